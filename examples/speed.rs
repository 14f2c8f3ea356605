use endat_gen::config::{load_preset, DEFAULT_PRESET};
use endat_hdl::card::Card;
use endat_hdl::elaborate::elaborate;
use endat_sim::{bench::*, engine::*, scenario};
use rust_hdl::prelude::Block;
use std::time::Instant;
fn main() {
    let card = load_preset(DEFAULT_PRESET).unwrap().card;
    let mut b = Card::new(&card);
    b.connect_all();
    let t = Instant::now();
    let d = elaborate(&b, "card").unwrap();
    println!("elaborate {:?}", t.elapsed());
    let t = Instant::now();
    let mut e = Compiled::new(&d).unwrap();
    println!(
        "compile {:?} fallback {:?} {}",
        t.elapsed(),
        e.fallback(),
        e.stats()
    );
    let n = 5_000_000u64;
    let run = |e: &mut dyn Engine| {
        let (rst, d0, d1, rx, clk) = (
            e.port("rst_i"),
            e.port("endat_data0_i"),
            e.port("endat_data1_i"),
            e.port("uart_rx_i"),
            e.port("endat_clk0_o"),
        );
        e.set(rst, 1);
        e.set(rx, 1);
        let mut x = 1u32;
        let mut acc = 0;
        let t = Instant::now();
        for i in 0..n {
            if i == 8 {
                e.set(rst, 0);
            }
            if i & 15 == 0 {
                x = x.wrapping_mul(1664525).wrapping_add(1013904223);
                e.set(d0, (x >> 31).into());
                e.set(d1, (x >> 30 & 1).into());
            }
            e.tick();
            acc += e.get(clk);
        }
        println!(
            "{:.2} Mcycles/s {acc}",
            n as f64 / t.elapsed().as_secs_f64() / 1e6
        );
    };
    run(&mut e);
    let s = scenario::named("paper").unwrap();
    for w in [LaneWords::One, LaneWords::Two] {
        let t = Instant::now();
        let mut e = Lanes::new(&d, Keep::Outputs, w).unwrap();
        println!(
            "lanes compile {:?} {:?} state {} gates {}",
            t.elapsed(),
            e.fallback(),
            e.state_bytes(),
            e.stats()
        );
        let (rst, d0, d1, rx, clk) = (
            e.port("rst_i"),
            e.port("endat_data0_i"),
            e.port("endat_data1_i"),
            e.port("uart_rx_i"),
            e.port("endat_clk0_o"),
        );
        e.set_all(rst, 1);
        e.set_all(rx, 1);
        let n = 200_000u64;
        let t = Instant::now();
        let mut x = 1u64;
        let mut acc = 0;
        for i in 0..n {
            if i == 8 {
                e.set_all(rst, 0);
            }
            if i > 10 {
                for p in 0..w.count() {
                    x = x
                        .wrapping_mul(6364136223846793005)
                        .wrapping_add(1442695040888963407);
                    let y = x >> 32;
                    e.set_word(d0, 0, p, y << 32 | y);
                    e.set_word(d1, 0, p, x);
                }
            }
            e.tick();
            acc += e.word(clk, 0, 0).count_ones() as u64;
        }
        let s = t.elapsed().as_secs_f64();
        println!(
            "noise: {:.2} M lane-cycles/s {acc}  {:.0} ns/pass",
            n as f64 * e.lanes() as f64 / s / 1e6,
            s / n as f64 * 1e9
        );
    }
    let links: Vec<_> = (0..2)
        .map(|i| (PinNames::card(i), s.link(i.min(s.channels.len() - 1))))
        .collect();
    for keep in [Keep::Outputs, Keep::Registers] {
        let e = Compiled::keeping(&d, keep).unwrap();
        let mut bench = Bench::new(
            e,
            100_000_000,
            vec![
                (PinNames::card(0), s.link(0)),
                (PinNames::card(1), s.link(0)),
            ],
        );
        bench.reset();
        let t = Instant::now();
        bench.run_cycles(n);
        let el = t.elapsed().as_secs_f64();
        println!(
            "models: {:.2} Mcycles/s frames {} viol {:?}",
            n as f64 / el / 1e6,
            bench.frames(0).len(),
            bench.violations(0).len()
        );
    }
    let _ = links;
    let e = Interpreter::new(&d).unwrap();
    let mut bench = Bench::new(
        e,
        100_000_000,
        vec![
            (PinNames::card(0), s.link(0)),
            (PinNames::card(1), s.link(0)),
        ],
    );
    bench.reset();
    let n = 500_000;
    let t = Instant::now();
    bench.run_cycles(n);
    let el = t.elapsed().as_secs_f64();
    println!(
        "interp models: {:.2} Mcycles/s frames {}",
        n as f64 / el / 1e6,
        bench.frames(0).len()
    );
}
