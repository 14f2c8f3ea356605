//! The card: identity, words, results, triggers.

use crate::error::Error;
use crate::facts::Facts;
use crate::link::Link;
use crate::map::{field, word};
use crate::result::{Moment, MOMENT_WORDS};
use embedded_hal::delay::DelayNs;
use endat_regs::{
    Part, Protocol, Protocols, BLOCK_STRIDE, CHANNELS_MAX, FEATURES_BITS, ID, RESULT_BASE, VERSION,
};

/// Number of tries to read one instant word by word before the results are held.
const MOMENT_TRIES: usize = 3;
/// Number of writes of a word that reads back with another value.
const WRITE_TRIES: usize = 2;
/// Pause between two polls of results.
const RESULT_PAUSE_US: u32 = 5;
/// Patterns for the scratch bits, which detect swapped bytes, lost writes and wrong addresses.
const PATTERNS: [u32; 4] = [0x00AA_5501, 0x0055_AAFE, 0x0001_0280, 0];

/// A card at a link.
#[derive(Debug)]
pub struct Card<L, D> {
    pub(crate) link: L,
    delay: D,
    facts: Facts,
}

/// A wait with a limit, which adds up its pauses.
pub(crate) struct Wait {
    left_us: u64,
}

impl Wait {
    pub(crate) const fn of_us(limit_us: u32) -> Self {
        let left_us = limit_us as u64;
        Self { left_us }
    }

    pub(crate) const fn of_ms(limit_ms: u32) -> Self {
        let left_us = limit_ms as u64 * 1_000;
        Self { left_us }
    }

    /// Pauses; `false` after the limit: poll once more, then stop.
    pub(crate) fn more(&mut self, delay: &mut impl DelayNs, pause_us: u32) -> bool {
        delay.delay_us(pause_us);
        self.left_us = self.left_us.saturating_sub(pause_us.into());
        self.left_us > 0
    }
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Identifies the card. Rejects anything else, another major version of the register map and, if a hash is given (the first 8
    /// digits of the configuration hash in the generated files), a card with another configuration. Give `&mut link` to keep the link
    /// after an error.
    pub fn open(mut link: L, delay: D, hash: Option<u32>) -> Result<Self, Error<L::Error>> {
        let id = link.read(word!(CARD.id))?;
        let version = link.read(word!(CARD.version))?;
        let capabilities = link.read(word!(CARD.capabilities))?;
        let protocols = link.read(word!(CARD.protocols))?;
        let facts = Facts {
            version: [
                field!(CARD.version.major).of(version) as u8,
                field!(CARD.version.minor).of(version) as u8,
                field!(CARD.version.patch).of(version) as u8,
            ],
            configuration_hash: link.read(word!(CARD.configuration_hash))?,
            system_hz: link.read(word!(CARD.system_hz))?,
            channels: field!(CARD.capabilities.channels).of(capabilities) as usize,
            max_position_bits: field!(CARD.capabilities.max_position_bits).of(capabilities),
            protocols: Protocols::of_word(protocols),
            features: field!(CARD.capabilities.features).of(capabilities)
                | field!(CARD.protocols.features).of(protocols) << FEATURES_BITS,
        };
        if id != ID {
            return Err(Error::NoCard);
        }
        if facts.version[0] != VERSION[0] {
            let found = facts.version[0];
            return Err(Error::Version { found });
        }
        if !(1..=CHANNELS_MAX).contains(&facts.channels) || facts.system_hz == 0 {
            return Err(Error::NoCard);
        }
        match hash.filter(|hash| *hash != facts.configuration_hash) {
            Some(_) => Err(Error::Configuration {
                found: facts.configuration_hash,
            }),
            None => Ok(Self { link, delay, facts }),
        }
    }

    /// Returns link and delay.
    pub fn release(self) -> (L, D) {
        (self.link, self.delay)
    }

    /// The link, for example to read its counters.
    pub const fn link(&self) -> &L {
        &self.link
    }

    /// The link, to change its settings.
    pub const fn link_mut(&mut self) -> &mut L {
        &mut self.link
    }

    /// Identification of the card.
    pub const fn facts(&self) -> &Facts {
        &self.facts
    }

    /// Reads a word, for words without a separate call: see `endat_regs`.
    pub fn read_word(&mut self, word_address: u32) -> Result<u32, Error<L::Error>> {
        self.link.read(word_address)
    }

    /// Writes a word.
    pub fn write_word(&mut self, word_address: u32, value: u32) -> Result<(), Error<L::Error>> {
        self.link.write(word_address, value)
    }

    /// Writes a word that keeps the written value, and reads it back; tries once more if it differs.
    pub fn write_checked(&mut self, word_address: u32, value: u32) -> Result<(), Error<L::Error>> {
        for _ in 0..WRITE_TRIES {
            self.link.write(word_address, value)?;
            if self.link.read(word_address)? == value {
                return Ok(());
            }
        }
        Err(Error::ReadBack)
    }

    /// Tests the link: writes patterns into the scratch bits, and reads them back. Held results are released.
    pub fn try_link(&mut self) -> Result<(), Error<L::Error>> {
        let address = word!(CARD_CONFIG.hold);
        for pattern in PATTERNS {
            let word = field!(CARD_CONFIG.hold.scratch).put(0, pattern);
            self.write_checked(address, word.unwrap_or(0))?;
        }
        Ok(())
    }

    /// Reads the results of all channels from one instant: with one burst if the link supports it, else word by word, again if a
    /// result came in between, and finally with the card's hold. Each position is checked against its CRC; a mismatch is read again.
    pub fn read_moment(&mut self) -> Result<Moment, Error<L::Error>> {
        let moment = self.look_at_one_moment()?;
        match moment.results().iter().all(|result| result.fits) {
            true => Ok(moment),
            false => self.look_at_one_moment(),
        }
    }

    fn look_at_one_moment(&mut self) -> Result<Moment, Error<L::Error>> {
        let mut words = [0; MOMENT_WORDS];
        let has_infos = self.facts.has(Part::Requests);
        let channels = self.facts.channels;
        let count = endat_regs::result_words(channels, has_infos) as usize;
        if !self
            .link
            .read_burst(RESULT_BASE.into(), &mut words[..count])?
        {
            let mut is_one = false;
            for _ in 0..MOMENT_TRIES {
                self.look(&mut words[..count])?;
                is_one = self.is_same(&words)?;
                if is_one {
                    break;
                }
            }
            if !is_one {
                self.look_held(&mut words[..count])?;
            }
        }
        Ok(Moment::new(&words, &self.facts))
    }

    /// Reads the words of all results in rising order, without those between two results.
    fn look(&mut self, words: &mut [u32]) -> Result<(), Error<L::Error>> {
        let each = endat_regs::result_words(1, self.facts.has(Part::Requests)) as usize;
        for (at, word) in words.iter_mut().enumerate() {
            if at % usize::from(BLOCK_STRIDE) < each {
                *word = self.link.read(u32::from(RESULT_BASE) + at as u32)?;
            }
        }
        Ok(())
    }

    /// True if no result has come since these words were read: all of them belong to one instant.
    fn is_same(&mut self, words: &[u32]) -> Result<bool, Error<L::Error>> {
        for channel in 0..self.facts.channels {
            let status = self.link.read(word!(RESULT.status, channel))?;
            if status != words[usize::from(BLOCK_STRIDE) * channel] {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Reads the words while the card holds its results.
    fn look_held(&mut self, words: &mut [u32]) -> Result<(), Error<L::Error>> {
        let address = word!(CARD_CONFIG.hold);
        let hold = field!(CARD_CONFIG.hold.hold).mask();
        let free = self.link.read(address)? & !hold;
        let held = self.write_checked(address, free | hold);
        let looked = held.and_then(|()| self.look(words));
        // Release after every error, too: frozen results would be worse.
        let let_go = self.put_back(address, free);
        looked.and(let_go)
    }

    /// Triggers all channels that accept it. Two triggers must be at least a frame apart: `explain` prints the time.
    pub fn trigger(&mut self) -> Result<(), Error<L::Error>> {
        let trigger = field!(CARD.trigger_now.trigger).mask();
        self.link.write(word!(CARD.trigger_now), trigger)
    }

    /// Triggers, and waits until every channel has its result. Timer and pin may continue: each result belongs to this trigger or to a later one,
    /// and is not stale. [`Error::Timeout`]: at least one channel has no result, for example because its encoder is
    /// unplugged; [`Card::read_moment`] has the others, and that channel is stale.
    pub fn measure(&mut self, limit_us: u32) -> Result<Moment, Error<L::Error>> {
        self.measure_channels(u32::MAX, limit_us)
    }

    /// As [`Card::measure`] for some of the channels, bit n for channel n; it does not wait for the others.
    pub fn measure_channels(
        &mut self,
        channels: u32,
        limit_us: u32,
    ) -> Result<Moment, Error<L::Error>> {
        let before = self.read_moment()?;
        self.trigger()?;
        let mut wait = Wait::of_us(limit_us);
        loop {
            // The last poll comes after the last pause.
            let is_in_time = self.pause(&mut wait, RESULT_PAUSE_US);
            let mut moment = self.read_moment()?;
            moment.since(&before);
            let pairs = moment.results().iter().zip(before.results()).enumerate();
            let mut asked = pairs.filter(|(channel, _)| channels >> channel & 1 == 1);
            let any_new = asked
                .clone()
                .any(|(_, (now, then))| now.sequence != then.sequence);
            if any_new && asked.all(|(_, (now, _))| !now.stale) {
                return Ok(moment);
            }
            if !is_in_time {
                break;
            }
        }
        let sources = self.link.read(word!(CARD_CONFIG.trigger_sources))?;
        match field!(CARD_CONFIG.trigger_sources.register).of(sources) {
            0 => Err(Error::TriggerOff),
            _ => Err(Error::Timeout),
        }
    }

    /// Channels measure their line delay again with their next frame; bit n for channel n.
    pub fn calibrate(&mut self, channels: u32) -> Result<(), Error<L::Error>> {
        let word = field!(CARD.calibrate.channels).put(0, channels);
        let word = word.filter(|_| channels >> self.facts.channels == 0);
        let word = word.ok_or(Error::Argument)?;
        self.link.write(word!(CARD.calibrate), word)
    }

    /// Writes a word on which others depend, also after a failed access.
    pub(crate) fn put_back(&mut self, address: u32, value: u32) -> Result<(), Error<L::Error>> {
        let once = self.write_checked(address, value);
        once.or_else(|_| self.write_checked(address, value))
    }

    pub(crate) fn pause(&mut self, wait: &mut Wait, pause_us: u32) -> bool {
        wait.more(&mut self.delay, pause_us)
    }

    pub(crate) fn needs(&self, part: Part) -> Result<(), Error<L::Error>> {
        match self.facts.has(part) {
            true => Ok(()),
            false => Err(Error::Part(part)),
        }
    }

    /// Checks for an EnDat channel.
    pub(crate) fn needs_endat(&self, channel: usize) -> Result<(), Error<L::Error>> {
        self.needs_protocol(channel, Protocol::Endat)
    }

    /// Checks for a channel with this protocol.
    pub(crate) fn needs_protocol(
        &self,
        channel: usize,
        protocol: Protocol,
    ) -> Result<(), Error<L::Error>> {
        match channel < self.facts.channels {
            false => Err(Error::Argument),
            true if self.facts.protocol(channel) != protocol => Err(Error::Protocol),
            true => Ok(()),
        }
    }

    /// Checks for an EnDat channel with a service.
    pub(crate) fn needs_service(&self, channel: usize) -> Result<(), Error<L::Error>> {
        self.needs_endat(channel)?;
        self.needs(Part::Requests)
    }
}
