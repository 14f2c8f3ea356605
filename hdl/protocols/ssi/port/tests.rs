use super::super::cause;
use super::super::protocol::from_gray;
use super::*;
use crate::testing::tick;

/// An encoder that answers in the cycle of the clock edge, and the port.
struct Rig {
    uut: SsiPort,
    cycle: u64,
    clk: bool,
    /// Bits as received, including the LOW one after each copy.
    bits: Vec<bool>,
    sent: usize,
    falls: Vec<u64>,
    rises: Vec<u64>,
    /// Cycles of LOW after the last edge.
    recovery: u64,
}

impl Rig {
    fn new(frame: u64, position_bits: u64) -> Self {
        let mut uut = SsiPort::new(&SsiSpec::default(), true);
        uut.data_i.next = true;
        uut.period_cycles.next = 21.into();
        uut.frame.next = frame.into();
        uut.position_bits.next = position_bits.into();
        uut.recovery_limit_cycles.next = 300.into();
        uut.connect_all();
        let mut rig = Self {
            uut,
            cycle: 0,
            clk: true,
            bits: vec![],
            sent: 0,
            falls: vec![],
            rises: vec![],
            recovery: 100,
        };
        rig.ready();
        rig
    }

    /// After a reset the encoder may be in the middle of a frame.
    fn ready(&mut self) {
        self.steps(20);
        while self.uut.busy.val() {
            self.steps(1);
        }
    }

    fn steps(&mut self, cycles: u64) {
        for _ in 0..cycles {
            self.uut.timestamp.next = self.cycle.into();
            tick(&mut self.uut, |u, level| u.clock.next = level.into());
            self.cycle += 1;
            let clk = self.uut.ssi_clk.val();
            if clk && !self.clk {
                self.rises.push(self.cycle);
                let bit = self.bits.get(self.sent).copied().unwrap_or(false);
                self.uut.data_i.next = bit;
                self.sent += 1;
            }
            if !clk && self.clk {
                self.falls.push(self.cycle);
            }
            self.clk = clk;
            if self
                .rises
                .last()
                .is_some_and(|at| self.cycle > at + self.recovery)
            {
                self.uut.data_i.next = true;
            }
        }
    }

    /// Sends a frame with these bits, up to the end of the recovery time; returns its cause.
    fn frame(&mut self, bits: Vec<bool>) -> u64 {
        self.bits = bits;
        self.sent = 0;
        (self.falls, self.rises) = (vec![], vec![]);
        self.trigger();
        // The encoder may take longer than the port waits; on a line that stays LOW the port waits forever.
        let mut left = 3_000;
        while left > 0 && (self.uut.busy.val() || !self.uut.data_i.val()) {
            self.steps(1);
            left -= 1;
        }
        self.steps(10);
        self.uut.result.cause.val().to_u64()
    }

    fn trigger(&mut self) {
        self.uut.trigger.next = true;
        self.steps(1);
        self.uut.trigger.next = false;
    }

    fn position(&self) -> u64 {
        self.uut.result.position.val().to_u64()
    }

    fn is_fresh(&self) -> bool {
        self.uut.result.fresh.val()
    }
}

/// Most significant bit first.
fn bits(value: u64, width: u64) -> Vec<bool> {
    (0..width).rev().map(|n| value >> n & 1 == 1).collect()
}

fn twice(first: u64, second: u64, width: u64) -> Vec<bool> {
    [bits(first, width), vec![false], bits(second, width)].concat()
}

fn positions_come(widths: &[u64]) {
    for &width in widths {
        let value = 0x9A5C_3F16_7E24u64 & ((1 << width) - 1);
        for (frame, sent, is) in [
            (4, bits(value, width), value),
            (5, bits(value, width), from_gray(value)),
            (6, twice(value, value, width), value),
            (7, twice(value, value, width), from_gray(value)),
        ] {
            let mut rig = Rig::new(frame, width);
            assert_eq!(rig.frame(sent), cause::NONE, "{frame} {width}");
            assert!(rig.is_fresh());
            assert_eq!(rig.position(), is, "{frame} {width}");
            // No more clock edges follow.
            rig.steps(2_000);
            let clocks = (width + 1) * (1 + (frame >> 1 & 1));
            assert_eq!(rig.falls.len() as u64, clocks);
            assert_eq!(rig.rises.len() as u64, clocks);
        }
    }
}

#[test]
fn positions_of_every_width_come_in_both_codes() {
    positions_come(&[1, 2, 48]);
}

#[test]
#[ignore = "slow: seven widths"]
fn positions_of_seven_widths_come_in_both_codes() {
    positions_come(&[1, 2, 12, 13, 25, 31, 48]);
}

#[test]
fn the_clock_has_the_period_and_a_longer_first_low() {
    let mut rig = Rig::new(4, 12);
    rig.uut.first_low_extra_cycles.next = 30.into();
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::NONE);
    assert_eq!(rig.position(), 0xA53);
    assert_eq!(rig.rises[0] - rig.falls[0], 10 + 30);
    for n in 1..13 {
        assert_eq!(rig.rises[n] - rig.rises[n - 1], 21);
        assert_eq!(rig.rises[n] - rig.falls[n], 10);
    }
    // The time stamp is that of the first falling edge, where the encoder latches the position.
    let stamp = rig.uut.result.first_fall_timestamp.val().to_u64();
    assert_eq!(stamp, rig.falls[0]);
}

#[test]
fn what_is_wrong_has_its_cause_and_brings_no_position() {
    let mut rig = Rig::new(6, 8);
    assert_eq!(rig.frame(twice(0x5A, 0x5A, 8)), cause::NONE);
    for (sent, is) in [
        (twice(0x33, 0x32, 8), cause::COPIES_DIFFER),
        // More bits than configured.
        (
            [twice(0x33, 0x33, 8), vec![true]].concat(),
            cause::DATA_NOT_LOW_AFTER,
        ),
        // HIGH between the copies.
        (
            [bits(0x33, 8), vec![true], bits(0x33, 8)].concat(),
            cause::DATA_NOT_LOW_AFTER,
        ),
        // No encoder is connected.
        (vec![true; 40], cause::DATA_NOT_LOW_AFTER),
    ] {
        assert_eq!(rig.frame(sent), is);
        assert!(!rig.is_fresh());
        assert_eq!(rig.position(), 0x5A, "the last good one");
        assert_eq!(
            rig.uut.result.flags.val().to_u64() & cause::flag(is),
            cause::flag(is)
        );
    }
    // Invalid settings.
    rig.uut.frame.next = 0.into();
    assert_eq!(rig.frame(twice(0x11, 0x11, 8)), cause::UNKNOWN_FRAME);
    assert!(rig.falls.is_empty());
    rig.uut.frame.next = 6.into();
    assert_eq!(rig.frame(twice(0x11, 0x11, 8)), cause::NONE);
    assert_eq!(rig.position(), 0x11);
}

/// The parity covers the bits as sent, for each copy separately.
#[test]
fn a_parity_bit_that_does_not_fit_has_its_cause() {
    for (frame, odd) in [
        (12, false),
        (13, false),
        (15, false),
        (28, true),
        (31, true),
    ] {
        for value in [0u64, 1, 0x2A7, 0x1FFF] {
            let fits = (value.count_ones() % 2 == 1) != odd;
            let copy = |parity| [bits(value, 13), vec![parity]].concat();
            let sent = |first, second| match frame & 2 {
                0 => copy(first),
                _ => [copy(first), vec![false], copy(second)].concat(),
            };
            let mut rig = Rig::new(frame, 13);
            assert_eq!(
                rig.frame(sent(fits, fits)),
                cause::NONE,
                "{frame} {value:x}"
            );
            assert_eq!(
                rig.position(),
                if frame & 1 == 1 {
                    from_gray(value)
                } else {
                    value
                }
            );
            assert_eq!(
                rig.frame(sent(!fits, fits)),
                cause::PARITY,
                "{frame} {value:x}"
            );
            assert!(!rig.is_fresh());
            if frame & 2 != 0 {
                assert_eq!(
                    rig.frame(sent(fits, !fits)),
                    cause::PARITY,
                    "{frame} {value:x}"
                );
            }
            assert_eq!(rig.frame(sent(fits, fits)), cause::NONE);
        }
    }
}

#[test]
fn a_line_that_is_low_is_not_clocked() {
    let mut rig = Rig::new(4, 12);
    rig.recovery = 1_000_000;
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::RECOVERY_TOO_LONG);
    let before = rig.uut.result.sequence.val();
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::DATA_NOT_HIGH);
    assert!(rig.falls.is_empty());
    assert!(!rig.is_fresh());
    assert_eq!(
        rig.uut.result.sequence.val(),
        before + 1,
        "a result for each trigger"
    );
}

#[test]
fn a_trigger_within_frame_or_recovery_is_lost_and_told_once() {
    let mut rig = Rig::new(4, 12);
    rig.bits = bits(0x123, 12);
    rig.trigger();
    rig.steps(50);
    assert!(!rig.uut.trigger_lost.val());
    rig.trigger();
    assert!(rig.uut.trigger_lost.val());
    rig.steps(1);
    assert!(!rig.uut.trigger_lost.val(), "a strobe");
    rig.steps(3_000);
    assert_eq!(rig.uut.result.cause.val().to_u64(), cause::TRIGGER_OVERRUN);
    assert!(rig.is_fresh(), "its position is good");
    assert_eq!(rig.position(), 0x123);
    assert_eq!(rig.frame(bits(0x124, 12)), cause::NONE);
    assert_eq!(rig.position(), 0x124);
    // Within the recovery time.
    rig.sent = 0;
    rig.trigger();
    while rig.rises.len() < 26 {
        rig.steps(1);
    }
    rig.steps(60);
    assert!(rig.uut.busy.val());
    rig.trigger();
    rig.steps(3_000);
    assert_eq!(rig.frame(bits(0x125, 12)), cause::TRIGGER_OVERRUN);
    assert_eq!(rig.frame(bits(0x126, 12)), cause::NONE);
}

#[test]
fn settings_out_of_their_range_end_in_a_result() {
    for (period, width) in [(0, 12), (1, 12), (3, 12), (21, 0), (21, 63)] {
        let mut rig = Rig::new(4, width);
        rig.uut.period_cycles.next = period.into();
        rig.frame(bits(0xA53, 12));
        assert_eq!(
            rig.uut.result.sequence.val().to_u64(),
            1,
            "{period} {width}"
        );
        assert!(!rig.uut.busy.val());
    }
}

#[test]
fn recovery_time_beyond_its_limit_withdraws_the_position_and_is_reported_by_the_next_result() {
    let mut rig = Rig::new(4, 12);
    rig.recovery = 260;
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::NONE);
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::NONE, "within its limit");
    rig.recovery = 500;
    // Its position is withdrawn.
    assert_eq!(rig.frame(bits(0xA53, 12)), cause::RECOVERY_TOO_LONG);
    assert!(!rig.is_fresh() && !rig.uut.result.position_valid.val());
    assert_eq!(
        rig.uut.result.flags.val().to_u64(),
        cause::flag(cause::RECOVERY_TOO_LONG)
    );
    rig.recovery = 100;
    assert_eq!(rig.frame(bits(0x5A3, 12)), cause::RECOVERY_TOO_LONG);
    assert!(rig.is_fresh());
    assert_eq!(rig.position(), 0x5A3);
    assert_eq!(rig.frame(bits(0x5A4, 12)), cause::NONE);
}
