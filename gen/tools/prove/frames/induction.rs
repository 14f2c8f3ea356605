//! The induction over frames: states that runs lead to, widened until every run leads back to them.

use super::walk::{self, End, Run, State};
use super::{text, unreadable, Broken, Case};
use crate::prove::netlist::{self, Netlist};
use endat_console::error::CommandError;
use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// What ends an induction early.
pub(super) enum Stop {
    Broken(Broken),
    Error(CommandError),
}

impl From<CommandError> for Stop {
    fn from(error: CommandError) -> Self {
        Self::Error(error)
    }
}

/// Frames that are looked at one by one before those of which nothing is told apart any more: an average over edges needs some
/// to come to its end. A number is for channels where the one before it does not do.
const SETTLING: [usize; 3] = [1, 5, 40];

/// Finds ready and rest, and shows that every run leads to them.
pub(super) struct Induction<'a> {
    pub netlist: &'a Netlist,
    pub case: &'a Case,
    /// Phases of the microsecond in which runs begin.
    pub phases: Vec<u64>,
    /// Runs at a time.
    pub threads: usize,
    pub progress: &'a dyn Fn(&str),
    /// Found: from the first trigger to rest, and from each other one, at most.
    pub frame_cycles: [u64; 2],
    /// Found: bits of registers that have a level at rest, and bits that may be anything.
    pub rest_bits: [usize; 2],
}

impl Induction<'_> {
    /// Proves the frames, or says what ended that.
    pub fn run(&mut self) -> Result<(), Stop> {
        let registers = self.netlist.registers.iter();
        let start: State = registers.map(|r| self.start(r)).collect();
        let (ready, _) = self.all(Run::PowerUp, "the run from power-up", &start)?;
        let (ready, _) = self.closed(&[(Run::Wait, "a wait for the first trigger")], ready)?;
        let (mut rest, cycles) = self.all(Run::Frame, "the first frame", &ready)?;
        self.frame_cycles[0] = cycles;
        let wait = (Run::Wait, "a wait");
        let mut count = 1;
        let last = SETTLING[SETTLING.len() - 1];
        for settling in SETTLING {
            for _ in count..settling {
                rest = self.closed(&[wait], rest)?.0;
                rest = self.all(Run::Frame, "one of the first frames", &rest)?.0;
            }
            count = settling;
            match self.closed(&[wait, (Run::Frame, "a frame")], rest.clone()) {
                Err(Stop::Broken(_)) if settling < last => {}
                Err(stop) => return Err(stop),
                Ok((rest, cycles)) => {
                    self.frame_cycles[1] = cycles;
                    for level in rest {
                        self.rest_bits[usize::from(level.is_none())] += 1;
                    }
                    break;
                }
            }
        }
        Ok(())
    }

    /// Level of a register after configuration. Which additional data the encoder sends is known: the service has selected them.
    fn start(&self, register: &netlist::Register) -> Option<bool> {
        let names = self.netlist.names.iter();
        let mut selected = names.filter(|(name, _)| name.ends_with(text::SELECTED));
        let bit = selected.find_map(|(_, nets)| nets.iter().position(|n| *n == register.output));
        match bit {
            Some(bit) => Some(self.case.infos >> bit & 1 == 1),
            None => register.start,
        }
    }

    /// Widens a state until these runs lead from it to itself; the cycles of the longest one.
    fn closed(&self, runs: &[(Run, &'static str)], state: State) -> Result<(State, u64), Stop> {
        let (mut state, mut longest) = (state, 0);
        loop {
            let before = state.clone();
            for (run, name) in runs {
                let (end, cycles) = self.all(*run, name, &before)?;
                longest = longest.max(cycles);
                join(&mut state, &end);
            }
            if state == before {
                return Ok((state, longest));
            }
        }
    }

    /// A run in every phase of the microsecond: where it leads to, and the cycles of the longest one. Phases are run side by side; of those
    /// that break the first one counts, so that the outcome is that of one thread.
    fn all(&self, run: Run, name: &'static str, begins: &State) -> Result<(State, u64), Stop> {
        if run != Run::Wait {
            (self.progress)(&format!("{}: {name}", self.case.name));
        }
        let (netlist, case, phases) = (self.netlist, self.case, &self.phases);
        let next = AtomicUsize::new(0);
        let work = || {
            let mut ends = BTreeMap::new();
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(phase) = phases.get(index) else {
                    return ends;
                };
                let end = walk::run(netlist, case, begins, run, *phase);
                if !matches!(end, Ok(End::Waits { .. })) {
                    next.store(phases.len(), Ordering::Relaxed);
                }
                ends.insert(index, end);
            }
        };
        let mut ends = BTreeMap::new();
        thread::scope(|scope| {
            let threads: Vec<_> = (0..self.threads).map(|_| scope.spawn(work)).collect();
            for thread in threads {
                ends.extend(thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            }
        });
        let (mut to, mut longest): (Option<State>, u64) = (None, 0);
        for end in ends.into_values() {
            match end.map_err(|what| unreadable(self.case, &what))? {
                End::Waits { state, cycles } => {
                    longest = longest.max(cycles);
                    match &mut to {
                        Some(to) => join(to, &state),
                        None => to = Some(state),
                    }
                }
                End::Breaks(broken) => return Err(Stop::Broken(Broken::new(broken, name))),
            }
        }
        Ok((to.unwrap_or_default(), longest))
    }
}

/// A register that comes back differently may be anything.
fn join(to: &mut State, state: &State) {
    for (to, level) in to.iter_mut().zip(state) {
        if to != level {
            *to = None;
        }
    }
}
