//! The service behind the host link of a card.

use crate::service_waits::{quick, times};
use crate::{host, made};
use endat_hdl::{
    card::{service_times, uart_bridge::TIMEOUT_US},
    config::CardConfig,
    regs::{CARD, CARD_CONFIG, RESULT, SERVICE},
};
use endat_sim::{
    bench::Link,
    encoder::{Device, RCN_8510, ROQ_437},
    line::LineConfig,
    MS, US,
};

/// System clock: services wait for milliseconds, which are few cycles.
const KHZ: u64 = 12_500;
/// With a slower one the service does not get ready between two triggers of two channels.
const QUICK_KHZ: u64 = 25_000;

/// The card with service, without a stream and a continuous clock: some of these clocks are too slow for them.
fn card(system_khz: u64) -> CardConfig {
    host::card_with("s6_two_channel_service", system_khz, |text| {
        text.replacen("fifo_bytes = 2_048", "fifo_bytes = 0", 1)
            .replacen("\"continuous\", ", "", 1)
    })
}

/// The service's words behind it.
struct Host(host::Host);

impl Host {
    fn new(system_khz: u64) -> Self {
        let config = card(system_khz);
        Self::with(&config, &[RCN_8510, ROQ_437])
    }

    fn with(config: &CardConfig, encoders: &[Device]) -> Self {
        let times = endat_hdl::endat::service::program::ServiceTimes {
            system_khz: (config.system_hz / 1_000) as u32,
            ..times(true)
        };
        let card = made::uart_card(config, &times, 100);
        let link = |encoder: &Device| Link::new(LineConfig::cable(10.0), quick(encoder.encoder()));
        let links = encoders.iter().map(link).collect();
        Self(host::Host::new(card, config.system_hz, links))
    }

    fn read(&mut self, name: &str, channel: usize) -> u32 {
        self.0.read(&SERVICE, name, channel)
    }

    fn write(&mut self, name: &str, channel: usize, value: u32) {
        self.0.write(&SERVICE, name, channel, value);
    }

    fn wait_for(&mut self, name: &str, channel: usize, done: impl Fn(u32) -> bool) -> u32 {
        for _ in 0..2_000 {
            let value = self.read(name, channel);
            if done(value) {
                return value;
            }
            self.0.bench.run_for(100 * US);
        }
        panic!("{name} of channel {channel} never comes");
    }
}

/// An encoder that leaves a frame after 2 us of HIGH never answers at 200 kHz, however many frames it gets.
fn a_faster_calibration_clock_is_needed(frames: usize) {
    for (hz, starts) in [(200_000, false), (400_000, true)] {
        let config = host::card_with("s6_two_channel", KHZ, |text| {
            let key = format!("clock_hz = 3_125_000\ncalibration_hz = {hz}");
            text.replacen("clock_hz = 3_125_000", &key, 1).replacen(
                "fifo_bytes = 2_048",
                "fifo_bytes = 0",
                1,
            )
        });
        let mut encoder = RCN_8510.encoder();
        encoder.max_clock_high = 2 * US;
        let links = [0, 1].map(|_| Link::new(LineConfig::cable(10.0), encoder.clone()));
        let card = made::uart_card(&config, &service_times(&config), TIMEOUT_US);
        let mut host = host::Host::new(card, config.system_hz, links.into());
        host.write(&CARD_CONFIG, "trigger_sources", 0, 4);
        for _ in 0..frames {
            host.write(&CARD, "trigger_now", 0, 1);
            host.bench.run_for(32 * MS);
            let status = host.read(&RESULT, "status", 1);
            assert_eq!(status >> 23 & 1 == 1, starts, "{hz} Hz: {status:08x}");
        }
    }
}

#[test]
fn an_encoder_that_leaves_a_slow_frame_starts_with_a_faster_calibration_clock() {
    a_faster_calibration_clock_is_needed(1);
}

#[test]
#[ignore = "slow: frames after frames at an encoder that leaves slow ones"]
fn an_encoder_that_leaves_slow_frames_never_starts_with_a_slow_calibration_clock() {
    a_faster_calibration_clock_is_needed(3);
}

#[test]
fn both_channels_are_initialised_and_take_requests_over_the_host_link() {
    let mut host = Host::new(KHZ);
    for (channel, width) in [(0, 29), (1, 37)] {
        host.wait_for("state", channel, |s| s & 1 == 1);
        assert_eq!(host.read("progress", channel), 0);
        assert_eq!(host.read("position_bits", channel) & 0x3F, width);
        assert_eq!(host.read("position_bits", channel) >> 16, 1);
    }
    assert_ne!(host.read("serial_1", 0), host.read("id_1", 0));
    // Each channel has its own memory, and keeps what is written.
    for channel in [0, 1] {
        host.write("offset_low", channel, 0x1234_5678 + channel as u32);
        host.write("list_0", channel, 0x4C + channel as u32);
        host.write("list_length", channel, 1);
    }
    assert_eq!(host.read("offset_low", 0), 0x1234_5678);
    assert_eq!(host.read("offset_low", 1), 0x1234_5679);
    // The preset's timer triggers ten thousand times a second: the selections ride, and the slots fill.
    for (channel, celvin) in [(0, 2954), (1, 2982)] {
        let slot = host.wait_for("slot_0", channel, |s| s != 0);
        assert_eq!(slot & 0xFFFF, celvin);
    }
    // A request with a frame of its own, between the triggers.
    host.write("request", 1, 0x0E << 24 | 0xA1 << 16);
    let finished = host.wait_for("request_state", 1, |s| s & 1 == 0 && s >> 16 == 1);
    assert_eq!(finished & 0xF0, 0, "fulfilled");
    host.write("request", 1, 0x23 << 24 | 0x0D << 16);
    host.wait_for("request_state", 1, |s| s & 1 == 0 && s >> 16 == 2);
    assert_eq!(host.read("answer", 1), 0x0D_8025);
    assert_eq!(host.0.bench.conflicts(0), []);
    assert_eq!(host.0.bench.conflicts(1), []);
}

/// The first service has two channels, the second one only one.
#[test]
#[ignore = "slow: a second service, which has one channel"]
fn a_third_channel_has_a_service_of_its_own() {
    let mut config = card(KHZ);
    config.channels.push(config.channels[1].clone());
    let mut host = Host::with(&config, &[RCN_8510, ROQ_437, RCN_8510]);
    for (channel, width) in [(2, 29), (1, 37), (0, 29)] {
        host.wait_for("state", channel, |s| s & 1 == 1);
        assert_eq!(host.read("position_bits", channel) & 0x3F, width);
    }
    // All at once, each with another word.
    for (channel, area) in [(0, 0xA1), (1, 0xA1), (2, 0xA3)] {
        host.write("request", channel, 0x0E << 24 | area << 16);
        host.wait_for("request_state", channel, |s| s & 1 == 0 && s >> 16 == 1);
    }
    for (channel, address) in [(0, 0x0D), (1, 0x0D), (2, 0x09)] {
        host.write("request", channel, 0x23 << 24 | address << 16);
    }
    let id = host.read("id_1", 2) & 0xFFFF;
    assert!(id != 0);
    for (channel, answer) in [(0, 0x0D_801D), (1, 0x0D_8025), (2, 0x09_0000 | id)] {
        host.wait_for("request_state", channel, |s| s & 1 == 0 && s >> 16 == 2);
        assert_eq!(host.read("answer", channel), answer, "channel {channel}");
    }
    // What no channel has reads as 0, whatever was read before.
    assert_eq!(host.read("answer", 3), 0);
    host.write("offset_low", 3, 0x55AA);
    for channel in 0..3 {
        assert_eq!(host.read("offset_low", channel), 0);
    }
}

/// Two channels that share a service, each with additional data of two codes in turn, a threshold and so many requests: no end of a
/// frame is missed, and more than `least` frames are good.
fn no_frame_is_missed(requests: u32, least: u32) {
    let mut host = Host::new(QUICK_KHZ);
    for channel in [0, 1] {
        host.wait_for("state", channel, |s| s & 1 == 1);
        host.write("list_0", channel, 0x4C);
        host.write("list_1", channel, 0x4D);
        host.write("list_length", channel, 2);
        host.write("threshold", channel, 3 | 16 << 16);
        host.write("control", channel, 2);
    }
    for request in 1..=requests {
        for channel in [0, 1] {
            host.write("request", channel, 0x09 << 24 | 0x4C << 16);
        }
        for channel in [0, 1] {
            host.wait_for("request_state", channel, |s| {
                s & 1 == 0 && s >> 16 == request
            });
        }
        host.0.bench.run_for(3 * MS);
    }
    for channel in [0, 1] {
        assert_eq!(host.read("lost", channel) >> 16, 0, "channel {channel}");
        assert!(host.read("slot_1", channel) != 0);
        assert!(host.read("frames_good", channel) > least);
    }
}

#[test]
fn no_frame_is_missed_while_both_channels_are_busy() {
    no_frame_is_missed(2, 50);
}

#[test]
#[ignore = "slow: more requests to two busy channels"]
fn no_frame_is_missed_while_both_channels_are_busy_for_long() {
    no_frame_is_missed(4, 100);
}
