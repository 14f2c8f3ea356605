//! Fate of the frames of a channel.

use crate::{
    bench::ChannelResult,
    campaign::{Case, Traces},
    encoder::FrameLog,
    line::Sample,
    Time, US,
};
use endat_hdl::endat::transaction::cause;

/// Fate of a frame; later ones are worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// The position is the encoder's, and the encoder received exactly its pulses.
    Good,
    /// Rejected for a reason other than the following ones, or without a result.
    Refused,
    /// No start bit, or one outside its window.
    Start,
    /// The CRC is wrong.
    Crc,
    /// A result, but not exactly the pulses that the encoder needs.
    Pulses,
    /// Reported as good, but with another position than the encoder's.
    Wrong,
}

impl Fate {
    /// All fates.
    pub const ALL: [Self; 6] = [
        Self::Good,
        Self::Refused,
        Self::Start,
        Self::Crc,
        Self::Pulses,
        Self::Wrong,
    ];

    /// Name in tables.
    pub const fn column(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Refused => "refused",
            Self::Start => "start_bit",
            Self::Crc => "crc",
            Self::Pulses => "pulse_count",
            Self::Wrong => "silently_wrong",
        }
    }

    /// Readable name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Refused => "refused for another reason",
            Self::Start => "start bit: none, or outside its window",
            Self::Crc => "CRC error",
            Self::Pulses => "wrong number of clock pulses",
            Self::Wrong => "silently wrong position",
        }
    }

    /// Letter in maps.
    pub const fn letter(self) -> char {
        match self {
            Self::Good => '.',
            Self::Refused => 'R',
            Self::Start => 'S',
            Self::Crc => 'C',
            Self::Pulses => 'P',
            Self::Wrong => 'W',
        }
    }
}

/// Counts of fates, and the smallest margin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    counts: [usize; Fate::ALL.len()],
    margin: Option<f64>,
}

impl Tally {
    /// Number of frames with this fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.counts[fate as usize]
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The worst fate of a frame.
    pub fn fate(&self) -> Fate {
        let worst = Fate::ALL.iter().rev().find(|fate| self.count(**fate) > 0);
        worst.copied().unwrap_or(Fate::Refused)
    }

    /// The smallest distance of a sample from a DATA edge, as a part of the bit: at most 0.5. Good frames only.
    pub fn margin(&self) -> Option<f64> {
        self.margin.filter(|_| self.fate() == Fate::Good)
    }

    /// Adds another tally.
    pub fn add(&mut self, other: &Self) {
        for (sum, count) in self.counts.iter_mut().zip(other.counts) {
            *sum += count;
        }
        self.margin = match (self.margin, other.margin) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }
}

/// Counts the frames of a case, except those that measure the delay, which have another clock.
pub(super) fn judge(case: &Case, traces: &Traces<'_>) -> Tally {
    let mut tally = Tally::default();
    let first = case.calibration_frames();
    for (index, result) in traces.results.iter().enumerate().skip(first) {
        let before = index.checked_sub(1).map_or(0, |i| traces.results[i].time);
        let frames = traces.frames.iter();
        let frames = frames.filter(|f| (before..result.time).contains(&f.first_fall));
        tally.counts[fate(result, frames) as usize] += 1;
    }
    // Results that did not arrive.
    let missing = case.frames.saturating_sub(traces.results.len().max(first));
    tally.counts[Fate::Refused as usize] += missing;
    let period = (case.settings.period_cycles * 1_000_000 * US) as f64 / case.system_hz as f64;
    let from = match first.checked_sub(1) {
        Some(last) => traces.results.get(last).map_or(Time::MAX, |r| r.time),
        None => 0,
    };
    let distance = |s: &Sample| Some(s.since.min(s.until?));
    let bits = (traces.samples.iter()).filter(|s| s.time > from && s.answer_bit().is_some());
    let narrowest = bits.filter_map(distance).min();
    tally.margin = narrowest.map(|d| d as f64 / period);
    tally
}

/// `frames` are the encoder's frames for this result: additional pulses may form a second one.
fn fate<'f>(result: &ChannelResult, frames: impl Iterator<Item = &'f FrameLog>) -> Fate {
    match result.last_cause() {
        cause::NONE => {
            let mut frames: Vec<&FrameLog> = frames.collect();
            // A frame that measures the delay comes before that of the position.
            if let Some(last) = frames.last().copied() {
                frames.retain(|f| !f.measures_for(last));
            }
            match frames.iter().find(|f| f.position == result.position) {
                None => Fate::Wrong,
                Some(frame) if frames.len() == 1 && frame.is_whole() => Fate::Good,
                Some(_) => Fate::Pulses,
            }
        }
        cause::CRC => Fate::Crc,
        cause::NO_START_BIT | cause::START_WINDOW => Fate::Start,
        // The encoder is still sending, or has stopped early: not exactly its pulses.
        cause::DATA_NOT_FALLING => Fate::Pulses,
        _ => Fate::Refused,
    }
}
