//! Checks that the card at the link is still the same and has not restarted: asked after a silence, and after a lost link is back.

use crate::card::{Card, Identity};
use crate::registers::Place;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::ID;
use std::hash::{BuildHasher, RandomState};

/// Known state of a card from earlier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Witness {
    triggers: u32,
    /// Mark in the card's scratch bits, which a reset clears. The count alone does not show a restart after which the card has
    /// soon counted more than before. `None` if the card did not accept it.
    mark: Option<u32>,
}

/// Registers of a card that has answered.
struct Answer {
    /// Words from the first one on.
    words: Vec<u32>,
    /// `None` if the card does not push although it should.
    mark: Option<u32>,
}

impl Witness {
    /// Records the present state of a card, and marks it.
    pub fn new<T: Transport>(card: &mut Card<T>) -> Result<Self, HostError> {
        let triggers = card.read(&Place::at("card", "trigger_count", 0))?;
        let scratch = scratch();
        // A different mark each time, so that a card with the same configuration is recognised as another one; a reset leaves 0.
        let mark = 1.max(scratch.of(RandomState::new().hash_one(triggers) as u32));
        card.write(&scratch, mark)?;
        let mark = Some(mark).filter(|mark| card.read(&scratch).is_ok_and(|is| is == *mark));
        Ok(Self { triggers, mark })
    }

    /// Triggers since the card's reset, when last asked.
    pub fn triggers(&self) -> u32 {
        self.triggers
    }

    /// Asks the card: true if it has answered, and an error if it is another one, or has restarted. Its counts, such as triggers
    /// and time, do not continue then.
    pub fn ask<T: Transport>(&mut self, card: &mut Card<T>) -> Result<bool, HostError> {
        let Some(mut now) = answer(card)? else {
            return Ok(false);
        };
        if now.mark.is_some() && self.verdict(card.identity(), &now).is_err() {
            // Answers have no check sum: a byte may have been changed on its way.
            match answer(card)? {
                Some(again) => now = again,
                None => return Ok(false),
            }
        }
        self.verdict(card.identity(), &now)?;
        self.triggers = now.triggers();
        Ok(true)
    }

    fn verdict(&self, was: &Identity, now: &Answer) -> Result<(), HostError> {
        let refused = |what: String| Err(HostError::Refused(what));
        if !Identity::of(&now.words).is_ok_and(|now| now == *was) {
            return refused(format!(
                "another card answers: its configuration hash is 0x{:08X}, that of the card before 0x{:08X}",
                now.words[4], was.configuration_hash
            ));
        }
        let before = self.triggers;
        let count = now.triggers();
        if (count.wrapping_sub(before) as i32) < 0 {
            return refused(format!(
                "the card was restarted: it has counted {count} triggers since its reset, and had counted at least {before} before"
            ));
        }
        let Some(mark) = now.mark else {
            return refused(
                "the card was restarted, or another program has used it: it no longer pushes its stream".into(),
            );
        };
        if self.mark.is_some_and(|was| was != mark) {
            return refused(format!(
                "the card was restarted, or replaced, or another program has used it: the mark in {} is gone",
                scratch()
            ));
        }
        Ok(())
    }
}

/// The scratch bits.
fn scratch() -> Place {
    Place::field_at("card_config", "hold", "scratch", 0)
}

/// Address of the trigger count.
fn place() -> usize {
    usize::from(Place::at("card", "trigger_count", 0).address())
}

impl Answer {
    fn triggers(&self) -> u32 {
        self.words[place()]
    }

    /// `None` if it is not a card, or has stopped answering; an error if nothing answers.
    fn read<T: Transport>(card: &mut Card<T>) -> Result<Option<Self>, HostError> {
        let words = card.bridge().read(0, place() + 1)?;
        let mark = match card.read(&scratch()) {
            Err(HostError::Silent { .. }) => return Ok(None),
            mark => mark?,
        };
        Ok(is_card(&words).then_some(Self {
            words,
            mark: Some(mark),
        }))
    }
}

/// True if these words are the first ones of a card.
fn is_card(words: &[u32]) -> bool {
    words[0] == ID
}

/// The card's answer; `None` if nothing, or not a card, answers.
fn answer<T: Transport>(card: &mut Card<T>) -> Result<Option<Answer>, HostError> {
    let damaged = card.bridge().decoder().damaged();
    match Answer::read(card) {
        Err(HostError::Silent { .. }) if card.bridge().pushes() => {}
        Err(HostError::Silent { .. }) => return Ok(None),
        now => return now,
    }
    // A restarted card pushes nothing, and its answers have no marker. One that only paused may continue at any moment.
    let words = card.bridge().read_unmarked(place() + 1, is_card)?;
    Ok(words.map(|words| {
        card.bridge().set_pushes(false);
        card.bridge().forgive(damaged);
        Answer { words, mark: None }
    }))
}
