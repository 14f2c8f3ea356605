//! Clock managers: which system clocks one makes of a board's oscillator.

use endat_hdl::config::{SYSTEM_HZ_MAX, SYSTEM_HZ_MIN};
use std::ops::RangeInclusive;

/// What the loop of a clock manager multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// Its own oscillator: loop = input / divide * multiply, output = loop / output divider.
    Loop,
    /// Its output: output = input / divide * multiply, loop = output * output divider.
    Output,
}

/// What a family's clock manager can do; its file says where the numbers come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClockManager {
    /// What the loop multiplies.
    pub feedback: Feedback,
    /// Input divider.
    pub divide: RangeInclusive<u64>,
    /// Multiplier.
    pub multiply: RangeInclusive<u64>,
    /// Output dividers, the least first.
    pub output_divides: Vec<u64>,
    /// Input of the phase detector, in hertz.
    pub detector_hz: RangeInclusive<u64>,
    /// Oscillator of the loop, in hertz.
    pub vco_hz: RangeInclusive<u64>,
    /// Output, in hertz.
    pub output_hz: RangeInclusive<u64>,
}

/// Factors of a clock manager.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pll {
    /// What the loop multiplies.
    pub feedback: Feedback,
    /// Input divider.
    pub divide: u64,
    /// Multiplier.
    pub multiply: u64,
    /// Output divider.
    pub output_divide: u64,
    /// Input of the phase detector, in hertz.
    pub detector_hz: u64,
    /// Oscillator of the loop, in hertz.
    pub vco_hz: u64,
    /// Output, in hertz.
    pub output_hz: u64,
}

impl Pll {
    /// Output = oscillator times the first, divided by the others.
    pub const fn factors(&self) -> [u64; 3] {
        let output_divide = match self.feedback {
            Feedback::Loop => self.output_divide,
            Feedback::Output => 1,
        };
        [self.multiply, self.divide, output_divide]
    }
}

impl ClockManager {
    /// All settings, the fastest loop first (least jitter).
    fn settings(&self, oscillator_hz: u64) -> impl Iterator<Item = Pll> + '_ {
        let dividers = self.divide.clone().filter(move |divide| {
            *divide != 0
                && oscillator_hz.is_multiple_of(*divide)
                && self.detector_hz.contains(&(oscillator_hz / divide))
        });
        let loops = dividers.flat_map(move |divide| {
            let most = self.vco_hz.end() / (oscillator_hz / divide);
            let multipliers = *self.multiply.start()..=*self.multiply.end().min(&most);
            multipliers.rev().map(move |multiply| (divide, multiply))
        });
        loops.flat_map(move |(divide, multiply)| {
            let detector_hz = oscillator_hz / divide;
            let product_hz = detector_hz * multiply;
            let outputs = self.output_divides.iter().rev();
            outputs.filter_map(move |&output_divide| {
                let (vco_hz, output_hz) = match self.feedback {
                    Feedback::Loop if product_hz.is_multiple_of(output_divide) => {
                        (product_hz, product_hz / output_divide)
                    }
                    Feedback::Loop => return None,
                    Feedback::Output => (product_hz.checked_mul(output_divide)?, product_hz),
                };
                let pll = Pll {
                    feedback: self.feedback,
                    divide,
                    multiply,
                    output_divide,
                    detector_hz,
                    vco_hz,
                    output_hz,
                };
                (self.vco_hz.contains(&vco_hz) && self.output_hz.contains(&output_hz))
                    .then_some(pll)
            })
        })
    }

    /// The frequencies that a card can have.
    fn system_clocks(&self, oscillator_hz: u64) -> impl Iterator<Item = u64> + '_ {
        let all = self.settings(oscillator_hz).map(|pll| pll.output_hz);
        all.filter(|hz| (SYSTEM_HZ_MIN..=SYSTEM_HZ_MAX).contains(hz))
    }

    /// Whether there is any system clock that it can make.
    pub fn takes(&self, oscillator_hz: u64) -> bool {
        oscillator_hz > 0 && self.system_clocks(oscillator_hz).next().is_some()
    }

    /// Factors that make exactly `system_hz`; `Err` has the message with the nearest frequencies.
    pub fn pll(&self, oscillator_hz: u64, system_hz: u64) -> Result<Pll, String> {
        let mut settings = self.settings(oscillator_hz);
        if let Some(pll) = settings.find(|pll| pll.output_hz == system_hz) {
            return Ok(pll);
        }
        let all = || self.system_clocks(oscillator_hz);
        let below = all().filter(|hz| *hz < system_hz).max();
        let above = all().filter(|hz| *hz > system_hz).min();
        let near: Vec<String> = (below.into_iter().chain(above))
            .map(|hz| format!("{hz}"))
            .collect();
        let remedy = match near.is_empty() {
            true => "it makes none that a card can have".into(),
            false => format!("use {} Hz", near.join(" or ")),
        };
        Err(format!(
            "the clock manager cannot make it from the board's {oscillator_hz} Hz; {remedy}"
        ))
    }
}
