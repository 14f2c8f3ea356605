//! Cards with SSI channels, over their registers and as a host has them.

use crate::bus::Master;
use crate::program::{bad, good};
use endat_config::{parse, Project};
use endat_hdl::protocols::ssi::cause;
use endat_hdl::regs::{Block, Protocol, Protocols, CARD, CHANNEL_CONFIG, RESULT};
use endat_sim::bench::PinNames;
use endat_sim::ssi::{Defect, EncoderConfig, SsiLink};
use endat_sim::{Time, NS, US};
use std::sync::Arc;

const ENDAT: &str = "[[channel]]\nposition_bits = 29\ncommand = \"111000\"\n";
const SSI: &str =
    "[[channel]]\nprotocol = \"ssi\"\nposition_bits = 25\nclock_hz = 500_000\ncode = \"gray\"\ntwice = true\n";

fn project(channels: &[&str]) -> Project {
    let text = format!(
        "name = \"mixed\"\n[clock]\nsystem_hz = 50_000_000\n[endat]\nclock_hz = 2_500_000\n{}\
         [trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n[host]\nbus = \"apb\"\n",
        channels.concat()
    );
    parse("mixed.toml", &text).unwrap()
}

/// A position that nobody can guess.
fn shaft(time: Time) -> u64 {
    (time / 1_000).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 8
}

fn at(block: &Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// Cause, freshness, position and time stamp of a channel.
fn result(master: &mut Master, channel: usize) -> (u64, bool, u64, u32) {
    let first = at(&RESULT, "status", channel);
    let words = [0, 1, 2, 3].map(|n| master.read(first + n));
    (
        u64::from(words[0] >> 16 & 31),
        words[0] >> 23 & 1 == 1,
        u64::from(words[1]) | u64::from(words[2] & 0xFFFF) << 32,
        words[3],
    )
}

/// One trigger for EnDat and SSI: both positions are of the same moment, neighbours notice nothing of a fault, and settings are the host's.
#[test]
fn a_card_reads_endat_and_ssi_together() {
    for ssi in [0, 1] {
        let mut channels = [ENDAT; 2];
        channels[ssi] = SSI;
        let project = project(&channels);
        assert_eq!(
            project.card.protocols(),
            Protocols::ENDAT.with(ssi, Protocol::Ssi)
        );
        let mut master = Master::at_channels(&project, &[(1 - ssi, 29)]);
        let config = EncoderConfig {
            gray: true,
            ..EncoderConfig::default()
        };
        let mut link = SsiLink::new(config, 200 * NS);
        link.set_motion(Arc::new(shaft));
        master.bench.add_other(&PinNames::card(ssi), Box::new(link));
        // After power-up the encoder may be in the middle of a frame.
        master.bench.run_for(60 * US);
        assert_eq!(master.read(at(&CARD, "protocols", 0)) >> 24, 1 << ssi);
        let mut seen = vec![];
        for round in 0..6 {
            let defect = if round == 4 {
                Defect::Silent
            } else {
                Defect::None
            };
            let link = master.bench.others_as_mut::<SsiLink>().next().unwrap();
            link.encoder_mut().config.defect = defect;
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_for(400 * US);
            let link = master.bench.others_as_mut::<SsiLink>().next().unwrap();
            let is = link.encoder().config.position;
            let (cause, fresh, position, stamp) = result(&mut master, ssi);
            let other = result(&mut master, 1 - ssi);
            if round == 4 {
                assert_eq!((cause, fresh), (cause::DATA_NOT_LOW_AFTER, false));
                assert_eq!(position, *seen.last().unwrap(), "the last good one");
            } else {
                assert_eq!((cause, fresh, position), (cause::NONE, true, is));
                seen.push(position);
            }
            // The first EnDat frame measures the delay.
            if round > 0 {
                assert_eq!((other.0, other.1), (0, true));
                assert!(round == 4 || other.3 == stamp, "time stamps of one trigger");
            }
        }
        seen.dedup();
        assert_eq!(seen.len(), 5);
        // A host asks for single positions, then spoils the kind of frame.
        let frame = at(&CHANNEL_CONFIG, "frame", ssi);
        let was = master.read(frame);
        assert_eq!(was >> 24 & 63, 7, "Gray code, twice");
        for (command, expected) in [
            (5, cause::NONE),
            (2, cause::UNKNOWN_FRAME),
            (7, cause::NONE),
        ] {
            master.write(frame, was & !(63 << 24) | command << 24);
            master.bench.run_for(20 * US);
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_for(400 * US);
            assert_eq!(result(&mut master, ssi).0, expected, "{command}");
        }
        assert_eq!(master.bench.others().next().unwrap().complaints(), [""; 0]);
    }
}

/// Catches an encoder that answers sooner than its channel allows it, and a card that does not wait for it.
#[test]
fn card_reads_encoders_that_answer_as_late_as_configured() {
    for (bits, hz, cable_m, delay_ns) in [
        (19, 2_500_000, 2, 320),
        (12, 4_000_000, 0, 190),
        (12, 80_000, 100, 10_000),
    ] {
        let text = format!(
            "name = \"late\"\n[clock]\nsystem_hz = 100_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = {bits}\n\
             clock_hz = {hz}\ncable_m = {cable_m}\nbit_delay_ns = {delay_ns}\nrecovery_min_ns = 19_000\n\
             [trigger]\nsample_hz = 500\nsources = [\"register\"]\n[host]\nbus = \"apb\"\n"
        );
        let project = parse("late.toml", &text).unwrap();
        let mut master = Master::at_channels(&project, &[]);
        let config = EncoderConfig {
            position_bits: bits,
            repeats: false,
            bit_delay: delay_ns * NS,
            pulse_min: 100 * NS,
            ..EncoderConfig::default()
        };
        let mut link = SsiLink::new(config, cable_m * 5 * NS);
        link.set_motion(Arc::new(shaft));
        master.bench.add_other(&PinNames::card(0), Box::new(link));
        master.bench.run_for(60 * US);
        for _ in 0..4 {
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_for(300 * US);
            let link = master.bench.others_as_mut::<SsiLink>().next().unwrap();
            let is = link.encoder().config.position;
            let (cause, fresh, position, _) = result(&mut master, 0);
            assert_eq!((cause, fresh, position), (cause::NONE, true, is), "{hz}");
        }
        assert_eq!(master.bench.others().next().unwrap().complaints(), [""; 0]);
    }
}

/// A reset of the card in the middle of a frame, and a trigger of the host soon after it.
#[test]
fn card_shows_no_wrong_ssi_position_after_a_reset() {
    let single =
        "[[channel]]\nprotocol = \"ssi\"\nposition_bits = 25\nclock_hz = 1_000_000\ncable_m = 10\n";
    let text = format!(
        "name = \"single\"\n[clock]\nsystem_hz = 50_000_000\n{single}\
         [trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n[host]\nbus = \"apb\"\n"
    );
    let project = parse("single.toml", &text).unwrap();
    let mut wrong = 0;
    for moment in 0..20 {
        let mut master = Master::at_channels(&project, &[]);
        // It stays LOW after its last bit.
        let config = EncoderConfig {
            repeats: false,
            position: 0x155_32D3,
            tm: 25 * US,
            ..EncoderConfig::default()
        };
        let link = SsiLink::new(config, 50 * NS);
        master.bench.add_other(&PinNames::card(0), Box::new(link));
        master.bench.run_for(60 * US);
        master.write(at(&CARD, "trigger_now", 0), 1);
        master.bench.run_for((2 + moment) * US);
        master.bench.reset();
        for _ in 0..4 {
            master.bench.run_for(moment % 3 * US);
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_for(32 * US);
            let (_, fresh, position, _) = result(&mut master, 0);
            wrong += u32::from(fresh && position != 0x155_32D3);
        }
        master.bench.run_for(100 * US);
        master.write(at(&CARD, "trigger_now", 0), 1);
        master.bench.run_for(100 * US);
        let (_, fresh, position, _) = result(&mut master, 0);
        assert!(fresh && position == 0x155_32D3, "{moment}");
    }
    assert_eq!(wrong, 0);
}

const PORT: [&str; 2] = ["--port", "virtual:ssi_two_channel"];

/// The program at a card: results by name, faults that are made, what is told of the card.
#[test]
fn the_program_reads_and_explains_it() {
    let text = good(&[&["read"][..], &PORT].concat());
    for part in ["      0  ", " counts ", "good"] {
        assert!(text.contains(part), "{text}");
    }
    assert!(
        !text.contains("multi"),
        "nobody says what a turn is: {text}"
    );
    let text = bad(&[&["param", "read", "0xB9", "0"][..], &PORT].concat(), 2);
    assert!(
        text.contains("its encoders have nothing but positions"),
        "{text}"
    );
}
