//! The port with its encoder, at the limits of a configuration.

use super::{bench, design, link, power_up};
use endat_hdl::config::{ChannelConfig, ChannelSpec};
use endat_hdl::protocols::ssi::asked::Parity;
use endat_hdl::protocols::ssi::cause;
use endat_hdl::protocols::ssi::protocol::bit_delay_most_ns;
use endat_hdl::protocols::{Spoken, SsiSpec};
use endat_sim::bench::Bench;
use endat_sim::rng::Rng;
use endat_sim::ssi::{Defect, EncoderConfig};
use endat_sim::{NS, US};
use rtl_design::engine::Compiled;

const SYSTEM_HZ: u64 = 60_000_000;

fn resolved(asked: SsiSpec, spec: ChannelSpec) -> ChannelConfig {
    let spec = ChannelSpec {
        spoken: Spoken::Ssi(asked),
        ..spec
    };
    ChannelConfig::resolve(&spec, SYSTEM_HZ, false, 0).unwrap()
}

fn spec(position_bits: u64, clock_hz: u64) -> ChannelSpec {
    ChannelSpec {
        position_bits,
        clock_hz,
        ..ChannelSpec::speaking(Spoken::default())
    }
}

fn get(bench: &mut Bench<Compiled>, name: &str) -> u64 {
    bench.get(name) as u64
}

fn configure(bench: &mut Bench<Compiled>, config: &ChannelConfig) {
    for (name, value) in [
        ("period_cycles", config.period_cycles),
        ("first_low_extra_cycles", config.first_low_extra_cycles),
        ("position_bits", config.position_bits.into()),
        ("filter_cycles", config.filter_cycles),
        ("recovery_limit_cycles", config.recovery_limit_cycles),
        ("command", config.spoken.ssi().unwrap().frame()),
    ] {
        bench.set(name, value.into());
    }
}

/// Triggers at the fastest allowed rate; each result has the position of its first falling edge.
fn run(config: &ChannelConfig, encoder: EncoderConfig, delay_ns: u64, frames: usize) {
    let encoder = EncoderConfig {
        position_bits: config.position_bits,
        gray: config.spoken.ssi().unwrap().gray,
        parity: match config.spoken.ssi().unwrap().parity {
            Parity::None => None,
            parity => Some(parity == Parity::Odd),
        },
        ..encoder
    };
    let mut bench = bench(&design(), SYSTEM_HZ, encoder, delay_ns * NS);
    configure(&mut bench, config);
    power_up(&mut bench);
    bench.run_for(US);
    for n in 0..frames {
        bench.trigger();
        bench.run_cycles(config.cycle_max_cycles(SYSTEM_HZ));
        assert_eq!(get(&mut bench, "busy"), 0, "{n}: ready when it says so");
        assert_eq!(get(&mut bench, "cause"), cause::NONE, "{n} {config:?}");
        assert_eq!(get(&mut bench, "fresh"), 1);
        let is = link(&mut bench).encoder().config.position;
        assert_eq!(get(&mut bench, "position"), is, "{n} {config:?}");
    }
    let encoder = link(&mut bench).encoder();
    assert_eq!(encoder.violations(), []);
    assert_eq!(encoder.frames(), frames as u64);
}

/// Widths, codes and rates; the slowest encoder at the end of the longest cable, jitter on every bit, the longest recovery time.
fn positions_come(rates: &[(u64, u64)], codes: &[(bool, bool, Parity)]) {
    for &(bits, hz) in rates {
        for &(gray, twice, parity) in codes {
            for (filter_ns, tst_ns) in [(0, 0), (100, 4_000)] {
                let config = resolved(
                    SsiSpec {
                        gray,
                        twice,
                        parity,
                        ..SsiSpec::default()
                    },
                    ChannelSpec {
                        filter_ns,
                        tst_ns,
                        cable_m: 60,
                        ..spec(bits, hz)
                    },
                );
                let most_ns =
                    bit_delay_most_ns(config.period_cycles, config.filter_cycles, SYSTEM_HZ);
                for (encoder_ns, jitter_ns, tm_us) in [(10, 0, 12), (400, 0, 30), (300, 100, 25)] {
                    let encoder = EncoderConfig {
                        bit_delay: encoder_ns * NS,
                        jitter: jitter_ns * NS,
                        tm: tm_us * US,
                        ..EncoderConfig::default()
                    };
                    let delay_ns = match encoder_ns {
                        10 => 0,
                        // The rest of a period, for both directions.
                        _ => (most_ns - 400) / 2,
                    };
                    run(&config, encoder, delay_ns, 3);
                }
            }
        }
    }
}

/// Widths and clocks in hertz.
const RATES: [(u64, u64); 5] = [
    (1, 150_000),
    (13, 400_000),
    (25, 500_000),
    (32, 600_000),
    (48, 630_000),
];
/// Gray code, a second copy, parity.
const CODES: [(bool, bool, Parity); 4] = [
    (false, false, Parity::None),
    (true, false, Parity::Even),
    (false, true, Parity::Odd),
    (true, true, Parity::None),
];

#[test]
fn positions_come_at_the_ends_of_the_tolerances() {
    positions_come(&[RATES[0], RATES[2]], &CODES[1..3]);
}

#[test]
#[ignore = "slow: widths up to 48 in every code"]
fn every_position_comes_at_the_ends_of_the_tolerances() {
    positions_come(&RATES, &CODES);
}

/// Catches a bit that is sampled later than the limit allows: beyond it positions are wrong.
#[test]
fn the_limit_of_the_delay_is_one() {
    let config = resolved(SsiSpec::default(), spec(24, 500_000));
    let period_ns = 2_000;
    let mut bench = bench(
        &design(),
        SYSTEM_HZ,
        EncoderConfig {
            position_bits: 24,
            bit_delay: period_ns * NS,
            ..EncoderConfig::default()
        },
        0,
    );
    configure(&mut bench, &config);
    power_up(&mut bench);
    bench.run_for(US);
    let mut wrong = 0;
    for _ in 0..20 {
        bench.trigger();
        bench.run_cycles(2 * config.cycle_max_cycles(SYSTEM_HZ));
        let is = link(&mut bench).encoder().config.position;
        wrong += u64::from(get(&mut bench, "position") != is);
    }
    assert!(wrong > 15, "{wrong}");
}

/// Random defects: each has its cause, none brings a wrong position, and the next frame is good.
#[test]
fn what_is_wrong_is_told_and_forgotten() {
    let mut rng = Rng::new(5);
    for twice in [false, true] {
        let config = resolved(
            SsiSpec {
                gray: true,
                twice,
                ..SsiSpec::default()
            },
            ChannelSpec {
                recovery_max_ns: 20_000,
                ..spec(25, 500_000)
            },
        );
        let mut bench = bench(
            &design(),
            SYSTEM_HZ,
            EncoderConfig {
                gray: true,
                ..EncoderConfig::default()
            },
            100 * NS,
        );
        configure(&mut bench, &config);
        power_up(&mut bench);
        bench.run_for(US);
        let mut last = 0;
        for round in 0..60 {
            let defect = match round % 6 {
                _ if round % 2 == 0 => Defect::None,
                1 => Defect::Silent,
                3 => Defect::StuckLow,
                5 if twice && round % 12 == 5 => Defect::TakesAnew,
                5 if twice => Defect::Flip {
                    copy: 1,
                    bit: rng.in_range(0, 24) as usize,
                },
                _ => Defect::Longer(1),
            };
            link(&mut bench).encoder_mut().config.defect = defect;
            bench.run_for(US);
            bench.trigger();
            bench.run_cycles(config.cycle_max_cycles(SYSTEM_HZ) + 600);
            let expected = match defect {
                Defect::None => cause::NONE,
                Defect::StuckLow => cause::DATA_NOT_HIGH,
                Defect::Flip { .. } | Defect::TakesAnew => cause::COPIES_DIFFER,
                _ => cause::DATA_NOT_LOW_AFTER,
            };
            assert_eq!(get(&mut bench, "cause"), expected, "{round} {defect:?}");
            assert_eq!(get(&mut bench, "fresh"), u64::from(defect == Defect::None));
            if defect == Defect::None {
                last = link(&mut bench).encoder().config.position;
            }
            assert_eq!(get(&mut bench, "position"), last, "{round} {defect:?}");
            link(&mut bench).encoder_mut().config.defect = Defect::None;
            bench.run_for(60 * US);
        }
        assert_eq!(get(&mut bench, "sequence"), 60);
    }
}
