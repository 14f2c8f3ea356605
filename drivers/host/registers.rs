//! Registers by name: `result0.status`, `config1.frame.period_cycles`, `service0.request`.

use crate::HostError;
use endat_console::did_you_mean::closest;
use std::fmt;

pub use endat_regs::{Access, Block, Field, Named, Register, Values, BLOCKS};

/// A word of a card, or one of its fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Block of the word.
    pub block: &'static Block,
    /// Channel of the block, 0 for words of the card.
    pub channel: usize,
    /// The word.
    pub register: &'static Register,
    /// The field, if any.
    pub field: Option<&'static Field>,
}

/// At most 40 characters of the user's text.
fn shown(text: &str) -> String {
    let clean: String = text.chars().filter(|c| !c.is_control()).take(40).collect();
    format!("{clean:?}")
}

/// Most suggestions for a wrong name.
const PROPOSALS_MAX: usize = 4;

/// `; did you mean ...?`, or nothing: names that end with this one (without its block), else the closest names.
fn proposal(name: &str, channels: usize) -> String {
    let parts: Vec<&str> = name.split('.').collect();
    let (mut behind, mut others) = (Vec::new(), Vec::new());
    for block in BLOCKS {
        let typed = parts[0]
            .strip_prefix(block.name)
            .and_then(|n| n.parse().ok());
        let number = match block.per_channel {
            true => typed
                .filter(|n: &usize| *n < channels)
                .unwrap_or(0)
                .to_string(),
            false => String::new(),
        };
        for register in block.registers {
            let word = format!("{}{number}.{}", block.name, register.name);
            let fields = register.fields.iter().map(|f| format!("{word}.{}", f.name));
            for whole in std::iter::once(word.clone()).chain(fields) {
                if whole.ends_with(&format!(".{name}")) {
                    behind.push(whole);
                    continue;
                }
                if whole.split('.').count() == parts.len().max(2) {
                    others.push(whole);
                }
            }
        }
    }
    // A word in front of a field of another word.
    let parts_of = |whole: &String| whole.split('.').count();
    let fewest = behind.iter().map(parts_of).min();
    behind.retain(|whole| Some(parts_of(whole)) == fewest);
    // A name without a block is compared with names without theirs.
    let tail = |whole: &String| match parts.len() {
        1 => whole.find('.').map_or(0, |dot| dot + 1),
        _ => 0,
    };
    let mut names = match behind.is_empty() {
        true => closest(name, others, |whole| &whole[tail(whole)..]),
        false => behind,
    };
    names.truncate(PROPOSALS_MAX);
    match names.as_slice() {
        _ if name.is_empty() => String::new(),
        [] => String::new(),
        names => format!("; did you mean {}?", names.join(" or ")),
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}

impl Place {
    /// The place with this name, on a card with `channels` channels.
    pub fn named(name: &str, channels: usize) -> Result<Self, HostError> {
        Self::named_among(name, channels, |_| true)
    }

    /// As [`Self::named`], on a card with these blocks; only they are suggested for an unknown block.
    pub(crate) fn named_among(
        name: &str,
        channels: usize,
        has: impl Fn(&Block) -> bool,
    ) -> Result<Self, HostError> {
        // The suggestion comes before the list of names, which may be long.
        let fail = |what: String, names: String| {
            Err(HostError::Name(format!(
                "register = {}: {what}{} ({names})",
                shown(name),
                proposal(name, channels)
            )))
        };
        let mut parts = name.split('.');
        let block_name = parts.next().unwrap_or("");
        let stem = block_name.trim_end_matches(|c: char| c.is_ascii_digit());
        // The readable map calls the card's block `config`, too.
        let own_name = if block_name == "config" {
            "card_config"
        } else {
            block_name
        };
        let whole = |b: &&Block| !b.per_channel && b.name == own_name;
        let one = |b: &&Block| b.per_channel && b.name == stem;
        let Some(block) = BLOCKS.iter().find(|b| whole(b) || one(b)) else {
            let there = BLOCKS.iter().filter(|b| has(b));
            let names = there.map(|b| match b.per_channel {
                true => format!("{}0", b.name),
                false => b.name.to_owned(),
            });
            let names: Vec<String> = names.collect();
            return fail(
                format!("no block is called {}", shown(block_name)),
                format!(
                    "write BLOCK.REGISTER or BLOCK.REGISTER.FIELD; blocks are {}; 0 = channel",
                    names.join(", ")
                ),
            );
        };
        let number = &block_name[stem.len()..];
        let channel = match (block.per_channel, number.parse::<usize>()) {
            (false, _) => 0,
            (true, Ok(n)) if n < channels => n,
            (true, _) => {
                return fail(
                    format!("{stem} needs a channel"),
                    format!("write {stem}0 to {stem}{}", channels.max(1) - 1),
                )
            }
        };
        let Some(register_name) = parts.next() else {
            return fail(
                "names no register".into(),
                format!(
                    "{block_name} has {}",
                    list(block.registers.iter().map(|r| r.name))
                ),
            );
        };
        let Some(register) = block.register(register_name) else {
            return fail(
                format!("no register of that name in {block_name}"),
                format!("it has {}", list(block.registers.iter().map(|r| r.name))),
            );
        };
        let field = match parts.next() {
            None => None,
            Some(field) => match register.field(field) {
                Some(field) => Some(field),
                None => {
                    return fail(
                        format!("no field of that name in {block_name}.{register_name}"),
                        format!("it has {}", list(register.fields.iter().map(|f| f.name))),
                    )
                }
            },
        };
        match parts.next() {
            None => Ok(Self {
                block,
                channel,
                register,
                field,
            }),
            Some(_) => fail(
                "has too many parts".into(),
                "write BLOCK.REGISTER.FIELD".into(),
            ),
        }
    }

    /// All words of the map, for a card with `channels` channels; [`crate::Card::place`] checks whether the card has them.
    pub fn words(channels: usize) -> impl Iterator<Item = Self> {
        let numbers = move |block: &Block| 0..if block.per_channel { channels } else { 1 };
        BLOCKS.iter().flat_map(move |block| {
            numbers(block).flat_map(move |channel| {
                block.registers.iter().map(move |register| Self {
                    block,
                    channel,
                    register,
                    field: None,
                })
            })
        })
    }

    /// A word of the map; panics if it is missing.
    pub(crate) fn at(block: &str, register: &str, channel: usize) -> Self {
        let block = BLOCKS.iter().find(|b| b.name == block);
        let register = block.and_then(|b| Some((b, b.register(register)?)));
        let (block, register) = register.expect("a register of the map");
        Self {
            block,
            channel,
            register,
            field: None,
        }
    }

    /// A field of the map; panics if it is missing.
    pub(crate) fn field_at(block: &str, register: &str, field: &str, channel: usize) -> Self {
        let place = Self::at(block, register, channel);
        let field = place.register.field(field).expect("a field of the map");
        Self {
            field: Some(field),
            ..place
        }
    }

    /// Word address.
    pub fn address(&self) -> u16 {
        self.block.address(self.register, self.channel)
    }

    /// The number in a word: of the field, or the whole word.
    pub fn of(&self, word: u32) -> u32 {
        self.field.map_or(word, |f| f.of(word))
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.block.name)?;
        if self.block.per_channel {
            write!(f, "{}", self.channel)?;
        }
        write!(f, ".{}", self.register.name)?;
        self.field
            .map_or(Ok(()), |field| write!(f, ".{}", field.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_regs::Protocol;

    #[test]
    fn every_name_leads_to_its_place() {
        for block in BLOCKS {
            for register in block.registers {
                for field in register.fields {
                    let number = if block.per_channel { "1" } else { "" };
                    let name = format!("{}{number}.{}.{}", block.name, register.name, field.name);
                    let place = Place::named(&name, 2).unwrap();
                    assert_eq!(place.to_string(), name);
                    let shift = if block.per_channel { block.stride } else { 0 };
                    assert_eq!(place.address(), block.base + shift + register.offset);
                    assert_eq!(place.field, Some(field));
                }
            }
        }
    }

    #[test]
    fn a_wrong_name_is_answered_with_the_right_ones() {
        for (name, told) in [
            (
                "",
                "blocks are card, interrupt, recovery0, direct0, t_format0, card_config, config0",
            ),
            ("nothing.id", "blocks are card"),
            ("result.status", "result0 to result1"),
            ("result2.status", "result0 to result1"),
            (
                "result0",
                "names no register (result0 has status, position_low",
            ),
            ("result0.statu", "it has status, position_low"),
            ("result0.status.caus", "it has sequence, cause"),
            ("result0.status.cause.x", "too many parts"),
            ("card0.id", "blocks are card"),
            ("config.frame", "it has trigger_sources"),
        ] {
            let error = Place::named(name, 2).unwrap_err().to_string();
            assert!(error.contains(told), "{name}: {error}");
        }
    }

    #[test]
    fn a_name_without_its_block_or_with_a_slip_finds_the_right_one() {
        for (name, told) in [
            ("age_recovery", "; did you mean result0.age_recovery?"),
            (
                "status",
                "; did you mean interrupt.status or result0.status?",
            ),
            ("frame.command", "; did you mean config0.frame.command?"),
            (
                "trigger_perod",
                "; did you mean card_config.trigger_period?",
            ),
            ("result1.statsu", "; did you mean result1.status?"),
            (
                "result1.status.cuase",
                "; did you mean result1.status.cause?",
            ),
        ] {
            let error = Place::named(name, 2).unwrap_err().to_string();
            assert!(error.contains(&format!("{told} (")), "{name}: {error}");
        }
        let error = Place::named("quite.something_else", 2).unwrap_err();
        assert!(!error.to_string().contains("did you mean"), "{error}");
    }

    #[test]
    fn what_the_map_forbids_is_refused() {
        let of = |block, register, field, value, protocol| {
            let place = Place::field_at(block, register, field, 0);
            place.field.unwrap().refusal(value, protocol)
        };
        let frame = |field, value, protocol| of("config", "frame", field, value, protocol);
        assert_eq!(
            frame("position_bits", 49, Protocol::Endat).unwrap(),
            "1..48"
        );
        assert_eq!(frame("position_bits", 48, Protocol::Endat), None);
        assert_eq!(
            frame("position_bits", 49, Protocol::TFormat).unwrap(),
            "1..48"
        );
        assert_eq!(
            frame("period_cycles", 128, Protocol::TFormat).unwrap(),
            "8..127"
        );
        assert!(frame("command", 5, Protocol::Endat)
            .unwrap()
            .contains("send_position"));
        assert_eq!(frame("command", 0, Protocol::TFormat), None);
        let id = of("config", "timing", "request_id", 6, Protocol::TFormat);
        assert_eq!(id.unwrap(), "0..5, 7..12, 14..15");
        let period = of("card_config", "trigger_period", "value", 3, Protocol::Endat);
        assert_eq!(period.unwrap(), "4..16777215");
    }

    #[test]
    fn a_field_is_put_into_its_bits_alone() {
        let field = Place::field_at("config", "frame", "command", 0)
            .field
            .unwrap();
        assert_eq!(field.put(0xFFFF_FFFF, 7), Some(0xC7FF_FFFF));
        assert_eq!(field.put(0, 64), None);
        assert_eq!(field.of(0x0700_0000), 7);
        assert_eq!(
            field.told(0x0700_0000, Protocol::Endat).unwrap(),
            "000111 send position (EnDat 2.1)"
        );
    }
}
