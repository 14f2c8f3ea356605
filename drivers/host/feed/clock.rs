//! Number and time of rows, not wrapping.

/// Extends wrapping numbers. Two rows must be less than 2^16 triggers and 2^32 cycles apart.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    pub last: Option<(u16, u32)>,
    /// Last position of a running clock since the last trigger, with its extended time.
    passed: Option<(u32, u64)>,
    pub trigger: u64,
    pub cycles: u64,
    /// Difference of the card's trigger count and `trigger`.
    above: u32,
    /// Triggers since the last row, according to the card's count after a pause.
    ahead: Option<u32>,
    /// After this many rows the number has wrapped unseen, this many times.
    behind: Option<(usize, u64)>,
}

/// Number of wraps of a number that has advanced by `low` modulo 2^16, while the card has counted about `ahead`.
fn wraps(ahead: u32, low: u64) -> u64 {
    (u64::from(ahead) + 0x8000).saturating_sub(low) >> 16
}

impl Clock {
    /// Uses the card's trigger count: during a pause the number of a trigger may wrap more than once. `before` has the numbers and
    /// times of rows that arrived before the count and are not processed yet: the pause is before or among them.
    pub fn counted(&mut self, triggers: u32, before: &[(u16, u32)]) {
        let Some((mut number, mut moment)) = self.last else {
            self.above = triggers;
            return;
        };
        let ahead = triggers.wrapping_sub(self.above.wrapping_add(self.trigger as u32));
        let ahead = Some(ahead).filter(|ahead| *ahead as i32 > 0);
        let (mut low, mut longest) = (0, (0, 0));
        for (n, (next, at)) in before.iter().enumerate() {
            low += u64::from(next.wrapping_sub(number));
            let span = at.wrapping_sub(moment);
            if span > longest.1 {
                longest = (n, span);
            }
            (number, moment) = (*next, *at);
        }
        match before {
            [] => self.ahead = ahead,
            _ => self.behind = ahead.map(|ahead| (longest.0, wraps(ahead, low))),
        }
    }

    /// Wraps of the number that apply to this row.
    fn unseen_wraps(&mut self, low: u64) -> u64 {
        let told = self.ahead.take().map_or(0, |ahead| wraps(ahead, low));
        match self.behind {
            Some((0, more)) => {
                self.behind = None;
                more
            }
            Some((rows, more)) => {
                self.behind = Some((rows - 1, more));
                told
            }
            None => told,
        }
    }

    /// Processes a trigger's number and time; returns the number of missing triggers before it.
    pub fn step(&mut self, sequence: u16, timestamp: u32) -> u64 {
        let missing = match self.last {
            None => {
                self.trigger = sequence.into();
                let since = sequence.wrapping_sub(self.above as u16) as i16;
                let counted = self.above.wrapping_add_signed(since.into());
                self.above = counted.wrapping_sub(sequence.into());
                0
            }
            Some((last_sequence, last_timestamp)) => {
                let low = u64::from(sequence.wrapping_sub(last_sequence));
                let steps = low + (self.unseen_wraps(low) << 16);
                self.trigger += steps;
                self.cycles = match self.passed {
                    None => self.cycles + u64::from(timestamp.wrapping_sub(last_timestamp)),
                    Some(passed) => near(passed, timestamp),
                };
                steps.saturating_sub(1)
            }
        };
        self.last = Some((sequence, timestamp));
        self.passed = None;
        missing
    }

    /// Processes the time of a running clock's position; returns its extended time.
    pub fn pass(&mut self, timestamp: u32) -> u64 {
        let known = self
            .passed
            .or(self.last.map(|(_, last)| (last, self.cycles)));
        let known = known.unwrap_or((timestamp, self.cycles));
        let cycles = near(known, timestamp);
        if cycles >= known.1 {
            self.passed = Some((timestamp, cycles));
        }
        cycles
    }
}

/// Extended time of an instant near a known one.
fn near((known, cycles): (u32, u64), timestamp: u32) -> u64 {
    let since = timestamp.wrapping_sub(known) as i32;
    cycles.saturating_add_signed(since.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_of_a_running_clock_stand_between_the_triggers() {
        let mut clock = Clock::default();
        clock.step(7, 0xFFFF_FF00);
        assert_eq!([0xFFFF_FFF0, 0x10].map(|t| clock.pass(t)), [0xF0, 0x110]);
        // Each channel has its own delay until its position is sent.
        assert_eq!(clock.pass(8), 0x108);
        // The trigger was before the last received position.
        assert_eq!((clock.step(8, 0xC), clock.cycles), (0, 0x10C));
        // A run of many seconds.
        for n in 1..20u32 {
            clock.pass(n.wrapping_mul(1 << 30));
        }
        assert_eq!((clock.step(9, 0xC), clock.trigger), (0, 9));
        assert_eq!(clock.cycles, 0x100 + (5 << 32) + 0xC);
    }

    /// Catches a pause of 100 000 triggers that is counted as one of 34 464.
    #[test]
    fn over_a_pause_the_cards_own_count_tells_how_many_were_missed() {
        for begin in [0x0003_0005u32, 0x0002_FFF0, 0xFFFF_FFF0] {
            let mut clock = Clock::default();
            // The count is read some triggers before the first row, and some before or after the first row after the pause.
            clock.counted(begin.wrapping_sub(20), &[]);
            clock.step(begin as u16, 0);
            for late in [0, 3, u32::MAX - 2] {
                let before = clock.trigger;
                let now = begin.wrapping_add(before as u32 - u32::from(begin as u16) + 100_000);
                clock.counted(now.wrapping_add(late), &[]);
                assert_eq!(clock.step(now as u16, 0), 99_999, "{begin:#x} {late}");
                assert_eq!(clock.trigger, before + 100_000);
            }
            // No triggers were missed: the count is the current one.
            clock.counted(begin.wrapping_add(300_000), &[]);
            let next = begin.wrapping_add(300_001) as u16;
            assert_eq!(clock.step(next, 0), 0);
        }
    }

    /// Catches a pause of the host that is counted as a pause of the card, and the reverse: rows wait, and the count is current.
    #[test]
    fn rows_that_came_before_the_count_are_not_behind_it() {
        let rows = |numbers: std::ops::Range<u32>| -> Vec<(u16, u32)> {
            numbers.map(|n| (n as u16, n * 100)).collect()
        };
        // The host paused for 80 000 triggers, and all their rows are available.
        let mut clock = Clock::default();
        clock.counted(0, &[]);
        clock.step(1, 100);
        let waiting = rows(2..80_002);
        clock.counted(80_010, &waiting);
        for (number, moment) in &waiting {
            assert_eq!(clock.step(*number, *moment), 0);
        }
        assert_eq!(clock.trigger, 80_001);
        // The card was silent for 100 000 triggers, and ten rows after that arrived before its count.
        let mut waiting = rows(80_002..80_007);
        waiting.extend(rows(180_007..180_017));
        clock.counted(180_020, &waiting);
        let missing: Vec<u64> = waiting.iter().map(|(n, t)| clock.step(*n, *t)).collect();
        assert_eq!(missing.iter().sum::<u64>(), 100_000);
        assert_eq!((missing[5], clock.trigger), (100_000, 180_016));
        assert_eq!(clock.step(180_017u32 as u16, 18_001_700), 0);
    }

    #[test]
    fn numbers_that_wrap_go_on() {
        let mut clock = Clock::default();
        let steps = [(0xFFFE, 0xFFFF_FFF0), (0xFFFF, 0x10), (2, 0x30)];
        let missing = steps.map(|(sequence, timestamp)| {
            let missing = clock.step(sequence, timestamp);
            (clock.trigger, clock.cycles, missing)
        });
        assert_eq!(
            missing,
            [(0xFFFE, 0, 0), (0xFFFF, 0x20, 0), (0x1_0002, 0x40, 2)]
        );
    }
}
