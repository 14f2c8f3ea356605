//! What the host does: it reads results and the stream, checks them with the host's library, and opens the connection anew when nothing
//! else helps, as the pages on the link and on the stream say.

use super::line::Line;
use super::told::{Kind, Known, Round, Seen, Verdict, What};
use super::CYCLES_PER_US;
use super::{CHANNELS, CONFIG_WORDS, SERVICE_WORDS};
use endat_driver::Reading;
use endat_hdl::card::stream::buffer::frame_bytes;
use endat_hdl::endat::service::map::{control, request_state, word};
use endat_hdl::endat::timing::PARAMETER_TIMEOUT_US;
use endat_hdl::protocol::ModeCommand;
use endat_hdl::regs::{
    result_words, BLOCK_STRIDE, CARD, CONFIG_BASE, RESULT_BASE, SERVICE, SERVICE_BASE,
};
use endat_host::result::of_burst;
use endat_host::stream::SampleSet;
use endat_regs::Protocols;
use std::collections::VecDeque;

/// System clock cycles of a bit of the link, and of a byte.
pub const BIT_CYCLES: u64 = 8;
const BYTE: u64 = 10 * BIT_CYCLES;
/// The card forgets a command that pauses for so long; real ones after 100 ms.
pub const TIMEOUT_US: u64 = 100;
/// As long as the host waits for that.
const FORGET: u64 = CYCLES_PER_US * (TIMEOUT_US + TIMEOUT_US / 10);
/// A line that is never quiet is given up after this.
const SETTLE_MAX: u64 = 10 * FORGET;
/// From a trigger until both results and their set are there.
pub const FRAME: u64 = 1_200;
/// Nothing happens.
const IDLE: u64 = 1_500;
/// How often a read is tried.
const TRIES: u32 = 3;
/// A frame of the stream.
const FRAME_BYTES: u64 = frame_bytes(CHANNELS, false);
/// Words that hold one and its end.
const FRAME_WORDS: usize = FRAME_BYTES as usize / 4 + 1;
/// Comes before an answer while the card pushes.
const ANSWER: u8 = 0xFF;
/// Longest wait for a request: longer than the card's own.
const PATIENCE: u64 = 80_000;
/// A command with a parameter that the encoder refuses has ended by then: the channel waits so long for its answer, the service no more.
const REFUSED: u64 = CYCLES_PER_US * (PARAMETER_TIMEOUT_US + 10_000);
/// Send parameter, address 0x0D; and select memory area 0xA1.
const SEND_PARAMETER: u32 = request_word(ModeCommand::SendParameter, 0x0D);
const SELECT_MEMORY: u32 = request_word(ModeCommand::SelectMemory, 0xA1);

const fn request_word(command: ModeCommand, address: u32) -> u32 {
    (command.code() as u32) << 24 | address << 16
}

/// Address of a word of the card.
fn card_word(name: &str) -> u16 {
    let found = CARD.registers.iter().find(|r| r.name == name);
    CARD.address(found.expect("a word of the card"), 0)
}

/// Address of a word of a channel's service.
fn service_word(channel: usize, word: u8) -> u16 {
    SERVICE_BASE + SERVICE.stride * channel as u16 + u16::from(word)
}

/// The host's program.
pub struct Host {
    line: Line<Seen, Verdict>,
    known: Known,
    /// Answers have their marks.
    is_marked: bool,
    at_boundary: bool,
    is_told: bool,
    /// When the last byte that was sent will have left.
    sent: u64,
    sets: Vec<SampleSet>,
    troubles: u64,
    silent_rounds: u32,
}

type Words = Option<Vec<u32>>;

impl Host {
    /// A host that knows this.
    pub fn new(line: Line<Seen, Verdict>, known: Known) -> Self {
        let mut host = Self {
            is_marked: known.pushes,
            line,
            known,
            at_boundary: true,
            is_told: false,
            sent: 0,
            sets: vec![],
            troubles: 0,
            silent_rounds: 0,
        };
        host.troubles = host.count_troubles();
        host
    }

    /// Everything before a case, on a card that has just been switched on.
    pub async fn prepare(mut self, pushes: bool, words: Vec<[u32; CONFIG_WORDS]>) {
        self.known.words = words;
        self.known.pushes = pushes;
        for channel in 0..CHANNELS {
            for (index, word) in SERVICE_WORDS.into_iter().enumerate() {
                let read = self.read(2, service_word(channel, word), 1).await;
                self.known.services[channel][index] = read.expect("an answer")[0];
            }
        }
        self.open().await;
        for _ in 0..3 {
            let round = self.round().await;
            self.tell(What::Round(round)).await;
        }
        for channel in 0..CHANNELS {
            let area = self.request(channel, SELECT_MEMORY).await;
            let answer = self.request(channel, SEND_PARAMETER).await;
            assert!(area.is_some() && answer.is_some(), "a request, {channel}");
            self.known.answers[channel] = answer.unwrap_or_default();
        }
        let known = Box::new(self.known.clone());
        self.tell(What::Ready(known)).await;
    }

    /// A case.
    pub async fn case(mut self, kind: Kind) {
        if kind == Kind::Read {
            self.trigger().await;
        }
        self.tell(What::Begun).await;
        let mut acted = None;
        match kind {
            Kind::Idle => self.line.until(self.line.now() + IDLE).await,
            Kind::Frame => self.trigger().await,
            Kind::Read => acted = Some(self.results().await),
            Kind::Write => self.configure().await,
            Kind::Stream => acted = Some(self.round().await),
            Kind::Request => self.ask(0).await,
        }
        self.tell(What::Acted(acted)).await;
        if kind == Kind::Frame {
            let round = self.results().await;
            self.tell(What::Acted(Some(round))).await;
        }
        loop {
            let round = self.round().await;
            match self.tell(What::Round(round)).await {
                Verdict::Again => {}
                Verdict::Reopen => {
                    self.open().await;
                    self.tell(What::Reopened).await;
                }
                Verdict::Rest => {
                    self.tell(What::Slow).await;
                    self.line.until(self.line.now() + REFUSED).await;
                }
                Verdict::End => break,
                Verdict::GiveUp => return,
            }
        }
        // In the other kinds the services have been left alone.
        if matches!(kind, Kind::Idle | Kind::Request) {
            for channel in 0..CHANNELS {
                self.ask(channel).await;
            }
        }
        let is_same = self.is_as_written().await;
        self.tell(What::End(is_same)).await;
    }

    async fn tell(&mut self, what: What) -> Verdict {
        let troubles = self.count_troubles();
        self.is_told |= std::mem::replace(&mut self.troubles, troubles) != troubles;
        let is_told = std::mem::take(&mut self.is_told);
        self.line.tell(Seen { what, is_told }).await
    }

    /// Frames that were damaged or missing, as the library counts them.
    fn count_troubles(&self) -> u64 {
        let counts = self.known.decoder.counts();
        counts.damaged + counts.missing + counts.lost_in_card
    }

    async fn trigger(&mut self) {
        self.line.trigger();
        self.line.until(self.line.now() + FRAME).await;
    }

    async fn round(&mut self) -> Round {
        self.trigger().await;
        self.results().await
    }

    /// Results of both channels, and the sets of the stream.
    async fn results(&mut self) -> Round {
        let mut results = self.read_results().await;
        // As the library does it: what does not fit its CRC is read again, and then it is an error.
        if results.as_ref().is_some_and(|r| r.iter().any(|r| !r.fits)) {
            self.is_told = true;
            results = self.read_results().await;
        }
        let results = results.map(|all| all.into_iter().map(Reading::checked).collect());
        match self.known.pushes {
            true => self.pushed().await,
            false => self.read_stream().await,
        }
        let mut sets = std::mem::take(&mut self.sets);
        sets.extend(self.known.decoder.take());
        // A stream that stays silent is switched on again.
        self.silent_rounds = match sets.is_empty() {
            true => self.silent_rounds + 1,
            false => 0,
        };
        if self.silent_rounds == 2 {
            self.is_told = true;
            self.silent_rounds = 0;
            self.write(card_word("stream_control"), &[self.control()]);
        }
        Round { results, sets }
    }

    async fn read_results(&mut self) -> Option<Vec<Reading>> {
        let count = result_words(CHANNELS, true) as usize;
        let words = self.read(2, RESULT_BASE, count).await?;
        Some(of_burst(&words, CHANNELS, true, Protocols::ENDAT))
    }

    async fn read_stream(&mut self) {
        for _ in 0..4 {
            let Some(words) = self.read(4, card_word("stream_data"), FRAME_WORDS).await else {
                return;
            };
            let bytes = words.iter().flat_map(|w| w.to_be_bytes());
            bytes.for_each(|byte| self.known.decoder.push(byte));
            if words.last().is_some_and(|w| w & 0xFF == 0) {
                return;
            }
        }
    }

    /// Waits for the set of this trigger.
    async fn pushed(&mut self) {
        let end = self.line.now() + 2 * FRAME_BYTES * BYTE;
        loop {
            self.sets.extend(self.known.decoder.take());
            if !self.sets.is_empty() && self.at_boundary {
                return;
            }
            let Some(byte) = self.line.byte(end).await else {
                return;
            };
            self.pushed_byte(byte);
        }
    }

    fn pushed_byte(&mut self, byte: u8) {
        self.at_boundary = byte == 0;
        self.known.decoder.push(byte);
    }

    fn control(&self) -> u32 {
        match self.known.pushes {
            true => 3,
            false => 1,
        }
    }

    /// Configuration words are changed and read back; what is not as written is written again.
    async fn configure(&mut self) {
        let block = CHANNELS;
        self.known.words[block][2] ^= 1;
        let (address, words) = (self.block_at(block), self.known.words[block]);
        for _ in 0..TRIES {
            self.write(address, &words);
            if self.read(2, address, CONFIG_WORDS).await.as_deref() == Some(&words) {
                return;
            }
            self.is_told = true;
        }
    }

    fn block_at(&self, block: usize) -> u16 {
        CONFIG_BASE + block as u16 * BLOCK_STRIDE
    }

    async fn is_as_written(&mut self) -> bool {
        let count = CHANNELS * usize::from(BLOCK_STRIDE) + CONFIG_WORDS;
        let (Some(words), Some(control)) = (
            self.read(2, CONFIG_BASE, count).await,
            self.read(2, card_word("stream_control"), 1).await,
        ) else {
            self.is_told = true;
            return true;
        };
        let mut blocks = self.known.words.iter().enumerate();
        let same = |(n, block): (usize, &[u32; CONFIG_WORDS])| {
            words[n * usize::from(BLOCK_STRIDE)..][..CONFIG_WORDS] == block[..]
        };
        blocks.all(same) && control == [self.control()]
    }

    /// A request whose answer is known. What fails is tried again; then the connection is opened anew.
    async fn ask(&mut self, channel: usize) {
        for attempt in 0..5 {
            if attempt == 2 {
                self.open().await;
                self.tell(What::Reopened).await;
                // Another command than the one that was meant may have gone out, and the encoder has forgotten its area.
                self.request(channel, SELECT_MEMORY).await;
            }
            match self.request(channel, SEND_PARAMETER).await {
                Some(answer) if answer != self.known.answers[channel] => {
                    self.tell(What::WrongAnswer).await;
                    return;
                }
                Some(_) => return,
                None => self.is_told = true,
            }
            if attempt == 3 {
                self.tell(What::Slow).await;
                self.line.until(self.line.now() + REFUSED).await;
            }
        }
        self.tell(What::Stuck).await;
    }

    /// A request, as the library sends one; none if it is refused.
    async fn request(&mut self, channel: usize, word: u32) -> Option<u64> {
        let at = |word| service_word(channel, word);
        let state = at(word::REQUEST_STATE);
        let (busy, cancel) = (u32::from(request_state::BUSY), [control::CANCEL.into()]);
        let before = self.read(2, state, 1).await?[0];
        if before & busy != 0 {
            self.write(at(word::CONTROL), &cancel);
            self.line.until(self.line.now() + PATIENCE).await;
            return None;
        }
        self.write(at(word::REQUEST), &[word]);
        let end = self.line.now() + PATIENCE;
        let state = loop {
            let now = self.read(2, state, 1).await?[0];
            if now >> 16 != before >> 16 && now & busy == 0 {
                break now;
            }
            if self.line.now() > end {
                self.write(at(word::CONTROL), &cancel);
                return None;
            }
        };
        if state >> request_state::ERROR_SHIFT & 0xF != 0 {
            return None;
        }
        let answer = self.read(2, at(word::ANSWER), 2).await?;
        Some(u64::from(answer[1] & 0xFFFF) << 32 | u64::from(answer[0]))
    }

    /// Brings card and link into a known state, whatever was before: `docs/stream.md`; then everything is written.
    async fn open(&mut self) {
        self.is_marked = false;
        self.known.decoder.forget();
        self.settle().await;
        self.write(card_word("stream_control"), &[0]);
        self.settle().await;
        self.send(&[2, 1, 0, 0, 0, 0]);
        self.settle().await;
        for block in 0..=CHANNELS {
            let words = self.known.words[block];
            self.write(self.block_at(block), &words);
        }
        for (channel, values) in self.known.services.into_iter().enumerate() {
            for (word, value) in SERVICE_WORDS.into_iter().zip(values) {
                self.write(service_word(channel, word), &[value]);
            }
        }
        self.write(card_word("stream_clear"), &[1]);
        self.write(card_word("stream_control"), &[self.control()]);
        self.is_marked = self.known.pushes;
        self.at_boundary = true;
        self.line.until(self.sent + BYTE).await;
    }

    /// Waits until the card has forgotten what was sent to it, and nothing comes any more (unless it pushes).
    async fn settle(&mut self) {
        let start = self.line.now().max(self.sent);
        let mut quiet_since = start;
        while self.line.now() < (quiet_since + FORGET).min(start + SETTLE_MAX) {
            self.line.until(quiet_since + FORGET).await;
            quiet_since = quiet_since.max(self.line.heard());
            self.drop_bytes();
        }
    }

    /// Bytes that have come: of the stream, or nobody's.
    fn drop_bytes(&mut self) -> usize {
        let bytes: VecDeque<u8> = self.line.take();
        let count = bytes.len();
        if self.is_marked {
            bytes.into_iter().for_each(|byte| self.pushed_byte(byte));
        }
        count
    }

    fn send(&mut self, bytes: &[u8]) {
        self.line.send(bytes);
        self.sent = self.sent.max(self.line.now()) + bytes.len() as u64 * BYTE;
    }

    fn write(&mut self, address: u16, words: &[u32]) {
        let [high, low] = address.to_be_bytes();
        let mut bytes = vec![1, words.len() as u8, 0, 0, high, low];
        bytes.extend(words.iter().flat_map(|w| w.to_be_bytes()));
        self.send(&bytes);
    }

    async fn read(&mut self, command: u8, address: u16, count: usize) -> Words {
        let [high, low] = address.to_be_bytes();
        // What a read changes is not read twice.
        let tries = if command == 4 { 1 } else { TRIES };
        for attempt in 0..tries {
            if attempt > 0 {
                self.settle().await;
            }
            if !self.is_marked && self.drop_bytes() > 0 {
                self.is_told = true;
                self.settle().await;
            }
            self.send(&[command, count as u8, 0, 0, high, low]);
            let answer = self.answer(4 * count).await;
            if let Some(bytes) = answer {
                if self.goes_on_well().await {
                    let word = |b: &[u8]| u32::from_be_bytes([b[0], b[1], b[2], b[3]]);
                    return Some(bytes.chunks_exact(4).map(word).collect());
                }
            }
            self.is_told = true;
        }
        None
    }

    async fn answer(&mut self, count: usize) -> Option<Vec<u8>> {
        let frames = if self.is_marked { 2 * FRAME_BYTES } else { 0 };
        let end = self.sent + (count as u64 + frames + 6) * BYTE;
        let mut bytes = Vec::with_capacity(count);
        let mut has_begun = !self.is_marked;
        while bytes.len() < count {
            let byte = self.line.byte(end).await?;
            if has_begun {
                bytes.push(byte);
            } else if self.at_boundary && byte == ANSWER {
                has_begun = true;
            } else {
                self.pushed_byte(byte);
            }
        }
        self.at_boundary = true;
        Some(bytes)
    }

    /// An answer that lost a byte has eaten one of the frame behind it: then that frame is damaged.
    async fn goes_on_well(&mut self) -> bool {
        if !self.is_marked {
            return true;
        }
        let damaged = self.known.decoder.damaged();
        while let Some(byte) = self.line.byte(self.line.now() + 3 * BYTE).await {
            self.pushed_byte(byte);
            if self.at_boundary {
                return self.known.decoder.damaged() == damaged;
            }
        }
        true
    }
}
