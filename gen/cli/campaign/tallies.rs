//! Campaigns that count what becomes of each case: parts, tables, budgets.

use super::{fault, CampaignArgs, Name};
use endat_campaign::card::{CardSubject, CardUpsets};
use endat_campaign::configurations::Configurations;
use endat_campaign::part::{merge, shard, Part};
use endat_campaign::{budget, reference, report};
use endat_console::error::{shorten, shown, CommandError};
use endat_console::number::{number, number_if};
use endat_sim::campaign::faults::Faults;
use endat_sim::campaign::garbage::{AcceptSet, Garbage, WIDEST_BITS};
use endat_sim::campaign::other::{ssi, t_format, OtherFrames, OtherUpsets};
use endat_sim::campaign::port::Port;
use endat_sim::campaign::upsets::{Draw, Upsets};
use endat_sim::campaign::{count, Campaign, CampaignError, Joined, Shard};
use endat_terminal::outcome::Outcome;
use std::time::Instant;

/// Most moments of a frame, and most quarter bits between two faults.
const MOMENTS_MAX: u64 = 1_000_000;
/// Most cases of a campaign.
const CASES_MAX: u64 = 1_000_000_000_000;
/// Moments of each kind of frame, if not told.
const MOMENTS_USUAL: u64 = 65;
/// Cases of `garbage`, if not told.
const GARBAGE_USUAL: &str = "1000000";
/// Valid configurations of `configurations`, if not told.
const CONFIGURATIONS_USUAL: &str = "5000";
/// What `--quick` takes of each.
const QUICK_CASES: u64 = 12_800;
const QUICK_CONFIGURATIONS: u64 = 10;
const QUICK_STEP: u64 = 50;
const QUICK_BITS: u32 = 5;

/// Runs such a campaign, or puts parts of one together.
pub fn run(arguments: &CampaignArgs, seed: u64) -> Result<Outcome, CommandError> {
    match arguments.name {
        Name::Merge => merged(arguments),
        _ => one(arguments, seed),
    }
}

/// Runs a part of a campaign, or all of it.
fn one(arguments: &CampaignArgs, seed: u64) -> Result<Outcome, CommandError> {
    let part = arguments.shard.as_deref().map(shard).transpose();
    let part = part.map_err(|e| CommandError::input(format!("--shard = {e}")))?;
    let threads = arguments.threads.count()?;
    let (name, plan, campaign) = match arguments.name {
        Name::Configurations => {
            let configurations = configurations(arguments, seed)?;
            if let Some(index) = &arguments.case {
                return alone(&configurations, index);
            }
            let plan = format!("seed {seed}");
            ("configurations", plan, Box::new(configurations) as _)
        }
        _ => {
            let (name, plan, campaign) = chosen(arguments, seed)?;
            (name, plan, campaign?)
        }
    };
    let start = Instant::now();
    let part = Part::run(
        name,
        plan,
        campaign.as_ref(),
        part.unwrap_or(Shard::WHOLE),
        threads,
    );
    let seconds = start.elapsed().as_secs_f64();
    let cases = part.shard.cases(part.identity.cases);
    let (cases, all) = (cases.end - cases.start, part.identity.cases);
    if let Some(path) = &arguments.out {
        part.write(path)?;
    }
    let mut outcome = summary(&part);
    outcome.stdout += &format!("\n{cases} of {all} cases in {seconds:.1} s\n");
    Ok(outcome)
}

/// The campaign over configurations that is asked for.
fn configurations(arguments: &CampaignArgs, seed: u64) -> Result<Configurations, CommandError> {
    let told = arguments.cases.as_deref().unwrap_or(CONFIGURATIONS_USUAL);
    let valid = match arguments.quick {
        true => QUICK_CONFIGURATIONS,
        false => number("--cases", told, 1..=MOMENTS_MAX)?,
    };
    Configurations::new(valid, seed)
}

/// One configuration: the text, and what was said about it.
fn alone(configurations: &Configurations, index: &str) -> Result<Outcome, CommandError> {
    let case = number("--case", index, 0..=configurations.cases() - 1)?;
    let found = configurations.case(case);
    Ok(Outcome {
        stdout: format!("{}\n", found.text.trim_end()),
        exit_code: u8::from(!found.is_good()),
        messages: found.told,
    })
}

/// Tables and budgets; a budget that must hold and does not is a failure.
fn summary(part: &Part) -> Outcome {
    let (lines, holds) = budget::lines(&part.identity.campaign, &part.tally);
    let is_whole = part.shard == Shard::WHOLE;
    let campaign = part.identity.campaign.as_str();
    Outcome {
        stdout: report::text(campaign, &part.tally) + &lines,
        exit_code: u8::from(is_whole && !holds),
        ..Outcome::default()
    }
}

fn merged(arguments: &CampaignArgs) -> Result<Outcome, CommandError> {
    let named = |path: &std::path::PathBuf| Ok((path.display().to_string(), Part::read(path)?));
    let parts: Result<Vec<_>, CommandError> = arguments.parts.iter().map(named).collect();
    let whole = merge(parts?)?;
    if let Some(path) = &arguments.out {
        whole.write(path)?;
    }
    Ok(summary(&whole))
}

type Made = Result<Box<dyn Campaign>, CommandError>;

fn boxed<C: Campaign + 'static>(made: Result<C, CampaignError>) -> Made {
    let made = made.map_err(|e| fault(&e))?;
    Ok(Box::new(made) as Box<dyn Campaign>)
}

/// What upsets are of.
struct Subjects {
    ports: Vec<Port>,
    is_t_format: bool,
    is_ssi: bool,
    is_ssi_special: bool,
    card: Option<CardSubject>,
}

/// Each subject but the first one gets an eighth of the random cases.
const SHARE: u64 = 8;

/// Upsets of these subjects.
fn upsets(subjects: &Subjects, draw: Draw, seed: u64, only: &str) -> Made {
    let mut makers: Vec<Box<dyn Fn(Draw) -> Made + '_>> = vec![];
    if !subjects.ports.is_empty() {
        makers.push(Box::new(|draw| {
            boxed(Upsets::new(&subjects.ports, draw, seed, only))
        }));
    }
    if subjects.is_t_format {
        makers.push(Box::new(|draw| {
            boxed(OtherUpsets::<t_format::TFormat>::new(draw, seed, only))
        }));
    }
    if subjects.is_ssi {
        makers.push(Box::new(|draw| {
            boxed(OtherUpsets::<ssi::Ssi<false>>::new(draw, seed, only))
        }));
    }
    if subjects.is_ssi_special {
        makers.push(Box::new(|draw| {
            boxed(OtherUpsets::<ssi::Ssi<true>>::new(draw, seed, only))
        }));
    }
    if let Some(card) = subjects.card {
        makers.push(Box::new(move |draw| {
            Ok(Box::new(CardUpsets::new(card, draw, seed, only)?) as _)
        }));
    }
    let others = makers.len().saturating_sub(1) as u64;
    let made = makers.iter().enumerate().map(|(n, make)| {
        make(match (draw, n) {
            (Draw::Random { cases }, 0) => Draw::Random {
                cases: cases - others * (cases / SHARE),
            },
            (Draw::Random { cases }, _) => Draw::Random {
                cases: cases / SHARE,
            },
            (grid, _) => grid,
        })
    });
    Ok(Box::new(Joined(made.collect::<Result<_, _>>()?)))
}

/// Spoilt frames of the T-format port, and of the SSI port, for each of EnDat's, if those are there, too.
const SPOILT_SHARE: u64 = 40;

/// Spoilt frames of each port of another protocol.
fn of_others(subjects: &Subjects, cases: u64) -> u64 {
    match subjects.ports.is_empty() {
        true => cases,
        false => cases / SPOILT_SHARE,
    }
}

/// Frames that are disturbed, of EnDat ports and of the others that are asked for.
fn disturbed(
    subjects: &Subjects,
    of_ports: Result<Box<dyn Campaign>, CommandError>,
    of_t_format: impl FnOnce() -> Result<OtherFrames<t_format::TFormat>, CampaignError>,
    of_ssi: impl FnOnce() -> Result<OtherFrames<ssi::Ssi<false>>, CampaignError>,
) -> Made {
    let mut joined = vec![];
    if !subjects.ports.is_empty() {
        joined.push(of_ports?);
    }
    if subjects.is_t_format {
        joined.push(boxed(of_t_format())?);
    }
    if subjects.is_ssi {
        joined.push(boxed(of_ssi())?);
    }
    Ok(Box::new(Joined(joined)))
}

/// The campaign that is asked for: its name and its plan, in words.
fn chosen(
    arguments: &CampaignArgs,
    seed: u64,
) -> Result<(&'static str, String, Made), CommandError> {
    let chosen = arguments.subject.as_deref();
    let is_t_format = chosen.is_none_or(|name| name == t_format::SUBJECT);
    let is_ssi = chosen.is_none_or(|name| name == ssi::SUBJECT);
    let is_ssi_special = chosen.is_none_or(|name| name == ssi::SUBJECT_SPECIAL);
    let card = chosen.map_or(Some(CardSubject::Plain), CardSubject::named);
    let ports: Vec<Port> = match chosen {
        Some(name) => Port::named().filter(|port| port.name() == name).collect(),
        None => Port::ALL.to_vec(),
    };
    let is_upsets = matches!(arguments.name, Name::Upsets);
    let has_others = is_t_format || is_ssi;
    let has_more = card.is_some() || is_ssi_special;
    if ports.is_empty() && !(has_others || is_upsets && has_more) {
        let mut names: Vec<&str> = Port::named().map(Port::name).collect();
        names.extend([t_format::SUBJECT, ssi::SUBJECT]);
        if is_upsets {
            names.push(ssi::SUBJECT_SPECIAL);
            names.extend(CardSubject::ALL.map(CardSubject::name));
        }
        return Err(CommandError::input(format!(
            "--subject = {}: is no subject of this campaign; take one of {}",
            shown(chosen.unwrap_or_default()),
            names.join(", ")
        )));
    }
    let subject = arguments.subject.as_deref().unwrap_or("all");
    let cases = |usual: Option<&str>| match (arguments.quick, arguments.cases.as_deref().or(usual))
    {
        (true, _) => Ok(Some(QUICK_CASES)),
        (_, Some(text)) => number("--cases", text, 1..=CASES_MAX).map(Some),
        _ => Ok(None),
    };
    let subjects = Subjects {
        ports,
        is_t_format,
        is_ssi,
        is_ssi_special,
        card,
    };
    Ok(match arguments.name {
        Name::Faults => {
            let step = match (arguments.quick, &arguments.step) {
                (true, _) => QUICK_STEP,
                (_, Some(step)) => number("--step", step, 1..=MOMENTS_MAX)?,
                _ => 1,
            };
            let plan = format!("step {step}; seed {seed}; subject {subject}");
            let of_ports = boxed(Faults::new(&subjects.ports, step, seed));
            let made = disturbed(
                &subjects,
                of_ports,
                || OtherFrames::faults(step, seed),
                || OtherFrames::faults(step, seed),
            );
            ("faults", plan, made)
        }
        Name::Garbage => {
            let cases = cases(Some(GARBAGE_USUAL))?.unwrap_or(QUICK_CASES);
            let plan = format!("seed {seed}; subject {subject}");
            let others = of_others(&subjects, cases);
            let made = disturbed(
                &subjects,
                boxed(Garbage::new(&subjects.ports, cases, seed)),
                || OtherFrames::garbage(others, seed),
                || OtherFrames::garbage(others, seed),
            );
            ("garbage", plan, made)
        }
        Name::Accept => {
            let widest = match arguments.quick {
                true => QUICK_BITS,
                false => WIDEST_BITS,
            };
            let made = AcceptSet::new(widest, reference::position);
            ("accept", format!("1 to {widest} bits"), boxed(made))
        }
        _ => {
            let draw = match cases(None)? {
                Some(cases) => Draw::Random { cases },
                None => Draw::Grid {
                    moments: number_if("--moments", &arguments.moments, 1..=MOMENTS_MAX)?
                        .unwrap_or(MOMENTS_USUAL),
                },
            };
            let only = arguments.only.as_deref().unwrap_or_default();
            let how = match draw {
                Draw::Random { .. } => "random".to_owned(),
                Draw::Grid { moments } => format!("moments {moments}"),
            };
            let plan = format!("{how}; seed {seed}; subject {subject}; only {only}*");
            let of = |only: &str| {
                let made = upsets(&subjects, draw, seed, only)?;
                match count(made.as_ref()) {
                    0 => Err(CommandError::input(format!(
                        "--only = {}: no register of --subject {subject} begins like this; `campaign upsets` prints their blocks, or leave it out",
                        shorten(only)
                    ))),
                    _ => Ok(made),
                }
            };
            // Each of several beginnings, by itself, too: a wrong one would be missing in silence.
            let several = only.split(',').filter(|_| only.contains(','));
            for begin in several {
                of(begin)?;
            }
            let made = of(only);
            ("upsets", plan, made)
        }
    })
}
