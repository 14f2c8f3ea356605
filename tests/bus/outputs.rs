//! Outputs to logic and to a processor in the same device: cropped position, error, interrupt.

use super::{sound, text, Master};
use crate::stream_rig::Named;
use crate::three_way::{three_way, Stimulus};
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::direct::{DirectOutput, CROP_CYCLES};
use endat_hdl::card::interrupt::Interrupt;
use endat_hdl::endat::transaction::cause;
use endat_hdl::regs::{Block, CARD, DIRECT, INTERRUPT, RESULT};
use endat_sim::encoder::{Defect, EncoderConfig};
use endat_sim::rng::Rng;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block as _;

const OUTPUTS: &str = "[outputs]\nparts = [\"position\", \"interrupt\"]\n";

fn at(block: &Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// Triggers, and runs to the end of the frame; how many cycles each channel's strobe was high, and how often it was so without `valid`.
fn frame(master: &mut Master) -> [(u32, u32); 2] {
    let mut seen = [(0, 0); 2];
    master.write(at(&CARD, "trigger_now", 0), 1);
    for _ in 0..8_000 {
        master.bench.run_cycles(1);
        for (channel, (strobes, stale)) in seen.iter_mut().enumerate() {
            if master.bench.get(&format!("direct_fresh{channel}_o")) != 0 {
                *strobes += 1;
                *stale += u32::from(master.bench.get(&format!("direct_valid{channel}_o")) == 0);
            }
        }
    }
    seen
}

/// A card whose channels know their line delay; nothing has been told of it.
fn ready() -> Master {
    ready_spoilt(&[])
}

/// The first frame of channel 0 behind [`ready`]: one has measured, one has brought a position.
const FIRST: u64 = 2;

/// The same; the encoder of channel 0 spoils the CRC of these frames.
fn ready_spoilt(spoilt: &[u64]) -> Master {
    let project = parse("card.toml", &text(HostBus::Apb, OUTPUTS)).unwrap();
    let spoil = |encoder: EncoderConfig, frame: &u64| encoder.defect(*frame, Defect::CrcXor(1));
    let first = spoilt.iter().fold(sound(0, 29), spoil);
    let mut master = Master::with_encoders(&project, vec![(0, first), (1, sound(1, 25))]);
    master.write(at(&CARD, "trigger_now", 0), 1);
    master.bench.run_cycles(60_000);
    master.write(at(&INTERRUPT, "clear", 0), u32::MAX);
    master
}

#[test]
fn a_card_gives_any_part_of_its_positions_to_the_logic_beside_it() {
    let mut master = ready();
    assert_eq!(master.read(at(&DIRECT, "crop", 0)), 29 << 8);
    let mut rng = Rng::new(5);
    for round in 0..12 {
        let crops = [0, 1].map(|_| [rng.in_range(0, 30) as u32, rng.in_range(0, 32) as u32]);
        for (channel, [first, length]) in crops.iter().enumerate() {
            // The start values once, too.
            if round > 0 {
                master.write(at(&DIRECT, "crop", channel), first | length << 8);
            }
        }
        assert_eq!(frame(&mut master), [(1, 0); 2], "one strobe each");
        for (channel, &[first, length]) in crops.iter().enumerate() {
            let [first, length] = match round {
                0 => [0, 29 - 4 * channel as u32],
                _ => [first, length],
            };
            let low = u64::from(master.read(at(&RESULT, "position_low", channel)));
            let expected = low >> first & ((1 << length) - 1);
            let position = master.bench.get(&format!("direct_position{channel}_o"));
            assert_eq!(position as u64, expected, "{first} {length}");
        }
    }
}

#[test]
fn error_follows_the_causes_that_are_selected() {
    let mut master = ready_spoilt(&[FIRST + 1]);
    let error = |master: &mut Master| master.bench.get("direct_error0_o") != 0;
    let valid = |master: &mut Master| master.bench.get("direct_valid0_o") != 0;
    frame(&mut master);
    assert!(valid(&mut master) && !error(&mut master));
    let position = master.bench.get("direct_position0_o");
    assert_eq!(frame(&mut master)[0], (0, 0), "a bad result has no strobe");
    assert!(!valid(&mut master) && error(&mut master));
    assert_eq!(master.bench.get("direct_position0_o"), position, "held");
    assert_eq!(
        master.read(at(&RESULT, "status", 0)) >> 16 & 31,
        cause::CRC as u32
    );
    // Not selected; all others are.
    master.write(at(&DIRECT, "error_causes", 0), !(1 << cause::CRC));
    master.bench.run_cycles(2);
    assert!(!error(&mut master) && !valid(&mut master));
    master.write(at(&DIRECT, "error_causes", 0), 1 << cause::CRC);
    master.bench.run_cycles(2);
    assert!(error(&mut master));
    assert_eq!(master.bench.get("direct_error1_o"), 0, "the other channel");
    frame(&mut master);
    assert!(valid(&mut master) && !error(&mut master));
}

#[test]
fn the_interrupt_comes_for_what_the_mask_lets_through_and_goes_when_it_is_cleared() {
    let mut master = ready_spoilt(&[FIRST + 1, FIRST + 2]);
    let [status, mask, clear] = ["status", "mask", "clear"].map(|name| at(&INTERRUPT, name, 0));
    let irq = |master: &mut Master| {
        master.bench.run_cycles(2);
        master.bench.get("irq_o") != 0
    };
    frame(&mut master);
    assert_eq!(master.read(status), 0x11, "a result of each channel");
    assert!(!irq(&mut master), "nothing is let through after reset");
    master.write(mask, 0x10);
    assert!(irq(&mut master));
    master.write(clear, 0x01);
    assert!(irq(&mut master));
    assert_eq!(master.read(status), 0x10);
    master.write(clear, 0x10);
    assert!(!irq(&mut master));
    // An error of channel 0, twice: each bad result is one.
    master.write(mask, 0x02);
    for _ in 0..2 {
        frame(&mut master);
        assert!(irq(&mut master));
        assert_eq!(master.read(status), 0x13);
        master.write(clear, u32::MAX);
        assert!(!irq(&mut master));
    }
    assert_eq!(master.read(mask), 0x02);
    assert_eq!(master.read(clear), 0);
    // What is read only stays.
    master.write(status, u32::MAX);
    assert_eq!(master.read(status), 0);
}

/// Sets inputs of a block to 0 and takes it out of reset.
fn idle(block: &mut Named) {
    block.set("reset", 1u8);
    block.tick();
    block.set("reset", 0u8);
    block.set("in_range", 1u8);
}

#[test]
fn the_cropped_position_comes_with_a_fixed_delay_whatever_the_crop() {
    for (first, length) in [(0u32, 32u32), (47, 1), (20, 28), (40, 32), (3, 0)] {
        let mut block = Named::new(DirectOutput::new(0, 48), "direct_output");
        idle(&mut block);
        block.set("word_address", DIRECT.base);
        block.set("write", 1u8);
        block.set("write_data", first | length << 8);
        block.tick();
        block.set("write", 0u8);
        let position = 0xa5c3_96f0_1b2du64;
        block.set("position", position);
        block.set("fresh", 1u8);
        block.set("result_strobe", 1u8);
        block.tick();
        block.set("result_strobe", 0u8);
        let mut cycles = 1;
        while block.get("direct_fresh") == 0 {
            assert_eq!(block.get("direct_valid"), 0, "not yet");
            block.tick();
            cycles += 1;
        }
        assert_eq!(cycles, CROP_CYCLES);
        let expected = position >> first & ((1 << length) - 1);
        assert_eq!(block.get("direct_position"), expected, "{first} {length}");
        assert_eq!(block.get("direct_valid"), 1);
        // A fault that is seen later takes the position back.
        block.set("fresh", 0u8);
        block.tick();
        assert_eq!(
            (block.get("direct_valid"), block.get("direct_fresh")),
            (0, 0)
        );
    }
}

#[test]
fn an_event_in_the_cycle_of_its_clear_is_not_lost() {
    for distance in -3..=3i32 {
        let mut block = Named::new(Interrupt::new(2), "interrupt");
        idle(&mut block);
        block.set("word_address", INTERRUPT.base + 2);
        block.set("write_data", u32::MAX);
        for cycle in -4..=4i32 {
            block.set("write", u8::from(cycle == 0));
            block.set("request_1", u8::from(cycle == distance));
            block.tick();
        }
        block.set("word_address", INTERRUPT.base);
        block.set("lane", 3u8);
        block.tick();
        let expected = if distance < 0 { 0 } else { 0x80 };
        assert_eq!(block.get("read_byte"), expected, "{distance}");
    }
}

/// Accesses to the block's own words and to others, everything else at random.
fn stimulus(inputs: &[(&'static str, usize)], words: &[u16], count: usize) -> Stimulus {
    let mut rng = Rng::new(11);
    let mut cycles = vec![];
    for cycle in 0..count {
        let row = inputs.iter().map(|(name, width)| match *name {
            "reset" => u128::from(cycle < 2 || cycle == count / 2),
            "word_address" => words[rng.in_range(0, words.len() as u64 - 1) as usize].into(),
            "result_strobe" => (rng.in_range(0, 100) == 0).into(),
            "write" => (rng.in_range(0, 8) == 0).into(),
            _ => u128::from(rng.next_u64()) & ((1 << width) - 1),
        });
        cycles.push(row.collect());
    }
    Stimulus {
        inputs: inputs.iter().map(|(name, _)| (*name).to_owned()).collect(),
        cycles,
        middle: vec![],
    }
}

/// In so many cycles, in which more than `least` positions come.
fn direct_output_agrees(cycles: usize, least: usize) {
    let mut block = DirectOutput::new(1, 29);
    block.connect_all();
    let design = elaborate(&block, "direct_output").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, result_strobe, position, fresh, cause, alarm, word_address, in_range, lane, write, write_data;
        out read_byte, direct_position, direct_valid, direct_fresh, direct_error);
    let inputs = [
        ("reset", 1),
        ("result_strobe", 1),
        ("position", 48),
        ("fresh", 1),
        ("cause", 5),
        ("alarm", 1),
        ("word_address", 11),
        ("in_range", 1),
        ("lane", 2),
        ("write", 1),
        ("write_data", 32),
    ];
    let words = [8, 9, 10].map(|n| DIRECT.base + n);
    let seen = three_way(
        &format!("direct_output_{cycles}"),
        &mut kernel,
        &design,
        &stimulus(&inputs, &words, cycles),
    )
    .unwrap();
    let fresh = seen.output("direct_fresh");
    let fresh = fresh.iter().filter(|v| **v != 0).count();
    assert!(fresh > least, "{fresh}");
}

#[test]
fn direct_output_agrees_in_three_ways() {
    direct_output_agrees(1_500, 1);
}

#[test]
#[ignore = "slow: kernels, engines and simulators on thousands of cycles of the direct output"]
fn direct_output_agrees_in_three_ways_for_long() {
    direct_output_agrees(6_000, 10);
}

#[test]
fn outputs_are_refused_where_nothing_could_take_them() {
    for (bus, message) in [
        (
            HostBus::Bare,
            "outputs.parts = \"interrupt\": host.bus = \"none\" has",
        ),
        (
            HostBus::Uart,
            "outputs.parts = \"interrupt\": a card with a UART",
        ),
    ] {
        let text = match bus {
            HostBus::Uart => endat_config::preset("s6_two_channel").unwrap().to_owned() + OUTPUTS,
            _ => text(bus, OUTPUTS).replacen(
                "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n",
                "",
                1,
            ),
        };
        let all = parse("card.toml", &text).unwrap_err();
        assert_eq!(all.len(), 1, "{all:?}");
        assert!(all[0].to_string().contains(message), "{all:?}");
    }
    let unknown = text(HostBus::Apb, "[outputs]\nparts = [\"speed\"]\n");
    let all = parse("card.toml", &unknown).unwrap_err();
    assert!(
        all[0]
            .to_string()
            .contains("unknown part; use position, interrupt"),
        "{all:?}"
    );
}
