//! Campaigns that count: parts, what they find, the page of their results.

use super::run;
use endat_campaign::budget;
use endat_campaign::card::{CardSubject, CardUpsets};
use endat_campaign::part::Part;
use endat_sim::campaign::port::Port;
use endat_sim::campaign::upsets::{Draw, Upsets};
use endat_sim::campaign::{count, run_shard, Campaign, Shard, Tally};
use rtl_design::engine::{Keep, LaneWords, Lanes};
use std::fs;
use std::path::Path;

/// Where the results of the whole campaigns are, and the page that shows them.
const RESULTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/campaigns/results");
const CAMPAIGNS: [&str; 4] = ["upsets", "faults", "garbage", "accept"];
/// Files that the page is made of.
const FILES: [&str; 5] = ["upsets", "upsets_safety", "faults", "garbage", "accept"];
const PAGE: &str = include_str!("../../docs/reliability.md");
const TABLES: &str = include_str!("../../campaigns/results/tables.md");

fn done(folder: &Path, arguments: &[&str], out: &str) -> Vec<u8> {
    let path = folder.join(out);
    let all = [arguments, &["--out", path.to_str().unwrap()]].concat();
    let outcome = run(&all);
    assert_eq!(outcome.exit_code, 0, "{outcome:?}");
    fs::read(path).unwrap()
}

/// Each campaign is cut where its batches are not, so every case has other neighbours.
fn any_split_gives_what_one_run_gives(folder: &str, campaigns: &[&[&str]]) {
    let folder = crate::tools::folder(folder);
    for campaign in campaigns {
        let campaign = [&["campaign"], *campaign].concat();
        let whole = done(&folder, &campaign, "whole.csv");
        let part = |index: usize, threads: &str| {
            let shard = format!("{index}/3");
            let all = [&campaign[..], &["--shard", &shard, "--threads", threads]].concat();
            done(&folder, &all, &format!("{index}.csv"))
        };
        let parts = [part(1, "1"), part(2, "2"), part(3, "1")];
        fs::remove_file(folder.join("2.csv")).unwrap();
        let files = [3, 1, 2].map(|i| folder.join(format!("{i}.csv")).display().to_string());
        let [third, first, second] = &files;
        let refused = run(&["campaign", "merge", third, first]);
        assert_eq!(refused.exit_code, 2);
        assert!(
            refused.messages[0].contains("not there: 2/3"),
            "{refused:?}"
        );
        assert!(part(2, "1") == parts[1]);
        let merged = done(
            &folder,
            &["campaign", "merge", third, first, second],
            "merged.csv",
        );
        assert!(merged == whole, "{campaign:?}");
    }
}

#[test]
fn any_split_gives_byte_for_byte_what_one_run_gives_and_a_lost_part_is_run_again_alone() {
    let upsets = ["upsets", "--subject", "port", "--cases", "300"];
    any_split_gives_what_one_run_gives("campaign_parts", &[&upsets]);
}

#[test]
#[ignore = "slow: parts of upsets, faults and garbage of other ports"]
fn any_split_of_a_port_s_campaign_gives_byte_for_byte_what_one_run_gives() {
    let campaigns = [
        &["upsets", "--subject", "port_all", "--cases", "700"][..],
        &["faults", "--subject", "port", "--step", "150"],
        &["garbage", "--subject", "port_double_edge", "--cases", "400"],
    ];
    any_split_gives_what_one_run_gives("campaign_parts_of_ports", &campaigns);
}

#[test]
#[ignore = "slow: parts of upsets of a card"]
fn any_split_of_a_card_s_campaign_gives_byte_for_byte_what_one_run_gives() {
    let only = ["--only", "core.stream_0.l", "--cases", "200"];
    let upsets = [&["upsets", "--subject", "card"], &only[..]].concat();
    any_split_gives_what_one_run_gives("campaign_parts_of_cards", &[&upsets]);
}

#[test]
fn bad_arguments_of_parts_are_refused_with_their_limits() {
    let upsets = ["campaign", "upsets"];
    for (arguments, text) in [
        (&["--shard", "4/3"][..], "--shard = 4/3: is no part"),
        (&["--shard", "x"], "--shard = x: is no part"),
        (&["--moments", "0"], "--moments = 0: outside 1..1000000"),
        (
            &["--subject", "x"],
            "--subject = x: is no subject of this campaign; take one of port, ",
        ),
        (
            &["a.csv"],
            "campaign upsets: PART: is only of merge; leave it out",
        ),
        (
            &["--step", "2"],
            "campaign upsets: --step: is only of faults; leave it out",
        ),
        (
            &["--json"],
            "campaign upsets: --json: is only of sweep, random; leave it out",
        ),
        (
            &["--subject", "port", "--only", "bridge."],
            "--only = bridge.: no register of --subject port begins like this",
        ),
        (
            &["--subject", "port", "--only", "receiver.,reciever."],
            "--only = reciever.: no register of --subject port begins like this",
        ),
    ] {
        let outcome = run(&[&upsets[..], arguments].concat());
        assert_eq!(outcome.exit_code, 2, "{arguments:?}");
        assert!(
            outcome.messages.iter().any(|m| m.contains(text)),
            "{outcome:?}"
        );
    }
    let outcome = run(&["campaign", "merge", "/none/there.csv"]);
    assert_eq!(outcome.exit_code, 2);
    assert!(outcome.messages[0].starts_with("/none/there.csv: cannot read"));
}

fn upsets(port: Port, draw: Draw, only: &str) -> Tally {
    let campaign = Upsets::new(&[port], draw, 1, only).unwrap();
    let tally = run_shard(&campaign, Shard::WHOLE, 0, |_| {});
    let cases = tally.count(budget::is_case);
    assert_eq!(cases, count(&campaign), "each case is in one class");
    tally
}

/// Without guards an upset may show a wrong position, which is what they are for; but nothing hangs. With them one in a thousand may.
fn guards_hide_wrong_positions(moments: u64) {
    let of = |port| {
        let tally = upsets(port, Draw::Grid { moments }, "");
        ["silent", "hang", "detected"].map(|class| tally.count(|row| row.class == class))
    };
    let [guarded, bare] = [Port::Position, Port::Unguarded].map(of);
    assert_eq!([guarded[1], bare[1]], [0, 0], "{guarded:?} {bare:?}");
    assert!(
        bare[0] > 10 * guarded[0] && bare[0] > 50,
        "{guarded:?} {bare:?}"
    );
    assert!(guarded[2] > bare[2], "{guarded:?} {bare:?}");
}

#[test]
fn a_port_without_guards_shows_wrong_positions_and_never_hangs() {
    guards_hide_wrong_positions(2);
}

#[test]
#[ignore = "slow: upsets of a port with and without guards, at eight moments"]
fn a_port_without_guards_shows_wrong_positions_at_eight_moments() {
    guards_hide_wrong_positions(8);
}

/// Catches registers that a campaign forgets, those on the falling edge among them.
#[test]
fn every_flip_flop_of_a_port_is_inverted_in_every_kind_of_frame() {
    is_inverted(&[Port::Position, Port::DoubleEdge]);
}

#[test]
#[ignore = "slow: flip-flops of every port"]
fn every_flip_flop_of_every_port_is_inverted_in_every_kind_of_frame() {
    is_inverted(&Port::ALL);
}

fn is_inverted(ports: &[Port]) {
    for &port in ports {
        let design = port.design().unwrap();
        let engine = Lanes::new(&design, Keep::Registers, LaneWords::Two).unwrap();
        let flops: usize = engine.registers().map(|r| engine.width_bits(r)).sum();
        let campaign = Upsets::new(&[port], Draw::Grid { moments: 65 }, 1, "").unwrap();
        let kinds = port.kinds().len();
        assert_eq!(count(&campaign), (flops * kinds * 65) as u64, "{port:?}");
        let falling = design.modules.iter().flat_map(|m| &m.registers);
        assert!(falling.count() > 0 && flops > 600, "{port:?} {flops}");
    }
}

/// A campaign that finds nothing is worth nothing: what an upset does to a register that drives a pin is seen.
#[test]
fn a_flip_that_must_be_seen_is_seen() {
    let pin = upsets(Port::Position, Draw::Grid { moments: 65 }, "clk_pin");
    let seen = pin.count(|r| r.class == "pulses" || r.class == "rules" || r.class == "detected");
    assert!(seen > 0, "{pin:?}");
    let stamp = upsets(
        Port::Position,
        Draw::Grid { moments: 65 },
        "snapshot.crc_received",
    );
    let moved = stamp.count(|r| r.class == "silent" || r.class == "hang");
    assert_eq!(
        moved, 0,
        "the CRC that is shown moves no position: {stamp:?}"
    );
}

/// What became of upsets of these registers of the card, in one run: what it takes is the card's simulation, whatever is upset in it.
fn card(subject: CardSubject, places: &[&str], moments: u64) -> Tally {
    let only = places.join(",");
    let campaign = CardUpsets::new(subject, Draw::Grid { moments }, 1, &only).unwrap();
    let tally = run_shard(&campaign, Shard::WHOLE, 0, |_| {});
    assert_eq!(tally.count(budget::is_case), count(&campaign));
    for only in places {
        assert!(tally.count(|r| r.place.starts_with(only)) > 0, "{only}");
    }
    tally
}

/// The host must notice what it can, and the judge what it cannot.
#[test]
#[ignore = "slow: upsets of a card's settings, time and held results"]
fn upsets_of_the_card_that_must_be_seen_are_seen() {
    let (rings, time, held) = (
        ["core.registers_1.ring.w2", "core.bank.ring.w1"],
        "core.timebase.cycles",
        "core.registers_0.held_1",
    );
    let tally = card(CardSubject::Plain, &[rings[0], rings[1], time, held], 1);
    let of =
        |only: &str, class: &str| tally.count(|r| r.place.starts_with(only) && r.class == class);
    // Nothing goes out with them, and the host writes them again.
    for ring in rings {
        let told = of(ring, "detected");
        assert!(told > 100 && of(ring, "config") * 20 < told, "{tally:?}");
    }
    assert!(of(time, "silent_other") > 100, "{tally:?}");
    // Either side of a bit: the stream's CRC, the position's own.
    assert_eq!(of(held, "silent"), 0, "{tally:?}");
    assert!(of(held, "detected") > 0, "{tally:?}");
}

/// The quick relative of the tests below, in one frame of a card: settings that the host notices, time that only the judge sees, and a link
/// without an end.
#[test]
fn upsets_of_the_card_are_seen_and_end() {
    let places = [
        "core.registers_1.ring.w2",
        "core.timebase.cycles",
        "bridge.sent",
    ];
    let draw = Draw::Grid { moments: 1 };
    let campaign = CardUpsets::new(CardSubject::Plain, draw, 1, &places.join(",")).unwrap();
    let frame = 1;
    let tally = campaign.run(frame, 0..campaign.groups()[frame]);
    let of =
        |only: &str, class: &str| tally.count(|r| r.place.starts_with(only) && r.class == class);
    let told = of(places[0], "detected");
    assert!(
        told > 20 && of(places[0], "config") * 20 < told,
        "{tally:?}"
    );
    assert!(of(places[1], "silent_other") > 20, "{tally:?}");
    assert_eq!(tally.count(|r| r.class == "hang"), 0, "{tally:?}");
}

/// The second controller reads, and refuses what is not of this card, trigger and moment. Catches one that is never asked, that takes
/// what does not fit, or that refuses what is right: then a case without a flip would be told, which the campaign itself refuses.
#[test]
#[ignore = "slow: upsets on the way to a card's second controller"]
fn the_second_controller_of_a_card_is_told_of_upsets_on_its_way() {
    let places = [
        "core.second_0.",
        "core.port_1.channel_0.second_0.receiver.crc_bits",
    ];
    let tally = card(CardSubject::Safety, &places, 1);
    let of =
        |only: &str, class: &str| tally.count(|r| r.place.starts_with(only) && r.class == class);
    for (only, least) in [(places[0], 100), (places[1], 1)] {
        assert!(of(only, "detected") >= least, "{only}: {tally:?}");
        assert_eq!(of(only, "silent"), 0, "{only}: {tally:?}");
    }
}

/// Found by the campaign: a byte of an answer that was lost inside, a level that nobody wrote again, a frame without an end, and a service
/// that waits for minutes because the word that says how long was upset.
#[test]
#[ignore = "slow: upsets of waits of a card, at thirteen moments"]
fn neither_the_link_nor_a_slower_clock_nor_a_service_stands_for_ever() {
    let service = "core.port_0.served_0.seen_17";
    let places = [
        "bridge.byte_ready",
        "bridge.sent",
        "core.port_0.served_0.out_period",
        "core.stream_0.pushing",
        service,
    ];
    let tally = card(CardSubject::Plain, &places, 13);
    // A request that runs with a clock far too slow is another matter.
    let hangs =
        tally.count(|r| r.class == "hang" && (r.kind != "request" || r.place.starts_with(service)));
    assert_eq!(hangs, 0, "{tally:?}");
}

/// The budgets that are asserted hold in a part of a campaign.
fn keeps_its_budgets(campaign: &str, more: &[&str]) {
    let outcome = run(&[&["campaign", campaign], more].concat());
    assert_eq!(outcome.exit_code, 0, "{}", outcome.stdout);
    let verdicts = outcome.stdout.matches(", limit ").count();
    assert_eq!(verdicts, budget::of(campaign).count(), "{}", outcome.stdout);
}

#[test]
fn a_few_cases_of_each_campaign_keep_their_budgets() {
    for (campaign, more) in [
        ("upsets", &["--subject", "port", "--cases", "300"][..]),
        ("faults", &["--subject", "port", "--step", "400"]),
        ("garbage", &["--subject", "port", "--cases", "150"]),
        ("accept", &["--quick"]),
    ] {
        keeps_its_budgets(campaign, more);
    }
}

/// Of the ports of other protocols: no hang, no more than three triggers to recover, and 0.5 % of all upsets at most are a wrong position that
/// is published as good.
fn other_ports_keep_their_budgets(moments: &str, step: &str, cases: &str) {
    for subject in ["ssi_port", "t_format_port"] {
        for (campaign, option, value) in [
            ("upsets", "--moments", moments),
            ("faults", "--step", step),
            ("garbage", "--cases", cases),
        ] {
            keeps_its_budgets(campaign, &["--subject", subject, option, value]);
        }
    }
    let special = ["--subject", "ssi_port_special", "--moments", moments];
    keeps_its_budgets("upsets", &special);
}

#[test]
fn ports_of_other_protocols_keep_their_budgets() {
    other_ports_keep_their_budgets("2", "40", "300");
}

#[test]
#[ignore = "slow: every flip-flop at 65 moments, every quarter of a bit"]
fn ports_of_other_protocols_keep_their_budgets_everywhere() {
    other_ports_keep_their_budgets("65", "1", "40000");
}

/// A campaign that finds nothing is worth nothing: the clock of an SSI encoder and the driver of a T-format port are seen.
#[test]
fn flip_of_an_other_port_s_pin_is_seen() {
    for (subject, only) in [
        ("ssi_port", "clk"),
        ("ssi_port_special", "special_0."),
        ("t_format_port", "exchange.phase"),
    ] {
        let more = ["--subject", subject, "--only", only, "--moments", "30"];
        let outcome = run(&[&["campaign", "upsets"], &more[..]].concat());
        let line = outcome
            .stdout
            .lines()
            .find(|l| l.starts_with(&format!("| {subject}, all")));
        let cells: Vec<&str> = line.unwrap().split('|').map(str::trim).collect();
        // Flips, masked, detected.
        let detected: f64 = cells[4].parse().unwrap();
        assert!(detected > 50.0, "{outcome:?}");
    }
}

#[test]
#[ignore = "slow: a quick run of each campaign"]
fn a_quick_run_of_each_campaign_keeps_its_budgets() {
    for campaign in CAMPAIGNS {
        keeps_its_budgets(campaign, &["--quick"]);
    }
}

fn committed(campaign: &str) -> Part {
    Part::read(&Path::new(RESULTS).join(format!("{campaign}.csv"))).unwrap()
}

#[test]
fn the_page_is_what_the_results_say() {
    for (what, file, committed) in [
        (None, "docs/reliability.md", PAGE),
        (Some("--tables"), "campaigns/results/tables.md", TABLES),
    ] {
        let files = FILES.map(|c| format!("{RESULTS}/{c}.csv"));
        let mut arguments = vec!["page"];
        arguments.extend(what);
        arguments.extend(files.iter().map(String::as_str));
        let outcome = run(&arguments);
        assert_eq!(outcome.exit_code, 0, "{outcome:?}");
        for (index, (old, now)) in committed.lines().zip(outcome.stdout.lines()).enumerate() {
            assert_eq!(old, now, "{file}:{}: campaigns/run", index + 1);
        }
        assert_eq!(committed, outcome.stdout);
    }
}

/// With every monitor one upset of a thousand at most is a wrong position that is reported as good, none of them in a receiver; the page on safety
/// has the count.
#[test]
fn a_card_with_every_monitor_keeps_what_it_promises() {
    let tally = committed("upsets_safety").tally;
    let (all, silent) = (
        tally.count(budget::is_case),
        tally.count(|r| r.class == "silent"),
    );
    assert!(1000 * silent <= all, "{silent} of {all}");
    let is_receiver = |place: &str| place.contains(".receiver.") || place.contains(".second_0.");
    let of_receivers = |class: &str| {
        tally.count(|r| r.class == class && r.place.contains("channel_0") && is_receiver(&r.place))
    };
    assert_eq!(of_receivers("silent"), 0);
    assert!(of_receivers("detected") > 1000);
    let page = include_str!("../../docs/safety.md");
    let (thousands, rest) = (all / 1000, all % 1000);
    let share = 100.0 * silent as f64 / all as f64;
    let told = format!("{silent} of {thousands} {rest:03} upsets end in a wrong position that is reported as good, {share:.3} %");
    assert!(page.contains(&told), "docs/safety.md: {told}");
}

/// Some of the cases again: their rows must be the committed ones.
#[test]
fn the_results_are_those_of_this_core() {
    are_those_of_this_core(&[(Port::Position, "clock_gen.half.")]);
}

#[test]
#[ignore = "slow: committed results of more registers"]
fn the_results_of_more_registers_are_those_of_this_core() {
    are_those_of_this_core(&[
        (Port::Position, "sender."),
        (Port::AllParts, "clock_gen.half."),
    ]);
}

fn are_those_of_this_core(places: &[(Port, &str)]) {
    let Part {
        identity,
        tally: all,
        ..
    } = committed("upsets");
    let plan = identity.plan.strip_prefix("moments ").unwrap();
    let moments = plan.split_once(';').unwrap().0.parse().unwrap();
    for &(port, only) in places {
        let now = upsets(port, Draw::Grid { moments }, only);
        assert!(now.rows().count() > 5);
        let subject =
            |r: &endat_sim::campaign::Row| r.subject == port.name() && r.place.starts_with(only);
        let then: Vec<_> = all.rows().filter(|(row, _)| subject(row)).collect();
        assert_eq!(then, now.rows().collect::<Vec<_>>(), "campaigns/run");
    }
}

/// The columns that DuckDB and pandas read have one type each: text, and whole numbers.
#[test]
fn results_are_plain_tables() {
    for campaign in FILES {
        let text = fs::read_to_string(format!("{RESULTS}/{campaign}.csv")).unwrap();
        let mut lines = text.lines();
        let heading = "campaign,version,plan,cases,part,subject,kind,place,class,count";
        assert_eq!(lines.next(), Some(heading));
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), 10, "{line}");
            assert!(cells[9].parse::<u64>().is_ok() && cells[3].parse::<u64>().is_ok());
            assert!(cells.iter().all(|c| !c.is_empty()), "{line}");
        }
    }
}
