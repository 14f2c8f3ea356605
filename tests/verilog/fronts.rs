//! Proofs on the emitted fronts, for every master and for ever: answers stand, one for each request and in order, the bank does what was
//! asked and only that, everything ends. And on the emitted bank: no front can leave the ring between two words.
//!
//! `tests/formal` has the properties; they are put into the flattened module, so that induction can use its registers.

use super::{file_of, is_core, name_of};
use crate::bus_card::text;
use crate::tools;
use endat_gen::artifact::Artifact;
use endat_gen::config::parse;
use endat_hdl::card::bus::HostBus;
use rtl_design::elaborate::block_name;
use std::fs;

const BANK: &str = include_str!("../formal/bank.vh");
const BEFORE: &str = include_str!("../formal/before.vh");
const FOLLOWS: &str = include_str!("../formal/follows.vh");
const APB: &str = include_str!("../formal/apb.vh");
const WISHBONE: &str = include_str!("../formal/wishbone.vh");
const TRANSFER: &str = include_str!("../formal/transfer.vh");
const AHB_LITE: &str = include_str!("../formal/ahb_lite.vh");
const AXI_LITE: &str = include_str!("../formal/axi_lite.vh");
const RING: &str = include_str!("../formal/ring.vh");

/// From here on a file says what holds between front, word and bank inside.
const INSIDE: &str = "    // What holds between front, word and bank";
/// States that a step of the induction looks back over, and that the base has.
const DEPTH: &str = "5";
/// Deep enough for the longest wait.
const WAIT_DEPTH: &str = "66";

/// A module of a card and what is claimed of it.
struct Claim {
    bus: HostBus,
    block: &'static str,
    properties: &'static [&'static str],
    /// Names of the claims that take as many steps as the longest wait.
    waits: &'static [&'static str],
}

const FRONTS: [Claim; 4] = [
    Claim {
        bus: HostBus::Apb,
        block: "apb_front",
        properties: &[BANK, BEFORE, APB, FOLLOWS, TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        bus: HostBus::Wishbone,
        block: "wishbone_front",
        properties: &[BANK, BEFORE, WISHBONE, FOLLOWS, TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        bus: HostBus::AhbLite,
        block: "ahb_lite_front",
        properties: &[BANK, AHB_LITE, TRANSFER],
        waits: &["answers_in_time"],
    },
    Claim {
        bus: HostBus::AxiLite,
        block: "axi_lite_front",
        properties: &[BANK, AXI_LITE],
        waits: &["write_answers_in_time", "read_answers_in_time"],
    },
];

const RING_CLAIM: Claim = Claim {
    bus: HostBus::Apb,
    block: "register_bank",
    properties: &[RING],
    waits: &[],
};

/// What a run of the solver says.
#[derive(Debug, PartialEq, Eq)]
enum Verdict {
    Proved,
    Refuted(String),
}

impl Claim {
    /// What is emitted of a card with this bus and one channel.
    fn files(&self) -> Vec<Artifact> {
        let second = "[[channel]]\nposition_bits = 25\ncommand = \"000111\"\n";
        let one = text(self.bus, "").replace(second, "");
        endat_gen::emit(&parse("card.toml", &one).unwrap()).unwrap()
    }

    /// The name of the emitted module, and it with all that it holds in one text; `mutation` is a piece of it and what stands there instead.
    fn flat(&self, folder: &std::path::Path, mutation: Option<(&str, &str)>) -> (String, String) {
        let files = self.files();
        let mut names = vec![];
        let mut is_mutated = mutation.is_none();
        let own = file_of(&files, "");
        for file in files.iter().filter(|f| is_core(f) && f.path != own) {
            let mut text = file.text.clone();
            if let Some((from, to)) = mutation {
                if file.path == file_of(&files, self.block) {
                    assert_eq!(text.matches(from).count(), 1, "{from}");
                    text = text.replace(from, to);
                    is_mutated = true;
                }
            }
            fs::write(folder.join(&file.path), text).unwrap();
            names.push(file.path.clone());
        }
        assert!(is_mutated);
        let script = format!(
            "read_verilog {}; hierarchy -top {}; proc; flatten; opt_clean; write_verilog -noattr flat.v",
            names.join(" "),
            block_name(name_of(&files), self.block)
        );
        let (done, text) = tools::run("yosys", folder, &["-q", "-p", &script]);
        assert!(done, "{text}");
        let flat = fs::read_to_string(folder.join("flat.v")).unwrap();
        (block_name(name_of(&files), self.block), flat)
    }

    /// Base and induction step of all properties; those of `waits` come after, with the others taken for granted.
    fn judge(&self, name: &str, mutation: Option<(&str, &str)>) -> Verdict {
        let folder = tools::folder(&format!("proof-{name}"));
        let (module, flat) = self.flat(&folder, mutation);
        let all = self.properties.concat();
        // A mutant is to fail by what it does, not by how it is made inside.
        let all = match mutation {
            Some(_) => all.split(INSIDE).next().unwrap(),
            None => all.as_str(),
        };
        let mut quick = String::new();
        let mut slow = String::new();
        for line in all.lines() {
            let waits = self.waits.iter().any(|w| line.contains(&format!(" {w}: ")));
            if !waits {
                quick += &format!("{line}\n");
                slow += &format!("{}\n", line.replace(": assert (", ": assume ("));
            } else {
                slow += &format!("{line}\n");
            }
        }
        let mut runs = vec![(quick, DEPTH)];
        if !self.waits.is_empty() && mutation.is_none() {
            runs.push((slow, WAIT_DEPTH));
        }
        let (head, tail) = flat.rsplit_once("endmodule").unwrap();
        for (properties, depth) in runs {
            fs::write(
                folder.join("claim.v"),
                format!("{head}{properties}endmodule{tail}"),
            )
            .unwrap();
            let script = format!(
                "read_verilog -formal claim.v; prep -top {module}; dffunmap; write_smt2 -wires claim.smt2"
            );
            let (done, text) = tools::run("yosys", &folder, &["-q", "-p", &script]);
            assert!(done, "{text}");
            for mode in [&["-i"][..], &[]] {
                // A mutant may take some cycles to show.
                let depth = if mutation.is_some() { "16" } else { depth };
                let arguments = [mode, &["-s", "yices", "-t", depth, "claim.smt2"]].concat();
                let (passed, text) = tools::run("yosys-smtbmc", &folder, &arguments);
                let is_step = !mode.is_empty();
                // A step that fails for a mutant says nothing: the state may not be reached.
                if !(passed || is_step && mutation.is_some()) {
                    return Verdict::Refuted(text);
                }
            }
        }
        Verdict::Proved
    }
}

fn can_prove(what: &str) -> bool {
    tools::require("yosys", what)
        && tools::require("yosys-smtbmc", what)
        && tools::require("yices-smt2", what)
}

/// Catches a bus of a system that came without its proof.
#[test]
fn every_bus_of_a_system_has_a_claim() {
    for bus in HostBus::ALL.into_iter().filter(|bus| bus.has_base()) {
        assert!(FRONTS.iter().any(|claim| claim.bus == bus), "{bus:?}");
    }
}

#[test]
fn the_front_of_apb_answers_every_request_once_in_order_and_in_time() {
    if can_prove("proofs on the front of APB") {
        assert_eq!(FRONTS[0].judge("apb", None), Verdict::Proved);
    }
}

#[test]
#[ignore = "slow: every front"]
fn fronts_answer_every_request_once_in_order_and_in_time() {
    if !can_prove("proofs on the fronts") {
        return;
    }
    for claim in &FRONTS {
        assert_eq!(claim.judge(claim.block, None), Verdict::Proved);
    }
}

#[test]
fn no_sequence_of_accesses_leaves_the_ring_between_two_words() {
    if !can_prove("proof on the ring") {
        return;
    }
    assert_eq!(RING_CLAIM.judge("ring", None), Verdict::Proved);
}

/// The proofs say something: a front or a bank that is wrong in one place is refuted from reset on, by the claim that names it.
#[test]
fn fronts_that_are_wrong_are_refuted() {
    if !can_prove("refutations on the fronts") {
        return;
    }
    let [apb, wishbone, ahb_lite, axi_lite] = &FRONTS;
    for (claim, from, to, wanted) in [
        // A SETUP that is held and changed is taken for the transfer.
        (
            apb,
            "assign enabled = psel & penable;",
            "assign enabled = psel;",
            "does_what_was_asked",
        ),
        // Who leaves gets the answer of who comes.
        (
            wishbone,
            "asks & !abandoned",
            "asks & (!abandoned | writing)",
            "answer_has_been_done",
        ),
        // The address of the next transfer is taken while this one waits.
        (
            ahb_lite,
            "hready & htrans[1] & hreadyout",
            "hready & htrans[1]",
            "error_has_two_cycles",
        ),
        // A part of a word is read as a whole one.
        (ahb_lite, " & (hsize == 3'd2)", "", "answer_has_been_done"),
        // The answer is overwritten by the next one.
        (
            axi_lite,
            "assign may_read = has_ar & !has_r;",
            "assign may_read = has_ar;",
            "reads_the_oldest",
        ),
        // The page of an access follows the pins.
        (
            &RING_CLAIM,
            "assign busy = turning | ended;",
            "assign busy = 1'b0;",
            "begins_at_home",
        ),
    ] {
        let name = format!("mutant-{}", claim.block);
        match claim.judge(&name, Some((from, to))) {
            Verdict::Proved => panic!("{to}: not seen"),
            Verdict::Refuted(text) => {
                assert!(
                    text.contains("Assert failed") && text.contains(wanted),
                    "{text}"
                );
            }
        }
    }
}
