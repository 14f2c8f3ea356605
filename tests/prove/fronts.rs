//! Proofs that look into a module: bus fronts for every master, the ring of configuration words for every front.

use super::{file_of, proved, TOOLS};
use crate::bus_card::text;
use crate::tools;
use endat_config::parse;
use endat_hdl::card::bus::HostBus;
use endat_tools::prove::{Subject, Verdict};

/// A card with this bus, cut down to what holds a block.
fn card(bus: HostBus, more: &str, block: &str) -> Subject {
    let project = parse("card.toml", &text(bus, more)).unwrap();
    let mut card = Subject::new(&project).unwrap();
    card.narrow(&format!("{}_{block}", card.name));
    assert_eq!(card.parts.len(), 1, "{bus:?}: {block}");
    card
}

fn front(bus: HostBus) -> Subject {
    card(bus, "", &format!("{}_front", bus.name()))
}

fn is_proved(card: &Subject) {
    let report = proved(card);
    let rows = &report.parts[0].rows;
    assert!(report.is_good() && rows.len() > 2, "{report}");
}

/// Catches a bus of a system that came without its proof.
#[test]
fn every_bus_of_a_system_has_a_claim() {
    for bus in HostBus::ALL.into_iter().filter(|bus| bus.has_base()) {
        front(bus);
    }
}

/// In the run of a user, on a card of two channels.
#[test]
fn the_front_of_apb_answers_every_request_once_in_order_and_in_time() {
    if tools::require_all(&TOOLS, "proofs on the front of APB") {
        is_proved(&front(HostBus::Apb));
    }
}

#[test]
#[ignore = "slow: every front, and one without start values"]
fn fronts_answer_every_request_once_in_order_and_in_time() {
    if !tools::require_all(&TOOLS, "proofs on the fronts") {
        return;
    }
    for bus in HostBus::ALL.into_iter().filter(|bus| bus.has_base()) {
        is_proved(&front(bus));
    }
    let more = "[device]\ninitial_values = false\n";
    is_proved(&card(HostBus::Wishbone, more, "wishbone_front"));
}

#[test]
fn no_sequence_of_accesses_leaves_the_ring_between_two_words() {
    if tools::require_all(&TOOLS, "proof on the ring") {
        is_proved(&card(HostBus::Apb, "", "register_bank"));
    }
}

/// Changes of a block of a card with this bus, and the claim that refutes each.
const WRONG: [(HostBus, &str, &str, &str, &str); 7] = [
    // A SETUP that is held and changed is taken for the transfer.
    (
        HostBus::Apb,
        "apb_front",
        "assign enabled = psel & penable;",
        "assign enabled = psel;",
        "does_what_was_asked",
    ),
    // Who leaves gets the answer of who comes.
    (
        HostBus::Wishbone,
        "wishbone_front",
        "asks & !abandoned",
        "asks & (!abandoned | writing)",
        "answer_has_been_done",
    ),
    // The address of the next transfer is taken while this one waits.
    (
        HostBus::AhbLite,
        "ahb_lite_front",
        "hready & htrans[1] & hreadyout",
        "hready & htrans[1]",
        "does_what_was_asked",
    ),
    // A part of a word is read as a whole one.
    (
        HostBus::AhbLite,
        "ahb_lite_front",
        " & (hsize == 3'd2)",
        "",
        "answer_has_been_done",
    ),
    // The answer is overwritten by the next one.
    (
        HostBus::AxiLite,
        "axi_lite_front",
        "assign may_read = has_ar & !has_r;",
        "assign may_read = has_ar;",
        "reads_the_oldest",
    ),
    // A write goes out although the answer of the one before has not been taken.
    (
        HostBus::AxiLite,
        "axi_lite_front",
        "assign may_write = has_aw & has_w & !has_b;",
        "assign may_write = has_aw & has_w;",
        "b_stands",
    ),
    // The page of an access follows the pins.
    (
        HostBus::Apb,
        "register_bank",
        "assign busy = turning | ended;",
        "assign busy = 1'b0;",
        "begins_at_home",
    ),
];

/// The proofs say something: a front or a bank that is wrong in one place is refuted from reset on, by the claim that names it.
fn are_refuted(wrong: &[(HostBus, &str, &str, &str, &str)]) {
    assert!(!wrong.is_empty());
    if !tools::require_all(&TOOLS, "refutations on the fronts") {
        return;
    }
    for (bus, block, from, to, wanted) in wrong.iter().copied() {
        let mut broken = card(bus, "", block);
        let file = file_of(&broken, block).unwrap();
        let file = &mut broken.files[file];
        assert_eq!(file.text.matches(from).count(), 1, "{from}");
        file.text = file.text.replace(from, to);
        let report = proved(&broken);
        let failed = report.parts[0].rows.iter();
        let failed: Vec<_> = failed.filter(|r| r.verdict.is_failure()).collect();
        let is_it = |r: &&endat_tools::prove::Row| {
            r.name == wanted && matches!(r.verdict, Verdict::Violated { .. })
        };
        assert!(failed.iter().any(is_it), "{to}: {report}");
    }
}

/// A front of each kind, of one request and of two at a time, and a bank.
#[test]
fn fronts_that_are_wrong_are_refuted() {
    let quick = ["apb_front", "register_bank"];
    let is_quick = |row: &&(HostBus, &str, &str, &str, &str)| {
        quick.contains(&row.1) || row.4 == "reads_the_oldest"
    };
    let wrong: Vec<_> = WRONG.iter().filter(is_quick).copied().collect();
    assert_eq!(wrong.len(), 3);
    are_refuted(&wrong);
}

#[test]
#[ignore = "slow: wrong fronts of every bus"]
fn every_front_that_is_wrong_is_refuted() {
    are_refuted(&WRONG);
}
