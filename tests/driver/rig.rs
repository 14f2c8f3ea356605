//! The driver, compiled as C, at the front of a card on its bench: the program asks over its output for what its hooks do, line by line,
//! and the bench does it on the pins of the bus.

use super::compiled;
use crate::bus::{parallel, spi, Master};
use crate::made;
use endat_card::{VirtualCard, VirtualConfig};
use endat_config::{parse, Project};
use endat_hdl::card::bus::HostBus;
use endat_hdl::card::service_times;
use endat_hdl::endat::service::program::ServiceTimes;
use endat_sim::bench::{Bench, Link};
use endat_sim::encoder::{Defect, EncoderConfig, Violation};
use endat_sim::line::LineConfig;
use endat_sim::rng::Rng;
use endat_sim::{MS, US};
use rtl_design::engine::Compiled;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// System clock of these cards: milliseconds are few cycles, and an initialisation does not take a slower one.
const SYSTEM_HZ: u64 = 8_000_000;

/// EnDat clock.
pub const ENDAT_HZ: u32 = 1_000_000;

/// More than a scenario takes: a driver that asks for ever ends, too.
const LINES: usize = 1_000_000;

/// Widths of the encoders.
pub const WIDTHS: [u32; 2] = [29, 25];

/// A card with every part that the driver knows.
pub const ALL_PARTS: &str = "[service]\nparts = [\"requests\", \"initialise\", \"diagnosis\"]\n[stream]\nfifo_bytes = 1_024\n";

/// The configuration of such a card.
pub fn text(bus: HostBus, more: &str) -> String {
    let name = bus.name();
    let channel =
        WIDTHS.map(|bits| format!("[[channel]]\nposition_bits = {bits}\ncommand = \"111000\"\n"));
    format!(
        "name = \"{name}_card\"\n[clock]\nsystem_hz = {SYSTEM_HZ}\n[endat]\nclock_hz = {ENDAT_HZ}\n{}\
         [trigger]\nsample_hz = 5_000\nsources = [\"register\"]\n[host]\nbus = \"{name}\"\n{more}",
        channel.concat()
    )
}

/// The card of a project with short waits of its services, as its encoders have them.
fn quick_card(project: &Project) -> Compiled {
    let times = ServiceTimes {
        power_up_ms: 2,
        after_pulse_ms: 2,
        reset_ms: 3,
        write_ms: 2,
        busy_ms: 30,
        request_ms: 60,
        ..service_times(&project.card)
    };
    made::card_with(project, &times, 100)
}

/// An encoder for whose waits these tests have the time.
pub fn encoder(channel: usize) -> EncoderConfig {
    let mut encoder = EncoderConfig::endat22(WIDTHS[channel]).seed(channel as u64 + 1);
    encoder.tac = 100 * US..=200 * US;
    encoder.write_time = MS..=MS;
    encoder.reset_time = 2 * MS;
    encoder
}

/// Whoever is at the pins.
enum Front {
    /// A simulator of others: it takes the lines as they are.
    Outside(ChildStdin, BufReader<ChildStdout>),
    Words(Master),
    Spi(spi::Host),
    Parallel(parallel::Host),
    Uart(crate::host::Host),
    /// The program's own virtual card, over its UART.
    Virtual(Box<VirtualCard>),
}

impl Front {
    fn bench(&mut self) -> &mut Bench<Compiled> {
        match self {
            Self::Words(master) => &mut master.bench,
            Self::Spi(host) => &mut host.0.bench,
            Self::Parallel(host) => &mut host.0.bench,
            Self::Uart(host) => &mut host.bench,
            Self::Virtual(card) => card.bench(),
            Self::Outside(..) => unreachable!("it has a bench of its own"),
        }
    }
}

/// A card, and the program with the driver.
pub struct Rig {
    front: Front,
    /// First digits of the hash of its configuration.
    pub hash: String,
    /// Which hooks the program has: `spi`, `parallel`, `uart` or `words`.
    pub kind: &'static str,
    /// One of so many frames on SPI has a wrong bit; 0 = none.
    noise: u64,
    rng: Rng,
    system_hz: u64,
    encoders: usize,
    /// Pause before each read, in cycles.
    slow_cycles: u64,
    /// Wrong bits so far.
    pub flipped: u64,
    /// Which write from now on is lost, if any.
    loses: u32,
}

impl Rig {
    /// A card with these parts, with an encoder at each channel.
    pub fn new(bus: HostBus, more: &str) -> Self {
        // A UART asks for a board, which the other cards do not have.
        let like = match bus {
            HostBus::Uart => HostBus::Apb,
            bus => bus,
        };
        let mut project = parse("card.toml", &text(like, more)).unwrap();
        project.bus = bus;
        Self::of(project)
    }

    /// A card of this configuration.
    pub fn of(project: Project) -> Self {
        Self::with(project, encoder)
    }

    /// A card with these encoders.
    pub fn with(mut project: Project, encoder: impl Fn(usize) -> EncoderConfig) -> Self {
        project.card.uart_bit_cycles = 8;
        let (system_hz, channels) = (project.card.system_hz, project.card.channels.len());
        let engine = quick_card(&project);
        let encoders = || (0..channels).map(|n| (n, encoder(n)));
        let master = || Master::of_engine(engine.clone(), &project, encoders().collect(), 20.0);
        let (front, kind) = match project.bus {
            HostBus::Spi => (Front::Spi(spi::Host::at(master())), "spi"),
            HostBus::Parallel => (Front::Parallel(parallel::Host::at(master())), "parallel"),
            HostBus::Uart => {
                let link = |(_, encoder)| Link::new(LineConfig::cable(20.0), encoder);
                let links = encoders().map(link).collect();
                let host = crate::host::Host::new(engine.clone(), system_hz, links);
                (Front::Uart(host), "uart")
            }
            _ => (Front::Words(master()), "words"),
        };
        Self::at(front, kind, &project)
    }

    /// The virtual card of this project.
    pub fn of_virtual_card(project: &Project) -> Self {
        let card = VirtualCard::new(project, &VirtualConfig::default()).unwrap();
        Self::at(Front::Virtual(Box::new(card)), "uart", project)
    }

    fn at(front: Front, kind: &'static str, project: &Project) -> Self {
        Self {
            front,
            hash: project.hash[..8].to_owned(),
            kind,
            noise: 0,
            rng: Rng::new(3),
            system_hz: project.card.system_hz,
            encoders: project
                .card
                .channels
                .iter()
                .filter(|c| c.is_endat())
                .count(),
            slow_cycles: 0,
            flipped: 0,
            loses: 0,
        }
    }

    /// The card of this project in a program that takes the lines of the hooks.
    pub fn outside(project: &Project, program: &Path) -> Self {
        let kind = match project.bus {
            HostBus::Spi => "spi",
            _ => "words",
        };
        let mut child = Command::new(program)
            .arg(kind)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (to, from) = pipes(&mut child);
        Self::at(Front::Outside(to, from), kind, project)
    }

    /// The same with a wrong bit in one of so many frames.
    pub fn noise(mut self, one_of: u64) -> Self {
        self.noise = one_of;
        self
    }

    /// Lets the program go through a scenario.
    ///
    /// # Panics
    /// With what the program said, if it is not content.
    pub fn run(&mut self, scenario: &str) {
        let Some(program) = compiled() else { return };
        let mut child = Command::new(program)
            .args([self.kind, scenario, &self.hash])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (mut to, from) = pipes(&mut child);
        let mut said = vec![];
        for (count, line) in from.lines().enumerate() {
            assert!(count < LINES, "{} {scenario}: never ends", self.kind);
            let line = line.unwrap();
            match line.strip_prefix("# ") {
                Some(text) => said.push(text.to_owned()),
                None => writeln!(to, "{}", self.answer(&line)).unwrap(),
            }
        }
        let status = child.wait().unwrap();
        let said = said.join("\n");
        assert!(status.success(), "{} {scenario}: {said}", self.kind);
    }

    /// Does what a line asks for, on the pins of the bus or with the encoders; what came of it.
    pub fn answer(&mut self, line: &str) -> String {
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |n: usize| u32::from_str_radix(words[n], 16).unwrap();
        let cycles_per_us = self.system_hz / 1_000_000;
        if let Front::Outside(to, from) = &mut self.front {
            writeln!(to, "{line}").unwrap();
            let mut answer = String::new();
            while !answer.starts_with("= ") {
                // What its encoders complain of stands in lines of its own.
                answer.clear();
                assert!(
                    from.read_line(&mut answer).unwrap() > 0,
                    "{line}: no answer"
                );
            }
            return answer[2..].trim_end().to_owned();
        }
        match words[0] {
            "delay" => {
                let cycles = u64::from(number(1)) * cycles_per_us;
                match &mut self.front {
                    Front::Virtual(card) => card.run(cycles),
                    front => front.bench().run_cycles(cycles),
                }
                String::new()
            }
            "slow" => {
                self.slow_cycles = u64::from(number(1)) * cycles_per_us;
                String::new()
            }
            "lose" => {
                self.loses = number(1);
                String::new()
            }
            "irq" => format!("{:x}", self.front.bench().get("irq_o")),
            "now" => format!("{:x}", (self.front.bench().now() / US) as u32),
            "unplug" => {
                let bench = self.front.bench();
                let from = bench.now() + US + u64::from(number(3)) * MS;
                let until = from + u64::from(number(2)) * MS;
                let link = bench.link_mut(number(1) as usize);
                link.encoder_mut().unplug(from, until);
                String::new()
            }
            "crc" => {
                let link = self.front.bench().link_mut(number(1) as usize);
                link.encoder_mut().spoil_next(Defect::CrcXor(1));
                String::new()
            }
            "position" => {
                let bench = self.front.bench();
                let frames = bench.link(number(1) as usize).encoder().frames();
                format!("{:x}", frames.last().unwrap().position)
            }
            "frames" => {
                let link = self.front.bench().link(number(1) as usize);
                format!("{:x}", link.encoder().frames().len())
            }
            "violations" => {
                let encoders = self.encoders;
                let bench = self.front.bench();
                // The pulse after power-up is no frame, and a request that the encoder refuses ends without an answer.
                let is_one = |v: &Violation| !matches!(v, Violation::StoppedBeforeAnswer { .. });
                let of = |n| {
                    let violations = bench.violations(n).iter();
                    violations.filter(|(_, v)| is_one(v)).count() + bench.conflicts(n).len()
                };
                let of_others = bench.others().map(|other| other.complaints().len());
                let all = (0..encoders).map(of).chain(of_others);
                format!("{:x}", all.sum::<usize>())
            }
            _ => self.access(&words),
        }
    }

    /// What goes over the pins of the bus.
    fn access(&mut self, words: &[&str]) -> String {
        let number = |n: usize| u32::from_str_radix(words[n], 16).unwrap();
        let bytes = |text: &str| -> Vec<u8> {
            let pairs = (0..text.len()).step_by(2);
            pairs
                .map(|n| u8::from_str_radix(&text[n..n + 2], 16).unwrap())
                .collect()
        };
        if ["r", "get"].contains(&words[0]) {
            self.front.bench().run_cycles(self.slow_cycles);
        }
        match (&mut self.front, words[0]) {
            (Front::Words(master), "r") => format!("{:x}", master.read(number(1) as u16)),
            (Front::Words(master), "w") => {
                master.write(number(1) as u16, number(2));
                String::new()
            }
            (Front::Spi(host), "spi") => {
                let mut sent = bytes(words[1]);
                let is_noisy = self.noise > 0 && self.rng.in_range(1, self.noise) == 1;
                let bit = self.rng.in_range(0, 8 * sent.len() as u64 - 1) as usize;
                let is_on_the_way_there = self.rng.in_range(0, 1) == 1;
                let flip = |bytes: &mut [u8]| bytes[bit / 8] ^= 0x80 >> (bit % 8);
                if is_noisy && is_on_the_way_there {
                    flip(&mut sent);
                }
                let mut came = host.frame(&sent);
                if is_noisy && !is_on_the_way_there {
                    flip(&mut came);
                }
                self.flipped += u64::from(is_noisy);
                came.iter().map(|b| format!("{b:02x}")).collect()
            }
            (Front::Parallel(host), "get") => format!("{:x}", host.get(number(1))),
            (Front::Parallel(host), "put") => {
                host.put(number(1), number(2));
                String::new()
            }
            (Front::Uart(host), "send") => {
                host.send(&bytes(words[1]));
                String::new()
            }
            (Front::Uart(host), "receive") => (0..number(1))
                .map(|_| format!("{:02x}", host.receive()))
                .collect(),
            (Front::Virtual(card), "send") => {
                let sent = bytes(words[1]);
                // A write begins with a 1.
                let is_lost = sent[0] == 1 && self.loses == 1;
                self.loses = self.loses.saturating_sub(u32::from(sent[0] == 1));
                if !is_lost {
                    card.send_bytes(&sent);
                }
                String::new()
            }
            (Front::Virtual(card), "receive") => {
                let count = number(1) as usize;
                let mut came = vec![];
                for _ in 0..LINES {
                    came.extend(card.take_bytes());
                    if came.len() >= count {
                        break;
                    }
                    card.run(100);
                }
                // Nobody asks for more than is answered.
                assert_eq!(came.len(), count);
                came.iter().map(|b| format!("{b:02x}")).collect()
            }
            (_, what) => panic!("{what}: no access of this bus"),
        }
    }
}

fn pipes(child: &mut Child) -> (ChildStdin, BufReader<ChildStdout>) {
    let to = child.stdin.take().unwrap();
    (to, BufReader::new(child.stdout.take().unwrap()))
}
