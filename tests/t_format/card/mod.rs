//! Cards that mix protocols, over their registers.

mod faults;
mod memory;
mod neighbours;
mod services;
mod three_ways;

use crate::bus::Master;
use endat_config::{parse, Project};
use endat_hdl::regs::{Block, CARD, CHANNEL_CONFIG, DIRECT, INTERRUPT, RESULT, T_FORMAT};
use endat_sim::bench::{PinNames, TFormatLink};
use endat_sim::t_format::EncoderConfig;
use endat_sim::{Time, US};

pub const ENDAT: &str = "[[channel]]\nposition_bits = 29\ncommand = \"111000\"\n";
pub const T: &str = "[[channel]]\nprotocol = \"t_format\"\n";
/// Cycles of a microsecond.
pub const CYCLES: u64 = 100;

/// A card with these channels behind APB.
pub fn project(channels: &[&str], sources: &str, more: &str) -> Project {
    let text = format!(
        "name = \"mixed\"\n[clock]\nsystem_hz = 100_000_000\n[endat]\nclock_hz = 3_125_000\n{}\
         [trigger]\nsample_hz = 10_000\nsources = [{sources}]\n[host]\nbus = \"apb\"\n{more}",
        channels.concat()
    );
    parse("mixed.toml", &text).unwrap()
}

pub fn at(block: &Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// A result as the registers have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seen {
    pub sequence: u32,
    pub cause: u64,
    pub valid: bool,
    pub fresh: bool,
    pub position: u64,
    pub timestamp: u32,
}

/// What `answer` says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    pub data: u8,
    pub id: u8,
    pub cause: u64,
    pub done: bool,
    pub busy: bool,
}

/// A mixed card with one EnDat encoder and one T-format encoder.
pub struct Rig {
    pub master: Master,
    pub endat: usize,
    pub t_format: usize,
}

/// The positions of a shaft that nobody can guess; latched by the request.
pub fn shaft(time: Time) -> (u32, u32) {
    let mixed = (time / 1_000).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (
        (mixed >> 8) as u32 & 0xFF_FFFF,
        (mixed >> 40) as u32 & 0xFF_FFFF,
    )
}

impl Rig {
    /// EnDat on channel 0, or on channel 1 if `is_swapped`.
    pub fn new(is_swapped: bool, sources: &str) -> Self {
        Self::with(
            is_swapped,
            sources,
            "",
            EncoderConfig {
                status: 0,
                ..EncoderConfig::default()
            },
        )
    }

    pub fn with(is_swapped: bool, sources: &str, more: &str, config: EncoderConfig) -> Self {
        let (endat, t_format) = if is_swapped { (1, 0) } else { (0, 1) };
        let mut channels = [ENDAT; 2];
        channels[t_format] = T;
        let project = project(&channels, sources, more);
        let mut master = Master::at_channels(&project, &[(endat, 29)]);
        let mut link = TFormatLink::new(config, US / 10);
        link.set_motion(std::sync::Arc::new(shaft));
        master.bench.add_t_format(&PinNames::card(t_format), link);
        // After power-up no request goes out before the line has been at rest.
        master.bench.run_cycles(90 * CYCLES);
        Self {
            master,
            endat,
            t_format,
        }
    }

    /// Runs for some microseconds.
    pub fn us(&mut self, us: u64) {
        self.master.bench.run_cycles(us * CYCLES);
    }

    pub fn trigger(&mut self) {
        self.master.write(at(&CARD, "trigger_now", 0), 1);
    }

    /// The result of a channel; its words of one moment.
    pub fn result(&mut self, channel: usize) -> Seen {
        let first = at(&RESULT, "status", channel);
        let words = [0, 1, 2, 3].map(|n| self.master.read(first + n));
        Seen {
            sequence: words[0] & 0xFFFF,
            cause: u64::from(words[0] >> 16 & 31),
            valid: words[0] >> 22 & 1 == 1,
            fresh: words[0] >> 23 & 1 == 1,
            position: u64::from(words[1]) | u64::from(words[2] & 0xFFFF) << 32,
            timestamp: words[3],
        }
    }

    /// The position that the last reply with everything carried.
    pub fn replied(&self) -> Option<u64> {
        let replies = self.master.bench.t_format(0).encoder().replies();
        let last = replies.iter().rfind(|r| r.len() == 11)?;
        let part = |at: usize| {
            u64::from(u32::from_le_bytes([
                last[at],
                last[at + 1],
                last[at + 2],
                0,
            ]))
        };
        Some(part(2) | part(6) << 24)
    }

    pub fn send(&mut self, id: u8, address: u8, data: u8) {
        let word = u32::from(data) | u32::from(address) << 8 | u32::from(id) << 16;
        self.master
            .write(at(&T_FORMAT, "send", self.t_format), word);
    }

    pub fn answer(&mut self) -> Answer {
        let word = self.master.read(at(&T_FORMAT, "answer", self.t_format));
        Answer {
            data: word as u8,
            id: (word >> 8) as u8 & 15,
            cause: u64::from(word >> 12 & 15),
            done: word >> 16 & 1 == 1,
            busy: word >> 17 & 1 == 1,
        }
    }

    /// Sends a request and waits for its end.
    pub fn request(&mut self, id: u8, address: u8, data: u8) -> Answer {
        self.send(id, address, data);
        for _ in 0..2_000 {
            let answer = self.answer();
            if answer.done {
                assert!(!answer.busy);
                return answer;
            }
            assert!(answer.busy);
        }
        panic!("the request does not end");
    }

    /// Another word of the channel's configuration.
    pub fn configure(&mut self, name: &str, field: &str, value: u32) {
        let register = CHANNEL_CONFIG.register(name).unwrap();
        let field = register.field(field).unwrap();
        let address = CHANNEL_CONFIG.address(register, self.t_format);
        let before = self.master.read(address);
        let word = before & !field.mask() | value << field.lsb;
        self.master.write(address, word);
    }

    /// Neither encoder has anything to complain about.
    pub fn check_encoders(&self) {
        assert_eq!(self.master.bench.violations(0), []);
        assert_eq!(self.master.bench.t_format(0).encoder().violations(), []);
    }
}

/// In so many results; EnDat on channel 0, or on channel 1 if `is_swapped`.
fn both_channels_are_read_right(is_swapped: bool, results: u64) {
    let mut rig = Rig::new(is_swapped, "\"timer\"");
    let clock = format!("endat_clk{}_o", rig.t_format);
    // The first EnDat frame measures the delay. Then from the middle of one pause to that of the next.
    rig.us(450);
    let mut last = rig.result(rig.t_format).sequence;
    while rig.result(rig.t_format).sequence == last {
        rig.us(1);
    }
    last += 1;
    rig.us(15);
    let start = rig.master.bench.cycle();
    let mut behind = None;
    for round in 0..results {
        while rig.master.bench.cycle() < start + 100 * CYCLES * (round + 1) {
            rig.master.bench.run_cycles(1);
            assert_eq!(rig.master.bench.get(&clock), 1, "a clock for T-format");
        }
        let (endat, t_format) = (rig.result(rig.endat), rig.result(rig.t_format));
        assert_eq!(t_format.sequence, last + 1, "{round}");
        last = t_format.sequence;
        for seen in [endat, t_format] {
            assert!(
                seen.cause == 0 && seen.valid && seen.fresh,
                "{round} {seen:?}"
            );
        }
        let frame = rig.master.bench.frames(0).last().unwrap();
        assert_eq!(endat.position, frame.position, "{round}");
        assert_eq!(Some(t_format.position), rig.replied(), "{round}");
        // One trigger: the request follows the frame's first edge by a constant.
        let apart = t_format.timestamp.wrapping_sub(endat.timestamp);
        assert_eq!(*behind.get_or_insert(apart), apart);
    }
    // Half a bit of 40 cycles, and the registers on both ways.
    assert_eq!(behind, Some(19));
    rig.check_encoders();
}

#[test]
fn both_channels_are_triggered_together_and_read_right() {
    both_channels_are_read_right(false, 20);
    both_channels_are_read_right(true, 20);
}

#[test]
#[ignore = "slow: hundreds of results of a card with two protocols"]
fn both_channels_are_triggered_together_and_read_right_hundreds_of_times() {
    both_channels_are_read_right(false, 200);
    both_channels_are_read_right(true, 200);
}

#[test]
fn requests_that_bring_a_part_leave_the_other_as_it_was() {
    let mut rig = Rig::new(false, "\"register\"");
    let parts = at(&T_FORMAT, "parts", 1);
    let mut known = (None, None);
    for (id, has_single, has_multi) in [
        (2, false, false),
        (0, true, false),
        (1, false, true),
        (3, true, true),
        (0, true, false),
        (2, false, false),
        (1, false, true),
    ] {
        rig.configure("timing", "request_id", id);
        let before = rig.result(1);
        rig.trigger();
        rig.us(400);
        let replies = rig.master.bench.t_format(0).encoder().replies();
        let last = replies.last().unwrap().clone();
        let part = |at: usize| {
            u64::from(u32::from_le_bytes([
                last[at],
                last[at + 1],
                last[at + 2],
                0,
            ]))
        };
        if has_single {
            known.0 = Some(part(2));
        }
        if has_multi {
            known.1 = Some(part(if has_single { 6 } else { 2 }));
        }
        let seen = rig.result(1);
        assert_eq!(seen.sequence, before.sequence + 1);
        assert_eq!(seen.cause, 0, "{id}");
        assert_eq!(seen.fresh, has_single || has_multi, "{id}");
        assert_eq!(seen.valid, known != (None, None));
        let position = known.0.unwrap_or(0) | known.1.unwrap_or(0) << 24;
        assert_eq!(seen.position, position, "{id}");
        let valid = u32::from(known.0.is_some()) | u32::from(known.1.is_some()) << 1;
        assert_eq!(rig.master.read(parts), valid, "{id}");
    }
    rig.check_encoders();
}

/// Cards with so many channels, of which those in the mask speak T-format, elaborate, and their words report the mask.
fn protocols_come_in_order(cards: &[(usize, u32)]) {
    for &(count, mask) in cards {
        let channels: Vec<&str> = (0..count)
            .map(|n| if mask >> n & 1 == 1 { T } else { ENDAT })
            .collect();
        let channels = match mask == (1 << count) - 1 {
            true => vec![T; count],
            false => channels,
        };
        let text = format!(
            "name = \"mixed\"\n[clock]\nsystem_hz = 100_000_000\n{}[trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n[host]\nbus = \"apb\"\n",
            channels.concat().replace("command", "clock_hz = 2_000_000\ncommand")
        );
        let project = parse("mixed.toml", &text).unwrap();
        let mut master = Master::at_channels(&project, &[]);
        assert_eq!(master.read(at(&CARD, "protocols", 0)), mask);
        for n in 0..count {
            // An unknown request is refused without a line.
            master.write(at(&T_FORMAT, "send", n), 4 << 16);
            master.bench.run_cycles(400);
            let answer = master.read(at(&T_FORMAT, "answer", n));
            let expected = if mask >> n & 1 == 1 { 0x1_1000 } else { 0 };
            assert_eq!(answer, expected, "{count} channels, {mask:b}, {n}");
        }
    }
}

#[test]
fn protocols_come_in_two_orders() {
    protocols_come_in_order(&[(1, 1), (3, 0b101)]);
}

#[test]
#[ignore = "slow: cards of up to eight channels with two protocols"]
fn protocols_come_in_any_order() {
    protocols_come_in_order(&[
        (1, 1),
        (3, 0b101),
        (8, 0b1101_0110),
        (8, 0xFF),
        (5, 0b1_0000),
    ]);
}

#[test]
fn outputs_and_interrupt_follow_a_t_format_channel() {
    let parts = "[outputs]\nparts = [\"position\", \"interrupt\"]\n";
    let config = EncoderConfig {
        status: 0,
        ..EncoderConfig::default()
    };
    let mut rig = Rig::with(false, "\"register\"", parts, config);
    let [status, clear] = ["status", "clear"].map(|name| at(&INTERRUPT, name, 0));
    // The line has just become HIGH.
    rig.us(1);
    rig.trigger();
    rig.us(400);
    assert_eq!(rig.master.read(status), 0x11, "a result of each channel");
    let seen = rig.result(1);
    let direct = rig.master.bench.get("direct_position1_o") as u64;
    assert_eq!(direct, seen.position & 0xFFFF_FFFF);
    assert_eq!(rig.master.bench.get("direct_valid1_o"), 1);
    assert_eq!(rig.master.bench.get("direct_error1_o"), 0);
    rig.master.write(clear, u32::MAX);
    rig.request(2, 0, 0);
    assert_eq!(rig.master.read(status), 0x80, "the request has ended");
    rig.master.write(clear, u32::MAX);
    rig.master.bench.t_format_mut(0).unplug();
    // Behind the rest.
    rig.us(3);
    rig.trigger();
    rig.us(200);
    assert_eq!(rig.master.read(status), 0x31, "results, one of them bad");
    assert_eq!(rig.master.bench.get("direct_error1_o"), 1);
    assert_eq!(rig.master.bench.get("direct_valid1_o"), 0);
    // Of all causes but this one.
    let cause = rig.result(1).cause;
    rig.master
        .write(at(&DIRECT, "error_causes", 1), !(1 << cause));
    rig.us(1);
    assert_eq!(rig.master.bench.get("direct_error1_o"), 0);
}
