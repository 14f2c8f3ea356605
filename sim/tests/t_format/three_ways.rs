//! The receiver with its bus: kernels, engines and emitted Verilog agree in every cycle.

use super::rig::{design, Rig};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::protocols::t_format::dsp::{AsyncDsp, TFormatStart};
use endat_sim::rng::Rng;
use endat_sim::t_format::{Defect, EncoderConfig};
use rtl_design::kernel_engine;

/// The inputs of a receiver with these requests, defects and a processor that reads continuously.
fn recorded(ids: &[u8]) -> Stimulus {
    let mut rng = Rng::new(7);
    let mut rig = Rig::new(20, EncoderConfig::default());
    rig.record();
    // From power-up on: the line must be at rest.
    rig.wait_us(70);
    for &id in ids {
        rig.encoder.config.single_turn = rng.next_u64() as u32 >> 8;
        rig.encoder.config.multi_turn = rng.next_u64() as u32 >> 8;
        rig.encoder.config.defect = match rng.in_range(0, 5) {
            0 => Defect::Flip {
                field: rng.in_range(0, 3) as usize,
                bit: rng.in_range(0, 7) as usize,
            },
            1 => Defect::Delimiter { field: 1 },
            2 => Defect::Short { fields: 2 },
            _ => Defect::None,
        };
        rig.memory(id, rng.next_u64() as u8, rng.next_u64() as u8);
        rig.pins.trigger = !rig.pins.trigger;
        // The map shows a refused request, without a write before it.
        rig.steps(20);
    }
    rig.pins.reset = true;
    rig.steps(3);
    rig.pins.reset = false;
    // Refused, then accepted: the line must be at rest.
    rig.exchange(2);
    rig.wait_us(70);
    rig.exchange(2);
    rig.recorded()
}

fn agrees(name: &str, ids: &[u8], requests_min: usize) {
    let block = AsyncDsp::new(&TFormatStart::default(), true);
    let mut kernel = kernel_engine!(block; clk_i;
        in rst_i, clk_select_i, trigger_i, bus_cs_n_i, bus_rd_n_i, bus_wr_n_i, bus_address_i, bus_data_i, encoder_data_i;
        out bus_data_o, bus_data_oe, encoder_data_o, encoder_data_oe, led_o);
    let recording = three_way(name, &mut kernel, design(), &recorded(ids)).unwrap();
    // The recording is not trivial.
    let driver = recording.output("encoder_data_oe");
    let requests = driver.windows(2).filter(|w| w[0] < w[1]).count();
    assert!(requests >= requests_min, "{requests}");
    assert!(recording.output("led_o").contains(&1));
}

/// A position, a write, a read, an unknown request.
#[test]
fn the_receiver_agrees_in_kernels_engines_and_verilog() {
    agrees("async_dsp", &[3, 6, 13, 4], 3);
}

#[test]
#[ignore = "slow: requests of all kinds"]
fn the_receiver_agrees_on_requests_of_all_kinds() {
    let ids = [3, 0, 1, 2, 6, 13, 7, 4, 3, 3, 0];
    agrees("async_dsp_all", &ids, 10);
}
