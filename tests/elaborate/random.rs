//! Random kernels under random stimulus: rust-hdl, interpreter and Verilog agree.

use super::generator::Generator;
use super::program::{RandomKernel, WIDTHS};
use crate::three_way::{three_way, Stimulus};
use endat_hdl::elaborate::elaborate;
use proptest::prelude::*;
use rust_hdl::prelude::Block;

const CYCLES: usize = 40;

fn stimulus(generator: &mut Generator) -> Stimulus {
    let mut inputs = vec!["reset".to_string()];
    let mut widths = vec![1];
    for width in WIDTHS {
        inputs.extend([format!("a{width}"), format!("b{width}")]);
        widths.extend([*width, *width]);
    }
    let cycle = |n: usize| {
        let mut row: Vec<u128> = widths.iter().map(|w| generator.input(*w)).collect();
        // mostly running; reset now and then
        row[0] = (n % 16 == 7).into();
        row
    };
    Stimulus {
        inputs,
        cycles: (0..CYCLES).map(cycle).collect(),
    }
}

fn check(seed: u64, statements: usize, depth: usize) -> Result<(), String> {
    let mut generator = Generator::new(seed);
    let mut block = RandomKernel::new(generator.program(statements, depth));
    block.connect_all();
    let design = elaborate(&block, "random").map_err(|e| e.to_string())?;
    let stimulus = stimulus(&mut generator);
    three_way("random", &mut block.engine(), &design, &stimulus).map(|_| ())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_kernels_agree(seed: u64, statements in 0usize..14, depth in 1usize..5) {
        check(seed, statements, depth).map_err(TestCaseError::fail)?;
    }
}
