use super::*;
use crate::test_receiver::{Bug, TestReceiver, LATENCY};

fn run(scenario: &Scenario, index: usize, bug: Bug) -> Report {
    let receiver = TestReceiver::with_bug(scenario.system_hz, bug).measuring_apart();
    let options = RunOptions {
        record: false,
        sample_latency_cycles: LATENCY,
    };
    scenario.run_channel(index, receiver, options).1
}

/// The reference receiver takes no requests, and initialises nothing.
fn all_for_the_plain_receiver() -> impl Iterator<Item = Scenario> {
    let plain = |s: &Scenario| s.requests.is_empty() && s.initialisation == 0;
    all().into_iter().filter(plain)
}

#[test]
fn every_scenario_goes_as_it_says() {
    for s in all_for_the_plain_receiver() {
        // The reference receiver has no input filter, and no window for the start bit.
        if ["glitches", "paper-flow"].contains(&s.name) {
            continue;
        }
        for i in 0..s.channels.len() {
            let report = run(&s, i, Bug::None);
            assert_eq!(report.complaints(), [""; 0], "{report}");
            let frames = report.channels[0].frames.iter();
            let results = frames.filter(|f| f.result.is_some()).count();
            assert_eq!(results, s.causes.len());
        }
    }
}

#[test]
fn without_a_filter_the_glitches_hurt() {
    let report = run(&named("glitches").unwrap(), 0, Bug::None);
    assert!(!report.complaints().is_empty(), "{report}");
}

#[test]
fn a_wrong_receiver_is_complained_about() {
    let paper = named("paper").unwrap();
    for bug in [
        Bug::ExtraPulses(1),
        Bug::ExtraPulses(-1),
        Bug::LateRelease(2),
        Bug::NoRecovery,
        Bug::LateSample(20),
        Bug::Command(0b000_111),
    ] {
        let report = run(&paper, 0, bug);
        let noticed = !report.complaints().is_empty();
        // Ignoring the recovery time has no effect while triggers are slow.
        assert_eq!(noticed, bug != Bug::NoRecovery, "{bug:?} {report}");
    }
    let fast = named("overrun").unwrap();
    assert!(!run(&fast, 0, Bug::NoRecovery).complaints().is_empty());
}

#[test]
fn names_are_unique_and_found() {
    let names: std::collections::BTreeSet<_> = all().iter().map(|s| s.name).collect();
    assert_eq!(names.len(), all().len());
    assert!(named("paper").is_some() && named("no such scenario").is_none());
}

#[test]
fn the_columns_of_a_report_stand_below_their_heads() {
    let mut long = 0;
    for s in all_for_the_plain_receiver() {
        let report = run(&s, 0, Bug::None).to_string();
        let table: Vec<&str> = report
            .lines()
            .skip_while(|l| !l.contains("trigger us"))
            .take_while(|l| !l.contains("samples"))
            .collect();
        let rows = table.iter().filter(|l| l.len() > 80);
        assert!(rows.clone().all(|l| l.len() == table[0].len()), "{report}");
        long += rows
            .filter(|l| l.contains("data not low before start"))
            .count();
    }
    assert!(long > 0, "no result is longer than the narrowest column");
}

#[test]
fn the_report_reads_well() {
    let report = run(&named("alarm").unwrap(), 0, Bug::None).to_string();
    let lines: Vec<&str> = report.lines().map(str::trim_end).collect();
    let expected = [
        "alarm: the encoder reports an error in F1, in F2 and in both, with a correct CRC",
        "",
        "channel 0: command 111000, 29 position bits, 3.125 MHz from 100 MHz (32 cycles, +0 ppm), 10 m of cable",
        "   trigger us  command  result                            position      encoder's   pulses  start  S at us frame us    tm us",
        "       20.000  111000   -                                        -      0x1234567    48/48   R#11   52.500  237.500   24.916",
        "       20.000  111000   good                             0x1235678      0x1235678    48/48   R#11    5.200   17.040   18.887",
        "      620.000  111000   good                             0x1236789      0x1236789    48/48   R#11    5.200   17.040   25.258",
        "      720.000  111000   held: F1                         0x1236789      0x123789A    48/48   R#11    5.200   17.040   20.461",
        "      820.000  111000   held: F2                         0x1236789      0x12389AB    48/48   R#11    5.200   17.040   25.880",
        "      920.000  111000   held: F1                         0x1236789      0x1239ABC    48/48   R#11    5.200   17.040   22.108",
        "     1020.000  111000   good                             0x123ABCD      0x123ABCD    48/48   R#11    5.200   17.040   20.602",
        "  259 samples, narrowest margin 160.0 ns",
        "",
        "all as it should be",
    ];
    assert_eq!(lines, expected);
}
