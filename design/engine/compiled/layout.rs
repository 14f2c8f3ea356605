//! Layout of the state of a running design: one array of 64-bit words.

use crate::engine::form::{Commit, Form};

/// Word positions. First the segments to run, then the registers to load, then the memories to serve (one bit each), then nets.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Layout {
    /// First word of each net that has a value.
    slots: Vec<Option<usize>>,
    segments: usize,
    /// Commits that load registers; those of memories follow.
    pub groups: usize,
    memories: usize,
    /// Words in all.
    pub words: usize,
    /// For each net, the words and bits to set when it changes.
    marks: Vec<Vec<(usize, u64)>>,
}

fn words_for(bits: usize) -> usize {
    bits.div_ceil(64)
}

impl Layout {
    /// A layout in which a net of so many bits takes `words_of` words.
    pub fn new(form: &Form, words_of: impl Fn(usize) -> usize) -> Self {
        let is_group = |c: &&Commit| matches!(c, Commit::Registers(_));
        let groups = form.commits.iter().filter(is_group).count();
        let mut layout = Self {
            slots: vec![None; form.nets.len()],
            segments: form.segments.len(),
            groups,
            memories: form.memories.len(),
            words: 0,
            marks: vec![],
        };
        layout.words = layout.memory_words().end;
        for (net, slot) in layout.slots.iter_mut().enumerate() {
            if form.is_stored[net] {
                *slot = Some(layout.words);
                layout.words += words_of(form.nets[net].width_bits);
            }
        }
        layout.marks = (0..form.nets.len())
            .map(|net| layout.marks_of(form, net))
            .collect();
        layout
    }

    /// The words with a bit for each segment to run.
    pub fn segment_words(&self) -> std::ops::Range<usize> {
        0..words_for(self.segments)
    }

    /// The words with a bit for each group of registers to load.
    pub fn group_words(&self) -> std::ops::Range<usize> {
        let start = self.segment_words().end;
        start..start + words_for(self.groups)
    }

    /// The words with a bit for each memory to serve.
    pub fn memory_words(&self) -> std::ops::Range<usize> {
        let start = self.group_words().end;
        start..start + words_for(self.memories)
    }

    fn marks_of(&self, form: &Form, net: usize) -> Vec<(usize, u64)> {
        let segments = form.readers[net].iter().map(|s| (s / 64, s % 64));
        let commits = form.commit_readers[net].iter().map(|c| {
            let (first, index) = match c.checked_sub(self.groups) {
                None => (self.group_words().start, *c),
                Some(memory) => (self.memory_words().start, memory),
            };
            (first + index / 64, index % 64)
        });
        let mut marks: Vec<(usize, u64)> = vec![];
        for (word, bit) in segments.chain(commits) {
            match marks.iter_mut().find(|(w, _)| *w == word) {
                Some((_, bits)) => *bits |= 1 << bit,
                None => marks.push((word, 1 << bit)),
            }
        }
        marks
    }

    /// Words and bits to set when a net changes.
    pub fn marks(&self, net: usize) -> &[(usize, u64)] {
        &self.marks[net]
    }

    /// The first word of a net, if it is stored.
    pub fn slot(&self, net: usize) -> Option<usize> {
        self.slots[net]
    }

    /// The first word of a stored net.
    ///
    /// # Panics
    /// If it is not stored; every net that is read or driven anywhere is.
    pub fn place(&self, net: usize) -> usize {
        self.slots[net].unwrap_or_else(|| unreachable!("net {net} is not stored"))
    }

    /// Notes in a state that a net has changed.
    pub fn mark(&self, state: &mut [u64], net: usize) {
        for (word, bits) in &self.marks[net] {
            state[*word] |= bits;
        }
    }

    /// Notes in a state that the registers and memories fed by a net are to be loaded.
    pub fn mark_commits(&self, state: &mut [u64], net: usize) {
        let first_commit = self.group_words().start;
        for (word, bits) in self.marks[net].iter().filter(|(w, _)| *w >= first_commit) {
            state[*word] |= bits;
        }
    }

    /// Takes the mark of the first memory from number `from` on that has one.
    pub fn take_memory(&self, state: &mut [u64], from: usize) -> Option<usize> {
        (from..self.memories).find(|memory| {
            let (word, mark) = self.memory_mark(*memory);
            let is_marked = state[word] & mark != 0;
            state[word] &= !mark;
            is_marked
        })
    }

    /// Notes in a state that a memory is to be served.
    pub fn mark_memory(&self, state: &mut [u64], memory: usize) {
        let (word, mark) = self.memory_mark(memory);
        state[word] |= mark;
    }

    fn memory_mark(&self, memory: usize) -> (usize, u64) {
        (self.memory_words().start + memory / 64, 1 << (memory % 64))
    }

    /// Takes the lowest mark in some of the words: its number, counted from the first of them.
    pub fn take_lowest(state: &mut [u64], words: std::ops::Range<usize>) -> Option<usize> {
        let first = words.start;
        let word = words.into_iter().find(|word| state[*word] != 0)?;
        let bit = state[word].trailing_zeros() as usize;
        state[word] &= state[word] - 1;
        Some(64 * (word - first) + bit)
    }

    /// Notes that nothing is settled.
    pub fn mark_all(&self, state: &mut [u64]) {
        let mut set = |words: std::ops::Range<usize>, count: usize| {
            for (index, word) in words.enumerate() {
                let left = count - 64 * index;
                state[word] = if left >= 64 {
                    u64::MAX
                } else {
                    (1 << left) - 1
                };
            }
        };
        set(self.segment_words(), self.segments);
        set(self.group_words(), self.groups);
        set(self.memory_words(), self.memories);
    }
}
