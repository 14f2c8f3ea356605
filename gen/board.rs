//! Boards: pin tables, and the clock manager that makes the system clock.

use endat_hdl::config::{SYSTEM_HZ_MAX, SYSTEM_HZ_MIN};
use serde::Deserialize;
use std::collections::BTreeMap;

/// What a port of the top level is for; decides its constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Board oscillator.
    Oscillator,
    /// Output to a transceiver: clock, data, driver enable.
    Transceiver,
    /// Answer of the encoder, asynchronous.
    EncoderData,
    /// Trigger pin, asynchronous.
    Trigger,
    /// UART input, asynchronous.
    UartInput,
    /// UART output.
    UartOutput,
    /// Input from a bus outside the device, asynchronous.
    BusInput,
    /// Output to a bus outside the device, driven only while the card is read.
    BusOutput,
    /// Data line of a bus outside the device, driven by either side.
    BusData,
    /// Interrupt to a processor outside the device.
    Interrupt,
    /// Light.
    Led,
}

impl Kind {
    /// Whether the port is an input of the device.
    pub const fn is_input(self) -> bool {
        matches!(
            self,
            Self::Oscillator | Self::EncoderData | Self::Trigger | Self::UartInput | Self::BusInput
        )
    }

    /// Its direction in a module's port list, padded.
    pub const fn direction(self) -> &'static str {
        match self {
            Self::BusData => "inout  wire",
            kind if kind.is_input() => "input  wire",
            _ => "output wire",
        }
    }

    /// Why the timing of the port must not be analysed; `None` when it must.
    pub const fn asynchronous(self) -> Option<&'static str> {
        match self {
            Self::EncoderData => Some("answers arrive with the delay of the cable, in any phase; synchronised and tracked inside"),
            Self::Trigger => Some("belongs to no clock; synchronised inside, one system clock of jitter is documented"),
            Self::UartInput => Some("belongs to the host's clock; synchronised and sampled in mid bit inside"),
            Self::BusInput | Self::BusData => Some("belongs to the clock of the other end; synchronised inside, see the rules of its bus for set-up times"),
            _ => None,
        }
    }
}

/// The boards that come with the program: name and pin table.
const BOARDS: &[(&str, &str)] = &[(
    "papilio_pro",
    include_str!("../constraints/boards/papilio_pro.toml"),
)];

/// A board's pin table.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Board {
    /// Name by which a configuration asks for it.
    #[serde(skip)]
    pub name: String,
    /// Name for people.
    pub title: String,
    /// Device, speed grade and package, as the vendor's tools spell it.
    pub part: String,
    /// Pins of the package: P1 to this.
    pub package_pins: u32,
    /// Pin of the oscillator.
    pub oscillator_pin: String,
    /// Frequency of the oscillator, in hertz.
    pub oscillator_hz: u64,
    /// Fastest host UART of the board, in bit/s.
    pub uart_baud_max: u64,
    /// I/O standard of all pins.
    pub iostandard: String,
    /// Free pins by connector, position 0 first.
    pub connectors: BTreeMap<String, Vec<String>>,
    /// Signals that the board itself wires.
    pub fixed: BTreeMap<String, String>,
    /// Usual places of the other signals.
    pub wing: BTreeMap<String, String>,
}

/// One signal of the top level on one pin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Port of the top level.
    pub signal: String,
    /// What the signal is for.
    pub kind: Kind,
    /// Package pin.
    pub pin: String,
    /// Connector and position, or empty.
    pub position: String,
}

/// Names of all boards.
pub fn names() -> Vec<&'static str> {
    BOARDS.iter().map(|(name, _)| *name).collect()
}

impl Board {
    /// The board of this name; `Err` has the message.
    pub fn named(name: &str) -> Result<Self, String> {
        let Some((_, text)) = BOARDS.iter().find(|(n, _)| *n == name) else {
            return Err(format!(
                "unknown board; known boards: {}",
                names().join(", ")
            ));
        };
        let mut board: Self =
            toml::from_str(text).map_err(|e| format!("its pin table is broken: {e}"))?;
        board.name = name.into();
        Ok(board)
    }

    /// The package pin that a user's word means (`P48` or `A0`); `Err` has the message.
    pub fn pin(&self, word: &str) -> Result<String, String> {
        let word = word.to_ascii_uppercase();
        if let Some(pin) = self.by_position(&word) {
            return Ok(pin.clone());
        }
        let number = word.strip_prefix('P').and_then(|n| n.parse::<u32>().ok());
        match number {
            Some(n) if !(1..=self.package_pins).contains(&n) => Err(format!(
                "no such pin; the package of {} has P1..P{}",
                self.part, self.package_pins
            )),
            Some(n) if self.is_free(&format!("P{n}")) => Ok(format!("P{n}")),
            Some(_) => Err(format!(
                "is not on a connector of {}; {}",
                self.name,
                self.free_pins()
            )),
            None => Err(format!(
                "is neither a pin (P48) nor a connector position (A0); {}",
                self.free_pins()
            )),
        }
    }

    fn by_position(&self, word: &str) -> Option<&String> {
        let split = word.find(|c: char| c.is_ascii_digit())?;
        let position: usize = word.get(split..)?.parse().ok()?;
        self.connectors.get(word.get(..split)?)?.get(position)
    }

    fn is_free(&self, pin: &str) -> bool {
        self.connectors.values().flatten().any(|p| p == pin)
            || self.fixed.values().any(|p| p == pin)
    }

    fn free_pins(&self) -> String {
        let ranges = self
            .connectors
            .iter()
            .map(|(name, pins)| format!("{name}0..{name}{}", pins.len().saturating_sub(1)));
        format!("use {}", ranges.collect::<Vec<_>>().join(", "))
    }

    /// Every connector position with its pin.
    pub fn places(&self) -> impl Iterator<Item = (String, &String)> {
        self.connectors.iter().flat_map(|(name, pins)| {
            let pins = pins.iter().enumerate();
            pins.map(move |(n, pin)| (format!("{name}{n}"), pin))
        })
    }

    /// Connector and position of a pin, such as `C3`.
    pub fn position(&self, pin: &str) -> String {
        let found = self.connectors.iter().find_map(|(name, pins)| {
            let index = pins.iter().position(|p| p == pin)?;
            Some(format!("{name}{index}"))
        });
        found.unwrap_or_default()
    }

    /// The usual word for the place of a signal.
    pub fn usual_place(&self, signal: &str) -> Option<&String> {
        self.fixed.get(signal).or_else(|| self.wing.get(signal))
    }
}

/// Factors of a Spartan-6 `PLL_BASE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pll {
    /// Input divider.
    pub divide: u64,
    /// Feedback multiplier.
    pub multiply: u64,
    /// Output divider.
    pub output_divide: u64,
    /// Oscillator frequency of the loop, in hertz.
    pub vco_hz: u64,
}

/// Slowest loop oscillator of a Spartan-6 PLL, in hertz (DS162).
pub const VCO_HZ_MIN: u64 = 400_000_000;
/// Fastest loop oscillator of a Spartan-6 PLL in speed grade -2, in hertz (DS162).
pub const VCO_HZ_MAX: u64 = 1_000_000_000;
/// Slowest phase detector input, in hertz (DS162).
const DETECTOR_HZ_MIN: u64 = 19_000_000;

/// All output frequencies of the PLL with their factors, the fastest loop first (least jitter).
fn pll_settings(oscillator_hz: u64) -> impl Iterator<Item = (u64, Pll)> {
    let dividers = 1..=(oscillator_hz / DETECTOR_HZ_MIN).clamp(1, 52);
    let loops =
        dividers.flat_map(move |divide| (1..=64u64).rev().map(move |multiply| (divide, multiply)));
    loops
        .filter(move |(divide, _)| oscillator_hz.is_multiple_of(*divide))
        .map(move |(divide, multiply)| (divide, multiply, oscillator_hz / divide * multiply))
        .filter(|(_, _, vco_hz)| (VCO_HZ_MIN..=VCO_HZ_MAX).contains(vco_hz))
        .flat_map(|(divide, multiply, vco_hz)| {
            let exact = (1..=128u64).filter(move |o| vco_hz % o == 0);
            exact.map(move |output_divide| {
                (
                    vco_hz / output_divide,
                    Pll {
                        divide,
                        multiply,
                        output_divide,
                        vco_hz,
                    },
                )
            })
        })
}

/// Factors that make exactly `system_hz`; `Err` has the message with the nearest frequencies.
pub fn pll(oscillator_hz: u64, system_hz: u64) -> Result<Pll, String> {
    if let Some((_, pll)) = pll_settings(oscillator_hz).find(|(hz, _)| *hz == system_hz) {
        return Ok(pll);
    }
    let all = || {
        let all = pll_settings(oscillator_hz).map(|(hz, _)| hz);
        all.filter(|hz| (SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX).contains(hz))
    };
    let below = all().filter(|hz| *hz < system_hz).max();
    let above = all().filter(|hz| *hz > system_hz).min();
    let near: Vec<String> = below
        .into_iter()
        .chain(above)
        .map(|hz| format!("{hz}"))
        .collect();
    Err(format!(
        "the clock manager cannot make it from the board's {oscillator_hz} Hz; use {} Hz",
        near.join(" or ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_board_parses_and_uses_each_pin_once() {
        for name in names() {
            let board = Board::named(name).unwrap();
            let mut pins: Vec<&String> = board
                .connectors
                .values()
                .flatten()
                .chain(board.fixed.values())
                .collect();
            pins.push(&board.oscillator_pin);
            let count = pins.len();
            pins.sort();
            pins.dedup();
            assert_eq!(pins.len(), count, "a pin of {name} stands twice");
            for pin in pins {
                let number: u32 = pin.strip_prefix('P').unwrap().parse().unwrap();
                assert!((1..=board.package_pins).contains(&number));
            }
            for place in board.wing.values() {
                assert!(board.pin(place).is_ok(), "{place}");
            }
        }
    }

    #[test]
    fn pins_are_found_by_number_and_by_position() {
        let board = Board::named("papilio_pro").unwrap();
        assert_eq!(board.pin("c8"), Ok("P123".into()));
        assert_eq!(board.pin("P48"), Ok("P48".into()));
        assert_eq!(board.position("P123"), "C8");
        for (word, text) in [
            ("P145", "P1..P144"),
            ("P0", "P1..P144"),
            ("P9", "not on a connector"),
            ("C16", "neither a pin"),
            ("", "neither a pin"),
            ("Pä", "neither a pin"),
        ] {
            assert!(board.pin(word).unwrap_err().contains(text), "{word}");
        }
    }

    #[test]
    fn the_pll_makes_the_system_clocks_of_the_presets() {
        for hz in [100_000_000, 128_000_000, 50_000_000] {
            let pll = pll(32_000_000, hz).unwrap();
            assert_eq!(32_000_000 / pll.divide * pll.multiply, pll.vco_hz);
            assert_eq!(pll.vco_hz / pll.output_divide, hz);
            assert!((VCO_HZ_MIN..=VCO_HZ_MAX).contains(&pll.vco_hz));
        }
        assert!(pll(32_000_000, 99_999_999)
            .unwrap_err()
            .contains("use 99200000 or 100000000 Hz"));
        // The next one up, 256 MHz, is more than the core is made for.
        assert!(pll(32_000_000, 249_000_000)
            .unwrap_err()
            .ends_with("use 248000000 Hz"));
    }
}
