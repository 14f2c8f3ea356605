//! Stream, a channel's part and a complete card with a stream: kernels, engines and emitted Verilog agree in every cycle.

use super::rig::{Access, Channel, Rig};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::card::stream::{buffer::SetParts, channel::SetChannel, Stream};
use endat_hdl::regs::Protocol;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

/// Reproducible numbers.
fn random() -> impl FnMut(u32) -> u32 {
    let mut state = 0x1234_5678_9abc_def1u64;
    move |below| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as u32 % below
    }
}

/// Inputs of both blocks in a random life with all kinds of events.
fn recorded() -> (Stimulus, Stimulus) {
    let mut random = random();
    let mut rig = Rig::new(1024, 1, true, false);
    rig.record();
    for cycle in 0..9_000u32 {
        rig.trigger = random(500) == 0;
        let channel = &mut rig.channel[0];
        channel.busy = random(400) == 0 || (channel.busy && random(60) != 0);
        channel.strobe = random(300) == 0;
        if channel.strobe {
            *channel = Channel {
                position: u64::from(random(1 << 16)) << 20,
                status: random(1 << 15) as u16 & !(1 << 5),
                ..*channel
            };
        }
        rig.line_free = random(30) == 0;
        let (word, lane) = (random(4) as u8, random(4) as u8);
        rig.access = match random(30) {
            0 => Some(Access::Elsewhere),
            1..4 => Some(Access::Read { word, lane }),
            // Clear is rare, so that the buffer is usually not empty.
            4 if word < 3 || random(8) == 0 => Some(Access::Write {
                word,
                value: random(4) | u32::from(cycle % 1000 < 500),
            }),
            _ => None,
        };
        rig.step();
    }
    let [stream, channel] = rig.recorded().try_into().ok().unwrap();
    (stream, channel)
}

#[test]
fn stream_and_channel_agree_in_kernels_engines_and_verilog() {
    let (stream, channel) = recorded();
    let mut block = Stream::new(1024, 1, true, false, SetParts::default());
    block.connect_all();
    let design = elaborate(&block, "stream").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, trigger, trigger_count, timestamp, owes, replaced, channel_byte, selected, word, lane, access, write, write_data;
        out take_set, block, byte_at, read_byte;
        bundles pushed);
    let recording = three_way("stream", &mut kernel, &design, &stream).unwrap();
    // The recording is not trivial.
    let pushed = recording.output("push_byte");
    assert!(pushed.contains(&0x11), "the head of a set");
    assert!(recording.output("take_set").iter().sum::<u128>() > 5);

    let mut block = SetChannel::new(0, Protocol::Endat, false, SetParts::default(), true);
    block.connect_all();
    let design = elaborate(&block, "set_channel").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, trigger, busy, result_strobe, position, position_crc, position_has_f2, position_valid, fresh, cause, flags, take, block, byte_at;
        out set_byte, owes, replaced);
    three_way("set_channel", &mut kernel, &design, &channel).unwrap();
}
