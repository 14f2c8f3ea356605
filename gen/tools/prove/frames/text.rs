//! The Verilog around a channel for the proof of a frame: encoder and cable.

use super::{Case, Settings};
use endat_hdl::endat::transaction::cause::TRIGGER_OVERRUN;
use rtl_design::elaborate::{Direction, Module};
use rtl_design::verilog::emitted_name;
use std::fmt::Write;

/// The channel with its encoder at the end of the cable.
pub(super) const FRAMES: &str = "frames";
/// End of the name of a net that ties registers to each other: it is HIGH whenever the channel waits.
pub(super) const WHOLE: &str = "u_snapshot.f_whole";
/// The one cause that a good result may have: that a trigger was lost.
pub(super) const OVERRUN: u32 = TRIGGER_OVERRUN as u32;
/// End of the names of the registers that say which additional data the encoder sends.
pub(super) const SELECTED: &str = "u_add_info.selected";
/// What is shown of a run: ports of [`FRAMES`].
pub(super) const SHOWN: [&str; 15] = [
    "trigger",
    "busy",
    "endat_clk",
    "data_o",
    "data_oe",
    "line",
    "drives",
    "is_driven",
    "wrong",
    "data_i",
    "result_strobe",
    "position",
    "sent",
    "cause",
    "info_good",
];

/// Module [`FRAMES`]. DATA is `undriven` while nobody drives it.
pub(super) fn frames(channel: &Module, case: &Case, settings: &Settings) -> String {
    let connection = |port: &rtl_design::elaborate::Port| {
        let net = &channel.nets[port.net];
        let width = net.width_bits;
        let value = match net.name.as_str() {
            "clock" | "tick_us" | "timestamp" | "trigger" | "data_i" => net.name.clone(),
            "endat_clk" | "data_o" | "data_oe" | "busy" | "cause" | "fresh" | "position"
            | "position_valid" | "result_strobe" | "info_1" | "info_2" | "info_came"
            | "info_good" => net.name.clone(),
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
    let (bits, delay) = (case.position_bits, case.line.delay_cycles);
    let last = bits - 1;
    let _ = write!(
        out,
        "
module {FRAMES} (
    input  wire clock, input wire tick_us, input wire trigger, input wire [{last}:0] position_now,
    input  wire [23:0] info_1_now, input wire [23:0] info_2_now, input wire [31:0] timestamp, input wire undriven,
    output wire endat_clk, output wire data_o, output wire data_oe, output wire line, output wire data_i,
    output wire busy, output wire result_strobe, output wire [47:0] position, output wire [4:0] cause, output wire fresh,
    output wire [23:0] info_1, output wire [23:0] info_2, output wire [1:0] info_came, output wire [1:0] info_good,
    output wire [23:0] sent_1, output wire [23:0] sent_2, output wire position_valid, output wire [{last}:0] sent, output wire wrong, output wire drives, output wire is_driven
);
    wire value, clk_at, data_at;
    assign line = drives ? value : is_driven ? data_at : undriven;
    way_of_proof #(.CYCLES({delay}), .START(1)) u_clk (.clock(clock), .here(endat_clk), .there(clk_at));
    way_of_proof #(.CYCLES({delay})) u_driver (.clock(clock), .here(data_oe), .there(is_driven));
    way_of_proof #(.CYCLES({delay})) u_data (.clock(clock), .here(data_o), .there(data_at));
    way_of_proof #(.CYCLES({delay})) u_back (.clock(clock), .here(line), .there(data_i));
    encoder_of_proof #(.BITS({bits}), .HAS_F2({f2}), .COMMAND(6'd{command}), .TCAL_CYCLES({tcal}), .TM_CYCLES({tm}),
        .HAS_INFO_1({info_1}), .HAS_INFO_2({info_2})) u_encoder (
        .clock(clock), .clk_pin(clk_at), .is_driven(is_driven), .data_pin(data_at), .position(position_now), .info_1(info_1_now), .info_2(info_2_now),
        .drives(drives), .value(value), .wrong(wrong), .sent(sent), .sent_1(sent_1), .sent_2(sent_2));
    {name} u ({connections});
endmodule
",
        f2 = u8::from(case.command.has_f2()),
        command = case.command.code(),
        tcal = case.line.tcal_cycles,
        info_1 = case.infos & 1,
        info_2 = case.infos >> 1,
        tm = case.line.tm_cycles,
        name = channel.name,
        connections = connections.join(", ")
    );
    out
}
