//! From the statements of one kernel to processes: targets that are assigned together stay together, as the author
//! wrote them, unless that would close a loop through another process or a child.

mod assigned;

pub(super) use assigned::for_each_read;

use super::design::{restricted, NetId, Process, Statement};
use assigned::check_assigned;
use std::collections::{BTreeMap, BTreeSet};

/// Nets that each target depends on combinationally.
pub(super) type Dependencies = BTreeMap<NetId, BTreeSet<NetId>>;

/// Why the statements have no exact meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum PlanError {
    /// These nets depend on each other.
    Loop(Vec<NetId>),
    /// Read before it is assigned.
    ReadBeforeAssigned(NetId),
    /// Not assigned on every way through the kernel.
    Latch(NetId),
}

/// Splits `statements` into processes in an order in which each reads only what earlier ones drive.
/// `through_children` says which nets a child's output depends on.
pub(super) fn plan(
    statements: &[Statement],
    through_children: &Dependencies,
) -> Result<(Vec<Process>, Dependencies), PlanError> {
    let targets = Targets::new(statements);
    let classes = targets.classes();
    check_order(&targets, &classes)?;
    let order = targets.sorted(&classes, through_children)?;
    let sets = place(&targets, &classes, &order, through_children);
    let mut processes = vec![];
    for set in sets {
        let statements = restricted(statements, &set);
        check_assigned(&statements, &set)?;
        processes.push(Process { statements });
    }
    Ok((processes, targets.depends))
}

/// Nets on which each target of statements depends.
pub(super) fn dependencies(statements: &[Statement]) -> Dependencies {
    Targets::new(statements).depends
}

/// The smallest processes that the statements of one process can be taken apart into.
pub(super) fn split(statements: &[Statement]) -> Vec<Process> {
    let targets = Targets::new(statements);
    let classes = targets.classes();
    let none = Dependencies::new();
    // One process is never a loop in itself.
    let order = targets.sorted(&classes, &none).unwrap_or_default();
    if order.len() < 2 {
        return vec![Process {
            statements: statements.to_vec(),
        }];
    }
    let part = |class: &NetId| {
        let members = classes.iter().filter(|(_, c)| *c == class);
        let set: BTreeSet<NetId> = members.map(|(net, _)| *net).collect();
        Process {
            statements: restricted(statements, &set),
        }
    };
    order.iter().map(part).collect()
}

/// Targets of the kernel's assignments, and their order.
struct Targets {
    /// First and last top-level statement that assigns a net.
    span: BTreeMap<NetId, (usize, usize)>,
    /// (target, net read for it, top-level statement)
    reads: BTreeSet<(NetId, NetId, usize)>,
    depends: Dependencies,
    /// Targets of each top-level statement.
    together: Vec<BTreeSet<NetId>>,
}

impl Targets {
    fn new(statements: &[Statement]) -> Self {
        let mut targets = Self {
            span: BTreeMap::new(),
            reads: BTreeSet::new(),
            depends: BTreeMap::new(),
            together: vec![],
        };
        for (at, statement) in statements.iter().enumerate() {
            let set = super::design::targets(std::slice::from_ref(statement));
            for &target in &set {
                targets.span.entry(target).or_insert((at, at)).1 = at;
                let part = statement.restricted_to(&BTreeSet::from([target]));
                let depends = targets.depends.entry(target).or_default();
                if let Some(part) = part {
                    part.for_each_expr(&mut |expr| {
                        expr.for_each_net(&mut |net| {
                            depends.insert(net);
                            targets.reads.insert((target, net, at));
                        });
                    });
                }
            }
            targets.together.push(set);
        }
        targets
    }

    /// A name (one of its nets) for each set of targets that must share a process, because one reads a value of another
    /// that is not its last.
    fn classes(&self) -> BTreeMap<NetId, NetId> {
        let mut sets = Sets::new(self.span.keys().copied());
        for &(target, read, at) in &self.reads {
            if let Some(&(first, last)) = self.span.get(&read) {
                if (first..=last).contains(&at) {
                    sets.join(target, read);
                }
            }
        }
        // Sets that read each other's last values can only run as one, in the order of the source.
        loop {
            let classes = sets.names();
            let mut graph: Dependencies = classes
                .values()
                .map(|class| (*class, BTreeSet::new()))
                .collect();
            for &(target, read, at) in &self.reads {
                if let Some(&(_, last)) = self.span.get(&read) {
                    let (class, source) = (classes[&target], classes[&read]);
                    if at > last && class != source {
                        graph.entry(class).or_default().insert(source);
                    }
                }
            }
            let left: BTreeMap<NetId, usize> = graph.keys().map(|class| (*class, 0)).collect();
            let found = find_loop(&graph, &on_loops(&graph, left));
            if found.len() < 2 {
                return classes;
            }
            for pair in found.windows(2) {
                sets.join(pair[0], pair[1]);
            }
        }
    }

    /// Sets of classes that share top-level statements: candidates for one process.
    fn groups(&self, classes: &BTreeMap<NetId, NetId>) -> BTreeMap<NetId, NetId> {
        let mut sets = Sets::new(self.span.keys().copied());
        for (net, class) in classes {
            sets.join(*net, *class);
        }
        for set in &self.together {
            for pair in set.iter().collect::<Vec<_>>().windows(2) {
                sets.join(*pair[0], *pair[1]);
            }
        }
        sets.names()
    }

    /// For each class, the other classes that it reads.
    fn direct_graph(&self, classes: &BTreeMap<NetId, NetId>) -> Dependencies {
        let mut graph: Dependencies = classes
            .values()
            .map(|class| (*class, BTreeSet::new()))
            .collect();
        for (target, depends) in &self.depends {
            let class = classes[target];
            let sources = depends.iter().filter_map(|net| classes.get(net));
            graph
                .entry(class)
                .or_default()
                .extend(sources.filter(|source| **source != class));
        }
        graph
    }

    /// For each class, the classes that it reads by way of a child. One that reads itself so is a loop.
    fn through_graph(
        &self,
        classes: &BTreeMap<NetId, NetId>,
        through_children: &Dependencies,
    ) -> Dependencies {
        let mut graph: Dependencies = classes
            .values()
            .map(|class| (*class, BTreeSet::new()))
            .collect();
        for (target, depends) in &self.depends {
            let sources = depends
                .iter()
                .filter_map(|net| through_children.get(net))
                .flatten();
            let sources = sources.filter_map(|source| classes.get(source));
            graph.entry(classes[target]).or_default().extend(sources);
        }
        graph
    }

    /// The classes in an order in which each depends on earlier ones only, as close to the source as possible.
    fn sorted(
        &self,
        classes: &BTreeMap<NetId, NetId>,
        through_children: &Dependencies,
    ) -> Result<Vec<NetId>, PlanError> {
        let mut graph = self.direct_graph(classes);
        for (class, sources) in self.through_graph(classes, through_children) {
            graph.entry(class).or_default().extend(sources);
        }
        let groups = self.groups(classes);
        let first = |class: NetId| {
            let members = classes.iter().filter(|(_, c)| **c == class);
            members.map(|(net, _)| self.span[net].0).min().unwrap_or(0)
        };
        let mut left: BTreeMap<NetId, usize> =
            graph.keys().map(|class| (*class, first(*class))).collect();
        let mut order: Vec<NetId> = vec![];
        while !left.is_empty() {
            let last_group = order.last().map(|class| groups[class]);
            let ready = left
                .iter()
                .filter(|(class, _)| graph[class].iter().all(|source| !left.contains_key(source)))
                .min_by_key(|(class, first)| (Some(groups[class]) != last_group, **first));
            let Some((&class, _)) = ready else {
                return Err(PlanError::Loop(find_loop(&graph, &left)));
            };
            left.remove(&class);
            order.push(class);
        }
        Ok(order)
    }
}

/// The classes that are left when those that depend on nothing left are taken away again and again.
fn on_loops(graph: &Dependencies, mut left: BTreeMap<NetId, usize>) -> BTreeMap<NetId, usize> {
    loop {
        let count = left.len();
        let before = left.clone();
        left.retain(|class, _| {
            graph[class]
                .iter()
                .any(|source| before.contains_key(source))
        });
        if left.len() == count {
            return left;
        }
    }
}

fn find_loop(graph: &Dependencies, left: &BTreeMap<NetId, usize>) -> Vec<NetId> {
    let mut path: Vec<NetId> = left.keys().take(1).copied().collect();
    while let Some(last) = path.last() {
        let Some(&next) = graph[last].iter().find(|source| left.contains_key(source)) else {
            break;
        };
        if let Some(at) = path.iter().position(|net| *net == next) {
            let mut found = path.split_off(at);
            found.reverse();
            return found;
        }
        path.push(next);
    }
    path
}

/// The target sets of the processes, in order.
fn place(
    targets: &Targets,
    classes: &BTreeMap<NetId, NetId>,
    order: &[NetId],
    through_children: &Dependencies,
) -> Vec<BTreeSet<NetId>> {
    let direct = targets.direct_graph(classes);
    let through = targets.through_graph(classes, through_children);
    let groups = targets.groups(classes);
    let mut process_of: BTreeMap<NetId, usize> = BTreeMap::new();
    // For each process: the group, and the processes that it reads.
    let mut processes: Vec<(NetId, BTreeSet<usize>)> = vec![];
    for class in order {
        let processes_of = |graph: &Dependencies| -> BTreeSet<usize> {
            graph[class]
                .iter()
                .map(|source| process_of[source])
                .collect()
        };
        let (sources, around) = (processes_of(&direct), processes_of(&through));
        let fits = |process: usize| {
            processes[process].0 == groups[class]
                && !targets.is_read_early(*class, process, classes, &process_of)
                // Joining must not make the process feed itself through another one or through a child.
                && sources.iter().all(|source| *source == process || !reads(&processes, *source, process))
                && around.iter().all(|source| !reads(&processes, *source, process))
        };
        let process = match (0..processes.len()).rev().find(|process| fits(*process)) {
            Some(process) => process,
            None => {
                processes.push((groups[class], BTreeSet::new()));
                processes.len() - 1
            }
        };
        processes[process]
            .1
            .extend(sources.into_iter().chain(around).filter(|s| *s != process));
        process_of.insert(*class, process);
    }
    let mut sets = vec![BTreeSet::new(); processes.len()];
    for (net, class) in classes {
        sets[process_of[class]].insert(*net);
    }
    // A process joined late may read one that was made after it: sort once more.
    let mut done: Vec<usize> = vec![];
    while done.len() < processes.len() {
        let next = (0..processes.len())
            .find(|p| {
                !done.contains(p) && processes[*p].1.iter().all(|source| done.contains(source))
            })
            .unwrap_or(done.len());
        done.push(next);
    }
    done.into_iter()
        .map(|process| std::mem::take(&mut sets[process]))
        .collect()
}

/// Whether process `from` reads, directly or not, process `to`.
fn reads(processes: &[(NetId, BTreeSet<usize>)], from: usize, to: usize) -> bool {
    let mut seen = BTreeSet::new();
    let mut open = vec![from];
    while let Some(process) = open.pop() {
        if process == to {
            return true;
        }
        if seen.insert(process) {
            open.extend(&processes[process].1);
        }
    }
    false
}

impl Targets {
    /// True if `class` and a member of `process` read each other before the first assignment: such a read means
    /// the final value, so it must be in another process.
    fn is_read_early(
        &self,
        class: NetId,
        process: usize,
        classes: &BTreeMap<NetId, NetId>,
        process_of: &BTreeMap<NetId, usize>,
    ) -> bool {
        self.reads.iter().any(|(target, read, at)| {
            let (Some(target), Some(source)) = (classes.get(target), classes.get(read)) else {
                return false;
            };
            let is_pair = (*target == class && process_of.get(source) == Some(&process))
                || (*source == class && process_of.get(target) == Some(&process));
            is_pair && *at < self.span[read].0
        })
    }
}

/// A target that must share the process of what it reads early has no exact meaning.
fn check_order(targets: &Targets, classes: &BTreeMap<NetId, NetId>) -> Result<(), PlanError> {
    for (target, read, at) in &targets.reads {
        let is_early = targets.span.get(read).is_some_and(|(first, _)| at < first);
        if is_early && classes.get(target) == classes.get(read) {
            return Err(PlanError::ReadBeforeAssigned(*read));
        }
    }
    Ok(())
}

/// Disjoint sets of nets.
struct Sets {
    parent: BTreeMap<NetId, NetId>,
}

impl Sets {
    fn new(nets: impl Iterator<Item = NetId>) -> Self {
        Self {
            parent: nets.map(|net| (net, net)).collect(),
        }
    }

    fn root(&self, mut net: NetId) -> NetId {
        while self.parent[&net] != net {
            net = self.parent[&net];
        }
        net
    }

    fn join(&mut self, a: NetId, b: NetId) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent.insert(a.max(b), a.min(b));
    }

    fn names(&self) -> BTreeMap<NetId, NetId> {
        self.parent
            .keys()
            .map(|net| (*net, self.root(*net)))
            .collect()
    }
}
