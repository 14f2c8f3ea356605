//! The virtual card of every bus: the host's words go over the pins of that bus, and everything that the host can do is done.

use super::{card_of, found, SERVICE};
use endat_card::{card_at, Door, VirtualCard, VirtualConfig};
use endat_config::{parse, parse_any, preset, Configuration, Project};
use endat_hdl::card::bus::HostBus;
use endat_hdl::regs::ID;
use endat_host::feed::Feed;
use endat_host::registers::Place;
use endat_host::Bridge;
use endat_sim::{MS, US};
use std::collections::VecDeque;
use std::time::Duration;

/// Every bus that has a controller here.
const BUSES: [HostBus; 5] = [
    HostBus::Apb,
    HostBus::Wishbone,
    HostBus::AxiLite,
    HostBus::Spi,
    HostBus::Parallel,
];

/// A card of this bus at this clock, with a timer and a stream.
fn project(bus: HostBus, system_hz: u64) -> Project {
    let text = format!(
        "name = \"card\"\n[clock]\nsystem_hz = {system_hz}\n[endat]\nclock_hz = 2_000_000\n\
         [[channel]]\nposition_bits = 25\ncommand = \"111000\"\n[[channel]]\nposition_bits = 37\ncommand = \"000111\"\n\
         [trigger]\nsample_hz = 4_000\nsources = [\"timer\"]\n[host]\nbus = \"{}\"\n\
         [service]\nparts = [\"requests\", \"initialise\"]\n[stream]\nfifo_bytes = 1_024\n",
        bus.name()
    );
    parse("card.toml", &text).unwrap()
}

/// Everything that a host does, over each of these buses, at a system clock in megahertz; so many rows of the stream are read.
fn works_over(buses: &[(HostBus, u64)], results: u32, count: usize) {
    for &(bus, system_hz) in buses {
        let mut card = found(&project(bus, system_hz * 1_000_000));
        assert_eq!(card.bridge().read(0, 1).unwrap(), [ID], "{bus:?}");
        for channel in [0, 1] {
            card.wait_for_initialisation(channel).unwrap();
        }
        // Whatever a host writes comes back, and an absent word is 0.
        let period = card.place("card_config.trigger_period").unwrap();
        let written = card.read(&period).unwrap() + 7;
        card.write(&period, written).unwrap();
        assert_eq!(card.read(&period).unwrap(), written, "{bus:?}");
        assert_eq!(card.bridge().read(0x7FF, 1).unwrap(), [0]);
        assert_eq!(card.bridge().read(0xF000, 1).unwrap(), [0]);
        assert_eq!(card.bridge().read(0x7FF, 2).unwrap(), [0, 0], "{bus:?}");
        // A word of the encoder's memory goes there and back.
        card.write_parameter(0, 0xA7, 3, 0x1234).unwrap();
        let answer = card.read_parameter(0, 0xA7, 3).unwrap();
        assert_eq!(answer.data, 0x1234, "{bus:?}");
        // Results of one moment: those of both channels are of the same trigger.
        for _ in 0..results {
            let results = card.results().unwrap().channels;
            let apart = results[0].timestamp.abs_diff(results[1].timestamp);
            assert!(apart < 8, "{bus:?}: {apart}");
            card.bridge().transport().run(1_237);
        }
        let mut feed = Feed::begin(&mut card, false).unwrap();
        let mut rows = VecDeque::new();
        while rows.len() < count {
            let wait = Duration::from_millis(1);
            feed.fill(&mut card, &mut rows, wait).unwrap();
            // A register is read between two frames.
            assert_eq!(card.bridge().read(0, 1).unwrap(), [ID]);
        }
        feed.end(&mut card).unwrap();
        let sent = [0, 1].map(|n| -> Vec<u64> {
            let frames = card.bridge().transport().bench().frames(n).iter();
            frames.map(|f| f.position).collect()
        });
        for row in &rows {
            assert_eq!(row.missing, 0, "{bus:?}");
            for (cell, sent) in row.cells.iter().zip(&sent) {
                assert!(cell.fresh && sent.contains(&cell.position.unwrap()));
            }
        }
        // And the link is as it was before.
        assert_eq!(card.bridge().read(0, 1).unwrap(), [ID]);
    }
}

/// Catches a controller that is wrong at the pins, words in another order, results of two triggers, and a stream that loses frames: a bus of
/// words, and a serial one.
#[test]
fn a_host_does_over_apb_and_spi_what_it_does_over_a_uart() {
    works_over(&[(HostBus::Apb, 16), (HostBus::Spi, 20)], 10, 20);
}

#[test]
#[ignore = "slow: a host over every bus"]
fn a_host_does_over_every_bus_what_it_does_over_a_uart() {
    let all: Vec<_> = BUSES.into_iter().zip([16, 20, 24, 32, 48]).collect();
    works_over(&all, 40, 60);
}

/// What a port gives for bytes.
fn answer(card: &mut VirtualCard, bytes: &[u8]) -> Vec<u8> {
    card.send_bytes(bytes);
    card.run(20_000);
    card.take_bytes()
}

/// Half a command is forgotten, bytes that begin none are ignored, and nothing of them is written.
#[test]
fn a_controller_forgets_half_a_command_and_ignores_noise() {
    let mut card = card_of(&project(HostBus::Apb, 24_000_000));
    let id = ID.to_be_bytes();
    assert_eq!(answer(&mut card, &[2, 1, 0, 0, 0, 0]), id);
    assert_eq!(answer(&mut card, &[0, 9, 0xFF, 2, 1, 0, 0, 0, 0]), id);
    // A write without its last byte, and then a pause.
    assert!(answer(&mut card, &[1, 1, 0, 0, 1, 1, 0xAA, 0xBB, 0xCC]).is_empty());
    card.run(24 * 6_000);
    assert_eq!(answer(&mut card, &[2, 1, 0, 0, 0, 0]), id);
    let before = answer(&mut card, &[2, 1, 0, 0, 1, 1]);
    assert_ne!(before[..3], [0xAA, 0xBB, 0xCC]);
    // The same of a host that goes.
    card.send_bytes(&[1, 1, 0, 0, 1, 1, 0xAA]);
    card.forget_host();
    assert_eq!(answer(&mut card, &[2, 1, 0, 0, 1, 1]), before);
    // No words at all, and all from one address.
    assert!(answer(&mut card, &[2, 0, 0, 0, 0, 0]).is_empty());
    assert_eq!(answer(&mut card, &[4, 2, 0, 0, 0, 0]), [id, id].concat());
}

/// A T-format receiver has eight addresses: a request is sent, and the reply is what its encoder's shaft says.
#[test]
fn the_receiver_of_a_signal_processor_is_read_by_its_addresses() {
    let Ok(Configuration::Receiver(mut receiver)) =
        parse_any("r.toml", preset("async_dsp").unwrap())
    else {
        panic!("a receiver")
    };
    for fast in [false, true] {
        receiver.start.fast = fast;
        let mut card = VirtualCard::of_receiver(&receiver, &VirtualConfig::default()).unwrap();
        let word = |card: &mut VirtualCard, address: u8| {
            let bytes = answer(card, &[2, 1, 0, 0, 0, address]);
            u32::from_be_bytes(bytes.try_into().unwrap())
        };
        assert_eq!(word(&mut card, 6) & 0xFF00, 0);
        assert!(answer(&mut card, &[1, 1, 0, 0, 0, 0, 0, 0, 0, 3]).is_empty());
        while word(&mut card, 7) >> 15 != 0 {}
        let [w0, w1, w2, _, w4, _, w6] = [0, 1, 2, 3, 4, 5, 6].map(|n| word(&mut card, n));
        assert_eq!((w0, w1 & 0x8F, w6 >> 8), (3, 0x83, 0), "fresh, no alarm");
        let single = w1 >> 8 | (w2 & 0xFF) << 8 | (w2 >> 8) << 16;
        let turns = f64::from(single) / f64::from(1 << 17);
        // 100.1 turns and a quarter of a turn a second, some milliseconds behind power-up.
        let seconds = card.now() as f64 / (1_000.0 * MS as f64);
        assert!((0.1..0.1001 + 0.25 * seconds).contains(&turns), "{turns}");
        assert_eq!(w4 & 0xFF, 0);
        // Nothing is behind them, and nobody writes there: word 8 would be request 3 again.
        let requests = |card: &mut VirtualCard| card.bench().t_format(0).encoder().requests().len();
        let before = requests(&mut card);
        assert!(answer(&mut card, &[1, 1, 0, 0, 0, 8, 0, 0, 0, 3]).is_empty());
        let bytes = answer(&mut card, &[2, 2, 0, 0, 0, 7]);
        assert_eq!((bytes.len(), &bytes[4..]), (8, [0; 4].as_slice()));
        assert_eq!(requests(&mut card), before);
        let violations = card.bench().t_format(0).encoder().violations();
        assert!(violations.is_empty(), "{violations:?}");
    }
    let told = |config| match VirtualCard::of_receiver(&receiver, &config) {
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    };
    let config = VirtualConfig {
        makes_sets: true,
        ..VirtualConfig::default()
    };
    assert!(told(config).contains("has no stream"));
}

/// A card whose sets are made.
fn loaded(project: &Project) -> VirtualCard {
    let config = VirtualConfig {
        makes_sets: true,
        ..VirtualConfig::default()
    };
    VirtualCard::new(project, &config).unwrap()
}

/// Every set that is made comes, with the number and moment of its trigger and the position of the shaft then; over the wrap of both.
#[test]
fn made_sets_are_those_of_a_card_without_faults() {
    const ROWS: usize = 140_000;
    for (bus, infos) in [(HostBus::Uart, false), (HostBus::Spi, true)] {
        let mut project = project(HostBus::Apb, 24_000_000);
        project.bus = bus;
        project.card.stream.additional_data = infos;
        let period = project.card.sample_period_cycles;
        let mut card = endat_host::Card::find(Bridge::new(loaded(&project))).unwrap();
        let mut feed = Feed::begin(&mut card, false).unwrap();
        let mut rows = VecDeque::new();
        while rows.len() < ROWS {
            feed.fill(&mut card, &mut rows, Duration::ZERO).unwrap();
        }
        let trigger = card.place("card.trigger_count").unwrap();
        assert!(card.read(&trigger).unwrap() as usize >= ROWS);
        feed.end(&mut card).unwrap();
        assert_eq!(card.bridge().read(0, 1).unwrap(), [ID], "no push is left");
        let first = rows[0].cycles;
        let turns = |row: usize| rows[row].cells[0].position.unwrap() as f64 / f64::from(1 << 25);
        for (n, row) in rows.iter().enumerate() {
            assert_eq!((row.missing, row.run), (0, None));
            assert_eq!(row.trigger, rows[0].trigger + n as u64);
            assert_eq!(row.cycles, first + n as u64 * period);
            assert!(row.cells.iter().all(|c| c.fresh && c.cause == "none"));
        }
        // A quarter of a turn a second, and a swing of 0.002 turns on top.
        for row in [4_000, 8_000] {
            let seconds = row as f64 * period as f64 / 24e6;
            let moved = turns(row) - turns(0);
            assert!((moved - 0.25 * seconds).abs() < 0.0041, "{row}: {moved}");
        }
    }
}

/// In real time no set comes before its trigger.
#[test]
fn in_real_time_made_sets_come_when_their_triggers_do() {
    let project = project(HostBus::Wishbone, 24_000_000);
    let mut card = endat_host::Card::find(Bridge::new(loaded(&project))).unwrap();
    card.bridge().transport().keep_time();
    let begun = std::time::Instant::now();
    let mut feed = Feed::begin(&mut card, false).unwrap();
    let mut rows = VecDeque::new();
    while rows.len() < 400 {
        feed.fill(&mut card, &mut rows, Duration::from_micros(20))
            .unwrap();
        let most = begun.elapsed().as_secs_f64() * 4_000.0;
        assert!(rows.len() as f64 <= most + 1.0, "{} of {most}", rows.len());
    }
}

/// The card with a service takes them, one without a stream says what is missing.
#[test]
fn sets_are_made_where_there_is_a_stream() {
    let mut project = super::quick(SERVICE);
    assert!(project.card.stream.fifo_bytes > 0);
    let mut card = loaded(&project);
    card.run(20 * US / (MS / 1_000_000));
    project.card.stream.fifo_bytes = 0;
    let config = VirtualConfig {
        makes_sets: true,
        ..VirtualConfig::default()
    };
    let error = VirtualCard::new(&project, &config).err().unwrap();
    assert!(error.to_string().contains("give stream.fifo_bytes"));
}

/// Catches a card that looks at its port once in a period of the timer: each access of a host would meet the same moment of a frame, and who
/// waits for another one would wait for ever.
#[test]
fn host_accesses_fall_at_every_phase_of_the_timer() {
    let mut timed = project(HostBus::AxiLite, 8_000_000);
    timed.card.sample_period_cycles = 800;
    let served = super::ports::Served::new(timed, || Door::tcp("127.0.0.1:0").unwrap());
    let mut card = card_at(&served.name, 0).unwrap();
    let place = Place::named("result0.age_recovery.age_us", 2).unwrap();
    card.wait_until_initialised(|| {}).unwrap();
    // Until there are results.
    let begin = std::time::Instant::now();
    while card.read(&place).unwrap() >= 100 {
        assert!(begin.elapsed() < Duration::from_secs(60), "no result");
    }
    let mut quarters = [0; 4];
    for _ in 0..60 {
        let age_us = card.read(&place).unwrap() as usize;
        quarters[(age_us / 25).min(3)] += 1;
    }
    assert!(quarters.iter().all(|met| *met > 2), "{quarters:?}");
}
