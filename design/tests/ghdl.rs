//! The printed VHDL under GHDL, on the stimulus and the expectation of the other executions.

use crate::three_way::{input_ports, write_rows, Recording, Stimulus};
use crate::tools;
use rtl_design::elaborate::Design;
use rtl_design::engine::Port;
use rtl_design::vhdl::{self, emitted_name, Header};
use std::fmt::Write;
use std::fs;

/// GHDL runs only the beginning of a long stimulus: it is slower than all other engines.
const CYCLES_MAX: usize = 4_000;

/// Runs the printed VHDL on the stimulus under GHDL and compares every output in every cycle. Not a warning is taken after time 0, where
/// signals have not met their values yet.
pub fn replay(
    name: &str,
    design: &Design,
    stimulus: &Stimulus,
    expected: &Recording,
) -> Result<(), String> {
    let folder = tools::folder(&format!("four_way-{name}"));
    let text = vhdl::print(design, &Header::default());
    let standard = standard(name);
    let count = stimulus.cycles.len().min(CYCLES_MAX);
    let write = |file: &str, text: String| fs::write(folder.join(file), text).unwrap();
    write("design.vhd", text);
    write("bench.vhd", bench(design, stimulus, expected, count));
    write_rows(&folder, "txt", design, stimulus, expected);
    let arguments = [
        "-c",
        standard,
        "design.vhd",
        "bench.vhd",
        "-r",
        "bench",
        "--ieee-asserts=disable-at-0",
    ];
    let (good, text) = tools::run("ghdl", &folder, &arguments);
    match (good, text.trim()) {
        (true, "PASS") => Ok(()),
        (_, other) => Err(format!("VHDL {standard}, {}: {other}", folder.display())),
    }
}

/// Half of the names have VHDL-93, the others VHDL-2008. Names that differ in their last bit differ in the standard.
fn standard(name: &str) -> &'static str {
    match name.bytes().fold(0, |sum, byte| sum ^ byte & 1) {
        0 => "--std=93",
        _ => "--std=08",
    }
}

fn bench(design: &Design, stimulus: &Stimulus, expected: &Recording, count: usize) -> String {
    let top = design.top();
    let inputs = input_ports(design, stimulus);
    let total = |ports: &[Port]| ports.iter().map(|p| p.width_bits).sum::<usize>().max(1);
    let mut connections = vec![];
    for port in top.ports.iter().filter(|p| p.is_clock) {
        connections.push(format!("{} => clk", emitted_name(&top.nets[port.net].name)));
    }
    let mut checks = String::new();
    for (ports, signal) in [(&inputs, "given"), (&expected.outputs, "got")] {
        let mut low = 0;
        for port in ports {
            let range = match port.width_bits {
                1 => format!("{low}"),
                width_bits => format!("{} downto {low}", low + width_bits - 1),
            };
            connections.push(format!("{} => {signal}({range})", emitted_name(&port.name)));
            if signal == "got" {
                let _ = writeln!(
                    checks,
                    "            assert got({range}) = want({range}) report \"cycle \" & integer'image(cycle) & \", port {}\" severity failure;",
                    port.name
                );
            }
            low += port.width_bits;
        }
    }
    let has_middle = !stimulus.middle.is_empty();
    let (middle_file, fall, end) = match has_middle {
        true => (
            "        file middle : text open read_mode is \"middle.txt\";\n",
            "            readline(middle, row);\n            read(row, given_row);\n            given <= to_stdlogicvector(given_row);\n            \
            wait for 5 ns;\n            clk <= '0';\n            wait for 1 ns;\n",
            "",
        ),
        false => ("", "", "            clk <= '0';\n"),
    };
    format!(
        "library ieee;
use ieee.std_logic_1164.all;
use std.textio.all;

entity bench is
end entity;

architecture test of bench is
    signal clk : std_logic := '0';
    signal given : std_logic_vector({given} downto 0) := (others => '0');
    signal got : std_logic_vector({got} downto 0);
begin
    dut : entity work.{name} port map ({connections});

    process
        file stimulus : text open read_mode is \"stimulus.txt\";
        file expected : text open read_mode is \"expected.txt\";
{middle_file}        variable row : line;
        variable given_row : bit_vector(given'range);
        variable want_row : bit_vector(got'range);
        variable want : std_logic_vector(got'range);
    begin
        for cycle in 0 to {last} loop
{fall}            readline(stimulus, row);
            read(row, given_row);
            given <= to_stdlogicvector(given_row);
            readline(expected, row);
            read(row, want_row);
            want := to_stdlogicvector(want_row);
            wait for 5 ns;
{checks}            clk <= '1';
            wait for 5 ns;
{end}        end loop;
        write(row, string'(\"PASS\"));
        writeline(output, row);
        wait;
    end process;
end architecture;
",
        given = total(&inputs) - 1,
        got = total(&expected.outputs) - 1,
        name = emitted_name(&top.name),
        connections = connections.join(", "),
        last = count - 1,
    )
}
