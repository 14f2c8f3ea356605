//! Campaigns: thousands of cases in parallel, each with separate channel settings, encoder and line.

mod case;
pub mod faults;
pub mod garbage;
mod list;
pub mod other;
pub mod port;
mod run;
mod tally;
#[cfg(test)]
mod tests;
pub mod upsets;
mod work;

pub use case::{Case, Traces, SAMPLE_LATENCY_CYCLES};
pub use list::{random, sweep, Story, ABORT_US, CABLES_M, RATES};
pub use run::{run, CampaignError, Outcome, RunOptions};
pub use tally::{Row, Shard, Tally};
pub use work::{count, digest, run_shard, Campaign, Joined};
