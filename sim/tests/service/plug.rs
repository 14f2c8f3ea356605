//! The plug is pulled at every half clock period of a frame with additional data 1 and 2 and a supplement, and plugged in at any time.
//! `unplugged` has some of these times.

use super::rig::{quick, times};
use crate::requests::lanes::{
    self, Rig, FRAME_TIME, HALF_PERIOD, LANES, POSITION_BITS, RECOVERY, SYSTEM_HZ,
};
use endat_hdl::{
    encoder_port::EncoderPort,
    endat::{
        channel::FixedTimes,
        service::{
            map::{request_state, state, word},
            program::ServiceTimes,
        },
        transaction::cause,
    },
    protocol::ModeCommand::{self, *},
};
use endat_sim::{campaign::ABORT_US, encoder::EncoderConfig, Time, MS, US};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Keep, LaneWords, Lanes};
use rust_hdl::prelude::Block;
use std::{ops::Range, sync::OnceLock};

/// Trigger period.
pub(super) const PERIOD: Time = 150 * US;
/// Start of the frame in which the plug is pulled.
const PULLED_FROM: Time = 3 * MS;
/// Milliseconds of HIGH after which DATA counts as an open line.
const UNPLUGGED_MS: u16 = 2;
/// Milliseconds without a sign of life after which a program restarts.
pub(super) const STUCK_MS: u16 = 2;

pub(super) fn encoder() -> EncoderConfig {
    let mut encoder = quick(EncoderConfig::endat22(POSITION_BITS));
    encoder.tm = 10 * US..=RECOVERY;
    encoder.tac = 0..=20 * US;
    encoder.write_time = 0..=20 * US;
    encoder.reset_time = MS;
    encoder
}

/// A port after power-up.
fn engine(initialise: bool) -> Lanes {
    let fixed = FixedTimes {
        abort_us: ABORT_US,
        parameter_timeout_us: 200,
        frame_us: lanes::FRAME_US,
        ..FixedTimes::at(SYSTEM_HZ)
    };
    let times = ServiceTimes {
        power_up_ms: 1,
        after_pulse_ms: 1,
        reset_ms: 1,
        write_ms: 0,
        gap_ms: 0,
        busy_ms: 2,
        unplugged_ms: UNPLUGGED_MS,
        stuck_ms: STUCK_MS,
        system_khz: (SYSTEM_HZ / 1_000) as u32,
        ..times(initialise)
    };
    let mut block = EncoderPort::new(fixed, Some(&times), false);
    block.connect_all();
    let design = elaborate(&block, "encoder_port").expect("the port elaborates");
    Lanes::new(&design, Keep::Outputs, LaneWords::Two).expect("the port has no loop")
}

/// Ports with a host that accesses all of them equally, and a trigger every 150 us.
pub(super) struct Hosts {
    pub rig: Rig,
    pub next_trigger: Time,
}

impl Hosts {
    pub fn tick(&mut self) {
        if self.rig.bench.now() >= self.next_trigger {
            self.next_trigger += PERIOD;
            (0..2).for_each(|part| self.rig.bench.set_trigger(part, u64::MAX));
            self.rig.bench.tick();
            (0..2).for_each(|part| self.rig.bench.set_trigger(part, 0));
        } else {
            self.rig.bench.tick();
        }
    }

    pub fn run_until(&mut self, time: Time) {
        while self.rig.bench.now() < time {
            self.tick();
        }
    }

    pub fn run_for(&mut self, span: Time) {
        self.run_until(self.rig.bench.now() + span);
    }

    fn strobe(&mut self, name: &str) {
        self.rig.bench.set_all(name, 1);
        self.tick();
        self.rig.bench.set_all(name, 0);
        (0..8).for_each(|_| self.tick());
    }

    /// A word of all lanes.
    pub fn read(&mut self, word: u8) -> Vec<u32> {
        self.rig.bench.set_all("host_address", word.into());
        self.strobe("host_read");
        let port = self.rig.bench.engine().port("host_word");
        let mut get = |lane| self.rig.bench.engine().get(port, lane) as u32;
        (0..self.rig.used).map(&mut get).collect()
    }

    pub fn write(&mut self, word: u8, value: u32) {
        for half in [1, 0] {
            self.write_half(word, half, (value >> (16 * half)) as u16);
        }
    }

    /// One half of a word, 1 = high.
    pub fn write_half(&mut self, word: u8, half: u32, value: u16) {
        self.rig.bench.set_all("host_address", word.into());
        self.rig.bench.set_all("host_half", half.into());
        self.rig.bench.set_all("host_data", value.into());
        self.strobe("host_write");
    }

    /// Waits until a word satisfies a condition in all lanes.
    fn wait_for(&mut self, word: u8, span: Time, done: impl Fn(u32) -> bool) {
        let end = self.rig.bench.now() + span;
        loop {
            let values = self.read(word);
            let open = values.iter().position(|value| !done(*value));
            let Some(lane) = open else { return };
            let late = self.rig.bench.now() >= end;
            assert!(
                !late,
                "lane {lane}: word {word} stays {:#010x}",
                values[lane]
            );
            self.run_for(100 * US);
        }
    }

    fn initialised(&mut self) {
        let done = |s: u32| s as u16 & state::INITIALISED != 0;
        self.wait_for(word::STATE, 200 * MS, done);
    }

    pub fn request(&mut self, command: ModeCommand, address: u8) {
        let fields = u32::from(address) << 16;
        self.write(word::REQUEST, u32::from(command.code()) << 24 | fields);
    }

    /// Waits until the request under way is finished in all lanes.
    pub fn finished(&mut self) {
        self.wait_for(word::REQUEST_STATE, 20 * MS, |s| {
            s as u16 & request_state::BUSY == 0
        });
    }

    /// A request that must succeed in all lanes.
    pub fn good(&mut self, command: ModeCommand, address: u8) {
        let before = self.read(word::REQUEST_STATE);
        self.request(command, address);
        self.run_for(2 * PERIOD);
        self.finished();
        let after = self.read(word::REQUEST_STATE);
        for (lane, (before, after)) in before.iter().zip(&after).enumerate() {
            let error = *after as u16 >> request_state::ERROR_SHIFT;
            assert_eq!(request_state::name(error), "fulfilled", "lane {lane}");
            assert_eq!(after >> 16, (before >> 16) + 1, "lane {lane}");
        }
    }

    /// Every fresh position of a lane was sent by its encoder.
    pub fn assert_never_wrong(&self, what: &[String]) {
        for (lane, what) in what.iter().enumerate() {
            let frames = self.rig.bench.link(0, lane).encoder().frames();
            let mut sent = frames.iter().map(|f| f.position);
            for result in self.rig.bench.results(lane).iter().filter(|r| r.fresh) {
                let is_true = sent.any(|position| position == result.position);
                assert!(is_true, "silently wrong: {what} {result:?}");
            }
        }
    }

    /// The last results are good. No frame is under way.
    pub fn assert_good_positions(&self, what: &[String]) {
        for (lane, what) in what.iter().enumerate() {
            let frames = self.rig.bench.link(0, lane).encoder().frames();
            let results = self.rig.bench.results(lane);
            for (result, frame) in results.iter().rev().zip(frames.iter().rev()).take(3) {
                let told = (result.last_cause(), result.fresh, result.position);
                assert_eq!(told, (cause::NONE, true, frame.position), "{what}");
            }
        }
    }

    /// Runs until the frame under way is over, without another one.
    pub fn rest(&mut self) {
        let next = std::mem::replace(&mut self.next_trigger, Time::MAX);
        self.run_until(next);
        self.next_trigger = next + PERIOD;
    }
}

/// Half clock periods of the frame and its recovery time, from just before its trigger.
fn places() -> impl Iterator<Item = Time> {
    (0..)
        .map(|i| PULLED_FROM + i * HALF_PERIOD)
        .take_while(|t| *t < PULLED_FROM + US + FRAME_TIME + RECOVERY)
}

/// Pulls the plug of each lane for its time, in a frame with additional data 1 and 2 and a request. Everything works again afterwards.
fn pull(ready: &Lanes, absences: &[(Time, Time)], initialises: bool) {
    pull_and_bounce(ready, absences, initialises, &|_| vec![]);
}

/// As [`pull`], with more interruptions within these spans after the encoder has returned.
fn pull_and_bounce(
    ready: &Lanes,
    absences: &[(Time, Time)],
    initialises: bool,
    bounces: &dyn Fn(usize) -> Vec<Range<Time>>,
) {
    let mut first = 0;
    for absences in absences.chunks(LANES) {
        let case = |(i, (from, length)): (usize, &(Time, Time))| {
            let mut encoder = encoder();
            let back = from + length;
            encoder.unplugged.push(*from..back);
            let bounces = bounces(first + i).into_iter();
            (encoder.unplugged).extend(bounces.map(|b| back + b.start..back + b.end));
            (encoder, lanes::line())
        };
        let cases: Vec<_> = absences.iter().enumerate().map(case).collect();
        first += absences.len();
        let what: Vec<String> = absences
            .iter()
            .map(|a| format!("away from {} ps for {} ps", a.0, a.1))
            .collect();
        let rig = Rig::on(ready.clone(), &cases);
        let mut hosts = Hosts {
            rig,
            next_trigger: 50 * US,
        };
        hosts.run_for(PERIOD);
        hosts.good(PositionSelectMemory, 0x4C);
        hosts.good(PositionSelectMemory, 0x5B);
        assert!(hosts.rig.bench.now() < PULLED_FROM - PERIOD);
        hosts.run_until(PULLED_FROM - 60 * US);
        hosts.request(PositionSelectMemory, 0x4D);
        // The trigger of the request.
        hosts.next_trigger = PULLED_FROM + US;
        let last = absences.iter().map(|a| a.0 + a.1).max().unwrap_or(0);
        hosts.run_until(last + 100 * US);
        if initialises {
            hosts.initialised();
        }
        hosts.run_for(12 * PERIOD);
        hosts.rest();
        hosts.assert_never_wrong(&what);
        hosts.assert_good_positions(&what);
        // The request under way has ended; another one succeeds.
        hosts.finished();
        hosts.good(PositionSelectMemory, 0xA1);
        hosts.good(PositionSelectMemory, 0x47);
        let answers = hosts.read(word::ANSWER);
        let areas: Vec<u32> = answers.iter().map(|a| a & 0xFFFF).collect();
        assert_eq!(areas, vec![0xA100; areas.len()]);
        hosts.assert_never_wrong(&what);
    }
}

/// A running port; its encoder is initialised if `initialise`.
pub(super) fn ready(initialise: bool) -> Lanes {
    static MADE: [OnceLock<Lanes>; 2] = [const { OnceLock::new() }; 2];
    let make = || {
        let mut rig = Rig::on(engine(initialise), &[(encoder(), lanes::line())]);
        rig.reset();
        let next_trigger = if initialise { Time::MAX } else { 50 * US };
        let mut hosts = Hosts { rig, next_trigger };
        if initialise {
            hosts.initialised();
        }
        hosts.run_for(MS);
        hosts.rig.settle(1_000);
        hosts.rig.bench.engine().clone()
    };
    MADE[usize::from(initialise)].get_or_init(make).clone()
}

/// Shorter than the detection time of an open line: back within the same frame, in the pause after it, in a later frame.
fn short() -> Vec<(Time, Time)> {
    let lengths = [3 * US, 23 * US, 150 * US, 600 * US];
    places()
        .flat_map(|from| lengths.map(|length| (from, length)))
        .collect()
}

#[test]
#[ignore = "slow: every half clock period of a frame, five absences"]
fn without_initialisation_an_encoder_that_was_away_is_found_again() {
    let mut absences = short();
    let spread = |(i, from): (usize, Time)| (from, 4 * MS + i as Time * 17 * HALF_PERIOD % PERIOD);
    absences.extend(places().enumerate().map(spread));
    pull(&ready(false), &absences, false);
}

#[test]
#[ignore = "slow: every half clock period of a frame"]
fn an_encoder_that_was_away_for_long_is_initialised_afresh_whenever_it_comes_back() {
    let spread = |(i, from): (usize, Time)| (from, 4 * MS + i as Time * 17 * HALF_PERIOD % PERIOD);
    let absences: Vec<_> = places().enumerate().map(spread).collect();
    pull(&ready(true), &absences, true);
}

/// Contacts that open again during the power-up sequence or in any step of the initialisation, briefly or for long.
#[test]
#[ignore = "slow: bounces in every step of the initialisation"]
fn an_encoder_whose_plug_bounces_is_initialised_when_it_stays() {
    const AWAY: [Time; 4] = [30 * US, 300 * US, 2_500 * US, 12 * MS];
    let bounces = |i: usize| {
        let from = (i as Time + 1) * 400 * US;
        let length = AWAY[i % AWAY.len()];
        vec![
            from..from + length,
            from + length + 50 * US..from + length + 80 * US,
        ]
    };
    let absences = vec![(PULLED_FROM + 40 * US, 4 * MS); LANES];
    pull_and_bounce(&ready(true), &absences, true, &bounces);
}

#[test]
#[ignore = "slow: every half clock period of a frame, four absences"]
fn an_encoder_that_was_away_for_a_moment_is_found_again() {
    pull(&ready(true), &short(), false);
}
