//! Waveform files of a bench: VCD for any viewer, and a GTKWave layout that opens with the signals grouped.

use crate::{
    bench::{Bench, Link, OtherEncoder},
    line::End,
    segments::{data_segments, By, Level, Segment},
    Time, NS,
};
use rtl_design::engine::Engine;
use std::{
    fmt::Write as _,
    io::{self, Write},
};
use vcd::{IdCode, TimescaleUnit, Value, VarType};

/// Value of a signal.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Held {
    Level(Level),
    Number(u128),
    Text(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Bit,
    Number(u32),
    Text,
}

struct Signal {
    name: String,
    kind: Kind,
    changes: Vec<(Time, Held)>,
}

struct Group {
    name: String,
    signals: Vec<Signal>,
}

/// The signals of a bench, with all their changes.
pub struct Wave {
    groups: Vec<Group>,
    end: Time,
    /// The first frame, to which the viewer scrolls.
    focus: Option<(Time, Time)>,
}

/// Program name in the waveforms.
const PROGRAM: &str = "endat-sim";
/// Start of a layout.
const LAYOUT_HEAD: &str = "[*] GTKWave layout, written with the waveform";

/// True if a file with this start may be a waveform of this program.
pub fn is_vcd(head: &str) -> bool {
    head.split_whitespace().take(2).eq(["$version", PROGRAM])
}

/// True if a file with this start may be a layout of this program; one saved by GTKWave is not.
pub fn is_layout(head: &str) -> bool {
    head.starts_with(LAYOUT_HEAD)
}

/// CLOCK and DATA of a link at the encoder's end as two scalars, in nanoseconds, for logic analyser programs.
pub fn write_wires(link: &Link, out: impl Write) -> io::Result<()> {
    let (clock, data) = link.trace().map_or((&[][..], &[][..]), |t| {
        (&t.clock_at_encoder, &t.data_at_encoder)
    });
    // DATA of the same nanosecond is written before CLOCK.
    write_scalars(&[("data", data), ("clk", clock)], None, out)
}

/// The line of an encoder of another protocol, at its end, in the same format.
pub fn write_line(encoder: &dyn OtherEncoder, end: Time, out: impl Write) -> io::Result<()> {
    // The last bits of a reply may have no edge.
    write_scalars(&[("data", encoder.trace())], Some(end), out)
}

/// Named wires with their changes; changes in the same nanosecond keep this order.
fn write_scalars(
    wires: &[(&str, &[(Time, bool)])],
    end: Option<Time>,
    out: impl Write,
) -> io::Result<()> {
    let mut w = vcd::Writer::new(out);
    w.version(&format!("{PROGRAM} {}", env!("CARGO_PKG_VERSION")))?;
    w.timescale(1, TimescaleUnit::NS)?;
    w.add_module(TOP)?;
    let mut changes = vec![];
    for (name, wire) in wires {
        let id = w.add_wire(1, name)?;
        changes.extend(wire.iter().map(|(time, level)| (time / NS, id, *level)));
    }
    w.upscope()?;
    w.enddefinitions()?;
    changes.sort_by_key(|(time, ..)| *time);
    let mut now = None;
    for (time, id, level) in changes {
        if now != Some(time) {
            w.timestamp(time)?;
            now = Some(time);
        }
        w.change_scalar(id, level)?;
    }
    if let Some(end) = end {
        w.timestamp(end / NS)?;
    }
    Ok(())
}

/// Name of the outermost scope.
const TOP: &str = "bench";

impl Wave {
    /// All recordings of a bench: its links, and the watched ports of the design.
    pub fn of<E: Engine>(bench: &Bench<E>) -> Self {
        let end = bench.now();
        let mut groups: Vec<Group> = (0..bench.link_count())
            .map(|i| Group {
                name: format!("link{i}"),
                signals: link_signals(bench.link(i), end),
            })
            .collect();
        groups.extend(bench.others().enumerate().map(|(i, other)| {
            let line = other.trace().iter();
            let changes = line.map(|(t, level)| (*t, Held::Level(Level::driven(*level))));
            Group {
                name: format!("{}{i}", other.protocol().row().word),
                signals: vec![Signal {
                    name: "data".into(),
                    kind: Kind::Bit,
                    changes: changes.collect(),
                }],
            }
        }));
        if !bench.watched().is_empty() {
            let signals = bench.watched().iter().map(|w| {
                let kind = match w.width_bits() {
                    1 => Kind::Bit,
                    n => Kind::Number(n),
                };
                Signal {
                    name: w.name().into(),
                    kind,
                    changes: w
                        .changes()
                        .iter()
                        .map(|(t, v)| match kind {
                            Kind::Bit => (*t, Held::Level(Level::driven(*v != 0))),
                            _ => (*t, Held::Number(*v)),
                        })
                        .collect(),
                }
            });
            groups.push(Group {
                name: "design".into(),
                signals: signals.collect(),
            });
        }
        let frame = (0..bench.link_count()).find_map(|i| bench.frames(i).last());
        Self {
            groups,
            end,
            focus: frame.map(|f| (f.first_fall, f.data_fall.unwrap_or(f.last_rise))),
        }
    }

    /// Writes the VCD, with a time unit of one picosecond.
    pub fn write_vcd(&self, out: impl Write) -> io::Result<()> {
        let mut w = vcd::Writer::new(out);
        w.version(&format!("{PROGRAM} {}", env!("CARGO_PKG_VERSION")))?;
        w.timescale(1, TimescaleUnit::PS)?;
        w.add_module(TOP)?;
        let mut changes: Vec<(Time, IdCode, &Held, Kind)> = Vec::new();
        for group in &self.groups {
            w.add_module(&group.name)?;
            for signal in &group.signals {
                let id = match signal.kind {
                    Kind::Bit => w.add_wire(1, &signal.name)?,
                    Kind::Number(width) => w.add_wire(width, &signal.name)?,
                    Kind::Text => w.add_var(VarType::String, 1, &signal.name, None)?,
                };
                changes.extend(signal.changes.iter().map(|(t, v)| (*t, id, v, signal.kind)));
            }
            w.upscope()?;
        }
        w.upscope()?;
        w.enddefinitions()?;
        changes.sort_by_key(|c| c.0);
        let mut now = None;
        for (time, id, held, kind) in changes {
            if now != Some(time) {
                w.timestamp(time)?;
                now = Some(time);
            }
            match (held, kind) {
                (Held::Level(level), _) => w.change_scalar(id, scalar(*level))?,
                (Held::Number(n), Kind::Number(width)) => {
                    let bits = (0..width).rev().map(|i| Value::from(n >> i & 1 != 0));
                    w.change_vector(id, bits)?;
                }
                (Held::Number(n), _) => w.change_string(id, &n.to_string())?,
                (Held::Text(text), _) => w.change_string(id, &text.replace(' ', "_"))?,
            }
        }
        w.timestamp(self.end)?;
        w.flush()
    }

    /// A GTKWave layout for the VCD called `vcd_name`.
    pub fn gtkw(&self, vcd_name: &str) -> String {
        /// GTKWave's display flags: right-justified binary, hexadecimal and text; begin and end of a group.
        const BINARY: u32 = 0x28;
        const HEXADECIMAL: u32 = 0x22;
        const TEXT: u32 = 0x820;
        const GROUP_BEGIN: u32 = 0x80_0200;
        const GROUP_END: u32 = 0x100_0200;
        let mut s = String::new();
        let mut line = |text: std::fmt::Arguments<'_>| {
            let _ = writeln!(s, "{text}");
        };
        line(format_args!("{LAYOUT_HEAD}"));
        line(format_args!("[dumpfile] \"{vcd_name}\""));
        line(format_args!("[size] 1500 700"));
        line(format_args!("[pos] -1 -1"));
        let (from, until) = self.focus.unwrap_or((0, self.end));
        // GTKWave shows 2^zoom time units in a pixel.
        let zoom = ((until - from).max(1) as f64 * 1.1 / VIEW_PIXELS).log2();
        line(format_args!("*-{zoom:.3} {from} -1 -1 -1 -1 -1 -1 -1 -1"));
        line(format_args!(
            "[timestart] {}",
            from.saturating_sub((until - from) / 20)
        ));
        line(format_args!("[treeopen] {TOP}."));
        line(format_args!("[sst_expanded] 0"));
        line(format_args!("[signals_width] 190"));
        for group in &self.groups {
            line(format_args!("@{GROUP_BEGIN:x}\n-{}", group.name));
            for signal in &group.signals {
                let (flags, range) = match signal.kind {
                    Kind::Bit => (BINARY, String::new()),
                    Kind::Number(n) => (HEXADECIMAL, format!("[{}:0]", n - 1)),
                    Kind::Text => (TEXT, String::new()),
                };
                let path = format!("{TOP}.{}.{}{range}", group.name, signal.name);
                line(format_args!("@{flags:x}\n{path}"));
            }
            line(format_args!("@{GROUP_END:x}\n-{}", group.name));
        }
        s
    }
}

/// Width of the wave area in GTKWave's window.
const VIEW_PIXELS: f64 = 1200.0;

fn scalar(level: Level) -> Value {
    match level {
        Level::Low => Value::V0,
        Level::High => Value::V1,
        Level::Floating => Value::Z,
        Level::Conflict => Value::X,
    }
}

fn link_signals(link: &Link, end: Time) -> Vec<Signal> {
    let Some(trace) = link.trace() else {
        return Vec::new();
    };
    let bits = |name: &str, track: &[(Time, bool)]| Signal {
        name: name.into(),
        kind: Kind::Bit,
        changes: track
            .iter()
            .map(|(t, v)| (*t, Held::Level(Level::driven(*v))))
            .collect(),
    };
    let at_receiver = data_segments(link, End::Receiver, end);
    let at_encoder = data_segments(link, End::Encoder, end);
    let levels = |name: &str, segments: &[Segment]| Signal {
        name: name.into(),
        kind: Kind::Bit,
        changes: changes(segments, |s| Held::Level(s.level)),
    };
    let texts = |name: &str, segments: &[Segment], text: fn(&Segment) -> String| Signal {
        name: name.into(),
        kind: Kind::Text,
        changes: changes(segments, |s| Held::Text(text(s))),
    };
    let drives = |name: &str, who: By| Signal {
        name: name.into(),
        kind: Kind::Bit,
        changes: changes(&at_encoder, |s| {
            Held::Level(Level::driven(s.by == who || s.by == By::Both))
        }),
    };
    vec![
        bits("clock", &trace.clock_at_receiver),
        levels("data", &at_receiver),
        texts("driver", &at_receiver, |s| s.by.name().into()),
        texts("meaning", &at_receiver, |s| s.meaning.to_string()),
        bits("encoder_clock", &trace.clock_at_encoder),
        levels("encoder_data", &at_encoder),
        texts("encoder_meaning", &at_encoder, |s| s.meaning.to_string()),
        drives("encoder_hears_receiver", By::Receiver),
        drives("encoder_drives", By::Encoder),
    ]
}

/// One value for each piece, without repetitions.
fn changes(segments: &[Segment], value: impl Fn(&Segment) -> Held) -> Vec<(Time, Held)> {
    let mut out: Vec<(Time, Held)> = Vec::new();
    for s in segments {
        let v = value(s);
        if out.last().is_none_or(|last| last.1 != v) {
            out.push((s.from, v));
        }
    }
    out
}

#[cfg(test)]
mod tests;
