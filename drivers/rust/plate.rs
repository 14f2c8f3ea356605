//! Name plate of an encoder, decoded from the words of its memory that the initialisation has read.

use crate::card::Card;
use crate::error::Error;
use crate::link::Link;
use core::fmt::{self, Display, Write};
use embedded_hal::delay::DelayNs;

/// A number as printed on the encoder: letters, digits, letters. Characters that cannot be printed are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Number {
    before: [u8; 2],
    /// The digits.
    pub number: u32,
    after: u8,
}

impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut letters = |bytes: &[u8]| {
            let mut printable = bytes.iter().filter(|b| b.is_ascii_graphic());
            printable.try_for_each(|b| f.write_char(char::from(*b)))
        };
        letters(&self.before)?;
        write!(f, "{}", self.number)?;
        let mut printable = [self.after].into_iter().filter(u8::is_ascii_graphic);
        printable.try_for_each(|b| f.write_char(char::from(b)))
    }
}

/// Name plate of an encoder; values that have not been read are `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NamePlate {
    /// Width of the position.
    pub position_bits: Option<u32>,
    /// Rotary, not linear.
    pub rotary: Option<bool>,
    /// Signal periods per revolution, or the signal period in nm.
    pub signal_periods: Option<u32>,
    /// Distinguishable revolutions, 0 or 1 = singleturn.
    pub revolutions: Option<u32>,
    /// Measuring steps per revolution, or the measuring step in nm.
    pub steps: Option<u32>,
    /// ID number.
    pub id: Option<Number>,
    /// Serial number.
    pub serial: Option<Number>,
}

/// Names of the decoded words.
const WORDS: [&str; 13] = [
    "position_bits",
    "encoder_type",
    "signal_periods_low",
    "signal_periods_high",
    "revolutions",
    "steps_low",
    "steps_high",
    "id_0",
    "id_1",
    "id_2",
    "serial_0",
    "serial_1",
    "serial_2",
];

impl NamePlate {
    /// Decodes words; `word` returns a word by name, if it has been read.
    pub fn of(word: impl Fn(&str) -> Option<u16>) -> Self {
        let long =
            |low: &str, high: &str| Some(u32::from(word(low)?) | u32::from(word(high)?) << 16);
        let id = || {
            Some(Number {
                before: word("id_0")?.to_be_bytes(),
                number: long("id_1", "id_2")?,
                after: 0,
            })
        };
        let serial = || {
            let [high, head] = word("serial_0")?.to_be_bytes();
            let middle = word("serial_1")?;
            let [tail, low] = word("serial_2")?.to_be_bytes();
            Some(Number {
                before: [0, head],
                number: u32::from(high) << 24 | u32::from(middle) << 8 | u32::from(low),
                after: tail,
            })
        };
        Self {
            position_bits: word("position_bits").map(|w| u32::from(w & 0x3F)),
            rotary: word("encoder_type").map(|w| w >> 15 == 1),
            signal_periods: long("signal_periods_low", "signal_periods_high"),
            revolutions: word("revolutions").map(u32::from),
            steps: long("steps_low", "steps_high"),
            id: id(),
            serial: serial(),
        }
    }

    /// True if it measures angles; the default if its type is unknown.
    pub fn is_rotary(&self) -> bool {
        self.rotary.unwrap_or(true)
    }
}

/// A line for each known value, as in `endat id`.
impl Display for NamePlate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_rotary = self.is_rotary();
        if let Some(steps) = self.steps {
            let unit = match is_rotary {
                true => "measuring steps per revolution",
                false => "nm",
            };
            writeln!(f, "  {:<18}{steps} {unit}", "resolution")?;
        }
        match self.revolutions.filter(|_| is_rotary) {
            None => {}
            Some(0 | 1) => writeln!(f, "  {:<18}singleturn", "revolutions")?,
            Some(n) => writeln!(f, "  {:<18}{n}", "revolutions")?,
        }
        if let Some(periods) = self.signal_periods {
            let unit = if is_rotary { "per revolution" } else { "nm" };
            writeln!(f, "  {:<18}{periods} {unit}", "signal periods")?;
        }
        if let Some(id) = &self.id {
            writeln!(f, "  {:<18}{id}", "ID number")?;
        }
        if let Some(serial) = &self.serial {
            writeln!(f, "  {:<18}{serial}", "serial number")?;
        }
        Ok(())
    }
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Reads the name plate of a channel's encoder; [`Error::Part`] on a card without the part `initialise`.
    pub fn read_name_plate(&mut self, channel: usize) -> Result<NamePlate, Error<L::Error>> {
        let mut words = [None; WORDS.len()];
        for (word, name) in words.iter_mut().zip(WORDS) {
            *word = self.read_plate(channel, name)?;
        }
        let place = |name: &str| WORDS.iter().position(|word| *word == name);
        Ok(NamePlate::of(|name| words[place(name)?]))
    }
}
