//! Names within a module.

use crate::elaborate::EnumType;
use std::collections::BTreeSet;

/// Names in use, without regard to case.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    /// These are in use.
    pub fn new<'a>(names: impl IntoIterator<Item = &'a String>) -> Self {
        Self(names.into_iter().map(|name| name.to_lowercase()).collect())
    }

    /// `base`, or `base` with a number if that is taken.
    pub fn unique(&mut self, base: &str) -> String {
        let numbered = (2..).map(|number| format!("{base}_{number}"));
        let name = std::iter::once(base.to_string())
            .chain(numbered)
            .find(|name| !self.0.contains(&name.to_lowercase()))
            .unwrap_or_default();
        self.0.insert(name.to_lowercase());
        name
    }
}

/// `NoStartBit` becomes `NO_START_BIT`.
fn upper(name: &str) -> String {
    let mut out = String::new();
    let mut previous_is_lower = false;
    for c in name.chars() {
        if c.is_ascii_uppercase() && previous_is_lower {
            out.push('_');
        }
        previous_is_lower = !c.is_ascii_uppercase();
        out.push(c.to_ascii_uppercase());
    }
    out
}

/// Name of a state, if it is free.
pub(crate) fn variant_name(enum_type: &EnumType, variant: usize) -> String {
    let name = upper(&enum_type.variants[variant]);
    format!("{}_{name}", upper(&enum_type.name))
}
