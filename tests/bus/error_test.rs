//! Forced errors on the card's own schedule: each is told, positions do not suffer, and a dead error path is found.

use super::{at, frame, sound, text, Master};
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_hdl::endat::service::map::{control, force, state};
use endat_hdl::endat::transaction::cause;
use endat_hdl::regs::{CARD, RESULT, SERVICE};
use endat_sim::encoder::{Defect, EncoderConfig};
use std::collections::BTreeSet;

/// All that the schedule can force, and more than it usually waits.
const PARTS: &str = "[service]\nparts = [\"requests\", \"continuous\"]\n[safety]\n\
     parts = [\"second_receiver\", \"error_test\"]\nerror_test_ms = 12345\n";

/// Cycles of a microsecond: few, because the schedule counts milliseconds.
const US: u64 = 20;

fn card(first: EncoderConfig) -> Master {
    let text = text(HostBus::Wishbone, PARTS)
        .replace("100_000_000", "20_000_000")
        .replace("3_125_000", "2_000_000");
    let project = parse("card.toml", &text).unwrap();
    Master::with_encoders(&project, vec![(0, first), (1, sound(1, 25))])
}

fn word(master: &mut Master, name: &str, channel: usize) -> u32 {
    master.read(at(&SERVICE, name, channel))
}

/// Forced errors that were told, and that were not.
fn state_of(master: &mut Master, channel: usize) -> (u32, u32) {
    let word = word(master, "error_test_state", channel);
    (word & 0xFFFF, word >> 16)
}

fn schedule(master: &mut Master, ms: u32) {
    for channel in 0..2 {
        master.write(at(&SERVICE, "error_test", channel), ms);
    }
}

/// Catches a schedule that spoils or loses positions of triggers, counts its own errors as bad frames, or leaves one of them out.
#[test]
fn each_error_is_forced_in_turn_and_no_trigger_sees_it() {
    let mut master = card(sound(0, 29));
    frame(&mut master);
    for channel in 0..2 {
        assert_eq!(word(&mut master, "error_test", channel), 12_345);
        assert_eq!(state_of(&mut master, channel), (0, 0));
    }
    schedule(&mut master, 1);
    let lost = at(&SERVICE, "lost", 0);
    for round in 0..26 {
        master.write(at(&CARD, "trigger_now", 0), 1);
        master.bench.run_cycles(400 * US);
        for channel in 0..2 {
            let status = master.read(at(&RESULT, "status", channel));
            let of = |name| RESULT.field("status", name).of(status);
            assert_eq!((of("cause"), of("fresh")), (0, 1), "{round} {channel}");
        }
    }
    assert_eq!(master.read(lost) & 0xFFFF, 0);
    for channel in 0..2 {
        let (told, silent) = state_of(&mut master, channel);
        assert!((8..=11).contains(&told) && silent == 0, "{told} {silent}");
        // Frames of triggers only.
        assert_eq!(word(&mut master, "frames_good", channel), 27 + 1);
        for cause in ["frames_crc", "frames_f1", "frames_f2"] {
            assert_eq!(word(&mut master, cause, channel), 0, "{cause}");
        }
        assert_eq!(
            word(&mut master, "state", channel) & u32::from(state::ERROR_TEST),
            0
        );
    }
    // Each with the command of its triggers: only answers to that of EnDat 2.2 have F2.
    let commands = |master: &Master, channel| -> BTreeSet<u8> {
        let frames = master.bench.frames(channel).iter();
        frames.filter_map(|frame| frame.command).collect()
    };
    assert_eq!(commands(&master, 0), BTreeSet::from([0o70]));
    assert_eq!(commands(&master, 1), BTreeSet::from([0o07]));
    for channel in 0..2 {
        assert_eq!(master.bench.violations(channel), []);
        assert_eq!(master.bench.conflicts(channel), []);
    }
}

/// Catches a schedule that waits for a trigger for ever, and one that does not end.
#[test]
fn without_triggers_it_goes_on_and_zero_stops_it() {
    let mut master = card(sound(0, 29));
    frame(&mut master);
    schedule(&mut master, 1);
    master.bench.run_cycles(25_000 * US);
    let (told, silent) = state_of(&mut master, 0);
    assert!((2..=3).contains(&told) && silent == 0, "{told} {silent}");
    schedule(&mut master, 0);
    master.bench.run_cycles(15_000 * US);
    let (after, _) = state_of(&mut master, 0);
    assert!(after <= told + 1);
    let result = master.read(at(&RESULT, "status", 0));
    assert_eq!(
        RESULT.field("status", "sequence").of(result),
        1,
        "no result of its own"
    );
}

/// Catches a test that takes what it has forced for what was told. An alarm of the encoder in the very frame whose F1 is inverted looks like an
/// error path that does not tell.
#[test]
fn an_error_that_is_not_told_raises_the_alarm_until_it_is_cleared() {
    // Frames: the one that measures, the trigger's, then CRC, and F1.
    let alarm = Defect::ErrorBits { f1: true, f2: true };
    let mut master = card(sound(0, 29).defect(3, alarm));
    frame(&mut master);
    schedule(&mut master, 1);
    master.bench.run_cycles(35_000 * US);
    let seen = state_of(&mut master, 0);
    assert!(seen.0 > 0 && seen.1 == 1, "{seen:?}");
    let bits = u32::from(state::ERROR_TEST);
    assert_eq!(word(&mut master, "state", 0) & bits, bits);
    assert_eq!(word(&mut master, "state", 1) & bits, 0);
    assert_eq!(state_of(&mut master, 1).1, 0);
    master.write(at(&SERVICE, "control", 0), control::CLEAR.into());
    master.bench.run_cycles(200 * US);
    assert_eq!(word(&mut master, "state", 0) & bits, 0);
    assert_eq!(state_of(&mut master, 0).1, 0);
}

/// Catches a schedule that takes the host's forced errors away, or a request's frame for its own.
#[test]
fn the_host_keeps_its_requests_and_its_own_forced_errors() {
    let mut master = card(sound(0, 29));
    frame(&mut master);
    schedule(&mut master, 1);
    master.write(at(&SERVICE, "force", 0), force::F1.into());
    for _ in 0..5 {
        frame(&mut master);
        let status = master.read(at(&RESULT, "status", 0));
        assert_eq!(
            u64::from(RESULT.field("status", "cause").of(status)),
            cause::F1
        );
    }
    master.write(at(&SERVICE, "force", 0), 0);
    let request = at(&SERVICE, "request", 0);
    for round in 0..4 {
        // 001110, selection of a memory area.
        let address = 0xA1 + 2 * (round & 1);
        master.write(request, 0x0E << 24 | address << 16);
        let mut finished = 1;
        for _ in 0..100 {
            master.bench.run_cycles(1_000 * US);
            finished = word(&mut master, "request_state", 0);
            if finished & 1 == 0 {
                break;
            }
        }
        assert_eq!(finished & 0xFF, 0, "{finished:#x}");
        assert_eq!(word(&mut master, "answer", 0) >> 16 & 0xFF, address);
    }
    let (told, silent) = state_of(&mut master, 0);
    assert!(told > 5 && silent == 0, "{told} {silent}");
}
