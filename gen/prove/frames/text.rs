//! The Verilog around a channel for the proof of a frame: encoder and cable, and what is looked at.

use super::rest::Register;
use super::{Case, Settings};
use crate::verilog::emitted_name;
use endat_hdl::elaborate::{mask, Direction, Module};
use std::fmt::Write;

/// The channel with its encoder at the end of the cable.
pub(super) const FRAMES: &str = "frames";
/// What is looked at.
pub(super) const LOOK: &str = "look";
/// Outputs of [`LOOK`] that must never be HIGH.
pub(super) const CHECKS: [&str; 6] = [
    "bad_wire",
    "bad_contention",
    "bad_result",
    "bad_again",
    "bad_none",
    "bad_whole",
];
/// Output that says that a register is not as it is at rest: with its number.
pub(super) const REST: &str = "bad_rest_";
/// What ties registers to each other that may hold anything: the stored position fits its parity.
const WHOLE: &str = "u.u_snapshot.f_whole";

/// How a run begins, and what it goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Run {
    /// From rest over a frame to rest.
    Frame,
    /// From rest to rest, a cycle without a trigger.
    Wait,
}

/// Module [`FRAMES`]. DATA is anything while nobody drives it; the microsecond's tick comes in a phase of the case's.
pub(super) fn frames(channel: &Module, case: &Case, settings: &Settings) -> String {
    let connection = |port: &endat_hdl::elaborate::Port| {
        let net = &channel.nets[port.net];
        let width = net.width_bits;
        let value = match net.name.as_str() {
            "clock" => "clock".into(),
            "tick_us" => "tick_us".into(),
            "timestamp" => "timestamp".into(),
            "trigger" => "trigger".into(),
            "data_i" => "back".into(),
            "endat_clk" | "data_o" | "data_oe" | "busy" | "cause" | "fresh" | "position"
            | "position_valid" | "result_strobe" | "calibrated" => net.name.clone(),
            _ if port.direction == Direction::Output => return None,
            name => {
                let value = settings.iter().find(|(n, _)| *n == name).map_or(0, |s| s.1);
                format!("{width}'d{value}")
            }
        };
        Some(format!(".{}({value})", emitted_name(&net.name)))
    };
    let connections: Vec<String> = channel.ports.iter().filter_map(connection).collect();
    let mut out = String::from(include_str!("encoder.sv"));
    let (bits, delay, phase) = (case.position_bits, case.times.delay_cycles, case.tick_phase);
    let last = bits - 1;
    let _ = write!(
        out,
        "
module {FRAMES} (
    input  wire clock, input wire trigger, input wire [{last}:0] position_now, input wire [31:0] timestamp, input wire undriven,
    output wire result_strobe, output wire [47:0] position, output wire [4:0] cause, output wire fresh, output wire position_valid,
    output wire busy, output wire calibrated, output wire [{last}:0] sent, output wire wrong, output wire drives, output wire is_driven
);
    wire endat_clk, data_o, data_oe, value, clk_at, data_at, back;
    wire line = drives ? value : is_driven ? data_at : undriven;
    way_of_proof #(.CYCLES({delay}), .START(1)) u_clk (.clock(clock), .here(endat_clk), .there(clk_at));
    way_of_proof #(.CYCLES({delay})) u_driver (.clock(clock), .here(data_oe), .there(is_driven));
    way_of_proof #(.CYCLES({delay})) u_data (.clock(clock), .here(data_o), .there(data_at));
    way_of_proof #(.CYCLES({delay})) u_back (.clock(clock), .here(line), .there(back));
    encoder_of_proof #(.BITS({bits}), .HAS_F2({f2}), .COMMAND(6'd{command}), .TCAL_CYCLES({tcal}), .TM_CYCLES({tm})) u_encoder (
        .clock(clock), .clk_pin(clk_at), .is_driven(is_driven), .data_pin(data_at), .position(position_now),
        .drives(drives), .value(value), .wrong(wrong), .sent(sent));
    reg [7:0] tick_count; initial tick_count = 8'd{phase};
    wire tick_us = tick_count == 8'd{tick};
    always @(posedge clock) tick_count <= tick_us ? 8'd0 : tick_count + 8'd1;
    {name} u ({connections});
endmodule
",
        f2 = u8::from(case.command.has_f2()),
        command = case.command.code(),
        tcal = case.times.tcal_cycles,
        tm = case.times.tm_cycles,
        tick = case.tick_cycles() - 1,
        name = channel.name,
        connections = connections.join(", ")
    );
    out
}

/// Registers of [`frames`] around the channel, as they are at rest.
pub(super) fn around(case: &Case) -> Vec<Register> {
    let register = |name: &str, width_bits: usize, value: u128| Register {
        name: name.into(),
        width_bits,
        value: Some(value),
    };
    let mut registers = vec![
        register("u_encoder.state", 2, 0),
        register("u_encoder.clk_before", 1, 1),
        register("u_encoder.drives_now", 1, 1),
        register("u_encoder.value_now", 1, 0),
        register("u_encoder.wrong_now", 1, 0),
    ];
    let delay = case.times.delay_cycles as usize;
    if delay > 0 {
        registers.push(register("u_clk.cable.way", delay, mask(delay)));
        registers.push(register("u_driver.cable.way", delay, 0));
        registers.push(register("u_back.cable.way", delay, 0));
    }
    registers
}

/// Module [`LOOK`]: what must hold, as outputs that must stay LOW. `registers` are those with a value at rest.
pub(super) fn look(case: &Case, run: Run, registers: &[Register], limit_cycles: u64) -> String {
    let last = case.position_bits - 1;
    let (mut wires, mut connections, mut outputs) = (String::new(), vec![], vec![]);
    let mut rests = String::new();
    for (index, register) in registers.iter().enumerate() {
        let Some(value) = register.value else {
            continue;
        };
        let width = register.width_bits;
        let _ = writeln!(wires, "    wire [{}:0] at_rest_{index};", width - 1);
        connections.push(format!(".\\{} (at_rest_{index})", register.name));
        outputs.push(format!("{REST}{index}"));
        let _ = writeln!(
            rests,
            "    assign {REST}{index} = is_rest & (at_rest_{index} != {width}'d{value});"
        );
    }
    let ports: Vec<String> = (CHECKS.iter().map(|c| (*c).to_owned()).chain(outputs))
        .map(|name| format!("output wire {name}"))
        .collect();
    // A trigger that meets a frame is lost, and changes nothing but that this is told.
    let (trigger, is_rest, has_frame) = match run {
        Run::Frame => (
            "(step == 16'd0) | (trigger_any & busy)",
            "got & !busy & !was_rest",
            1,
        ),
        Run::Wait => ("1'b0", "step == 16'd1", 0),
    };
    format!(
        "module {LOOK} (
    input wire clock, input wire [{last}:0] position_now, input wire [31:0] timestamp, input wire undriven, input wire trigger_any,
    {ports}
);
    wire result_strobe, fresh, position_valid, busy, calibrated, wrong, drives, is_driven;
    wire [47:0] position;
    wire [4:0] cause;
    wire [{last}:0] sent;
    wire whole;
{wires}    reg [15:0] step; initial step = 16'd0;
    reg got; initial got = 1'b0;
    reg was_rest; initial was_rest = 1'b0;
    wire trigger = {trigger};
    wire is_rest = {is_rest};
    always @(posedge clock) begin
        step <= step + 16'd1;
        if (result_strobe) got <= 1'b1;
        if (is_rest) was_rest <= 1'b1;
    end
    assign bad_wire = wrong & !was_rest;
    assign bad_contention = drives & is_driven & !was_rest;
    assign bad_result = result_strobe & !was_rest & !((position == sent) & fresh & position_valid & ((cause == 5'd0) | (cause == 5'd{overrun})));
    assign bad_again = result_strobe & got & !was_rest;
    assign bad_none = (step == 16'd{limit_cycles}) & !was_rest & {has_frame};
    assign bad_whole = is_rest & !whole;
{rests}    {FRAMES} f (.clock(clock), .trigger(trigger), .position_now(position_now), .timestamp(timestamp), .undriven(undriven),
        .result_strobe(result_strobe), .position(position), .cause(cause), .fresh(fresh), .position_valid(position_valid),
        .busy(busy), .calibrated(calibrated), .sent(sent), .wrong(wrong), .drives(drives), .is_driven(is_driven),
        .\\{WHOLE} (whole){comma}{connections});
    always @* if (step == 16'd0) assume (whole);
endmodule
",
        ports = ports.join(",\n    "),
        overrun = endat_hdl::transaction::cause::TRIGGER_OVERRUN,
        comma = if connections.is_empty() { "" } else { ", " },
        connections = connections.join(", "),
    )
}
