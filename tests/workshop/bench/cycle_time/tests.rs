use super::*;

const LIMIT: Figures = Figures {
    pulses: 44,
    frame: 20 * US,
    cycle: 30 * US,
};

#[test]
fn a_row_is_marked_if_it_is_not_at_the_limit() {
    let row = |pulses, frame, cycle| {
        let measured = Figures {
            pulses,
            frame,
            cycle,
        };
        verdict(measured, LIMIT)
    };
    assert_eq!(row(44, 20 * US, 31 * US), None);
    assert_eq!(row(44, 20 * US - 1, 30 * US - 1), None);
    let slow = "1.001 us over the limit, at most 1.000 us";
    assert_eq!(row(44, 20 * US, 31_001 * NS).as_deref(), Some(slow));
    for pulses in [43, 45] {
        let what = format!("{pulses} pulses instead of 44");
        assert_eq!(row(pulses, 20 * US, 30 * US), Some(what));
    }
    let early = Some("shorter than the protocol allows".into());
    assert_eq!(row(44, 20 * US, 30 * US - 2 * NS), early);
    assert_eq!(row(44, 20 * US - 2 * NS, 30 * US), early);
}

#[test]
fn the_longest_of_the_frames_counts() {
    let frame = |first_fall, last_rise, rising_edges| FrameLog {
        first_fall,
        last_rise,
        rising_edges,
        ..FrameLog::default()
    };
    let frames = [frame(0, 10, 44), frame(100, 112, 45), frame(190, 200, 44)];
    let longest = Figures {
        pulses: 45,
        frame: 12,
        cycle: 100,
    };
    assert_eq!(figures(&frames), Some(longest));
    assert_eq!(figures(&frames[..1]), None);
}

#[test]
fn a_marked_row_says_what_is_wrong() {
    let options = CycleTimeOptions {
        position_bits: Some(1),
        cable_m: 100,
        tcal_ns: 5_000,
        tm_ns: 1_250,
    };
    // More pulses fit on the line than the answer has bits: the clock must wait.
    let short = Subject {
        command: SendPositionAddInfo,
        behind: Behind::NOTHING,
        position_bits: 1,
        rate: RATES_2_2[5],
        published: None,
    };
    let row = measure(&short, &options, &mut BTreeMap::new()).unwrap();
    let table = CycleTimes {
        options,
        round_trip_us: 1.25,
        rows: vec![row],
    };
    assert!(!table.is_good());
    assert!(table
        .to_string()
        .contains("^ WRONG: 1.977 us over the limit"));
}
