//! Random stimulus.

use crate::rng::Rng;
use crate::three_way::Stimulus;
use rtl_design::elaborate::{Design, Direction, Net};
use rtl_design::engine::Engine;

/// Random values for all inputs of an engine; `reset` is high in the first cycle and now and then.
pub fn random_stimulus(engine: &dyn Engine, cycles: usize, seed: u64) -> Stimulus {
    let mut rng = Rng::new(seed);
    let inputs: Vec<_> = engine.ports().iter().filter(|p| p.is_input).collect();
    let value = |cycle: usize, name: &str, width: usize, rng: &mut Rng| match name {
        "reset" => (cycle.is_multiple_of(64)).into(),
        _ => {
            (rng.next_u64() as u128 | (rng.next_u64() as u128) << 64) & (u128::MAX >> (128 - width))
        }
    };
    Stimulus {
        middle: vec![],
        cycles: (0..cycles)
            .map(|cycle| {
                inputs
                    .iter()
                    .map(|p| value(cycle, &p.name, p.width_bits, &mut rng))
                    .collect()
            })
            .collect(),
        inputs: inputs.iter().map(|p| p.name.clone()).collect(),
    }
}

/// Random inputs; the first one, reset, now and then.
pub fn stimulus(design: &Design, cycles: usize, seed: u64) -> Stimulus {
    let mut rng = Rng::new(seed);
    let top = design.top();
    let inputs = top
        .ports
        .iter()
        .filter(|p| p.direction == Direction::Input && !p.is_clock);
    let nets: Vec<&Net> = inputs.map(|p| &top.nets[p.net]).collect();
    let mut row = vec![0; nets.len()];
    let mut cycle = |n: usize| {
        for (value, net) in row.iter_mut().zip(&nets) {
            // Inputs keep their value for a while, so that logic is skipped.
            if rng.in_range(0, 2) == 0 {
                let any = u128::from(rng.next_u64()) << 64 | u128::from(rng.next_u64());
                *value = any & rtl_design::elaborate::mask(net.width_bits);
            }
        }
        row[0] = (n % 13 == 5).into();
        row.clone()
    };
    Stimulus {
        inputs: nets.iter().map(|n| n.name.clone()).collect(),
        cycles: (0..cycles).map(&mut cycle).collect(),
        middle: vec![],
    }
}
