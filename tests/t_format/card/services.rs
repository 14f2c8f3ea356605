//! The services of a card that mixes protocols: two channels share one, whatever the other channel speaks.

use super::*;
use endat_hdl::regs::SERVICE;

const REQUESTS: &str = "[service]\nparts = [\"requests\"]\n";

impl Rig {
    fn service(&mut self, name: &str, channel: usize) -> u32 {
        self.master.read(at(&SERVICE, name, channel))
    }

    /// A request to the EnDat encoder, and its answer.
    fn ask(&mut self, word: u32) -> u32 {
        let finished = self.service("request_state", self.endat) >> 16;
        self.master.write(at(&SERVICE, "request", self.endat), word);
        for _ in 0..2_000 {
            let state = self.service("request_state", self.endat);
            if state >> 16 == finished + 1 {
                assert_eq!(state & 0xFF, 0, "fulfilled");
                return self.service("answer", self.endat);
            }
            self.us(20);
        }
        panic!("the request does not end");
    }
}

/// Catches a service that takes its neighbour's ports or words for its own, and a T-format port that answers for it.
fn an_endat_channel_has_its_service(is_swapped: bool) {
    let config = EncoderConfig {
        status: 0,
        ..EncoderConfig::default()
    };
    let mut rig = Rig::with(is_swapped, "\"timer\"", REQUESTS, config);
    rig.us(450);
    // Memory area, then the word that tells the width.
    assert_eq!(rig.ask(0x0E << 24 | 0xA1 << 16) >> 16, 0xA1);
    for _ in 0..3 {
        assert_eq!(rig.ask(0x23 << 24 | 0x0D << 16), 0x0D_801D);
        assert_eq!(rig.request(3, 0, 0).cause, 0);
    }
    let offset = at(&SERVICE, "offset_low", rig.endat);
    rig.master.write(offset, 0x1234_5678);
    assert_eq!(rig.master.read(offset), 0x1234_5678);
    // Neither has the other's words, and writing them does nothing.
    let foreign = at(&SERVICE, "offset_low", rig.t_format);
    rig.master.write(foreign, 0x55AA_55AA);
    let send = at(&T_FORMAT, "send", rig.endat);
    rig.master.write(send, 3 << 16);
    for address in [foreign, send, at(&T_FORMAT, "answer", rig.endat)] {
        assert_eq!(rig.master.read(address), 0, "{address:#x}");
    }
    assert_eq!(rig.master.read(offset), 0x1234_5678);
    assert!(rig.service("frames_good", rig.endat) > 10);
    assert_eq!(rig.service("frames_good", rig.t_format), 0);
    assert_eq!(rig.service("lost", rig.endat) >> 16, 0);
    rig.check_encoders();
}

#[test]
fn an_endat_channel_has_its_service_after_a_t_format_channel() {
    an_endat_channel_has_its_service(true);
}

#[test]
#[ignore = "slow: the service of an EnDat channel before a T-format channel"]
fn an_endat_channel_has_its_service_before_a_t_format_channel() {
    an_endat_channel_has_its_service(false);
}
