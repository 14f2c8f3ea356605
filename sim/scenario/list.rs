//! The scenarios.

use super::{ChannelScenario, Request, Scenario};
use crate::{
    bench::ChannelSettings,
    encoder::{area, Defect, EncoderConfig, PositionSource},
    line::{GlitchRate, LineConfig, Wire},
    Time, MS, NS, US,
};
use endat_hdl::endat::transaction::cause;
use endat_hdl::protocol::ModeCommand::{self, SendPosition, SendPositionAddInfo};

/// Abort time of scenarios with aborted frames: long enough for the encoder's time-out, short enough for simulation.
const SHORT_ABORT_US: u64 = 200;

/// A good frame, for the lists of causes.
const OK: u64 = cause::NONE;

/// The scenario called `name`.
pub fn named(name: &str) -> Option<Scenario> {
    all().into_iter().find(|s| s.name == name)
}

/// Every scenario.
pub fn all() -> Vec<Scenario> {
    vec![
        paper(),
        paper_flow(),
        real_1(),
        lc416(),
        long_cable(),
        sixteen_megahertz(),
        unplugged(),
        crc_error(),
        alarm(),
        glitches(),
        overrun(),
        additional_data(),
        parameter(),
        no_answer(),
        initialise(),
    ]
}

/// A channel with suitable settings for its encoder.
fn channel(
    rates: (u64, u64),
    command: ModeCommand,
    encoder: EncoderConfig,
    cable_m: f64,
) -> ChannelScenario {
    let (system_hz, endat_hz) = rates;
    ChannelScenario {
        settings: ChannelSettings::new(system_hz, endat_hz, command, encoder.position_bits),
        encoder,
        line: LineConfig::cable(cable_m),
    }
}

fn ramp(start: u64, step: u64) -> PositionSource {
    PositionSource::Ramp { start, step }
}

/// The angle encoder of the acquisition card: 29 bits.
fn rcn8510() -> EncoderConfig {
    EncoderConfig::endat22(29).position(ramp(0x0123_4567, 0x1111))
}

fn paper() -> Scenario {
    let rates = (100_000_000, 3_125_000);
    let second = rcn8510().position(ramp(0x1FFF_FFFE, 1)).seed(2);
    Scenario {
        name: "paper",
        summary: "two RCN 8510 angle encoders at 3.125 MHz, sampled at 10 kHz, as on the two-channel card",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![
            channel(rates, SendPositionAddInfo, rcn8510(), 10.0),
            channel(rates, SendPositionAddInfo, second, 15.0),
        ],
        trigger_period: 100 * US,
        triggers: 4,
        requests: &[],
        initialisation: 0,
        causes: &[OK; 5],
        may_stop: false,
    }
}

/// A position whose CRC, after F1 F2 = 01, is 0x1D: that of the frame in the paper.
const POSITION_WITH_CRC_1D: u64 = 0x0ABC_DE06;

/// Liu et al., figure 4: wait for the trigger, clock and command, start bit, error bits, position, CRC; with every exit.
fn paper_flow() -> Scenario {
    let bits = |f1, f2| Defect::ErrorBits { f1, f2 };
    let encoder = EncoderConfig::endat22(29)
        .position(PositionSource::Fixed(POSITION_WITH_CRC_1D))
        .defect(3, Defect::NoStartBit)
        .defect(
            6,
            Defect::Glitch {
                after: 5_050 * NS,
                width: 300 * NS,
            },
        )
        .defect(9, bits(true, false))
        .defect(10, Defect::CrcXor(0b1_0000));
    Scenario {
        name: "paper-flow",
        summary: "the flow chart of the two-channel card: a good frame with CRC 0x1D, then no start bit, a wrong one, error bits, a wrong CRC; data is held",
        trigger_period: MS,
        triggers: 8,
        causes: &[
            OK,
            OK,
            cause::NO_START_BIT,
            OK,
            cause::START_WINDOW,
            OK,
            cause::F1,
            cause::CRC,
            OK,
        ],
        may_stop: true,
        ..one_rcn8510(encoder)
    }
}

fn real_1() -> Scenario {
    let rates = (128_000_000, 8_000_000);
    let mut encoder = EncoderConfig::endat22(37).position(PositionSource::Fixed(0x7_5006_84EF));
    encoder.tcal = 4_520 * NS;
    encoder.tm = 21_140 * NS..=21_140 * NS;
    encoder.max_clock_hz = 8_000_000;
    let mut channel = channel(rates, SendPositionAddInfo, encoder, 2.0);
    channel.settings = channel.settings.start_time_ns(2_040, rates.0);
    Scenario {
        name: "real-1",
        summary: "the published logic-analyser picture of a 37-bit encoder at 8 MHz: 66 rising edges, CRC 0x19",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel],
        trigger_period: 50 * US,
        triggers: 2,
        requests: &[],
        initialisation: 0,
        causes: &[OK; 3],
        may_stop: false,
    }
}

fn lc416() -> Scenario {
    let rates = (100_000_000, 2_000_000);
    let mut encoder = EncoderConfig::endat22(36).position(ramp(0x1_2345_6789, 100));
    encoder.max_clock_hz = 2_000_000;
    encoder.max_clock_low = 30 * US;
    let mut channel = channel(rates, SendPosition, encoder, 3.0);
    channel.settings = channel.settings.start_time_ns(0, rates.0);
    Scenario {
        name: "lc416",
        summary: "a 36-bit LC 416 linear encoder asked with the EnDat 2.1 command at 2 MHz, 16 kHz control cycle",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel],
        trigger_period: 62_500 * NS,
        triggers: 4,
        requests: &[],
        initialisation: 0,
        causes: &[OK; 5],
        may_stop: false,
    }
}

fn long_cable() -> Scenario {
    let rates = (100_000_000, 8_333_333);
    let encoder = EncoderConfig::endat22(25).position(ramp(0x1AB_CDEF, 0x1_0001));
    Scenario {
        name: "long-cable",
        summary: "100 m of cable at 8.33 MHz: ten clock pulses are always on their way",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel(rates, SendPositionAddInfo, encoder, 100.0)],
        trigger_period: 60 * US,
        triggers: 4,
        requests: &[],
        initialisation: 0,
        causes: &[OK; 5],
        may_stop: false,
    }
}

fn sixteen_megahertz() -> Scenario {
    let rates = (128_000_000, 16_000_000);
    let mut encoder = EncoderConfig::endat22(25).position(ramp(0x155_5555, 0x01_2345));
    encoder.tm = 1_250 * NS..=3_750 * NS;
    Scenario {
        name: "sixteen-megahertz",
        summary: "the fastest clock, 20 m of cable and the short recovery time",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel(rates, SendPositionAddInfo, encoder, 20.0)],
        trigger_period: 15 * US,
        triggers: 8,
        requests: &[],
        initialisation: 0,
        causes: &[OK; 9],
        may_stop: false,
    }
}

/// One RCN 8510 at 3.125 MHz, for scenarios with faults.
fn one_rcn8510(encoder: EncoderConfig) -> Scenario {
    let rates = (100_000_000, 3_125_000);
    let mut channel = channel(rates, SendPositionAddInfo, encoder, 10.0);
    channel.settings.abort_us = SHORT_ABORT_US;
    Scenario {
        name: "",
        summary: "",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel],
        trigger_period: 100 * US,
        triggers: 5,
        requests: &[],
        initialisation: 0,
        causes: &[],
        may_stop: false,
    }
}

fn unplugged() -> Scenario {
    let mut encoder = rcn8510();
    encoder.unplugged.push(2_500 * US..4_500 * US);
    Scenario {
        name: "unplugged",
        summary: "the encoder's plug is pulled for two triggers and put back; the next frame measures the delay again",
        trigger_period: MS,
        triggers: 6,
        causes: &[OK, OK, OK, cause::DATA_NOT_LOW, cause::DATA_NOT_LOW, OK, OK],
        ..one_rcn8510(encoder)
    }
}

fn crc_error() -> Scenario {
    let encoder = rcn8510()
        .defect(3, Defect::FlipBits(1 << 7))
        .defect(5, Defect::CrcXor(0b0_0100));
    Scenario {
        name: "crc-error",
        summary: "one position bit and one CRC bit arrive wrong; the last good position is held",
        causes: &[OK, OK, cause::CRC, OK, cause::CRC, OK],
        ..one_rcn8510(encoder)
    }
}

fn alarm() -> Scenario {
    let bits = |f1, f2| Defect::ErrorBits { f1, f2 };
    let encoder = rcn8510()
        .defect(3, bits(true, true))
        .defect(4, bits(false, false))
        .defect(5, bits(true, false));
    Scenario {
        name: "alarm",
        summary: "the encoder reports an error in F1, in F2 and in both, with a correct CRC",
        causes: &[OK, OK, cause::F1, cause::F2, cause::F1, OK],
        ..one_rcn8510(encoder)
    }
}

fn glitches() -> Scenario {
    /// The filter suppresses pulses of up to this many system clock cycles.
    const FILTER_CYCLES: u64 = 3;
    let longest: Time = 25 * NS;
    let mut scenario = Scenario {
        name: "glitches",
        summary: "short pulses on DATA, shorter than the input filter lets through",
        causes: &[OK; 6],
        ..one_rcn8510(rcn8510())
    };
    let channel = &mut scenario.channels[0];
    channel.settings.filter_cycles = FILTER_CYCLES;
    channel.line.random_glitches = Some(GlitchRate {
        wire: Wire::Data,
        mean_gap: 1_500 * NS,
        shortest: 3 * NS,
        longest,
    });
    scenario
}

fn overrun() -> Scenario {
    let mut encoder = rcn8510();
    encoder.tm = 20 * US..=20 * US;
    Scenario {
        name: "overrun",
        summary: "triggers come twice as fast as frames can follow: every other one is lost, and reported",
        trigger_period: 30 * US,
        triggers: 10,
        causes: &[
            OK,
            OK,
            cause::TRIGGER_OVERRUN,
            cause::TRIGGER_OVERRUN,
            cause::TRIGGER_OVERRUN,
            cause::TRIGGER_OVERRUN,
        ],
        ..one_rcn8510(encoder)
    }
}

fn additional_data() -> Scenario {
    const SELECT: Request = Request {
        trigger: 1,
        command: ModeCommand::PositionSelectMemory,
        address: 0x4C,
        data: 0,
    };
    Scenario {
        name: "additional-data",
        summary: "temperature and time stamp are selected in supplements, and follow each position from then on",
        trigger_period: 100 * US,
        triggers: 4,
        requests: &[
            SELECT,
            Request {
                trigger: 2,
                address: 0x5B,
                ..SELECT
            },
            Request {
                trigger: 4,
                command: ModeCommand::PositionSendParameter,
                address: 0x0D,
                data: 0,
            },
        ],
        causes: &[OK; 5],
        ..one_rcn8510(rcn8510())
    }
}

fn parameter() -> Scenario {
    const SELECT: Request = Request {
        trigger: 2,
        command: ModeCommand::SelectMemory,
        address: area::MANUFACTURER_1,
        data: 0,
    };
    let rates = (100_000_000, 2_000_000);
    let mut encoder = rcn8510();
    encoder.tac = 200 * US..=200 * US;
    Scenario {
        name: "parameter",
        summary: "a memory area is selected and a word of it read, with EnDat 2.1 commands in frames of their own",
        endat_hz: rates.1,
        channels: vec![channel(rates, SendPositionAddInfo, encoder, 3.0)],
        trigger_period: 2 * MS,
        requests: &[
            SELECT,
            Request {
                trigger: 3,
                command: ModeCommand::SendParameter,
                address: 0x0D,
                ..SELECT
            },
        ],
        causes: &[OK; 4],
        ..one_rcn8510(rcn8510())
    }
}

fn no_answer() -> Scenario {
    let rates = (100_000_000, 3_125_000);
    let encoder = rcn8510().defect(3, Defect::NoStartBit);
    let channel = channel(rates, SendPositionAddInfo, encoder, 10.0);
    Scenario {
        name: "no-answer",
        summary: "the encoder does not answer: a pause of 30 ms, then the delay is measured again",
        channels: vec![channel],
        trigger_period: 12 * MS,
        triggers: 6,
        causes: &[OK, OK, cause::NO_START_BIT, cause::TRIGGER_OVERRUN, OK],
        may_stop: true,
        ..one_rcn8510(rcn8510())
    }
}

fn initialise() -> Scenario {
    // Two seconds are long, so use as few cycles as possible.
    let rates = (4_000_000, 500_000);
    Scenario {
        name: "initialise",
        summary: "from power-up to the first positions: the card resets the encoder and reads its name plate",
        system_hz: rates.0,
        endat_hz: rates.1,
        channels: vec![channel(rates, SendPositionAddInfo, rcn8510(), 10.0)],
        initialisation: 1_650 * MS,
        trigger_period: 200 * US,
        triggers: 2,
        causes: &[OK; 3],
        may_stop: true,
        ..one_rcn8510(rcn8510())
    }
}
