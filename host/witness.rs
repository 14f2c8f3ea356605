//! Whether the card at the other end is still the one that it was, and has run on: asked after a silence, and when a lost link is back.

use crate::card::{Card, Identity};
use crate::registers::Place;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::ID;

/// What is known of a card from earlier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Witness {
    triggers: u32,
}

impl Witness {
    /// Remembers a card as it is now.
    pub fn new<T: Transport>(card: &mut Card<T>) -> Result<Self, HostError> {
        let triggers = card.read(&Place::at("card", "trigger_count", 0))?;
        Ok(Self { triggers })
    }

    /// Triggers since the card's reset, when it was last asked.
    pub fn triggers(&self) -> u32 {
        self.triggers
    }

    /// Asks the card: whether it has answered, and an error if it is another one, or has begun anew. Whatever was counted, its triggers
    /// and its time among it, does not go on then.
    pub fn ask<T: Transport>(&mut self, card: &mut Card<T>) -> Result<bool, HostError> {
        let Some((mut words, is_stopped)) = answer(card)? else {
            return Ok(false);
        };
        if !is_stopped && self.verdict(card.identity(), &words, false).is_err() {
            // Answers have no check: a byte may have been changed on its way.
            match answer(card)? {
                Some((again, _)) => words = again,
                None => return Ok(false),
            }
        }
        self.verdict(card.identity(), &words, is_stopped)?;
        self.triggers = triggers(&words);
        Ok(true)
    }

    fn verdict(&self, was: &Identity, words: &[u32], is_stopped: bool) -> Result<(), HostError> {
        let same = Identity::of(words).is_ok_and(|now| now == *was);
        if !same {
            return Err(HostError::Refused(format!(
                "another card answers: its configuration hash is 0x{:08X}, that of the card before 0x{:08X}",
                words[4], was.configuration_hash
            )));
        }
        let (before, now) = (self.triggers, triggers(words));
        if (now.wrapping_sub(before) as i32) < 0 {
            return Err(HostError::Refused(format!(
                "the card was restarted: it has counted {now} triggers since its reset, and had counted at least {before} before"
            )));
        }
        if is_stopped {
            return Err(HostError::Refused(
                "the card was restarted, or another program has used it: it does not push its stream any more".into(),
            ));
        }
        Ok(())
    }
}

/// Where the count of triggers stands.
fn place() -> usize {
    usize::from(Place::at("card", "trigger_count", 0).address())
}

fn triggers(words: &[u32]) -> u32 {
    words[place()]
}

/// The card's first words, and whether it pushes nothing although it should; none if nobody answers, or no card.
fn answer<T: Transport>(card: &mut Card<T>) -> Result<Option<(Vec<u32>, bool)>, HostError> {
    let count = place() + 1;
    let bridge = card.bridge();
    let damaged = bridge.decoder().damaged();
    let is_card = |words: &Vec<u32>| words[0] == ID;
    match bridge.read(0, count) {
        Ok(words) => return Ok(Some((words, false)).filter(|(words, _)| is_card(words))),
        Err(HostError::Silent { .. }) if bridge.pushes() => {}
        Err(HostError::Silent { .. }) => return Ok(None),
        Err(error) => return Err(error),
    }
    // A card that has begun anew pushes nothing, and its answers have no marker.
    bridge.set_pushes(false);
    match bridge.read(0, count) {
        Ok(words) if is_card(&words) => {
            bridge.forgive(damaged);
            Ok(Some((words, true)))
        }
        Ok(_) | Err(HostError::Silent { .. }) => {
            bridge.set_pushes(true);
            Ok(None)
        }
        Err(error) => Err(error),
    }
}
