# Vivado's commands of a block design as tclsh sees them: cells of known kinds with their own pins, each input driven once, by an output.
# The caller gives: ports {name direction ...} of the core, vlnv, interface, boards, made_mhz; and reads what `facts` prints.

array set kind {}
array set config {}
array set driver {}
array set partner {}
array set outside {}
set files {}

proc create_project {name folder args} {
    if {[lindex $args 0] ne "-part" || [lindex $args 2] ne "-force"} { error "create_project $args" }
    set ::part [lindex $args 1]
    file delete -force $folder
    file mkdir $folder
}
proc get_board_parts {args} { expr {[lindex $args 0] eq "-quiet" ? $::boards : [error "no -quiet"]} }
proc current_project {} { return project }
proc current_fileset {} { return sources_1 }
proc update_ip_catalog {} { set ::catalog $::repository }
proc update_compile_order args {}
proc create_bd_design name { set ::design $name }
proc create_bd_cell {t ip v vlnv name} {
    if {$t ne "-type" || $ip ne "ip" || $v ne "-vlnv"} { error "create_bd_cell $t $ip $v" }
    if {$vlnv eq $::vlnv} {
        if {![string match */ip $::catalog]} { error "the core is in no catalogue" }
        set ::kind($name) core
    } elseif {[regexp {^xilinx.com:ip:(processing_system7|smartconnect|proc_sys_reset)$} $vlnv whole short]} {
        set ::kind($name) $short
    } else {
        error "no IP $vlnv"
    }
    return $name
}
proc apply_bd_automation {rule name option values cell} {
    if {$rule ne "-rule" || $name ne "xilinx.com:bd_rule:processing_system7" || $option ne "-config" || $::kind($cell) ne "processing_system7"} { error $name }
    if {[dict get $values make_external] ne "FIXED_IO, DDR"} { error $values }
    set ::preset [dict get $values apply_board_preset]
}
proc set_property {name args} {
    if {$name eq "-dict"} {
        lassign $args values object
    } else {
        lassign $args value object
        set values [list $name $value]
    }
    if {[info exists ::kind($object)]} {
        foreach {key value} $values {
            if {![regexp {^CONFIG\.(PCW_USE_M_AXI_GP0|PCW_EN_CLK0_PORT|PCW_FPGA0_PERIPHERAL_FREQMHZ|PCW_USE_FABRIC_INTERRUPT|PCW_IRQ_F2P_INTR|NUM_SI|NUM_MI)$} $key]} { error "no property $key" }
            set ::config($object.$key) $value
        }
    } else {
        switch $name {
            ip_repo_paths { set ::repository $value }
            board_part { set ::board $value }
            top { if {$value ne "${::design}_wrapper" || ![llength $::files]} { error "top $value" } }
            default { error "no property $name" }
        }
    }
}
proc has {cell key} { expr {[info exists ::config($cell.CONFIG.$key)] && $::config($cell.CONFIG.$key) == 1} }
proc pins {cell} {
    switch $::kind($cell) {
        core { return $::ports }
        smartconnect { return {aclk I aresetn I} }
        proc_sys_reset { return {slowest_sync_clk I ext_reset_in I peripheral_reset O interconnect_aresetn O} }
        processing_system7 {
            set pins {FCLK_RESET0_N O}
            if {[has $cell PCW_EN_CLK0_PORT]} { lappend pins FCLK_CLK0 O }
            if {[has $cell PCW_USE_M_AXI_GP0]} { lappend pins M_AXI_GP0_ACLK I }
            if {[has $cell PCW_USE_FABRIC_INTERRUPT] && [has $cell PCW_IRQ_F2P_INTR]} { lappend pins IRQ_F2P I }
            return $pins
        }
    }
}
proc interfaces {cell} {
    switch $::kind($cell) {
        core { return [list $::interface slave] }
        smartconnect { if {[has $cell NUM_SI] && [has $cell NUM_MI]} { return {S00_AXI slave M00_AXI master} } else { return {} } }
        processing_system7 { return [expr {[has $cell PCW_USE_M_AXI_GP0] ? {M_AXI_GP0 master} : {}}] }
        default { return {} }
    }
}
proc one_of {what path} {
    lassign [split $path /] cell name
    set all [$what $cell]
    if {![dict exists $all $name]} { error "no $path among the $what of $cell" }
    return $path
}
proc get_bd_pins path { one_of pins $path }
proc get_bd_intf_pins path { one_of interfaces $path }
proc direction {what path} { lassign [split $path /] cell name ; dict get [$what $cell] $name }
proc get_property {name object} {
    switch -glob $name {
        DIR { direction pins $object }
        CONFIG.PCW_ACT_FPGA0_PERIPHERAL_FREQMHZ { if {![info exists ::config($object.CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ)]} { error "not set" } ; return $::made_mhz }
        PROGRESS { return 100% }
        STATS.WNS { return $::slack }
        default { error "no property $name" }
    }
}
proc connect_bd_intf_net {master slave} {
    if {[direction interfaces $master] ne "master" || [direction interfaces $slave] ne "slave"} { error "$master to $slave" }
    if {[info exists ::partner($slave)]} { error "$slave twice" }
    set ::partner($slave) $master
}
proc create_bd_port {option direction name} {
    if {$option ne "-dir" || $direction ni {I O}} { error "create_bd_port $option $direction" }
    set ::outside($name) $direction
    return $name
}
proc get_bd_ports name { if {![info exists ::outside($name)]} { error "no port $name" } ; return $name }
proc connect_bd_net {a b} {
    set drives {}
    set takes {}
    foreach end [list $a $b] {
        if {[info exists ::outside($end)]} {
            if {$::outside($end) eq "I"} { lappend drives $end } else { lappend takes $end }
        } elseif {[direction pins $end] eq "O"} { lappend drives $end } else { lappend takes $end }
    }
    if {[llength $drives] != 1 || [llength $takes] != 1} { error "$a to $b" }
    if {[info exists ::driver($takes)]} { error "$takes twice" }
    set ::driver($takes) $drives
}
proc get_bd_addr_spaces path { if {$path ne "processor/Data"} { error $path } ; return $path }
proc get_bd_addr_segs path { if {$path ne "core/$::interface/registers"} { error $path } ; return $path }
proc assign_bd_address {o offset r range t space segment} {
    if {$o ne "-offset" || $r ne "-range" || $t ne "-target_address_space"} { error "assign_bd_address $o $r $t" }
    if {$offset < 0x40000000 || $offset + $range > 0x80000000 || $offset % $range} { error "$offset is out of reach" }
    set ::address [list $offset $range]
}
proc validate_bd_design {} {
    foreach cell [array names ::kind] {
        foreach {name direction} [pins $cell] {
            if {$direction eq "I" && ![info exists ::driver($cell/$name)]} { error "nothing drives $cell/$name" }
        }
        foreach {name direction} [interfaces $cell] {
            if {$direction eq "slave" && ![info exists ::partner($cell/$name)]} { error "nothing is at $cell/$name" }
        }
    }
}
proc save_bd_design {} { set ::saved 1 }
proc get_files name { if {$name ne "$::design.bd" || ![info exists ::saved]} { error $name } ; return $name }
proc make_wrapper {option files top} { if {$option ne "-files" || $top ne "-top"} { error $option } ; return wrapper.v }
proc add_files args {
    set file [lindex $args end]
    if {"-fileset" in $args && ![file exists $file]} { error "no file $file" }
    lappend ::files $file
}
proc launch_runs {run option step} { if {$run ne "impl_1" || $option ne "-to_step" || $step ne "write_bitstream"} { error $step } ; set ::launched 1 }
proc wait_on_run run { if {![info exists ::launched]} { error $run } }
proc get_runs run { return $run }
proc write_hw_platform args { set ::platform [lindex $args end] }
proc facts {} {
    foreach input [lsort [array names ::driver]] { puts "$input <- $::driver($input)" }
    foreach slave [lsort [array names ::partner]] { puts "$slave <= $::partner($slave)" }
    puts "address $::address"
    puts "clock $::config(processor.CONFIG.PCW_FPGA0_PERIPHERAL_FREQMHZ)"
    puts "board [expr {[info exists ::board] ? $::board : {}}] preset $::preset part $::part"
    puts "platform [expr {[info exists ::platform] ? [file tail $::platform] : {}}]"
}
