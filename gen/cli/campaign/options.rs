//! Which options a campaign has: one that it has not is refused, as nothing would follow from it.

use super::{CampaignArgs, Name};
use clap::ValueEnum;
use endat_console::error::CommandError;
use Name::{Accept, Configurations, Faults, Garbage, Merge, Random, Sweep, Upsets};

/// Those that count what becomes of each case.
const COUNTING: &[Name] = &[Upsets, Faults, Garbage, Accept, Configurations];
/// Those that have cases.
#[rustfmt::skip]
const RUNNING: &[Name] = &[Sweep, Random, Upsets, Faults, Garbage, Accept, Configurations];

impl CampaignArgs {
    /// Each option that is not of every campaign: whether it is there, and whose it is.
    fn options(&self) -> [(&'static str, bool, &'static [Name]); 15] {
        [
            ("PART", !self.parts.is_empty(), &[Merge]),
            (
                "--cases",
                self.cases.is_some(),
                &[Random, Upsets, Garbage, Configurations],
            ),
            ("--moments", self.moments.is_some(), &[Upsets]),
            ("--step", self.step.is_some(), &[Faults]),
            (
                "--subject",
                self.subject.is_some(),
                &[Upsets, Faults, Garbage],
            ),
            ("--only", self.only.is_some(), &[Upsets]),
            (
                "--seed",
                self.seed.is_some(),
                &[Random, Upsets, Faults, Garbage, Configurations],
            ),
            ("--quick", self.quick, COUNTING),
            ("--shard", self.shard.is_some(), COUNTING),
            (
                "--out",
                self.out.is_some(),
                &[Upsets, Faults, Garbage, Accept, Configurations, Merge],
            ),
            ("--threads", self.threads.is_given(), RUNNING),
            (
                "--case",
                self.case.is_some(),
                &[Sweep, Random, Configurations],
            ),
            ("--vcd", self.vcd.is_some(), &[Sweep, Random]),
            ("--svg", self.svg.is_some(), &[Sweep, Random]),
            ("--json", self.json, &[Sweep, Random]),
        ]
    }

    /// Refuses options of other campaigns.
    pub(super) fn check_options(&self) -> Result<(), CommandError> {
        for (option, is_there, of) in self.options() {
            if is_there && !of.contains(&self.name) {
                let of: Vec<String> = of.iter().map(|name| word(*name)).collect();
                return Err(CommandError::input(format!(
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
