//! A card with an SSI channel as its host has it: faults that are injected, words of a result, settings, and outputs beside the registers.

use crate::desk::Desk;
use endat_card::VirtualConfig;
use endat_config::parse;
use endat_driver::Reading;

/// A tenth of a turn of 12 bits, where the encoder stands.
const PLACE: u64 = 409;

const US_CYCLES: u64 = 20;

/// A card with a channel of 12 bits at 1 MHz, and its host.
fn desk(keys: &str, tables: &str) -> Desk {
    let text = format!(
        "name = \"one\"\n[clock]\nsystem_hz = 20_000_000\n[[channel]]\nprotocol = \"ssi\"\nposition_bits = 12\nclock_hz = 1_000_000\n\
         cable_m = 10\nsingle_turn_bits = 12\n{keys}[trigger]\nsample_hz = 1_000\nsources = [\"register\"]\n[host]\nbus = \"apb\"\n{tables}"
    );
    let still = VirtualConfig {
        speed: 0.0,
        ..VirtualConfig::default()
    };
    let mut desk = Desk::new(&parse("one.toml", &text).unwrap(), &still);
    desk.run_ms(1);
    desk
}

fn measure(desk: &mut Desk) -> Reading {
    desk.set("card.trigger_now", 1);
    desk.run_ms(1);
    desk.card.results().unwrap().channels[0]
}

fn inject(desk: &mut Desk, fault: &str) {
    desk.card.bridge().transport().inject(fault).unwrap();
}

/// Catches an encoder of another width, code or frame than its channel, and a fault that the page names and the card does not make.
#[test]
fn each_fault_of_a_virtual_ssi_encoder_has_its_cause_and_goes() {
    let all = "bits_before = [\"alarm\"]\nbits_after = [\"power_fail\", \"valid\"]\n";
    for (keys, faults) in [
        (
            "",
            &[
                ("unplug 0", "data_not_low_after"),
                ("silent 0", "data_not_low_after"),
                ("line 0 open", "data_not_low_after"),
                ("line 0 stuck_low", "data_not_high"),
                ("slow 0 30us", "recovery_too_long"),
            ][..],
        ),
        (
            "code = \"gray\"\nparity = \"odd\"\nbit_delay_ns = 300\n",
            &[("crc 0", "position_parity")],
        ),
        ("parity = \"even\"\n", &[("crc 0", "position_parity")]),
        (
            "code = \"gray\"\ntwice = true\n",
            &[("crc 0", "copies_differ")],
        ),
        ("bits_after = [\"crc6\"]\n", &[("crc 0", "position_crc")]),
        (
            all,
            &[
                ("alarm 0 1", "encoder_alarm"),
                ("alarm 0 2", "power_fail"),
                ("alarm 0 4", "position_not_valid"),
                ("alarm 0 6", "power_fail"),
                ("alarm 0 7", "encoder_alarm"),
            ],
        ),
    ] {
        let mut desk = desk(keys, "");
        let position = |reading: &Reading| reading.fresh.then_some(reading.position);
        assert_eq!(position(&measure(&mut desk)), Some(PLACE), "{keys}");
        for (fault, cause) in faults {
            inject(&mut desk, fault);
            let reading = measure(&mut desk);
            assert_eq!(reading.cause_name(), *cause, "{keys}{fault}");
            assert!(!reading.fresh, "{keys}{fault}");
            // A position that was published is withdrawn.
            assert_eq!(reading.valid, !fault.starts_with("slow"), "{fault}");
            let sum = fault.split(' ').nth(2).and_then(|n| n.parse::<u32>().ok());
            if let Some(sum) = sum.filter(|_| fault.starts_with("alarm")) {
                assert_eq!(reading.flags >> 8, sum, "{fault}");
            }
            inject(&mut desk, "heal 0");
            measure(&mut desk);
            let healed = measure(&mut desk);
            assert_eq!(
                (position(&healed), healed.cause),
                (Some(PLACE), 0),
                "{fault}"
            );
        }
    }
    let mut desk = desk("", "");
    // The first bit of the only copy, which nothing checks.
    inject(&mut desk, "crc 0");
    let reading = measure(&mut desk);
    assert_eq!((reading.cause, reading.fresh), (0, true));
    assert_eq!(reading.position, PLACE ^ 1 << 11);
    inject(&mut desk, "unplug 0");
    assert!(!measure(&mut desk).fresh);
    inject(&mut desk, "plug 0");
    assert!(measure(&mut desk).fresh);
    // Within what is left of a period.
    inject(&mut desk, "jitter 0 50ns");
    assert!((0..4).all(|_| measure(&mut desk).fresh));
    for fault in ["noise 0 1e-3", "line 0 swapped", "f1 0", "warning 0"] {
        let why = desk.card.bridge().transport().inject(fault).unwrap_err();
        assert!(
            why.contains("speaks SSI, which knows unplug, plug"),
            "{why}"
        );
    }
}

#[test]
fn ssi_results_have_no_width_delay_recovery_time_or_crc() {
    let mut desk = desk("bits_after = [\"shown\", \"crc6\"]\n", "");
    assert_eq!(desk.reg("card.protocols"), 1 << 24);
    for _ in 0..3 {
        let reading = measure(&mut desk);
        assert_eq!((reading.fresh, reading.position), (true, PLACE));
        assert_eq!(reading.special_bits, Some(1));
        let times = [reading.delay_cycles, reading.recovery_cycles];
        assert_eq!((reading.width_bits, times), (0, [0; 2]));
        assert_eq!((reading.crc, reading.fits), ([0; 2], true));
    }
    // One copy that nothing checks would be wrong, and the host could not see it.
    inject(&mut desk, "crc 0");
    let reading = measure(&mut desk);
    assert_eq!((reading.fresh, reading.crc), (false, [0; 2]));
    // Cause 12 has a number that no cause of EnDat has.
    assert_eq!((reading.cause, reading.flags), (64 + 12, 1 << 11));
}

/// A word that a host writes while a frame is under way is for the next one.
#[test]
fn ssi_settings_are_taken_over_between_two_frames() {
    let mut desk = desk("", "");
    let command = desk.reg("config0.frame.command");
    assert_eq!(command, 4);
    for (field, value) in [
        ("config0.frame.position_bits", 11),
        ("config0.frame.command", command | 1),
    ] {
        let before = desk.reg(field);
        desk.set("card.trigger_now", 1);
        desk.card.bridge().transport().run(4 * US_CYCLES);
        desk.set(field, value);
        desk.run_ms(1);
        let reading = desk.card.results().unwrap().channels[0];
        assert_eq!((reading.fresh, reading.position), (true, PLACE), "{field}");
        let reading = measure(&mut desk);
        assert_ne!((reading.fresh, reading.position), (true, PLACE), "{field}");
        desk.set(field, before);
        desk.run_ms(1);
        measure(&mut desk);
        assert_eq!(measure(&mut desk).position, PLACE);
    }
}

/// Direct outputs and interrupt of the channel, with special bits on both sides of the position.
#[test]
fn direct_outputs_and_interrupt_have_the_ssi_position_alone() {
    let keys = "bits_before = [\"shown\", \"alarm\"]\nbits_after = [\"shown\", \"power_fail\"]\n";
    let tables = "[outputs]\nparts = [\"position\", \"interrupt\"]\n";
    let mut desk = desk(keys, tables);
    desk.set("interrupt.clear", 0xFF);
    assert!(measure(&mut desk).fresh);
    let direct = |desk: &mut Desk| {
        let bench = desk.card.bridge().transport().bench();
        ["position", "valid", "error"].map(|name| bench.get(&format!("direct_{name}0_o")))
    };
    assert_eq!(direct(&mut desk), [PLACE.into(), 1, 0]);
    assert_eq!(desk.reg("interrupt.status"), 0b01, "a result");
    inject(&mut desk, "alarm 0 2");
    assert!(!measure(&mut desk).fresh);
    assert_eq!(direct(&mut desk), [PLACE.into(), 0, 1]);
    assert_eq!(desk.reg("interrupt.status"), 0b11, "and an error");
}
