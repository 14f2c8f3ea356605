//! Special bits of an SSI frame: kind and place of each bit that is not position.
//!
//! Ref: ams, AS5045 data sheet (12 bits of position, five status bits, even parity over all bits before it); MagnTek, MT6701 data sheet (14 bits of
//! position, four status bits, CRC of six bits, x^6 + x + 1, over the 18 bits before it, most significant bit first); maxon, EPOS4 firmware
//! specification (special bits before and after the position).

use super::cause;
use std::fmt;

/// Most special bits in a frame, before and after the position together: with 48 bits and their parity bit they fit a counter of 6 bits.
pub const SPECIALS_MAX: usize = 14;
/// Most special bits in a result.
pub const SHOWN_MAX: usize = 8;
/// Bits of a [`Special::Crc6`].
pub const CRC_BITS: usize = 6;
/// x^6 + x + 1 without its highest term.
pub const CRC_POLYNOMIAL: u64 = 0b00_0011;

/// A bit that is not position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Special {
    /// Not evaluated.
    #[default]
    Ignored,
    /// Shown with the result; does not affect the position.
    Shown,
    /// Alarm if 1.
    Alarm,
    /// Alarm if 0.
    NotAlarm,
    /// Power failure if 1.
    PowerFail,
    /// Power failure if 0.
    NotPowerFail,
    /// The position is not valid if 0.
    Valid,
    /// The position is not valid if 1.
    NotValid,
    /// Even number of ones in all bits up to here, including it.
    ParityEven,
    /// Odd number of ones in all bits up to here, including it.
    ParityOdd,
    /// Six bits: CRC of all bits before it.
    Crc6,
}

impl Special {
    /// All kinds, with name and meaning.
    pub const ALL: [(Self, &'static str, &'static str); 11] = [
        (Self::Ignored, "ignored", "not evaluated"),
        (Self::Shown, "shown", "shown with the result"),
        (Self::Alarm, "alarm", "alarm if 1"),
        (Self::NotAlarm, "not_alarm", "alarm if 0"),
        (Self::PowerFail, "power_fail", "power failure if 1"),
        (Self::NotPowerFail, "not_power_fail", "power failure if 0"),
        (Self::Valid, "valid", "no valid position if 0"),
        (Self::NotValid, "not_valid", "no valid position if 1"),
        (
            Self::ParityEven,
            "parity_even",
            "even parity of all bits before it",
        ),
        (
            Self::ParityOdd,
            "parity_odd",
            "odd parity of all bits before it",
        ),
        (
            Self::Crc6,
            "crc6",
            "CRC of all bits before it, 6 bits, x^6 + x + 1",
        ),
    ];

    /// Name.
    pub fn word(self) -> &'static str {
        let row = Self::ALL.iter().find(|(special, ..)| *special == self);
        row.map_or("", |(_, word, _)| word)
    }

    /// Number of bits.
    pub const fn bits(self) -> usize {
        match self {
            Self::Crc6 => CRC_BITS,
            _ => 1,
        }
    }

    /// True if it is stored and shown.
    pub const fn is_shown(self) -> bool {
        !self.is_check() && !matches!(self, Self::Ignored)
    }

    /// True if it is the parity of the bits before it.
    pub const fn is_parity(self) -> bool {
        matches!(self, Self::ParityEven | Self::ParityOdd)
    }

    /// True if it checks the bits before it.
    pub const fn is_check(self) -> bool {
        self.is_parity() || matches!(self, Self::Crc6)
    }

    /// Its cause, and the level that raises it.
    pub const fn cause(self) -> Option<(u64, bool)> {
        Some(match self {
            Self::Alarm => (cause::ALARM, true),
            Self::NotAlarm => (cause::ALARM, false),
            Self::PowerFail => (cause::POWER_FAIL, true),
            Self::NotPowerFail => (cause::POWER_FAIL, false),
            Self::Valid => (cause::NOT_VALID, false),
            Self::NotValid => (cause::NOT_VALID, true),
            _ => return None,
        })
    }
}

/// Consecutive special bits, in the order of transmission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Specials {
    list: [Special; SPECIALS_MAX],
    count: usize,
}

impl Specials {
    /// These bits; `None` if there are more than [`SPECIALS_MAX`].
    pub fn new(specials: &[Special]) -> Option<Self> {
        let mut list = [Special::default(); SPECIALS_MAX];
        list.get_mut(..specials.len())?.copy_from_slice(specials);
        Some(Self {
            list,
            count: specials.len(),
        })
    }

    /// In the order of transmission.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = Special> + '_ {
        self.list[..self.count].iter().copied()
    }

    /// Number of bits.
    pub fn bits(&self) -> usize {
        self.iter().map(Special::bits).sum()
    }

    /// Number of shown bits.
    pub fn shown(&self) -> usize {
        self.iter().filter(|s| s.is_shown()).count()
    }

    /// True if there are no special bits.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }
}

impl fmt::Display for Specials {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<String> = self.iter().map(|s| format!("{:?}", s.word())).collect();
        write!(f, "[{}]", words.join(", "))
    }
}

/// Places of the special bits in a copy, as the port uses them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Places {
    /// Bits before the position.
    pub before: usize,
    /// Bits after the position.
    pub after: usize,
    /// Bits of the shift register for the shown bits.
    pub stored: usize,
    /// Bits at the end of a copy that do not go into the shift register.
    pub tail: usize,
    /// Places of the shown bits in the shift register, in the order of transmission.
    pub shown: Vec<usize>,
    /// Places of the bits with a cause: cause, place, level.
    pub causes: Vec<(u64, usize, bool)>,
    /// Bits of the copy that are left at its parity bit, and whether the parity is odd.
    pub parity: Option<(usize, bool)>,
    /// Bits of the copy that are left at the last bit of its CRC.
    pub crc: Option<usize>,
}

impl Places {
    pub fn new(before: &Specials, after: &Specials) -> Self {
        let mut places = Self {
            before: before.bits(),
            after: after.bits(),
            ..Self::default()
        };
        // Each with the number of special bits from its last bit to the end of the copy.
        let mut left = places.before + places.after;
        let mut all = vec![];
        for special in before.iter().chain(after.iter()) {
            left -= special.bits();
            all.push((special, left + 1));
        }
        let shown = all.iter().filter(|(special, _)| special.is_shown());
        let lefts: Vec<usize> = shown.clone().map(|(_, left)| *left).collect();
        if let (Some(first), Some(last)) = (lefts.first(), lefts.last()) {
            places.tail = last - 1;
            places.stored = first - places.tail;
        }
        let tail = places.tail;
        places.shown = lefts.iter().map(|left| left - 1 - tail).collect();
        places.causes = shown
            .filter_map(|(special, left)| {
                let (cause, level) = special.cause()?;
                Some((cause, left - 1 - tail, level))
            })
            .collect();
        for (special, left) in all {
            match special {
                Special::ParityEven => places.parity = Some((left, false)),
                Special::ParityOdd => places.parity = Some((left, true)),
                Special::Crc6 => places.crc = Some(left),
                _ => {}
            }
        }
        places
    }

    /// Masks of the bits in the shift register with this cause: all of them, and those that raise it at level 0.
    pub fn masks(&self, cause: u64) -> [u64; 2] {
        let these = self.causes.iter().filter(|(of, ..)| *of == cause);
        these.fold([0, 0], |[all, low], (_, place, level)| {
            let bit = 1 << place;
            [all | bit, low | if *level { 0 } else { bit }]
        })
    }
}
