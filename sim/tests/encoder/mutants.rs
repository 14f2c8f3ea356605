//! Mistakes in the encoder that the comparison with the model sees.

use super::{twin::random_frames, DESIGN};
use rtl_design::engine::Compiled;
use rtl_design::mutate::{mutated, mutations, Kind, Mutation};

/// Share of the mutants that must be seen, in per cent. Most of the others have no effect: a bit that is 0 anyway is stuck at 0.
const SEEN_PERCENT: usize = 90;

/// Mutants that none of so many encoders shows a difference of, and the number of all.
fn survivors(encoders: u64) -> (Vec<String>, usize) {
    let design = &*DESIGN;
    let of = |module: usize| mutations(design, module);
    let all: Vec<_> = (0..design.modules.len()).flat_map(of).collect();
    // The model has no reset.
    let chosen: Vec<_> = all.iter().filter(|m| m.kind != Kind::Reset).collect();
    let is_seen = |mutant: &Compiled| {
        (0..encoders).any(|seed| random_frames(&mut mutant.clone(), false, seed, 30).is_err())
    };
    let survives = |mutation: &&&Mutation| {
        let mutant = Compiled::new(&mutated(design, mutation));
        mutant.is_ok_and(|mutant| !is_seen(&mutant))
    };
    let name = |m: &&Mutation| {
        format!(
            "{}: {} of {}: {m:?}",
            design.modules[m.module].name,
            m.kind.name(),
            m.about
        )
    };
    let left = chosen.iter().filter(survives).map(name).collect();
    (left, chosen.len())
}

#[test]
#[ignore = "slow: every mutant of the encoder"]
fn comparison_with_the_model_sees_mutants() {
    let (left, all) = survivors(40);
    let seen = all - left.len();
    assert!(
        seen * 100 >= all * SEEN_PERCENT,
        "{seen} of {all}: {left:#?}"
    );
}
