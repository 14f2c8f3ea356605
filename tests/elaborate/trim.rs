//! What a trimmed design leaves out makes no difference: whole and trimmed design side by side.

use crate::strangers::configurations::texts;
use endat_config::{parse_any, Configuration};
use endat_sim::rng::Rng;
use rtl_design::elaborate::{Design, Module};
use rtl_design::engine::{Compiled, Engine};

const CYCLES: usize = 6000;
/// A UART, buses, each protocol, outputs, a service, a receiver.
const QUICK: [&str; 6] = [
    "one_bit",
    "axi_lite",
    "bare_requests",
    "ssi",
    "t_format",
    "fast_receiver",
];

/// Random lines, most of which stay for a while, on both; the first output that differs.
fn difference(whole: &Design, trimmed: &Design, seed: u64) -> Option<String> {
    let mut engines = [whole, trimmed].map(|design| Compiled::new(design).unwrap());
    // The same ports in the same order.
    let ports: Vec<_> = engines[0].ports().to_vec();
    let ids = engines.each_ref().map(|engine| {
        let names = engine.ports().iter().map(|port| port.name.as_str());
        names.map(|name| engine.port(name)).collect::<Vec<_>>()
    });
    let mut rng = Rng::new(seed);
    let mut held = vec![0u128; ports.len()];
    for cycle in 0..CYCLES {
        for (index, port) in ports.iter().enumerate().filter(|(_, port)| port.is_input) {
            if cycle == 0 || rng.in_range(1, 8) == 1 {
                let random = rng.next_u64() as u128 | (rng.next_u64() as u128) << 64;
                held[index] = random & (u128::MAX >> (128 - port.width_bits));
            }
            let value = match port.name.as_str() {
                "rst_i" => (cycle < 3).into(),
                _ => held[index],
            };
            for (engine, ids) in engines.iter_mut().zip(&ids) {
                engine.set(ids[index], value);
            }
        }
        for (index, port) in ports.iter().enumerate().filter(|(_, port)| !port.is_input) {
            let one = engines[0].get(ids[0][index]);
            let other = engines[1].get(ids[1][index]);
            if one != other {
                return Some(format!("{}, cycle {cycle}: {one:x}, {other:x}", port.name));
            }
        }
        for engine in &mut engines {
            engine.fall();
            engine.tick();
        }
    }
    None
}

fn design(configuration: &Configuration) -> Design {
    match configuration {
        Configuration::Card(project) => endat_emit::design(project).unwrap(),
        Configuration::Receiver(receiver) => {
            endat_emit::protocols::t_format::design(receiver).unwrap()
        }
    }
}

fn lines(design: &Design) -> usize {
    let of = |module: &Module| module.nets.len() + module.processes.len();
    design.modules.iter().map(of).sum()
}

fn agree(is_wanted: impl Fn(&str) -> bool) -> usize {
    let texts = (1..).zip(texts());
    let wanted: Vec<_> = texts.filter(|(_, (name, _))| is_wanted(name)).collect();
    for (seed, (name, text)) in &wanted {
        let configuration = parse_any(&format!("{name}.toml"), text).unwrap();
        let whole = design(&configuration);
        let trimmed = whole.trimmed();
        assert!(lines(&trimmed) < lines(&whole), "{name}");
        assert_eq!(difference(&whole, &trimmed, *seed), None, "{name}");
    }
    wanted.len()
}

#[test]
fn some_emissions_do_what_their_whole_designs_do() {
    assert_eq!(agree(|name| QUICK.contains(&name)), QUICK.len());
}

#[test]
#[ignore = "slow: every emission"]
fn every_emission_does_what_its_whole_design_does() {
    assert!(agree(|name| !QUICK.contains(&name)) > 30);
}
