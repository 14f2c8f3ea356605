//! A recorded DATA line cut into pieces: who drove it, to which level, and what it meant.

use crate::{
    bench::{Link, LinkTrace},
    encoder::{Drive, FrameLog, Output, Symbol},
    line::{End, Who},
    Time,
};

/// Level of a line with several drivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// LOW.
    Low,
    /// HIGH.
    High,
    /// Nobody drives it.
    Floating,
    /// Two drive it.
    Conflict,
}

impl Level {
    /// A driven level.
    pub fn driven(high: bool) -> Self {
        if high {
            Self::High
        } else {
            Self::Low
        }
    }
}

/// Who drives DATA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The receiver.
    Receiver,
    /// The encoder.
    Encoder,
    /// Nobody.
    Nobody,
    /// Both.
    Both,
}

impl By {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Receiver => "receiver",
            Self::Encoder => "encoder",
            Self::Nobody => "nobody",
            Self::Both => "BOTH",
        }
    }
}

/// What a piece of DATA means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// LOW between frames.
    Idle,
    /// Nobody's turn, or not the one whose turn it is.
    Turnaround,
    /// Receiver's LOW before the mode command.
    LeadIn,
    /// Bit of the mode command, 5 = first sent.
    Command(u32),
    /// Encoder's LOW before the start bit.
    Wait,
    /// Bit of an answer, 0 = start bit, and the bit's name.
    Answer(u32, crate::frame::Field),
    /// HIGH for the recovery time.
    Recovery,
    /// An encoder that is not there.
    Absent,
    /// The level is a glitch.
    Glitch,
}

impl std::fmt::Display for Meaning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Idle => f.write_str("idle"),
            Self::Turnaround => f.write_str("turnaround"),
            Self::LeadIn => f.write_str("lead-in"),
            Self::Command(i) => write!(f, "M{i}"),
            Self::Wait => f.write_str("wait"),
            Self::Answer(_, field) => write!(f, "{field}"),
            Self::Recovery => f.write_str("recovery"),
            Self::Absent => f.write_str("absent"),
            Self::Glitch => f.write_str("glitch"),
        }
    }
}

/// A piece of DATA without change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Its begin.
    pub from: Time,
    /// Its end; for the last one the end of the record.
    pub until: Time,
    /// Its level.
    pub level: Level,
    /// Who drives it.
    pub by: By,
    /// What it means.
    pub meaning: Meaning,
}

/// Cuts DATA of a recorded link into pieces, as seen at one end, up to `until`.
pub fn data_segments(link: &Link, end: End, until: Time) -> Vec<Segment> {
    let Some(trace) = link.trace() else {
        return Vec::new();
    };
    let frames = link.encoder().frames();
    let changes = match end {
        End::Receiver => receiver_end(trace, frames),
        End::Encoder => encoder_end(trace, frames),
    };
    let ends: Vec<Time> = changes
        .iter()
        .skip(1)
        .map(|c| c.from)
        .chain([until])
        .collect();
    let mut segments: Vec<Segment> = Vec::new();
    for (mut piece, end) in changes.into_iter().zip(ends) {
        piece.until = end;
        if end <= piece.from {
            continue;
        }
        match segments.last_mut() {
            Some(last)
                if (last.level, last.by, last.meaning)
                    == (piece.level, piece.by, piece.meaning) =>
            {
                last.until = end;
            }
            _ => segments.push(piece),
        }
    }
    segments
}

fn receiver_end(trace: &LinkTrace, frames: &[FrameLog]) -> Vec<Segment> {
    let mut clock = FallCounter::new(&trace.clock_at_receiver);
    let piece = |c: &crate::line::DataChange| {
        let (by, meaning) = match c.who {
            Who::Nobody => (By::Nobody, Meaning::Turnaround),
            Who::Receiver => (By::Receiver, receiver_meaning(clock.at(c.time))),
            Who::Encoder(s) => (By::Encoder, encoder_meaning(s, c.time, frames)),
            Who::Both => (By::Both, Meaning::Turnaround),
        };
        let level = match by {
            By::Nobody if !c.glitch => Level::Floating,
            By::Both => Level::Conflict,
            _ => Level::driven(c.level),
        };
        Segment {
            from: c.time,
            until: c.time,
            level,
            by,
            meaning: if c.glitch { Meaning::Glitch } else { meaning },
        }
    };
    let mut pieces: Vec<Segment> = trace.data_at_receiver.iter().map(piece).collect();
    let mut clock = FallCounter::new(&trace.clock_at_receiver);
    split_at_falls(&mut pieces, &trace.clock_at_receiver, |t| clock.at(t));
    pieces
}

fn encoder_end(trace: &LinkTrace, frames: &[FrameLog]) -> Vec<Segment> {
    let times = trace.encoder.iter().map(|c| c.0);
    let mut times: Vec<Time> = times
        .chain(trace.receiver_at_encoder.iter().map(|c| c.0))
        .collect();
    times.sort_unstable();
    times.dedup();
    let at = |time| {
        let output = value_at(&trace.encoder, time);
        let receiver = value_at(&trace.receiver_at_encoder, time).unwrap_or(Drive::Released);
        (output, receiver)
    };
    let mut clock = FallCounter::new(&trace.clock_at_encoder);
    let mut pieces: Vec<Segment> = times
        .into_iter()
        .map(|time| {
            let (output, receiver) = at(time);
            let (level, by, meaning) = match (output, receiver) {
                (
                    Some(Output {
                        drive: Drive::Released,
                        ..
                    })
                    | None,
                    Drive::Released,
                ) => (Level::Floating, By::Nobody, Meaning::Turnaround),
                (
                    Some(Output {
                        drive: Drive::Released,
                        ..
                    })
                    | None,
                    r,
                ) => (
                    Level::driven(r == Drive::High),
                    By::Receiver,
                    receiver_meaning(clock.at(time)),
                ),
                (Some(o), Drive::Released) => (
                    Level::driven(o.drive == Drive::High),
                    By::Encoder,
                    encoder_meaning(o.symbol, time, frames),
                ),
                _ => (Level::Conflict, By::Both, Meaning::Turnaround),
            };
            Segment {
                from: time,
                until: time,
                level,
                by,
                meaning,
            }
        })
        .collect();
    let mut clock = FallCounter::new(&trace.clock_at_encoder);
    split_at_falls(&mut pieces, &trace.clock_at_encoder, |t| clock.at(t));
    pieces
}

/// The receiver's bits have no marks of their own: equal neighbours are told apart by the falling edges that launch them.
fn split_at_falls(
    pieces: &mut Vec<Segment>,
    clock: &[(Time, bool)],
    mut falls_at: impl FnMut(Time) -> u32,
) {
    let mut split = Vec::new();
    let ends: Vec<Time> = pieces
        .iter()
        .skip(1)
        .map(|p| p.from)
        .chain([Time::MAX])
        .collect();
    let mut falls = clock.iter().filter(|c| !c.1).map(|c| c.0).peekable();
    for (piece, end) in pieces.iter().zip(ends) {
        split.push(*piece);
        while falls.next_if(|t| *t <= piece.from).is_some() {}
        while let Some(t) = falls.next_if(|t| *t < end) {
            if piece.by == By::Receiver {
                let meaning = receiver_meaning(falls_at(t));
                split.push(Segment {
                    from: t,
                    meaning,
                    ..*piece
                });
            }
        }
    }
    *pieces = split;
}

fn receiver_meaning(falls: u32) -> Meaning {
    match falls {
        3..=8 => Meaning::Command(8 - falls),
        0..=2 => Meaning::LeadIn,
        _ => Meaning::Turnaround,
    }
}

fn encoder_meaning(symbol: Symbol, time: Time, frames: &[FrameLog]) -> Meaning {
    match symbol {
        Symbol::Idle => Meaning::Idle,
        Symbol::Listening => Meaning::Turnaround,
        Symbol::Lead => Meaning::Wait,
        Symbol::Tail => Meaning::Recovery,
        Symbol::Absent => Meaning::Absent,
        Symbol::Bit(i) => {
            let next = frames.partition_point(|f| f.first_fall <= time);
            let field = match next.checked_sub(1) {
                Some(n) => frames[n].field(u32::from(i)),
                None => crate::frame::Field::None,
            };
            Meaning::Answer(u32::from(i), field)
        }
    }
}

fn value_at<T: Copy>(track: &[(Time, T)], time: Time) -> Option<T> {
    let next = track.partition_point(|c| c.0 <= time);
    next.checked_sub(1).map(|i| track[i].1)
}

/// The first falling edge of each frame on a recorded clock.
pub fn first_falls(clock: &[(Time, bool)]) -> Vec<Time> {
    let mut counter = FallCounter::new(clock);
    let falls = clock.iter().filter(|c| !c.1);
    falls
        .filter(|c| counter.at(c.0) == 1)
        .map(|c| c.0)
        .collect()
}

/// Counts the falling clock edges of a frame, for moments in ascending order.
struct FallCounter<'a> {
    clock: &'a [(Time, bool)],
    next_edge: usize,
    last_edge: Time,
    last_low: Time,
    falls: u32,
}

/// A clock that has been HIGH for longer than this, and for longer than it was LOW before, has ended its frame.
const FRAME_GAP: Time = crate::US;

impl<'a> FallCounter<'a> {
    fn new(clock: &'a [(Time, bool)]) -> Self {
        Self {
            clock,
            next_edge: 0,
            last_edge: 0,
            last_low: 0,
            falls: 0,
        }
    }

    fn at(&mut self, time: Time) -> u32 {
        while let Some((t, level)) = self.clock.get(self.next_edge).filter(|c| c.0 <= time) {
            let width = *t - self.last_edge;
            if *level {
                self.last_low = width;
            } else if width > FRAME_GAP.max(self.last_low * 3 / 2) {
                self.falls = 1;
            } else {
                self.falls += 1;
            }
            self.last_edge = *t;
            self.next_edge += 1;
        }
        self.falls
    }
}
