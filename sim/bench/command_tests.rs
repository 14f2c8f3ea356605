//! Every mode command through cable and bench, with the reference receiver.

use super::*;
use crate::{
    encoder::{
        area, Cause, Command, Defect, EncoderConfig, FrameEnd, PositionSource, DEVICES, LC_416,
    },
    line::LineConfig,
    test_receiver::{TestReceiver, LATENCY},
    MS, US,
};
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::SendPosition;

const SYSTEM_HZ: u64 = 128_000_000;

struct Rig(Bench<TestReceiver>);

impl Rig {
    fn new(encoder: EncoderConfig, endat_hz: u64, cable_m: f64) -> Self {
        let mut settings =
            ChannelSettings::new(SYSTEM_HZ, endat_hz, SendPosition, encoder.position_bits);
        settings.start_timeout_us = 2_000;
        let link = Link::new(LineConfig::cable(cable_m), encoder);
        let receiver = TestReceiver::new(SYSTEM_HZ);
        let mut bench = Bench::channel(receiver, SYSTEM_HZ, &settings, link);
        bench.set_sample_latency(LATENCY);
        Self(bench)
    }

    /// One exchange; returns the cause of its result.
    fn exchange(&mut self, code: u8, address: u8, parameter: u16) -> u64 {
        let b = &mut self.0;
        b.set("command", code.into());
        b.set("address", address.into());
        b.set("parameter", parameter.into());
        let result = b.frame(5 * MS).expect("a result");
        assert!(b.run_until_done(MS, |b| b.get("busy") == 0));
        result.cause
    }

    fn good(&mut self, code: u8, address: u8, parameter: u16) -> u64 {
        let cause = self.exchange(code, address, parameter);
        let frame = self.0.frames(0).last().unwrap();
        assert_eq!(cause, cause::NONE, "{frame:?}");
        assert_eq!(frame.end, FrameEnd::Complete, "{frame:?}");
        assert_eq!(frame.expected_rising_edges(), Some(frame.rising_edges));
        self.0.get("reply") as u64
    }

    fn assert_clean(&self) {
        assert_eq!(self.0.violations(0), []);
        assert_eq!(self.0.conflicts(0), []);
    }
}

fn quick() -> EncoderConfig {
    let mut config = EncoderConfig::endat22(13);
    config.tac = 0..=0;
    config
}

#[test]
fn every_command_passes_every_cable_without_violation_or_conflict() {
    for cable_m in [0.0, 20.0, 100.0] {
        for hz in [200_000, 1_000_000, 8_000_000, 16_000_000] {
            let mut encoder = quick();
            encoder.reset_time = 0;
            encoder.write_time = 0..=0;
            let mut rig = Rig::new(encoder, hz, cable_m);
            rig.good(0b000_111, 0, 0); // measures the delay
            rig.good(0b001_110, area::OPERATING_PARAMETERS, 0);
            for (code, command) in Command::ALL {
                let address = match command {
                    Command::SelectMemory | Command::PositionSelectMemory => {
                        area::OPERATING_PARAMETERS
                    }
                    _ => 7,
                };
                let reply = rig.good(code, address, 0x5AC3);
                let frame = rig.0.frames(0).last().unwrap().clone();
                assert_eq!(frame.command, Some(code));
                let want = u64::from(address) << 16 | 0x5AC3;
                if command.has_parameter() {
                    assert_eq!(reply, want, "{command:?}");
                }
                if command.has_supplement() {
                    assert_eq!(u64::from(frame.supplement.unwrap().fields.word()), want);
                }
                if command == Command::ReceiveReset {
                    rig.good(0b001_110, area::OPERATING_PARAMETERS, 0);
                }
                assert_eq!(frame.refused, None, "{command:?}");
            }
            rig.assert_clean();
        }
    }
}

#[test]
fn a_word_is_read_while_positions_go_on() {
    let mut encoder = quick().position(PositionSource::Fixed(0x0BAD));
    encoder.tac = 300 * US..=300 * US;
    let mut rig = Rig::new(encoder, 8_000_000, 50.0);
    rig.good(0b111_000, 0, 0);
    rig.good(0b001_001, area::MANUFACTURER_1, 0);
    rig.good(0b001_001, 0x47, 0);
    rig.0.set("infos", 1);
    let info = |rig: &mut Rig, code, address| {
        rig.good(code, address, 0);
        assert_eq!(rig.0.get("position"), 0x0BAD);
        assert_eq!(rig.0.get("info_errors"), 0);
        rig.0.get("info_1")
    };
    let ready = |rig: &mut Rig| {
        let busy = |word| word & 0x20_0000 != 0;
        let waits = (0..100).position(|_| !busy(info(rig, 0b111_000, 0)));
        waits.expect("busy for a limited time")
    };
    assert!(ready(&mut rig) > 3);
    assert_eq!(info(&mut rig, 0b111_000, 0), 0x07_A100);
    info(&mut rig, 0b100_100, 13);
    assert!(ready(&mut rig) > 3);
    info(&mut rig, 0b001_001, 0x45);
    assert_eq!(info(&mut rig, 0b001_001, 0x46), 0x05_0D0D, "low byte");
    assert_eq!(info(&mut rig, 0b111_000, 0), 0x06_0D80, "high byte");
    rig.assert_clean();
}

#[test]
fn additional_data_1_and_2_arrive_in_their_places() {
    let defect = Defect::InfoCrcXor { info: 2, xor: 1 };
    let mut rig = Rig::new(quick().defect(4, defect), 8_000_000, 50.0);
    rig.good(0b000_111, 0, 0);
    rig.good(0b001_001, 0x4C, 0);
    rig.0.set("infos", 1);
    rig.good(0b001_001, 0x5B, 0);
    rig.0.set("infos", 3);
    rig.good(0b111_000, 0, 0);
    assert_eq!(rig.0.get("info_1"), 0x0C_0B8A);
    assert_eq!(rig.0.get("info_2") >> 16, 0x1B);
    assert_eq!(rig.0.get("info_errors"), 0);
    rig.good(0b111_000, 0, 0);
    assert_eq!(rig.0.get("info_errors"), 2);
    rig.assert_clean();
}

#[test]
fn an_alarm_from_the_bench_reaches_the_receiver_until_it_is_reset() {
    let mut rig = Rig::new(quick(), 2_000_000, 10.0);
    rig.good(0b111_000, 0, 0);
    let now = rig.0.now();
    rig.0.link_mut(0).encoder_mut().add_cause(Cause {
        during: now..now + 1,
        alarms: 1,
        warnings: 0,
    });
    assert_eq!(rig.exchange(0b111_000, 0, 0), 5, "F1");
    assert_eq!(rig.exchange(0b101_101, 0, 0), 5, "F1");
    rig.good(0b111_000, 0, 0);
    rig.assert_clean();
}

#[test]
fn every_device_is_read_at_its_fastest_clock() {
    for device in DEVICES {
        let mut rig = Rig::new(device.encoder(), device.max_clock_hz, 10.0);
        let command = if device.endat22 { 0b111_000 } else { 0b000_111 };
        (0..3).for_each(|_| {
            rig.good(command, 0, 0);
        });
        rig.assert_clean();
    }
    let mut rig = Rig::new(LC_416.encoder(), 2_000_000, 50.0);
    rig.good(0b000_111, 0, 0);
    rig.good(0b001_001, area::OPERATING_STATUS, 0); // with CLOCK parked LOW for less than 30 us
    rig.assert_clean();
}
