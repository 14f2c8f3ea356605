//! The table `[safety]`.

use super::keys::{ERROR_TEST_PERIOD as PERIOD, RESTORE, SAFETY_PARTS as PARTS, UPSET_GUARDS};
use super::parts::read_parts;
use super::reader::Table;
use endat_hdl::card::bus::HostBus;
use endat_hdl::config::SafetyParts;

/// What else the card has, as far as it could be read.
#[derive(Clone, Copy)]
pub struct Around {
    /// Its bus.
    pub bus: Option<HostBus>,
    /// Some channel speaks EnDat.
    pub has_endat: bool,
    /// DATA is looked at on both edges of the system clock.
    pub double_edge: bool,
    /// The channels have a service.
    pub has_requests: bool,
}

impl Around {
    /// Why this part cannot be there, and what to do.
    fn refuses(self, part: &str) -> Option<&'static str> {
        let takes_registers = part != "second_receiver";
        let takes_endat = part != "second_interface";
        match part {
            _ if self.bus == Some(HostBus::Bare) && takes_registers => Some("host.bus = \"none\" has no registers, and all results as ports; choose another bus, or leave it out"),
            "recovery_counter" if !self.has_endat => Some("no channel speaks EnDat, and T-format has no recovery time; leave it out"),
            _ if !self.has_endat && takes_endat => Some("no channel speaks EnDat; leave it out"),
            "second_receiver" if self.double_edge => Some("bits of line.parts = [\"double_edge\"] are too short for a comparison; leave one of them out"),
            "error_test" if !self.has_requests => Some("frames of its own take the service; write service.parts = [\"requests\"]"),
            _ => None,
        }
    }
}

/// Whether stored bits are checked.
pub fn read_guards(table: &Table<'_, '_>) -> bool {
    table.boolean(&UPSET_GUARDS).is_some_and(|at| at.value)
}

/// Reads the table; `None` if something is wrong.
pub fn read(table: &Table<'_, '_>, around: Around) -> Option<SafetyParts> {
    // A card with registers always restores.
    let restores = table.boolean(&RESTORE).is_some_and(|at| at.value);
    let mut parts = SafetyParts {
        upset_guards: read_guards(table),
        restore: restores && around.bus == Some(HostBus::Bare),
        ..SafetyParts::default()
    };
    let mut tests = false;
    let marks = &mut [
        &mut parts.recovery_counter,
        &mut parts.second_interface,
        &mut parts.second_receiver,
        &mut tests,
    ];
    let named = read_parts(table, &PARTS, marks);
    let period_limits = PERIOD.limits(None);
    let period = table.integer(&PERIOD, &period_limits);
    let mut good = true;
    for (line, shown) in &named? {
        if let Some(remedy) = around.refuses(shown.trim_matches('"')) {
            table.complain(*line, PARTS.name, shown, remedy);
            good = false;
        }
    }
    if let Some(period) = &period {
        if !tests {
            let text = match around.has_endat {
                true => "takes the part error_test; add it to safety.parts, or remove the key",
                false => {
                    "takes a channel that speaks EnDat, and this card has none; remove the key"
                }
            };
            table.complain(period.line, PERIOD.name, &period.value.to_string(), text);
            return None;
        }
        table.check(&PERIOD, period, &period_limits);
        good &= period_limits.contains(period.value);
    }
    if tests {
        parts.error_test_ms = period.map_or(PERIOD.usual_number(), |p| p.value) as u16;
    }
    good.then_some(parts)
}
