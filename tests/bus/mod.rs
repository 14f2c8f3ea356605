//! The card behind a bus: masters of each bus on a bench with encoders, the same claims for every front.

mod bank;
mod claims;
mod error_test;
mod handshake;
mod outputs;
pub mod parallel;
mod rates;
mod safety;
mod second;
mod second_receiver;
pub mod spi;
mod three_ways;
mod uart;

use crate::bus_card::{text, WORD_BUSES};
use crate::made;
use endat_config::{parse, Project};
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::CardConfig;
use endat_hdl::regs::{Block, CARD};
use endat_sim::bench::{Bench, Link, PinNames};
use endat_sim::encoder::EncoderConfig;
use endat_sim::line::LineConfig;
use endat_sim::rng::Rng;
use endat_sim::US;
use rtl_design::engine::Compiled;

/// Address of a word.
pub fn at(block: &Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// Triggers, and runs to the end of everything.
pub fn frame(master: &mut Master) {
    master.write(at(&CARD, "trigger_now", 0), 1);
    master.bench.run_for(600 * US);
}

/// An access that a master makes, and what it gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// The word that was read.
    pub word: u32,
    /// The slave says that it did nothing.
    pub refused: bool,
    /// Cycles from the first to the last of the access.
    pub cycles: u64,
}

/// A master at a card.
pub struct Master {
    /// Its bus.
    pub bus: HostBus,
    /// The card with an encoder on each channel.
    pub bench: Bench<Compiled>,
    /// The card.
    pub config: CardConfig,
    /// What the master has no reason to do in one way.
    pub rng: Rng,
}

/// An encoder with a short recovery time.
pub fn sound(seed: u64, position_bits: u32) -> EncoderConfig {
    let mut encoder = EncoderConfig::endat22(position_bits).seed(seed);
    encoder.tm = 10 * US..=12 * US;
    encoder
}

impl Master {
    /// A card with this bus, reset, its encoders at the end of `cable_m` metres.
    pub fn new(bus: HostBus, more: &str) -> Self {
        let project = parse("card.toml", &text(bus, more)).unwrap();
        Self::with_widths(&project, &[29, 25])
    }

    /// The card of a project, with encoders of these widths.
    pub fn with_widths(project: &Project, widths: &[u32]) -> Self {
        let channels = widths.iter().copied().enumerate();
        Self::at_channels(project, &channels.collect::<Vec<_>>())
    }

    /// The same with EnDat encoders at some channels only: number and width.
    pub fn at_channels(project: &Project, widths: &[(usize, u32)]) -> Self {
        let encoders = widths.iter().enumerate();
        let encoders = encoders.map(|(index, (n, bits))| (*n, sound(index as u64, *bits)));
        Self::with_encoders(project, encoders.collect())
    }

    /// The same with these encoders, each at its channel.
    pub fn with_encoders(project: &Project, encoders: Vec<(usize, EncoderConfig)>) -> Self {
        Self::with_cable(project, encoders, 20.0)
    }

    /// The same at the end of so many metres.
    pub fn with_cable(
        project: &Project,
        encoders: Vec<(usize, EncoderConfig)>,
        cable_m: f64,
    ) -> Self {
        Self::of_engine(made::card(project), project, encoders, cable_m)
    }

    /// The same with this card, which may have shorter waits than the project's.
    pub fn of_engine(
        engine: Compiled,
        project: &Project,
        encoders: Vec<(usize, EncoderConfig)>,
        cable_m: f64,
    ) -> Self {
        let link = |(n, encoder)| {
            let port = PinNames::card(n);
            (port, Link::new(LineConfig::cable(cable_m), encoder))
        };
        let links = encoders.into_iter().map(link).collect();
        let mut bench = Bench::new(engine, project.card.system_hz, links);
        if project.card.line.double_edge {
            bench.set_double_edge();
        }
        bench.power_up();
        // The lines have their levels at rest.
        bench.run_cycles(1_000);
        Self {
            bus: project.bus,
            bench,
            config: project.card.clone(),
            rng: Rng::new(7),
        }
    }

    fn tick(&mut self) {
        self.bench.run_cycles(1);
    }

    /// Sets an input of the bus.
    pub fn set(&mut self, name: &str, value: u32) {
        self.bench.set(name, value.into());
    }

    fn high(&mut self, name: &str) -> bool {
        self.bench.get(name) != 0
    }

    /// Waits for one of these outputs, and ends the cycle in which it is high.
    ///
    /// # Panics
    /// After 300 cycles: the slave hangs.
    fn wait_for(&mut self, names: &[&str]) -> u64 {
        for cycles in 1..300 {
            if names.iter().any(|name| self.high(name)) {
                return cycles;
            }
            self.tick();
        }
        panic!("{}: no answer", self.bus.name());
    }

    /// Reads a word, or writes one; leaves the bus idle.
    pub fn access(&mut self, word_address: u16, write: Option<u32>) -> Answer {
        self.transfer(u32::from(word_address) << 2, write, 15)
    }

    /// The same with a byte address and byte selects.
    pub fn transfer(&mut self, address: u32, write: Option<u32>, selects: u32) -> Answer {
        match self.bus {
            HostBus::Apb => self.apb(address, write),
            HostBus::Wishbone => self.wishbone(address, write, selects),
            HostBus::AxiLite => self.axi(address, write, selects),
            HostBus::AhbLite => self.ahb(address, write, selects),
            _ => unreachable!("no bus with words"),
        }
    }

    /// Reads a word.
    pub fn read(&mut self, word_address: u16) -> u32 {
        self.access(word_address, None).word
    }

    /// Writes a word.
    pub fn write(&mut self, word_address: u16, value: u32) {
        assert!(!self.access(word_address, Some(value)).refused);
    }

    fn apb(&mut self, address: u32, write: Option<u32>) -> Answer {
        self.set("s_apb_psel", 1);
        self.set("s_apb_penable", 0);
        self.set("s_apb_paddr", address);
        self.set("s_apb_pwrite", write.is_some().into());
        self.set("s_apb_pwdata", write.unwrap_or(0xdead_beef));
        assert!(!self.high("s_apb_pready"), "ready before the transfer");
        self.tick();
        self.set("s_apb_penable", 1);
        let cycles = 1 + self.wait_for(&["s_apb_pready"]);
        let word = self.bench.get("s_apb_prdata") as u32;
        let refused = self.high("s_apb_pslverr");
        self.tick();
        self.set("s_apb_psel", 0);
        self.set("s_apb_penable", 0);
        Answer {
            word,
            refused,
            cycles,
        }
    }

    fn wishbone(&mut self, address: u32, write: Option<u32>, selects: u32) -> Answer {
        self.set("wb_cyc_i", 1);
        self.set("wb_stb_i", 1);
        self.set("wb_adr_i", address >> 2);
        self.set("wb_we_i", write.is_some().into());
        self.set("wb_dat_i", write.unwrap_or(0xdead_beef));
        self.set("wb_sel_i", selects);
        let cycles = self.wait_for(&["wb_ack_o", "wb_err_o"]);
        let word = self.bench.get("wb_dat_o") as u32;
        let refused = self.high("wb_err_o");
        self.tick();
        self.set("wb_cyc_i", 0);
        self.set("wb_stb_i", 0);
        assert!(
            !self.high("wb_ack_o") && !self.high("wb_err_o"),
            "one cycle"
        );
        Answer {
            word,
            refused,
            cycles,
        }
    }

    /// Address phase, data phase; a part of a word is a smaller size.
    fn ahb(&mut self, address: u32, write: Option<u32>, selects: u32) -> Answer {
        self.set("s_ahb_hsel", 1);
        self.set("s_ahb_htrans", 2);
        self.set("s_ahb_haddr", address);
        self.set("s_ahb_hwrite", write.is_some().into());
        self.set("s_ahb_hsize", if selects == 15 { 2 } else { 0 });
        self.set("s_ahb_hready", 1);
        assert!(
            self.high("s_ahb_hreadyout"),
            "not ready before the transfer"
        );
        self.tick();
        // What stands beside the data phase is nobody's.
        self.set("s_ahb_hready", 0);
        let other = self.rng.in_range(0, 3) as u32;
        self.set("s_ahb_htrans", other);
        self.set("s_ahb_haddr", 4 * other);
        self.set("s_ahb_hwdata", write.unwrap_or(0xdead_beef));
        let has_error = self.high("s_ahb_hresp");
        let cycles = 1 + self.wait_for(&["s_ahb_hreadyout"]);
        let word = self.bench.get("s_ahb_hrdata") as u32;
        let refused = self.high("s_ahb_hresp");
        assert_eq!(has_error, refused, "both cycles of an error");
        self.set("s_ahb_hready", 1);
        self.set("s_ahb_htrans", 0);
        self.tick();
        self.set("s_ahb_hsel", 0);
        assert!(!self.high("s_ahb_hresp"), "two cycles");
        Answer {
            word,
            refused,
            cycles,
        }
    }

    /// Each channel comes after a pause of its own.
    fn axi(&mut self, address: u32, write: Option<u32>, selects: u32) -> Answer {
        let started = self.bench.cycle();
        let mut offers: Vec<(&str, u64)> = match write {
            Some(_) => vec![("aw", 0), ("w", 0)],
            None => vec![("ar", 0)],
        };
        for (_, pause) in &mut offers {
            *pause = self.rng.in_range(0, 6);
        }
        self.set("s_axi_awaddr", address);
        self.set("s_axi_araddr", address);
        self.set("s_axi_wdata", write.unwrap_or(0xdead_beef));
        self.set("s_axi_wstrb", selects);
        for cycle in 0..300 {
            if offers.is_empty() {
                break;
            }
            let mut left = vec![];
            for (channel, pause) in &offers {
                let is_offered = cycle >= *pause;
                self.set(&format!("s_axi_{channel}valid"), is_offered.into());
                if !(is_offered && self.high(&format!("s_axi_{channel}ready"))) {
                    left.push((*channel, *pause));
                }
            }
            let taken: Vec<&str> = offers.iter().map(|o| o.0).collect();
            self.tick();
            for channel in taken {
                if !left.iter().any(|l| l.0 == channel) {
                    self.set(&format!("s_axi_{channel}valid"), 0);
                }
            }
            offers = left;
        }
        assert!(offers.is_empty(), "axi_lite: not taken: {offers:?}");
        let (valid, ready, resp) = match write {
            Some(_) => ("s_axi_bvalid", "s_axi_bready", "s_axi_bresp"),
            None => ("s_axi_rvalid", "s_axi_rready", "s_axi_rresp"),
        };
        self.wait_for(&[valid]);
        // The answer waits, and stands still.
        let word = self.bench.get("s_axi_rdata") as u32;
        for _ in 0..self.rng.in_range(0, 5) {
            self.tick();
            assert!(self.high(valid) && self.bench.get("s_axi_rdata") as u32 == word);
        }
        let refused = self.bench.get(resp) == 2;
        self.set(ready, 1);
        self.tick();
        self.set(ready, 0);
        assert!(!self.high(valid), "{valid} after it was taken");
        Answer {
            word,
            refused,
            cycles: self.bench.cycle() - started,
        }
    }
}
