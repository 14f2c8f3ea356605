//! Preparation before positions are read: waits until the card is ready, determines position ranges, and checks for a trigger.

use crate::card::Card;
use crate::mailbox::INITIALISATION;
use crate::name_plate::NamePlate;
use crate::registers::Place;
use crate::transport::Transport;
use crate::units::Scale;
use crate::HostError;
use endat_driver::Range;
use endat_regs::{Part, Protocol};
use std::time::{Duration, Instant};

/// The user is informed about a longer initialisation.
const LONG: Duration = Duration::from_secs(1);
/// Timeout for first results.
const FIRST_RESULTS: Duration = Duration::from_secs(1);

impl<T: Transport> Card<T> {
    /// Scale of a channel: from [`Card::set_ranges`], else from the encoder, else from the configuration. With it a
    /// note if the last two differ.
    pub fn scale(&mut self, channel: usize) -> Result<(Scale, Option<String>), HostError> {
        let protocol = self.identity().protocol(channel);
        let plate = match self.identity().has(Part::Initialise) && protocol == Protocol::Endat {
            true => Some(self.name_plate(channel)?),
            false => None,
        };
        let words = self
            .bridge()
            .read(Place::at("config", "frame", channel).address(), 3)?;
        let words: [u32; 3] = words.try_into().unwrap_or_default();
        let bits = Place::field_at("config", "frame", "position_bits", channel).of(words[0]);
        let own = plate.as_ref().and_then(NamePlate::scale);
        let width = plate.and_then(|plate| plate.position_bits).unwrap_or(bits);
        let said = self.ranges().scale(channel, protocol, Some(width))?;
        let configured = Scale::of_range(Range::of_words(words, protocol));
        Ok(match (said, own, configured) {
            // Equal, with the step in addition.
            (Some(Scale::Counted), Some(own @ Scale::Linear { .. }), _) => (own, None),
            (Some(said), ..) => (said, None),
            (None, Some(own), Some(configured)) if !own.agrees(&configured) => {
                let text = format!(
                    "channel {channel}: the configuration says {configured}, the encoder {own}: the encoder's is used; correct single_turn_bits, multi_turn_bits or linear"
                );
                (own, Some(text))
            }
            (None, Some(own), _) => (own, None),
            (None, None, Some(configured)) => (configured, None),
            (None, None, None) => {
                let turns_at = protocol.row().turns_at;
                (Scale::Counts { turns_at }, None)
            }
        })
    }

    /// The scale of every channel.
    pub fn scales(&mut self) -> Result<Vec<Scale>, HostError> {
        let channels = 0..self.identity().channels;
        let all = channels.map(|channel| Ok(self.scale(channel)?.0));
        all.collect()
    }

    /// Notes about contradictions.
    pub fn scale_notes(&mut self) -> Result<Vec<String>, HostError> {
        let channels = 0..self.identity().channels;
        let notes = channels.map(|channel| Ok(self.scale(channel)?.1));
        let notes: Result<Vec<_>, HostError> = notes.collect();
        Ok(notes?.into_iter().flatten().collect())
    }

    /// Name plates; `None` for a channel whose encoder the card does not read.
    pub fn name_plates(&mut self) -> Result<Vec<Option<NamePlate>>, HostError> {
        let identity = *self.identity();
        let has =
            |n: usize| identity.has(Part::Initialise) && identity.protocol(n) == Protocol::Endat;
        let channels = 0..identity.channels;
        channels
            .map(|n| has(n).then(|| self.name_plate(n)).transpose())
            .collect()
    }

    /// EnDat channels.
    fn endat_channels(&self) -> Vec<usize> {
        let identity = self.identity();
        let all = 0..identity.channels;
        all.filter(|n| identity.protocol(*n) == Protocol::Endat)
            .collect()
    }

    /// Waits until no encoder is being initialised, or [`INITIALISATION`]; calls `is_long` once if it takes long. Returns true if one was.
    pub fn wait_until_initialised(&mut self, is_long: impl FnOnce()) -> Result<bool, HostError> {
        if !self.identity().has(Part::Initialise) {
            return Ok(false);
        }
        let mut has_waited = false;
        let begin = Instant::now();
        let mut is_long = Some(is_long);
        for channel in self.endat_channels() {
            let state = |field| format!("service{channel}.state.{field}");
            let running = self.place(&state("initialising"))?;
            // Just after power-up the service has not started yet.
            let starts = self.place(&state("starts"))?;
            while (self.read(&running)? == 1 || self.read(&starts)? == 0)
                && begin.elapsed() < INITIALISATION
            {
                has_waited = true;
                if begin.elapsed() > LONG {
                    if let Some(tell) = is_long.take() {
                        tell();
                    }
                }
            }
        }
        Ok(has_waited)
    }

    /// As [`Self::wait_until_initialised`]; then waits until every channel has a first result, or a second has passed.
    pub fn settle(&mut self, is_long: impl FnOnce()) -> Result<(), HostError> {
        let has_waited = self.wait_until_initialised(is_long)?;
        // After an initialisation the sequence numbers continue from the earlier ones.
        let before = match has_waited {
            true => self.sequences()?,
            false => vec![0; self.identity().channels],
        };
        let end = Instant::now() + FIRST_RESULTS;
        while Instant::now() < end {
            let now = self.sequences()?;
            let mut steps = now.iter().zip(&before).map(|(n, b)| n.wrapping_sub(*b));
            // The first frame measures the delay; the second one is a normal frame.
            if steps.all(|steps| steps > 1) {
                break;
            }
        }
        Ok(())
    }

    /// The number of every channel's last result.
    fn sequences(&mut self) -> Result<Vec<u16>, HostError> {
        let results = self.results()?;
        Ok(results.channels.iter().map(|r| r.sequence).collect())
    }

    /// Rejects a card without a trigger: a recording sends no triggers, and no other program has the link. `remedy` says how to enable another source.
    pub fn needs_trigger(&mut self, remedy: &str) -> Result<(), HostError> {
        let sources = self.place("card_config.trigger_sources")?;
        let enabled = self.read(&sources)?;
        let is_set = |name| (sources.register.field(name)).is_some_and(|f| f.of(enabled) != 0);
        if is_set("pin") || is_set("timer") {
            return Ok(());
        }
        let what = match is_set("register") {
            true if self.may_run()? => return Ok(()),
            true => "only trigger_now triggers this card, and a recording occupies the link, so there is nothing to record; enable another source",
            false => "no trigger is enabled, so there is nothing to record; enable one",
        };
        Err(HostError::Refused(format!("{what}, {remedy}")))
    }

    /// True if a continuous clock may be running, which gives positions without triggers.
    fn may_run(&mut self) -> Result<bool, HostError> {
        if !self.identity().has(Part::Continuous) {
            return Ok(false);
        }
        for channel in self.endat_channels() {
            if self.read_named(&format!("service{channel}.continuous.go_on"))? == 1 {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Reads the word or field with this name.
    pub fn read_named(&mut self, name: &str) -> Result<u32, HostError> {
        let place = self.place(name)?;
        self.read(&place)
    }
}
