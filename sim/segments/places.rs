//! Position of a time in its frame, and the meaning of the receiver's output there.

use super::Meaning;
use crate::{
    encoder::FrameLog,
    frame::{parameter_field, Field},
    Time,
};

/// A time in its frame.
pub(super) struct Place<'a> {
    /// Falling clock edges so far.
    falls: u32,
    frame: Option<&'a FrameLog>,
}

/// Returns positions in frames for times in ascending order.
pub(super) struct Places<'a> {
    clock: FallCounter<'a>,
    frames: &'a [FrameLog],
    /// Delay of CLOCK to the encoder, whose frames these are.
    flight: Time,
}

impl<'a> Places<'a> {
    pub(super) fn new(clock: &'a [(Time, bool)], frames: &'a [FrameLog], flight: Time) -> Self {
        Self {
            clock: FallCounter::new(clock),
            frames,
            flight,
        }
    }

    pub(super) fn at(&mut self, time: Time) -> Place<'a> {
        Place {
            falls: self.clock.at(time),
            frame: frame_at(self.frames, time + self.flight),
        }
    }
}

impl Place<'_> {
    /// Meaning of the receiver's output.
    pub(super) fn receiver(&self) -> Meaning {
        match (self.falls, self.frame) {
            (0..=2, _) => Meaning::LeadIn,
            (3..=8, _) => Meaning::Command(8 - self.falls),
            (9..=32, Some(f)) if f.parameter.is_some() => {
                Meaning::Parameter(parameter_field(self.falls - 8))
            }
            _ => self.supplement().unwrap_or(Meaning::Turnaround),
        }
    }

    fn supplement(&self) -> Option<Meaning> {
        let frame = self.frame?;
        let sent = frame.supplement?;
        let bit = self.falls.checked_sub(pause_fall(frame)?);
        let bit = bit.filter(|n| *n > 0)?;
        Some(match bit.checked_sub(sent.zeros + 1) {
            None => Meaning::SupplementZero(bit),
            Some(0) => Meaning::Supplement(Field::Start),
            Some(n @ 1..=24) => Meaning::Supplement(parameter_field(n)),
            Some(n @ 25..=32) if sent.block.is_some() => Meaning::Supplement(Field::Block(32 - n)),
            Some(_) => Meaning::Turnaround,
        })
    }

    /// Meaning of an undriven line.
    pub(super) fn nobody(&self) -> Meaning {
        match self.frame.and_then(pause_fall) {
            Some(fall) if fall == self.falls => Meaning::Pause,
            _ => Meaning::Turnaround,
        }
    }
}

/// The falling edge that begins the pause before a supplement.
fn pause_fall(frame: &FrameLog) -> Option<u32> {
    let has_supplement = frame.supplement_edges > 0;
    frame
        .start_edge
        .filter(|_| has_supplement)
        .map(|s| s + frame.answer.len)
}

/// The frame at a time, at the encoder.
pub(super) fn frame_at(frames: &[FrameLog], time: Time) -> Option<&FrameLog> {
    let next = frames.partition_point(|f| f.first_fall <= time);
    next.checked_sub(1).map(|n| &frames[n])
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

/// Counts the falling clock edges of a frame, for times in ascending order.
struct FallCounter<'a> {
    clock: &'a [(Time, bool)],
    next_edge: usize,
    last_edge: Time,
    last_low: Time,
    falls: u32,
}

/// A clock that is HIGH for longer than this, and for longer than its previous LOW, has ended its frame.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{encoder::Supplement, NS};

    fn meanings(frame: &FrameLog, falls: std::ops::RangeInclusive<u32>) -> String {
        let place = |falls| Place {
            falls,
            frame: Some(frame),
        };
        let names: Vec<_> = falls.map(|n| place(n).receiver().to_string()).collect();
        names.join(" ")
    }

    const FIELDS: &str =
        "A7 A6 A5 A4 A3 A2 A1 A0 P15 P14 P13 P12 P11 P10 P9 P8 P7 P6 P5 P4 P3 P2 P1 P0";

    #[test]
    fn bits_after_the_mode_command_are_those_of_a_parameter_where_there_is_one() {
        let mut frame = FrameLog::default();
        assert_eq!(meanings(&frame, 7..=9), "M1 M0 turnaround");
        frame.parameter = Some(Default::default());
        let text = format!("M1 M0 {FIELDS} turnaround");
        assert_eq!(meanings(&frame, 7..=33), text);
    }

    #[test]
    fn a_supplement_is_counted_from_the_pause() {
        let mut frame = FrameLog {
            start_edge: Some(13),
            supplement_edges: 35,
            supplement: Some(Supplement {
                zeros: 7,
                ..Supplement::default()
            }),
            ..FrameLog::default()
        };
        frame.answer.len = 20;
        let nobody = |falls| {
            let frame = Some(&frame);
            Place { falls, frame }.nobody()
        };
        let before = [nobody(32), nobody(33), nobody(34)];
        let turn = Meaning::Turnaround;
        assert_eq!(before, [turn, Meaning::Pause, turn]);
        let text = format!("turnaround 0 0 0 0 0 0 0 S {FIELDS}");
        assert_eq!(meanings(&frame, 33..=65), text);
        assert_eq!(meanings(&frame, 66..=66), "turnaround");
        frame.supplement.as_mut().unwrap().block = Some(0);
        let block = "B7 B6 B5 B4 B3 B2 B1 B0 turnaround";
        assert_eq!(meanings(&frame, 66..=74), block);
    }

    /// Without tST the receiver sends its parameter before a distant encoder receives the first edge.
    #[test]
    fn the_receivers_frame_begins_before_the_encoders() {
        let frame = FrameLog {
            first_fall: 650 * NS,
            parameter: Some(Default::default()),
            ..FrameLog::default()
        };
        let edge = |n: u64| (n * 31 * NS, n % 2 == 1);
        let clock: Vec<_> = (0..60).map(edge).collect();
        let mut places = Places::new(&clock, std::slice::from_ref(&frame), 650 * NS);
        let ninth_fall = places.at(clock[16].0);
        assert_eq!(ninth_fall.receiver().to_string(), "A7");
    }
}
