//! Which options a campaign has: one that it has not is refused, as nothing would follow from it.

use super::{CampaignArgs, Name};
use crate::error::GenError;
use clap::ValueEnum;
use Name::{Accept, Configurations, Faults, Garbage, Merge, Mutants, Page, Random, Sweep, Upsets};

/// Those that count what becomes of each case.
const COUNTING: &[Name] = &[Upsets, Faults, Garbage, Accept, Configurations, Mutants];
/// Those that have cases.
#[rustfmt::skip]
const RUNNING: &[Name] = &[Sweep, Random, Upsets, Faults, Garbage, Accept, Configurations, Mutants];

impl CampaignArgs {
    /// Each option that is not of every campaign: whether it is there, and whose it is.
    fn options(&self) -> [(&'static str, bool, &'static [Name]); 16] {
        [
            ("PART", !self.parts.is_empty(), &[Merge, Page]),
            (
                "--cases",
                self.cases.is_some(),
                &[Random, Upsets, Garbage, Configurations, Mutants],
            ),
            ("--moments", self.moments.is_some(), &[Upsets]),
            ("--step", self.step.is_some(), &[Faults]),
            (
                "--subject",
                self.subject.is_some(),
                &[Upsets, Faults, Garbage, Mutants],
            ),
            ("--only", self.only.is_some(), &[Upsets, Mutants]),
            (
                "--seed",
                self.seed.is_some(),
                &[Random, Upsets, Faults, Garbage, Configurations, Mutants],
            ),
            ("--quick", self.quick, COUNTING),
            ("--shard", self.shard.is_some(), COUNTING),
            (
                "--out",
                self.out.is_some(),
                &[
                    Upsets,
                    Faults,
                    Garbage,
                    Accept,
                    Configurations,
                    Mutants,
                    Merge,
                ],
            ),
            ("--tables", self.tables, &[Page]),
            ("--threads", self.threads.is_given(), RUNNING),
            (
                "--case",
                self.case.is_some(),
                &[Sweep, Random, Configurations, Mutants],
            ),
            ("--vcd", self.vcd.is_some(), &[Sweep, Random]),
            ("--svg", self.svg.is_some(), &[Sweep, Random]),
            ("--json", self.json, &[Sweep, Random]),
        ]
    }

    /// Refuses options of other campaigns.
    pub(super) fn check_options(&self) -> Result<(), GenError> {
        for (option, is_there, of) in self.options() {
            if is_there && !of.contains(&self.name) {
                let of: Vec<String> = of.iter().map(|name| word(*name)).collect();
                return Err(GenError::input(format!(
                    "campaign {}: {option}: is only of {}; leave it out",
                    word(self.name),
                    of.join(", ")
                )));
            }
        }
        Ok(())
    }
}

/// A campaign as it is typed.
fn word(name: Name) -> String {
    let value = name.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}
