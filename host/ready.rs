//! What a host does before it reads positions: waits until the card is ready, asks what a measuring step is and whether anything triggers.

use crate::card::Card;
use crate::mailbox::INITIALISATION;
use crate::name_plate::NamePlate;
use crate::transport::Transport;
use crate::units::Scale;
use crate::HostError;
use endat_regs::{Part, Protocol};
use std::time::{Duration, Instant};

/// An initialisation that takes longer is worth a word.
const LONG: Duration = Duration::from_secs(1);
/// First results come within this, if any come.
const FIRST_RESULTS: Duration = Duration::from_secs(1);

impl<T: Transport> Card<T> {
    /// What a measuring step of a channel is: as the encoder says, else as if the position were one turn.
    pub fn scale(&mut self, channel: usize) -> Result<Scale, HostError> {
        if let Some(scale) = Scale::of(self.identity().protocol(channel)) {
            return Ok(scale);
        }
        if self.identity().has(Part::Initialise) {
            if let Some(scale) = self.name_plate(channel)?.scale() {
                return Ok(scale);
            }
        }
        let bits = self.read_named(&format!("config{channel}.frame.position_bits"))?;
        Ok(Scale::singleturn(bits))
    }

    /// What a measuring step is, of every channel.
    pub fn scales(&mut self) -> Result<Vec<Scale>, HostError> {
        let channels = 0..self.identity().channels;
        channels.map(|channel| self.scale(channel)).collect()
    }

    /// Name plates; none of a channel whose encoder the card does not read.
    pub fn name_plates(&mut self) -> Result<Vec<Option<NamePlate>>, HostError> {
        let identity = *self.identity();
        let has =
            |n: usize| identity.has(Part::Initialise) && identity.protocol(n) == Protocol::Endat;
        let channels = 0..identity.channels;
        channels
            .map(|n| has(n).then(|| self.name_plate(n)).transpose())
            .collect()
    }

    /// Channels that speak EnDat.
    fn endat_channels(&self) -> Vec<usize> {
        let identity = self.identity();
        let all = 0..identity.channels;
        all.filter(|n| identity.protocol(*n) == Protocol::Endat)
            .collect()
    }

    /// Waits until no encoder is being initialised, or [`INITIALISATION`]; calls `is_long` once if it takes long. Whether one was.
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
            // Just after power-up the service has not begun.
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

    /// The same, and waits until every channel has had a first result, or has none after a second.
    pub fn settle(&mut self, is_long: impl FnOnce()) -> Result<(), HostError> {
        let has_waited = self.wait_until_initialised(is_long)?;
        // Behind an initialisation results are counted on from those before it.
        let before = match has_waited {
            true => self.sequences()?,
            false => vec![0; self.identity().channels],
        };
        let end = Instant::now() + FIRST_RESULTS;
        while Instant::now() < end {
            let now = self.sequences()?;
            let mut steps = now.iter().zip(&before).map(|(n, b)| n.wrapping_sub(*b));
            // The first frame measures the delay; the second one is as all others.
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

    /// Refuses a card that nothing triggers: recording sends nothing by itself, and nobody else has the link. `remedy` says how another source is enabled.
    pub fn needs_trigger(&mut self, remedy: &str) -> Result<(), HostError> {
        let sources = self.place("card_config.trigger_sources")?;
        let enabled = self.read(&sources)?;
        let is_set = |name| (sources.register.field(name)).is_some_and(|f| f.of(enabled) != 0);
        if is_set("pin") || is_set("timer") {
            return Ok(());
        }
        let what = match is_set("register") {
            true if self.may_run()? => return Ok(()),
            true => "only trigger_now triggers this card, and who records has the link, so there is nothing to record; enable another source",
            false => "no trigger is enabled, so there is nothing to record; enable one",
        };
        Err(HostError::Refused(format!("{what}, {remedy}")))
    }

    /// Whether a clock may be running, which gives positions without triggers.
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

    /// Reads the word or field of that name.
    pub fn read_named(&mut self, name: &str) -> Result<u32, HostError> {
        let place = self.place(name)?;
        self.read(&place)
    }
}
