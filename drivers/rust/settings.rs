//! Settings of channels, triggers and interrupts.

use crate::card::Card;
use crate::error::Error;
use crate::link::Link;
use crate::map::{field, word};
use embedded_hal::delay::DelayNs;
use endat_regs::{Field, Part, Protocol};

/// Fewest system clocks in an EnDat clock, if DATA is not sampled on both edges.
const SINGLE_EDGE_PERIOD_MIN: u32 = 4;

/// Settings of an EnDat channel; see the register map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// EnDat clock period: [`Card::period_cycles`].
    pub period_cycles: u32,
    /// Width of the position.
    pub position_bits: u32,
    /// Mode command of a trigger: [`endat_regs::protocol::ModeCommand::code`].
    pub command: u32,
    /// First low phase minus half a period.
    pub first_low_extra_cycles: u32,
    /// Tolerance of the start edge.
    pub start_window_cycles: u32,
    /// Pulses up to this length are ignored.
    pub filter_cycles: u32,
    /// Longest wait for the start bit.
    pub start_timeout_us: u32,
    /// DATA must fall within this time after the frame.
    pub recovery_limit_cycles: u32,
}

/// Trigger sources.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    /// Rising edges of the trigger pin.
    pub pin: bool,
    /// The timer.
    pub timer: bool,
    /// [`Card::trigger`] and [`Card::measure`].
    pub register: bool,
}

/// Word of a channel with a setting, and its field.
pub(crate) type Place = (usize, &'static Field);

/// Values of the words at these places.
pub(crate) fn values_at<const N: usize>(places: [Place; N], words: [u32; 3]) -> [u32; N] {
    places.map(|(word, field)| field.of(words[word]))
}

/// The words with these values at their places; `None` if a field does not allow its value.
pub(crate) fn put_at<const N: usize>(
    places: [Place; N],
    values: [u32; N],
    mut words: [u32; 3],
    protocol: Protocol,
) -> Option<[u32; 3]> {
    for ((word, field), value) in places.into_iter().zip(values) {
        if !field.allows(value, protocol) {
            return None;
        }
        words[word] = field.put(words[word], value)?;
    }
    Some(words)
}

/// Place of each setting.
fn places() -> [Place; 8] {
    [
        (0, field!(CHANNEL_CONFIG.frame.period_cycles)),
        (0, field!(CHANNEL_CONFIG.frame.position_bits)),
        (0, field!(CHANNEL_CONFIG.frame.command)),
        (1, field!(CHANNEL_CONFIG.timing.first_low_extra_cycles)),
        (1, field!(CHANNEL_CONFIG.timing.start_window_cycles)),
        (1, field!(CHANNEL_CONFIG.timing.filter_cycles)),
        (2, field!(CHANNEL_CONFIG.limits.start_timeout_us)),
        (2, field!(CHANNEL_CONFIG.limits.recovery_limit_cycles)),
    ]
}

impl Settings {
    fn of(words: [u32; 3]) -> Self {
        let [period_cycles, position_bits, command, first_low_extra_cycles, start_window_cycles, filter_cycles, start_timeout_us, recovery_limit_cycles] =
            values_at(places(), words);
        Self {
            period_cycles,
            position_bits,
            command,
            first_low_extra_cycles,
            start_window_cycles,
            filter_cycles,
            start_timeout_us,
            recovery_limit_cycles,
        }
    }

    fn values(&self) -> [u32; 8] {
        [
            self.period_cycles,
            self.position_bits,
            self.command,
            self.first_low_extra_cycles,
            self.start_window_cycles,
            self.filter_cycles,
            self.start_timeout_us,
            self.recovery_limit_cycles,
        ]
    }
}

impl<L: Link, D: DelayNs> Card<L, D> {
    /// Shortest clock period with a rate of at most `clock_hz`.
    pub const fn period_cycles(&self, clock_hz: u32) -> u32 {
        match clock_hz {
            0 => 0,
            _ => self.facts().system_hz.div_ceil(clock_hz),
        }
    }

    /// Reads the settings of a channel.
    pub fn read_settings(&mut self, channel: usize) -> Result<Settings, Error<L::Error>> {
        self.needs_endat(channel)?;
        Ok(Settings::of(self.settings_words(channel)?))
    }

    pub(crate) fn settings_words(&mut self, channel: usize) -> Result<[u32; 3], Error<L::Error>> {
        Ok([
            self.link.read(word!(CHANNEL_CONFIG.frame, channel))?,
            self.link.read(word!(CHANNEL_CONFIG.timing, channel))?,
            self.link.read(word!(CHANNEL_CONFIG.limits, channel))?,
        ])
    }

    /// Writes the settings while all trigger sources are disabled, and reads them back. Values that the map does not allow are rejected before writing.
    pub fn write_settings(
        &mut self,
        channel: usize,
        settings: &Settings,
    ) -> Result<(), Error<L::Error>> {
        self.needs_endat(channel)?;
        let least = match self.facts().has(Part::DoubleEdge) {
            true => 0,
            false => SINGLE_EDGE_PERIOD_MIN,
        };
        let widest = self.facts().max_position_bits;
        if settings.period_cycles < least || settings.position_bits > widest {
            return Err(Error::Argument);
        }
        let words = self.settings_words(channel)?;
        let words =
            put_at(places(), settings.values(), words, Protocol::Endat).ok_or(Error::Argument)?;
        // A frame between two writes would use half of the settings.
        self.without_triggers(|card| card.write_settings_words(channel, words))
    }

    /// Executes an action while all trigger sources are disabled.
    pub(crate) fn without_triggers(
        &mut self,
        act: impl FnOnce(&mut Self) -> Result<(), Error<L::Error>>,
    ) -> Result<(), Error<L::Error>> {
        let address = word!(CARD_CONFIG.trigger_sources);
        let sources = self.link.read(address)?;
        let disabled = field!(CARD_CONFIG.trigger_sources.disabled).mask();
        let stopped = self.write_checked(address, sources & disabled);
        let done = stopped.and_then(|()| act(self));
        // Restore after every error, too.
        let given_back = self.put_back(address, sources);
        done.and(given_back)
    }

    pub(crate) fn write_settings_words(
        &mut self,
        channel: usize,
        [frame, timing, limits]: [u32; 3],
    ) -> Result<(), Error<L::Error>> {
        self.write_checked(word!(CHANNEL_CONFIG.frame, channel), frame)?;
        self.write_checked(word!(CHANNEL_CONFIG.timing, channel), timing)?;
        self.write_checked(word!(CHANNEL_CONFIG.limits, channel), limits)
    }

    /// Enables trigger sources, and sets the period of the timer, if given, while it is stopped. After an error the sources are
    /// restored, unless the link has failed for that, too.
    pub fn set_triggers(
        &mut self,
        sources: Sources,
        period_cycles: Option<u32>,
    ) -> Result<(), Error<L::Error>> {
        let fields = [
            (field!(CARD_CONFIG.trigger_sources.pin), sources.pin),
            (field!(CARD_CONFIG.trigger_sources.timer), sources.timer),
            (
                field!(CARD_CONFIG.trigger_sources.register),
                sources.register,
            ),
        ];
        let period = field!(CARD_CONFIG.trigger_period.value);
        if period_cycles.is_some_and(|cycles| !period.allows(cycles, Protocol::Endat)) {
            return Err(Error::Argument);
        }
        let address = word!(CARD_CONFIG.trigger_sources);
        let before = self.link.read(address)?;
        if let Some(cycles) = period_cycles {
            let word = period.put(0, cycles).ok_or(Error::Argument)?;
            let stopped = self.write_checked(address, before & !fields[1].0.mask());
            let period = word!(CARD_CONFIG.trigger_period);
            let written = stopped.and_then(|()| self.write_checked(period, word));
            if let Err(error) = written {
                self.put_back(address, before)?;
                return Err(error);
            }
        }
        let with = |word: u32, (field, is_on): (&Field, bool)| match is_on {
            true => word | field.mask(),
            false => word & !field.mask(),
        };
        self.put_back(address, fields.into_iter().fold(before, with))
    }

    /// Selects the events that assert `irq_o`: the word `interrupt.mask`.
    pub fn enable_interrupts(&mut self, events: u32) -> Result<(), Error<L::Error>> {
        self.needs(Part::Interrupt)?;
        self.write_checked(word!(INTERRUPT.mask), events)
    }

    /// Reads the events (the word `interrupt.status`), and clears exactly these: for an interrupt routine.
    pub fn take_interrupts(&mut self) -> Result<u32, Error<L::Error>> {
        self.needs(Part::Interrupt)?;
        let events = self.link.read(word!(INTERRUPT.status))?;
        // Clear only the events that were read; new ones remain.
        if events != 0 {
            self.link.write(word!(INTERRUPT.clear), events)?;
        }
        Ok(events)
    }
}
