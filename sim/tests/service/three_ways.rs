//! A port with its service at work with an encoder: the recorded inputs of the bench are applied to every execution of the design.

use super::rig::{hasty, quick, times};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::endat::{
    channel::FixedTimes,
    service::{map::word, program::ServiceTimes},
};
use endat_hdl::{encoder_port::EncoderPort, protocol::ModeCommand};
use endat_sim::{
    bench::{Bench, ChannelSettings, Link, PinNames},
    encoder::EncoderConfig,
    line::LineConfig,
    Time, US,
};
use rtl_design::elaborate::{elaborate, Design};
use rtl_design::engine::Compiled;
use rtl_design::kernel_engine;
use rust_hdl::prelude::Block;

/// Clocks and times of a recorded run.
struct Life {
    name: &'static str,
    system_hz: u64,
    endat_hz: u64,
    /// Clock of the frame that measures the delay.
    calibration_hz: u64,
    /// Time from the first trigger to its result and the end of the measuring frame.
    first: Time,
    /// Trigger period.
    next: Time,
    /// Triggers after the first.
    triggers: u128,
    /// Additional data that the service selects by default; otherwise the host lists them.
    info: Option<u8>,
    encoder: EncoderConfig,
}

impl Life {
    fn block(&self) -> EncoderPort {
        let service = ServiceTimes {
            gap_ms: 0,
            system_khz: (self.system_hz / 1_000) as u32,
            infos: [self.info.unwrap_or(0), 0, 0, 0, 0, 0, 0, 0],
            ..times(false)
        };
        let fixed = FixedTimes {
            abort_us: 50,
            calibration_period_cycles: self.system_hz / self.calibration_hz,
            ..FixedTimes::at(self.system_hz)
        };
        let mut block = EncoderPort::new(fixed, Some(&service), false);
        block.connect_all();
        block
    }

    /// Positions, an attached selection, additional data, a separate request frame; cycle by cycle.
    fn recorded(&self, design: &Design) -> Stimulus {
        let bits = self.encoder.position_bits;
        let link = Link::new(LineConfig::cable(10.0), self.encoder.clone());
        let engine = Compiled::new(design).unwrap();
        let mut bench = Bench::new(engine, self.system_hz, vec![(PinNames::channel(), link)]);
        bench.record_cycles();
        let command = ModeCommand::SendPositionAddInfo;
        bench.configure(&ChannelSettings::new(
            self.system_hz,
            self.endat_hz,
            command,
            bits,
        ));
        bench.power_up();
        bench.run_for(20 * US);
        bench.trigger();
        bench.run_for(self.first);
        let write = |bench: &mut Bench<Compiled>, word: u8, value: u32| {
            bench.set("host_address", word.into());
            for half in [1, 0] {
                bench.set("host_half", half);
                bench.set("host_data", (value >> (16 * half) & 0xFFFF).into());
                bench.set("host_write", 1);
                bench.run_cycles(1);
                bench.set("host_write", 0);
                bench.run_cycles(8);
            }
        };
        if self.info.is_none() {
            write(&mut bench, word::LIST, 0x4C);
            write(&mut bench, word::LIST_LENGTH, 1);
        }
        for _ in 0..self.triggers {
            bench.trigger();
            bench.run_for(self.next);
        }
        write(&mut bench, word::REQUEST, 0x0E << 24 | 0xA1 << 16);
        bench.run_for(self.next);
        bench.set("host_address", word::REQUEST_STATE.into());
        bench.set("host_read", 1);
        bench.run_cycles(1);
        bench.set("host_read", 0);
        bench.run_for(5 * US);
        let cycles = bench.cycles().unwrap();
        let inputs: Vec<usize> = (0..cycles.ports.len())
            .filter(|i| cycles.ports[*i].is_input)
            .collect();
        Stimulus {
            middle: vec![],
            inputs: inputs
                .iter()
                .map(|i| cycles.ports[*i].name.clone())
                .collect(),
            cycles: (cycles.rows.iter())
                .map(|row| inputs.iter().map(|i| row[*i]).collect())
                .collect(),
        }
    }

    fn agrees(&self) {
        let design = elaborate(&self.block(), "encoder_port").unwrap();
        let mut kernel = kernel_engine!(self.block(); clock;
            in reset, tick_us, timestamp, trigger, calibrate, request_id, field_gap_us;
            out recovery_cycles, delay_cycles, busy, sample_strobe, request_runs, line_high, trigger_lost, reply, calibrated, alarm;
            bundles line, settings, window, result, end, record);
        let stimulus = self.recorded(&design);
        let seen = three_way(self.name, &mut kernel, &design, &stimulus).unwrap();
        let last = |name: &str| *seen.output(name).last().unwrap();
        assert_eq!((last("sequence"), last("fresh")), (1 + self.triggers, 1));
        assert_eq!((last("info_active"), last("info_1")), (1, 0x0C_0B8A));
        assert_eq!((last("reply"), last("reply_good")), (0xA1_0000, 1));
    }
}

#[test]
fn kernels_engines_and_verilog_agree_on_requests() {
    let mut encoder = hasty(EncoderConfig::endat22(3));
    encoder.tm = 2 * US..=3 * US;
    encoder.tac = 0..=0;
    let short = Life {
        name: "encoder_port",
        system_hz: 10_000_000,
        // 6 and 10 cycles.
        endat_hz: 1_666_667,
        calibration_hz: 1_000_000,
        first: 120 * US,
        next: 80 * US,
        triggers: 2,
        info: Some(0x4C),
        encoder,
    };
    short.agrees();
}

#[test]
#[ignore = "slow: a port at 32 MHz whose first frame is slow"]
fn kernels_engines_and_verilog_agree_on_requests_at_32_mhz() {
    let long = Life {
        name: "encoder_port_32_mhz",
        system_hz: 32_000_000,
        endat_hz: 2_000_000,
        calibration_hz: 200_000,
        first: 250 * US,
        next: 110 * US,
        triggers: 3,
        info: None,
        encoder: quick(EncoderConfig::endat22(13)),
    };
    long.agrees();
}
