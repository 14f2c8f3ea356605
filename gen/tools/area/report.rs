//! The figures side by side with those of others, measured with the same tools.

use super::{speed, subjects, synthesise, version, Device, Speed, Usage, DEVICES, ICE40, XC6S};
use super::{YOSYS, YOSYS_VERSION};
use endat_console::error::CommandError;
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// Somebody else's receiver on the same tools: position only, no CRC check, no propagation delay compensation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peer {
    /// What it is.
    pub name: &'static str,
    /// On xc6s.
    pub xc6s: Usage,
    /// Median on the HX8K, in MHz.
    pub hx8k_mhz: Option<f64>,
    /// Median on the ECP5-25F -6, in MHz.
    pub ecp5_mhz: Option<f64>,
}

/// Receivers to compare a channel with.
pub const PEERS: [Peer; 3] = [
    Peer {
        name: "public VHDL receiver (32 bits, position only, no CRC check, no delay compensation)",
        xc6s: Usage { lut: 561, ff: 153 },
        hx8k_mhz: Some(120.5),
        ecp5_mhz: Some(155.1),
    },
    Peer {
        name: "its bare engine, alignment of the word stripped",
        xc6s: Usage { lut: 168, ff: 174 },
        hx8k_mhz: Some(140.7),
        ecp5_mhz: Some(160.2),
    },
    Peer {
        name: "naive 48-bit prototype with CRC and start phase",
        xc6s: Usage { lut: 246, ff: 168 },
        hx8k_mhz: None,
        ecp5_mhz: None,
    },
];

/// One subject.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Its name.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// On xc6s.
    pub xc6s: Usage,
    /// On ice40.
    pub ice40: Usage,
    /// On each device; empty unless asked for.
    pub speed: Vec<Speed>,
}

/// All figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Tool and version.
    pub tool: String,
    /// Subjects.
    pub lines: Vec<Line>,
    /// Receivers to compare a channel with.
    pub peers: [Peer; 3],
}

/// How much is measured.
pub struct Scope<'a> {
    /// Names of the subjects; all if empty.
    pub only: &'a [String],
    /// Card and channel are also placed and routed.
    pub with_speed: bool,
    /// Their worst paths are located, too.
    pub with_path: bool,
    /// Folder in which the files of the tools remain.
    pub out: Option<&'a Path>,
}

/// Measures area, and speed where it is asked for.
pub fn report(scope: &Scope, progress: &dyn Fn(&str)) -> Result<Report, CommandError> {
    let Scope {
        only,
        with_speed,
        with_path,
        out,
    } = *scope;
    let version = version()?;
    if !version.starts_with(YOSYS_VERSION) {
        return Err(CommandError::input(format!(
            "{YOSYS} = {version:?}: figures are made with {YOSYS_VERSION} and differ between versions; `pip install {YOSYS}==0.70.0.0.post1259`"
        )));
    }
    let mut subjects = subjects()?;
    for name in only {
        if !subjects.iter().any(|subject| subject.name == name) {
            let names: Vec<_> = subjects.iter().map(|subject| subject.name).collect();
            return Err(CommandError::input(format!(
                "--only = {}: nothing of that name is measured; one or more of: {}",
                endat_console::error::shown(name),
                names.join(", ")
            )));
        }
    }
    subjects.retain(|subject| only.is_empty() || only.iter().any(|name| name == subject.name));
    let scratch = crate::scratch::folder()?;
    let mut lines = vec![];
    for subject in subjects {
        progress(subject.name);
        let files = subject.files();
        let folder = out.unwrap_or(scratch.path()).join(subject.name);
        let usage = |family| synthesise(&folder, &files, subject.name, family).map(|s| s.usage);
        let measure = |device: &Device| speed(&folder, &subject.design, &files, device, with_path);
        let fast = with_speed && ["card", "channel"].contains(&subject.name);
        let devices = DEVICES.iter().filter(|_| fast);
        lines.push(Line {
            name: subject.name,
            title: subject.title,
            xc6s: usage(&XC6S)?,
            ice40: usage(&ICE40)?,
            speed: devices.map(measure).collect::<Result<_, _>>()?,
        });
    }
    Ok(Report {
        tool: format!("{YOSYS}, {}", short(&version)),
        lines,
        peers: PEERS,
    })
}

/// Name and number of a version, without what stands in brackets.
fn short(version: &str) -> &str {
    version.split(" (").next().unwrap_or(version)
}

/// One number for another, as people say it.
fn ratio(ours: u64, theirs: u64) -> String {
    format!("{:.2}", ours as f64 / theirs as f64)
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}; {}; {}", self.tool, XC6S.synth, ICE40.synth)?;
        writeln!(
            f,
            "\n{:<15} {:>8} {:>8} {:>9} {:>8}",
            "", "xc6s LUT", "xc6s FF", "ice40 LUT", "ice40 FF"
        )?;
        for line in &self.lines {
            let (s6, ice) = (line.xc6s, line.ice40);
            writeln!(
                f,
                "{:<15} {:>8} {:>8} {:>9} {:>8}  {}",
                line.name, s6.lut, s6.ff, ice.lut, ice.ff, line.title
            )?;
        }
        for line in &self.lines {
            for s in &line.speed {
                writeln!(
                    f,
                    "{:<15} {:<12} median of {} seeds {:.1} MHz ({:.1}..{:.1})",
                    line.name,
                    s.device,
                    speed::SEEDS.len(),
                    s.median_mhz,
                    s.min_mhz,
                    s.max_mhz
                )?;
                if let Some(path) = &s.path {
                    write!(f, "{path}")?;
                }
            }
        }
        let Some(channel) = self.lines.iter().find(|l| l.name == "channel") else {
            return Ok(());
        };
        writeln!(
            f,
            "\none channel beside others on the same tools (ratio = channel / other):"
        )?;
        for peer in &self.peers {
            write!(
                f,
                "  LUT {:>3} ratio {}  FF {:>3} ratio {}",
                peer.xc6s.lut,
                ratio(channel.xc6s.lut, peer.xc6s.lut),
                peer.xc6s.ff,
                ratio(channel.xc6s.ff, peer.xc6s.ff)
            )?;
            let theirs = [peer.hx8k_mhz, peer.ecp5_mhz];
            for (speed, theirs) in channel.speed.iter().zip(theirs) {
                if let Some(theirs) = theirs {
                    let ratio = speed.median_mhz / theirs;
                    write!(f, "  {} {theirs:.1} MHz ratio {ratio:.2}", speed.device)?;
                }
            }
            writeln!(f, "  {}", peer.name)?;
        }
        Ok(())
    }
}
