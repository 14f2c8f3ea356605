//! Temporary faults of the DATA pair.

use crate::{encoder::Drive, rng::Rng, Time, NS};

/// A fault of the DATA pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaultKind {
    /// Both ends read LOW.
    StuckLow,
    /// Both ends read HIGH.
    StuckHigh,
    /// Cut: each end receives its own driver, or its fail-safe bias, which is HIGH.
    Open,
    /// The wires of the pair touch: without a voltage between them, fail-safe receivers read HIGH, even with the driver on.
    Short,
    /// The wires of the pair are swapped: all levels arrive inverted.
    Swapped,
    /// DATA has the level of CLOCK.
    ToClock,
    /// Any level at any time at the receiver.
    Noise,
    /// Short pulses at the receiver.
    Glitches,
    /// The plug is off: the encoder has no supply, and the receiver reads its bias, HIGH.
    PlugHigh,
    /// The plug is off, with a LOW bias.
    PlugLow,
}

impl FaultKind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::StuckLow,
        Self::StuckHigh,
        Self::Open,
        Self::Short,
        Self::Swapped,
        Self::ToClock,
        Self::Noise,
        Self::Glitches,
        Self::PlugHigh,
        Self::PlugLow,
    ];

    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::StuckLow => "stuck_low",
            Self::StuckHigh => "stuck_high",
            Self::Open => "open",
            Self::Short => "short",
            Self::Swapped => "swapped",
            Self::ToClock => "data_to_clock",
            Self::Noise => "noise",
            Self::Glitches => "glitches",
            Self::PlugHigh => "plug_off_bias_high",
            Self::PlugLow => "plug_off_bias_low",
        }
    }

    /// True if the encoder is off as well.
    pub fn is_plug(self) -> bool {
        matches!(self, Self::PlugHigh | Self::PlugLow)
    }

    /// Mean, shortest and longest time between level changes of random faults.
    fn pulses(self) -> Option<(Time, Time, Time)> {
        match self {
            // A level holds for part of a bit, at any rate.
            Self::Noise => Some((100 * NS, 20 * NS, 400 * NS)),
            Self::Glitches => Some((800 * NS, 40 * NS, 200 * NS)),
            _ => None,
        }
    }
}

/// A temporary fault.
#[derive(Clone, Debug)]
pub struct LineFault {
    kind: FaultKind,
    from: Time,
    until: Time,
    rng: Rng,
    is_on: bool,
    /// State of the random pulse, and the time of its next change.
    is_pulse: bool,
    toggle: Time,
}

impl LineFault {
    /// A fault from `from` to `until`.
    pub fn new(kind: FaultKind, from: Time, until: Time, seed: u64) -> Self {
        Self {
            kind,
            from,
            until,
            rng: Rng::new(seed),
            is_on: false,
            is_pulse: false,
            toggle: Time::MAX,
        }
    }

    /// Time of its next change.
    pub(super) fn next_event(&self) -> Time {
        match self.is_on {
            true => self.until.min(self.toggle),
            false => self.from,
        }
    }

    /// Starts, ends or changes it. Returns whether something changed, and whether it is over.
    pub(super) fn advance(&mut self, time: Time) -> (bool, bool) {
        if self.next_event() > time {
            return (false, false);
        }
        if !self.is_on {
            self.is_on = true;
            self.plan(time);
        } else if self.until <= time {
            return (true, true);
        } else {
            self.is_pulse = !self.is_pulse;
            self.plan(time);
        }
        (true, false)
    }

    fn plan(&mut self, now: Time) {
        let Some((gap, shortest, longest)) = self.kind.pulses() else {
            return;
        };
        let wait = match self.is_pulse || self.kind == FaultKind::Noise {
            true => self.rng.in_range(shortest, longest),
            false => self.rng.in_range(gap / 8, 2 * gap),
        };
        self.toggle = now + wait;
    }

    /// DATA at the receiver's pin: `level` is the arriving level, `own` the receiver's drive, `clock` the level of CLOCK there.
    pub(super) fn at_receiver(&self, level: bool, own: Drive, clock: bool) -> bool {
        if !self.is_on {
            return level;
        }
        let or_own = |bias: bool| match own {
            Drive::Released => bias,
            drive => drive == Drive::High,
        };
        match self.kind {
            FaultKind::StuckLow => false,
            FaultKind::StuckHigh | FaultKind::Short => true,
            FaultKind::Open | FaultKind::PlugHigh => or_own(true),
            FaultKind::PlugLow => or_own(false),
            FaultKind::Swapped => match own {
                Drive::Released => !level,
                _ => level,
            },
            FaultKind::ToClock => clock,
            FaultKind::Noise | FaultKind::Glitches => level ^ self.is_pulse,
        }
    }

    /// The receiver's drive as it arrives at the encoder; `clock` is the level of CLOCK there.
    pub(super) fn at_encoder(&self, drive: Drive, clock: bool) -> Drive {
        if !self.is_on {
            return drive;
        }
        match (self.kind, drive) {
            (FaultKind::StuckLow, _) => Drive::Low,
            (FaultKind::StuckHigh | FaultKind::Short, _) => Drive::High,
            (FaultKind::Open | FaultKind::PlugHigh | FaultKind::PlugLow, _) => Drive::Released,
            (FaultKind::Swapped, Drive::Low) => Drive::High,
            (FaultKind::Swapped, Drive::High) => Drive::Low,
            (FaultKind::ToClock, _) => Drive::level(clock),
            (_, drive) => drive,
        }
    }
}
