//! Tests of [`super`]: the published tables, and every rejection.

use super::*;
use crate::endat::timing::{PERIOD_CYCLES_MIN, RECOVERY_MAX_NS, RECOVERY_MIN_NS};

fn rcn_8510() -> ChannelSpec {
    ChannelSpec {
        clock_hz: 3_125_000,
        calibration_hz: None,
        tst_ns: 2_000,
        command: ModeCommand::SendPositionAddInfo,
        position_bits: 29,
        filter_ns: 20,
        start_window_ns: 80,
        tcal_max_ns: 5_000,
        recovery_min_ns: RECOVERY_MIN_NS,
        recovery_max_ns: RECOVERY_MAX_NS,
        cable_m: 100,
        spoken: Spoken::Endat,
        trigger: None,
        range: None,
    }
}

fn card() -> CardSpec {
    CardSpec {
        system_hz: 100_000_000,
        channels: vec![rcn_8510(), rcn_8510()],
        sample_hz: 10_000,
        sources: TriggerSources {
            pin: true,
            timer: true,
            register: true,
        },
        baud: 2_000_000,
        read_hz: 1_000,
        service: Default::default(),
        line: Default::default(),
        stream: Default::default(),
        outputs: Default::default(),
        safety: Default::default(),
    }
}

/// Pulses and microseconds of a frame at a system clock that generates `clock_hz` exactly.
fn frame(clock_hz: u64, command: ModeCommand, bits: u64, tst_ns: u64) -> (u64, f64) {
    let system_hz = [100_000_000, 128_000_000, 120_000_000, 60_000_000]
        .into_iter()
        .find(|s| {
            s % clock_hz == 0
                && (s / clock_hz).is_multiple_of(2)
                && s / clock_hz >= PERIOD_CYCLES_MIN
        })
        .expect("a system clock for every row");
    let request = ChannelSpec {
        clock_hz,
        command,
        position_bits: bits,
        tst_ns,
        filter_ns: 0,
        start_window_ns: 1_000_000_000u64.div_ceil(system_hz),
        ..rcn_8510()
    };
    let config = ChannelConfig::resolve(&request, system_hz, false, 0).expect("a good request");
    let time = config.frame_time(system_hz);
    (
        time.pulses,
        time.frame_cycles as f64 * 1e6 / system_hz as f64,
    )
}

#[test]
fn frame_times_of_endat_2_1_are_the_table() {
    // clock in kHz, then P / us for 13, 25, 29, 36, 37 position bits.
    let table: [(u64, [(u64, f64); 5]); 6] = [
        (
            100,
            [
                (31, 305.00),
                (43, 425.00),
                (47, 465.00),
                (54, 535.00),
                (55, 545.00),
            ],
        ),
        (
            200,
            [
                (31, 152.50),
                (43, 212.50),
                (47, 232.50),
                (54, 267.50),
                (55, 272.50),
            ],
        ),
        (
            300,
            [
                (31, 101.67),
                (43, 141.67),
                (47, 155.00),
                (54, 178.33),
                (55, 181.67),
            ],
        ),
        (
            500,
            [
                (31, 61.00),
                (43, 85.00),
                (47, 93.00),
                (54, 107.00),
                (55, 109.00),
            ],
        ),
        (
            1_000,
            [
                (31, 30.50),
                (43, 42.50),
                (47, 46.50),
                (54, 53.50),
                (55, 54.50),
            ],
        ),
        (
            2_000,
            [
                (31, 15.25),
                (43, 21.25),
                (47, 23.25),
                (54, 26.75),
                (55, 27.25),
            ],
        ),
    ];
    for (khz, row) in table {
        for (bits, (pulses, us)) in [13, 25, 29, 36, 37].into_iter().zip(row) {
            let (got_pulses, got_us) = frame(khz * 1_000, ModeCommand::SendPosition, bits, 0);
            assert_eq!(got_pulses, pulses, "{khz} kHz, {bits} bits");
            assert!(
                (got_us - us).abs() < 0.006,
                "{khz} kHz, {bits} bits: {got_us} us, table {us}"
            );
        }
    }
}

#[test]
fn frame_times_of_endat_2_2_are_the_table() {
    // clock in kHz, then P / us for 25, 29, 36, 37 position bits; tST = 2 us from 1 MHz up.
    let table: [(u64, [(u64, f64); 4]); 11] = [
        (
            100,
            [(44, 435.00), (48, 475.00), (55, 545.00), (56, 555.00)],
        ),
        (
            200,
            [(44, 217.50), (48, 237.50), (55, 272.50), (56, 277.50)],
        ),
        (500, [(44, 87.00), (48, 95.00), (55, 109.00), (56, 111.00)]),
        (1_000, [(44, 45.00), (48, 49.00), (55, 56.00), (56, 57.00)]),
        (2_000, [(44, 23.50), (48, 25.50), (55, 29.00), (56, 29.50)]),
        (3_125, [(44, 15.76), (48, 17.04), (55, 19.28), (56, 19.60)]),
        (4_000, [(46, 13.25), (50, 14.25), (57, 16.00), (58, 16.25)]),
        (8_000, [(58, 9.125), (62, 9.625), (69, 10.50), (70, 10.625)]),
        (10_000, [(64, 8.30), (68, 8.70), (75, 9.40), (76, 9.50)]),
        (12_500, [(72, 7.68), (76, 8.00), (83, 8.56), (84, 8.64)]),
        (
            16_000,
            [(82, 7.0625), (86, 7.3125), (93, 7.75), (94, 7.8125)],
        ),
    ];
    for (khz, row) in table {
        for (bits, (pulses, us)) in [25, 29, 36, 37].into_iter().zip(row) {
            let tst = ChannelSpec::usual_tst_ns(khz * 1_000);
            let (got_pulses, got_us) =
                frame(khz * 1_000, ModeCommand::SendPositionAddInfo, bits, tst);
            assert_eq!(got_pulses, pulses, "{khz} kHz, {bits} bits");
            assert!(
                (got_us - us).abs() < 0.006,
                "{khz} kHz, {bits} bits: {got_us} us, table {us}"
            );
        }
    }
}

#[test]
fn the_card_of_the_paper_resolves_to_these_cycles() {
    let config = CardConfig::resolve(&card()).unwrap();
    let channel = &config.channels[1];
    assert_eq!(channel.period_cycles, 32);
    assert_eq!(channel.first_low_extra_cycles, 200 - 16);
    assert_eq!(channel.filter_cycles, 2);
    assert_eq!(channel.start_window_cycles, 8);
    assert_eq!(channel.start_timeout_us, 18); // 5 + 1.2 + 2 * 5 us of the calibration clock, rounded up, and one
    assert_eq!(channel.recovery_limit_cycles, 3_000 + 120 + 32);
    assert_eq!(channel.ready_low_cycles, 51);
    assert_eq!(channel.abort_us, 30_000);
    assert_eq!(config.sample_period_cycles, 10_000);
    assert_eq!(config.uart_bit_cycles, 50);
    assert_eq!(config.needed_baud(), 620_000);
    assert_eq!(
        channel.cycle_max_cycles(config.system_hz),
        1_704 + 120 + 3_000 + 51 + 32
    );
}

#[test]
fn an_odd_period_keeps_the_first_low_phase_at_least_tst() {
    let request = ChannelSpec {
        clock_hz: 4_000_000,
        ..rcn_8510()
    };
    let config = ChannelConfig::resolve(&request, 100_000_000, false, 0).unwrap();
    assert_eq!(
        (config.period_cycles, config.first_low_extra_cycles),
        (25, 188)
    );
    assert_eq!(config.frame_time(100_000_000).first_low_cycles, 200);
}

/// The only problem of a card changed by `change`.
fn problem(change: impl Fn(&mut CardSpec)) -> Problem {
    let mut request = card();
    change(&mut request);
    let problems = CardConfig::resolve(&request).expect_err("must be rejected");
    assert_eq!(problems.len(), 1, "{problems:?}");
    problems[0].clone()
}

#[test]
fn each_limit_is_refused_with_its_key_and_remedy() {
    type Change = fn(&mut CardSpec);
    let cases: [(Change, &str, &str); 23] = [
        (|c| c.channels[1].tcal_max_ns = 4_083_000, "tcal_max_ns", "outside 1..4082800; choose a value in that range"),
        (|c| c.system_hz = 999_999, "system_hz", "outside 1000000..250000000"),
        (|c| c.channels.clear(), "channel", "1..8 channels"),
        (|c| c.channels[1].clock_hz = 99_999, "clock_hz", "outside 100000..16000000"),
        (|c| { c.system_hz = 50_000_000; c.channels[1].clock_hz = 16_000_000 }, "clock_hz", "needs a system clock of at least 64000000 Hz"),
        (|c| c.channels[1].clock_hz = 9_000_000, "clock_hz", "would become 9090909 Hz (+10101 ppm), more than the allowed 5000 ppm; use 8333333 or 9090909 Hz"),
        (|c| { c.system_hz = 250_000_000; c.channels[1].clock_hz = 100_000; c.sample_hz = 1_000 }, "clock_hz", "at most 2047 can be timed; use at least 122130 Hz"),
        (|c| c.channels[1].tst_ns = 499, "tst_ns", "neither 0 nor in 500..10000"),
        (|c| c.channels[1].tst_ns = 10_001, "tst_ns", "neither 0 nor in 500..10000"),
        (|c| c.channels[1].position_bits = 0, "position_bits", "outside 1..48"),
        (|c| c.channels[1].position_bits = 49, "position_bits", "outside 1..48"),
        (|c| c.channels[1].filter_ns = 151, "filter_ns", "is 16 cycles, more than 15"),
        (|c| c.channels[1].start_window_ns = 9, "start_window_ns", "outside 1..16"),
        (|c| c.channels[1].start_window_ns = 170, "start_window_ns", "use 10..160 ns"),
        (|c| c.channels[1].tcal_max_ns = 0, "tcal_max_ns", "outside 1..4082800"),
        (|c| c.channels[1].cable_m = 781, "cable_m", "outside 0..780"),
        (|c| c.channels[1].recovery_min_ns = 1_249, "recovery_min_ns", "outside 1250..80390"),
        (|c| c.channels[1].recovery_min_ns = 30_001, "recovery_min_ns", "above recovery_max_ns = 30000; lower it to 30000, or raise recovery_max_ns to 30001"),
        (|c| { c.channels[1].recovery_max_ns = 80_391; c.sample_hz = 1_000 }, "recovery_max_ns", "outside 1250..80390"),
        (|c| c.sample_hz = 20_382, "sample_hz", "so at most 20379 Hz"),
        (|c| c.sample_hz = 5, "sample_hz", "outside 6..1000000"),
        (|c| c.baud = 7_000_000, "baud", "would become 7142857 bit/s (+20408 ppm)"),
        (|c| c.read_hz = 10_000, "baud", "takes 6200000 bit/s; raise it to 6250000, or set link.read_hz to 3225 or less"),
    ];
    for (change, key, text) in cases {
        let problem = problem(change);
        assert_eq!(problem.key, key, "{problem}");
        assert!(
            problem.text.contains(text),
            "{problem} does not contain {text}"
        );
    }
}

/// A card that the slowest system clock supports.
fn slow_card() -> CardSpec {
    let mut request = card();
    request.system_hz = 1_000_000;
    for channel in &mut request.channels {
        channel.clock_hz = 100_000;
        channel.tst_ns = 0;
        channel.filter_ns = 0;
        channel.start_window_ns = 1_000;
        channel.cable_m = 10;
    }
    request.sample_hz = 100;
    request.baud = 125_000;
    request.read_hz = 10;
    request
}

#[test]
fn what_a_slow_system_clock_cannot_have_is_refused() {
    assert_eq!(CardConfig::resolve(&slow_card()).map(|_| ()), Ok(()));
    let mut request = slow_card();
    request.service.requests = true;
    request.service.initialise = true;
    request.channels.truncate(1);
    let problems = CardConfig::resolve(&request).unwrap_err();
    assert_eq!((problems.len(), problems[0].key), (1, "system_hz"));
    assert!(
        problems[0].text.contains("use at least 8000000 Hz"),
        "{problems:?}"
    );
    request.system_hz = 8_000_000;
    request.channels[0].start_window_ns = 125;
    assert!(CardConfig::resolve(&request).is_ok());
}

#[test]
fn the_clock_that_measures_the_delay_leaves_room_for_the_receiver() {
    // 1 us of the default calibration clock is one cycle here: the receiver would see a bit when the next one comes.
    let mut request = slow_card();
    request.channels[1].clock_hz = 142_857;
    let problems = CardConfig::resolve(&request).unwrap_err();
    assert_eq!((problems.len(), problems[0].key), (1, "calibration_hz"));
    assert!(
        problems[0].text.contains("use at most 125000 Hz"),
        "{problems:?}"
    );
    request.channels[1].clock_hz = 125_000;
    assert!(CardConfig::resolve(&request).is_ok());
    // No EnDat clock is slow enough.
    request.channels[1].cable_m = 310;
    let problems = CardConfig::resolve(&request).unwrap_err();
    assert!(
        problems[0].text.contains("shorten cable or filter"),
        "{problems:?}"
    );
    // A requested clock, with a short cable: four fifths of its period would hold the delay.
    let asked = |calibration_hz| {
        let mut request = card();
        request.channels[0].cable_m = 0;
        request.channels[0].filter_ns = 0;
        request.channels[0].start_window_ns = 50;
        request.channels[0].calibration_hz = Some(calibration_hz);
        request.channels[0].clock_hz = 10_000_000;
        CardConfig::resolve(&request)
    };
    assert_eq!(asked(3_703_703).map(|_| ()), Ok(()));
    assert_eq!(asked(3_703_704).unwrap_err()[0].key, "calibration_hz");
}

#[test]
fn the_fastest_allowed_sampling_passes() {
    let mut request = card();
    request.sample_hz = 20_379;
    assert!(CardConfig::resolve(&request).is_ok());
}

#[test]
fn every_problem_is_reported_at_once() {
    let mut request = card();
    request.channels[0].position_bits = 49;
    request.channels[1].clock_hz = 9_000_000;
    request.baud = 1;
    request.sample_hz = 0;
    let problems = CardConfig::resolve(&request).unwrap_err();
    let keys: Vec<_> = problems.iter().map(|p| (p.section, p.key)).collect();
    assert_eq!(
        keys,
        [
            (Section::Channel(0), "position_bits"),
            (Section::Channel(1), "clock_hz"),
            (Section::Trigger, "sample_hz"),
            (Section::Link, "baud"),
        ]
    );
}

#[test]
fn short_recovery_needs_a_2_2_command_above_one_megahertz() {
    let short = |command, clock_hz| {
        let mut request = card();
        let channel = &mut request.channels[0];
        (channel.command, channel.clock_hz) = (command, clock_hz);
        (channel.recovery_min_ns, channel.recovery_max_ns) = (1_250, 3_750);
        CardConfig::resolve(&request).is_ok()
    };
    assert!(short(ModeCommand::SendPositionAddInfo, 3_125_000));
    assert!(!short(ModeCommand::SendPositionAddInfo, 1_000_000));
    assert!(!short(ModeCommand::SendPosition, 3_125_000));
}

proptest::proptest! {
    /// For any numbers, the result is either a list of problems or fits the configuration inputs of the blocks.
    #[test]
    fn what_resolves_fits_the_blocks(
        system_hz in 0u64..400_000_000, clock_hz in 0u64..20_000_000, tst_ns in 0u64..12_000, bits in 0u64..60,
        filter_ns in 0u64..300, window in 0u64..800, tcal in 0u64..2_000_000, tm in 0u64..u64::MAX, cable in 0u64..200,
    ) {
        let request = ChannelSpec {
            clock_hz, tst_ns, position_bits: bits, filter_ns, start_window_ns: window, tcal_max_ns: tcal,
            recovery_max_ns: tm, cable_m: cable, ..rcn_8510()
        };
        if let Ok(c) = ChannelConfig::resolve(&request, system_hz, false, 0) {
            proptest::prop_assert!((PERIOD_CYCLES_MIN..=max_of(PERIOD_BITS)).contains(&c.period_cycles));
            proptest::prop_assert!(c.first_low_extra_cycles != 1 && c.first_low_extra_cycles <= max_of(PERIOD_BITS));
            proptest::prop_assert!((1..=48).contains(&c.position_bits));
            proptest::prop_assert!(c.filter_cycles <= max_of(FILTER_BITS));
            proptest::prop_assert!((1..=max_of(START_WINDOW_BITS)).contains(&c.start_window_cycles));
            proptest::prop_assert!(c.start_timeout_us <= max_of(START_TIMEOUT_BITS));
            proptest::prop_assert!(c.recovery_limit_cycles <= max_of(RECOVERY_LIMIT_BITS));
            proptest::prop_assert!(c.ready_low_cycles <= max_of(READY_LOW_BITS));
            let first_low_ns = (c.frame_time(system_hz).first_low_cycles as u128 * 1_000_000_000 / system_hz as u128) as u64;
            proptest::prop_assert!(first_low_ns + 1 >= tst_ns);
        }
    }
}
