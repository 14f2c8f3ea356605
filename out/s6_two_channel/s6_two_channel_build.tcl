# Bitstream of s6_two_channel_top on Gadget Factory Papilio Pro with ISE 14.7: xtclsh s6_two_channel_build.tcl
# What there is of another run is none of this one.
file delete -force s6_two_channel_report.json s6_two_channel.bit

# What `endat-gen build` reads, when the bitstream is there: clocks as (name, MHz reached, MHz wanted), cells as (kind, used, there).
proc write_report {clocks cells} {
    set rows {}
    foreach {name reached wanted} $clocks {
        set name [string map {\\ \\\\ \" \\\"} $name]
        lappend rows "    \"$name\": {\"achieved\": [format %.6f $reached], \"constraint\": [format %.6f $wanted]}"
    }
    set kinds {}
    foreach {kind used available} $cells {
        lappend kinds "    \"$kind\": {\"used\": [number $used], \"available\": [number $available]}"
    }
    set file [open s6_two_channel_report.json w]
    puts $file "{\n  \"configuration\": \"4372d9d99a42\",\n  \"part\": \"xc6slx9-tqg144-2\",\n  \"bitstream_bytes\": [file size s6_two_channel.bit],\n  \"fmax\": {\n[join $rows ",\n"]\n  },\n  \"utilization\": {\n[join $kinds ",\n"]\n  }\n}"
    close $file
}

# A number without the commas and halves that tools write in it.
proc number text {
    return [expr {int([string map {, ""} $text])}]
}

# Ends with what is wrong, and without a trace of the script.
proc refuse text {
    puts stderr "s6_two_channel: $text"
    exit 1
}

proc text_of name {
    set file [open $name]
    set text [read $file]
    close $file
    return $text
}

# The sources in the order in which they are read, the board top last.
set sources [split [string trim [text_of s6_two_channel.f]] "\n"]
lappend sources s6_two_channel_top.v

proc tool args {
    puts $args
    eval exec $args >@stdout 2>@stderr
}

set project [open s6_two_channel.prj w]
foreach file $sources {
    set language [expr {[file extension $file] eq ".vhd" ? "vhdl" : "verilog"}]
    puts $project "$language work \"$file\""
}
close $project
set script [open s6_two_channel.xst w]
puts $script "run -ifn s6_two_channel.prj -top s6_two_channel_top -p xc6slx9-tqg144-2 -ofn s6_two_channel.ngc"
close $script
tool xst -ifn s6_two_channel.xst
tool ngdbuild -uc s6_two_channel.ucf s6_two_channel.ngc s6_two_channel.ngd
tool map -w -o s6_two_channel_map.ncd s6_two_channel.ngd s6_two_channel.pcf
tool par -w s6_two_channel_map.ncd s6_two_channel_par.ncd s6_two_channel.pcf
tool trce -v 3 -o s6_two_channel.twr s6_two_channel_par.ncd s6_two_channel.pcf

# A period is in ns, or a multiple or a part of another constraint's.
set clocks {}
set mark "Timing constraint:"
set sections [split [string map [list $mark \001] [text_of s6_two_channel.twr]] \001]
foreach section [lrange $sections 1 end] {
    if {[regexp {^\s*TS_asynchronous_inputs\d?\s} $section] && [regexp {([0-9]+) timing errors?} $section all count] && $count > 0} {
        refuse "$count ways of asynchronous inputs to their first register are longer than they may be: see s6_two_channel.twr"
    }
    if {![regexp {^\s*(TS_\S+)\s+=\s+PERIOD\s+TIMEGRP\s+"([^"]+)"\s+(.*?)\s+HIGH} $section all constraint name period]} continue
    if {[regexp {^([0-9.]+)\s*ns$} $period all ns]} {
        set periods($constraint) $ns
    } elseif {[regexp {^(\S+)\s*([*/])\s*([0-9.]+)$} $period all other sign factor]} {
        set periods($constraint) [expr "double($periods($other)) $sign $factor"]
    } elseif {[regexp {^(TS_\S+)$} $period all other]} {
        set periods($constraint) $periods($other)
    } else {
        refuse "a period that this script cannot read: $period"
    }
    if {[regexp {([0-9]+) hold errors?} $section all count] && $count > 0} {
        refuse "$constraint: $count hold times are not met: see s6_two_channel.twr"
    }
    # What nothing is timed by, as the oscillator in front of the PLL, has no least period or one of the PLL alone.
    if {[regexp {Minimum period is\s+([0-9.]+)ns} $section all least]} {
        lappend clocks $name [expr {1000.0 / $least}] [expr {1000.0 / $periods($constraint)}]
    }
}

set cells {}
set map_report [text_of s6_two_channel_map.mrp]
foreach kind {"Slice LUTs" "Slice Registers" "RAMB16BWERs" "bonded IOBs"} {
    if {[regexp "Number of $kind:\\s+(\[0-9,\]+) out of\\s+(\[0-9,\]+)" $map_report all used available]} {
        lappend cells $kind $used $available
    }
}
tool bitgen -w s6_two_channel_par.ncd s6_two_channel.bit
write_report $clocks $cells
