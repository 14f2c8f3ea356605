//! Frames with additional data and a supplement.

use super::{Rate, Subject, CYCLES, MHZ};
use endat_hdl::endat::channel::{Channel, Features, FixedTimes};
use endat_hdl::endat::timing::PARK_NS;
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::{
    ModeCommand::{self, PositionErrorReset, PositionSelectMemory, SendPositionAddInfo},
    INFO_BITS, SUPPLEMENT_PULSES,
};
use endat_sim::bench::{Bench, Link, PinNames};
use endat_sim::campaign::{Case, Traces};
use endat_sim::{Time, MS, NS};
use rtl_design::elaborate::{elaborate, Design, ElaborateError};
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;

/// What follows the position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Behind {
    pub infos: u32,
    pub has_supplement: bool,
}

/// Rates of these rows.
const RATES: [Rate; 3] = [
    (2 * MHZ, 128 * MHZ),
    (8 * MHZ, 128 * MHZ),
    (16 * MHZ, 128 * MHZ),
];
/// Selections of additional data 1 and 2.
const SELECTIONS: [u8; 2] = [0x4C, 0x5B];
/// Longer than any frame.
const FRAME_LIMIT: Time = MS;

impl Behind {
    pub const NOTHING: Self = Self {
        infos: 0,
        has_supplement: false,
    };

    /// Additional data 1, 1 and 2, a supplement, and all of them.
    pub fn subjects(position_bits: u32) -> impl Iterator<Item = Subject> {
        let kinds = [(1, false), (2, false), (0, true), (2, true)];
        kinds.into_iter().flat_map(move |(infos, has_supplement)| {
            RATES.map(|rate| Subject {
                command: if has_supplement {
                    PositionErrorReset
                } else {
                    SendPositionAddInfo
                },
                behind: Self {
                    infos,
                    has_supplement,
                },
                position_bits,
                rate,
                published: None,
            })
        })
    }

    /// Bits from the start bit to the last CRC bit.
    pub fn answer_bits(self, command: ModeCommand, position_bits: u32) -> u64 {
        u64::from(command.answer_bits(position_bits)) + u64::from(self.infos * INFO_BITS)
    }

    /// Clock pulses behind the answer.
    pub fn pulses(self) -> u64 {
        if self.has_supplement {
            SUPPLEMENT_PULSES.into()
        } else {
            1
        }
    }

    /// How much longer than half a period the clock is LOW before the supplement. The protocol has no shortest time: the last bit must
    /// have come in, and then it is as long as tST.
    pub fn pause(self, case: &Case) -> Time {
        match self.has_supplement {
            true => case.line.round_trip() + case.encoder.clock_to_data + PARK_NS * NS,
            false => 0,
        }
    }

    /// The channel that can do it.
    pub fn design(self, case: &Case) -> Result<Design, ElaborateError> {
        if self == Self::NOTHING {
            return case.design();
        }
        let mut block = Channel::with(FixedTimes::at(case.system_hz), Features::PROTOCOL);
        block.connect_all();
        elaborate(&block, "channel")
    }

    /// The frame with which the frames back to back begin: one measures the delay, one brings the first position, others select.
    pub fn first_frame(self) -> usize {
        2 + self.infos as usize
    }

    /// Frames back to back.
    pub fn run(self, case: &Case, engine: Compiled) -> Bench<Compiled> {
        if self == Self::NOTHING {
            return case.run_alone(engine, false);
        }
        let link = Link::new(case.line.clone(), case.encoder.clone());
        let mut bench = Bench::new(engine, case.system_hz, vec![(PinNames::channel(), link)]);
        let mut settings = case.settings;
        settings.command = SendPositionAddInfo.code();
        bench.configure(&settings);
        bench.power_up();
        let wait = |bench: &mut Bench<Compiled>, busy| {
            bench.run_until_done(FRAME_LIMIT, |b| b.get("busy") == busy);
        };
        let mut frame = |request: Option<(ModeCommand, u8)>, is_at_once: bool| {
            if !is_at_once {
                wait(&mut bench, 0);
            }
            // With a frame under way it is for the next one.
            if let Some((command, address)) = request {
                bench.set("request_command", command.code().into());
                bench.set("request_parameter", u128::from(address) << 16);
                bench.set("request_ride", 1);
                bench.run_cycles(1);
                bench.set("request_ride", 0);
                bench.run_cycles(3);
            }
            wait(&mut bench, 0);
            bench.trigger();
            wait(&mut bench, 1);
        };
        frame(None, false);
        for code in &SELECTIONS[..self.infos as usize] {
            frame(Some((PositionSelectMemory, *code)), false);
        }
        let request = self.has_supplement.then_some((PositionErrorReset, 0));
        for i in 0..=CYCLES {
            frame(request, i > 0);
        }
        wait(&mut bench, 0);
        bench
    }

    /// Whether all frames were good and by the rules.
    pub fn check(self, case: &Case, traces: &Traces<'_>) -> Result<(), String> {
        if self == Self::NOTHING {
            return case.check(traces);
        }
        if let Some((_, violation)) = traces.violations.first() {
            return Err(violation.to_string());
        }
        let count = self.first_frame() + CYCLES;
        // One more measures the delay.
        let counts = (traces.frames.len(), traces.results.len());
        if counts != (count + 1, count) {
            return Err(format!("{} frames instead of {}", counts.0, count + 1));
        }
        for (frame, result) in traces.positions()?.iter().zip(traces.results) {
            let is_whole =
                frame.is_whole() && frame.is_true_answer(case.settings.position_bits, true);
            let is_good = result.last_cause() == cause::NONE
                && result.fresh
                && result.position == frame.position;
            let is_measured = frame.index >= self.first_frame() as u64;
            let has_all = frame.infos.len() == self.infos as usize
                && frame.supplement.is_some() == self.has_supplement;
            if !is_whole || !is_good || (is_measured && !has_all) {
                return Err(format!("frame {}: {result:?}, {frame:?}", frame.index));
            }
        }
        Ok(())
    }
}
