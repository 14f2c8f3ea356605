#!/usr/bin/env tclsh
# Stand-ins for the shells of vendors' tools, and for the tools that ISE's shell starts: under each name, its commands as Tcl sees them,
# called with words that they know and files that exist, and its reports in its form. SLOW, HOLD and FAR (inputs; Vivado, ISE) in the environment spoil the timing.

set shell [file tail $argv0]
set slow [info exists ::env(SLOW)]
set hold [info exists ::env(HOLD)]
set far [info exists ::env(FAR)]

proc must {is_so text} {
    if {![uplevel 1 [list expr $is_so]]} { error $text }
}

proc must_exist file {
    must {[file exists $file] && [file size $file] > 0} "no file $file"
}

# A source in a language: the module or entity of its name is in it.
proc must_be_source {file language} {
    must_exist $file
    must {[file extension $file] eq [dict get {verilog .v vhdl .vhd} $language]} "$file as $language"
    set channel [open $file]
    set text [read $channel]
    close $channel
    set name [file rootname [file tail $file]]
    must {[regexp -line "^(module|entity|package) ${name}\\M" $text] || [string match *_logic.vhd $file]} "$file: no $name in it"
    incr ::read_count
}

# A text that goes to a file, with its folder.
proc leave {file text} {
    file mkdir [file dirname $file]
    set channel [open $file w]
    puts $channel $text
    close $channel
}

proc must_be_whole top {
    must {[file exists $top.v] || [file exists $top.vhd]} "no $top"
    must {$::read_count > 10} "only $::read_count sources"
}

set read_count 0
switch $shell {
    vivado {
        must {[lrange $argv 0 3] eq {-mode batch -nojournal -source}} $argv
        set script [lindex $argv 4]
        proc read_verilog file { must_be_source $file verilog }
        proc read_vhdl file { must_be_source $file vhdl }
        proc read_xdc file {
            proc set_property {option list ports} { must {$option eq "-dict" || $ports eq "design"} "$option $ports" }
            proc create_clock {n name p period port} { must {$period == 10 && $port eq "osc_i"} "$period $port" }
            proc set_max_delay {o f port ns} { must {$ns == 10 && [string match *_i* $port]} "$port $ns" ; incr ::bounds }
            proc get_ports name { return $name }
            proc current_design {} { return design }
            uplevel #0 source $file
            must {$::bounds == 4} "$::bounds bounds"
        }
        proc synth_design {t top p part} {
            must {"$t $p" eq "-top -part" && $part eq "xc7a35ticsg324-1L"} $part
            must_be_whole $top
        }
        foreach step {opt_design place_design phys_opt_design route_design} { proc $step {} "lappend ::steps $step" }
        proc all_inputs {} { return inputs }
        proc get_clocks {} { return {osc_i pll_clk pll_feedback} }
        proc get_timing_paths args {
            if {[lindex $args 1] eq "min"} { return min }
            must {[lindex $args 0] eq "-from"} $args
            if {[lindex $args 1] eq "inputs"} { return inputs }
            must {[lindex $args 2] eq "-to" && [lindex $args 1] eq [lindex $args 3]} $args
            return [expr {[lindex $args 1] eq "pll_clk" ? "pll_clk" : ""}]
        }
        proc get_property {name object} {
            must {$object ne ""} "Invalid option value '' specified for 'object'."
            switch "$name $object" {
                "SLACK pll_clk" { return [expr {$::slow ? -0.125 : 0.5}] }
                "SLACK inputs" { return [expr {$::far ? -1.5 : 6.2}] }
                "SLACK min" { return [expr {$::hold ? -0.2 : 0.031}] }
                "PERIOD pll_clk" - "PERIOD osc_i" { return 10.000 }
            }
            if {$name eq "NAME"} { return $object }
            return ""
        }
        proc report_utilization option {
            must {$option eq "-return_string"} $option
            return "1. Slice Logic
+-------------------------+------+-------+------------+-----------+-------+
|        Site Type        | Used | Fixed | Prohibited | Available | Util% |
+-------------------------+------+-------+------------+-----------+-------+
| Slice LUTs              | 2907 |     0 |          0 |     20800 | 13.98 |
|   LUT as Logic          | 2899 |     0 |          0 |     20800 | 13.94 |
| Slice Registers         | 3172 |     0 |          0 |     41600 |  7.63 |
| Block RAM Tile          |  0.5 |     0 |          0 |        50 |  1.00 |
+-------------------------+------+-------+------------+-----------+-------+"
        }
        proc write_bitstream {f file} {
            must {$f eq "-force" && [llength $::steps] == 4} "steps: $::steps"
            leave $file "bits"
        }
        source $script
    }
    xtclsh {
        must {[llength $argv] == 1} $argv
        source [lindex $argv 0]
    }
    xst {
        must {[lindex $argv 0] eq "-ifn"} $argv
        set channel [open [lindex $argv 1]]
        must {[regexp {^run -ifn (\S+) -top (\S+) -p (\S+) -ofn (\S+)\n$} [read $channel] all project top part result]} $argv
        must {$part eq "xc6slx9-tqg144-2"} $part
        set channel [open $project]
        foreach line [split [string trim [read $channel]] "\n"] {
            must {[lindex $line 1] eq "work"} $line
            must_be_source [lindex $line 2] [lindex $line 0]
        }
        must_be_whole $top
        leave $result "netlist"
    }
    ngdbuild {
        must {[lindex $argv 0] eq "-uc"} $argv
        foreach file [lrange $argv 1 2] { must_exist $file }
        set ucf [open [lindex $argv 1]]
        must {[regexp -all {NET "\S+_i" TNM = "asynchronous_inputs";} [read $ucf]] == 4} "asynchronous inputs"
        leave [lindex $argv 3] "database"
    }
    map {
        must {[lrange $argv 0 1] eq {-w -o}} $argv
        must_exist [lindex $argv 3]
        leave [lindex $argv 2] "mapped"
        leave [lindex $argv 4] "constraints"
        leave [file rootname [lindex $argv 2]].mrp "Slice Logic Utilization:
  Number of Slice Registers:                 3,181 out of  11,440   27%
    Number used as Flip Flops:               3,172
  Number of Slice LUTs:                      2,795 out of   5,720   48%
  Number of bonded IOBs:                        16 out of     102   15%
  Number of RAMB16BWERs:                         1 out of      32    3%"
    }
    par {
        must {[lindex $argv 0] eq "-w"} $argv
        must_exist [lindex $argv 1]
        must_exist [lindex $argv 3]
        leave [lindex $argv 2] "routed"
    }
    trce {
        must {[lrange $argv 0 2] eq {-v 3 -o}} $argv
        must_exist [lindex $argv 4]
        set least [expr {$slow ? 10.4 : 8.0}]
        set holds [expr {$hold ? 2 : 0}]
        leave [lindex $argv 3] "Release 14.7 Trace
================================================================================
Timing constraint: TS_osc_i = PERIOD TIMEGRP \"osc_i\" 31.25 ns HIGH 50%;

 0 paths analyzed, 0 endpoints analyzed, 0 failing endpoints
 0 timing errors detected. (0 component switching limit errors)
 Minimum period is   5.000ns.
--------------------------------------------------------------------------------
================================================================================
Timing constraint: TS_pll_clk = PERIOD TIMEGRP \"pll_clk\" TS_osc_i / 3.125 HIGH
50%;
For more information, see Period Analysis in the Timing Closure User Guide.

 41522 paths analyzed, 9120 endpoints analyzed, 0 failing endpoints
 0 timing errors detected. (0 setup errors, $holds hold errors, 0 component switching limit errors)
 Minimum period is   ${least}ns.
--------------------------------------------------------------------------------
================================================================================
Timing constraint: TS_asynchronous_inputs = MAXDELAY FROM TIMEGRP
\"asynchronous_inputs\" TO TIMEGRP \"FFS\" 10 ns DATAPATHONLY;

 6 paths analyzed, 6 endpoints analyzed, $far failing endpoints
 $far timing errors detected. ($far setup errors, 0 hold errors)
 Maximum delay is   4.120ns.
--------------------------------------------------------------------------------"
    }
    bitgen {
        must {[lindex $argv 0] eq "-w"} $argv
        must_exist [lindex $argv 1]
        leave [lindex $argv 2] "bits"
    }
    quartus_sh {
        must {[lindex $argv 0] eq "-t"} $argv
        proc load_package name { must {$name in {flow report}} $name }
        proc project_new {name o} { set ::project $name ; must {$o eq "-overwrite"} $o }
        proc set_global_assignment {n name value} {
            set ::globals($name) $value
            switch $name {
                VERILOG_FILE { must_be_source $value verilog }
                VHDL_FILE { must_be_source $value vhdl }
                SDC_FILE { must_exist $value }
            }
        }
        proc set_location_assignment {pin to signal} { must {[string match PIN_* $pin] && $to eq "-to"} "$pin $to" ; set ::pins($signal) $pin }
        proc set_instance_assignment {n name value to signal} {
            must {"$n $to" eq "-name -to" && [info exists ::pins($signal)]} "$signal"
            must {$name in {IO_STANDARD CURRENT_STRENGTH_NEW SLEW_RATE FAST_OUTPUT_REGISTER WEAK_PULL_UP_RESISTOR}} $name
        }
        proc export_assignments {} {}
        proc execute_flow what {
            must {$what eq "-compile" && $::globals(DEVICE) eq "5CSEBA6U23I7" && $::globals(GENERATE_RBF_FILE) eq "ON"} $what
            must_be_whole $::globals(TOP_LEVEL_ENTITY)
            proc create_clock {n name p period port} { must {$period == 20 && $port eq "osc_i"} "$period $port" }
            proc get_ports name { must {[info exists ::pins($name)]} "no port $name" ; return $name }
            proc derive_pll_clocks {} {}
            proc derive_clock_uncertainty {} {}
            proc set_max_delay {f port ns} { must {$ns == 10} $ns }
            proc set_min_delay {f port ns} { must {$ns < 0} $ns }
            proc set_false_path {t port} { must {$t eq "-to"} $t }
            uplevel #0 source $::globals(SDC_FILE)
            leave $::project.rbf "bits"
        }
        proc load_report {} {}
        proc unload_report {} {}
        proc project_close {} {}
        set mhz [expr {$slow ? 98.2 : 118.61}]
        set panels [list "Fitter||Fitter Summary" [list {{Fitter Status} Successful} {{Logic utilization (in ALMs)} {1,702 / 41,910 ( 4 % )}} \
            {{Total registers} 3245} {{Total pins} {16 / 314 ( 5 % )}} {{Total block memory bits} {16,384 / 5,662,720 ( < 1 % )}} {{Total PLLs} {1 / 6 ( 17 % )}}] \
            "Timing Analyzer||Clocks" [list {{Clock Name} Type Period Frequency Rise} {osc_i Base 20.000 {50.0 MHz} 0.000} {{clock_manager|general[0]|divclk} Generated 10.000 {100.0 MHz} 0.000}] \
            "Timing Analyzer||Slow 1100mV 100C Model||Slow 1100mV 100C Model Fmax Summary" [list {Fmax {Restricted Fmax} {Clock Name} Note} {{130.1 MHz} {130.1 MHz} {clock_manager|general[0]|divclk} {}}] \
            "Timing Analyzer||Slow 1100mV -40C Model||Slow 1100mV -40C Model Fmax Summary" [list {Fmax {Restricted Fmax} {Clock Name} Note} [list "$mhz MHz" "$mhz MHz" {clock_manager|general[0]|divclk} {}]] \
            "Timing Analyzer||Multicorner Timing Analysis Summary" [list {Clock Setup Hold Recovery Removal} [list {Worst-case Slack} 1.57 [expr {$hold ? -0.21 : 0.17}] N/A N/A]]]
        array set tables $panels
        proc get_report_panel_names {} { return [array names ::tables] }
        proc get_number_of_rows {n panel} { return [llength $::tables($panel)] }
        proc get_report_panel_row {n panel r row} { return [lindex $::tables($panel) $row] }
        source [lindex $argv 1]
    }
    gw_sh {
        must {[llength $argv] == 1} $argv
        proc set_device {n die part} { must {"$n $die $part" eq "-name GW1NR-9C GW1NR-LV9QN88PC6/I5"} "$die $part" }
        proc add_file {t type file} {
            must {$t eq "-type" && $type in {verilog vhdl cst sdc}} $type
            if {$type in {verilog vhdl}} { must_be_source $file $type } else { must_exist $file }
        }
        proc set_option {name value} { set ::options($name) $value }
        proc run what {
            must {$what eq "all"} $what
            must_be_whole $::options(-top_module)
            set name $::options(-output_base_name)
            set mhz [expr {$::slow ? "91.100" : "110.250"}]
            set holds [expr {$::hold ? 3 : 0}]
            leave impl/pnr/$name.fs "bits"
            leave impl/pnr/${name}_tr_content.html "<table><tr><td class=\"label\">Numbers of Hold Violated Endpoints</td>
<td>$holds</td></tr></table><h2><a name=\"Max_Frequency_Report\">Max Frequency Summary:</a></h2><table>
<tr><th>NO.</th><th>Clock Name</th><th>Constraint</th><th>Actual Fmax</th><th>Logic Level</th><th>Entity</th></tr>
<tr><td>1</td><td>clk</td><td>99.000(MHz)</td><td>${mhz}(MHz)</td><td>9</td><td>TOP</td></tr></table>
<h2>Total Negative Slack Summary:</h2><table><tr><td>1 clk 1.000(MHz) 2.000(MHz)</td></tr></table>"
            leave impl/pnr/$name.rpt.txt "
  ----------------------------------------------------------
  Resources                   | Usage
  ----------------------------------------------------------
  Logic                       | 4364/8640  51%
    --LUT,ALU,ROM16           | 4364(3642 LUT, 722 ALU, 0 ROM16)
  Register                    | 3172/6693  48%
  I/O Port                    | 15/71  22%
  BSRAM                       | 1/26  4%"
        }
        source [lindex $argv 0]
    }
    diamondc {
        must {[llength $argv] == 1} $argv
        proc prj_project {what n name i impl d part s synthesis} {
            must {"$what $i $d $part" eq "new -impl -dev LFE5U-85F-6BG381C"} "$what $part"
            set ::result $impl/${name}_$impl
        }
        proc prj_src {what file} {
            switch [file extension $file] {
                .v { must_be_source $file verilog }
                .vhd { must_be_source $file vhdl }
                default { must_exist $file }
            }
        }
        proc prj_impl {what key top} { must {"$what $key" eq "option top"} "$what $key" ; must_be_whole $top }
        proc prj_run {step i impl args} {
            lappend ::steps [concat $step $args]
            if {$step eq "Export"} { done }
        }
        proc done {} {
            set mhz [expr {$::slow ? 97.4 : 104.866}]
            set holds [expr {$::hold ? 4 : 0}]
            leave $::result.bit "bits"
            leave $::result.twr "Lattice TRACE Report - Setup
Preference: FREQUENCY PORT \"osc_i\" 25.000000 MHz ;
            0 items scored, 0 timing errors detected.
--------------------------------------------------------------------------------
Preference: FREQUENCY NET \"clk\" 100.000000 MHz ;
            4096 items scored, 0 timing errors detected.
Report:  ${mhz}MHz is the maximum frequency for this preference.

Timing summary (Setup):
---------------
Timing errors: 0  Score: 0

Timing summary (Hold):
---------------
Timing errors: $holds  Score: 0"
            leave $::result.mrp "
   Number of registers:   3172 out of 84735 (4%)
   Number of SLICEs:      2011 out of 41820 (5%)
   Number of LUT4s:       3221 out of 83640 (4%)
   Number of block RAMs:  0 out of 208 (0%)"
        }
        source [lindex $argv 0]
        must {[lindex $steps 0] eq "Synthesis" && [lindex $steps end] eq {Export -task Bitgen}} $steps
    }
    default { error "no tool $shell" }
}
