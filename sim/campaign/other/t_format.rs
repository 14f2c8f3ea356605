//! The T-format port of a card with its encoder: exchanges with request 3.

use super::{Device, Plan};
use crate::campaign::CampaignError;
use crate::t_format::{Defect, Encoder, EncoderConfig};
use crate::{encoder::Drive, rng::Rng, Time, NS, US};
use endat_hdl::protocols::t_format::port::TFormatPort;
use rtl_design::elaborate::{elaborate, Design};
use rust_hdl::prelude::Block;

/// Name in tables.
pub const SUBJECT: &str = "t_format_port";
const SYSTEM_MHZ: u64 = 20;
const BIT_CYCLES: u64 = 8;
/// Fields of a reply to request 3.
const FIELDS: u64 = 11;

static SETTINGS: [(&str, u64); 5] = [
    ("bit_cycles", BIT_CYCLES),
    ("request_id", 3),
    ("reply_gap_us", 4),
    ("field_gap_us", 1),
    ("filter_cycles", 1),
];
static CHANGES: [(&str, u64); 4] = [
    ("bit_cycles", 127),
    ("request_id", 15),
    ("reply_gap_us", 63),
    ("field_gap_us", 7),
];

/// An encoder in a lane.
#[derive(Clone)]
pub struct TFormat {
    encoder: Encoder,
    sound: EncoderConfig,
}

impl Device for TFormat {
    const PINS: &'static [&'static str] = &["data_oe", "data_o"];
    const DRIVER: Option<usize> = Some(0);
    const WAYS: &'static [&'static str] = &[
        "another ID",
        "a bit",
        "a delimiter",
        "too few fields",
        "a long pause",
        "silent encoder",
        "a pulse before the reply",
        "late reply",
        "jitter 150 ns",
    ];

    fn plans() -> Vec<Plan> {
        vec![Plan {
            subject: SUBJECT,
            kind: "exchange",
            system_mhz: SYSTEM_MHZ,
            settings: &SETTINGS,
            // Request 3, its reply, and the line at rest.
            span_cycles: 80 * SYSTEM_MHZ,
            disturbed_cycles: 56 * SYSTEM_MHZ,
            over_cycles: 58 * SYSTEM_MHZ,
            // A 7-bit timer that wraps.
            hang_cycles: 500 * SYSTEM_MHZ,
            quarter_cycles: BIT_CYCLES / 4,
            changes: &CHANGES,
        }]
    }

    fn design() -> Result<Design, CampaignError> {
        let mut block = TFormatPort::new(true);
        block.connect_all();
        Ok(elaborate(&block, SUBJECT)?)
    }

    fn new(_: &Plan) -> Self {
        let sound = EncoderConfig {
            status: 0,
            ..EncoderConfig::default()
        };
        Self {
            encoder: Encoder::new(sound.clone()),
            sound,
        }
    }

    fn hear(&mut self, now: Time, pins: &[bool]) {
        let drive = match pins[0] {
            true => Drive::level(pins[1]),
            false => Drive::Released,
        };
        self.encoder.receiver(now, drive);
    }

    fn advance(&mut self, now: Time) {
        self.encoder.advance(now);
    }

    fn next_event(&self) -> Option<Time> {
        self.encoder.next_event()
    }

    fn data(&self) -> bool {
        self.encoder.output() != Drive::Low
    }

    fn turn(&mut self, round: u32) -> u64 {
        let mixed = Rng::new(u64::from(round)).next_u64();
        let config = &mut self.encoder.config;
        config.single_turn = mixed as u32 & 0xFF_FFFF;
        config.multi_turn = (mixed >> 32) as u32 & 0xFF_FFFF;
        u64::from(config.multi_turn) << 24 | u64::from(config.single_turn)
    }

    fn complaints(&self) -> usize {
        self.encoder.violations().len()
    }

    fn spoil(&mut self, way: usize, rng: &mut Rng) {
        let field = rng.in_range(0, FIELDS - 1) as usize;
        let bit = rng.in_range(0, 7) as usize;
        let config = &mut self.encoder.config;
        config.defect = match way {
            0 => Defect::OtherId(rng.in_range(4, 15) as u8),
            1 => Defect::Flip { field, bit },
            2 => Defect::Delimiter { field },
            3 => Defect::Short {
                fields: field.max(1),
            },
            4 => Defect::Pause {
                field: field.max(1),
                length: 10 * US,
            },
            5 => Defect::Silent,
            6 => Defect::Pulse {
                ahead: 2 * US,
                width: rng.in_range(100, 1_500) * NS,
            },
            _ => Defect::None,
        };
        match way {
            7 => config.reply_gap = 10 * US,
            8 => config.jitter = 150 * NS,
            _ => {}
        }
    }

    fn mend(&mut self) {
        let EncoderConfig {
            single_turn,
            multi_turn,
            ..
        } = self.encoder.config;
        self.encoder.config = EncoderConfig {
            single_turn,
            multi_turn,
            ..self.sound.clone()
        };
    }
}
