//! `monitor`: positions, rate, health and margin, live.

use super::super::number::{decimal_if, number_if};
use super::super::Outcome;
use super::read::{shown, verdict};
use super::{interrupted, settled, told, AnyCard, PortArgs};
use crate::error::GenError;
use clap::Args;
use endat_driver::Reading;
use endat_host::registers::Place;
use endat_host::units::Scale;
use endat_regs::Part;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Arguments of `monitor`.
#[derive(Args)]
pub struct MonitorArgs {
    #[command(flatten)]
    port: PortArgs,
    /// Show so many times [default: until Ctrl-C]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    count: Option<String>,
    /// Seconds from one to the next [default: 0.2]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    every: Option<String>,
}

/// What is looked up once.
#[derive(Default)]
struct Places {
    /// Counters of frames, good ones first, and how many words until that of additional data with a wrong CRC.
    frames: Option<(Place, usize)>,
    state: Option<Place>,
    worst: Option<Place>,
}

impl Places {
    fn new(card: &AnyCard) -> Result<Self, GenError> {
        let named =
            |is_there: bool, name: &str| is_there.then(|| super::place(card, name)).transpose();
        let identity = card.identity();
        // Of the first EnDat channel; the others have the same words.
        let first = (0..identity.channels).find(|n| !identity.is_t_format(*n));
        let Some(n) = first else {
            return Ok(Self::default());
        };
        let frames = named(
            identity.has(Part::Requests),
            &format!("service{n}.frames_good"),
        )?;
        let last = named(
            identity.has(Part::Requests),
            &format!("service{n}.bad_infos"),
        )?;
        Ok(Self {
            frames: frames.zip(last).map(|(first, last)| {
                let words = usize::from(last.address() - first.address());
                (first, words)
            }),
            state: named(identity.has(Part::Requests), &format!("service{n}.state"))?,
            worst: named(identity.has(Part::Margin), &format!("line{n}.worst"))?,
        })
    }
}

/// The flags of a word that are set; a number of it is none.
fn flags(place: &Place, word: u32) -> String {
    let fields = place.register.fields.iter();
    let set = fields.filter(|f| f.width == 1 && f.of(word) == 1);
    let names: Vec<&str> = set.map(|f| f.name).collect();
    match names.is_empty() {
        true => "-".into(),
        false => names.join(", "),
    }
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

fn screen(
    card: &mut AnyCard,
    places: &Places,
    scales: &[Scale],
    before: &mut Vec<Reading>,
) -> Result<String, GenError> {
    let results = card.results().map_err(told)?.channels;
    let system_hz = f64::from(card.identity().system_hz.max(1));
    let mut text = String::new();
    for (channel, (r, scale)) in results.iter().zip(scales).enumerate() {
        let _ = writeln!(
            text,
            "channel {channel}  {:<28} {}",
            shown(r, scale),
            verdict(r)
        );
        let rate = before.get(channel).and_then(|b| rate(b, r, system_hz));
        let rate = rate.map_or("-".into(), |hz| format!("{hz:.0}"));
        let ns = |cycles: u16| f64::from(cycles) * 1e9 / system_hz;
        let _ = write!(text, "           {rate} results/s, age {} us", r.age_us);
        if card.identity().is_t_format(channel) {
            text.push('\n');
            continue;
        }
        let _ = writeln!(
            text,
            ", line delay {:.0} ns, recovery time {:.2} us",
            ns(r.delay_cycles),
            ns(r.recovery_cycles) / 1e3
        );
        let good = r.infos.iter().enumerate();
        let good = good.filter_map(|(n, info)| Some((n + 1, info.good()?)));
        let infos: Vec<String> = good
            .map(|(n, info)| format!("{n}: 0x{:04X} (status 0x{:02X})", info.content, info.status))
            .collect();
        if !infos.is_empty() {
            let _ = writeln!(text, "           additional data {}", infos.join(", "));
        }
        if let Some((first, words)) = places.frames {
            let words = card
                .bridge()
                .read(of(&first, channel).address(), words + 1)
                .map_err(told)?;
            // The last two count no frames: comparisons of positions, additional data.
            let (counts, others) = words.split_at(words.len() - 2);
            let all: u64 = counts.iter().map(|c| u64::from(*c)).sum();
            let _ = write!(text, "           frames {all}, good {}", counts[0]);
            for (cause, count) in counts.iter().enumerate().skip(1).filter(|(_, c)| **c > 0) {
                let _ = write!(text, ", {} {count}", endat_host::causes::name(cause as u8));
            }
            if others[1] > 0 {
                let _ = write!(text, "; additional data with a wrong CRC {}", others[1]);
            }
            text.push('\n');
        }
        if let Some(state) = &places.state {
            let word = card.read(&of(state, channel)).map_err(told)?;
            let _ = writeln!(text, "           state: {}", flags(state, word));
        }
        if let Some(worst) = &places.worst {
            let word = card.read(&of(worst, channel)).map_err(told)?;
            let [_, _, latest, earliest] = word.to_be_bytes().map(|b| b as i8);
            let has_edges = worst
                .register
                .field("valid")
                .is_some_and(|f| f.of(word) == 1);
            let edges = match has_edges {
                true => format!("{earliest} to {latest} places from where they are expected,"),
                false => "none".into(),
            };
            let _ = writeln!(text, "           edges: {edges} since cleared");
        }
    }
    let retries = card.bridge().retries();
    if retries > 0 {
        let s = if retries == 1 { "" } else { "s" };
        let _ = writeln!(text, "link: {retries} answer{s} asked for again");
    }
    *before = results;
    Ok(text)
}

/// Runs the command.
pub fn run(arguments: &MonitorArgs) -> Result<Outcome, GenError> {
    let count = number_if("--count", &arguments.count, 1..=u64::from(u32::MAX))?;
    let every = decimal_if("--every", &arguments.every, 0.0..=3_600.0)?;
    let every = Duration::from_secs_f64(every.unwrap_or(0.2));
    let mut card = arguments.port.open()?;
    settled(&mut card)?;
    let scales = card.scales().map_err(told)?;
    let places = Places::new(&card)?;
    let stop = interrupted();
    let mut stdout = std::io::stdout();
    let is_live = stdout.is_terminal();
    let mut before = Vec::new();
    let mut done = 0;
    while !stop.load(Ordering::Relaxed) && count != Some(done) {
        let begin = Instant::now();
        let text = match screen(&mut card, &places, &scales, &mut before) {
            // A card that is unplugged may come back.
            Err(error @ GenError::CheckFailed(_)) => format!("{error}\n"),
            other => other?,
        };
        // From the top of the screen, and nothing left below: no flicker.
        let text = match is_live {
            true => format!("\x1b[H{}\x1b[J", text.replace('\n', "\x1b[K\n")),
            false => text + "\n",
        };
        if stdout
            .write_all(text.as_bytes())
            .and_then(|()| stdout.flush())
            .is_err()
        {
            break;
        }
        done += 1;
        if count != Some(done) {
            std::thread::sleep(every.saturating_sub(begin.elapsed()));
        }
    }
    Ok(Outcome::default())
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
        assert_eq!(flags(&state, word), "-");
        let word = field("initialised").put(word, 1).unwrap();
        assert_eq!(flags(&state, word), "initialised");
    }
}
