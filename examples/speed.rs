use endat_gen::config::{load_preset, DEFAULT_PRESET};
use endat_hdl::card::Card;
use endat_hdl::elaborate::elaborate;
use endat_sim::{bench::*, engine::*, scenario};
use rust_hdl::prelude::Block;
#[derive(Clone, Copy)]
struct Instant(u64);
fn cpu() -> u64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap()
}
impl Instant {
    fn now() -> Self {
        Instant(cpu())
    }
    fn elapsed(&self) -> std::time::Duration {
        std::time::Duration::from_nanos(cpu() - self.0)
    }
}
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
    let s = scenario::named("paper").unwrap();
    {
        let e = Compiled::new(&d).unwrap();
        let n = 300_000u64;
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
    {
        let e = Lanes::new(&d, Keep::Outputs, LaneWords::Two).unwrap();
        let n = 200_000u64;
        let mut b = LaneBench::new(
            e,
            100_000_000,
            vec![
                (PinNames::card(0), (0..128).map(|_| s.link(0)).collect()),
                (PinNames::card(1), (0..128).map(|_| s.link(0)).collect()),
            ],
        );
        b.set_all("uart_rx_i", 1);
        b.set_all("rst_i", 1);
        for _ in 0..8 {
            b.tick();
        }
        b.set_all("rst_i", 0);
        let t = Instant::now();
        for _ in 0..n {
            b.tick();
        }
        let el = t.elapsed().as_secs_f64();
        println!(
            "lanes card models: {:.2} M lane-cycles/s frames {}",
            n as f64 * 128.0 / el / 1e6,
            (0..128)
                .map(|l| b.link(0, l).encoder().frames().len())
                .sum::<usize>()
        );
    }
    // channel
    {
        use endat_hdl::{channel::*, protocol::ModeCommand};
        use endat_sim::{encoder::EncoderConfig, line::LineConfig};
        let mut c = Channel::new(FixedTimes::at(128_000_000));
        c.connect_all();
        let d = elaborate(&c, "channel").unwrap();
        let e = Lanes::new(&d, Keep::Outputs, LaneWords::Two).unwrap();
        let mut set = ChannelSettings::new(
            128_000_000,
            16_000_000,
            ModeCommand::SendPositionAddInfo,
            29,
        );
        set.first_low_extra_cycles = 4;
        let links = (0..128)
            .map(|i| {
                let mut c = EncoderConfig::endat22(29).seed(i);
                c.tcal = 600_000;
                c.tm = 1_250_000..=1_250_000;
                Link::new(LineConfig::cable(i as f64 / 2.0), c)
            })
            .collect();
        let mut b = LaneBench::new(e, 128_000_000, vec![(PinNames::channel(), links)]);
        for l in 0..128 {
            b.configure(l, &set);
        }
        b.set_all("reset", 1);
        for _ in 0..8 {
            b.tick();
        }
        b.set_all("reset", 0);
        let n = 100_000u64;
        let t = Instant::now();
        for _ in 0..n {
            for p in 0..2 {
                let busy = b.busy(p);
                b.set_trigger(p, !busy);
            }
            b.tick();
        }
        let el = t.elapsed().as_secs_f64();
        let fr = (0..128)
            .map(|l| b.link(0, l).encoder().frames().len())
            .sum::<usize>();
        let good: usize = (0..128)
            .map(|l| b.results(l).iter().filter(|r| r.cause == 0).count())
            .sum();
        println!("lanes channel: {:.2} M lane-cycles/s frames {} good {} -> {:.0} frames/s viol {:?} res {:?}", n as f64*128.0/el/1e6, fr, good, fr as f64/el, b.link(0,0).encoder().violations().iter().take(3).collect::<Vec<_>>(), b.results(0).last());
    }
}
