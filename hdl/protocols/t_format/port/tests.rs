use super::super::cause;
use super::super::protocol::Request;
use super::*;
use crate::testing::tick;

/// Cycles of a microsecond in the tests, except for long bits.
const US: u64 = 20;

/// A port with an idle line, simulated cycle by cycle.
struct Rig {
    uut: TFormatPort,
    cycle: u64,
    /// Cycles in which the line to the encoder fell while the driver was on.
    falls: Vec<u64>,
    tx: bool,
    /// Cycles of a microsecond.
    us: u64,
}

impl Rig {
    fn new() -> Self {
        let mut uut = TFormatPort::new(true);
        uut.data_i.next = true;
        uut.bit_cycles.next = 8.into();
        uut.reply_gap_us.next = 3.into();
        uut.field_gap_us.next = 2.into();
        uut.request_id.next = 3.into();
        uut.connect_all();
        let mut rig = Self {
            uut,
            cycle: 0,
            falls: vec![],
            tx: true,
            us: US,
        };
        // Longer than any pause and any field: the line is idle.
        rig.us(70);
        rig
    }

    fn step(&mut self) {
        self.uut.timestamp.next = self.cycle.into();
        self.uut.tick_us.next = self.cycle.is_multiple_of(self.us);
        tick(&mut self.uut, |u, level| u.clock.next = level.into());
        self.cycle += 1;
        if self.tx && !self.uut.data_o.val() {
            assert!(self.uut.data_oe.val());
            self.falls.push(self.cycle);
        }
        self.tx = self.uut.data_o.val();
    }

    fn us(&mut self, us: u64) {
        (0..us * self.us).for_each(|_| self.step());
    }

    fn trigger(&mut self) {
        self.uut.trigger.next = true;
        self.step();
        self.uut.trigger.next = false;
    }

    fn half(&mut self, half: bool, data: u64) {
        self.uut.host_address.next = u64::from(word::SEND).into();
        self.uut.host_half.next = half;
        self.uut.host_data.next = data.into();
        self.uut.host_write.next = true;
        self.step();
        self.uut.host_write.next = false;
    }

    fn send(&mut self, id: u64, address: u64, data: u64) {
        self.half(true, id);
        self.half(false, address << 8 | data);
    }

    fn read(&mut self, at: u8) -> u64 {
        self.uut.host_address.next = u64::from(at).into();
        self.uut.host_read.next = true;
        self.step();
        self.uut.host_read.next = false;
        // The word stays, even if the port changes.
        self.step();
        self.uut.host_word.val().to_u64()
    }

    /// Cause, done and busy of the host's request.
    fn answer(&mut self) -> (u64, bool, bool) {
        let word = self.read(word::ANSWER);
        (word >> 12 & 15, word >> 16 & 1 == 1, word >> 17 & 1 == 1)
    }

    fn result(&self) -> (u64, u64) {
        let sequence = self.uut.result.sequence.val().to_u64();
        (sequence, self.uut.result.cause.val().to_u64())
    }
}

/// The line falls once for the start bit and three times for the bits of these requests, LSB first.
#[test]
fn a_trigger_sends_its_request_and_silence_is_told_as_such() {
    let mut rig = Rig::new();
    rig.trigger();
    assert!(rig.uut.busy.val());
    rig.us(20);
    // 0x1A: falls at the start bit, after bit 1 and after bit 4.
    assert_eq!(rig.falls.len(), 3);
    assert_eq!(rig.falls[1] - rig.falls[0], 3 * 8);
    assert_eq!(rig.result(), (1, cause::NO_ANSWER));
    assert!(!rig.uut.result.fresh.val() && !rig.uut.result.position_valid.val());
    assert_eq!(
        rig.uut.result.flags.val().to_u64(),
        cause::flag(cause::NO_ANSWER),
        "raw flags"
    );
    assert!(!rig.uut.busy.val());
    assert_eq!(rig.answer(), (0, false, false), "no request of the host");
}

#[test]
fn a_request_written_while_one_is_under_way_is_ignored() {
    let sent = |again: bool| {
        let mut rig = Rig::new();
        rig.send(3, 0, 0);
        rig.us(1);
        assert!(rig.answer().2, "the first request is under way");
        if again {
            rig.send(3, 5, 6);
        }
        rig.us(60);
        (rig.answer(), rig.falls.len())
    };
    let alone = sent(false);
    assert_eq!(alone.0, (cause::NO_ANSWER, true, false));
    assert_eq!(sent(true), alone);
}

#[test]
fn what_a_trigger_must_not_send_is_refused() {
    for id in 0..16u8 {
        let mut rig = Rig::new();
        rig.uut.request_id.next = u64::from(id).into();
        rig.trigger();
        rig.us(30);
        let is_sent =
            Request::from_id(id).is_some_and(crate::protocols::t_format::asked::is_triggered);
        assert_eq!(!rig.falls.is_empty(), is_sent, "{id}");
        let cause = match is_sent {
            true => cause::NO_ANSWER,
            false => cause::UNKNOWN_REQUEST,
        };
        assert_eq!(rig.result(), (1, cause), "{id}");
    }
}

#[test]
fn the_hosts_request_gives_no_result_and_waits_for_its_turn() {
    let mut rig = Rig::new();
    rig.trigger();
    rig.us(2);
    rig.send(2, 0, 0);
    assert_eq!(rig.answer(), (0, false, true), "waiting");
    let before = rig.falls.len();
    while rig.uut.result.sequence.val().to_u64() == 0 {
        rig.step();
        assert!(rig.falls.len() <= before + 3, "one exchange at a time");
    }
    rig.us(1);
    assert_eq!(rig.answer(), (0, false, true), "a rest, or under way");
    rig.us(20);
    // After a missing answer the line must be idle for a while.
    assert_eq!(rig.answer(), (cause::LINE_NOT_IDLE, true, false));
    rig.us(20);
    rig.send(2, 0, 0);
    rig.us(20);
    assert_eq!(rig.answer(), (cause::NO_ANSWER, true, false));
    assert_eq!(rig.result(), (1, cause::NO_ANSWER));
}

#[test]
fn a_request_that_is_under_way_cannot_be_changed() {
    let line = |disturb: bool| {
        let mut rig = Rig::new();
        rig.send(6, 0x55, 0xA5);
        while rig.cycle < 60 * US {
            if disturb && rig.answer().2 {
                rig.send(13, 0x2A, 0x5A);
            }
            (0..5).for_each(|_| rig.step());
        }
        rig.falls
    };
    let (plain, disturbed) = (line(false), line(true));
    let apart = |falls: &[u64]| {
        let pairs = falls.windows(2).map(|w| w[1] - w[0]);
        pairs.collect::<Vec<_>>()
    };
    assert_eq!(apart(&plain), apart(&disturbed));
    // The two halves of a request must follow the end of the previous one.
    let mut rig = Rig::new();
    rig.send(2, 0, 0);
    rig.half(true, 6);
    rig.us(60);
    let sent = rig.falls.len();
    rig.half(false, 0x55A5);
    rig.us(60);
    assert_eq!(rig.falls.len(), sent, "no other request was sent");
    assert!(rig.answer().1);
}

#[test]
fn a_trigger_that_is_not_taken_is_told_by_the_next_result() {
    let overrun = cause::flag(cause::TRIGGER_OVERRUN);
    let mut rig = Rig::new();
    rig.send(2, 0, 0);
    rig.us(2);
    assert!(!rig.uut.trigger_lost.val());
    rig.trigger();
    assert!(rig.uut.trigger_lost.val());
    rig.us(60);
    assert!(!rig.uut.trigger_lost.val(), "a strobe");
    assert_eq!(rig.result().0, 0);
    assert_eq!(rig.answer().0, cause::NO_ANSWER);
    rig.trigger();
    rig.us(60);
    assert_eq!(rig.result().0, 1);
    assert_eq!(rig.uut.result.flags.val().to_u64() & overrun, overrun);
    rig.trigger();
    rig.us(60);
    assert_eq!(rig.result().0, 2);
    assert_eq!(rig.uut.result.flags.val().to_u64() & overrun, 0);
}

/// A bit of one cycle would never end: lengths below 8 cycles are set to 8 and more.
fn bits_end(lengths: impl Iterator<Item = u64>) {
    for bit_cycles in lengths {
        let mut rig = Rig::new();
        rig.uut.bit_cycles.next = bit_cycles.into();
        // A request that takes longer than at its rate would be cut.
        rig.us = US.max(bit_cycles * 5 / 2);
        rig.trigger();
        let mut left_us = 120;
        while rig.result().0 == 0 && left_us > 0 {
            rig.us(1);
            left_us -= 1;
        }
        // Exactly one result.
        rig.us(left_us.min(20));
        assert_eq!(rig.result().0, 1, "{bit_cycles}");
        let cycles = if bit_cycles < 8 {
            bit_cycles | 8
        } else {
            bit_cycles
        };
        assert_eq!(rig.falls[1] - rig.falls[0], 3 * cycles, "{bit_cycles}");
    }
}

#[test]
fn no_bit_length_hangs() {
    bits_end([0, 1, 7, 8, 9, 127].into_iter());
}

#[test]
#[ignore = "slow: every bit length below 20 cycles"]
fn no_bit_length_hangs_at_any_length() {
    bits_end((0..20).chain([63, 64, 127]));
}
