//! What a configuration may say of an SSI channel, with the line and the remedy of what it may not.

use endat_config::{load_preset, parse, preset};

/// The preset with another line.
fn changed(from: &str, to: &str) -> String {
    let text = preset("ssi_two_channel").unwrap();
    assert_eq!(text.matches(from).count(), 1, "{from}");
    text.replacen(from, to, 1)
}

fn complaint(text: &str) -> String {
    match parse("ssi.toml", text) {
        Ok(_) => panic!("taken: {text}"),
        Err(wrong) => wrong.iter().map(|one| format!("{one}\n")).collect(),
    }
}

#[test]
fn mistakes_are_told_with_line_and_remedy() {
    let ignored = ["\"ignored\""; 15].join(", ");
    let too_many = format!("bits_after = [{ignored}] ");
    let with_crc = format!(
        "bits_after = [{}, \"crc6\"] ",
        ["\"ignored\""; 9].join(", ")
    );
    let far = format!(
        "bits_before = [\"shown\", {}, \"alarm\"] ",
        ["\"ignored\""; 7].join(", ")
    );
    for (from, to, is) in [
        (
            "bits_before = [] ",
            "bits_before = [\"ignored\", \"crc6\"] ",
            "ssi.toml:21: channel[0].bits_before = [\"ignored\", \"crc6\"]: \"crc6\" is of the bits before it, and the position comes after these; move it to bits_after, or call its six bits \"ignored\"",
        ),
        (
            "bits_after = [] ",
            "bits_after = [\"warning\"] ",
            "ssi.toml:22: channel[0].bits_after = \"warning\": unknown bit; use \"ignored\", \"shown\", \"alarm\", ",
        ),
        (
            "bits_after = [] ",
            "bits_after = [\"parity_even\", \"parity_odd\"] ",
            "has two parity bits; call the first of them \"ignored\"",
        ),
        (
            "bits_after = [] ",
            &too_many,
            "channel[0].bits_after = 15 words: a frame has at most 14 bits that are not position; leave the last ones out",
        ),
        (
            "bits_after = [] ",
            &with_crc,
            "15 bits of a frame are not position, bits_before and bits_after together; at most 14 (without the last ones an encoder needs end_low = false); leave the last ones out",
        ),
        (
            "bits_before = [] ",
            &far,
            "a result has room for the last 8 special bits, counted from the last one that is not ignored, and a \"shown\" one is before these; call it \"ignored\"",
        ),
        (
            "twice = true ",
            "twice = true\nend_low = false #",
            "channel[1].end_low = false: an encoder that sends its position twice is LOW after each copy; leave end_low out, or leave twice out",
        ),
        (
            "clock_hz = 1_000_000 ",
            "clock_hz = 2_000_000 ",
            "ssi.toml:14: channel[0].clock_hz = 2000000: a bit takes up to 700 ns of a period from its clock edge (400 ns in the encoder, the rest in 30 m of cable), and the input 11 cycles; use at most 1234567 Hz, or lower bit_delay_ns to 90, if that is the encoder's",
        ),
        (
            "clock_hz = 1_000_000 ",
            "clock_hz = 125_000 ",
            "ssi.toml:14: channel[0].clock_hz = 125000: DATA is checked for LOW 12000 ns after the last falling edge, but recovery_min_ns = 10000 ends the LOW sooner; use at least 150151 Hz, or raise recovery_min_ns to 12000, if the encoder's is as long",
        ),
        (
            "code = \"gray\" ",
            "code = \"grey\" ",
            "ssi.toml:15: channel[0].code = \"grey\": unknown code; use \"binary\" or \"gray\"",
        ),
        (
            "twice = false ",
            "parity = \"mark\" ",
            "ssi.toml:16: channel[0].parity = \"mark\": unknown parity; use \"none\" or \"even\" or \"odd\"",
        ),
        (
            "position_bits = 25 ",
            "position_bits = 49 ",
            "ssi.toml:13: channel[0].position_bits = 49: outside 1..48; choose a value in that range",
        ),
        (
            "recovery_max_ns = 30_000 ",
            "recovery_max_ns = 300_000 ",
            "channel[0].recovery_max_ns = 300000: outside ",
        ),
        (
            "twice = false ",
            "command = \"111000\" ",
            "is a key of EnDat, and this channel speaks SSI; remove it (SSI has code, parity, bit_delay_ns, twice, bits_before, bits_after, end_low, clock_hz, ",
        ),
        (
            "twice = false ",
            "request = 3 ",
            "is a key of T-format, and this channel speaks SSI; remove it",
        ),
        (
            "twice = false ",
            "twice = 1 ",
            "true or false, without quotes",
        ),
        (
            "sample_hz = 5_000 ",
            "sample_hz = 9_000 ",
            "a frame of SSI channel 1 takes up to 137.32 us with the recovery time, so at most 7282 Hz; lower it to 7282, or make the frame shorter: raise clock_hz = 500000, leave twice out, or shorten recovery_max_ns = 25000 if the data sheet allows it",
        ),
    ] {
        let told = complaint(&changed(from, to));
        assert!(told.contains(is), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    for (delay, is) in [
        (
            "10_001 ",
            "channel[0].bit_delay_ns = 10001: outside 0..10000; choose a value in that range",
        ),
        (
            "610 ",
            "(610 ns in the encoder, the rest in 30 m of cable), and the input 11 cycles; use at most 980392 Hz, or lower cable_m to 28, or lower bit_delay_ns to 590, if that is the encoder's",
        ),
    ] {
        let told = complaint(&changed("twice = false ", &format!("bit_delay_ns = {delay}")));
        assert!(told.contains(is), "{told}");
        assert_eq!(told.lines().count(), 1, "{told}");
    }
    let missing = changed("clock_hz = 1_000_000 ", "# ");
    assert!(complaint(&missing).contains("channel[0].clock_hz: is missing"));
}

/// Catches a figure in a remedy that is one too few or too many.
#[test]
fn figures_in_remedies_of_a_slow_ssi_clock_are_the_first_that_fit() {
    let with = |hz: u64, ns: u64| {
        let text = changed("clock_hz = 1_000_000 ", &format!("clock_hz = {hz} "));
        let text = text.replacen("sample_hz = 5_000 ", "sample_hz = 2_000 ", 1);
        text.replacen("twice = false ", &format!("recovery_min_ns = {ns} "), 1)
    };
    for (hz, ns, fits) in [
        (125_000, 12_000, true),
        (125_000, 11_999, false),
        (150_151, 10_000, true),
        (149_500, 10_000, false),
    ] {
        let read = parse("ssi.toml", &with(hz, ns));
        assert_eq!(read.is_ok(), fits, "{hz} {ns}: {read:?}");
    }
}

/// An SSI channel at 100 MHz, on a card without a UART.
fn single(keys: &str) -> String {
    format!(
        "name = \"single\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\n{keys}\
         [trigger]\nsample_hz = 100\n[host]\nbus = \"apb\"\n"
    )
}

/// Catches a delay of the encoder that is fixed, and a limit of the clock that is EnDat's.
#[test]
fn channel_takes_the_encoders_own_delay_and_clocks_from_80_khz_to_4_mhz() {
    for (keys, sheet_ns, most_ns) in [
        (
            "position_bits = 19\nclock_hz = 2_500_000\ncable_m = 2\n",
            300,
            320,
        ),
        (
            "position_bits = 12\nclock_hz = 4_000_000\ncable_m = 2\n",
            150,
            170,
        ),
        (
            "position_bits = 12\nclock_hz = 4_000_000\ncable_m = 0\n",
            150,
            190,
        ),
    ] {
        assert!(
            complaint(&single(keys)).contains("400 ns in the encoder"),
            "{keys}"
        );
        let with = |ns: u64| single(&format!("{keys}bit_delay_ns = {ns}\n"));
        let card = parse("single.toml", &with(most_ns)).unwrap();
        let told = endat_config::explain::report(&card).to_string();
        let line = format!("; {most_ns} ns in the encoder and ");
        assert!(told.contains(&line), "{told}");
        let slow = parse("single.toml", &with(sheet_ns)).unwrap();
        let told = endat_config::explain::report(&slow).to_string();
        // A period, but six cycles of 10 ns at the input.
        let left_ns = 1_000_000_000 / slow.card.channels[0].spec.clock_hz - 60;
        let line = format!("  bits             taken up to {left_ns} ns after their clock edge; {sheet_ns} ns in the encoder and ");
        assert!(told.contains(&line), "{told}");
        let refused = complaint(&with(most_ns + 1));
        let remedy = format!("lower bit_delay_ns to {most_ns}, if that is the encoder's");
        assert!(refused.contains(&remedy), "{refused}");
    }
    let slow = |hz: u64| {
        single(&format!(
            "position_bits = 48\nclock_hz = {hz}\nrecovery_min_ns = 18_750\n"
        ))
    };
    let card = parse("single.toml", &slow(80_000)).unwrap();
    assert_eq!(card.card.channels[0].period_cycles, 1_250);
    let refused = complaint(&slow(79_999));
    assert!(
        refused.contains("clock_hz = 79999: outside 80000..16000000"),
        "{refused}"
    );
}

/// Catches a recovery time that fits its counter only without the cable.
#[test]
fn recovery_time_and_cable_are_limited_together() {
    let keys = |ns: u64| {
        let keys = format!("position_bits = 12\nclock_hz = 80_000\ncable_m = 780\nrecovery_min_ns = 20_000\nrecovery_max_ns = {ns}\n");
        single(&keys)
    };
    let refused = complaint(&keys(81_000));
    let (_, limit) = refused.split_once("outside 1250..").expect(&refused);
    let most = limit
        .split(' ')
        .next()
        .and_then(|n| n.parse().ok())
        .unwrap();
    let card = parse("single.toml", &keys(most)).unwrap();
    let cycles = card.card.channels[0].recovery_limit_cycles;
    assert!(
        cycles < 1 << endat_hdl::config::RECOVERY_LIMIT_BITS,
        "{cycles}"
    );
}

/// Catches a number that the hash of a card leaves out, and one that it has without need.
#[test]
fn the_hash_is_of_what_decides() {
    let is = load_preset("ssi_two_channel").unwrap().hash;
    let hash = |text: &str| parse("ssi.toml", text).unwrap().hash;
    for (from, to) in [
        ("clock_hz = 1_000_000 ", "clock_hz = 800_000 "),
        ("position_bits = 25 ", "position_bits = 24 "),
        ("multi_turn_bits = 12 ", "multi_turn_bits = 11 "),
        ("linear = true ", "linear = false "),
        ("code = \"gray\" ", "code = \"binary\" "),
        ("twice = false ", "twice = true "),
        ("twice = false ", "parity = \"odd\" "),
        ("bits_before = [] ", "bits_before = [\"alarm\"] "),
        ("bits_after = [] ", "bits_after = [\"alarm\"] "),
        ("bits_after = [] ", "bits_after = [\"power_fail\"] "),
        ("end_low = true ", "end_low = false "),
        ("recovery_max_ns = 30_000 ", "recovery_max_ns = 31_000 "),
        ("tst_ns = 2_000 ", "tst_ns = 3_000 "),
    ] {
        assert_ne!(hash(&changed(from, to)), is, "{to}");
    }
    for (from, to) in [
        ("encoder = \"EQN 425, SSI\" ", "encoder = \"another\" "),
        ("code = \"binary\" ", "#"),
        ("clock_hz = 1_000_000 ", "clock_hz = 1_000_001 "),
        // It is checked only.
        ("code = \"binary\" ", "bit_delay_ns = 300 "),
    ] {
        assert_eq!(hash(&changed(from, to)), is, "{to}");
    }
}
