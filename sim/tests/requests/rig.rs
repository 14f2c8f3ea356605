//! A channel with requests on its bench.

use endat_hdl::endat::{
    channel::{Channel, Features, FixedTimes},
    transaction::cause,
};
use endat_hdl::protocol::ModeCommand;
use endat_sim::{
    bench::{Bench, ChannelSettings, Link},
    campaign::{ABORT_US, SAMPLE_LATENCY_CYCLES},
    encoder::{EncoderConfig, FrameEnd, FrameLog},
    frame::Parameter,
    line::LineConfig,
    Time, MS,
};
use rtl_design::elaborate::elaborate;
use rtl_design::engine::Compiled;
use rust_hdl::prelude::Block;
use std::{
    collections::BTreeMap,
    sync::{Mutex, OnceLock, PoisonError},
};

/// More than any frame with its time-outs.
const FRAME_LIMIT: Time = 80 * MS;

/// The fixed times of the channels in these tests.
pub fn fixed_times(system_hz: u64) -> FixedTimes {
    FixedTimes {
        abort_us: ABORT_US,
        ..FixedTimes::at(system_hz)
    }
}

/// A channel after power-up. The design is elaborated once for each system clock.
fn engine(system_hz: u64) -> Compiled {
    static MADE: OnceLock<Mutex<BTreeMap<u64, Compiled>>> = OnceLock::new();
    let mut made = MADE
        .get_or_init(Mutex::default)
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    let make = || {
        let mut block = Channel::with(fixed_times(system_hz), Features::PROTOCOL);
        block.connect_all();
        let design = elaborate(&block, "channel").expect("the channel elaborates");
        Compiled::new(&design).expect("the channel has no loop")
    };
    made.entry(system_hz).or_insert_with(make).clone()
}

/// End of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Over {
    /// The frame carried the request.
    pub is_request: bool,
    /// Primary cause.
    pub cause: u64,
    /// Raw flags.
    pub flags: u64,
    /// The answer, for separate request frames.
    pub reply: u64,
    /// The CRC of the answer is right.
    pub reply_good: bool,
}

/// A channel, a line, an encoder.
pub struct Rig {
    pub bench: Bench<Compiled>,
}

impl Rig {
    /// After reset; triggers send `command`.
    pub fn new(system_hz: u64, endat_hz: u64, encoder: EncoderConfig, cable_m: f64) -> Self {
        let command = match encoder.endat22 {
            true => ModeCommand::SendPositionAddInfo,
            false => ModeCommand::SendPosition,
        };
        let settings = ChannelSettings::new(system_hz, endat_hz, command, encoder.position_bits);
        Self::with(system_hz, settings, encoder, LineConfig::cable(cable_m))
    }

    /// After reset.
    pub fn with(
        system_hz: u64,
        settings: ChannelSettings,
        encoder: EncoderConfig,
        line: LineConfig,
    ) -> Self {
        let link = Link::new(line, encoder);
        let mut bench = Bench::channel(engine(system_hz), system_hz, &settings, link);
        bench.set_sample_latency(SAMPLE_LATENCY_CYCLES + settings.filter_cycles);
        assert!(bench.run_until_done(MS, |b| b.get("busy") == 0));
        Self { bench }
    }

    /// Puts a request at the inputs.
    fn put(&mut self, command: ModeCommand, address: u8, data: u16, strobe: &str) {
        let word = u128::from(address) << 16 | u128::from(data);
        self.bench.set("request_command", command.code().into());
        self.bench.set("request_parameter", word);
        self.strobe(strobe);
    }

    /// Holds an input for one cycle.
    pub fn strobe(&mut self, name: &str) {
        self.bench.set(name, 1);
        self.bench.tick();
        self.bench.set(name, 0);
    }

    /// Runs to the end of the frame under way, and until the channel is idle.
    pub fn over(&mut self) -> Over {
        let b = &mut self.bench;
        assert!(
            b.run_until_done(FRAME_LIMIT, |b| b.get("over") == 1),
            "no end of a frame"
        );
        let over = Over {
            is_request: b.get("over_request") == 1,
            cause: b.get("over_cause") as u64,
            flags: b.get("over_flags") as u64,
            reply: b.get("reply") as u64,
            reply_good: b.get("reply_good") == 1,
        };
        assert!(
            b.run_until_done(FRAME_LIMIT, |b| b.get("busy") == 0),
            "stays busy"
        );
        over
    }

    /// A triggered frame.
    pub fn position(&mut self) -> Over {
        self.bench.trigger();
        self.over()
    }

    /// A request on a triggered frame.
    pub fn ride(&mut self, command: ModeCommand, address: u8, data: u16) -> Over {
        self.put(command, address, data, "request_ride");
        self.bench.run_cycles(4);
        self.position()
    }

    /// A request with a separate frame.
    pub fn own(&mut self, command: ModeCommand, address: u8, data: u16) -> Over {
        self.put(command, address, data, "request_own");
        self.over()
    }

    /// A request in the form that its command needs.
    pub fn request(&mut self, command: ModeCommand, address: u8, data: u16) -> Over {
        match command.has_f2() {
            true => self.ride(command, address, data),
            false => self.own(command, address, data),
        }
    }

    /// A request that must succeed and follow all rules; returns the encoder's log.
    pub fn good(&mut self, command: ModeCommand, address: u8, data: u16) -> FrameLog {
        let over = self.request(command, address, data);
        let frame = self.last_frame();
        assert_eq!(
            cause::name(over.cause),
            "none",
            "{command:?} {over:?} {frame:?}"
        );
        assert!(over.is_request, "{command:?}");
        self.assert_whole(&frame);
        assert_eq!(frame.command, Some(command.code()));
        let sent = Parameter::from_word(u32::from(address) << 16 | u32::from(data));
        if command.has_parameter() {
            assert_eq!(frame.parameter, Some(sent), "{command:?}");
            assert!(over.reply_good, "{command:?}");
            assert_eq!(
                Some(over.reply),
                frame.reply.map(|r| r.word().into()),
                "{command:?}"
            );
        }
        if command.has_supplement() {
            let supplement = frame.supplement.expect("a supplement");
            assert_eq!((supplement.fields, supplement.zeros), (sent, 7));
        }
        frame
    }

    /// A triggered frame that must succeed and follow all rules.
    pub fn good_position(&mut self) -> FrameLog {
        let over = self.position();
        let frame = self.last_frame();
        assert_eq!(cause::name(over.cause), "none", "{over:?} {frame:?}");
        self.assert_whole(&frame);
        frame
    }

    /// The frame is complete, with its exact pulses; position and additional data are those of the encoder.
    fn assert_whole(&mut self, frame: &FrameLog) {
        assert_eq!(frame.end, FrameEnd::Complete, "{frame:?}");
        assert_eq!(
            frame.expected_rising_edges(),
            Some(frame.rising_edges),
            "{frame:?}"
        );
        if frame.has_f2 {
            assert_eq!(
                self.bench.get("position") as u64,
                frame.position,
                "{frame:?}"
            );
            let came = self.bench.get("info_came");
            assert_eq!(
                came,
                self.bench.get("info_good"),
                "all received blocks are good: {frame:?}"
            );
            assert_eq!(frame.infos.len() as u32, came.count_ones(), "{frame:?}");
            for (info, _) in &frame.infos {
                let (name, bit) = match info.code < 0x50 {
                    true => ("info_1", 1),
                    false => ("info_2", 2),
                };
                assert_eq!(came & bit, bit, "{frame:?}");
                let word = info.fields().word();
                assert_eq!(self.bench.get(name), word.into(), "{frame:?}");
            }
        }
    }

    /// The last frame, as seen by the encoder.
    pub fn last_frame(&self) -> FrameLog {
        self.bench
            .frames(0)
            .last()
            .expect("the encoder received a frame")
            .clone()
    }

    /// The encoder has noted no violation.
    pub fn assert_clean(&self) {
        assert_eq!(self.bench.violations(0), []);
        assert_eq!(self.bench.conflicts(0), []);
    }
}
