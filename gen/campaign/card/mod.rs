//! Upsets of a whole card: two channels with requests, a stream, the link, and a host beside them that knows the card from its pages only.
//!
//! Of the [plain](CardSubject::Plain) card the flip-flops of the two channels are those of the ports' campaign, and are left to it; of the
//! card with [every monitor](CardSubject::Safety) all are inverted, and a second controller reads at the second interface.

mod host;
mod judge;
mod line;
mod second;
mod subject;
mod told;

pub use subject::{in_channel, CardSubject};

use endat_console::error::CommandError;
use endat_hdl::card::config_ring::RING_WORDS;
use endat_hdl::config::CardConfig;
use endat_hdl::endat::service::map::word;
use endat_hdl::regs::config_words;
use endat_sim::bench::{LaneBench, LaneUart, Link, PinNames};
use endat_sim::campaign::port::{is_count, Class, Mark};
use endat_sim::campaign::upsets::{is_asked, Draw, Flops};
use endat_sim::campaign::{digest, Campaign, Row, Tally, ABORT_US};
use endat_sim::encoder::{AnswerKind, Encoder, EncoderConfig};
use endat_sim::line::LineConfig;
use endat_sim::{Time, NS, US};
use host::{BIT_CYCLES, FRAME};
use judge::{Judge, Noted, Shot};
use line::Host;
use rtl_design::engine::{Keep, LaneWords, Lanes};
use second::Masters;
use std::ops::Range;
use std::sync::OnceLock;
use subject::{configuration, design};
use told::{Kind, Known, Seen, Verdict, What};

/// Channels of the card.
const CHANNELS: usize = 2;
/// Configuration words of the card, and of each channel.
const CONFIG_WORDS: usize = RING_WORDS;
/// Settings of a service that decide what becomes of positions.
const SERVICE_WORDS: [u8; 3] = [word::FORCE, word::LIMITS, word::CONTINUOUS];
/// Width of the encoders' positions.
const POSITION_BITS: u32 = 25;
const SYSTEM_HZ: u64 = 32_000_000;
const CYCLES_PER_US: u64 = SYSTEM_HZ / 1_000_000;
const CYCLE: Time = US / CYCLES_PER_US;
const LANES: usize = 128;
/// Cycles for which the trigger pin is held.
const PULSE: u64 = 4;
/// A frame with a longer period measures the delay.
const SLOW: Time = 500 * NS;
/// A host that has not come to an end by then never will: many times what the longest one takes.
const LONGEST: u64 = 8_000_000;

/// A card in each lane, with its encoders, and what the hosts do at its pins.
#[derive(Clone)]
struct Bench {
    bench: LaneBench,
    uart: LaneUart,
    /// Of a card with a second interface.
    second: Option<Masters>,
    /// Lanes whose trigger pin is HIGH, until when.
    pulses: Vec<(u64, usize)>,
    /// What was taken of the encoders' logs.
    frames: Vec<[usize; CHANNELS]>,
    violations: Vec<[usize; CHANNELS]>,
}

impl Bench {
    fn new(engine: Lanes, card: &CardConfig) -> Self {
        let port = |channel: usize| {
            let mut encoder = EncoderConfig::endat22(POSITION_BITS).seed(channel as u64 + 1);
            encoder.tm = 1_500 * NS..=1_500 * NS;
            encoder.tac = 0..=0;
            encoder.write_time = 0..=0;
            encoder.reset_time = 0;
            let link = Link::new(LineConfig::cable(20.0), encoder);
            (PinNames::card(channel), vec![link; LANES])
        };
        let mut bench = LaneBench::new(engine, SYSTEM_HZ, (0..CHANNELS).map(port).collect());
        let uart = LaneUart::new(&mut bench, BIT_CYCLES);
        let second = (card.safety.second_interface).then(|| Masters::new(&mut bench));
        Self {
            bench,
            uart,
            second,
            pulses: vec![],
            frames: vec![[0; CHANNELS]; LANES],
            violations: vec![[0; CHANNELS]; LANES],
        }
    }

    fn cycle(&self) -> u64 {
        self.bench.cycle()
    }

    /// Bytes that a host sends, and its trigger.
    fn act(&mut self, lane: usize, (bytes, trigger): (Vec<u8>, bool)) {
        self.uart.send(lane, &bytes);
        if trigger {
            self.bench.set("trigger_i", lane, 1);
            let now = self.cycle();
            self.pulses.push((now + PULSE, lane));
            if let Some(second) = &mut self.second {
                second.ask(lane, now + FRAME);
            }
        }
    }

    fn tick(&mut self) {
        let now = self.cycle();
        while let Some(index) = self.pulses.iter().position(|p| p.0 <= now) {
            let (_, lane) = self.pulses.swap_remove(index);
            self.bench.set("trigger_i", lane, 0);
        }
        if let Some(second) = &mut self.second {
            second.drive(&mut self.bench);
        }
        self.uart.tick(&mut self.bench);
    }

    /// What the encoders of a lane have noted since they were asked.
    fn noted(&mut self, lane: usize) -> Noted {
        let mut noted = Noted::default();
        if let Some(second) = &mut self.second {
            noted.answers = second.take(lane);
        }
        for channel in 0..CHANNELS {
            let encoder = self.bench.link(channel, lane).encoder();
            let frames = &mut self.frames[lane][channel];
            noted.shots[channel] = shots(encoder, *frames);
            *frames = encoder.frames().len();
            let violations = &mut self.violations[lane][channel];
            for (_, violation) in &encoder.violations()[*violations..] {
                match is_count(violation) {
                    true => noted.pulses = true,
                    false => noted.rules = true,
                }
            }
            *violations = encoder.violations().len();
        }
        noted
    }
}

/// Positions that an encoder sent, from a frame on.
fn shots(encoder: &Encoder, from: usize) -> Vec<Shot> {
    let (mut shots, mut first) = (vec![], None);
    let cycle = |time: Time| (time / CYCLE) as u32;
    let positions = encoder.frames()[from..].iter();
    for frame in positions.filter(|f| f.kind == AnswerKind::Position) {
        let fall = cycle(frame.first_fall);
        let begun = first.take().unwrap_or(fall);
        if frame.period > SLOW {
            first = Some(begun);
        }
        shots.push(Shot {
            first: begun,
            fall,
            position: frame.position,
        });
    }
    shots
}

/// A lane with its host and its judge.
struct Lane {
    host: Host<Seen, Verdict>,
    judge: Judge,
    known: Option<Known>,
    /// When what goes on at the flip began, and when it had ended.
    begun: u64,
    acted: Option<u64>,
    wake_at: u64,
    is_done: bool,
}

impl Lane {
    fn new(host: Host<Seen, Verdict>, judge: Judge) -> Self {
        Self {
            host,
            judge,
            known: None,
            begun: 0,
            acted: None,
            wake_at: 0,
            is_done: false,
        }
    }

    /// The host goes on as far as it can.
    fn go_on(&mut self, bench: &mut Bench, lane: usize) {
        loop {
            self.is_done = self.host.go_on(bench.cycle());
            bench.act(lane, self.host.acts());
            self.wake_at = self.host.wake_at();
            let Some(seen) = self.host.seen().filter(|_| !self.is_done) else {
                return;
            };
            let noted = bench.noted(lane);
            let verdict = self.judge.take(&seen, noted);
            match seen.what {
                What::Ready(known) => self.known = Some(*known),
                What::Begun => self.begun = bench.cycle(),
                What::Acted(_) => self.acted = self.acted.or(Some(bench.cycle())),
                _ => {}
            }
            if verdict == Verdict::GiveUp || self.judge.class == Class::Hang {
                self.is_done = true;
                return;
            }
            self.host.answer(verdict);
        }
    }
}

/// Runs all lanes to their ends, with flips in order.
fn run(bench: &mut Bench, lanes: &mut [Lane], flips: &[Flip]) {
    let end = bench.cycle() + LONGEST;
    let mut flips = flips.iter().peekable();
    let mut wake = 0;
    loop {
        let cycle = bench.cycle();
        while let Some((_, lane, register, bit)) = flips.next_if(|f| f.0 <= cycle) {
            bench.bench.upset(*register, *bit, *lane);
        }
        let bytes = bench.uart.take();
        for (lane, byte) in &bytes {
            if let Some(lane) = lanes.get_mut(*lane) {
                lane.host.hear(cycle, *byte);
                lane.wake_at = cycle;
            }
        }
        if !bytes.is_empty() || wake <= cycle {
            wake = u64::MAX;
            for (index, lane) in lanes.iter_mut().enumerate().filter(|(_, l)| !l.is_done) {
                if lane.wake_at <= cycle {
                    lane.go_on(bench, index);
                }
                if !lane.is_done {
                    wake = wake.min(lane.wake_at);
                }
            }
            if wake == u64::MAX {
                return;
            }
        }
        if cycle >= end {
            let open = lanes.iter_mut().filter(|l| !l.is_done);
            open.for_each(|l| l.judge.hang());
            return;
        }
        bench.tick();
    }
}

/// Cards with which a host works, all alike up to here.
struct Ready {
    bench: Bench,
    known: Known,
    judge: Judge,
}

impl Ready {
    fn new(pushes: bool, engine: Lanes, card: &CardConfig) -> Self {
        let blocks = std::iter::once(None).chain((0..CHANNELS).map(Some));
        let words: Vec<_> = blocks.map(|block| config_words(card, block)).collect();
        let mut bench = Bench::new(engine, card);
        (0..CYCLES_PER_US * (ABORT_US + 10)).for_each(|_| bench.tick());
        let lane = |_| {
            let words = words.clone();
            let program = |line| async move {
                let host = host::Host::new(line, Known::default());
                host.prepare(pushes, words).await;
            };
            Lane::new(Host::new(program), Judge::default())
        };
        let mut lanes: Vec<Lane> = (0..LANES).map(lane).collect();
        run(&mut bench, &mut lanes, &[]);
        let first = lanes.swap_remove(0);
        let mut judge = first.judge;
        judge.begin();
        Self {
            known: first.known.unwrap_or_default(),
            judge,
            bench,
        }
    }

    /// Runs so many lanes with these flips.
    fn all(&self, kind: Kind, count: usize, flips: &[Flip]) -> Vec<Lane> {
        let mut bench = self.bench.clone();
        let start = bench.cycle();
        let lane = |_| {
            let known = self.known.clone();
            let program = |line| host::Host::new(line, known).case(kind);
            Lane::new(Host::new(program), self.judge.clone())
        };
        let mut lanes: Vec<Lane> = (0..count).map(lane).collect();
        let mut flips = flips.to_vec();
        flips.iter_mut().for_each(|f| f.0 += start);
        flips.sort_unstable();
        run(&mut bench, &mut lanes, &flips);
        lanes
    }

    /// From when to when what a kind is of goes on, without a flip.
    fn window(&self, kind: Kind) -> (u64, u64) {
        let lane = self.all(kind, 1, &[]).remove(0);
        let marks: Vec<&str> = lane.judge.marks().map(Mark::name).collect();
        assert_eq!(
            (lane.judge.class, marks),
            (Class::Masked, vec![]),
            "{kind:?}"
        );
        let from = self.bench.cycle();
        (
            lane.begun - from,
            lane.acted.unwrap_or(lane.begun) - lane.begun,
        )
    }
}

/// Cycle, lane, register and bit.
type Flip = (u64, usize, usize, usize);

struct Group {
    kind: Kind,
    /// When it begins, and how long it lasts.
    window: OnceLock<(u64, u64)>,
    cases: u64,
}

/// The campaign.
pub struct CardUpsets {
    subject: CardSubject,
    card: CardConfig,
    engine: Lanes,
    /// Without and with a stream that is pushed.
    ready: [OnceLock<Ready>; 2],
    flops: Flops,
    groups: Vec<Group>,
    draw: Draw,
    seed: u64,
    digest: u64,
}

impl CardUpsets {
    /// Upsets of registers [that are asked for](is_asked).
    pub fn new(
        subject: CardSubject,
        draw: Draw,
        seed: u64,
        only: &str,
    ) -> Result<Self, CommandError> {
        let card = configuration(subject)?;
        let design = design(&card)?;
        let engine = Lanes::new(&design, Keep::Registers, LaneWords::Two)
            .map_err(|e| CommandError::fault("campaign", &e))?;
        let is_of_card = |name: &str| subject.has_monitors() || in_channel(name).is_none();
        let chosen = |name: &str| is_asked(name, only) && is_of_card(name);
        let flops = Flops::filtered(&engine, chosen);
        let count = Kind::ALL.len() as u64;
        let group = |(index, kind): (usize, Kind)| Group {
            kind,
            window: OnceLock::new(),
            cases: flops.cases(match draw {
                Draw::Random { cases } => Draw::Random {
                    cases: cases / count + u64::from((index as u64) < cases % count),
                },
                grid => grid,
            }),
        };
        Ok(Self {
            groups: Kind::ALL.into_iter().enumerate().map(group).collect(),
            digest: digest(&design),
            subject,
            card,
            engine,
            ready: [OnceLock::new(), OnceLock::new()],
            flops,
            draw,
            seed,
        })
    }
}

impl Campaign for CardUpsets {
    fn digest(&self) -> u64 {
        self.digest
    }

    fn groups(&self) -> Vec<u64> {
        self.groups.iter().map(|g| g.cases).collect()
    }

    fn run(&self, group: usize, cases: Range<u64>) -> Tally {
        let group = &self.groups[group];
        let kind = group.kind;
        let pushes = kind == Kind::Stream;
        let ready = self.ready[usize::from(pushes)]
            .get_or_init(|| Ready::new(pushes, self.engine.clone(), &self.card));
        let (begun, span) = *group.window.get_or_init(|| ready.window(kind));
        let label = format!("{} {}", self.subject.name(), kind.name());
        let case = |number| self.flops.case(self.draw, self.seed, &label, span, number);
        let drawn: Vec<(usize, u64)> = cases.map(case).collect();
        let flip = |(lane, (index, cycle)): (usize, &(usize, u64))| {
            let (register, bit) = self.flops.bits[*index];
            (begun + cycle, lane, register, bit)
        };
        let flips: Vec<_> = drawn.iter().enumerate().map(flip).collect();
        let mut tally = Tally::default();
        let outcomes = ready.all(kind, drawn.len(), &flips);
        for ((index, _), lane) in drawn.iter().zip(outcomes) {
            let judge = lane.judge;
            let mut add = |class: &str| {
                let row = Row {
                    subject: self.subject.name().into(),
                    kind: kind.name().into(),
                    place: self.flops.names[*index].clone(),
                    class: class.into(),
                };
                tally.add(row, 1);
            };
            add(judge.class.name());
            judge.marks().map(Mark::name).for_each(add);
        }
        tally
    }
}
