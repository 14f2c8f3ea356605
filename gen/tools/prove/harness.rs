//! The module around what is proved: every input may be anything in every cycle.

use endat_console::artifact::Artifact;
use rtl_design::elaborate::{Direction, Module};
use rtl_design::verilog::emitted_name;

/// Its name, and that of its file.
pub(super) const TOP: &str = "proof";

/// The harness of a module. Without start values it begins with a reset.
pub(super) fn artifact(module: &Module, has_initial_values: bool) -> Artifact {
    let (mut inputs, mut connections) = (vec![], vec![]);
    for port in &module.ports {
        let net = &module.nets[port.net];
        let name = emitted_name(&net.name);
        if port.direction == Direction::Output {
            continue;
        }
        connections.push(format!(".{name}({name})"));
        if !port.is_clock {
            let top = net.width_bits - 1;
            inputs.push(format!("    (* anyseq *) reg [{top}:0] {name};\n"));
        }
    }
    let begin = match has_initial_values {
        true => "",
        false => {
            "    reg f_first; initial f_first = 1'b1;
    always @(posedge clock) f_first <= 1'b0;
    always @* assume (!f_first | reset);
"
        }
    };
    let text = format!(
        "module {TOP} (input wire clock);\n{}    {} u ({});\n{begin}endmodule\n",
        inputs.concat(),
        module.name,
        connections.join(", ")
    );
    Artifact::new(format!("{TOP}.sv"), text)
}
