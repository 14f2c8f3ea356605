//! A driver that changes the rate of the clock while the card is running, over the bus.

use super::Master;
use endat_config::load_preset;
use endat_hdl::endat::channel::CALIBRATION_FRAMES;
use endat_hdl::regs::{Block, CARD, CHANNEL_CONFIG, RESULT};
use endat_sim::US;

fn at(block: &Block, name: &str, channel: usize) -> u16 {
    block.address(block.register(name).unwrap(), channel)
}

/// Rates in hertz, and the start window in cycles that is a quarter of their period, as far as its field goes.
const RATES: [(u64, u32); 7] = [
    (16_000_000, 2),
    (8_000_000, 4),
    (4_000_000, 8),
    (2_000_000, 16),
    (1_000_000, 32),
    (200_000, 63),
    (100_000, 63),
];

/// Catches a period that does not reach the clock, and a channel that another one's rate disturbs. Channel 0 has so many of the rates.
fn rates_at_run_time(count: usize) {
    let project = load_preset("artinchip_endat_if").unwrap();
    let mut master = Master::with_widths(&project, &[25, 25]);
    let system_hz = project.card.system_hz;
    for index in 0..count {
        // Channel 1 has the rates the other way round.
        let rates = [RATES[index], RATES[RATES.len() - 1 - index]];
        for (channel, (hz, window)) in rates.into_iter().enumerate() {
            assert_eq!(system_hz % hz, 0);
            let period = (system_hz / hz) as u32;
            let frame = at(&CHANNEL_CONFIG, "frame", channel);
            let word = master.read(frame) & !0x7ff;
            master.write(frame, word | period);
            master.write(at(&CHANNEL_CONFIG, "timing", channel), window << 16);
            let limits = at(&CHANNEL_CONFIG, "limits", channel);
            let word = master.read(limits) & !0xfff;
            master.write(limits, word | 100);
        }
        // The first frames measure the delay. A frame has at most 64 periods, then the recovery time.
        let slowest_hz = rates[0].0.min(rates[1].0);
        let frame_us = 60 + 64_000_000 / slowest_hz;
        for _ in 0..=CALIBRATION_FRAMES {
            master.write(at(&CARD, "trigger_now", 0), 1);
            master.bench.run_cycles(frame_us * system_hz / 1_000_000);
        }
        for (channel, (hz, _)) in rates.into_iter().enumerate() {
            let status = master.read(at(&RESULT, "status", channel));
            assert_eq!(status >> 16 & 0xff, 0xc0, "{hz} Hz: {status:#x}");
            let position = master.read(at(&RESULT, "position_low", channel));
            let frames = master.bench.frames(channel);
            let frame = frames.last().unwrap();
            assert_eq!(u64::from(position), frame.position, "{hz} Hz");
            let period = 1_000_000 * US / hz;
            assert!(frame.period.abs_diff(period) < period / 100, "{hz} Hz");
        }
    }
}

/// Channel 1 has the other rates.
#[test]
fn seven_rates_at_run_time_and_two_of_them_at_once() {
    rates_at_run_time(RATES.len().div_ceil(2));
}

#[test]
#[ignore = "slow: every rate at run time on either channel"]
fn seven_rates_at_run_time_on_either_channel() {
    rates_at_run_time(RATES.len());
}
