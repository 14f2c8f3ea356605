//! Words of a card over a byte link in the UARTBone format, interleaved with the sample sets that the card pushes.
//!
//! Ref: LiteX, `litex/tools/remote/comm_uart.py`.

use crate::registers::Place;
use crate::stream::{Decoder, SampleSet};
use crate::transport::Transport;
use crate::HostError;
use std::collections::VecDeque;
use std::time::Duration;

/// Most words in one command.
pub const WORDS_MAX: usize = 255;
/// Default timeout for an answer.
pub const WAIT: Duration = Duration::from_millis(500);
/// A card drops a command that pauses for 100 ms.
const FORGET: Duration = Duration::from_millis(120);
/// The longest answer at 9600 baud takes a second; after this time without silence on the line, waiting fails.
const SETTLE_MAX: Duration = Duration::from_secs(3);
/// Number of tries of a read.
const TRIES: u32 = 3;
/// Timeout for the frame after an answer.
const NEXT_FRAME: Duration = Duration::from_millis(5);
/// Precedes an answer while the card pushes sample sets; no frame begins with it.
const ANSWER: u8 = 0xFF;

/// Word access to a card.
pub struct Bridge<T> {
    transport: T,
    wait: Duration,
    pushes: bool,
    inbox: VecDeque<u8>,
    /// The next byte begins a frame or an answer.
    at_boundary: bool,
    decoder: Decoder,
    retries: u64,
}

impl<T: Transport> Bridge<T> {
    /// A bridge over a link.
    pub fn new(transport: T) -> Self {
        Self {
            transport,
            wait: WAIT,
            pushes: false,
            inbox: VecDeque::new(),
            at_boundary: true,
            decoder: Decoder::default(),
            retries: 0,
        }
    }

    /// Sets the timeout for an answer.
    pub fn set_wait(&mut self, wait: Duration) {
        self.wait = wait;
    }

    /// The link.
    pub fn transport(&mut self) -> &mut T {
        &mut self.transport
    }

    /// Number of answers that were missing or too long and were requested again.
    pub fn retries(&self) -> u64 {
        self.retries
    }

    /// Decoder of the pushed bytes, with its counters.
    pub fn decoder(&self) -> &Decoder {
        &self.decoder
    }

    /// Sets whether the card pushes sample sets; answers have a marker then.
    pub fn set_pushes(&mut self, pushes: bool) {
        self.pushes = pushes;
        self.at_boundary = true;
        self.decoder.forget();
    }

    /// Discounts damaged frames since `damaged`: they were answers without a marker.
    pub(crate) fn forgive(&mut self, damaged: u64) {
        self.decoder.forgive(damaged);
    }

    /// True if the card is assumed to push sample sets.
    pub(crate) fn pushes(&self) -> bool {
        self.pushes
    }

    /// Stops pushing: the answer after the last frame is the last one with a marker.
    pub fn end_push(&mut self) -> Result<(), HostError> {
        self.write(Place::at("card", "stream_control", 0).address(), &[0])?;
        let last = self.read(0, 1);
        match last {
            Ok(_) => self.set_pushes(false),
            Err(_) => self.calm()?,
        }
        Ok(())
    }

    /// Brings the link into a known state after any earlier use: no half command, and no pushed sets.
    pub fn calm(&mut self) -> Result<(), HostError> {
        self.set_pushes(false);
        self.settle()?;
        // A card without a stream ignores this.
        self.write(Place::at("card", "stream_control", 0).address(), &[0])?;
        self.settle()?;
        // The first answer after a push has its marker.
        self.send(&[2, 1, 0, 0, 0, 0])?;
        self.settle()
    }

    /// Received sample sets, after waiting at most `wait` for bytes.
    pub fn pushed(&mut self, wait: Duration) -> Result<Vec<SampleSet>, HostError> {
        if self.inbox.is_empty() {
            self.fill(wait)?;
        }
        while let Some(byte) = self.inbox.pop_front() {
            self.pushed_byte(byte);
        }
        Ok(self.decoder.take())
    }

    /// Sample sets received while waiting for an answer.
    pub(crate) fn decoded(&mut self) -> Vec<SampleSet> {
        self.decoder.take()
    }

    fn pushed_byte(&mut self, byte: u8) {
        self.at_boundary = byte == 0;
        self.decoder.push(byte);
    }

    /// Reads `count` words from `address` on, in one command.
    pub fn read(&mut self, address: u16, count: usize) -> Result<Vec<u32>, HostError> {
        self.read_as(2, address, count)
    }

    /// Reads the word at `address` `count` times, in one command.
    pub fn read_fixed(&mut self, address: u16, count: usize) -> Result<Vec<u32>, HostError> {
        self.read_as(4, address, count)
    }

    fn read_as(&mut self, command: u8, address: u16, count: usize) -> Result<Vec<u32>, HostError> {
        debug_assert!((1..=WORDS_MAX).contains(&count));
        let [high, low] = address.to_be_bytes();
        // A read with side effects must not be repeated automatically: the caller decides.
        let tries = if command == 4 { 1 } else { TRIES };
        for attempt in 0..tries {
            if attempt > 0 {
                self.retries += 1;
                self.settle()?;
            }
            if !self.pushes {
                // Unexpected bytes: an answer failed, and the rest of it may still arrive.
                let stale = self.inbox.len() + self.fill(Duration::ZERO)?;
                self.inbox.clear();
                if stale > 0 {
                    self.retries += 1;
                    self.settle()?;
                }
            }
            self.send(&[command, count as u8, 0, 0, high, low])?;
            if let Some(bytes) = self.answer(4 * count)? {
                if !self.goes_on_well()? {
                    continue;
                }
                return Ok(words(&bytes));
            }
        }
        Err(HostError::Silent {
            tries,
            wait_ms: self.wait.as_millis() as u64,
        })
    }

    /// Reads the first `count` words of a card that should push and does not answer. After a restart its answer has no marker. Returns `None` if
    /// no words satisfy `is_it`; received bytes then belong to the stream, and none are lost.
    pub(crate) fn read_unmarked(
        &mut self,
        count: usize,
        is_it: impl Fn(&[u32]) -> bool,
    ) -> Result<Option<Vec<u32>>, HostError> {
        let sets = self.decoder.counts().sets;
        for _ in 0..TRIES {
            self.settle()?;
            if self.decoder.counts().sets != sets {
                return Ok(None);
            }
            self.send(&[2, count as u8, 0, 0, 0, 0])?;
            let end = self.transport.elapsed() + self.wait;
            while self.inbox.len() < 4 * count && self.transport.elapsed() < end {
                self.fill(end.saturating_sub(self.transport.elapsed()))?;
            }
            let bytes: Vec<u8> = self.inbox.iter().copied().take(4 * count).collect();
            let found = words(&bytes);
            if found.len() == count && is_it(&found) {
                self.inbox.drain(..4 * count);
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// Writes words from `address` on, in one command; there is no answer.
    pub fn write(&mut self, address: u16, words: &[u32]) -> Result<(), HostError> {
        debug_assert!((1..=WORDS_MAX).contains(&words.len()));
        let [high, low] = address.to_be_bytes();
        let mut bytes = vec![1, words.len() as u8, 0, 0, high, low];
        bytes.extend(words.iter().flat_map(|w| w.to_be_bytes()));
        self.send(&bytes)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<(), HostError> {
        self.transport.send(bytes).map_err(lost)
    }

    /// Receives bytes into the inbox for up to `wait`.
    fn fill(&mut self, wait: Duration) -> Result<usize, HostError> {
        let mut buffer = [0; 4096];
        let count = self.transport.receive(&mut buffer, wait).map_err(lost)?;
        self.inbox.extend(&buffer[..count]);
        Ok(count)
    }

    /// Waits until the card has dropped any half command, and the line is quiet, or carries only whole frames if the card pushes.
    fn settle(&mut self) -> Result<(), HostError> {
        let mut quiet_since = self.transport.elapsed();
        let end = quiet_since + SETTLE_MAX;
        let mut damaged = self.decoder.damaged();
        let mut now = quiet_since;
        while now - quiet_since < FORGET && now < end {
            self.fill(FORGET)?;
            now = self.transport.elapsed();
            let mut is_noisy = !self.pushes && !self.inbox.is_empty();
            while let Some(byte) = self.inbox.pop_front() {
                if self.pushes {
                    self.pushed_byte(byte);
                }
            }
            // The rest of an answer corrupts the frame after it.
            is_noisy |= self.decoder.damaged() != damaged;
            damaged = self.decoder.damaged();
            if is_noisy {
                quiet_since = now;
            }
        }
        Ok(())
    }

    /// An answer that lost a byte has consumed one of the next frame, which is then damaged.
    fn goes_on_well(&mut self) -> Result<bool, HostError> {
        if !self.pushes {
            return Ok(true);
        }
        let damaged = self.decoder.damaged();
        loop {
            let Some(byte) = self.inbox.pop_front() else {
                if self.fill(NEXT_FRAME)? == 0 {
                    return Ok(true);
                }
                continue;
            };
            self.pushed_byte(byte);
            if self.at_boundary {
                return Ok(self.decoder.damaged() == damaged);
            }
        }
    }

    fn answer(&mut self, count: usize) -> Result<Option<Vec<u8>>, HostError> {
        let end = self.transport.elapsed() + self.wait;
        let mut bytes = Vec::with_capacity(count);
        let mut has_begun = !self.pushes;
        while bytes.len() < count {
            let Some(byte) = self.inbox.pop_front() else {
                let left = end.saturating_sub(self.transport.elapsed());
                if self.fill(left)? == 0 && self.transport.elapsed() >= end {
                    return Ok(None);
                }
                continue;
            };
            if has_begun {
                bytes.push(byte);
            } else if self.at_boundary && byte == ANSWER {
                has_begun = true;
            } else {
                self.pushed_byte(byte);
            }
        }
        self.at_boundary = true;
        Ok(Some(bytes))
    }
}

/// Words from received bytes.
fn words(bytes: &[u8]) -> Vec<u32> {
    let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
    bytes.chunks_exact(4).map(word).collect()
}

fn lost(error: std::io::Error) -> HostError {
    HostError::Link {
        address: "link".into(),
        action: "lost",
        error,
        remedy: "check that the card is still connected",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::thread::sleep;

    /// A card whose time runs at a tenth of real time; each byte of its answer takes a millisecond of it.
    struct Slow {
        time: Duration,
        answer: VecDeque<u8>,
    }

    impl Transport for Slow {
        fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
            self.answer.extend(&bytes[2..6]);
            Ok(())
        }

        fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
            if wait.is_zero() {
                return Ok(0);
            }
            let step = wait.min(Duration::from_millis(1));
            sleep(10 * step);
            self.time += step;
            let byte = self.answer.pop_front();
            buffer[0] = byte.unwrap_or(0);
            Ok(byte.is_some().into())
        }

        fn elapsed(&self) -> Duration {
            self.time
        }
    }

    #[test]
    fn answers_are_waited_for_in_the_card_s_own_time() {
        let mut bridge = Bridge::new(Slow {
            time: Duration::ZERO,
            answer: VecDeque::new(),
        });
        bridge.set_wait(Duration::from_millis(20));
        assert_eq!(bridge.read(7, 1).unwrap(), [7]);
        assert_eq!(bridge.retries(), 0);
    }
}
