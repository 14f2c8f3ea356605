//! Whether the card at the other end is still the one that it was, and has run on: asked after a silence, and when a lost link is back.

use crate::card::{Card, Identity};
use crate::registers::Place;
use crate::transport::Transport;
use crate::HostError;
use endat_regs::ID;
use std::hash::{BuildHasher, RandomState};

/// What is known of a card from earlier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Witness {
    triggers: u32,
    /// What was left in the card's scratch bits, which a reset clears: the count alone does not show a restart after which the card has
    /// soon counted more than before. None where it was not taken.
    mark: Option<u32>,
}

/// Registers of a card that has answered.
struct Answer {
    /// From the first on.
    words: Vec<u32>,
    /// None if it pushes nothing although it should.
    mark: Option<u32>,
}

impl Witness {
    /// Remembers a card as it is now, and marks it.
    pub fn new<T: Transport>(card: &mut Card<T>) -> Result<Self, HostError> {
        let triggers = card.read(&Place::at("card", "trigger_count", 0))?;
        let scratch = scratch();
        // Another one each time, so that a card of the same configuration is another one, too; 0 is what a reset leaves.
        let mark = 1.max(scratch.of(RandomState::new().hash_one(triggers) as u32));
        card.write(&scratch, mark)?;
        let mark = Some(mark).filter(|mark| card.read(&scratch).is_ok_and(|is| is == *mark));
        Ok(Self { triggers, mark })
    }

    /// Triggers since the card's reset, when it was last asked.
    pub fn triggers(&self) -> u32 {
        self.triggers
    }

    /// Asks the card: whether it has answered, and an error if it is another one, or has begun anew. Whatever was counted, its triggers
    /// and its time among it, does not go on then.
    pub fn ask<T: Transport>(&mut self, card: &mut Card<T>) -> Result<bool, HostError> {
        let Some(mut now) = answer(card)? else {
            return Ok(false);
        };
        if now.mark.is_some() && self.verdict(card.identity(), &now).is_err() {
            // Answers have no check: a byte may have been changed on its way.
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
                "the card was restarted, or another program has used it: it does not push its stream any more".into(),
            );
        };
        if self.mark.is_some_and(|was| was != mark) {
            return refused(format!(
                "the card was restarted, or another one is there, or another program has used it: what was left in {} is gone",
                scratch()
            ));
        }
        Ok(())
    }
}

/// The bits for a mark.
fn scratch() -> Place {
    Place::field_at("card_config", "hold", "scratch", 0)
}

/// Where the count of triggers stands.
fn place() -> usize {
    usize::from(Place::at("card", "trigger_count", 0).address())
}

impl Answer {
    fn triggers(&self) -> u32 {
        self.words[place()]
    }

    /// None if it is no card, or has fallen silent meanwhile; an error if nobody answers.
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

/// Whether these words are the first ones of a card.
fn is_card(words: &[u32]) -> bool {
    words[0] == ID
}

/// What the card answers; none if nobody answers, or no card.
fn answer<T: Transport>(card: &mut Card<T>) -> Result<Option<Answer>, HostError> {
    let damaged = card.bridge().decoder().damaged();
    match Answer::read(card) {
        Err(HostError::Silent { .. }) if card.bridge().pushes() => {}
        Err(HostError::Silent { .. }) => return Ok(None),
        now => return now,
    }
    // A card that has begun anew pushes nothing, and its answers have no marker. One that was only asleep may go on at any moment.
    let words = card.bridge().read_unmarked(place() + 1, is_card)?;
    Ok(words.map(|words| {
        card.bridge().set_pushes(false);
        card.bridge().forgive(damaged);
        Answer { words, mark: None }
    }))
}
