//! The SSI port of a card with its encoder: with one copy of the position, with two, and with special bits.

use super::{Device, Plan};
use crate::campaign::CampaignError;
use crate::ssi::{Defect, Encoder, EncoderConfig, Extra};
use crate::{rng::Rng, Time, NS, US};
use endat_hdl::protocols::ssi::port::{frame, SsiPort};
use endat_hdl::protocols::ssi::specials::{Special, Specials};
use endat_hdl::protocols::SsiSpec;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;

/// Name in tables.
pub const SUBJECT: &str = "ssi_port";
/// Name of the port with special bits.
pub const SUBJECT_SPECIAL: &str = "ssi_port_special";
const SYSTEM_MHZ: u64 = 32;
const PERIOD_CYCLES: u64 = 32;
const POSITION_BITS: u32 = 25;
const TM: Time = 12 * US;
const RECOVERY_MAX_US: u64 = 20;
const TWICE: &str = "position_twice";

/// Settings of a port, with this kind of frame.
const fn settings(frame: u64) -> [(&'static str, u64); 6] {
    [
        ("period_cycles", PERIOD_CYCLES),
        ("position_bits", POSITION_BITS as u64),
        ("filter_cycles", 1),
        ("first_low_extra_cycles", 0),
        ("recovery_limit_cycles", RECOVERY_MAX_US * SYSTEM_MHZ + 32),
        ("frame", frame),
    ]
}

static SINGLE: [(&str, u64); 6] = settings(1 << frame::CLOCKED);
static DOUBLE: [(&str, u64); 6] = settings(1 << frame::CLOCKED | 1 << frame::TWICE);
static CHANGES: [(&str, u64); 5] = [
    ("position_bits", 63),
    ("period_cycles", 2047),
    ("first_low_extra_cycles", 2047),
    ("recovery_limit_cycles", 8191),
    ("frame", 31),
];

/// An encoder in a lane; `SPECIAL` adds a power fail bit and a parity bit after the position.
#[derive(Clone)]
pub struct Ssi<const SPECIAL: bool> {
    encoder: Encoder,
    sound: EncoderConfig,
}

impl<const SPECIAL: bool> Ssi<SPECIAL> {
    /// Request for the port.
    fn asked() -> SsiSpec {
        let after: &[Special] = match SPECIAL {
            true => &[Special::PowerFail, Special::ParityEven],
            false => &[],
        };
        SsiSpec {
            after: Specials::new(after).unwrap_or_default(),
            ..SsiSpec::default()
        }
    }
}

impl<const SPECIAL: bool> Device for Ssi<SPECIAL> {
    const PINS: &'static [&'static str] = &["ssi_clk"];
    const DRIVER: Option<usize> = None;
    const WAYS: &'static [&'static str] = &[
        "a bit of the first copy",
        "a bit of the second copy",
        "more bits",
        "fewer bits",
        "silent encoder",
        "a position for each copy",
        "late recovery",
        "jitter 500 ns",
    ];

    fn plans() -> Vec<Plan> {
        let subject = if SPECIAL { SUBJECT_SPECIAL } else { SUBJECT };
        let bits = Self::asked().copy_bits(POSITION_BITS);
        let plan = |kind, settings: &'static [(&'static str, u64)], copies: u64| {
            let frame_us = copies * (bits + 1);
            Plan {
                subject,
                kind,
                system_mhz: SYSTEM_MHZ,
                settings,
                span_cycles: (frame_us + 2 * RECOVERY_MAX_US + 20) * SYSTEM_MHZ,
                disturbed_cycles: (frame_us + RECOVERY_MAX_US) * SYSTEM_MHZ,
                over_cycles: (frame_us + 2 * RECOVERY_MAX_US + 5) * SYSTEM_MHZ,
                hang_cycles: 40_000,
                quarter_cycles: PERIOD_CYCLES / 4,
                changes: &CHANGES,
            }
        };
        let mut plans = vec![plan("position", &SINGLE, 1)];
        if !SPECIAL {
            plans.push(plan(TWICE, &DOUBLE, 2));
        }
        plans
    }

    fn design() -> Result<Design, CampaignError> {
        let mut block = SsiPort::new(&Self::asked(), true);
        block.connect_all();
        Ok(elaborate(&block, SUBJECT)?)
    }

    fn new(plan: &Plan) -> Self {
        let after = match SPECIAL {
            true => vec![Extra::Level(false), Extra::Parity(false)],
            false => vec![],
        };
        let sound = EncoderConfig {
            after,
            position_bits: POSITION_BITS,
            repeats: plan.kind == TWICE,
            tm: TM,
            ..EncoderConfig::default()
        };
        Self {
            encoder: Encoder::new(sound.clone()),
            sound,
        }
    }

    fn hear(&mut self, now: Time, pins: &[bool]) {
        self.encoder.clock(now, pins[0]);
    }

    fn advance(&mut self, now: Time) {
        self.encoder.advance(now);
    }

    fn next_event(&self) -> Option<Time> {
        self.encoder.next_event()
    }

    fn data(&self) -> bool {
        self.encoder.data()
    }

    fn turn(&mut self, round: u32) -> u64 {
        let position = Rng::new(u64::from(round)).next_u64() & ((1 << POSITION_BITS) - 1);
        self.encoder.config.position = position;
        position
    }

    fn complaints(&self) -> usize {
        self.encoder.violations().len()
    }

    fn spoil(&mut self, way: usize, rng: &mut Rng) {
        let bit = rng.in_range(0, u64::from(POSITION_BITS) - 1) as usize;
        let config = &mut self.encoder.config;
        match way {
            0 => config.defect = Defect::Flip { copy: 0, bit },
            1 => config.defect = Defect::Flip { copy: 1, bit },
            2 => config.position_bits += rng.in_range(1, 8) as u32,
            3 => config.position_bits -= rng.in_range(1, 2) as u32,
            4 => config.defect = Defect::Silent,
            5 => config.defect = Defect::TakesAnew,
            6 => config.tm = (RECOVERY_MAX_US + 10) * US,
            _ => config.jitter = 500 * NS,
        }
    }

    fn mend(&mut self) {
        let position = self.encoder.config.position;
        self.encoder.config = EncoderConfig {
            position,
            ..self.sound.clone()
        };
    }
}
