//! A stream with its channels, driven cycle by cycle; the `cobs` and `crc` crates decode its frames.

use crate::three_way::Stimulus;
use crc::{Crc, CRC_16_IBM_3740};
use endat_hdl::card::stream::{buffer::SetParts, channel::SetChannel, Stream};
use endat_hdl::regs::Protocol;
use rtl_design::elaborate::elaborate;
use rtl_design::engine::{Compiled, Engine, PortId};
use rust_hdl::prelude::Block;
use std::collections::HashMap;

/// CRC of a set, independent of the core.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// Words of the stream.
pub mod word {
    pub const CONTROL: u8 = 0;
    pub const STATE: u8 = 1;
    pub const DATA: u8 = 2;
    pub const CLEAR: u8 = 3;
}

/// A channel in a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Part {
    pub position: u64,
    pub status: u16,
}

/// Bits of the status.
pub const TAKEN: u16 = 1 << 5;
pub const VALID: u16 = 1 << 6;
pub const FRESH: u16 = 1 << 7;
pub const MISSING: u16 = 1 << 15;

/// A set as decoded by a host.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Set {
    pub lost: u8,
    pub sequence: u16,
    pub timestamp: u32,
    pub parts: Vec<Part>,
}

impl Set {
    /// The expected frame.
    pub fn frame(&self) -> Vec<u8> {
        let mut bytes = vec![0x10 | self.parts.len() as u8, self.lost];
        bytes.extend(self.sequence.to_le_bytes());
        bytes.extend(self.timestamp.to_le_bytes());
        for part in &self.parts {
            bytes.extend(&part.position.to_le_bytes()[..6]);
            bytes.extend(part.status.to_le_bytes());
        }
        bytes.extend(CRC.checksum(&bytes).to_le_bytes());
        let mut frame = cobs::encode_vec(&bytes);
        frame.push(0);
        frame
    }

    /// Decodes a frame (without its zero); the error describes the problem.
    pub fn decode(frame: &[u8]) -> Result<Self, String> {
        let bytes = cobs::decode_vec(frame).map_err(|e| format!("COBS: {e:?}"))?;
        let (head, channels) = (bytes[0], usize::from(bytes[0] & 15));
        if head >> 4 != 1 || bytes.len() != 10 + 8 * channels {
            return Err(format!("head {head:#x}, {} bytes", bytes.len()));
        }
        let (content, crc) = bytes.split_at(bytes.len() - 2);
        if CRC.checksum(content).to_le_bytes() != crc {
            return Err("CRC".into());
        }
        let part = |b: &[u8]| Part {
            position: u64::from_le_bytes([b[0], b[1], b[2], b[3], b[4], b[5], 0, 0]),
            status: u16::from_le_bytes([b[6], b[7]]),
        };
        Ok(Self {
            lost: bytes[1],
            sequence: u16::from_le_bytes([bytes[2], bytes[3]]),
            timestamp: u32::from_le_bytes([bytes[4], bytes[5], bytes[6], bytes[7]]),
            parts: content[8..].chunks(8).map(part).collect(),
        })
    }

    /// All sets of a stream that ends with the end of a frame; empty frames are ignored.
    pub fn all(stream: &[u8]) -> Vec<Self> {
        assert_eq!(stream.last().copied().unwrap_or(0), 0, "half a frame");
        let frames = stream.split(|b| *b == 0).filter(|f| !f.is_empty());
        frames.map(|f| Self::decode(f).unwrap()).collect()
    }
}

/// An engine with its ports by name.
pub struct Named {
    pub engine: Compiled,
    ids: HashMap<String, PortId>,
    record: Option<Stimulus>,
}

impl Named {
    pub fn new(mut block: impl Block, name: &str) -> Self {
        block.connect_all();
        let engine = Compiled::new(&elaborate(&block, name).unwrap()).unwrap();
        let names = engine.ports().iter().enumerate();
        let ids = names.map(|(i, p)| (p.name.clone(), PortId(i))).collect();
        Self {
            engine,
            ids,
            record: None,
        }
    }

    pub fn set(&mut self, name: &str, value: impl Into<u128>) {
        self.engine.set(self.ids[name], value.into());
    }

    pub fn tick(&mut self) {
        if let Some(record) = &mut self.record {
            let row = record
                .inputs
                .iter()
                .map(|name| self.engine.get(self.ids[name]));
            record.cycles.push(row.collect());
        }
        self.engine.tick();
    }

    pub fn get(&mut self, name: &str) -> u64 {
        self.engine.get(self.ids[name]) as u64
    }
}

/// Outputs of a channel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Channel {
    pub busy: bool,
    /// In the next cycle.
    pub strobe: bool,
    pub position: u64,
    /// As in a set, without the bits `TAKEN` and `MISSING`.
    pub status: u16,
    /// The position does not match its parity.
    pub is_upset: bool,
}

/// An access to a word: byte of a read, or a value to write.
#[derive(Clone, Copy, Debug)]
pub enum Access {
    Read {
        word: u8,
        lane: u8,
    },
    Write {
        word: u8,
        value: u32,
    },
    /// Another part of the card.
    Elsewhere,
}

/// Environment of a stream.
pub struct Rig {
    pub stream: Named,
    pub set: Vec<Named>,
    pub channel: Vec<Channel>,
    /// A trigger in the next cycle.
    pub trigger: bool,
    pub access: Option<Access>,
    /// The line accepts a byte in the next cycle.
    pub line_free: bool,
    /// Bytes accepted by the line.
    pub pushed: Vec<u8>,
    pub triggers: u32,
    pub timestamp: u32,
    /// A set was taken in the last cycle.
    pub taken: bool,
}

impl Rig {
    pub fn new(bytes: u64, channels: usize, collect: bool, push: bool) -> Self {
        Self::with(bytes, channels, [collect, push], false)
    }

    /// A collecting stream, on a card with separate channel triggers.
    pub fn with_late_results(bytes: u64, channels: usize) -> Self {
        Self::with(bytes, channels, [true, false], true)
    }

    fn with(bytes: u64, channels: usize, [collect, push]: [bool; 2], takes_late: bool) -> Self {
        Self {
            stream: Named::new(
                Stream::new(bytes, channels, collect, push, SetParts::default()),
                "stream",
            ),
            set: (0..channels)
                .map(|n| {
                    Named::new(
                        SetChannel::new(n, Protocol::Endat, takes_late, SetParts::default(), true),
                        "set_channel",
                    )
                })
                .collect(),
            channel: vec![Channel::default(); channels],
            trigger: false,
            access: None,
            line_free: false,
            pushed: Vec::new(),
            triggers: 0,
            timestamp: 0xffff_f000,
            taken: false,
        }
    }

    /// As after power-up, except for the memory content: a new rig takes long.
    pub fn reset(&mut self) {
        for part in self.set.iter_mut().chain([&mut self.stream]) {
            part.set("reset", true);
        }
        self.step();
        for part in self.set.iter_mut().chain([&mut self.stream]) {
            part.set("reset", false);
        }
        self.channel.fill(Channel::default());
        self.pushed.clear();
        self.triggers = 0;
    }

    /// From now on the inputs of the blocks are recorded.
    pub fn record(&mut self) {
        for part in self.set.iter_mut().chain([&mut self.stream]) {
            let inputs = part.engine.ports().iter().filter(|p| p.is_input);
            part.record = Some(Stimulus {
                inputs: inputs.map(|p| p.name.clone()).collect(),
                ..Stimulus::default()
            });
        }
    }

    /// The recordings of the stream, and of each channel.
    pub fn recorded(self) -> Vec<Stimulus> {
        let parts = [self.stream].into_iter().chain(self.set);
        parts.filter_map(|part| part.record).collect()
    }

    /// One cycle.
    pub fn step(&mut self) {
        let (mut owes, mut replaced, mut byte) = (0, 0, 0);
        for (set, channel) in self.set.iter_mut().zip(&self.channel) {
            set.set("trigger", self.trigger);
            set.set("busy", channel.busy);
            set.set("result_strobe", channel.strobe);
            set.set("position", channel.position);
            let parity = channel.position.count_ones() % 2 == 1;
            set.set("position_crc", parity ^ channel.is_upset);
            set.set("position_valid", channel.status & VALID != 0);
            set.set("fresh", channel.status & FRESH != 0);
            set.set("cause", channel.status & 31);
            set.set("flags", u128::from(channel.status >> 8 & 127) << 12);
            owes |= set.get("owes");
            replaced |= set.get("replaced");
            byte |= set.get("set_byte");
        }
        let s = &mut self.stream;
        s.set("trigger", self.trigger);
        s.set("trigger_count", self.triggers);
        s.set("timestamp", self.timestamp);
        s.set("owes", owes);
        s.set("replaced", replaced);
        s.set("channel_byte", byte);
        s.set("access", self.access.is_some());
        let (selected, write, word, lane, value) = match self.access {
            Some(Access::Read { word, lane }) => (true, false, word, lane, 0),
            Some(Access::Write { word, value }) => (true, true, word, 0, value),
            _ => (false, false, 2, 0, 3),
        };
        s.set("selected", selected);
        s.set("write", write);
        s.set("word", word);
        s.set("lane", lane);
        s.set("write_data", value & 3);
        let take = self.line_free && s.get("push_valid") == 1;
        s.set("push_take", take);
        if take {
            self.pushed.push(s.get("push_byte") as u8);
        }
        let (take_set, block, at) = (s.get("take_set"), s.get("block"), s.get("byte_at"));
        s.tick();
        for set in &mut self.set {
            set.set("take", take_set);
            set.set("block", block);
            set.set("byte_at", at);
            set.tick();
        }
        self.taken = take_set == 1;
        self.timestamp = self.timestamp.wrapping_add(1);
        self.triggers = self.triggers.wrapping_add(u32::from(self.trigger));
        self.trigger = false;
        self.access = None;
        self.line_free = false;
        self.channel.iter_mut().for_each(|c| c.strobe = false);
    }

    pub fn run(&mut self, cycles: u64) {
        (0..cycles).for_each(|_| self.step());
    }

    /// A word, byte by byte with some cycles between, as on a bus.
    pub fn read(&mut self, word: u8) -> u32 {
        let mut bytes = [0; 4];
        for (lane, byte) in bytes.iter_mut().enumerate() {
            let lane = lane as u8;
            self.access = Some(Access::Read { word, lane });
            self.step();
            *byte = self.stream.get("read_byte") as u8;
            self.run(3);
            assert_eq!(self.stream.get("read_byte") as u8, *byte, "stays");
        }
        u32::from_be_bytes(bytes)
    }

    pub fn write(&mut self, word: u8, value: u32) {
        self.access = Some(Access::Write { word, value });
        self.step();
    }

    /// Reads words from `stream_data` until the buffer is empty.
    pub fn drain(&mut self) -> Vec<u8> {
        let mut bytes = Vec::new();
        while self.read(word::STATE) & 0xffff != 0 {
            bytes.extend(self.read(word::DATA).to_be_bytes());
        }
        bytes
    }

    /// Accepts all pushed bytes, one every `gap` cycles.
    pub fn push_all(&mut self, gap: u64) {
        let mut idle = 0;
        while idle < 8 {
            let before = self.pushed.len();
            self.line_free = true;
            self.step();
            idle = if self.pushed.len() == before {
                idle + 1
            } else {
                self.run(gap - 1);
                0
            };
        }
    }

    /// A trigger that all channels accept, and their results; returns the written set.
    pub fn set_of(&mut self, channels: &[Channel]) -> Set {
        self.channel.iter_mut().for_each(|c| c.busy = false);
        self.trigger = true;
        let timestamp = self.timestamp;
        self.step();
        let sequence = self.triggers as u16;
        self.run(5);
        for (mine, new) in self.channel.iter_mut().zip(channels) {
            *mine = Channel {
                strobe: true,
                ..*new
            };
        }
        self.step();
        Set {
            lost: 0,
            sequence,
            timestamp,
            parts: channels
                .iter()
                .map(|c| Part {
                    position: c.position,
                    status: c.status | TAKEN,
                })
                .collect(),
        }
    }

    /// Waits until a set has been written.
    pub fn written(&mut self) {
        self.run(endat_hdl::card::stream::buffer::frame_cycles(self.set.len(), false) + 4);
    }
}
