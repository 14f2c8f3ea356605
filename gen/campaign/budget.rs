//! How much may go wrong: all limits in one place. A budget that is asserted fails the campaign; the others are what is wanted.

use endat_sim::campaign::other::{ssi, t_format};
use endat_sim::campaign::port::Port;
use endat_sim::campaign::{Row, Tally};
use std::fmt::Write;

/// A limit.
pub struct Budget {
    /// Of which campaign.
    pub campaign: &'static str,
    /// In words.
    pub what: &'static str,
    /// The cases that are limited.
    pub bad: fn(&Row) -> bool,
    /// The cases of which they are a part.
    pub of: fn(&Row) -> bool,
    /// The limit, per mille of those.
    pub limit_per_mille: f64,
    /// Breaking it is a failure.
    pub is_asserted: bool,
}

/// Classes that a case is in exactly one of.
pub fn is_case(row: &Row) -> bool {
    const CLASSES: [&str; 21] = [
        "masked",
        "detected",
        "lost",
        "silent_other",
        "silent",
        "hang",
        "taken",
        "refused",
        "taken_wrongly",
        "refused_wrongly",
        "clean",
        "unclean",
        "panic",
        "not_found",
        "bench",
        "ports",
        "alone",
        "proof",
        "equivalent",
        "survivor",
        "not_run",
    ];
    CLASSES.contains(&row.class.as_str())
}

/// What a receiver with a CRC of 5 bits lets through: 1 of 32 of the frames that it refuses for it, and those.
const CRC_BOUND_PER_MILLE: f64 = 1000.0 / 32.0;

/// A port of another protocol, whose causes have other numbers, and whose positions have another check sum or none.
fn is_other(row: &Row) -> bool {
    [ssi::SUBJECT, ssi::SUBJECT_SPECIAL, t_format::SUBJECT]
        .iter()
        .any(|subject| of_port(row, subject))
}

/// One of this port, in whatever kind of frame.
fn of_port(row: &Row, subject: &str) -> bool {
    row.subject.split(' ').next() == Some(subject)
}

fn is_crc_or_silent(row: &Row) -> bool {
    !is_setting(row) && !is_other(row) && (row.class == "silent" || row.class == "cause_4")
}

fn is_card(row: &Row) -> bool {
    super::card::CardSubject::named(&row.subject).is_some()
}

/// Of a port or card with guards against upsets.
fn is_guarded(row: &Row) -> bool {
    !of_port(row, Port::Unguarded.name())
}

fn is_setting(row: &Row) -> bool {
    row.kind.starts_with("setting")
}

/// The SSI port where each position comes twice.
const SSI_TWICE: &str = "ssi_port position_twice";

/// All of them.
pub const BUDGETS: [Budget; 26] = [
    Budget {
        campaign: "upsets",
        what: "wrong positions reported as good",
        bad: |r| r.class == "silent" && is_guarded(r),
        of: |r| is_case(r) && is_guarded(r),
        limit_per_mille: 1.0,
        is_asserted: false,
    },
    Budget {
        campaign: "upsets",
        what: "hangs of the ports",
        bad: |r| r.class == "hang" && !is_card(r),
        of: |r| is_case(r) && !is_card(r),
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "hangs of the card",
        bad: |r| r.class == "hang" && is_card(r),
        of: |r| is_case(r) && is_card(r),
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "wrong positions of the card reported as good",
        bad: |r| r.class == "silent" && is_card(r),
        of: |r| is_case(r) && is_card(r),
        limit_per_mille: 1.0,
        is_asserted: false,
    },
    Budget {
        campaign: "upsets",
        what: "wrong positions of the T-format port reported as good",
        bad: |r| r.class == "silent" && of_port(r, t_format::SUBJECT),
        of: |r| is_case(r) && of_port(r, t_format::SUBJECT),
        limit_per_mille: 5.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "wrong positions of the SSI port reported as good",
        bad: |r| r.class == "silent" && of_port(r, ssi::SUBJECT),
        of: |r| is_case(r) && of_port(r, ssi::SUBJECT),
        limit_per_mille: 5.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "wrong positions of the SSI port with special bits reported as good",
        bad: |r| r.class == "silent" && of_port(r, ssi::SUBJECT_SPECIAL),
        of: |r| is_case(r) && of_port(r, ssi::SUBJECT_SPECIAL),
        limit_per_mille: 5.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "driver conflicts that outlast the frame",
        bad: |r| r.class == "conflict" && is_guarded(r),
        of: |r| is_case(r) && is_guarded(r),
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "upsets",
        what: "wrong pulse counts without a cause",
        bad: |r| r.class == "pulses" && is_guarded(r),
        of: |r| is_case(r) && is_guarded(r),
        limit_per_mille: 1.0,
        is_asserted: false,
    },
    Budget {
        campaign: "faults",
        what: "hangs",
        bad: |r| r.class == "hang",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "faults",
        what: "more than 3 triggers to recover",
        bad: |r| r.class == "triggers_more",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "faults",
        what: "wrong positions reported as good, share of these and the CRC errors",
        bad: |r| r.class == "silent" && !is_other(r),
        of: is_crc_or_silent,
        limit_per_mille: CRC_BOUND_PER_MILLE,
        is_asserted: false,
    },
    Budget {
        campaign: "faults",
        what: "wrong positions of the T-format port reported as good",
        bad: |r| r.class == "silent" && of_port(r, t_format::SUBJECT),
        of: |r| is_case(r) && of_port(r, t_format::SUBJECT),
        limit_per_mille: 5.0,
        is_asserted: false,
    },
    Budget {
        campaign: "faults",
        what: "wrong positions of the SSI port with two copies reported as good",
        bad: |r| r.class == "silent" && r.subject == SSI_TWICE,
        of: |r| is_case(r) && r.subject == SSI_TWICE,
        limit_per_mille: 5.0,
        is_asserted: false,
    },
    Budget {
        campaign: "garbage",
        what: "hangs",
        bad: |r| r.class == "hang",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "garbage",
        what: "more than 3 triggers to recover",
        bad: |r| r.class == "triggers_more",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "garbage",
        what: "wrong positions reported as good, share of these and the CRC errors",
        bad: |r| r.class == "silent" && !is_setting(r) && !is_other(r),
        of: is_crc_or_silent,
        limit_per_mille: CRC_BOUND_PER_MILLE,
        is_asserted: false,
    },
    Budget {
        campaign: "garbage",
        what: "wrong positions reported as good after a setting has changed",
        bad: |r| r.class == "silent" && is_setting(r) && !is_other(r),
        of: |r| is_case(r) && is_setting(r) && !is_other(r),
        limit_per_mille: 0.0,
        is_asserted: false,
    },
    Budget {
        campaign: "accept",
        what: "words taken that the reference refuses",
        bad: |r| r.class == "taken_wrongly",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "accept",
        what: "words refused that the reference takes",
        bad: |r| r.class == "refused_wrongly",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "configurations",
        what: "emissions that a linter complains about",
        bad: |r| r.class == "unclean",
        of: |r| is_case(r) && r.kind == "valid",
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "configurations",
        what: "benches that fail",
        bad: |r| r.class == "bench_failed",
        of: |r| r.class.starts_with("bench_"),
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "configurations",
        what: "panics",
        bad: |r| r.class == "panic",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "configurations",
        what: "draws without a valid configuration",
        bad: |r| r.class == "not_found",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
    Budget {
        campaign: "mutants",
        what: "mutants that change something, and that nobody sees",
        bad: |r| r.class == "survivor",
        of: |r| is_case(r) && !matches!(r.class.as_str(), "equivalent" | "not_run"),
        limit_per_mille: 30.0,
        is_asserted: false,
    },
    Budget {
        campaign: "mutants",
        what: "mutants that could not be run",
        bad: |r| r.class == "not_run",
        of: is_case,
        limit_per_mille: 0.0,
        is_asserted: true,
    },
];

impl Budget {
    /// What was found: cases, of how many.
    pub fn found(&self, tally: &Tally) -> (u64, u64) {
        (tally.count(self.bad), tally.count(self.of))
    }

    /// Whether it holds.
    pub fn holds(&self, tally: &Tally) -> bool {
        let (bad, of) = self.found(tally);
        1000.0 * bad as f64 <= self.limit_per_mille * of as f64
    }
}

/// The budgets of a campaign.
pub fn of(campaign: &str) -> impl Iterator<Item = &'static Budget> + '_ {
    BUDGETS.iter().filter(move |b| b.campaign == campaign)
}

/// A line for each, and whether those hold that must.
pub fn lines(campaign: &str, tally: &Tally) -> (String, bool) {
    let (mut text, mut all_hold) = (String::new(), true);
    for budget in of(campaign) {
        let ((bad, cases), holds) = (budget.found(tally), budget.holds(tally));
        all_hold &= holds || !budget.is_asserted;
        let verdict = match (cases, holds, budget.is_asserted) {
            // Nothing was tried that could break it.
            (0, ..) => "-",
            (_, true, _) => "holds",
            (_, false, true) => "BROKEN",
            (_, false, false) => "wanted",
        };
        let _ = writeln!(
            text,
            "{verdict:>7}: {}: {bad} of {cases}, limit {} per mille",
            budget.what, budget.limit_per_mille
        );
    }
    (text, all_hold)
}
