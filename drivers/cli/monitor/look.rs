//! One look at a card: what `monitor` shows, whatever it shows it on.

use crate::port::{place, told, AnyCard};
use crate::read;
use endat_console::error::CommandError;
use endat_driver::Reading;
use endat_host::registers::Place;
use endat_regs::{Part, Protocol};
use serde_json::{json, Value};

/// Frames of a channel since they were cleared.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    pub all: u64,
    pub good: u64,
    /// Causes that there were, with how often.
    pub causes: Vec<(&'static str, u64)>,
    /// Additional data with a wrong CRC.
    pub bad_infos: u64,
}

/// What a channel shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seen {
    pub reading: Reading,
    /// Results per second; none if no time has passed since the last look.
    pub rate_hz: Option<f64>,
    /// Line delay in ns and recovery time in us, of EnDat.
    pub times: Option<(f64, f64)>,
    pub frames: Option<Frames>,
    /// Flags of the service that are set.
    pub state: Option<Vec<&'static str>>,
    /// The earliest and the latest edge, in places from where they are expected; none inside if there were no edges.
    pub edges: Option<Option<(i8, i8)>>,
}

/// All of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Look {
    pub channels: Vec<Seen>,
    /// Answers of the link that were asked for again.
    pub retries: u64,
}

/// Looks at a card again and again.
#[derive(Default)]
pub struct Watcher {
    /// Counters of frames, good ones first, and how many words until that of additional data with a wrong CRC.
    frames: Option<(Place, usize)>,
    state: Option<Place>,
    worst: Option<Place>,
    before: Vec<Reading>,
}

/// The flags of a word that are set; a number of it is none.
fn flags(place: &Place, word: u32) -> Vec<&'static str> {
    let fields = place.register.fields.iter();
    let set = fields.filter(|f| f.width == 1 && f.of(word) == 1);
    set.map(|f| f.name).collect()
}

/// The same place of another channel.
fn of(place: &Place, channel: usize) -> Place {
    Place { channel, ..*place }
}

/// Results per second, from two looks at a channel; none if no time has passed between their positions.
fn rate(before: &Reading, now: &Reading, system_hz: f64) -> Option<f64> {
    let results = now.sequence.wrapping_sub(before.sequence);
    let cycles = now.timestamp.wrapping_sub(before.timestamp);
    (cycles > 0).then(|| f64::from(results) * system_hz / f64::from(cycles))
}

impl Watcher {
    /// Looks up the names once.
    pub fn new(card: &AnyCard) -> Result<Self, CommandError> {
        let named = |is_there: bool, name: &str| is_there.then(|| place(card, name)).transpose();
        let identity = card.identity();
        // Of the first EnDat channel; the others have the same words.
        let first = (0..identity.channels).find(|n| identity.protocol(*n) == Protocol::Endat);
        let Some(n) = first else {
            return Ok(Self::default());
        };
        let has_service = identity.has(Part::Requests);
        let frames = named(has_service, &format!("service{n}.frames_good"))?;
        let last = named(has_service, &format!("service{n}.bad_infos"))?;
        Ok(Self {
            frames: frames.zip(last).map(|(first, last)| {
                let words = usize::from(last.address() - first.address());
                (first, words)
            }),
            state: named(has_service, &format!("service{n}.state"))?,
            worst: named(identity.has(Part::Margin), &format!("line{n}.worst"))?,
            before: Vec::new(),
        })
    }

    /// A look.
    pub fn look(&mut self, card: &mut AnyCard) -> Result<Look, CommandError> {
        let results = card.results().map_err(told)?.channels;
        let mut channels = Vec::with_capacity(results.len());
        for (channel, reading) in results.iter().enumerate() {
            channels.push(self.seen(card, channel, reading)?);
        }
        self.before = results;
        Ok(Look {
            channels,
            retries: card.bridge().retries(),
        })
    }

    fn seen(
        &self,
        card: &mut AnyCard,
        channel: usize,
        reading: &Reading,
    ) -> Result<Seen, CommandError> {
        let system_hz = f64::from(card.identity().system_hz.max(1));
        let before = self.before.get(channel);
        let mut seen = Seen {
            reading: *reading,
            rate_hz: before.and_then(|before| rate(before, reading, system_hz)),
            ..Seen::default()
        };
        if card.identity().protocol(channel) != Protocol::Endat {
            return Ok(seen);
        }
        let ns = |cycles: u16| f64::from(cycles) * 1e9 / system_hz;
        seen.times = Some((ns(reading.delay_cycles), ns(reading.recovery_cycles) / 1e3));
        if let Some((first, words)) = self.frames {
            let first = of(&first, channel).address();
            let words = card.bridge().read(first, words + 1).map_err(told)?;
            // The last two count no frames: comparisons of positions, additional data.
            let (counts, others) = words.split_at(words.len() - 2);
            let causes = counts.iter().enumerate().skip(1).filter(|(_, n)| **n > 0);
            let causes = causes.map(|(c, n)| (endat_host::causes::name(c as u8), u64::from(*n)));
            seen.frames = Some(Frames {
                all: counts.iter().map(|c| u64::from(*c)).sum(),
                good: counts[0].into(),
                causes: causes.collect(),
                bad_infos: others[1].into(),
            });
        }
        if let Some(state) = &self.state {
            let word = card.read(&of(state, channel)).map_err(told)?;
            seen.state = Some(flags(state, word));
        }
        if let Some(worst) = &self.worst {
            let word = card.read(&of(worst, channel)).map_err(told)?;
            let [_, _, latest, earliest] = word.to_be_bytes().map(|b| b as i8);
            let valid = worst.register.field("valid");
            let has_edges = valid.is_some_and(|f| f.of(word) == 1);
            seen.edges = Some(has_edges.then_some((earliest, latest)));
        }
        Ok(seen)
    }
}

impl Seen {
    /// Additional data that came with the position: which, content and status.
    pub fn infos(&self) -> impl Iterator<Item = (usize, u16, u8)> + '_ {
        let all = self.reading.infos.iter().enumerate();
        all.filter_map(|(n, info)| {
            let info = info.good()?;
            Some((n + 1, info.content, info.status))
        })
    }
}

impl Look {
    /// As data.
    pub fn json(&self, scales: &[endat_host::units::Scale]) -> Value {
        let channels = self.channels.iter().zip(scales).enumerate();
        let channels = channels.map(|(channel, (seen, scale))| {
            let frames = seen.frames.as_ref().map(|f| {
                let causes = f
                    .causes
                    .iter()
                    .map(|(name, n)| ((*name).to_owned(), json!(n)));
                json!({
                    "all": f.all,
                    "good": f.good,
                    "causes": causes.collect::<serde_json::Map<_, _>>(),
                    "bad_additional_data": f.bad_infos,
                })
            });
            let infos = seen.infos();
            let infos = infos.map(
                |(n, content, status)| json!({"number": n, "content": content, "status": status}),
            );
            let mut object = read::json(channel, &seen.reading, scale);
            object["result_hz"] = json!(seen.rate_hz);
            object["line_delay_ns"] = json!(seen.times.map(|t| t.0));
            object["recovery_us"] = json!(seen.times.map(|t| t.1));
            object["additional_data"] = json!(infos.collect::<Vec<_>>());
            object["frames"] = json!(frames);
            object["state"] = json!(seen.state);
            object["edges"] = json!(seen.edges.flatten().map(|(first, last)| [first, last]));
            object
        });
        json!({"channels": channels.collect::<Vec<_>>(), "link_retries": self.retries})
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_comes_from_the_cards_own_time() {
        let at = |sequence, timestamp| Reading {
            sequence,
            timestamp,
            ..Reading::default()
        };
        let hz = rate(&at(0xFFFF, 0xFFFF_0000), &at(99, 0x0000_0000), 65_536.0);
        assert_eq!(hz, Some(100.0));
        assert_eq!(rate(&at(1, 5), &at(1, 5), 1e6), None);
    }

    /// Catches the count of starts, which is 1 after power-up, as if it were a state.
    #[test]
    fn a_number_is_no_flag() {
        let state = Place::named("service0.state", 1).unwrap();
        let field = |name| state.register.field(name).unwrap();
        let word = field("starts").put(0, 1).unwrap();
        assert!(flags(&state, word).is_empty());
        let word = field("initialised").put(word, 1).unwrap();
        assert_eq!(flags(&state, word), ["initialised"]);
    }
}
