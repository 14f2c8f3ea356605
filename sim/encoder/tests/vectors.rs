//! Frames with the published CRC vectors, including vectors of a real encoder, as sent by this encoder.

use super::*;

fn vectors() -> Vec<serde_json::Value> {
    let text = include_str!("../../../tests/data/crc_vectors.json");
    let file: serde_json::Value = serde_json::from_str(text).unwrap();
    file["vectors"].as_array().unwrap().clone()
}

fn hex(value: &serde_json::Value) -> u64 {
    u64::from_str_radix(value.as_str().unwrap().trim_start_matches("0x"), 16).unwrap()
}

fn text(bits: &[bool]) -> String {
    bits.iter().map(|b| if *b { '1' } else { '0' }).collect()
}

#[test]
fn every_position_frame_is_sent_as_published() {
    let mut count = 0;
    for v in vectors() {
        let bits = v["n_bits"].as_u64().filter(|n| *n <= 48);
        let (Some(bits), Some(frame)) = (bits, v["frame_S_to_CRC"].as_str()) else {
            continue;
        };
        let bit = |name: &str| v[name].as_u64().map(|b| b == 1);
        let errors = Defect::ErrorBits {
            f1: bit("f1").unwrap(),
            f2: bit("f2").unwrap_or(true),
        };
        let config = EncoderConfig::endat22(bits as u32)
            .position(PositionSource::Fixed(hex(&v["position_hex"])))
            .defect(0, errors);
        let command = bit("f2").map_or(POSITION_21, |_| POSITION_22);
        let mut m = Master::new(config, 8_000_000);
        let got = m.exchange(command, Parameter::default()).unwrap();
        assert_eq!(text(&got), frame, "{v}");
        assert_eq!(u64::from(m.last().crc), hex(&v["crc_hex"]));
        count += 1;
    }
    assert!(count >= 30, "{count}");
}

#[test]
fn every_parameter_frame_is_sent_as_published() {
    let mut count = 0;
    for v in vectors().iter().filter(|v| v["kind"] == "parameter") {
        let mut m = Master::new(quick(), 1_000_000);
        let (address, data) = (hex(&v["byte8_hex"]) as u8, hex(&v["word16_hex"]) as u16);
        let got = m.exchange(TEST, Parameter { address, data }).unwrap();
        let covered = v["covered_bits_tx_order"].as_str().unwrap();
        let crc = v["crc_bits_tx_order"].as_str().unwrap();
        assert_eq!(text(&got), format!("1{covered}{crc}"), "{v}");
        count += 1;
    }
    assert!(count >= 10, "{count}");
}

#[test]
fn additional_data_are_sent_as_published() {
    let vector = |id: &str| {
        let all = vectors();
        let v = all.iter().find(|v| v["id"] == id).unwrap();
        v["frame_first_bit_to_CRC"].as_str().unwrap().to_owned()
    };
    let info = |m: &mut Master, select: u8| {
        m.select(select, 1);
        let bits = m.exchange(POSITION_22, Parameter::default()).unwrap();
        text(&bits[bits.len() - 30..])
    };
    let mut config = EncoderConfig::endat22(25).cause(Cause {
        during: 50 * MS..51 * MS,
        alarms: 0,
        warnings: 1,
    });
    config.position = PositionSource::Fixed(0xABCD);
    config.tac = 0..=0;
    let mut m = Master::new(config.clone(), 1_000_000);
    assert_eq!(info(&mut m, 0x40), vector("INF-0"));
    m.position22(SELECT_22, 0xB9, 0);
    assert_eq!(info(&mut m, 0x47), vector("INF-1"));
    m.position22(WRITE_22, 0x02, 0);
    assert_eq!(info(&mut m, 0x47), vector("INF-2"), "Busy");
    m.wait(13 * MS);
    assert_eq!(info(&mut m, 0x47), vector("INF-1"), "no longer busy");
    m.position22(SELECT_22, 0xA1, 0);
    m.position22(READ_22, 0x0D, 0);
    assert_eq!(info(&mut m, 0x45), vector("INF-3"));
    assert_eq!(info(&mut m, 0x46), vector("INF-4"));
    assert_eq!(info(&mut m, 0x4C), vector("INF-5"));
    m.position22(SELECT_22, 0xA7, 0);
    m.position22(WRITE_22, 0x03, 1);
    m.wait(50 * MS);
    let turn = m.encoder.frames().len();
    m.select(0x41, 1);
    m.exchange(POSITION_22, Parameter::default());
    let mut texts = vec![];
    for _ in 0..3 {
        let bits = m.exchange(POSITION_22, Parameter::default()).unwrap();
        texts.push(text(&bits[bits.len() - 30..]));
    }
    assert!(
        texts.contains(&vector("INF-6")),
        "one of three in turn, {turn}"
    );
    assert_eq!(m.violations(), []);

    config.values.reference_done = true;
    let mut m = Master::new(config.clone(), 1_000_000);
    assert_eq!(info(&mut m, 0x42), vector("INF-7"));
    config.values.reference_done = false;
    let mut m = Master::new(config, 1_000_000);
    assert_eq!(info(&mut m, 0x50), vector("INF-8"));
    let unknown = m.pulses(0, 500 * NS, 20);
    assert!(unknown.iter().all(|o| o.symbol != Symbol::Bit(0)));
    m.wait(50 * US);
    assert_eq!(info(&mut m, 0x59), vector("INF-9"), "source 1 in bit 0");
    m.wait(0x1234 * US - 80 * US - m.now); // so that the start bit comes within that microsecond
    m.select(0x5B, 1);
    let stamp = m.position22(POSITION_22, 0, 0)[0];
    assert_eq!(stamp.address, 0x1B);
    assert_eq!(u64::from(stamp.data), m.last().start_time / US);
}
