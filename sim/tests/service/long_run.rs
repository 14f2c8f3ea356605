//! Seconds with a busy host: its reads and writes cost no sample.

use super::rig::{quick, Make, Rig};
use endat_hdl::endat::{
    service::map::{request_state, word},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand::{self, *};
use endat_sim::{
    encoder::{area, EncoderConfig, PositionSource},
    rng::Rng,
    US,
};
use std::{collections::BTreeSet, thread};

/// The slowest clock at which a frame with one block of additional data and a supplement fits into a period: half a clock period is 4 cycles.
const SYSTEM_HZ: u64 = 10_000_000;
const ENDAT_HZ: u64 = SYSTEM_HZ / 8;
const SAMPLE_HZ: u64 = 10_000;
/// Parallel runs that share the samples.
const PARTS: u64 = 2;

/// The requests of a round, with their expected answers; `None` = any.
fn round(address: u8, data: u16) -> [(ModeCommand, u8, u16, Option<u16>); 9] {
    let byte = |low: u8| Some(u16::from_be_bytes([address, low]));
    let [high, low] = data.to_be_bytes();
    let echo = u16::from(area::OPERATING_PARAMETERS) << 8;
    [
        (PositionSelectMemory, area::OPERATING_PARAMETERS, 0, None),
        (PositionSelectMemory, 0x47, 0, Some(echo)),
        (PositionReceiveParameter, address, data, None),
        (PositionSelectMemory, 0x45, 0, byte(low)),
        (PositionSendParameter, address, 0, byte(low)),
        (PositionSelectMemory, 0x46, 0, byte(high)),
        (PositionTestCommand, address, data, None),
        (PositionErrorReset, 0, 0, None),
        (SendPositionAddInfo, 0, 0, None),
    ]
}

/// A permanently active host: it accesses the service at another time of each period, and sends the next request when
/// the last one has finished.
struct Host {
    rng: Rng,
    finished: u32,
    requests: Vec<(ModeCommand, u8, u16, Option<u16>)>,
    expected: Option<u16>,
}

impl Host {
    fn look(&mut self, rig: &mut Rig) {
        let state = rig.read(word::REQUEST_STATE);
        if state as u16 & request_state::BUSY != 0 || state >> 16 != self.finished & 0xFFFF {
            return;
        }
        let error = state as u16 >> request_state::ERROR_SHIFT;
        assert_eq!(error, request_state::OK, "request {}", self.finished);
        if let Some(expected) = self.expected {
            let answer = rig.read(word::ANSWER) as u16;
            assert_eq!(answer, expected, "request {}", self.finished);
        }
        if self.requests.is_empty() {
            let address = self.rng.in_range(4, 15) as u8;
            self.requests = round(address, self.rng.next_u64() as u16).into();
            self.requests.reverse();
        }
        let (command, address, data, expected) = self.requests.pop().expect("a request");
        let fields = u32::from(address) << 16 | u32::from(data);
        rig.write(word::REQUEST, u32::from(command.code()) << 24 | fields);
        self.expected = expected;
        self.finished += 1;
    }
}

/// One run with this many samples.
fn part(seed: u64, samples: u64) {
    const PERIOD: u64 = SYSTEM_HZ / SAMPLE_HZ;
    let encoder = EncoderConfig::endat22(13).position(PositionSource::Random);
    let mut encoder = quick(encoder).seed(seed);
    encoder.tm = 10 * US..=12 * US;
    let make = Make {
        system_hz: SYSTEM_HZ,
        ..Make::usual(false)
    };
    let mut rig = Rig::with(make, ENDAT_HZ, encoder, 13);
    rig.good_position();
    let first = rig.bench.results().len();
    let mut host = Host {
        rng: Rng::new(seed),
        finished: 0,
        requests: vec![],
        expected: None,
    };
    let mut triggers = vec![];
    for _ in 0..samples {
        triggers.push(rig.bench.now());
        rig.bench.trigger();
        let end = rig.bench.cycle() + PERIOD;
        // Long enough before the next trigger for all its accesses.
        let phase = host.rng.in_range(1, PERIOD - 60);
        rig.bench.run_cycles(phase);
        host.look(&mut rig);
        rig.bench.run_cycles(end - rig.bench.cycle());
    }
    let results = &rig.bench.results()[first..];
    // One more has measured the delay.
    let frames = &rig.bench.frames(0)[first + 1..];
    let counts = (results.len(), frames.len());
    assert_eq!(counts, (triggers.len(), triggers.len()));
    let mut latches = BTreeSet::new();
    for ((result, frame), trigger) in results.iter().zip(frames).zip(&triggers) {
        let told = (result.last_cause(), result.fresh);
        assert_eq!(told, (cause::NONE, true), "{frame:?}");
        assert_eq!(result.position, frame.position, "{frame:?}");
        latches.insert(frame.first_fall - trigger);
    }
    assert_eq!(latches.len(), 1, "ps from trigger to latch: {latches:?}");
    let ridden = frames.iter().filter(|f| f.supplement.is_some()).count();
    println!("{} requests, {ridden} supplements", host.finished);
    assert!(ridden > triggers.len() / 8, "{ridden} supplements");
    assert_eq!(rig.read(word::LOST), 0, "no trigger lost, no frame missed");
    rig.assert_clean();
}

/// Runs this many samples in total.
fn run(samples: u64) {
    thread::scope(|scope| {
        for seed in 1..=PARTS {
            scope.spawn(move || part(seed, samples / PARTS));
        }
    });
}

#[test]
fn requests_cost_no_sample() {
    run(SAMPLE_HZ / 8);
}

#[test]
#[ignore = "slow: ten seconds, a hundred thousand samples"]
fn ten_seconds_of_requests_cost_no_sample() {
    run(10 * SAMPLE_HZ);
}
