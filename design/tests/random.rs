//! Random kernels under random stimulus: rust-hdl, interpreter and Verilog agree.

use crate::generator::Generator;
use crate::program::{Op, RandomKernel, E, S, WIDTHS};
use crate::three_way::{three_way, Stimulus};
use proptest::prelude::*;
use rtl_design::elaborate::elaborate;
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
        middle: vec![],
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
    let name = format!("random-{}", seed % 2);
    three_way(&name, &mut block.engine(), &design, &stimulus).map(|_| ())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_kernels_agree(seed: u64, statements in 0usize..14, depth in 1usize..5) {
        check(seed, statements, depth).map_err(TestCaseError::fail)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 480, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "slow: 480 random kernels"]
    fn many_random_kernels_agree(seed: u64, statements in 0usize..14, depth in 1usize..5) {
        check(seed, statements, depth).map_err(TestCaseError::fail)?;
    }
}

/// Comparisons with a literal, on both sides: those that cannot come out otherwise are decided in elaboration.
#[test]
fn comparisons_with_literals_agree() {
    let mut out = E::Literal(0, 64);
    let mut bit = 0;
    for op in [Op::Eq, Op::Ne, Op::Lt, Op::Le, Op::Gt, Op::Ge] {
        for literal in [0, 1, 62, 63] {
            let a = || Box::new(E::Signal('a', 6));
            let right = E::Compare(op, a(), Box::new(E::Raw(literal)));
            let left = E::Compare(op, Box::new(E::Literal(literal, 6)), a());
            for compared in [left, right] {
                let at = Box::new(E::Raw(bit));
                out = E::ReplaceBit(Box::new(out), at, Box::new(compared));
                bit += 1;
            }
        }
    }
    let mut generator = Generator::new(0);
    let mut program = generator.program(0, 1);
    program.push(S::Assign(('o', 64), out));
    let mut block = RandomKernel::new(program);
    block.connect_all();
    let design = elaborate(&block, "comparisons").unwrap();
    let mut stimulus = stimulus(&mut generator);
    let a6 = stimulus
        .inputs
        .iter()
        .position(|name| name == "a6")
        .unwrap();
    stimulus.cycles = (0..64)
        .map(|value| {
            let mut row = stimulus.cycles[0].clone();
            row[a6] = value;
            row
        })
        .collect();
    three_way("comparisons", &mut block.engine(), &design, &stimulus).unwrap();
}
