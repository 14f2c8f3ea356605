//! The second interface: an SPI master that knows nothing but the page, beside the first controller at its bus.

use super::spi::crc16;
use super::{at, frame, sound, text, Master, WORD_BUSES};
use crate::three_way::{three_way, Stimulus};
use crate::tools::{self, require};
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::second_interface::record::SecondRecord;
use endat_hdl::card::second_interface::SecondInterface;
use endat_hdl::regs::{CARD, RESULT};
use endat_sim::encoder::Defect;
use endat_sim::rng::Rng;
use rtl_design::elaborate::elaborate;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block as _;

const SECOND: &str = "[safety]\nparts = [\"second_interface\"]\n";
const WITH_INFOS: &str =
    "[service]\nparts = [\"requests\"]\ninfos = [0x4C, 0x5B]\n[safety]\nparts = [\"second_interface\", \"recovery_counter\"]\n";
/// Half a period of the serial clock, in system clocks: the fastest that is allowed.
const HALF: u64 = 4;
/// Words of an answer of two channels.
const WORDS: usize = 2 + 2 * 9;

fn card(bus: HostBus, more: &str) -> Master {
    let project = parse("card.toml", &text(bus, more)).unwrap();
    let mut master = Master::with_encoders(&project, vec![(0, sound(0, 29)), (1, sound(1, 25))]);
    master.set("second_cs_n_i", 1);
    master.bench.run_cycles(20);
    master
}

/// So many bits of an answer; noise now and then turns the clock round for a cycle.
fn bits(master: &mut Master, count: usize, half: u64, noise: u64) -> Vec<u8> {
    let phase = master.rng.in_range(0, 3);
    master.bench.run_cycles(phase);
    assert_eq!(master.bench.get("second_miso_oe"), 0);
    master.set("second_cs_n_i", 0);
    let mut came = vec![0; count.div_ceil(8)];
    for bit in 0..count {
        master.bench.run_cycles(half);
        assert_eq!(master.bench.get("second_miso_oe"), 1);
        came[bit / 8] |= (master.bench.get("second_miso_o") as u8) << (7 - bit % 8);
        master.set("second_sck_i", 1);
        if noise > 0 && master.rng.in_range(0, noise) == 0 {
            master.bench.run_cycles(half / 2);
            master.set("second_sck_i", 0);
            master.bench.run_cycles(1);
            master.set("second_sck_i", 1);
        }
        master.bench.run_cycles(half);
        master.set("second_sck_i", 0);
    }
    master.bench.run_cycles(half);
    master.set("second_cs_n_i", 1);
    master.bench.run_cycles(2 * HALF);
    came
}

/// A whole answer.
fn answer(master: &mut Master) -> Vec<u8> {
    bits(master, 32 * WORDS, HALF, 0)
}

fn words(answer: &[u8]) -> Vec<u32> {
    let word = |b: &[u8]| u32::from_be_bytes(b.try_into().unwrap());
    answer.chunks(4).map(word).collect()
}

/// Whether the check sum of a channel is right; that of the first one covers the head, too.
fn is_right(answer: &[u8], channel: usize) -> bool {
    let first = 4 * (2 + 9 * channel);
    let begin = if channel == 0 { 0 } else { first };
    crc16(&answer[begin..first + 36]) == 0
}

/// What the first controller reads of a channel, without the age.
fn told(master: &mut Master, channel: usize, has_infos: bool) -> Vec<u32> {
    let count = if has_infos { 8 } else { 6 };
    let first = at(&RESULT, "status", channel);
    let mut all: Vec<u32> = (0..count).map(|w| master.read(first + w)).collect();
    all.resize(8, 0);
    all[5] &= !0xffff;
    all
}

/// The same in an answer.
fn second_told(answer: &[u8], channel: usize) -> Vec<u32> {
    let mut all = words(answer)[2 + 9 * channel..][..8].to_vec();
    all[5] &= !0xffff;
    all
}

/// Catches a word in another's place, additional data of another frame, a count that stays, a check sum over something else.
fn both_controllers_read_the_same_over(cases: &[(HostBus, bool)]) {
    for &(bus, has_infos) in cases {
        let mut master = card(bus, if has_infos { WITH_INFOS } else { SECOND });
        let hash = master.read(at(&CARD, "configuration_hash", 0));
        let mut came = [false; 2];
        let first = words(&answer(&mut master))[0];
        assert_eq!(first >> 16, 0x5E02, "{bus:?}");
        for round in 1..=8 {
            frame(&mut master);
            let bytes = answer(&mut master);
            let head = words(&bytes)[0];
            assert_eq!(head, first + round, "{bus:?}");
            assert_eq!(words(&bytes)[1], hash);
            for channel in 0..2 {
                assert!(is_right(&bytes, channel), "{bus:?} {round} {channel}");
                assert_eq!(bytes[4 * (10 + 9 * channel)], channel as u8);
                let own = told(&mut master, channel, has_infos);
                assert_eq!(second_told(&bytes, channel), own, "{bus:?} {round}");
                assert_ne!(own[1], 0);
            }
            for (n, came) in came.iter_mut().enumerate() {
                let info = second_told(&bytes, 0)[6 + n];
                *came |= info >> 24 & 3 == 3;
                // The CRC came with these bits.
                let crc = (0..24).rev().fold(0x1F, |crc: u32, bit| {
                    let feed = ((crc >> 4) ^ (info >> bit)) & 1;
                    ((crc << 1) ^ (feed * 0x0B)) & 0x1F
                });
                assert!(info == 0 || crc ^ 0x1F == info >> 26, "{info:08x}");
            }
        }
        assert_eq!(came, [has_infos; 2]);
    }
}

#[test]
fn both_controllers_read_the_same() {
    both_controllers_read_the_same_over(&[(HostBus::Apb, false), (HostBus::Wishbone, true)]);
}

#[test]
#[ignore = "slow: the second interface with each bus, with and without additional data"]
fn both_controllers_read_the_same_over_each_bus() {
    let cases = WORD_BUSES.map(|bus| [(bus, false), (bus, true)]).concat();
    both_controllers_read_the_same_over(&cases);
}

/// Catches words of two frames in one answer.
#[test]
fn an_answer_is_of_one_moment() {
    let mut master = card(HostBus::Wishbone, WITH_INFOS);
    frame(&mut master);
    for round in 0..6 {
        let before = [0, 1].map(|channel| told(&mut master, channel, true));
        master.write(at(&CARD, "trigger_now", 0), 1);
        // The result comes while the answer goes out; each time elsewhere.
        master.bench.run_cycles(10 + 200 * round);
        let bytes = answer(&mut master);
        for (channel, before) in before.iter().enumerate() {
            assert!(is_right(&bytes, channel));
            let mut seen = second_told(&bytes, channel);
            // It says that a trigger has come since.
            assert_eq!(seen[5] >> 30 & 1, 1);
            seen[5] &= !(1 << 30);
            assert_eq!(seen, *before, "{round}");
        }
        master.bench.run_cycles(60_000);
        let bytes = answer(&mut master);
        let sequence = |words: &[u32]| words[0] as u16;
        assert_eq!(
            sequence(&second_told(&bytes, 0)),
            sequence(&before[0]).wrapping_add(1)
        );
    }
}

/// Catches a fault of one controller that reaches the other, and an answer that goes on where the one before was cut.
#[test]
fn what_the_second_controller_does_the_first_does_not_see() {
    let run = |noise: bool| {
        let mut master = card(HostBus::Apb, SECOND);
        let mut rng = Rng::new(4);
        let mut seen = vec![];
        for round in 0..6 {
            master.write(at(&CARD, "trigger_now", 0), 1);
            for _ in 0..6_000 {
                if noise {
                    master.set("second_sck_i", rng.in_range(0, 1) as u32);
                    master.set("second_cs_n_i", u32::from(rng.in_range(0, 99) < round));
                }
                master.bench.run_cycles(10);
            }
            seen.push([0, 1].map(|channel| told(&mut master, channel, false)));
        }
        master.set("second_sck_i", 0);
        master.set("second_cs_n_i", 1);
        master.bench.run_cycles(20);
        let bytes = answer(&mut master);
        assert!(is_right(&bytes, 0) && is_right(&bytes, 1), "after all that");
        (seen, second_told(&bytes, 1))
    };
    assert_eq!(run(false), run(true));
}

/// Catches a clock edge that counts twice without being told.
#[test]
fn an_answer_that_is_cut_or_disturbed_is_found_out() {
    let mut master = card(HostBus::AxiLite, SECOND);
    frame(&mut master);
    for cut in [0, 1, 31, 32, 100, 352, 353] {
        let before = answer(&mut master);
        bits(&mut master, cut, HALF, 0);
        let after = answer(&mut master);
        assert!(is_right(&after, 0) && is_right(&after, 1), "{cut}");
        assert_eq!(words(&after)[0], words(&before)[0] + 2);
        assert_eq!(second_told(&after, 0), second_told(&before, 0));
    }
    // Beyond the last channel nothing is left, however long one reads.
    let long = bits(&mut master, 32 * (WORDS + 40), HALF, 0);
    assert!(long[4 * WORDS..].iter().all(|byte| *byte == 0));
    let good = answer(&mut master);
    let mut wrong = 0;
    for _ in 0..20 {
        let bytes = bits(&mut master, 32 * WORDS, 2 * HALF, 300);
        let is_whole = is_right(&bytes, 0) && is_right(&bytes, 1);
        wrong += u32::from(!is_whole);
        assert!(!is_whole || second_told(&bytes, 1) == second_told(&good, 1));
    }
    assert!(wrong > 5, "{wrong}");
}

/// The page's C: for each answer on its input whether the head is right, and each channel's position, or `-`.
struct Example(std::path::PathBuf);

impl Example {
    fn new(name: &str) -> Self {
        let page = include_str!("../../docs/safety.md");
        let example = page.split_once("```c\n").unwrap().1;
        let example = example.split_once("```").unwrap().0;
        let main = include_str!("second_main.c").replace("BYTES", &(4 * WORDS).to_string());
        let folder = tools::folder(name);
        std::fs::write(folder.join("example.c"), format!("{example}\n{main}")).unwrap();
        let flags = [
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-pedantic",
            "-Werror",
            "-o",
            "example",
            "example.c",
        ];
        let (is_good, said) = tools::run("gcc", &folder, &flags);
        assert!(is_good, "{said}");
        Self(folder)
    }

    /// What it says of answers that should have this count; with `steps` each the next one, and the sequences go on.
    fn says(
        &self,
        answers: &[Vec<u8>],
        hash: u32,
        count: u32,
        steps: bool,
    ) -> Vec<(bool, [Option<u64>; 2])> {
        std::fs::write(self.0.join("answers"), answers.concat()).unwrap();
        let command = format!("./example {hash:#x} {count} {} < answers", u32::from(steps));
        let (is_good, said) = tools::run("sh", &self.0, &["-c", &command]);
        assert!(is_good, "{said}");
        let line = |line: &str| {
            let words: Vec<&str> = line.split(' ').collect();
            (words[0] == "1", [1, 2].map(|n| words[n].parse().ok()))
        };
        said.lines().map(line).collect()
    }
}

fn position(answer: &[u8], channel: usize) -> u64 {
    let all = second_told(answer, channel);
    u64::from(all[2] & 0xffff) << 32 | u64::from(all[1])
}

/// Catches a program that takes an answer with one wrong bit anywhere, one that is old, or one that is repeated.
#[test]
fn the_example_of_the_page_takes_nothing_but_what_is_right() {
    if !require("gcc", "example of the second interface") {
        return;
    }
    let example = Example::new("second-example");
    let mut master = card(HostBus::Wishbone, WITH_INFOS);
    frame(&mut master);
    let hash = master.read(at(&CARD, "configuration_hash", 0));
    let good = answer(&mut master);
    let count = words(&good)[0] & 0xffff;
    let spoilt = (0..8 * good.len()).map(|bit| {
        let mut spoilt = good.clone();
        spoilt[bit / 8] ^= 0x80 >> (bit % 8);
        spoilt
    });
    let all: Vec<_> = [good.clone()].into_iter().chain(spoilt).collect();
    let told = example.says(&all, hash, count, false);
    let both = [0, 1].map(|channel| Some(position(&good, channel)));
    assert_eq!(told[0], (true, both));
    for (bit, (head, positions)) in told[1..].iter().enumerate() {
        // The check sum of the first channel covers the head.
        let in_first = bit < 32 * 11;
        assert_eq!(*head, !in_first, "{bit}");
        assert_eq!(positions[0].is_some(), !in_first, "{bit}");
        assert_eq!(positions[1].is_some(), in_first, "{bit}");
    }
    let other = example.says(&all[..1], hash, count + 1, false);
    assert!(!other[0].0, "not the count that is expected");
    let other = example.says(&all[..1], hash ^ 1, count, false);
    assert!(!other[0].0, "another card");
}

/// Catches a program that takes a position that is held, of an encoder with an alarm, or of a trigger that comes no more.
#[test]
fn the_example_of_the_page_takes_no_position_that_is_not_of_the_last_trigger() {
    if !require("gcc", "example of the second interface") {
        return;
    }
    let example = Example::new("second-faults");
    let defects = [
        Defect::ErrorBits { f1: true, f2: true },
        Defect::ErrorBits {
            f1: false,
            f2: false,
        },
        Defect::CrcXor(1),
        Defect::NoStartBit,
    ];
    for defect in defects {
        let project = parse("card.toml", &text(HostBus::Apb, SECOND)).unwrap();
        let broken = sound(0, 29).defect(3, defect.clone());
        let mut master = Master::with_encoders(&project, vec![(0, broken), (1, sound(1, 25))]);
        master.set("second_cs_n_i", 1);
        master.bench.run_cycles(20);
        let hash = master.read(at(&CARD, "configuration_hash", 0));
        let mut all = vec![];
        for _ in 0..3 {
            frame(&mut master);
            all.push(answer(&mut master));
        }
        // Nobody triggers; then a trigger whose result is still to come.
        all.push(answer(&mut master));
        master.write(at(&CARD, "trigger_now", 0), 1);
        master.bench.run_cycles(200);
        all.push(answer(&mut master));
        let count = words(&all[0])[0] & 0xffff;
        let told = example.says(&all, hash, count, true);
        assert!(told.iter().all(|(head, _)| *head), "{told:?}");
        let taken = told.iter().map(|(_, p)| p.map(|p| p.is_some()));
        let expected = [[true; 2], [true; 2], [false, true], [false; 2], [false; 2]];
        assert_eq!(taken.collect::<Vec<_>>(), expected, "{defect:?}");
    }
}

#[test]
fn defects_of_an_encoder_reach_both_controllers() {
    let project = parse("card.toml", &text(HostBus::Apb, SECOND)).unwrap();
    let broken = sound(0, 29).defect(2, Defect::ErrorBits { f1: true, f2: true });
    let mut master = Master::with_encoders(&project, vec![(0, broken), (1, sound(1, 25))]);
    master.set("second_cs_n_i", 1);
    for round in 0..4 {
        frame(&mut master);
        let bytes = answer(&mut master);
        for channel in 0..2 {
            let seen = second_told(&bytes, channel);
            assert_eq!(seen, told(&mut master, channel, false));
            let is_fresh = seen[0] >> 23 & 1 == 1;
            assert_eq!(is_fresh, (round, channel) != (1, 0), "{round} {channel}");
        }
    }
}

/// In so many cycles of the interface, and so many of the record.
fn the_blocks_agree([interface, record]: [usize; 2]) {
    let mut block = SecondInterface::new(2, 0x1234_5678);
    block.connect_all();
    let design = elaborate(&block, "second_interface").unwrap();
    let mut kernel = kernel_engine!(block; clock;
        in reset, sck, cs_n, word;
        out miso, miso_enable, take, channel, word_at);
    let mut rng = Rng::new(5);
    let mut row = vec![0u128; 4];
    let mut rows = vec![];
    for cycle in 0..interface {
        // The reset ends an answer.
        row[0] = u128::from(cycle < 2 || cycle == interface * 9 / 20);
        if rng.in_range(0, 3) == 0 {
            row[1] ^= 1;
        }
        let selected = cycle % 5_000 < 4_800;
        row[2] = u128::from(!selected);
        if rng.in_range(0, 60) == 0 {
            row[3] = u128::from(rng.next_u64() as u32);
        }
        rows.push(row.clone());
    }
    let stimulus = Stimulus {
        inputs: ["reset", "sck", "cs_n", "word"].map(str::to_owned).to_vec(),
        cycles: rows,
        middle: vec![],
    };
    let seen = three_way(
        &format!("second_interface_{interface}"),
        &mut kernel,
        &design,
        &stimulus,
    )
    .unwrap();
    assert!(seen.output("channel").contains(&2), "it comes to its end");

    let mut block = SecondRecord::new(3);
    block.connect_all();
    let design = elaborate(&block, "second_record").unwrap();
    let kernel = kernel_engine!(block; clock; in reset, take, channel, word_at, word_in; out word);
    let mut kernel = kernel
        .input("live_0", |b: &mut SecondRecord| &mut b.live[0])
        .input("live_1", |b| &mut b.live[1])
        .input("live_2", |b| &mut b.live[2])
        .input("live_3", |b| &mut b.live[3])
        .input("live_4", |b| &mut b.live[4])
        .input("live_5", |b| &mut b.live[5])
        .input("live_6", |b| &mut b.live[6])
        .input("live_7", |b| &mut b.live[7]);
    let lives = (0..8).map(|n| format!("live_{n}"));
    let names = ["reset", "take", "channel", "word_at", "word_in"];
    let row = |cycle: usize| -> Vec<u128> {
        let mut row = vec![
            u128::from(cycle < 2 || cycle == 900),
            (rng.in_range(0, 9) == 0).into(),
            rng.in_range(2, 3).into(),
            rng.in_range(0, 15).into(),
            u128::from(rng.next_u64() as u32) * u128::from(rng.in_range(0, 1)),
        ];
        row.extend((0..8).map(|_| u128::from(rng.next_u64() as u32)));
        row
    };
    let stimulus = Stimulus {
        inputs: names.map(str::to_owned).into_iter().chain(lives).collect(),
        cycles: (0..record).map(row).collect(),
        middle: vec![],
    };
    three_way(
        &format!("second_record_{record}"),
        &mut kernel,
        &design,
        &stimulus,
    )
    .unwrap();
}

#[test]
fn the_blocks_agree_in_three_ways() {
    the_blocks_agree([11_200, 1_000]);
}

#[test]
#[ignore = "slow: kernels, engines and simulators on thousands of cycles of the second interface"]
fn the_blocks_agree_in_three_ways_for_long() {
    the_blocks_agree([20_000, 2_000]);
}
