//! Upsets of the handshake registers between service and channel, and between host and service.

use super::plug::{encoder, ready, Hosts, PERIOD, STUCK_MS};
use crate::requests::lanes::{self, Rig, LANES};
use endat_hdl::endat::service::map::{control, request_state, word};
use endat_hdl::protocol::ModeCommand::*;
use endat_sim::{rng::Rng, Time, MS, US};

/// The registers, with the inverted bits.
fn masks() -> Vec<(String, u128)> {
    let flags = [
        "has_event",
        "missed",
        "event_request",
        "request_written",
        "control_written",
    ];
    let mut masks: Vec<_> = flags.iter().map(|name| (*name, 1)).collect();
    masks.extend((1..16).map(|mask| ("out_go", mask)));
    masks.extend((0..5).map(|bit| ("event_cause", 1 << bit)));
    let full = |(name, mask): (&str, u128)| (format!("served_0.{name}"), mask);
    masks.into_iter().map(full).collect()
}

/// Times from the host's write to after the end of the frame with the request.
const MOMENTS: u64 = 24;
const SPAN: Time = 240 * US;

/// Upsets each of them at this many times.
fn handshakes(moments: u64) {
    let ready = ready(false);
    let names: Vec<String> = ready.nets().map(Into::into).collect();
    let mut rng = Rng::new(7);
    let mut upsets = vec![];
    for (name, mask) in masks() {
        let net = names.iter().position(|n| *n == name).expect("a register");
        for moment in 0..moments {
            let cycles = SPAN * lanes::SYSTEM_HZ / (1_000_000 * US);
            let cycle = (moment * cycles + rng.in_range(0, cycles)) / moments;
            upsets.push((
                net,
                mask,
                cycle,
                format!("{name} ^ {mask:#b} in cycle {cycle}"),
            ));
        }
    }
    let mut waiting = vec![];
    for upsets in upsets.chunks(LANES) {
        let what: Vec<String> = upsets.iter().map(|u| u.3.clone()).collect();
        let rig = Rig::on(
            ready.clone(),
            &vec![(encoder(), lanes::line()); upsets.len()],
        );
        let mut hosts = Hosts {
            rig,
            next_trigger: 50 * US,
        };
        hosts.run_for(PERIOD);
        hosts.good(PositionSelectMemory, 0x4C);
        hosts.request(PositionSelectMemory, 0x4D);
        let last = upsets.iter().map(|u| u.2).max().unwrap_or(0);
        for cycle in 0..=last {
            for (lane, upset) in upsets.iter().enumerate().filter(|(_, u)| u.2 == cycle) {
                for bit in (0..16).filter(|bit| upset.1 >> bit & 1 == 1) {
                    hosts.rig.bench.engine().flip(upset.0, bit, lane);
                }
            }
            hosts.tick();
        }
        hosts.run_for(8 * MS);
        hosts.rest();
        hosts.assert_never_wrong(&what);
        hosts.assert_good_positions(&what);
        let states = hosts.read(word::REQUEST_STATE);
        let busy = |lane: &usize| states[*lane] as u16 & request_state::BUSY != 0;
        let open = (0..upsets.len()).filter(busy);
        waiting.extend(open.map(|lane| what[lane].clone()));
        let before = hosts.read(word::REQUEST_STATE);
        hosts.request(PositionSelectMemory, 0x4C);
        hosts.run_for(MS);
        let after = hosts.read(word::REQUEST_STATE);
        for lane in (0..upsets.len()).filter(|lane| !busy(lane)) {
            let error = after[lane] as u16;
            let finished = (error, after[lane] >> 16);
            assert_eq!(finished, (0, (before[lane] >> 16) + 1), "{}", what[lane]);
        }
    }
    assert!(waiting.is_empty(), "{waiting:#?}");
}

#[test]
fn an_upset_of_a_handshake_loses_a_request_at_most() {
    handshakes(LANES as u64 / masks().len() as u64);
}

#[test]
#[ignore = "slow: 24 moments of each register"]
fn an_upset_of_a_handshake_loses_a_request_at_most_and_the_next_one_is_fulfilled() {
    handshakes(MOMENTS);
}

/// Upsets of the program counter and the return address, at times of the main loop: some of these jumps end in a loop.
fn astray(moments: u64) {
    let ready = ready(false);
    let names: Vec<String> = ready.nets().map(Into::into).collect();
    let mut upsets = vec![];
    for name in ["counter", "link"] {
        let full = format!("service_0.sequencer.{name}");
        let net = names.iter().position(|n| *n == full).expect("a register");
        for bit in 0..11 {
            for moment in 0..moments {
                let cycle = 23 * moment + bit as u64;
                upsets.push((net, bit, cycle, format!("{name} bit {bit}, cycle {cycle}")));
            }
        }
    }
    let mut most_starts = 0;
    for upsets in upsets.chunks(LANES) {
        let what: Vec<String> = upsets.iter().map(|u| u.3.clone()).collect();
        let links = vec![(encoder(), lanes::line()); upsets.len()];
        let mut hosts = Hosts {
            rig: Rig::on(ready.clone(), &links),
            next_trigger: 50 * US,
        };
        hosts.run_for(PERIOD);
        hosts.good(PositionSelectMemory, 0x4C);
        let last = upsets.iter().map(|u| u.2).max().unwrap_or(0);
        for cycle in 0..=last {
            for (lane, upset) in upsets.iter().enumerate().filter(|(_, u)| u.2 == cycle) {
                hosts.rig.bench.engine().flip(upset.0, upset.1, lane);
            }
            hosts.tick();
        }
        hosts.run_for(Time::from(STUCK_MS + 5) * MS);
        hosts.write(word::CONTROL, control::CANCEL.into());
        hosts.run_for(MS);
        hosts.assert_never_wrong(&what);
        hosts.good(PositionSelectMemory, 0x4D);
        let starts = hosts.read(word::STATE).into_iter().map(|s| s >> 16);
        most_starts = most_starts.max(starts.max().unwrap_or(0));
    }
    assert!(most_starts > 1, "no upset led into a loop");
}

#[test]
fn a_program_that_goes_astray_begins_anew() {
    astray(LANES as u64 / 22);
}

#[test]
#[ignore = "slow: 24 moments of each bit"]
fn a_program_that_goes_astray_at_any_moment_begins_anew() {
    astray(MOMENTS);
}

/// Registers of the program's machine, with their number of bits.
const MACHINE: [(&str, usize); 6] = [
    ("counter", 11),
    ("link", 11),
    ("accumulator", 16),
    ("index", 8),
    ("address", 8),
    ("value", 16),
];
/// `limits` as the host writes them: no frame reaches the watchdog, and the recovery time is not checked.
const LIMITS: u32 = 0x0000_0FA3;
const CONTINUOUS: u32 = 2;

/// The host's settings while each bit of these registers is upset at times of the main loop: they remain, or `starts` reports
/// that the host must write them again, and writing them restores the axis.
fn settings(registers: &[(&str, usize)], moments: u64) {
    let ready = ready(false);
    let names: Vec<String> = ready.nets().map(Into::into).collect();
    let mut upsets = vec![];
    for (name, bits) in registers {
        let full = format!("service_0.sequencer.{name}");
        let net = names.iter().position(|n| *n == full).expect("a register");
        for bit in 0..*bits {
            for moment in 0..moments {
                let cycle = 37 * moment + bit as u64;
                upsets.push((net, bit, cycle, format!("{name} bit {bit}, cycle {cycle}")));
            }
        }
    }
    let mut begun = 0;
    for upsets in upsets.chunks(LANES) {
        let what: Vec<String> = upsets.iter().map(|u| u.3.clone()).collect();
        let links = vec![(encoder(), lanes::line()); upsets.len()];
        let mut hosts = Hosts {
            rig: Rig::on(ready.clone(), &links),
            next_trigger: 50 * US,
        };
        hosts.write(word::LIMITS, LIMITS);
        hosts.write(word::CONTINUOUS, CONTINUOUS);
        hosts.run_for(2 * PERIOD);
        let before = hosts.read(word::STATE);
        let last = upsets.iter().map(|u| u.2).max().unwrap_or(0);
        for cycle in 0..=last {
            for (lane, upset) in upsets.iter().enumerate().filter(|(_, u)| u.2 == cycle) {
                hosts.rig.bench.engine().flip(upset.0, upset.1, lane);
            }
            hosts.tick();
        }
        hosts.run_for(Time::from(STUCK_MS + 3) * MS);
        let words = [word::LIMITS, word::CONTINUOUS, word::FORCE].map(|w| hosts.read(w));
        // A start under way is counted at its end.
        hosts.run_for(PERIOD);
        let after = hosts.read(word::STATE);
        for (lane, what) in what.iter().enumerate() {
            let is_new = before[lane] >> 16 != after[lane] >> 16;
            begun += usize::from(is_new);
            let settings = [words[0][lane], words[1][lane], words[2][lane]];
            assert!(
                is_new || settings == [LIMITS, CONTINUOUS, 0],
                "{what}: {settings:x?}, and `starts` stays {:x} {:x}",
                before[lane],
                after[lane]
            );
        }
        hosts.write(word::LIMITS, LIMITS);
        hosts.write(word::CONTINUOUS, CONTINUOUS);
        hosts.run_for(6 * PERIOD);
        hosts.rest();
        hosts.assert_never_wrong(&what);
        hosts.assert_good_positions(&what);
    }
    assert!(begun > 0, "no upset restarted the program");
}

#[test]
fn settings_of_the_host_stay_or_starts_counts() {
    settings(&MACHINE[..1], LANES as u64 / 11);
}

#[test]
#[ignore = "slow: 24 moments of each bit of the program's machine"]
fn settings_of_the_host_stay_or_starts_counts_whatever_is_upset_in_the_program_s_machine() {
    settings(&MACHINE, MOMENTS);
}

#[test]
fn a_setting_of_which_the_host_writes_one_half_is_not_taken_for_upset() {
    let ready = ready(false);
    let links = vec![(encoder(), lanes::line()); LANES];
    let mut hosts = Hosts {
        rig: Rig::on(ready, &links),
        next_trigger: 50 * US,
    };
    hosts.run_for(PERIOD);
    hosts.write_half(word::LIMITS, 1, 7);
    hosts.run_for(2 * PERIOD);
    let starts = hosts.read(word::STATE);
    hosts.write_half(word::LIMITS, 1, 0);
    hosts.write(word::LIMITS, LIMITS);
    hosts.run_for(2 * PERIOD);
    assert_eq!(hosts.read(word::STATE), starts);
    assert_eq!(hosts.read(word::LIMITS), vec![LIMITS; LANES]);
}
