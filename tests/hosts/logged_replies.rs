//! Replies of a real T-format encoder, from the wire of a virtual card to the host.

use super::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::parse;
use endat_sim::t_format::EncoderConfig;
use std::sync::Arc;

/// One channel that asks for the single-turn position.
const CARD: &str = "name = \"logged\"\n[clock]\nsystem_hz = 20_000_000\n\
    [[channel]]\nprotocol = \"t_format\"\nrequest = 0\n[trigger]\nsample_hz = 2_000\n\
    [link]\nbaud = 2_000_000\n[board]\nname = \"papilio_pro\"\n";

/// Bytes of the published replies to request 0, and their CRCs.
fn replies() -> Vec<Vec<u8>> {
    let text = include_str!("../data/crc_vectors.json");
    let data: serde_json::Value = serde_json::from_str(text).unwrap();
    let hex = |text: &str| u8::from_str_radix(text.trim_start_matches("0x"), 16).unwrap();
    let vectors = data["tamagawa"]["vectors"].as_array().unwrap().iter();
    let bytes = |v: &serde_json::Value| -> Vec<u8> {
        let bytes = v["bytes_uart_order"].as_str().unwrap().split(' ');
        bytes.chain(v["crc_hex"].as_str()).map(hex).collect()
    };
    vectors.map(bytes).filter(|b| b[0] == 0x02).collect()
}

/// Catches a host that takes the bytes of a position in another order, or does not show one whose encoder has an empty battery.
#[test]
fn host_reads_the_logged_replies_of_a_t_format_encoder() {
    let project = parse("logged.toml", CARD).unwrap();
    let mut desk = Desk::new(&project, &VirtualConfig::default());
    let mut read = vec![];
    for reply in replies() {
        let single_turn = u32::from_le_bytes([reply[2], reply[3], reply[4], 0]);
        let link = desk.card.bridge().transport().bench().t_format_mut(0);
        link.encoder_mut().config.status = EncoderConfig::default().status;
        link.set_motion(Arc::new(move |_| (single_turn, 0)));
        desk.run_ms(2);
        let link = desk.card.bridge().transport().bench().t_format_mut(0);
        assert_eq!(link.encoder().replies().last(), Some(&reply));
        let result = &desk.card.results().unwrap().channels[0];
        assert!(result.fresh, "{result:?}");
        assert_eq!(result.cause_name(), "multi_turn_alarm");
        read.push(result.position);
    }
    let positions = [
        1_883_572, 7_907_664, 7_267_713, 6_039_153, 3_755_428, 1_522_390, 229_187,
    ];
    assert_eq!(read, positions);
}
