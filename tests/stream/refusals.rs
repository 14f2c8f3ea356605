//! What the table `[stream]` refuses, with the numbers and the remedy.

use endat_config::{parse, preset};

/// The complaints about the preset with service, with these texts replaced.
fn complaints(changes: &[(&str, &str)]) -> Vec<String> {
    let mut text = preset("s6_two_channel_service").unwrap().to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    match parse("card.toml", &text) {
        Ok(_) => Vec::new(),
        Err(all) => all.iter().map(ToString::to_string).collect(),
    }
}

#[test]
fn a_stream_that_cannot_fit_is_refused() {
    assert_eq!(complaints(&[]), [""; 0]);
    for (changes, told) in [
        (
            &[("baud = 3_000_000", "baud = 2_000_000")][..],
            "trigger.sample_hz = 10000: the stream does not fit: 10000 sets a second of 28 bytes take 2800000 bit/s, link.baud is 2000000; lower it to 7142 or less",
        ),
        (
            &[("fifo_bytes = 2_048", "fifo_bytes = 3_000")],
            "stream.fifo_bytes = 3000: not a buffer size; use 0 (no stream), 1024, 2048, 4096, 8192",
        ),
        (
            &[("fifo_bytes = 2_048", "fifo_bytes = 0"), ("start = \"off\"", "start = \"push\"")],
            "stream.start = \"push\": a stream without a buffer; set stream.fifo_bytes = 2048",
        ),
        (
            &[("start = \"off\"", "additional_data = true\nstart = \"off\"")],
            "trigger.sample_hz = 10000: the stream does not fit: 10000 sets a second of 44 bytes take 4400000 bit/s, link.baud is 3000000; lower it to 6818 or less",
        ),
        (
            &[("fifo_bytes = 2_048", "fifo_bytes = 0"), ("start = \"off\"", "additional_data = true\nstart = \"off\"")],
            "stream.additional_data = true: a stream without a buffer; set stream.fifo_bytes = 2048, or stream.additional_data = false",
        ),
        (
            &[(r#"parts = ["requests", "diagnosis", "continuous", "initialise"]"#, "parts = []"), ("sample_hz = 10_000", "sample_hz = 5_000"), ("start = \"off\"", "additional_data = true\nstart = \"off\"")],
            "stream.additional_data = true: a card without requests has no additional data; add \"requests\" to service.parts, or set stream.additional_data = false",
        ),
        (
            &[("start = \"off\"", "start = \"on\"")],
            "stream.start = \"on\": unknown; use off, collect, push",
        ),
    ] {
        let all = complaints(changes);
        assert_eq!(all.len(), 1, "{all:?}");
        assert!(all[0].starts_with("card.toml:") && all[0].contains(told), "{all:?}");
    }
    // Without a stream the slower line is enough.
    let without = [
        ("fifo_bytes = 2_048", "fifo_bytes = 0"),
        ("baud = 3_000_000", "baud = 2_000_000"),
    ];
    assert_eq!(complaints(&without), [""; 0]);
}
