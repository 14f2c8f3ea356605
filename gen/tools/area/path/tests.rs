use super::*;
use serde_json::json;

/// Emitted text of a block; yosys reads it without its comment lines.
const RECEIVER: &str = "// A receiver.
module receiver (
    input wire clk,
    // High when the last bit is in.
    output wire done
);
    // Right CRC.
    reg crc_equal;
    reg last;
    reg last_next;
    wire from_part;
    assign done = crc_equal & last;
    always @(posedge clk) begin
        if (reset) begin
            crc_equal <= 1'b0;
        end else begin
            crc_equal <= computed == received;
            last <= last_next;
        end
    end
    always @* begin
        last_next = last;
        if (done) begin
            last_next = 1'b1;
        end
    end
endmodule
";
const TOP: &str = "module channel (input wire clk);
    // Of the receiver.
    wire receiver_done;
    reg owing;
    always @(posedge clk) owing <= 1'b0;
    owing <= receiver_done;
endmodule
";

fn files() -> [Artifact; 2] {
    [("receiver.v", RECEIVER), ("channel.v", TOP)].map(|(path, text)| Artifact::new(path, text))
}

fn netlist() -> Value {
    let net =
        |bits: Value, src: &str| json!({"bits": bits, "attributes": {"hdlname": "x", "src": src}});
    json!({"modules": {"harness": {"netnames": {
        "dut.owing_SB_DFF_Q_D_SB_LUT4_O_I3": {"bits": [7, 8], "attributes": {}},
        "dut.a_port": net(json!([7]), "channel.v:2.1-2.9|/share/cells_map.v:6.2"),
        "dut.receiver_done": net(json!([9]), "channel.v:2.1-2.9"),
        "dut.owing": net(json!([10]), "channel.v:3.1-3.9"),
        "dut.u_receiver.crc_equal": net(json!([7]), "receiver.v:5.9-5.18"),
        "dut.u_receiver.done": net(json!([9]), "receiver.v:3.9-3.18"),
        "dut.u_receiver.from_part": net(json!([11]), "receiver.v:8.9-8.18"),
        "dut.u_receiver.last": net(json!([12]), "receiver.v:6.9-6.18"),
    }}}})
}

fn step(kind: &str, delay: f64, net: &str, cell: &str) -> Value {
    let to = json!({"cell": cell, "port": "I0"});
    json!({"type": kind, "delay": delay, "net": net, "from": to, "to": to})
}

/// Two paths between registers, the slower one second, and a slower one to a pin.
fn report() -> Value {
    let lc = "dut.owing_SB_DFF_Q_D_SB_LUT4_O_LC";
    json!({"critical_paths": [
        {"from": "posedge clk", "to": "posedge clk", "path": [
            step("clk-to-q", 1.0, "", lc),
            step("routing", 1.0, "dut.u_receiver.last", lc),
        ]},
        {"from": "posedge clk", "to": "posedge clk", "path": [
            step("clk-to-q", 0.5, "", lc),
            step("routing", 1.5, "dut.owing_SB_DFF_Q_D_SB_LUT4_O_I3[0]", lc),
            step("logic", 0.25, "", lc),
            step("routing", 0.5, "$nextpnr_ICESTORM_LC_10$I3", lc),
            step("routing", 0.25, "dut.receiver_done", lc),
            step("routing", 0.25, "dut.u_receiver.done_SB_LUT4_I0_O[1]", lc),
            step("setup", 0.125, "", lc),
        ]},
        {"from": "<async>", "to": "posedge clk", "path": [step("routing", 9.0, "load", lc)]},
        {"from": "posedge clk", "to": "<async>", "path": [step("routing", 9.0, "q", lc)]},
    ]})
}

fn found() -> CriticalPath {
    critical_path(3, &report(), &netlist(), &files()).unwrap()
}

#[test]
fn critical_path_is_the_slowest_between_registers() {
    let path = found();
    assert_eq!((path.seed, path.total_ns), (3, 3.375));
}

#[test]
fn hops_have_the_declared_name_in_the_block_that_drives_the_signal() {
    let hops = found().hops;
    let names: Vec<_> = hops.iter().map(|h| (&*h.block, &*h.signal)).collect();
    let wanted = [
        ("u_receiver", "crc_equal"),
        ("u_receiver", "done"),
        ("", "owing"),
    ];
    assert_eq!(names, wanted);
}

#[test]
fn hops_count_time_up_to_the_driver_of_their_signal() {
    let hops = found().hops;
    let times: Vec<_> = hops.iter().map(|h| h.at_ns).collect();
    assert_eq!(times, [0.5, 2.75, 3.375]);
}

#[test]
fn hops_name_the_line_of_the_text_with_comments() {
    let hops = found().hops;
    let lines: Vec<_> = hops.iter().map(|h| h.line.as_deref().unwrap()).collect();
    assert_eq!(lines, ["receiver.v:17", "receiver.v:12", "channel.v:6"]);
    let texts: Vec<_> = hops.iter().map(|h| h.text.as_deref().unwrap()).collect();
    assert_eq!(texts[0], "crc_equal <= computed == received;");
    assert_eq!(texts[2], "owing <= receiver_done;");
}

/// Block, signal and line of a net of the netlist.
fn hop_of(net: &str) -> Hop {
    let (netlist, files) = (netlist(), files());
    let nets = netlist["modules"]["harness"]["netnames"]
        .as_object()
        .unwrap();
    let design = Design {
        nets,
        files: &files,
    };
    design.hop(0.0, net).unwrap()
}

#[test]
fn signals_without_an_assignment_have_the_line_of_their_declaration() {
    let hop = hop_of("dut.u_receiver.from_part");
    assert_eq!(hop.line.as_deref(), Some("receiver.v:11"));
    assert_eq!(hop.text.as_deref(), Some("wire from_part;"));
    let unknown = hop_of("dut.u_other.x_SB_LUT4_O");
    assert_eq!((unknown.line, unknown.text), (None, None));
}

#[test]
fn registers_named_after_a_port_have_the_name_in_their_block() {
    let hop = hop_of("dut.receiver_done_SB_DFF_Q_DFFLC");
    assert_eq!((&*hop.block, &*hop.signal), ("u_receiver", "done"));
    assert_eq!(hop.line.as_deref(), Some("receiver.v:12"));
}

#[test]
fn registers_with_a_separate_next_value_have_the_line_that_decides_it() {
    assert_eq!(driver(RECEIVER, "last"), Some(24));
    assert_eq!(driver(RECEIVER, "las"), None);
}

#[test]
fn names_lose_what_synthesis_appends() {
    for (net, wanted) in [
        (
            "dut.u_a.u_b.field_SB_DFFESR_Q_1_D_SB_LUT4_O_I3[1]",
            ("u_a.u_b", "field"),
        ),
        ("dut.u_a.left_LUT4_A_Z[3]", ("u_a", "left")),
        ("dut.u_a.left_TRELLIS_FF_Q_2", ("u_a", "left")),
        ("dut.u_a.sum_CCU2C_S0", ("u_a", "sum")),
        ("dut.u_a.sum_PFUMX_Z", ("u_a", "sum")),
        ("dut.u_a.sum_L6MUX21_Z", ("u_a", "sum")),
        ("dut.since_rise[0]", ("", "since_rise")),
        ("load$SB_IO_IN", ("harness", "load")),
    ] {
        assert_eq!(named(net), Some(wanted), "{net}");
    }
    assert_eq!(named("$abc$17$n5"), None);
}

#[test]
fn path_is_printed_with_one_row_for_each_hop() {
    let text = found().to_string();
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(lines[0], "  worst path with seed 3: 3.38 ns");
    assert_eq!(lines.len(), 4);
    let row = "     3.38  -           owing      channel.v:6    owing <= receiver_done;";
    assert_eq!(lines[3], row);
}

#[test]
fn report_without_a_path_between_registers_is_a_fault() {
    let report = json!({"critical_paths": []});
    let fault = critical_path(1, &report, &netlist(), &files()).unwrap_err();
    assert!(
        fault.to_string().contains("no path between registers"),
        "{fault}"
    );
}

#[test]
fn lines_that_hand_on_another_name_come_after_those_that_compute() {
    let ranks = [
        "done <= is_taken;",
        "done = a & b;",
        "assign done = done_now;",
    ]
    .map(Rank::of);
    assert_eq!(ranks, [Rank::Value, Rank::Value, Rank::Copy]);
    assert!(Rank::Value < Rank::Copy && Rank::Copy < Rank::Declaration);
}
