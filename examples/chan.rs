//! scratch
use endat_hdl::{channel::*, elaborate::elaborate, protocol::ModeCommand};
use endat_sim::{bench::*, encoder::EncoderConfig, engine::*, line::LineConfig};
use rust_hdl::prelude::Block;
fn cpu() -> u64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap()
}
fn main() {
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
    let n = 300_000u64;
    let t = cpu();
    for _ in 0..n {
        for p in 0..2 {
            let busy = b.busy(p);
            b.set_trigger(p, !busy);
        }
        b.tick();
    }
    let el = (cpu() - t) as f64 / 1e9;
    let fr = (0..128)
        .map(|l| b.link(0, l).encoder().frames().len())
        .sum::<usize>();
    let good: usize = (0..128)
        .map(|l| b.results(l).iter().filter(|r| r.cause == 0).count())
        .sum();
    println!("lanes channel: {:.2} M lane-cycles/s frames {} good {} -> {:.0} frames/s {:.0} cycles/frame", n as f64 * 128.0 / el / 1e6, fr, good, fr as f64 / el, n as f64*128.0/fr as f64);
}
