//! The campaign over configurations: valid ones at random, whose emission every reader takes without a word, and spoilt ones, which are
//! refused or taken and nothing else.

mod draw;

pub use draw::{mutated, valid};

use endat_config::{parse_any, Configuration};
use endat_console::artifact::Artifact;
use endat_console::error::CommandError;
use endat_emit::emit;
use endat_emit::protocols::t_format;
use endat_hdl::card::bus::HostBus;
use endat_sim::campaign::{Campaign, Row, Tally};
use endat_tools::readers::{is_bench, Reader, LINTERS};
use endat_tools::scratch;
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::panic::catch_unwind;

/// Of seven cases five are valid and two spoilt; of fifty valid ones, one runs its bench.
const VALID: u64 = 5;
const OF: u64 = 7;
const BENCH_EVERY: u64 = 50;
/// Drawn again until there is a bench (a bare port has none) that ends in a minute: what is simulated most is bits.
const BENCH_DRAWS: u64 = 1_000;
/// Longest bit of a UART and of an encoder, in cycles, where the bench is run.
const BENCH_BIT_CYCLES_MAX: u64 = 64;

/// Random configurations.
pub struct Configurations {
    cases: u64,
    seed: u64,
}

/// What became of a case.
pub struct Finding {
    /// The configuration.
    pub text: String,
    /// Its bus, or `spoilt`.
    subject: String,
    class: &'static str,
    /// `bench_passed`, `bench_failed`.
    bench: Option<&'static str>,
    /// What was said.
    pub told: Vec<String>,
}

impl Configurations {
    /// So many valid ones, and two spoilt ones to five of them. The outside programs must be there.
    pub fn new(valid: u64, seed: u64) -> Result<Self, CommandError> {
        LINTERS.iter().try_for_each(|linter| linter.find())?;
        let cases = valid.div_ceil(VALID) * OF;
        Ok(Self { cases, seed })
    }

    /// All cases.
    pub fn cases(&self) -> u64 {
        self.cases
    }

    fn seed(&self, case: u64, draw: u64) -> u64 {
        let digest = Sha256::digest(format!("{} {case} {draw}", self.seed));
        digest[..8]
            .iter()
            .fold(0, |seed, byte| seed << 8 | u64::from(*byte))
    }

    /// Runs one case.
    pub fn case(&self, case: u64) -> Finding {
        let place = case % OF;
        match place < VALID {
            true => self.valid(
                case,
                (case / OF * VALID + place).is_multiple_of(BENCH_EVERY),
            ),
            false => self.spoilt(case),
        }
    }

    fn valid(&self, case: u64, wants_bench: bool) -> Finding {
        let mut found = Finding::new("none", "not_found");
        for draw in 0..if wants_bench { BENCH_DRAWS } else { 1 } {
            let Some(text) = draw::valid(self.seed(case, draw)) else {
                continue;
            };
            found.text = text;
            match emission(&found.text) {
                Made::Emission(emission) => {
                    found.subject = emission.bus;
                    let has_bench = emission.is_quick && emission.files.iter().any(is_bench);
                    if !wants_bench || has_bench {
                        found.read(&emission.top, &emission.files, wants_bench);
                        return found;
                    }
                }
                Made::Refused(told) => found.fails("unclean", told),
                Made::Panic => found.fails("panic", "panics".into()),
            }
            if !found.told.is_empty() {
                return found;
            }
        }
        found
    }

    fn spoilt(&self, case: u64) -> Finding {
        let mut found = Finding::new("spoilt", "not_found");
        let Some(text) = draw::valid(self.seed(case, 0)) else {
            return found;
        };
        found.text = draw::mutated(&text, self.seed(case, 1));
        match emission(&found.text) {
            Made::Emission(_) => found.class = "taken",
            Made::Refused(_) => found.class = "refused",
            Made::Panic => found.fails("panic", "panics".into()),
        }
        found
    }
}

/// What a text becomes.
enum Made {
    Emission(Emission),
    /// What is wrong with it.
    Refused(String),
    Panic,
}

struct Emission {
    bus: String,
    top: String,
    /// Whether the bench would end soon.
    is_quick: bool,
    files: Vec<Artifact>,
}

fn emission(text: &str) -> Made {
    let made = catch_unwind(|| -> Result<Emission, CommandError> {
        let mut is_quick = true;
        let (bus, top, files) = match parse_any("drawn.toml", text)? {
            Configuration::Card(card) => {
                let is_uart = card.bus == HostBus::Uart;
                let channels = card.card.channels.iter().map(|c| c.period_cycles);
                let bits = channels.chain(is_uart.then_some(card.card.uart_bit_cycles));
                is_quick = bits.into_iter().all(|bit| bit <= BENCH_BIT_CYCLES_MAX);
                (card.bus.name(), card.name.clone(), emit(&card)?)
            }
            Configuration::Receiver(receiver) => {
                let files = t_format::emit(&receiver)?;
                (endat_config::RECEIVER_BUS, receiver.name, files)
            }
        };
        Ok(Emission {
            bus: bus.into(),
            top,
            is_quick,
            files,
        })
    });
    match made {
        Ok(Ok(emission)) => Made::Emission(emission),
        Ok(Err(error)) => Made::Refused(error.to_string()),
        Err(_) => Made::Panic,
    }
}

impl Finding {
    fn new(subject: &str, class: &'static str) -> Self {
        Self {
            text: String::new(),
            subject: subject.into(),
            class,
            bench: None,
            told: vec![],
        }
    }

    fn fails(&mut self, class: &'static str, told: String) {
        self.class = class;
        self.told.push(told);
    }

    /// Gives an emission to every linter, and runs its bench if that is wanted.
    fn read(&mut self, top: &str, files: &[Artifact], wants_bench: bool) {
        self.class = "clean";
        if let Err(error) = self.readers(top, files, wants_bench) {
            self.fails("unclean", error.to_string());
        }
    }

    fn readers(
        &mut self,
        top: &str,
        files: &[Artifact],
        wants_bench: bool,
    ) -> Result<(), CommandError> {
        let folder = scratch::folder()?;
        endat_console::artifact::write(folder.path(), files, scratch::REMEDY)?;
        for linter in LINTERS {
            if let Some(told) = linter.lint(folder.path(), top, files)? {
                self.fails("unclean", format!("{linter}: {told}"));
            }
        }
        if wants_bench {
            let (passes, told) = Reader::Icarus("-g2005").play(folder.path(), files, &[])?;
            self.bench = Some(if passes {
                "bench_passed"
            } else {
                "bench_failed"
            });
            if !passes {
                self.told.push(format!("bench: {told}"));
            }
        }
        Ok(())
    }

    /// Whether anything is wrong.
    pub fn is_good(&self) -> bool {
        self.told.is_empty() && self.class != "not_found"
    }
}

impl Campaign for Configurations {
    fn digest(&self) -> u64 {
        // What is drawn depends on the reader's keys and limits; a few draws tell one reader from another.
        let draws: String = (0..8).filter_map(draw::valid).collect();
        let digest = Sha256::digest(draws);
        digest[..8]
            .iter()
            .fold(0, |sum, byte| sum << 8 | u64::from(*byte))
    }

    fn groups(&self) -> Vec<u64> {
        vec![self.cases]
    }

    fn run(&self, _group: usize, cases: Range<u64>) -> Tally {
        let mut tally = Tally::default();
        for case in cases {
            let found = self.case(case);
            let row = |class: &str| Row {
                subject: found.subject.clone(),
                kind: if found.subject == "spoilt" {
                    "spoilt"
                } else {
                    "valid"
                }
                .into(),
                // One that is wrong is told with its number, which runs it alone.
                place: if found.is_good() {
                    "all".into()
                } else {
                    format!("case {case}")
                },
                class: class.into(),
            };
            tally.add(row(found.class), 1);
            if let Some(bench) = found.bench {
                tally.add(row(bench), 1);
            }
        }
        tally
    }

    fn batch(&self, _group: usize) -> u64 {
        4
    }
}
