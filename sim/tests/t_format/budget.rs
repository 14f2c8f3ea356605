//! Single upsets of every flip-flop at every time of every kind of exchange, in lanes: no undetected wrong position, no hang,
//! no driver conflict with the encoder, and no unrequested write to an EEPROM.

use endat_hdl::protocols::t_format::dsp::{AsyncDsp, TFormatStart};
use endat_hdl::protocols::t_format::port::TFormatPort;
use endat_sim::encoder::Drive;
use endat_sim::rng::Rng;
use endat_sim::t_format::{Encoder, EncoderConfig};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Keep, LaneWords, Lanes, PortId};
use rust_hdl::prelude::Block;
use std::collections::BTreeMap;

const LANES: usize = 128;
/// Times of an exchange at which each flip-flop is upset in the slow tests, and in the quick ones.
const MOMENTS: u64 = 65;
const FEW_MOMENTS: u64 = 3;
const SYSTEM_MHZ: u64 = 20;
/// Time from the start of an exchange until its result is read.
const EXCHANGE_US: u64 = 95;
/// Time after an upset, for an encoder that still answers and a line that must be at rest.
const QUIET_US: u64 = 60;
/// Exchanges that may be lost or bad after an upset.
const TRIGGERS: usize = 2;
/// The longest request: four fields, and the microseconds by which a wait may be longer.
const REQUEST_US: u64 = 4 * 4 + 3;
/// An upset may turn a request on the wire into one with a single field: its reply arrives while the other three are sent.
const GARBLED_US: u64 = 3 * 4;
/// Undetected wrong positions of all flips, in parts per thousand.
const SILENT_PER_MILLE: usize = 5;
const BEFORE: u64 = 0x1234_56A5_3C96;

/// Exchange during an upset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Single,
    Everything,
    Read,
    Write,
    Reset,
}

impl Kind {
    const ALL: [Self; 5] = [
        Self::Single,
        Self::Everything,
        Self::Read,
        Self::Write,
        Self::Reset,
    ];

    fn id(self) -> u64 {
        match self {
            Self::Single => 0,
            Self::Everything => 3,
            Self::Read => 13,
            Self::Write => 6,
            Self::Reset => 12,
        }
    }

    /// The position during the exchange.
    fn position(self) -> u64 {
        match self {
            Self::Single => BEFORE & !0xFF_FFFF | 0x5A_C369,
            Self::Everything => 0x6543_215A_C369,
            _ => BEFORE,
        }
    }
}

const ADDRESS: u64 = 5;
const DATA: u64 = 0x5A;
const ASKED: [u8; 4] = [0x32, 0x05, 0x5A, 0x32 ^ 0x05 ^ 0x5A];

/// Outputs of a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Shown {
    position: u64,
    valid: [bool; 2],
    fresh: bool,
    cause: u64,
    /// Number of results so far, if there is a count.
    sequence: u64,
    /// The request of the result, if shown.
    id: u64,
}

impl Shown {
    /// The parts shown as good belong to one of these positions.
    fn is_one_of(&self, positions: &[u64]) -> bool {
        let part = |word: u64, part: usize| word >> (24 * part) & 0xFF_FFFF;
        (0..2).all(|p| {
            let right = |at: &u64| part(*at, p) == part(self.position, p);
            !self.valid[p] || positions.iter().any(right)
        })
    }
}

/// The receiver in all lanes, with an encoder each.
#[derive(Clone)]
struct Many {
    lanes: Lanes,
    is_card: bool,
    line: [PortId; 3],
    encoders: Vec<Encoder>,
    due: Vec<u64>,
    next_due: u64,
    cycle: u64,
    levels: [u64; 2],
    drivers: [u64; 2],
    encoder_drives: [u64; 2],
    rx: [u64; 2],
    driven_since: Vec<u64>,
    longest_drive: Vec<u64>,
    conflict: Vec<u64>,
    /// Cycle, lane, register and bit of the upsets.
    flips: Vec<(u64, usize, usize, usize)>,
}

impl Many {
    fn new(is_card: bool) -> Self {
        let design = if is_card {
            let mut block = TFormatPort::new(true);
            block.connect_all();
            elaborate(&block, "port").unwrap()
        } else {
            let mut block = AsyncDsp::new(
                &TFormatStart {
                    reply_gap_us: 4,
                    field_gap_us: 1,
                    ..TFormatStart::default()
                },
                true,
            );
            block.connect_all();
            elaborate(&block, "async_dsp").unwrap()
        };
        let mut lanes = Lanes::new(&design, Keep::Registers, LaneWords::Two).unwrap();
        let settings: &[(&str, u128)] = if is_card {
            &[
                ("bit_cycles", 8),
                ("request_id", 3),
                ("reply_gap_us", 4),
                ("field_gap_us", 1),
                ("filter_cycles", 1),
                ("data_i", 1),
            ]
        } else {
            &[
                ("bus_cs_n_i", 1),
                ("bus_rd_n_i", 1),
                ("bus_wr_n_i", 1),
                ("encoder_data_i", 1),
            ]
        };
        for (name, value) in settings {
            let port = lanes.port(name);
            lanes.set_all(port, *value);
        }
        let line = match is_card {
            true => ["data_i", "data_o", "data_oe"],
            false => ["encoder_data_i", "encoder_data_o", "encoder_data_oe"],
        };
        let config = EncoderConfig {
            status: 0,
            single_turn: BEFORE as u32 & 0xFF_FFFF,
            multi_turn: (BEFORE >> 24) as u32,
            ..EncoderConfig::default()
        };
        let encoder = Encoder::new(config);
        let mut many = Self {
            line: line.map(|name| lanes.port(name)),
            lanes,
            is_card,
            encoders: vec![encoder; LANES],
            due: vec![u64::MAX; LANES],
            next_due: u64::MAX,
            cycle: 0,
            levels: [u64::MAX; 2],
            drivers: [0; 2],
            encoder_drives: [0; 2],
            rx: [u64::MAX; 2],
            driven_since: vec![0; LANES],
            longest_drive: vec![0; LANES],
            conflict: vec![0; LANES],
            flips: vec![],
        };
        // After power-up no request is sent.
        many.us(70);
        many.begin(3);
        many.us(EXCHANGE_US);
        many
    }

    fn now(&self) -> u64 {
        self.cycle * (1_000_000 / SYSTEM_MHZ)
    }

    /// A lane's encoder has acted, or may have.
    fn look(&mut self, lane: usize) {
        let (part, bit) = (lane / 64, 1u64 << (lane % 64));
        let encoder = &self.encoders[lane];
        let period = 1_000_000 / SYSTEM_MHZ;
        self.due[lane] = encoder
            .next_event()
            .map_or(u64::MAX, |t| t.div_ceil(period));
        let set = |word: &mut u64, on: bool| *word = *word & !bit | if on { bit } else { 0 };
        set(&mut self.rx[part], encoder.output() != Drive::Low);
        set(
            &mut self.encoder_drives[part],
            encoder.output() != Drive::Released,
        );
    }

    #[allow(clippy::needless_range_loop)] // two parallel arrays
    fn step(&mut self) {
        while let Some((_, lane, register, bit)) =
            self.flips.pop_if(|(cycle, ..)| *cycle <= self.cycle)
        {
            self.lanes.flip(register, bit, lane);
        }
        let now = self.now();
        let [rx, tx, oe] = self.line;
        let before = self.rx;
        for part in 0..2 {
            let levels = self.lanes.word(tx, 0, part);
            let drivers = self.lanes.word(oe, 0, part);
            let switched = drivers ^ self.drivers[part];
            let mut changed = switched | ((levels ^ self.levels[part]) & drivers);
            (self.levels[part], self.drivers[part]) = (levels, drivers);
            while changed != 0 {
                let bit = changed.trailing_zeros() as usize;
                changed &= changed - 1;
                let lane = 64 * part + bit;
                let is_on = drivers >> bit & 1 == 1;
                if switched >> bit & 1 == 1 {
                    match is_on {
                        true => self.driven_since[lane] = self.cycle,
                        false => {
                            let length = self.cycle - self.driven_since[lane];
                            self.longest_drive[lane] = self.longest_drive[lane].max(length);
                        }
                    }
                }
                let drive = match is_on {
                    true => Drive::level(levels >> bit & 1 == 1),
                    false => Drive::Released,
                };
                self.encoders[lane].receiver(now, drive);
                self.look(lane);
                self.next_due = self.next_due.min(self.due[lane]);
            }
        }
        if self.next_due <= self.cycle {
            for lane in 0..LANES {
                if self.due[lane] <= self.cycle {
                    self.encoders[lane].advance(now);
                    self.look(lane);
                }
            }
            self.next_due = self.due.iter().copied().min().unwrap();
        }
        for part in 0..2 {
            if self.rx[part] != before[part] {
                self.lanes.set_word(rx, 0, part, self.rx[part]);
            }
            let mut both = self.drivers[part] & self.encoder_drives[part];
            while both != 0 {
                self.conflict[64 * part + both.trailing_zeros() as usize] += 1;
                both &= both - 1;
            }
        }
        if self.is_card {
            let tick = self.cycle.is_multiple_of(SYSTEM_MHZ);
            self.set("tick_us", tick.into());
            self.set("timestamp", u128::from(self.cycle));
        }
        self.lanes.tick();
        self.cycle += 1;
    }

    fn steps(&mut self, cycles: u64) {
        (0..cycles).for_each(|_| self.step());
    }

    fn us(&mut self, us: u64) {
        self.steps(us * SYSTEM_MHZ);
    }

    fn set(&mut self, name: &str, value: u128) {
        let port = self.lanes.port(name);
        self.lanes.set_all(port, value);
    }

    fn bus_write(&mut self, address: u128, data: u64) {
        self.set("bus_address_i", address);
        self.set("bus_data_i", data.into());
        self.set("bus_cs_n_i", 0);
        self.set("bus_wr_n_i", 0);
        self.steps(4);
        self.set("bus_cs_n_i", 1);
        self.set("bus_wr_n_i", 1);
        self.steps(4);
    }

    fn bus_read(&mut self, address: u128) -> Vec<u64> {
        self.set("bus_address_i", address);
        self.set("bus_cs_n_i", 0);
        self.set("bus_rd_n_i", 0);
        self.steps(4);
        let port = self.lanes.port("bus_data_o");
        let words = (0..LANES).map(|lane| self.lanes.get(port, lane) as u64);
        let words = words.collect();
        self.set("bus_cs_n_i", 1);
        self.set("bus_rd_n_i", 1);
        self.step();
        words
    }

    /// A request with this ID.
    fn begin(&mut self, id: u64) {
        if !self.is_card {
            if id == 6 || id == 13 {
                self.bus_write(7, ADDRESS | DATA << 8);
            }
            return self.bus_write(0, id);
        }
        if id == 0 || id == 3 {
            self.set("request_id", id.into());
            self.set("trigger", 1);
            self.step();
            return self.set("trigger", 0);
        }
        for (half, data) in [(1, id), (0, ADDRESS << 8 | DATA)] {
            self.set("host_half", half);
            self.set("host_data", data.into());
            self.set("host_write", 1);
            self.step();
            self.set("host_write", 0);
            self.steps(3);
        }
    }

    fn shown(&mut self) -> Vec<Shown> {
        if self.is_card {
            let ports = ["position", "position_valid", "fresh", "cause", "sequence"];
            let ports = ports.map(|name| self.lanes.port(name));
            let parts = ["has_had_single", "has_had_multi"];
            let parts = parts.map(|name| self.lanes.nets().position(|n| n == name).unwrap());
            let shown = (0..LANES).map(|lane| {
                let [position, valid, fresh, cause, sequence] =
                    ports.map(|port| self.lanes.get(port, lane) as u64);
                Shown {
                    position,
                    valid: parts.map(|net| valid == 1 && self.lanes.peek(net, lane) == Some(1)),
                    fresh: fresh == 1,
                    cause,
                    sequence,
                    id: 0,
                }
            });
            return shown.collect();
        }
        let words: Vec<Vec<u64>> = (0..8).map(|address| self.bus_read(address)).collect();
        let shown = (0..LANES).map(|lane| {
            let word = |address: usize| words[address][lane];
            let single = word(1) >> 8 | word(2) << 8;
            let multi = word(3) >> 8 | word(4) << 8;
            Shown {
                position: single | multi << 24,
                valid: [12, 13].map(|bit| word(7) >> bit & 1 == 1),
                fresh: word(1) >> 7 & 1 == 1,
                cause: word(7) >> 8 & 15,
                sequence: 0,
                id: word(1) & 15,
            }
        });
        shown.collect()
    }

    fn turn_to(&mut self, position: u64) {
        for encoder in &mut self.encoders {
            encoder.config.single_turn = position as u32 & 0xFF_FFFF;
            encoder.config.multi_turn = (position >> 24) as u32;
        }
    }
}

/// Results of the flips of one register.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    flips: usize,
    told: usize,
    silent: usize,
    hung: usize,
    conflicts: usize,
    long_drives: usize,
    unasked: usize,
}

/// Upsets all registers in all kinds of exchange.
fn campaign(is_card: bool, moments: u64) -> BTreeMap<String, Tally> {
    let base = Many::new(is_card);
    let names: Vec<String> = base.lanes.nets().map(String::from).collect();
    let registers: Vec<usize> = base.lanes.registers().collect();
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for kind in Kind::ALL {
        let mut rng = Rng::new(kind.id() + 1);
        let mut plan = vec![];
        // Duration, and outputs without an upset.
        let begin = base.cycle;
        let mut plain = base.clone();
        plain.turn_to(kind.position());
        plain.begin(kind.id());
        plain.us(EXCHANGE_US);
        let good = plain.shown()[0];
        let span = plain.cycle - begin;
        assert!(good.fresh && good.cause == 0, "{kind:?} {good:?}");
        assert!(good.valid == [true; 2] && good.position == kind.position());
        assert_eq!(plain.conflict[0], 0);
        for register in &registers {
            for bit in 0..base.lanes.width_bits(*register) {
                for moment in 0..moments {
                    let (from, to) = (moment * span / moments, (moment + 1) * span / moments);
                    let cycle = begin + rng.in_range(from, to - 1);
                    plan.push((cycle, *register, bit));
                }
            }
        }
        // Lanes of a batch are upset at similar times.
        for batch in plan.chunks(LANES) {
            let mut many = base.clone();
            let flips = batch.iter().enumerate();
            many.flips = flips
                .map(|(lane, (cycle, register, bit))| (*cycle, lane, *register, *bit))
                .collect();
            many.flips.sort_unstable_by(|a, b| b.cmp(a));
            many.turn_to(kind.position());
            many.begin(kind.id());
            many.us(EXCHANGE_US);
            let seen = many.shown();
            many.us(QUIET_US);
            let mut is_silent = [false; LANES];
            let mut is_told = [false; LANES];
            for lane in 0..batch.len() {
                let it = seen[lane];
                let is_whole = it.fresh && it.valid == [true; 2] && it.id == good.id;
                is_told[lane] = it.cause != 0 || !is_whole;
                // An exchange that did not take place is no result.
                let is_counted = !is_card || it.sequence != good.sequence;
                is_silent[lane] = !it.is_one_of(&[BEFORE, kind.position()])
                    || (!is_told[lane] && is_counted) && !it.is_one_of(&[kind.position()]);
            }
            // The exchanges after it.
            let mut good_at_last = [false; LANES];
            for turn in 0..=TRIGGERS {
                let position = 0x2222_2211_1111 * (1 + turn as u64);
                many.turn_to(position);
                if !is_card {
                    let start = TFormatStart {
                        reply_gap_us: 4,
                        field_gap_us: 1,
                        ..TFormatStart::default()
                    };
                    many.bus_write(6, start.word());
                }
                many.begin(3);
                many.us(EXCHANGE_US + QUIET_US);
                for (lane, it) in many.shown().iter().enumerate() {
                    good_at_last[lane] = it.fresh && it.cause == 0 && it.valid == [true; 2];
                    is_silent[lane] |= good_at_last[lane] && it.position != position;
                }
            }
            for (lane, (cycle, register, _)) in batch.iter().enumerate() {
                let tally = tallies.entry(names[*register].clone()).or_default();
                tally.flips += 1;
                tally.told += usize::from(is_told[lane]);
                tally.silent += usize::from(is_silent[lane]);
                tally.hung += usize::from(!good_at_last[lane]);
                tally.conflicts += usize::from(many.conflict[lane] > GARBLED_US * SYSTEM_MHZ);
                let longest = many.longest_drive[lane];
                tally.long_drives += usize::from(longest > REQUEST_US * SYSTEM_MHZ);
                let requests = many.encoders[lane].requests();
                let writes = requests.iter().filter(|r| r[0] >> 3 & 15 == 6);
                let writes: Vec<_> = writes.collect();
                let asked = usize::from(kind == Kind::Write);
                let is_asked = writes.len() <= asked && writes.iter().all(|w| w[..] == ASKED);
                if !is_asked {
                    println!("{} {kind:?} {} {writes:?}", names[*register], cycle - begin);
                }
                tally.unasked += usize::from(!is_asked);
            }
        }
    }
    tallies
}

/// Checks the budgets; names that begin with `elsewhere` have a separate test.
fn holds(is_card: bool, elsewhere: &str, moments: u64) {
    let tallies = campaign(is_card, moments);
    let sum = |of: fn(&Tally) -> usize| tallies.values().map(of).sum::<usize>();
    let flips = sum(|t| t.flips);
    let show = |of: fn(&Tally) -> usize| {
        let mut rows: Vec<_> = tallies.iter().filter(|(_, t)| of(t) > 0).collect();
        rows.sort_by_key(|(_, t)| std::cmp::Reverse(of(t)));
        let rows = rows.iter().map(|(name, t)| format!("{name} {}", of(t)));
        rows.collect::<Vec<_>>().join(", ")
    };
    let table = format!(
        "{flips} flips, {} told; silent {}: {}; hung: {}; conflicts: {}; long drives: {}; unasked: {}",
        sum(|t| t.told),
        sum(|t| t.silent),
        show(|t| t.silent),
        show(|t| t.hung),
        show(|t| t.conflicts),
        show(|t| t.long_drives),
        show(|t| t.unasked),
    );
    println!("{table}");
    let silent = tallies
        .iter()
        .filter(|(name, _)| !name.starts_with(elsewhere));
    let silent: usize = silent.map(|(_, t)| t.silent).sum();
    assert!(silent * 1000 <= SILENT_PER_MILLE * flips, "{table}");
    let none = sum(|t| t.hung + t.conflicts + t.long_drives + t.unasked);
    assert_eq!(none, 0, "{table}");
}

/// All protocols share the snapshot.
const SNAPSHOT: &str = "snapshot.";

#[test]
fn an_upset_of_a_card_s_port_is_masked_or_reported() {
    holds(true, SNAPSHOT, FEW_MOMENTS);
}

#[test]
fn an_upset_of_the_receiver_is_masked_or_reported() {
    holds(false, "none", FEW_MOMENTS);
}

#[test]
#[ignore = "slow: every flip-flop at 65 moments of every exchange"]
fn an_upset_of_a_card_s_port_is_masked_or_reported_and_drives_and_writes_nothing() {
    holds(true, SNAPSHOT, MOMENTS);
}

#[test]
#[ignore = "slow: every flip-flop at 65 moments of every exchange"]
fn an_upset_of_the_receiver_is_masked_or_reported_and_drives_and_writes_nothing() {
    holds(false, "none", MOMENTS);
}
