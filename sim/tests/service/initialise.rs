//! Initialisation: every device from power-up, failures, and a plug.

use super::rig::{hasty, quick, Make, Rig, ENDAT_HZ, SYSTEM_HZ};
use endat_hdl::endat::service::{
    map::{plate, state, word, NAME_PLATE, PLATE_DELAY},
    program::{step_name, steps},
};
use endat_hdl::protocol::ModeCommand::SendPositionAddInfo;
use endat_sim::{
    encoder::{
        area, Defect, Device, EncoderConfig, Violation, DEVICES, LONG_RECOVERY, SHORT_RECOVERY,
    },
    MS,
};

/// Description of the step with this number.
fn step(number: u32) -> String {
    match number {
        0 => "none".into(),
        n => step_name(steps()[n as usize - 1]),
    }
}

/// For an encoder that is already connected, the pulse of the power-up sequence looks like the start of a frame.
fn assert_only_the_pulse(rig: &Rig) {
    let other = |v: &&(u64, Violation)| !matches!(v.1, Violation::StoppedBeforeAnswer { seen: 1 });
    let others: Vec<_> = rig.bench.violations(0).iter().filter(other).collect();
    assert!(others.is_empty(), "{others:?}");
    assert_eq!(rig.bench.conflicts(0), []);
}

/// A port that initialises an encoder of 25 bits quickly.
fn hasty_rig(encoder: EncoderConfig) -> Rig {
    Rig::with(Make::hasty(), ENDAT_HZ, hasty(encoder), 25)
}

fn are_found<'a>(devices: impl Iterator<Item = &'a Device>) {
    for device in devices {
        let encoder = quick(device.encoder());
        let width = encoder.position_bits;
        let mut rig = Rig::new(true, encoder, 13);
        let failed = rig.initialised();
        assert_eq!(step(failed), "none", "{}", device.name);
        let endat22 = rig.state() & state::ENDAT22 != 0;
        assert_eq!(endat22, device.endat22, "{}", device.name);
        let name_plate = |rig: &mut Rig, name| rig.read(plate(name));
        assert_eq!(name_plate(&mut rig, "position_bits") & 63, width);
        let other = rig.state() & state::OTHER_WIDTH != 0;
        assert_eq!(other, width != 13);
        for entry in NAME_PLATE {
            let value = rig.read(plate(entry.name));
            let is_read = entry.mrs != area::MANUFACTURER_22 && entry.name != "recovery";
            assert_eq!(value >> 16, u32::from(is_read || endat22), "{}", entry.name);
            if value >> 16 == 1 && entry.mrs != area::OPERATING_STATUS {
                let word = rig.bench.link(0).encoder().word(entry.mrs, entry.address);
                assert_eq!(Some(value as u16), word, "{} {}", device.name, entry.name);
            }
        }
        assert!(rig.read(PLATE_DELAY) & 0xFFFF > 5);
        for _ in 0..3 {
            rig.good_position();
        }
        let code = if endat22 { 0b111_000 } else { 0b000_111 };
        assert_eq!(rig.bench.frames(0).last().unwrap().command, Some(code));
        assert_only_the_pulse(&rig);
    }
}

#[test]
fn a_device_of_either_version_is_found_from_nothing() {
    let first = |endat22| DEVICES.iter().find(move |d| d.endat22 == endat22);
    are_found([false, true].into_iter().filter_map(first));
}

#[test]
#[ignore = "slow: every device"]
fn every_device_is_found_from_nothing() {
    are_found(DEVICES.iter());
}

/// Catches triggers that are accepted before the last step, for example after the wait for a reset.
#[test]
fn no_trigger_disturbs_it() {
    let mut rig = Rig::new(true, quick(EncoderConfig::endat22(25)), 25);
    let under_way = u32::from(state::INITIALISING);
    rig.wait_for(word::STATE, |s| s & under_way != 0);
    while rig.read(word::STATE) & under_way != 0 {
        rig.frames(1);
    }
    assert!(rig.is_initialised());
    assert_only_the_pulse(&rig);
    let position = Some(SendPositionAddInfo.code());
    let frames = rig.bench.frames(0);
    assert!(frames.iter().all(|f| f.command != position), "{frames:?}");
    rig.frames(2);
    rig.good_position();
}

#[test]
fn a_failed_step_is_told_and_positions_go_on_as_configured() {
    // Frame 0 is the pulse; three tries of step 3, whose frames come after reset and selection, in both rounds.
    let silent = EncoderConfig::endat22(25).defects(3..=5, Defect::NoStartBit);
    let silent = silent.defects(8..=10, Defect::NoStartBit);
    let mut rig = hasty_rig(silent);
    let failed = rig.initialised();
    assert_eq!(step(failed), "read alarms");
    assert!(!rig.is_initialised());
    rig.good_position();

    // Two failures of each step are tolerated, and one failed round of all steps.
    for defects in [3..=4, 3..=5, 13..=15] {
        let shaky = EncoderConfig::endat22(25).defects(defects, Defect::CrcXor(1));
        let mut rig = hasty_rig(shaky);
        assert_eq!(rig.initialised(), 0);
        assert!(rig.is_initialised());
    }
}

#[test]
fn the_slower_of_both_clocks_is_chosen() {
    let mut encoder = EncoderConfig::endat22(25);
    encoder.max_clock_hz = 1_000_000;
    let mut rig = hasty_rig(encoder);
    assert_eq!(rig.initialised(), 0);
    assert!(rig.state() & state::SLOWER != 0);
    rig.good_position();
    rig.good_position();
    let period = rig.bench.frames(0).last().unwrap().period;
    assert_eq!(period, 1_000_000);
    assert_only_the_pulse(&rig);
}

#[test]
fn recovery_is_set_as_wanted() {
    for (short, want) in [(true, SHORT_RECOVERY), (false, LONG_RECOVERY)] {
        let encoder = hasty(EncoderConfig::endat22(25));
        let make = Make {
            wants_short: short,
            ..Make::hasty()
        };
        let mut rig = Rig::with(make, ENDAT_HZ, encoder, 25);
        assert_eq!(rig.initialised(), 0);
        rig.good_position();
        rig.good_position();
        let word = rig.bench.link(0).encoder().word(area::OPERATING_STATUS, 3);
        assert_eq!(word, Some(want));
        let us = rig.bench.get("recovery_cycles") as u64 * 1_000_000 / SYSTEM_HZ;
        assert_eq!(us < 5, short, "{us} us");
    }
}

/// Word 3 of the operating status has other functions in addition to the recovery time: they are kept, and the name plate has the updated word.
fn other_functions_are_kept(all_found: &[u16]) {
    for (short, set) in [(true, SHORT_RECOVERY), (false, LONG_RECOVERY)] {
        for &found in all_found {
            let others = 0xA554;
            let mut encoder = hasty(EncoderConfig::endat22(25));
            encoder.function = others | found;
            let make = Make {
                wants_short: short,
                ..Make::hasty()
            };
            let mut rig = Rig::with(make, ENDAT_HZ, encoder, 25);
            assert_eq!(rig.initialised(), 0);
            let told = rig.read(plate("recovery"));
            assert_eq!(told, 1 << 16 | u32::from(others | set), "found {found:02b}");
            (0..2).for_each(|_| rig.good_position());
            let word = rig.bench.link(0).encoder().word(area::OPERATING_STATUS, 3);
            assert_eq!(word, Some(others | set), "found {found:02b}");
        }
    }
}

#[test]
fn setting_the_recovery_time_keeps_the_other_functions() {
    other_functions_are_kept(&[3]);
}

#[test]
#[ignore = "slow: every recovery time that an encoder may come with"]
fn setting_the_recovery_time_keeps_the_other_functions_whatever_it_was() {
    other_functions_are_kept(&[LONG_RECOVERY, SHORT_RECOVERY, 0, 3]);
}

#[test]
fn an_encoder_that_is_plugged_in_later_is_found() {
    let mut encoder = EncoderConfig::endat22(25);
    encoder.unplugged.push(0..90 * MS);
    let mut rig = hasty_rig(encoder);
    let failed = rig.wait_for(word::PROGRESS, |p| p >> 16 != 0) >> 16;
    assert_eq!(step(failed), "reset");
    assert!(rig.state() & state::UNPLUGGED != 0);
    rig.wait_for(word::STATE, |s| s as u16 & state::INITIALISED != 0);
    assert!(rig.state() & state::UNPLUGGED == 0);
    rig.good_position();
}
