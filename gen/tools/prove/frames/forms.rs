//! Bits as functions of unknown bits, written so that equal ones mostly are the same number: exclusive or of products of unknowns.
//!
//! A CRC, a parity, a shift register and a position are exclusive ors, and stay exact whatever their width; that is what solvers of
//! Boolean formulas are slow at. A product with too many terms becomes an unknown of its own, that is known by its two factors. So two
//! functions that are told to be the same are the same; of two that are told apart, [`Forms::sample`] says whether they are.

use endat_sim::rng::Rng;
use std::collections::HashMap;

/// A function: which sum of products it is, and in the last bit whether it is inverted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Form(u32);

impl Form {
    pub const LOW: Self = Self(0);
    pub const HIGH: Self = Self(1);

    fn sum(self) -> u32 {
        self.0 >> 1
    }

    fn is_inverted(self) -> bool {
        self.0 & 1 == 1
    }

    /// Its level, if that is known.
    pub fn level(self) -> Option<bool> {
        (self.sum() == 0).then_some(self.is_inverted())
    }

    pub fn inverted_if(self, inverted: bool) -> Self {
        Self(self.0 ^ u32::from(inverted))
    }
}

impl std::ops::Not for Form {
    type Output = Self;
    fn not(self) -> Self {
        Self(self.0 ^ 1)
    }
}

impl From<bool> for Form {
    fn from(level: bool) -> Self {
        Self(u32::from(level))
    }
}

/// What an unknown is.
#[derive(Clone, Copy, Debug)]
enum Unknown {
    /// Anything.
    Free,
    /// The product of two functions, which would have had too many terms.
    Product(Form, Form),
    /// A sum of older ones, which one of these has been written with since: see [`Forms::name`].
    Sum(Form),
}

/// An unknown, and the function that stands for it from now on.
#[derive(Clone, Debug)]
pub(super) struct Renamed {
    unknown: u32,
    by: Form,
    /// What each sum has become.
    done: HashMap<u32, Form>,
}

/// Products with more terms become an unknown.
const TERMS_MAX: usize = 64;

/// All functions of a run.
pub(super) struct Forms {
    unknowns: Vec<Unknown>,
    /// Unknowns of each product of a sum, in order.
    terms: Interned,
    /// Terms of each sum, in order; sum 0 is empty.
    sums: Interned,
    added: HashMap<(u32, u32), u32>,
    multiplied: HashMap<(u32, u32), u32>,
    /// Products that are unknowns.
    named: HashMap<(Form, Form), Form>,
}

/// Lists with a number for each.
#[derive(Default)]
struct Interned {
    lists: Vec<Box<[u32]>>,
    numbers: HashMap<Box<[u32]>, u32>,
}

impl Interned {
    fn number(&mut self, list: Vec<u32>) -> u32 {
        let list = list.into_boxed_slice();
        if let Some(number) = self.numbers.get(&list) {
            return *number;
        }
        let number = self.lists.len() as u32;
        self.lists.push(list.clone());
        self.numbers.insert(list, number);
        number
    }

    fn list(&self, number: u32) -> &[u32] {
        &self.lists[number as usize]
    }
}

/// Members of one of two ordered lists, of both (`keeps_both`), or of exactly one.
fn merged(a: &[u32], b: &[u32], keeps_both: bool) -> Vec<u32> {
    let mut out = Vec::with_capacity(a.len() + b.len());
    let (mut i, mut j) = (0, 0);
    while i < a.len() || j < b.len() {
        if j == b.len() || (i < a.len() && a[i] < b[j]) {
            out.push(a[i]);
            i += 1;
        } else if i == a.len() || b[j] < a[i] {
            out.push(b[j]);
            j += 1;
        } else {
            if keeps_both {
                out.push(a[i]);
            }
            i += 1;
            j += 1;
        }
    }
    out
}

impl Forms {
    pub fn new() -> Self {
        let mut forms = Self {
            unknowns: vec![],
            terms: Interned::default(),
            sums: Interned::default(),
            added: HashMap::new(),
            multiplied: HashMap::new(),
            named: HashMap::new(),
        };
        forms.sums.number(vec![]);
        forms
    }

    /// A new unknown that may be anything.
    pub fn free(&mut self) -> Form {
        Form(self.unknown(Unknown::Free) << 1)
    }

    fn unknown(&mut self, what: Unknown) -> u32 {
        self.unknowns.push(what);
        self.alone(self.unknowns.len() as u32 - 1).sum()
    }

    fn add(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        match (a == 0, a == b) {
            (true, _) => return b,
            (_, true) => return 0,
            _ => {}
        }
        if let Some(sum) = self.added.get(&(a, b)) {
            return *sum;
        }
        let sum = merged(self.sums.list(a), self.sums.list(b), false);
        let sum = self.sums.number(sum);
        self.added.insert((a, b), sum);
        sum
    }

    /// The product of two sums, if it is short.
    fn multiply(&mut self, a: u32, b: u32) -> Option<u32> {
        let (a, b) = (a.min(b), a.max(b));
        if let Some(sum) = self.multiplied.get(&(a, b)) {
            return Some(*sum);
        }
        let (x, y) = (self.sums.list(a), self.sums.list(b));
        if x.len() * y.len() > TERMS_MAX {
            return None;
        }
        let pairs: Vec<(u32, u32)> = (x.iter())
            .flat_map(|i| y.iter().map(|j| (*i, *j)))
            .collect();
        let product = |&(i, j): &(u32, u32)| {
            let both = merged(self.terms.list(i), self.terms.list(j), true);
            self.terms.number(both)
        };
        let mut terms: Vec<u32> = pairs.iter().map(product).collect();
        terms.sort_unstable();
        // What is there twice is not there.
        let groups = terms.chunk_by(|a, b| a == b);
        let terms = groups.filter(|g| g.len() % 2 == 1).map(|g| g[0]);
        let terms = terms.collect();
        let sum = self.sums.number(terms);
        self.multiplied.insert((a, b), sum);
        Some(sum)
    }

    pub fn xor(&mut self, a: Form, b: Form) -> Form {
        let sum = self.add(a.sum(), b.sum());
        Form(sum << 1).inverted_if(a.is_inverted() != b.is_inverted())
    }

    pub fn and(&mut self, a: Form, b: Form) -> Form {
        match (a.level(), b.level()) {
            (Some(false), _) | (_, Some(false)) => return Form::LOW,
            (Some(true), _) => return b,
            (_, Some(true)) => return a,
            _ => {}
        }
        if a == b {
            return a;
        }
        if a == !b {
            return Form::LOW;
        }
        let Some(product) = self.multiply(a.sum(), b.sum()) else {
            // Inversions stay within: sums that go on for many cycles would grow otherwise.
            let (a, b) = (a.min(b), a.max(b));
            if let Some(form) = self.named.get(&(a, b)) {
                return *form;
            }
            let form = Form(self.unknown(Unknown::Product(a, b)) << 1);
            self.named.insert((a, b), form);
            return form;
        };
        // (x + i)(y + j) = xy + jx + iy + ij
        let mut sum = product;
        if b.is_inverted() {
            sum = self.add(sum, a.sum());
        }
        if a.is_inverted() {
            sum = self.add(sum, b.sum());
        }
        Form(sum << 1).inverted_if(a.is_inverted() && b.is_inverted())
    }

    pub fn or(&mut self, a: Form, b: Form) -> Form {
        !self.and(!a, !b)
    }

    /// `b` while `select` is HIGH, `a` otherwise.
    pub fn mux(&mut self, a: Form, b: Form, select: Form) -> Form {
        // Mostly it is known; the sum of both would be one more for nothing.
        if let Some(level) = select.level() {
            return if level { b } else { a };
        }
        // Two ways to write it are one function.
        let (a, b, select) = match select.is_inverted() {
            true => (b, a, !select),
            false => (a, b, select),
        };
        let difference = self.xor(a, b);
        let taken = self.and(difference, select);
        self.xor(a, taken)
    }

    /// Whether a sum has an unknown in a term of its own and in no other: then it can be solved for it.
    pub fn has_alone(&self, sum: Form, unknown: Form) -> bool {
        let [term] = self.sums.list(unknown.sum()) else {
            return false;
        };
        let [unknown] = self.terms.list(*term) else {
            return false;
        };
        let with = self.sums.list(sum.sum()).iter();
        let mut with = with.filter(|t| self.terms.list(**t).contains(unknown));
        with.next() == Some(term) && with.next().is_none()
    }

    /// Makes an unknown of a sum of several: the oldest one of these is the sum of it and the others from now on, wherever it is.
    /// None: it is no such sum.
    ///
    /// The edge between two CRC bits is a product of long sums otherwise, and what comes of it is no longer told to be the same.
    pub fn name(&mut self, form: Form) -> Option<Renamed> {
        let terms = self.sums.list(form.sum());
        let unknowns: Option<Vec<u32>> = terms
            .iter()
            .map(|term| match self.terms.list(*term) {
                [unknown] => Some(*unknown),
                _ => None,
            })
            .collect();
        let unknowns = unknowns.filter(|unknowns| unknowns.len() > 1)?;
        let is_free = |unknown: &u32| matches!(self.unknowns[*unknown as usize], Unknown::Free);
        let oldest = unknowns.into_iter().filter(is_free).min()?;
        let named = Form(self.unknown(Unknown::Sum(form)) << 1);
        let alone = self.alone(oldest);
        let others = self.xor(form, alone);
        Some(Renamed {
            unknown: oldest,
            by: self.xor(named, others),
            done: HashMap::new(),
        })
    }

    /// A function as it is written after that.
    pub fn renamed(&mut self, form: Form, renamed: &mut Renamed) -> Form {
        if let Some(done) = renamed.done.get(&form.sum()) {
            return done.inverted_if(form.is_inverted());
        }
        let has = |term: &u32| self.terms.list(*term).contains(&renamed.unknown);
        let terms = self.sums.list(form.sum());
        let (with, without): (Vec<u32>, Vec<u32>) = terms.iter().partition(|term| has(term));
        let mut sum = Form(form.sum() << 1);
        if !with.is_empty() {
            sum = Form(self.sums.number(without) << 1);
            for term in with {
                let factors = self.terms.list(term).to_vec();
                let mut product = renamed.by;
                for factor in factors.into_iter().filter(|f| *f != renamed.unknown) {
                    let factor = self.alone(factor);
                    product = self.and(product, factor);
                }
                sum = self.xor(sum, product);
            }
        }
        renamed.done.insert(form.sum(), sum);
        sum.inverted_if(form.is_inverted())
    }

    fn alone(&mut self, unknown: u32) -> Form {
        let term = self.terms.number(vec![unknown]);
        Form(self.sums.number(vec![term]) << 1)
    }

    /// 64 draws of all unknowns.
    pub fn sample(&self, seed: u64) -> Sample<'_> {
        let mut sample = Sample {
            forms: self,
            levels: Vec::with_capacity(self.unknowns.len()),
        };
        let mut rng = Rng::new(seed);
        for unknown in &self.unknowns {
            // What it is made of is older than it is.
            let levels = match unknown {
                Unknown::Free => rng.next_u64(),
                Unknown::Sum(form) => sample.levels(*form),
                Unknown::Product(a, b) => sample.levels(*a) & sample.levels(*b),
            };
            sample.levels.push(levels);
        }
        sample
    }
}

/// Levels of all unknowns in 64 draws, a bit for each.
pub(super) struct Sample<'a> {
    forms: &'a Forms,
    levels: Vec<u64>,
}

impl Sample<'_> {
    fn of_sum(&self, sum: u32) -> u64 {
        let product = |term: &u32| {
            let unknowns = self.forms.terms.list(*term).iter();
            unknowns.fold(!0, |level, u| level & self.levels[*u as usize])
        };
        let terms = self.forms.sums.list(sum).iter();
        terms.fold(0, |level, term| level ^ product(term))
    }

    /// A function's level in each draw.
    pub fn levels(&self, form: Form) -> u64 {
        match form.is_inverted() {
            false => self.of_sum(form.sum()),
            true => !self.of_sum(form.sum()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random circuits: whatever the unknowns are, the function has the level that the gates have. Catches a rule of the algebra that is
    /// wrong, and a sum whose terms are out of order, in products that stay small and in those that become unknowns.
    #[test]
    fn functions_are_what_gates_compute() {
        for seed in 0..200 {
            let mut rng = Rng::new(seed);
            let mut forms = Forms::new();
            let inputs = 3 + (seed as usize % 20);
            let mut nets: Vec<Form> = (0..inputs).map(|_| forms.free()).collect();
            nets.extend([Form::LOW, Form::HIGH]);
            let mut gates = vec![];
            for _ in 0..120 {
                let mut any = || rng.next_u64() as usize % nets.len();
                let [a, b, c] = [any(), any(), any()];
                let kind = gates.len() % 5;
                gates.push((kind, [a, b, c]));
                let [a, b, c] = [nets[a], nets[b], nets[c]];
                nets.push(match kind {
                    0 => forms.and(a, b),
                    1 => forms.or(a, b),
                    2 => forms.xor(a, b),
                    3 => forms.mux(a, b, c),
                    _ => !a,
                });
            }
            let sample = forms.sample(seed);
            let mut levels: Vec<u64> = nets[..inputs].iter().map(|f| sample.levels(*f)).collect();
            levels.extend([0, !0]);
            for (kind, [a, b, c]) in gates {
                let [a, b, c] = [levels[a], levels[b], levels[c]];
                levels.push(match kind {
                    0 => a & b,
                    1 => a | b,
                    2 => a ^ b,
                    3 => (b & c) | (a & !c),
                    _ => !a,
                });
            }
            for (net, level) in nets.iter().zip(levels) {
                assert_eq!(sample.levels(*net), level, "seed {seed}");
            }
        }
    }

    /// A function stays what it was when a sum becomes an unknown: products that have the one which is written anew, too, and sums
    /// whose first unknown has been written anew before. The edge between two named sums is one between two unknowns.
    #[test]
    fn a_named_sum_changes_no_function() {
        for seed in 0..50 {
            let mut rng = Rng::new(seed);
            let mut forms = Forms::new();
            let unknowns: Vec<Form> = (0..24).map(|_| forms.free()).collect();
            let mut any = |forms: &mut Forms| {
                let bits = rng.next_u64();
                let taken = unknowns.iter().enumerate();
                let taken = taken.filter(|(index, _)| bits >> index & 1 == 1);
                taken.fold(Form::LOW, |sum, (_, unknown)| forms.xor(sum, *unknown))
            };
            let mut named = [any(&mut forms), any(&mut forms), any(&mut forms)];
            let mut live = unknowns.clone();
            for _ in 0..40 {
                let [a, b] = [any(&mut forms), any(&mut forms)];
                live.push(forms.and(a, unknowns[3]));
                live.push(forms.and(unknowns[0], unknowns[1]));
                live.push(forms.or(a, b));
            }
            let before = live.clone();
            for index in 0..named.len() {
                let mut renamed = forms.name(named[index]).expect("a long sum");
                for form in live.iter_mut().chain(&mut named) {
                    *form = forms.renamed(*form, &mut renamed);
                }
                assert!(forms.name(named[index]).is_none(), "it is one unknown now");
            }
            let edge = forms.xor(named[0], named[1]);
            let (both, once) = (forms.and(edge, named[0]), forms.and(named[0], !named[1]));
            assert_eq!(both, once);
            let sample = forms.sample(seed);
            for (before, after) in before.iter().zip(&live) {
                assert_eq!(sample.levels(*before), sample.levels(*after), "seed {seed}");
            }
        }
        let mut forms = Forms::new();
        let (a, b) = (forms.free(), forms.free());
        let product = forms.and(a, b);
        let with_product = forms.xor(a, product);
        assert!(forms.name(a).is_none() && forms.name(with_product).is_none());
    }

    /// Two ways to add up a parity are one function, of any width; a wrong one is another.
    #[test]
    fn a_parity_is_the_same_in_any_order() {
        let mut forms = Forms::new();
        let bits: Vec<Form> = (0..96).map(|_| forms.free()).collect();
        let forward = bits.iter().fold(Form::LOW, |sum, b| forms.xor(sum, *b));
        let halves = bits.chunks(2).rev().fold(Form::HIGH, |sum, pair| {
            let both = forms.xor(pair[0], !pair[1]);
            forms.xor(sum, both)
        });
        assert_eq!(forward, !halves.inverted_if(bits.len() / 2 % 2 == 1));
        let without_one = forms.xor(forward, bits[50]);
        assert!(forms.xor(without_one, forward).level().is_none());
        assert!(forms.has_alone(forward, bits[50]) && !forms.has_alone(without_one, bits[50]));
    }
}
