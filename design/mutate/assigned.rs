//! Whether a process still drives whatever it drove: a change must not make a latch.

use crate::elaborate::{mask, Module, NetId, Statement};
use std::collections::{BTreeMap, BTreeSet};

/// Bits that a process drives on every path, and nets that it reads before it has driven them.
#[derive(Default)]
pub(super) struct Assigned {
    /// Bits of each net that every way through the process assigns.
    always: BTreeMap<NetId, u128>,
    /// Nets of the process that it reads before every way has assigned all bits.
    early: BTreeSet<NetId>,
}

impl Assigned {
    pub fn of(module: &Module, targets: &BTreeSet<NetId>, statements: &[Statement]) -> Self {
        let mut assigned = Self::default();
        let mut always = BTreeMap::new();
        assigned.walk(module, targets, statements, &mut always);
        assigned.always = always;
        assigned
    }

    /// True if all that the other one assigns is assigned here too, and nothing more is read too early.
    pub fn covers(&self, other: &Self) -> bool {
        let bits = |net: &NetId| self.always.get(net).copied().unwrap_or(0);
        let is_kept = |(net, wanted): (&NetId, &u128)| wanted & !bits(net) == 0;
        other.always.iter().all(is_kept) && self.early.is_subset(&other.early)
    }

    fn walk(
        &mut self,
        module: &Module,
        targets: &BTreeSet<NetId>,
        statements: &[Statement],
        always: &mut BTreeMap<NetId, u128>,
    ) {
        for statement in statements {
            statement.for_each_own_expr(&mut |expr| {
                expr.for_each_net(&mut |net| {
                    let all = mask(module.nets[net].width_bits);
                    let bits = always.get(&net).copied().unwrap_or(0);
                    if targets.contains(&net) && bits & all != all {
                        self.early.insert(net);
                    }
                });
            });
            if let Statement::Assign {
                net,
                low_bit,
                value,
                ..
            } = statement
            {
                *always.entry(*net).or_default() |= mask(value.width_bits) << low_bit;
                continue;
            }
            let mut ways: Vec<BTreeMap<NetId, u128>> = vec![];
            for block in statement.blocks() {
                let mut way = always.clone();
                self.walk(module, targets, block, &mut way);
                ways.push(way);
            }
            if let Some((first, others)) = ways.split_first() {
                let common = first.iter().map(|(net, bits)| {
                    let rest = others.iter().map(|way| way.get(net).copied().unwrap_or(0));
                    (*net, rest.fold(*bits, |all, bits| all & bits))
                });
                *always = common.collect();
            }
        }
    }
}
