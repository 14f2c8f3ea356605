//! A recorded DATA line divided into pieces with driver, level and meaning.

mod places;

pub use places::first_falls;

use crate::{
    bench::{Link, LinkTrace},
    encoder::{Drive, FrameLog, Output, Symbol},
    frame::Field,
    line::{End, Who},
    Time,
};
use places::{frame_at, Places};

/// Level of a line with several drivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// LOW.
    Low,
    /// HIGH.
    High,
    /// Undriven.
    Floating,
    /// Driven by both ends.
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

/// Driver of DATA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// The receiver.
    Receiver,
    /// The encoder.
    Encoder,
    /// None.
    Nobody,
    /// Both.
    Both,
}

impl By {
    /// Name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Receiver => "receiver",
            Self::Encoder => "encoder",
            Self::Nobody => "nobody",
            Self::Both => "BOTH",
        }
    }
}

/// Meaning of a piece of DATA.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// LOW between frames.
    Idle,
    /// Undriven, or driven by the wrong end.
    Turnaround,
    /// Receiver's LOW before the mode command.
    LeadIn,
    /// Bit of the mode command, 5 = first sent.
    Command(u32),
    /// Field sent by the receiver after an EnDat 2.1 command.
    Parameter(Field),
    /// Encoder's LOW before the start bit.
    Wait,
    /// Bit of an answer, 0 = start bit, and the bit's name.
    Answer(u32, Field),
    /// CLOCK is LOW before a supplement.
    Pause,
    /// LOW bit before the start bit of a supplement, 1 = first sent.
    SupplementZero(u32),
    /// Field sent by the receiver after an EnDat 2.2 answer.
    Supplement(Field),
    /// Encoder's LOW after a supplement.
    LeadOut,
    /// HIGH for the recovery time.
    Recovery,
    /// No encoder.
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
            Self::Answer(_, field) | Self::Parameter(field) | Self::Supplement(field) => {
                write!(f, "{field}")
            }
            Self::Pause => f.write_str("pause"),
            Self::SupplementZero(_) => f.write_str("0"),
            Self::LeadOut => f.write_str("lead-out"),
            Self::Recovery => f.write_str("recovery"),
            Self::Absent => f.write_str("absent"),
            Self::Glitch => f.write_str("glitch"),
        }
    }
}

/// A piece of DATA without change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Start.
    pub from: Time,
    /// End; for the last piece the end of the recording.
    pub until: Time,
    /// Level.
    pub level: Level,
    /// Driver.
    pub by: By,
    /// Meaning.
    pub meaning: Meaning,
}

/// Divides DATA of a recorded link into pieces, as seen at one end, up to `until`.
pub fn data_segments(link: &Link, end: End, until: Time) -> Vec<Segment> {
    let Some(trace) = link.trace() else {
        return Vec::new();
    };
    let frames = link.encoder().frames();
    let changes = match end {
        End::Receiver => {
            let config = link.line().config();
            receiver_end(trace, frames, config.flight() + config.clock.transceivers)
        }
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

/// `flight` is the delay of CLOCK to the encoder.
fn receiver_end(trace: &LinkTrace, frames: &[FrameLog], flight: Time) -> Vec<Segment> {
    let mut places = Places::new(&trace.clock_at_receiver, frames, flight);
    let piece = |c: &crate::line::DataChange| {
        let (by, meaning) = match c.who {
            Who::Nobody => (By::Nobody, places.at(c.time).nobody()),
            Who::Receiver => (By::Receiver, places.at(c.time).receiver()),
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
    let places = Places::new(&trace.clock_at_receiver, frames, flight);
    split_at_falls(&mut pieces, &trace.clock_at_receiver, places);
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
    let mut places = Places::new(&trace.clock_at_encoder, frames, 0);
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
                ) => (Level::Floating, By::Nobody, places.at(time).nobody()),
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
                    places.at(time).receiver(),
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
    let places = Places::new(&trace.clock_at_encoder, frames, 0);
    split_at_falls(&mut pieces, &trace.clock_at_encoder, places);
    pieces
}

/// The receiver's bits are not marked: the falling edges that launch them separate equal neighbours.
fn split_at_falls(pieces: &mut Vec<Segment>, clock: &[(Time, bool)], mut places: Places<'_>) {
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
                let meaning = places.at(t).receiver();
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

fn encoder_meaning(symbol: Symbol, time: Time, frames: &[FrameLog]) -> Meaning {
    match symbol {
        Symbol::Idle => Meaning::Idle,
        Symbol::Listening => Meaning::Turnaround,
        Symbol::Lead => match frame_at(frames, time) {
            Some(f) if f.start_edge.is_some() && time > f.start_time => Meaning::LeadOut,
            _ => Meaning::Wait,
        },
        Symbol::Tail => Meaning::Recovery,
        Symbol::Absent => Meaning::Absent,
        Symbol::Bit(i) => {
            let field = frame_at(frames, time);
            let field = field.map_or(Field::None, |f| f.field(u32::from(i)));
            Meaning::Answer(u32::from(i), field)
        }
    }
}

fn value_at<T: Copy>(track: &[(Time, T)], time: Time) -> Option<T> {
    let next = track.partition_point(|c| c.0 <= time);
    next.checked_sub(1).map(|i| track[i].1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::US;

    #[test]
    fn low_behind_an_answer_is_not_the_wait_for_it() {
        let frame = FrameLog {
            first_fall: US,
            start_edge: Some(13),
            start_time: 6 * US,
            ..FrameLog::default()
        };
        let at = |time| encoder_meaning(Symbol::Lead, time, std::slice::from_ref(&frame));
        assert_eq!(at(5 * US), Meaning::Wait);
        assert_eq!(at(20 * US), Meaning::LeadOut);
    }
}
