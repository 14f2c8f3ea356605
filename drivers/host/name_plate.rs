//! Name plate of the encoder, as read by the card at initialisation.

use crate::registers::Place;
use crate::units::Scale;
use endat_regs::Protocol;

/// Description of an encoder without a name plate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// Lines with heading and text.
    pub lines: Vec<(&'static str, String)>,
    /// Values as numbers.
    pub fields: Vec<(&'static str, u32)>,
}

/// Description of an initialisation step.
pub fn step_name(step: u16) -> String {
    let field = Place::field_at("service", "progress", "step", 0).field;
    let told = field.and_then(|f| f.told(step.into(), Protocol::Endat));
    told.unwrap_or_else(|| "unknown".to_owned())
}

/// Name plate of an encoder. Words that the card has not read are `None`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NamePlate {
    /// The part that the drivers have, too.
    pub driver: endat_driver::NamePlate,
    /// The card has initialised the encoder successfully.
    pub initialised: bool,
    /// Step of the initialisation that is under way.
    pub step: Option<u16>,
    /// Step that failed.
    pub failed: Option<u16>,
    /// The encoder supports EnDat 2.2.
    pub endat22: bool,
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
    /// ID number as printed on the encoder.
    pub id: Option<String>,
    /// Serial number.
    pub serial: Option<String>,
    /// Functional safety.
    pub safety: Option<bool>,
    /// Longest calculation time tcal, in the format of the encoder's word 39.
    pub tcal: Option<u16>,
    /// Supported additional data 1, bit n = code 0x40 + n.
    pub infos_1: Option<u16>,
    /// Supported additional data 2, bit n = code 0x50 + n.
    pub infos_2: Option<u16>,
    /// Fastest clock in kHz.
    pub clock_max_khz: Option<u32>,
    /// Short recovery time is selected.
    pub short_recovery: Option<bool>,
    /// Alarms before they were cleared.
    pub alarms: Option<u16>,
    /// Warnings before they were cleared.
    pub warnings: Option<u16>,
    /// Line delay measured at initialisation, in system clock cycles.
    pub delay_cycles: Option<u16>,
}

impl NamePlate {
    /// Combines the words; `word` returns a word by name, if the card has read it.
    pub(crate) fn new(word: impl Fn(&str) -> Option<u16>) -> Self {
        let driver = endat_driver::NamePlate::of(&word);
        Self {
            position_bits: driver.position_bits,
            rotary: driver.rotary,
            signal_periods: driver.signal_periods,
            revolutions: driver.revolutions,
            steps: driver.steps,
            id: driver.id.map(|id| id.to_string()),
            serial: driver.serial.map(|serial| serial.to_string()),
            driver,
            safety: word("commands").map(|w| w >> 2 & 3 == 1),
            tcal: word("tcal"),
            infos_1: word("infos_1"),
            infos_2: word("infos_2"),
            clock_max_khz: word("clock_max_khz").map(u32::from),
            short_recovery: word("recovery").map(|w| w & 3 == 1),
            alarms: word("alarms"),
            warnings: word("warnings"),
            ..Self::default()
        }
    }

    /// The measuring step, if the encoder gives it.
    pub fn scale(&self) -> Option<Scale> {
        let steps = self.steps.filter(|s| *s > 0)?;
        Some(match self.rotary? {
            true => Scale::Rotary {
                steps_per_turn: u64::from(steps),
                turns: self.revolutions.unwrap_or(1).max(1).into(),
                turns_at: None,
            },
            false => Scale::Linear {
                step_nm: f64::from(steps),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The word has other functions in addition to the recovery time.
    #[test]
    fn the_recovery_time_is_the_lowest_two_bits_of_its_word() {
        let short = |found: u16| NamePlate::new(|_| Some(found)).short_recovery;
        assert_eq!([1, 0xA555].map(short), [Some(true); 2]);
        assert_eq!([2, 0xA556].map(short), [Some(false); 2]);
    }
}
