//! The driver in Rust, at the same fronts.

use super::rig::{self, Rig, ALL_PARTS, ENDAT_HZ, WIDTHS};
use super::world::World;
use super::{everything, OTHER_BUSES};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use endat_config::parse;
use endat_driver::regs::Protocol;
use endat_driver::regs::{self, causes::endat, service::request_state};
use endat_driver::{
    difference, signed, Card, Error, Link, ModeCommand, Moment, NamePlate, Parallel, Part, Sources,
    Spi, Uart,
};
use endat_hdl::card::bus::HostBus;
use endat_sim::encoder::Defect;
use std::convert::Infallible;
use std::fmt::Debug;
use std::path::Path;

/// Triggers from here.
const HOST: Sources = Sources {
    pin: false,
    timer: false,
    register: true,
};
const HOST_AND_TIMER: Sources = Sources {
    timer: true,
    ..HOST
};

/// Rate of a timer that has a trigger under way at nearly every moment.
const BUSY_HZ: u32 = 1_000_000;

/// The card of a link, which has the hash of its configuration.
fn opened_over<L: Link<Error: Debug>>(mut link: L, world: &World) -> Card<L, World> {
    let hash = u32::from_str_radix(&world.0.borrow().hash, 16).unwrap();
    let wrong = Card::open(&mut link, world.clone(), Some(hash ^ 1));
    let found = wrong.err().unwrap();
    assert!(matches!(found, Error::Configuration { found } if found == hash));
    let mut card = Card::open(link, world.clone(), Some(hash)).unwrap();
    assert_eq!(card.facts().channels, WIDTHS.len());
    card.try_link().unwrap();
    card
}

/// A card under test.
struct Bench<L> {
    card: Card<L, World>,
    world: World,
}

impl<L: Link<Error: Debug + PartialEq>> Bench<L> {
    fn new(world: World, link: L) -> Self {
        let card = opened_over(link, &world);
        Self { card, world }
    }

    fn wait_for_both(&mut self) {
        for channel in 0..WIDTHS.len() {
            self.card.wait_ready(channel, 1_000).unwrap();
        }
    }

    /// Triggers, and compares what came with what the encoders have sent.
    fn measure_well(&mut self) -> Moment {
        let moment = self.card.measure(5_000).unwrap();
        for (n, result) in moment.results().iter().enumerate() {
            let sent = self.world.ask(&format!("position {n:x}"));
            assert!(
                result.fresh && result.valid && !result.stale && result.fits,
                "{result:?}"
            );
            assert_eq!((result.position, result.width_bits), (sent, WIDTHS[n]));
        }
        self.world.pause_us(200);
        moment
    }

    fn parameters(&mut self) {
        let card = &mut self.card;
        let got = card.read_parameter(0, 0xA1, 0x0D, 200).unwrap();
        assert_eq!((got.data, got.address), (0x801D, 0x0D));
        let bits = card.read_plate(1, "position_bits").unwrap().unwrap();
        assert_eq!(u32::from(bits & 0x3F), WIDTHS[1]);
        assert_eq!(card.read_plate(1, "request"), Err(Error::Argument));
        let plate = card.read_name_plate(1).unwrap();
        let told = plate.to_string();
        assert!(told.contains("  ID number         123456\n"), "{told}");
        assert!(told.contains("  serial number     1\n"), "{told}");
        assert_eq!(plate.position_bits, Some(WIDTHS[1]));
        let got = card.write_parameter(1, 0xA9, 3, 0x1234, 200).unwrap();
        assert!(got.time_us > 100, "{got:?}");
        assert_eq!(card.read_parameter(1, 0xA9, 3, 200).unwrap().data, 0x1234);
        // An address that the area does not have.
        let refused = card.read_parameter(0, 0xA1, 0xF0, 200);
        assert!(
            matches!(refused, Err(Error::Refused(answer)) if u16::from(answer.refusal) == request_state::SILENT),
            "{refused:?}"
        );
        // One that rides on a trigger which never comes is given up, and the next one goes through.
        let rides = ModeCommand::PositionSelectMemory;
        assert_eq!(card.send(0, rides, 0xA1, 0, 5), Err(Error::Timeout));
        assert_eq!(
            card.read_parameter(0, 0xA1, 0x0D, 200).unwrap().data,
            0x801D
        );
        self.world.pause_us(40_000);
    }

    fn additional_data(&mut self) {
        let wrong = self.card.select_additional_data(0, &[0xA1]);
        assert_eq!(wrong, Err(Error::Argument));
        assert_eq!(
            self.card.select_additional_data(0, &[0x4C; 9]),
            Err(Error::Argument)
        );
        self.card.select_additional_data(0, &[0x4C]).unwrap();
        // The card finds out what comes: one or two frames end with the pause of an aborted one.
        let is_there = |moment: &Moment| moment.results()[0].infos[0].came;
        for _ in 0..4 {
            if self
                .card
                .measure(5_000)
                .is_ok_and(|moment| is_there(&moment))
            {
                break;
            }
            self.world.pause_us(32_000);
        }
        let moment = self.card.measure(5_000).unwrap();
        let [first, second] = [moment.results()[0], moment.results()[1]];
        let came = first.infos[0];
        assert!(first.fresh && came.good, "{first:?}");
        assert_eq!((came.number(), came.content), (0x0C, 2954));
        assert!(!second.infos[0].came);
        let (content, sequence) = self.card.read_additional_data(0, 0).unwrap();
        assert_eq!(content, 2954);
        assert!(first.sequence.wrapping_sub(sequence) < 2, "{sequence}");
        self.card.select_additional_data(0, &[]).unwrap();
        self.world.pause_us(200);
    }

    fn settings(&mut self) {
        let card = &mut self.card;
        let before = card.read_settings(0).unwrap();
        assert_eq!(before.position_bits, WIDTHS[0]);
        assert_eq!(before.period_cycles, card.period_cycles(ENDAT_HZ));
        for wrong in [
            endat_driver::Settings {
                period_cycles: 3,
                ..before
            },
            endat_driver::Settings {
                command: ModeCommand::SendParameter.code().into(),
                ..before
            },
            endat_driver::Settings {
                start_window_cycles: 64,
                ..before
            },
            endat_driver::Settings {
                position_bits: 49,
                ..before
            },
        ] {
            assert_eq!(card.write_settings(0, &wrong), Err(Error::Argument));
        }
        let slow = endat_driver::Settings {
            period_cycles: card.period_cycles(ENDAT_HZ / 2),
            start_window_cycles: before.start_window_cycles + 1,
            ..before
        };
        card.write_settings(0, &slow).unwrap();
        assert_eq!(card.read_settings(0).unwrap(), slow);
        self.measure_well();
        let card = &mut self.card;
        card.write_settings(0, &before).unwrap();
        assert_eq!(card.read_settings(0).unwrap(), before);
        card.set_triggers(Sources::default(), None).unwrap();
        assert_eq!(card.measure(1_000), Err(Error::TriggerOff));
        let short = card.set_triggers(HOST_AND_TIMER, Some(3));
        assert_eq!(short, Err(Error::Argument));
        card.set_triggers(HOST, None).unwrap();
        card.calibrate(3).unwrap();
        self.measure_well();
    }

    fn wrong_crc(&mut self) {
        let held = self.measure_well().results()[0].position;
        self.world.told("crc 0");
        let moment = self.card.measure(5_000).unwrap();
        let [first, second] = [moment.results()[0], moment.results()[1]];
        assert!(!first.fresh && first.valid && second.fresh, "{first:?}");
        assert_eq!((u64::from(first.cause), first.position), (endat::CRC, held));
        assert!(first.cause_meaning().contains("CRC"));
        assert!(first
            .cause_remedy()
            .is_some_and(|remedy| !remedy.is_empty()));
        self.world.pause_us(200);
        self.measure_well();
    }

    fn alarms(&mut self) {
        assert_eq!(self.card.set_alarm(0, 1, 17), Err(Error::Argument));
        self.card.set_alarm(0, 1, 4).unwrap();
        self.wrong_crc();
        let state = self.card.read_state(0).unwrap();
        assert!(
            state.alarm && state.endat22 && state.initialised,
            "{state:?}"
        );
        let other = self.card.read_state(1).unwrap();
        assert!(
            !other.alarm && !other.unplugged && other.starts == 1,
            "{other:?}"
        );
        self.card.set_alarm(0, 0, 4).unwrap();
        self.card.clear(0).unwrap();
        self.world.pause_us(1_000);
        assert!(!self.card.read_state(0).unwrap().alarm);
    }

    fn interrupts(&mut self) {
        // Four events of a channel; the first is its result.
        let result_1 = 1 << 4;
        self.card.take_interrupts().unwrap();
        assert_eq!(self.card.take_interrupts().unwrap(), 0);
        self.card.enable_interrupts(result_1).unwrap();
        assert_eq!(self.world.ask("irq"), 0);
        self.measure_well();
        assert_eq!(self.world.ask("irq"), 1);
        assert!(self.card.take_interrupts().unwrap() & result_1 != 0);
        assert_eq!(self.world.ask("irq"), 0);
        self.card.enable_interrupts(0).unwrap();
    }

    fn initialise_again(&mut self) {
        self.card.initialise(0).unwrap();
        self.world.pause_us(1_000);
        assert_eq!(self.card.status(0), Err(Error::Busy));
        self.wait_for_both();
        self.measure_well();
    }

    fn stream(&mut self) {
        let mut stream = self.card.start_stream(true).unwrap();
        assert_eq!(self.card.next_set(&mut stream), Ok(None));
        let mut last = None;
        for sets in [1, 1, 0, 2, 1] {
            let moment = self.measure_well();
            self.world.pause_us(300);
            for left in (0..sets).rev() {
                let set = self.card.next_set(&mut stream).unwrap().unwrap();
                assert_eq!((set.samples().len(), set.first, set.lost), (2, 0, 0));
                assert!(last.is_none_or(|last: u16| set.sequence == last.wrapping_add(1)));
                last = Some(set.sequence);
                for (sample, result) in set.samples().iter().zip(moment.results()) {
                    assert!(sample.taken && sample.fresh && sample.valid, "{sample:?}");
                    assert!(!sample.missing && sample.cause == 0);
                    assert!(left > 0 || sample.position == result.position);
                }
            }
        }
        assert_eq!(self.card.next_set(&mut stream), Ok(None));
        self.card.start_stream(false).unwrap();
    }

    /// The plug of channel 0 is pulled, and put back.
    fn plug(&mut self, has_service: bool) {
        let good = self.measure_well().results()[0].sequence;
        // Longer than the accesses that follow: limits are counted in pauses, and a serial bus takes its time, too.
        let unplug_ms = match self.world.0.borrow().kind {
            "words" => 32,
            _ => 100,
        };
        self.world.told(&format!("unplug 0 {unplug_ms:x} 0"));
        self.world.pause_us(10_000);
        let _ = self.card.measure(500);
        let moment = self.card.read_moment().unwrap();
        let [first, second] = [moment.results()[0], moment.results()[1]];
        assert!(
            !first.fresh || first.stale && first.sequence == good,
            "{first:?}"
        );
        assert!(second.fresh, "{second:?}");
        assert_eq!(self.card.status(0), Err(Error::Unplugged));
        assert_eq!(self.card.status(1), Ok(()));
        if has_service {
            assert_eq!(self.card.measure(500), Err(Error::Timeout));
            let moment = self.card.measure_channels(0b10, 500).unwrap();
            assert!(moment.results()[1].fresh && !moment.results()[0].fresh);
            self.world.pause_us(200);
            let refused = self.card.read_parameter(0, 0xA1, 0x0D, 200);
            assert_eq!(refused, Err(Error::Unplugged));
            assert_eq!(self.card.wait_ready(0, 5), Err(Error::Unplugged));
            self.card.wait_ready(0, 2_000).unwrap();
        } else {
            self.world.pause_us(1_000 * unplug_ms + 30_000);
            let _ = self.card.measure(5_000);
            self.world.pause_us(32_000);
        }
        self.measure_well();
        assert_eq!(self.card.status(0), Ok(()));
    }

    /// Everything, on a card that has everything.
    fn journey(mut self) {
        assert_eq!(self.card.status(0), Err(Error::Busy));
        assert_eq!(self.card.wait_ready(0, 1), Err(Error::Timeout));
        self.wait_for_both();
        self.measure_well();
        self.settings();
        self.parameters();
        self.measure_well();
        self.wrong_crc();
        self.alarms();
        self.interrupts();
        self.initialise_again();
        self.stream();
        self.plug(true);
        self.additional_data();
        self.world.is_content();
    }

    /// A position, a parameter, a plug.
    fn short(mut self) {
        self.wait_for_both();
        self.measure_well();
        let got = self.card.read_parameter(1, 0xA1, 0x0D, 200).unwrap();
        assert_eq!(got.data, 0x8019);
        self.world.pause_us(40_000);
        self.wrong_crc();
        self.plug(true);
        self.world.is_content();
    }

    /// Reads that are so far apart that results come between: the moment is one all the same.
    fn torn(mut self) {
        self.wait_for_both();
        self.measure_well();
        let period = self.card.facts().system_hz / 5_000;
        let timer = Sources {
            timer: true,
            ..Sources::default()
        };
        self.card.set_triggers(timer, Some(period)).unwrap();
        self.world.told("slow 14");
        let hold = u32::from(endat_driver::regs::CARD_CONFIG.base)
            + u32::from(endat_driver::regs::CARD_CONFIG.word("hold").offset);
        for _ in 0..12 {
            let moment = self.card.read_moment().unwrap();
            let [first, second] = [moment.results()[0], moment.results()[1]];
            assert_eq!(first.timestamp, second.timestamp);
            assert!(first.fits && first.fresh && second.fresh, "{first:?}");
            assert_eq!(self.card.read_word(hold).unwrap() & 1, 0);
        }
    }
}

fn words(bus: HostBus, more: &str) -> Bench<World> {
    let world = World::new(Rig::new(bus, more));
    Bench::new(world.clone(), world)
}

#[test]
#[ignore = "slow: the Rust driver's whole journey over AXI4-Lite"]
fn everything_works_over_axi_lite() {
    words(HostBus::AxiLite, &everything()).journey();
}

#[test]
#[ignore = "slow: the Rust driver's whole journey over SPI"]
fn everything_works_over_spi() {
    let world = World::new(Rig::new(HostBus::Spi, &everything()));
    Bench::new(world.clone(), Spi::new(world)).journey();
}

fn short(bus: HostBus) {
    let world = World::new(Rig::new(bus, ALL_PARTS));
    match bus {
        HostBus::Parallel => Bench::new(world.clone(), Parallel::new(world)).short(),
        HostBus::Uart => Bench::new(world.clone(), Uart::new(world)).short(),
        _ => Bench::new(world.clone(), world).short(),
    }
}

/// In `cargo test` positions come over the parallel bus, and the tests of other protocols have the UART.
#[test]
#[ignore = "slow: the Rust driver over every other bus"]
fn position_parameter_and_plug_over_every_other_bus() {
    for bus in OTHER_BUSES {
        short(bus);
    }
}

#[test]
fn a_card_without_parts_says_which_one_is_missing() {
    let mut bench = words(HostBus::AxiLite, "");
    let card = &mut bench.card;
    card.wait_ready(0, 10).unwrap();
    let refused = card.read_parameter(0, 0xA1, 0x0D, 10);
    assert_eq!(refused, Err(Error::Part(Part::Requests)));
    assert_eq!(card.initialise(0), Err(Error::Part(Part::Initialise)));
    assert_eq!(
        card.start_stream(true).err(),
        Some(Error::Part(Part::Stream))
    );
    assert_eq!(card.take_interrupts(), Err(Error::Part(Part::Interrupt)));
    assert_eq!(card.read_parameter(2, 0xA1, 0x0D, 10), Err(Error::Argument));
    assert_eq!(card.calibrate(1 << 8), Err(Error::Argument));
    bench.measure_well();
    bench.wrong_crc();
    bench.plug(false);
    bench.world.is_content();
}

#[test]
fn an_encoder_that_never_answers_is_told_with_its_step() {
    let project = parse("card.toml", &rig::text(HostBus::Apb, ALL_PARTS)).unwrap();
    let encoder = |n| match n {
        1 => rig::encoder(n).defects(0..=u64::MAX, Defect::NoStartBit),
        n => rig::encoder(n),
    };
    let world = World::new(Rig::with(project, encoder));
    let mut bench = Bench::new(world.clone(), world);
    bench.card.wait_ready(0, 1_000).unwrap();
    let failed = bench.card.wait_ready(1, 2_000).unwrap_err();
    assert!(
        matches!(failed, Error::Initialisation { step } if step != 0),
        "{failed:?}"
    );
    assert!(failed.to_string().contains("step "), "{failed}");
}

#[test]
fn slow_reads_are_of_one_moment() {
    words(HostBus::Apb, ALL_PARTS).torn();
}

/// Catches a measurement that ends only when no trigger is under way, which a timer of a short period never lets be.
#[test]
fn measure_works_while_the_timer_triggers() {
    let mut bench = words(HostBus::Apb, ALL_PARTS);
    bench.wait_for_both();
    let period_cycles = bench.card.facts().system_hz / BUSY_HZ;
    let card = &mut bench.card;
    card.set_triggers(HOST_AND_TIMER, Some(period_cycles))
        .unwrap();
    let mut last = card.read_moment().unwrap();
    for _ in 0..6 {
        let moment = card.measure(1_000).unwrap();
        for (now, then) in moment.results().iter().zip(last.results()) {
            assert!(now.fresh && !now.stale, "{now:?}");
            assert_ne!(now.timestamp, then.timestamp);
        }
        last = moment;
    }
}

fn parallel() -> Bench<Parallel<World>> {
    let world = World::new(Rig::new(HostBus::Parallel, ALL_PARTS));
    Bench::new(world.clone(), Parallel::new(world))
}

#[test]
fn positions_come_over_the_parallel_bus() {
    let mut bench = parallel();
    bench.wait_for_both();
    bench.measure_well();
    bench.world.is_content();
}

#[test]
#[ignore = "slow: the Rust driver's slow reads over the parallel bus"]
fn slow_reads_over_the_parallel_bus_are_of_one_moment() {
    parallel().torn();
}

/// Good positions only, while one of some frames is disturbed; then parameters and settings, if asked for.
fn noise_spoils_nothing(positions: usize, has_more: bool, least: u64) {
    let world = World::new(Rig::new(HostBus::Spi, ALL_PARTS).noise(20));
    let mut spi = Spi::new(world.clone());
    spi.tries = 8;
    let mut bench = Bench::new(world, spi);
    bench.wait_for_both();
    for _ in 0..positions {
        bench.measure_well();
    }
    if has_more {
        bench.parameters();
        bench.settings();
    }
    let flipped = bench.world.0.borrow().flipped;
    assert!(flipped > least, "{flipped}");
    let (spi, _) = bench.card.release();
    assert!(spi.disturbed > 0);
}

#[test]
fn noise_on_spi_spoils_no_position() {
    noise_spoils_nothing(20, false, 12);
}

#[test]
#[ignore = "slow: positions, parameters and settings of the Rust driver over a noisy SPI"]
fn noise_on_spi_spoils_nothing() {
    noise_spoils_nothing(30, true, 50);
}

#[test]
fn the_function_of_the_page_shows_angles_over_a_plug() {
    let page = include_str!("../../docs/driver.md");
    let block = page.split("```rust\n").nth(1).unwrap();
    let block = block.split("```").next().unwrap();
    assert_eq!(block, include_str!("page.rs"));
    let world = World::new(Rig::new(HostBus::Spi, ALL_PARTS));
    world.told("unplug 0 18 64");
    let (mut good, mut bad) = (0, 0);
    let show = |shown: Result<i64, &str>| {
        if let Ok(angle) = shown {
            assert_eq!(angle, signed(world.ask("position 0"), WIDTHS[0]));
            world.pause_us(200);
        }
        good += u32::from(shown.is_ok());
        bad += u32::from(shown.is_err());
        bad == 0 || shown.is_err()
    };
    super::page::angles(world.clone(), world.clone(), show).unwrap();
    assert!(good > 10 && bad > 0, "{good} angles, {bad} without");
    world.is_content();
}

/// Answers with what a test has put there, and keeps what is written.
struct Memory {
    words: [u32; 0x600],
    /// This word changes whenever it is read.
    moves: Option<u32>,
    /// This access fails, and no other one.
    fails_at: Option<u32>,
    accesses: u32,
}

/// An access that failed.
#[derive(Debug, PartialEq)]
struct Failed;

impl Memory {
    fn new(words: [u32; 0x600]) -> Self {
        Self {
            words,
            moves: None,
            fails_at: None,
            accesses: 0,
        }
    }

    fn access(&mut self, word_address: u32) -> Result<&mut u32, Error<Failed>> {
        self.accesses += 1;
        if self.fails_at == Some(self.accesses) {
            return Err(Error::Link(Failed));
        }
        self.words
            .get_mut(word_address as usize)
            .ok_or(Error::Argument)
    }
}

impl Link for Memory {
    type Error = Failed;

    fn read(&mut self, word_address: u32) -> Result<u32, Error<Failed>> {
        let moves = u32::from(self.moves == Some(word_address));
        let word = self.access(word_address)?;
        *word += moves;
        Ok(*word)
    }

    fn write(&mut self, word_address: u32, value: u32) -> Result<(), Error<Failed>> {
        *self.access(word_address)? = value;
        Ok(())
    }
}

/// Time that nobody measures.
struct NoTime;

impl DelayNs for NoTime {
    fn delay_ns(&mut self, _: u32) {}
}

/// Word address of a register of the card, of its configuration, of channel 0.
fn at(block: &regs::Block, name: &str) -> u32 {
    block.address(block.word(name), 0).into()
}

/// A card of two channels with these parts, as its words tell.
fn words_of(parts: &[Part]) -> [u32; 0x600] {
    let mut words = [0; 0x600];
    let mut put = |name, value| words[at(&regs::CARD, name) as usize] = value;
    put("id", regs::ID);
    put("version", u32::from(regs::VERSION[0]) << 24 | 0x99 << 16);
    put("system_hz", 1_000_000);
    let field = |name| regs::CARD.field("capabilities", name);
    let features = parts.iter().fold(0, |word, part| word | 1 << *part as u32);
    let word = field("channels").put(0, 2).unwrap();
    let word = field("max_position_bits").put(word, 48).unwrap();
    put(
        "capabilities",
        field("features").put(word, features).unwrap(),
    );
    words
}

fn opened(memory: Memory) -> Card<Memory, NoTime> {
    let mut card = Card::open(memory, NoTime, None).unwrap();
    card.link_mut().accesses = 0;
    card
}

#[test]
fn what_no_card_says_is_refused() {
    let open = |change: &dyn Fn(&mut [u32; 0x600])| {
        let mut words = words_of(&[]);
        change(&mut words);
        Card::open(Memory::new(words), NoTime, None)
    };
    let mut card = open(&|_| ()).unwrap();
    card.try_link().unwrap();
    assert_eq!(card.facts().protocol(40), Protocol::Endat);
    assert_eq!(card.calibrate(1 << 2), Err(Error::Argument));
    assert_eq!(card.read_word(0x4000), Err(Error::Argument));
    let refused = |name, word| {
        let change = |words: &mut [u32; 0x600]| words[at(&regs::CARD, name) as usize] = word;
        open(&change).err().unwrap()
    };
    assert_eq!(refused("id", 0), Error::NoCard);
    assert_eq!(refused("system_hz", 0), Error::NoCard);
    assert_eq!(refused("capabilities", 0), Error::NoCard);
    let later = refused("version", 0x7F00_0000);
    assert_eq!(later, Error::Version { found: 0x7F });
    let told = later.to_string();
    assert!(told.contains("version 127 of the register map"), "{told}");
}

/// Catches parts of the position that are told as each other, and words of another channel.
#[test]
fn the_parts_of_a_t_format_position_are_told_one_by_one() {
    for (word, told) in [(0, [false; 2]), (1, [true, false]), (2, [false, true])] {
        let mut words = words_of(&[Part::TFormat]);
        words[at(&regs::CARD, "protocols") as usize] = 1 << 1;
        let parts = regs::T_FORMAT.address(regs::T_FORMAT.word("parts"), 1);
        words[usize::from(parts)] = word;
        let fields = opened(Memory::new(words)).read_fields(1).unwrap();
        assert_eq!([fields.has_single_turn, fields.has_multi_turn], told);
    }
}

/// Catches results that stand still for ever, and sources that are off, because one access in between has failed.
#[test]
fn one_failed_access_leaves_the_card_as_it_was() {
    let hold = at(&regs::CARD_CONFIG, "hold") as usize;
    let mut held = 0;
    for fails_at in 1..80 {
        let mut card = opened(Memory::new(words_of(&[])));
        // A result comes between any two looks: the driver holds them.
        card.link_mut().moves = Some(at(&regs::RESULT, "status"));
        card.link_mut().fails_at = Some(fails_at);
        let became = card.read_moment();
        let memory = card.link();
        held += u32::from(memory.accesses > 40);
        assert_eq!(memory.words[hold], 0, "access {fails_at}: {became:?}");
        let reached = memory.accesses >= fails_at;
        // One that fails when the results are let go is tried again.
        assert!(
            became.is_err() == reached || fails_at > 40,
            "access {fails_at}: {became:?}"
        );
    }
    assert!(held > 20, "{held}");
    let sources = at(&regs::CARD_CONFIG, "trigger_sources") as usize;
    let mut failed = 0;
    for fails_at in 1..30 {
        let mut words = words_of(&[]);
        words[sources] = 6;
        let frame = at(&regs::CHANNEL_CONFIG, "frame") as usize;
        words[frame] = 20 | 29 << 16 | u32::from(ModeCommand::SendPosition.code()) << 24;
        let mut card = opened(Memory::new(words));
        let settings = card.read_settings(0).unwrap();
        for what in 0..2 {
            card.link_mut().accesses = 0;
            card.link_mut().fails_at = Some(fails_at);
            let became = match what {
                0 => card.set_triggers(HOST_AND_TIMER, Some(1_000)),
                _ => card.write_settings(0, &settings),
            };
            // The last access of all is the read that says how the sources are.
            failed += u32::from(became.is_err());
            assert_eq!(
                card.link().words[sources],
                6,
                "{what}, access {fails_at}: {became:?}"
            );
        }
    }
    assert!(failed > 15, "{failed}");
}

/// Catches a card that has begun anew, whose count of requests is another one, taken for an answer.
#[test]
fn what_was_asked_before_a_restart_has_no_answer() {
    let mut words = words_of(&[Part::Requests]);
    let (state, request_state) = (
        at(&regs::SERVICE, "state"),
        at(&regs::SERVICE, "request_state"),
    );
    words[request_state as usize] = 5 << 16;
    let mut card = opened(Memory::new(words));
    let ask = |card: &mut Card<Memory, NoTime>| card.request(0, ModeCommand::SendParameter, 1, 0);
    assert_eq!(
        ask(&mut card),
        Err(Error::Busy),
        "its service has not begun"
    );
    card.write_word(state, 1 << 16).unwrap();
    let request = ask(&mut card).unwrap();
    assert_eq!(card.poll(&request), Err(Error::Busy));
    card.write_word(request_state, 6 << 16).unwrap();
    assert!(card.poll(&request).is_ok());
    card.write_word(request_state, 0).unwrap();
    assert_eq!(card.poll(&request), Err(Error::Restarted));
    assert_eq!(
        card.select_additional_data(0, &[0x4F]),
        Err(Error::Argument)
    );
}

/// Catches a bus that is stuck taken for a card that has nothing to say.
#[test]
fn ones_for_ever_are_no_empty_stream_and_no_card() {
    let mut words = words_of(&[Part::Stream]);
    for name in ["stream_state", "stream_data"] {
        words[at(&regs::CARD, name) as usize] = u32::MAX;
    }
    let mut card = opened(Memory::new(words));
    let mut stream = card.start_stream(true).unwrap();
    let sets: Vec<_> = (0..4).map(|_| card.next_set(&mut stream)).collect();
    assert!(sets.iter().all(|set| *set == Err(Error::Set)), "{sets:?}");
    for byte in [0, 0xFF] {
        let opened = Card::open(Spi::new(Stuck(byte)), NoTime, None);
        assert_eq!(opened.err(), Some(Error::NoCard));
    }
}

/// A bus on which nobody answers.
struct Stuck(u8);

impl ErrorType for Stuck {
    type Error = Infallible;
}

impl SpiDevice for Stuck {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        if let [Operation::TransferInPlace(bytes)] = operations {
            bytes.fill(self.0);
        }
        Ok(())
    }
}

#[test]
fn positions_are_numbers_around_zero() {
    assert_eq!(signed(0x1FFF_FFFF, 29), -1);
    assert_eq!(signed(0x0FFF_FFFF, 29), 0x0FFF_FFFF);
    assert_eq!(
        (signed(5, 0), signed(u64::MAX, 64), signed(1, 1)),
        (0, -1, -1)
    );
    assert_eq!(difference(0x1FFF_FFFE, 3, 29), 5);
    assert_eq!(difference(3, 0x1FFF_FFFE, 29), -5);
}

/// Catches a use of the standard library, or of a heap: neither is there on the processors that this is for.
#[test]
fn it_needs_no_standard_library() {
    let home = Path::new(env!("CARGO_MANIFEST_DIR")).join("drivers/rust");
    for entry in std::fs::read_dir(&home).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            for word in ["std::", "alloc::", "extern crate"] {
                assert!(!text.contains(word), "{}: {word}", path.display());
            }
        }
    }
}

/// Catches letters in a wrong order, digits that are lost, and a difference from the driver in C, which reads the same lines.
#[test]
fn name_plates_are_decoded_as_the_driver_in_c_does() {
    let lines = include_str!("plates.h").lines();
    let mut seen = 0;
    for line in lines.filter(|line| line.starts_with('{')) {
        let plain = line.trim_end_matches(',').replace(['{', '}'], "");
        let parts: Vec<&str> = plain.split(", ").collect();
        let word = |name: &str| {
            let (kind, number) = name.split_once('_')?;
            let number: usize = number.parse().ok()?;
            let at = match kind {
                "id" => number,
                "serial" => 3 + number,
                _ => return None,
            };
            u16::from_str_radix(parts[at].trim_start_matches("0x"), 16).ok()
        };
        let plate = NamePlate::of(word);
        let told = [plate.id, plate.serial].map(|number| number.unwrap().to_string());
        let wanted = [parts[6], parts[7]].map(|text| text.trim_matches('"'));
        assert_eq!(told, wanted);
        assert_eq!((plate.steps, plate.rotary), (None, None));
        seen += 1;
    }
    assert_eq!(seen, 4);
    for (kind, rotary) in [(0x8000, true), (0x7FFF, false)] {
        let words = [
            ("position_bits", 0x4025),
            ("encoder_type", kind),
            ("steps_low", 1),
            ("steps_high", 0x0200),
            ("revolutions", 4096),
        ];
        let plate = NamePlate::of(|name| Some(words.iter().find(|word| word.0 == name)?.1));
        let steps = (plate.steps, plate.revolutions);
        assert_eq!(
            (plate.position_bits, plate.rotary),
            (Some(37), Some(rotary))
        );
        assert_eq!((steps, plate.id), ((Some(0x0200_0001), Some(4096)), None));
    }
}
