//! Any state of a T-format port, reachable or not: the next triggers work, nothing hangs.

use endat_hdl::protocols::t_format::{channel::TFormatChannel, port::TFormatPort};
use endat_sim::encoder::Drive;
use endat_sim::rng::Rng;
use endat_sim::t_format::{Encoder, EncoderConfig};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::{Compiled, Engine, Keep, PortId};
use rust_hdl::prelude::Block;

/// Registers up to this width get every value, wider ones have each of their bits inverted.
const ALL_VALUES_BITS: usize = 6;
/// Times of the exchange at which each of them is upset in the slow tests.
const MOMENTS: u64 = 16;
/// Triggers that may be lost or bad after an upset.
const TRIGGERS: usize = 2;
const SYSTEM_MHZ: u64 = 20;
/// An exchange of request 3, its pauses, and the rest after it, in microseconds.
const EXCHANGE_US: u64 = 60;
/// The longest wait after an upset: a wrapping 7-bit timer, or a field, and the line at rest.
const LIMIT_US: u64 = 250;
/// Time after an exchange, for an encoder that still answers and a line that must be at rest, in microseconds.
const QUIET_US: u64 = 90;
const SINGLE_TURN: u32 = 0xA5_3C96;
const MULTI_TURN: u32 = 0x5A_C369;

/// A port by the names of its signals.
struct Port {
    engine: Compiled,
    line: [PortId; 3],
    controls: [PortId; 2],
    state: [PortId; 2],
    position: Vec<PortId>,
    expected: Vec<u128>,
}

impl Port {
    fn new(design: &Design, line: [&str; 3], position: &[&str], expected: &[u128]) -> Self {
        let mut engine = Compiled::keeping(design, Keep::Registers).unwrap();
        let settings = [
            ("bit_cycles", 8),
            ("request_id", 3),
            ("reply_gap_us", 4),
            ("field_gap_us", 1),
            ("filter_cycles", 1),
            (line[0], 1),
        ];
        for (name, value) in settings {
            let port = engine.port(name);
            engine.set(port, value);
        }
        Self {
            line: line.map(|n| engine.port(n)),
            controls: ["tick_us", "trigger"].map(|n| engine.port(n)),
            state: ["busy", "fresh"].map(|n| engine.port(n)),
            position: position.iter().map(|n| engine.port(n)).collect(),
            expected: expected.to_vec(),
            engine,
        }
    }

    fn card() -> Self {
        let mut block = TFormatPort::new(true);
        block.connect_all();
        let design = elaborate(&block, "port").unwrap();
        let position = u128::from(MULTI_TURN) << 24 | u128::from(SINGLE_TURN);
        let line = ["data_i", "data_o", "data_oe"];
        Self::new(&design, line, &["position", "cause"], &[position, 0])
    }

    fn receiver() -> Self {
        let mut block = TFormatChannel::new(true);
        block.connect_all();
        let design = elaborate(&block, "channel").unwrap();
        let line = ["rx", "tx", "driver"];
        let position = ["single_turn", "multi_turn", "flags"];
        let expected = [SINGLE_TURN.into(), MULTI_TURN.into(), 0];
        Self::new(&design, line, &position, &expected)
    }
}

/// A port and its encoder, from power-up on.
struct Run<'a> {
    port: &'a Port,
    engine: Compiled,
    encoder: Encoder,
    cycle: u64,
}

impl<'a> Run<'a> {
    fn new(port: &'a Port) -> Self {
        let config = EncoderConfig {
            status: 0,
            single_turn: SINGLE_TURN,
            multi_turn: MULTI_TURN,
            ..EncoderConfig::default()
        };
        let mut run = Self {
            port,
            engine: port.engine.clone(),
            encoder: Encoder::new(config),
            cycle: 0,
        };
        // The line is at rest after power-up.
        run.cycles(70 * SYSTEM_MHZ);
        run
    }

    fn cycles(&mut self, count: u64) {
        for _ in 0..count {
            let [rx, tx, driver] = self.port.line;
            let drive = match (self.engine.get(driver), self.engine.get(tx)) {
                (0, _) => Drive::Released,
                (_, level) => Drive::level(level == 1),
            };
            let now = self.cycle * 1_000_000 / SYSTEM_MHZ;
            self.encoder.receiver(now, drive);
            let level = self.encoder.output() != Drive::Low;
            self.engine.set(rx, level.into());
            let tick = self.cycle.is_multiple_of(SYSTEM_MHZ);
            self.engine.set(self.port.controls[0], tick.into());
            self.engine.tick();
            self.cycle += 1;
        }
    }

    fn trigger(&mut self) {
        let trigger = self.port.controls[1];
        self.engine.set(trigger, 1);
        self.cycles(1);
        self.engine.set(trigger, 0);
    }

    /// Waits for the end of the present activity; false if there is no end.
    fn ends(&mut self) -> bool {
        let last = self.cycle + LIMIT_US * SYSTEM_MHZ;
        while self.cycle < last {
            self.cycles(SYSTEM_MHZ);
            if self.engine.get(self.port.state[0]) == 0 {
                return true;
            }
        }
        false
    }

    /// One trigger; true if its result is good.
    fn is_good(&mut self) -> bool {
        self.trigger();
        let ends = self.ends();
        self.cycles(QUIET_US * SYSTEM_MHZ);
        let port = self.port;
        let mut shows = port.position.iter().zip(&port.expected);
        let is_right = shows.all(|(id, expected)| self.engine.get(*id) == *expected);
        ends && is_right && self.engine.get(port.state[1]) == 1
    }
}

/// Upsets every register at all times, or each value of it at one time that varies; returns the number of upsets and the failures to
/// recover.
fn upset(port: &Port, all_moments: bool) -> (usize, Vec<String>) {
    let names: Vec<String> = port.engine.nets().map(String::from).collect();
    let registers: Vec<usize> = port.engine.registers().collect();
    let mut rng = Rng::new(5);
    let (mut count, mut lost) = (0, vec![]);
    assert!(Run::new(port).is_good());
    for register in registers {
        let width = port.engine.width_bits(register);
        let masks: Vec<u128> = match width {
            0..=ALL_VALUES_BITS => (1..1 << width).collect(),
            _ => (0..width).map(|bit| 1 << bit).collect(),
        };
        let places = masks.iter().flat_map(|m| (0..MOMENTS).map(move |n| (m, n)));
        let step = if all_moments { 1 } else { MOMENTS as usize + 1 };
        for (mask, moment) in places.step_by(step) {
            let span = EXCHANGE_US * SYSTEM_MHZ / MOMENTS;
            let cycle = moment * span + rng.in_range(0, span - 1);
            let mut run = Run::new(port);
            run.trigger();
            run.cycles(cycle);
            for bit in (0..width).filter(|bit| mask >> bit & 1 == 1) {
                run.engine.flip(register, bit);
            }
            let ends = run.ends();
            run.cycles(QUIET_US * SYSTEM_MHZ);
            let tries = (0..TRIGGERS).take_while(|_| !run.is_good()).count();
            count += 1;
            if !ends || !run.is_good() {
                let name = &names[register];
                lost.push(format!(
                    "{name} ^ {mask:#b} in cycle {cycle}: ends {ends}, {tries} bad"
                ));
            }
        }
    }
    (count, lost)
}

fn the_next_triggers_work(port: &Port, all_moments: bool, count_min: usize) {
    let (count, lost) = upset(port, all_moments);
    assert!(count > count_min, "{count}");
    assert!(lost.is_empty(), "{} of {count}: {lost:#?}", lost.len());
}

#[test]
fn a_port_of_a_card_works_after_an_upset_of_any_register() {
    the_next_triggers_work(&Port::card(), false, 5_000 / 17);
}

#[test]
fn a_receiver_works_after_an_upset_of_any_register() {
    the_next_triggers_work(&Port::receiver(), false, 3_000 / 17);
}

#[test]
#[ignore = "slow: every value of every register at 16 moments"]
fn whatever_state_a_port_of_a_card_is_brought_into_the_next_triggers_work() {
    the_next_triggers_work(&Port::card(), true, 5_000);
}

#[test]
#[ignore = "slow: every value of every register at 16 moments"]
fn whatever_state_a_receiver_is_brought_into_the_next_triggers_work() {
    the_next_triggers_work(&Port::receiver(), true, 3_000);
}
