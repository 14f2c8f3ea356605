//! A card: identity, words by name, results.

use crate::bridge::Bridge;
use crate::name_plate::NamePlate;
use crate::range::Ranges;
use crate::registers::{Access, Block, Place};
use crate::result;
use crate::transport::Transport;
use crate::HostError;
use endat_driver::Reading;
use endat_regs::{result_words, Part, Protocol, Protocols, FEATURES_BITS, ID, VERSION};
use std::time::Duration;

/// Number of words of the identity.
pub(crate) const IDENTITY_WORDS: usize = 6;
/// The field of a channel's clock period.
const PERIOD: &str = "period_cycles";
/// Default timeout of a request: milliseconds on a real card, many seconds on a simulated one.
const PATIENCE: Duration = Duration::from_secs(20);

/// Identity of a card.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Major, minor and patch version of its register map.
    pub version: [u8; 3],
    /// Encoder ports.
    pub channels: usize,
    /// Widest position.
    pub max_position_bits: u32,
    /// Parts, bit by bit; see [`Identity::has`].
    pub features: u32,
    /// System clock: the unit of every number of cycles.
    pub system_hz: u32,
    /// Hash of the configuration from which it was generated.
    pub configuration_hash: u32,
    /// Protocol of each channel.
    pub protocols: Protocols,
    /// Stream sets include the additional data.
    pub stream_additional_data: bool,
}

impl Identity {
    /// Decodes the first words of a card's map.
    pub(crate) fn of(words: &[u32]) -> Result<Self, HostError> {
        if words[0] != ID {
            return Err(HostError::NoCard(format!(
                "word 0 is 0x{:08X}, not 0x{ID:08X}: this is not an EnDat card, or the baud rate differs (--baud)",
                words[0]
            )));
        }
        let [major, minor, ..] = words[1].to_be_bytes();
        let version = [major, minor, words[1] as u8];
        if major != VERSION[0] {
            return Err(HostError::NoCard(format!(
                "register map {major}.{minor}: this program supports {}.x; use the program that generated the card",
                VERSION[0]
            )));
        }
        let [high, low, bits, channels] = words[2].to_be_bytes();
        if channels == 0 || channels > 8 {
            return Err(HostError::NoCard(format!(
                "capabilities = 0x{:08X}: {channels} channels, outside 1..8; is the link disturbed?",
                words[2]
            )));
        }
        Ok(Self {
            version,
            channels: channels.into(),
            max_position_bits: bits.into(),
            features: u32::from(u16::from_be_bytes([high, low]))
                | (words[5] >> 16) << FEATURES_BITS,
            system_hz: words[3],
            configuration_hash: words[4],
            // 0 on cards with an older map: absent words read 0.
            protocols: Protocols::of_word(words[5]),
            stream_additional_data: words[5] >> 8 & 1 == 1,
        })
    }

    /// Parts of the card.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        let identity = *self;
        let all = Part::ALL.iter().copied();
        all.filter(move |part| identity.has(*part))
    }

    /// True if the card has a part.
    pub fn has(&self, part: Part) -> bool {
        self.features >> part as u32 & 1 == 1
    }

    /// Protocol of a channel.
    pub fn protocol(&self, channel: usize) -> Protocol {
        self.protocols.of(channel)
    }

    /// Protocol of the channel of a place; EnDat for words of the card.
    pub fn protocol_of(&self, place: &Place) -> Protocol {
        match place.block.per_channel {
            true => self.protocol(place.channel),
            false => Protocol::Endat,
        }
    }
}

/// Results of all channels at one instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Results {
    /// One for each channel.
    pub channels: Vec<Reading>,
}

/// A card at the other end of a link.
pub struct Card<T> {
    bridge: Bridge<T>,
    identity: Identity,
    patience: Duration,
    ranges: Ranges,
}

impl<T: Transport> Card<T> {
    /// Identifies the card at the link.
    pub fn find(mut bridge: Bridge<T>) -> Result<Self, HostError> {
        let mut words = bridge.read(0, IDENTITY_WORDS).unwrap_or_default();
        if words.first() != Some(&ID) {
            bridge.calm()?;
            let again = bridge.read(0, IDENTITY_WORDS);
            words = again.map_err(|error| match bridge.transport().refusal() {
                Some(why) => HostError::Refused(format!(
                    "{why}; end the program that uses it, or try again later"
                )),
                None => error,
            })?;
        }
        let identity = Identity::of(&words)?;
        Ok(Self {
            bridge,
            identity,
            patience: PATIENCE,
            ranges: Ranges::default(),
        })
    }

    /// Identity of the card.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// Word access to the card.
    pub fn bridge(&mut self) -> &mut Bridge<T> {
        &mut self.bridge
    }

    /// Timeout of a request.
    pub fn patience(&self) -> Duration {
        self.patience
    }

    /// Sets the timeout of requests.
    pub fn set_patience(&mut self, patience: Duration) {
        self.patience = patience;
    }

    /// Ranges given by the user; they override those of the card.
    pub fn ranges(&self) -> &Ranges {
        &self.ranges
    }

    /// Sets the position ranges of some channels.
    pub fn set_ranges(&mut self, ranges: Ranges) -> Result<(), HostError> {
        ranges.check(self.identity.channels)?;
        self.ranges = ranges;
        Ok(())
    }

    /// The place with this name on this card.
    pub fn place(&self, name: &str) -> Result<Place, HostError> {
        let lacks = |part: &Part| !self.identity.has(*part);
        let channels = 0..self.identity.channels;
        let has = |block: &Block| {
            block.part.is_none_or(|part| !lacks(&part))
                && channels
                    .clone()
                    .any(|n| self.identity.protocol(n).has(block))
        };
        let place = Place::named_among(name, self.identity.channels, has)?;
        let word = place
            .register
            .part
            .filter(lacks)
            .map(|part| (part, place.to_string()));
        let block = || {
            Some((
                place.block.part.filter(lacks)?,
                format!("block {}", place.block.name),
            ))
        };
        if let Some((part, what)) = block().or(word) {
            return Err(HostError::Name(format!(
                "register = {name:?}: this card has no {what}; emit one that has the part {} ({})",
                part.named().name,
                part.switch()
            )));
        }
        let protocol = self.identity.protocol(place.channel);
        if !protocol.has(place.block) {
            return Err(HostError::Name(format!(
                "register = {name:?}: channel {} speaks {}, which has no block {}; `endat id` shows the channels",
                place.channel,
                protocol.name(),
                place.block.name
            )));
        }
        Ok(place)
    }

    /// Reads a word, or the field of the place.
    pub fn read(&mut self, place: &Place) -> Result<u32, HostError> {
        Ok(place.of(self.bridge.read(place.address(), 1)?[0]))
    }

    /// Rejects a value that the map forbids for this word or field. [`Card::write`] accepts any that fits, and rejects read-only words.
    pub fn permits(&self, place: &Place, value: u32) -> Result<(), HostError> {
        if place.register.access == Access::ReadOnly {
            return Ok(());
        }
        let protocol = self.identity.protocol_of(place);
        let fields = place.register.fields.iter();
        let meant = fields
            .clone()
            .filter(|f| place.field.is_none_or(|one| one == *f));
        let known = fields.fold(0, |all, f| all | f.mask());
        // The card drops bits that the word does not have, and the write would look successful.
        if place.field.is_none() && value & !known != 0 {
            return Err(HostError::Name(format!(
                "value = {value}: {place} has no such bits; give bits of 0x{known:X}"
            )));
        }
        for field in meant {
            let number = match place.field {
                Some(_) => value,
                None => field.of(value),
            };
            let takes = match field.refusal(number, protocol) {
                // The map's limit applies to cards that sample DATA on both edges.
                None if field.name == PERIOD
                    && protocol == Protocol::Endat
                    && number < self.period_min() =>
                {
                    Some(format!("{}..{}", self.period_min(), field.mask()))
                }
                takes => takes,
            };
            if let Some(takes) = takes {
                return Err(HostError::Name(format!(
                    "value = {value}: {place} would have {} = {number}, which takes {takes}",
                    field.name
                )));
            }
        }
        Ok(())
    }

    /// Fewest system clocks in an EnDat clock period.
    fn period_min(&self) -> u32 {
        match self.identity.has(Part::DoubleEdge) {
            true => 2,
            false => 4,
        }
    }

    /// Writes a word, or changes the field of the place and keeps the others.
    pub fn write(&mut self, place: &Place, value: u32) -> Result<(), HostError> {
        if place.register.access == Access::ReadOnly {
            return Err(HostError::Name(format!(
                "register = {place}: is read only; nothing was written"
            )));
        }
        let word = match place.field {
            None => value,
            Some(field) => {
                let before = match place.register.access {
                    Access::Strobe => 0,
                    _ => self.bridge.read(place.address(), 1)?[0],
                };
                field.put(before, value).ok_or_else(|| {
                    HostError::Name(format!(
                        "value = {value}: does not fit {place}, which has {} bits; give 0 to {}",
                        field.width,
                        (1u64 << field.width) - 1
                    ))
                })?
            }
        };
        self.bridge.write(place.address(), &[word])
    }

    /// Results of all channels, from one instant. Each position is checked against its CRC again. A mismatch is read again; if it
    /// persists, the channel has no position and the cause `upset`.
    pub fn results(&mut self) -> Result<Results, HostError> {
        let mut results = self.read_results()?;
        if !results.channels.iter().all(|channel| channel.fits) {
            results = self.read_results()?;
        }
        for channel in &mut results.channels {
            *channel = channel.checked();
        }
        Ok(results)
    }

    fn read_results(&mut self) -> Result<Results, HostError> {
        let first = Place::at("result", "status", 0).address();
        let has_infos = self.identity.has(Part::Requests);
        let count = result_words(self.identity.channels, has_infos) as usize;
        let words = self.bridge.read(first, count)?;
        Ok(Results {
            channels: result::of_burst(
                &words,
                self.identity.channels,
                has_infos,
                self.identity.protocols,
            ),
        })
    }

    /// The name plate of a channel's encoder.
    pub fn name_plate(&mut self, channel: usize) -> Result<NamePlate, HostError> {
        self.needs_endat("name plate", channel)?;
        self.needs_requests("name plate")?;
        if !self.identity.has(Part::Initialise) {
            return Err(HostError::Part {
                what: "name plate",
                part: "initialise",
                remedy: "[service] parts = [\"requests\", \"initialise\"]",
            });
        }
        let at = |register| Place::at("service", register, channel);
        // Read the state first, so that the words it marks valid are valid when they are read.
        let state = self.bridge.read(at("progress").address(), 2)?;
        let (first, last) = (at("alarms").address(), at("delay").address());
        let words = self.bridge.read(first, usize::from(last - first) + 1)?;
        let field = |register: &str, field: &str, word: u32| {
            Place::field_at("service", register, field, 0).of(word)
        };
        let step = |name| Some(field("progress", name, state[0]) as u16).filter(|s| *s != 0);
        let word = |name: &str| {
            let word = words[usize::from(Place::at("service", name, channel).address() - first)];
            (word >> 16 & 1 == 1).then_some(word as u16)
        };
        Ok(NamePlate {
            initialised: field("state", "initialised", state[1]) == 1,
            endat22: field("state", "endat22", state[1]) == 1,
            step: step("step"),
            failed: step("failed"),
            delay_cycles: word("delay"),
            ..NamePlate::new(word)
        })
    }

    pub(crate) fn needs_endat(&self, what: &str, channel: usize) -> Result<(), HostError> {
        let protocol = self.identity.protocol(channel);
        if protocol == Protocol::Endat {
            return Ok(());
        }
        let (name, word) = (protocol.name(), protocol.row().word);
        let remedy = match protocol.row().part {
            Some(_) => format!(
                "its requests go through the words of {word}{channel} (`endat explain {word}`)"
            ),
            None => {
                "its encoders have nothing but positions; choose a channel that speaks EnDat".into()
            }
        };
        Err(HostError::Name(format!(
            "channel {channel}: {what}: the channel speaks {name}, which has none; {remedy}"
        )))
    }

    pub(crate) fn needs_requests(&self, what: &'static str) -> Result<(), HostError> {
        match self.identity.has(Part::Requests) {
            true => Ok(()),
            false => Err(HostError::Part {
                what,
                part: "requests",
                remedy: "[service] parts = [\"requests\", ...] (preset s6_two_channel_service)",
            }),
        }
    }
}
