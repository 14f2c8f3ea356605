//! Programs that are not of this project, and what they make of what is emitted.

mod benches;
pub mod configurations;
mod emissions;
mod flows;
pub mod table;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;

/// Does something with each case on both cores; what was said.
pub fn on_both_cores<T: Sync>(
    cases: &[T],
    complaint: impl Fn(usize, &T) -> Option<String> + Sync,
) -> Vec<String> {
    let (next, said) = (AtomicUsize::new(0), Mutex::new(vec![]));
    let work = || loop {
        let index = next.fetch_add(1, Ordering::Relaxed);
        let Some(case) = cases.get(index) else {
            return;
        };
        if let Some(line) = complaint(index, case) {
            said.lock().unwrap().push(line);
        }
    };
    std::thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
    said.into_inner().unwrap()
}
