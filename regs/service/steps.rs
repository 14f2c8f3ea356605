//! Steps of the initialisation, as `progress` counts them.

use crate::named::named;
use crate::Named;

/// Steps of the initialisation, in their order.
pub const STEPS: &[Named] = &[
    named("none", 0, "none"),
    named("reset", 1, "reset"),
    named("select_b9", 2, "select memory area 0xB9"),
    named("read_alarms", 3, "read alarms"),
    named("read_warnings", 4, "read warnings"),
    named("clear_alarms", 5, "write 0 to word 0"),
    named("clear_warnings", 6, "write 0 to word 1"),
    named("select_a1", 7, "select memory area 0xA1"),
    named("read_position_bits", 8, "read position_bits"),
    named("take_width", 9, "take over the position width"),
    named("read_encoder_type", 10, "read encoder_type"),
    named("read_signal_periods_low", 11, "read signal_periods_low"),
    named("select_a3", 12, "select memory area 0xA3"),
    named("read_signal_periods_high", 13, "read signal_periods_high"),
    named("read_revolutions", 14, "read revolutions"),
    named("read_steps_low", 15, "read steps_low"),
    named("read_steps_high", 16, "read steps_high"),
    named("read_id_0", 17, "read id_0"),
    named("read_id_1", 18, "read id_1"),
    named("read_id_2", 19, "read id_2"),
    named("read_serial_0", 20, "read serial_0"),
    named("read_serial_1", 21, "read serial_1"),
    named("read_serial_2", 22, "read serial_2"),
    named("select_a5", 23, "select memory area 0xA5"),
    named("read_commands", 24, "read commands"),
    named("read_tcal", 25, "read tcal"),
    named("find_endat22", 26, "find out whether it knows EnDat 2.2"),
    named("select_bd", 27, "select memory area 0xBD"),
    named("read_infos_1", 28, "read infos_1"),
    named("read_infos_2", 29, "read infos_2"),
    named("read_clock_max_khz", 30, "read clock_max_khz"),
    named("choose_clock", 31, "choose the clock"),
    named("select_b9_again", 32, "select memory area 0xB9"),
    named("read_recovery", 33, "read recovery"),
    named("set_recovery", 34, "set the recovery time"),
];
