use super::*;
use crate::regs::tests::test_config;
use crate::regs::{CHANNEL_CONFIG, RESULT};
use crate::testing::tick;

fn new() -> ChannelRegisters {
    made(&test_config())
}

fn made(config: &CardConfig) -> ChannelRegisters {
    let mut uut = ChannelRegisters::new(config, 0);
    uut.ring_home.next = true;
    uut.connect_all();
    step(&mut uut);
    uut
}

fn guarded_registers() -> ChannelRegisters {
    let mut config = test_config();
    config.safety.upset_guards = true;
    made(&config)
}

fn step(uut: &mut ChannelRegisters) {
    tick(uut, |u, level| u.clock.next = level.into());
}

/// A word of the held result, read byte by byte as the bank does.
fn read(uut: &mut ChannelRegisters, word: usize) -> u32 {
    let mut bytes = [0; 4];
    for (lane, byte) in bytes.iter_mut().enumerate() {
        uut.word_skip.next = (!(1u64 << word) & 0x3f).into();
        uut.lane.next = (lane as u64).into();
        uut.skip.next = false;
        step(uut);
        step(uut);
        *byte = uut.read_out.val().to_u8();
    }
    u32::from_be_bytes(bytes)
}

/// Sets one of the result inputs.
fn set(uut: &mut ChannelRegisters, register: &str, field: &str, value: u64) {
    match (register, field) {
        ("status", "sequence") => uut.result.sequence.next = value.into(),
        ("status", "cause") => uut.result.cause.next = value.into(),
        ("status", "valid") => uut.result.position_valid.next = value == 1,
        ("status", "fresh") => uut.result.fresh.next = value == 1,
        ("status", "line") => uut.result.flags.next = (value << 12).into(),
        ("position_low", _) => uut.result.position.next = value.into(),
        ("position_high", "crc") => uut.result.position_crc.next = value.into(),
        ("position_high", "f2") => uut.result.position_has_f2.next = value == 1,
        ("position_high", "width") => uut.result.position_width.next = value.into(),
        ("position_high", _) => uut.result.position.next = (value << 32).into(),
        ("timestamp", _) => uut.result.first_fall_timestamp.next = value.into(),
        ("evidence", "crc_received") => uut.result.crc_received.next = value.into(),
        ("evidence", "crc_computed") => uut.result.crc_computed.next = value.into(),
        ("evidence", "delay_cycles") => uut.delay_cycles.next = value.into(),
        ("age_recovery", "delay_high") => uut.delay_cycles.next = (value << 10).into(),
        ("evidence", "flags") => uut.result.flags.next = value.into(),
        ("age_recovery", "age_us") => uut.result.age_us.next = value.into(),
        ("age_recovery", "recovery_cycles") => uut.recovery_cycles.next = value.into(),
        ("age_recovery", "stale") => uut.trigger.next = value == 1,
        other => panic!("field of the table unknown to the test: {other:?}"),
    }
}

#[test]
fn every_result_field_is_where_the_table_says() {
    // Other tests cover the additional data.
    for register in &RESULT.registers[..6] {
        for field in register.fields {
            let mut uut = new();
            uut.load.next = true;
            uut.show.next = true;
            set(
                &mut uut,
                register.name,
                field.name,
                u64::from(field.mask() >> field.lsb),
            );
            step(&mut uut);
            for other in &RESULT.registers[..6] {
                let expected = if other.offset == register.offset {
                    field.mask()
                } else {
                    0
                };
                assert_eq!(
                    read(&mut uut, usize::from(other.offset)),
                    expected,
                    "{} {} in {}",
                    register.name,
                    field.name,
                    other.name
                );
            }
        }
    }
}

#[test]
fn words_stand_still_without_load_and_read_as_zero_when_not_selected() {
    let mut uut = new();
    uut.load.next = true;
    uut.result.sequence.next = 7u64.into();
    step(&mut uut);
    uut.load.next = false;
    uut.result.sequence.next = 8u64.into();
    uut.result.position.next = 0xffff_ffff_ffffu64.into();
    step(&mut uut);
    assert_eq!(
        (read(&mut uut, 0), read(&mut uut, 1), read(&mut uut, 2)),
        (7, 0, 0)
    );
    uut.skip.next = true;
    step(&mut uut);
    assert_eq!(uut.read_out.val().to_u8(), 0);
    uut.read_in.next = 0xa5u64.into();
    step(&mut uut);
    assert_eq!(uut.read_out.val().to_u8(), 0xa5);
}

/// A field of a word that is on the ring.
fn kept(register: &str, field: &str, word: u64) -> u64 {
    CHANNEL_CONFIG.field(register, field).of(word as u32).into()
}

/// One of the configuration outputs.
fn output(uut: &ChannelRegisters, field: &str) -> u64 {
    match field {
        "period_cycles" => uut.settings.period_cycles.val().to_u64(),
        "position_bits" => uut.settings.position_bits.val().to_u64(),
        "command" => uut.settings.command.val().to_u64(),
        "skip" => uut.trigger_skip.val().to_u64(),
        "ignore_pin" => uut.ignored_sources.val().to_u64() & 1,
        "ignore_timer" => uut.ignored_sources.val().to_u64() >> 1 & 1,
        "ignore_register" => uut.ignored_sources.val().to_u64() >> 2,
        "first_low_extra_cycles" => uut.settings.first_low_extra_cycles.val().to_u64(),
        "start_window_cycles" => uut.settings.start_window_cycles.val().to_u64(),
        "filter_cycles" => uut.settings.filter_cycles.val().to_u64(),
        "filter_half" => uut.settings.filter_half.val().into(),
        "request_id" => uut.request_id.val().to_u64(),
        "field_gap_us" => uut.field_gap_us.val().to_u64(),
        "start_timeout_us" => uut.settings.start_timeout_us.val().to_u64(),
        "recovery_limit_cycles" => uut.settings.recovery_limit_cycles.val().to_u64(),
        // Only the host uses them: the ring stores them.
        "multi_turn_bits" => kept("timing", field, uut.ring.word1.val().to_u64()),
        "range" => kept("limits", field, uut.ring.word2.val().to_u64()),
        other => panic!("field of the table unknown to the test: {other}"),
    }
}

/// A byte with its parity.
fn guarded(byte: u8) -> Bits<9> {
    (u64::from(byte.count_ones() % 2) << 8 | u64::from(byte)).into()
}

/// Turns new words into the ring block, most significant byte of word 0 first.
fn turn_in(uut: &mut ChannelRegisters, words: [u32; 3]) {
    turn_in_spoilt(uut, words, [0; 3]);
}

#[test]
fn every_configuration_field_is_where_the_table_says() {
    let config = test_config();
    let uut = new();
    let fields = || {
        CHANNEL_CONFIG
            .registers
            .iter()
            .flat_map(|r| r.fields.iter().map(move |f| (r, f)))
    };
    let words = config_words(&config, Some(0));
    for (register, field) in fields() {
        assert_eq!(
            output(&uut, field.name),
            u64::from(field.of(words[usize::from(register.offset)])),
            "{} after reset",
            field.name
        );
    }
    for (register, field) in fields() {
        let mut uut = new();
        let mut words = [0; 3];
        words[usize::from(register.offset)] = field.mask();
        turn_in(&mut uut, words);
        for (_, other) in fields() {
            let set = u64::from(other.mask() >> other.lsb);
            let expected = if other.name == field.name { set } else { 0 };
            assert_eq!(
                output(&uut, other.name),
                expected,
                "{} with {}",
                other.name,
                field.name
            );
        }
    }
}

/// The words of a block on the ring after a turn with the bits of `spoilt` inverted on the way in.
fn turn_in_spoilt(uut: &mut ChannelRegisters, words: [u32; 3], spoilt: [u32; 3]) {
    uut.ring_turn.next = true;
    uut.ring_home.next = false;
    let bytes = |words: [u32; 3]| words.into_iter().flat_map(u32::to_be_bytes);
    for (byte, spoilt) in bytes(words).zip(bytes(spoilt)) {
        uut.ring_in.next = guarded(byte) ^ Bits::<9>::from(u64::from(spoilt));
        step(uut);
    }
    uut.ring_turn.next = false;
    uut.ring_home.next = true;
    step(uut);
}

/// Catches settings that change during a frame, or in the cycle in which its trigger is evaluated.
#[test]
fn settings_stay_while_the_channel_is_busy_and_in_the_cycle_of_a_trigger() {
    let words = config_words(&test_config(), Some(0));
    let mut other = words;
    other[0] ^= 1 << 8;
    let all = |uut: &ChannelRegisters| {
        ["command", "period_cycles", "position_bits"].map(|field| output(uut, field))
    };
    let mut uut = new();
    let before = all(&uut);
    uut.busy.next = true;
    turn_in(&mut uut, other);
    assert_eq!(all(&uut), before, "busy");
    uut.busy.next = false;
    uut.trigger.next = true;
    step(&mut uut);
    assert_eq!(all(&uut), before, "in the cycle of a trigger");
    uut.trigger.next = false;
    step(&mut uut);
    assert_ne!(all(&uut), before, "at rest");
}

#[test]
fn nothing_goes_out_with_settings_that_nobody_wrote() {
    let words = config_words(&test_config(), Some(0));
    let start = new();
    let right = ["command", "request_id", "period_cycles"].map(|f| output(&start, f));
    for bit in 0..96 {
        let mut uut = guarded_registers();
        let mut spoilt = [0; 3];
        spoilt[bit / 32] = 1 << (bit % 32);
        turn_in_spoilt(&mut uut, words, spoilt);
        assert_eq!(output(&uut, "command"), 0, "bit {bit}");
        assert_eq!(output(&uut, "request_id"), 15, "bit {bit}");
        turn_in(&mut uut, words);
        let now = ["command", "request_id", "period_cycles"].map(|f| output(&uut, f));
        assert_eq!(now, right, "bit {bit}, written again");
        uut.card_damaged.next = true;
        step(&mut uut);
        assert_eq!(output(&uut, "command"), 0, "the card's own settings");
    }
}

#[test]
fn configuration_changes_only_between_frames() {
    let mut uut = new();
    let before = output(&uut, "period_cycles");
    uut.busy.next = true;
    turn_in(&mut uut, [0x155, 0, 0]);
    (0..20).for_each(|_| step(&mut uut));
    assert_eq!(output(&uut, "period_cycles"), before);
    uut.busy.next = false;
    step(&mut uut);
    assert_eq!(output(&uut, "period_cycles"), 0x155);
}

#[test]
fn a_result_is_owed_from_a_trigger_that_is_taken_to_its_result() {
    let mut uut = new();
    let pulse = |uut: &mut ChannelRegisters, trigger: bool, result: bool| {
        uut.trigger.next = trigger;
        uut.new_set.next = trigger;
        uut.result.result_strobe.next = result;
        step(uut);
        uut.trigger.next = false;
        uut.new_set.next = false;
        uut.result.result_strobe.next = false;
        step(uut);
        uut.owes.val()
    };
    assert!(pulse(&mut uut, true, false));
    assert!(pulse(&mut uut, false, false));
    assert!(!pulse(&mut uut, false, true));
    uut.busy.next = true;
    assert!(
        !pulse(&mut uut, true, false),
        "an overrun gives no separate result"
    );
    uut.busy.next = false;
    assert!(
        pulse(&mut uut, true, true),
        "a trigger with the last result"
    );
    uut.busy.next = true;
    assert!(
        !pulse(&mut uut, true, false),
        "another channel's trigger: the result of this channel is not awaited"
    );
}

#[test]
fn held_words_grow_old_by_themselves() {
    let mut uut = new();
    uut.tick_us.next = true;
    uut.show.next = true;
    uut.load.next = true;
    uut.result.age_us.next = 0xfff0u64.into();
    step(&mut uut);
    uut.load.next = false;
    // A newer position has another age.
    uut.result.age_us.next = 0u64.into();
    (0..5).for_each(|_| step(&mut uut));
    uut.show.next = false;
    step(&mut uut);
    assert_eq!(read(&mut uut, 5), 0xfff5, "frozen while it is read");
    uut.trigger.next = true;
    (0..20).for_each(|_| step(&mut uut));
    assert_eq!(read(&mut uut, 5), 0xfff5);
    uut.show.next = true;
    step(&mut uut);
    assert_eq!(
        read(&mut uut, 5),
        1 << 30 | 0xffff,
        "the time did not; the age stops there"
    );
}
