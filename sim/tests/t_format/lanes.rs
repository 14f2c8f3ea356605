//! Many frames in parallel: each lane has its own encoder edges, all lanes the same request.

use endat_hdl::protocols::t_format::{channel::TFormatChannel, protocol::control};
use endat_sim::rng::Rng;
use endat_sim::t_format::{edges, Wire};
use endat_sim::Time;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Keep, LaneWords, Lanes, PortId};
use rust_hdl::prelude::Block;

/// A bit at the nominal rate.
pub const BIT: Time = 400_000;

/// Conditions of a run.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    pub system_mhz: u64,
    pub rate_error_ppm: i64,
    pub jitter: Time,
}

/// A reply on the line: bytes, and start time after the request.
pub struct Sent {
    pub levels: Option<Vec<bool>>,
    pub bytes: Vec<u8>,
    pub after: Time,
}

/// Outputs of a lane after an exchange.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    pub fresh: bool,
    pub cause: u64,
    pub status: u8,
    pub encoder_id: u8,
    pub sequence: u8,
}

/// The receiver in 128 lanes.
pub struct Many {
    lanes: Lanes,
    conditions: Conditions,
    rng: Rng,
    rx: PortId,
    tick: PortId,
    trigger: PortId,
    driver: PortId,
    said: [PortId; 5],
    cycle: u64,
}

pub const LANES: usize = 128;

impl Many {
    pub fn new(conditions: Conditions, seed: u64) -> Self {
        let mut block = TFormatChannel::new(true);
        block.connect_all();
        let design = elaborate(&block, "t_format").unwrap();
        let mut lanes = Lanes::new(&design, Keep::Outputs, LaneWords::Two).unwrap();
        let mut set = |name, value| {
            let port = lanes.port(name);
            lanes.set_all(port, value);
        };
        set("bit_cycles", u128::from(conditions.system_mhz * 2 / 5));
        set("request_id", 2);
        set("reply_gap_us", 4);
        set("field_gap_us", 1);
        set("filter_cycles", 1);
        set("rx", 1);
        let mut many = Self {
            rx: lanes.port("rx"),
            tick: lanes.port("tick_us"),
            trigger: lanes.port("trigger"),
            driver: lanes.port("driver"),
            said: ["fresh", "flags", "status", "encoder_id", "sequence"].map(|n| lanes.port(n)),
            lanes,
            conditions,
            rng: Rng::new(seed),
            cycle: 0,
        };
        // The line is at rest after power-up.
        many.run(70 * conditions.system_mhz, &[]);
        many
    }

    fn period(&self) -> f64 {
        1e6 / self.conditions.system_mhz as f64
    }

    /// Runs cycles; `toggles` are cycle, part and lanes whose line changes before it.
    fn run(&mut self, cycles: u64, toggles: &[(u64, usize, u64)]) {
        let mut levels = [u64::MAX; 2];
        let mut next = toggles.iter().peekable();
        for at in 0..cycles {
            while let Some((_, part, lanes)) = next.next_if(|(cycle, _, _)| *cycle <= at) {
                levels[*part] ^= lanes;
                self.lanes.set_word(self.rx, 0, *part, levels[*part]);
            }
            self.step();
        }
    }

    fn step(&mut self) {
        self.cycle += 1;
        let tick = self.cycle.is_multiple_of(self.conditions.system_mhz);
        self.lanes.set_all(self.tick, tick.into());
        self.lanes.tick();
    }

    /// One exchange in every lane.
    pub fn exchange(&mut self, mut sent: impl FnMut(usize, &mut Rng) -> Sent) -> Vec<Said> {
        self.lanes.set_all(self.trigger, 1);
        self.step();
        self.lanes.set_all(self.trigger, 0);
        while self.lanes.get(self.driver, 0) == 1 {
            self.step();
        }
        let nominal = BIT as i64;
        let wire = Wire {
            bit: (nominal * 1_000_000 / (1_000_000 + self.conditions.rate_error_ppm)) as Time,
            jitter: self.conditions.jitter,
        };
        let mut toggles = vec![];
        let mut last = 0;
        for lane in 0..LANES {
            let sent = sent(lane, &mut self.rng);
            let changes = match &sent.levels {
                Some(levels) => wire.changes(levels, sent.after, &mut self.rng),
                None => edges(&sent.bytes, &wire, sent.after, &mut self.rng),
            };
            for (time, _) in changes {
                let cycle = (time as f64 / self.period()).ceil() as u64;
                toggles.push((cycle, lane / 64, 1 << (lane % 64)));
                last = last.max(cycle);
            }
        }
        toggles.sort_unstable();
        // Longer than any time-out, and until the line is idle again.
        self.run(last + 25 * self.conditions.system_mhz, &toggles);
        (0..LANES).map(|lane| self.said(lane)).collect()
    }

    fn said(&mut self, lane: usize) -> Said {
        let [fresh, flags, status, encoder_id, sequence] =
            self.said.map(|port| self.lanes.get(port, lane));
        Said {
            fresh: fresh == 1,
            cause: match flags {
                0 => 0,
                _ => u64::from(flags.trailing_zeros()) + 1,
            },
            status: status as u8,
            encoder_id: encoder_id as u8,
            sequence: sequence as u8,
        }
    }
}

/// A reply to the request for the kind of encoder.
pub fn kind_reply(rng: &mut Rng) -> Vec<u8> {
    let [status, kind, ..] = rng.next_u64().to_le_bytes();
    // No error bits.
    let status = status & 0x3F;
    vec![control(2), status, kind, control(2) ^ status ^ kind]
}

/// Levels of bytes on the line.
pub fn levels(bytes: &[u8]) -> Vec<bool> {
    let field = |byte: &u8| {
        let field = u16::from(*byte) << 1 | 1 << 9;
        (0..10).map(move |i| field >> i & 1 == 1)
    };
    bytes.iter().flat_map(field).collect()
}
