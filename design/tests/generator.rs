//! Random programs for [`super::program`].

use crate::program::{Op, E, S, WIDTHS};
use crate::rng::Rng;

/// Makes random kernels.
pub struct Generator {
    rng: Rng,
}

impl Generator {
    pub fn new(seed: u64) -> Self {
        Self {
            rng: Rng::new(seed),
        }
    }

    fn below(&mut self, limit: usize) -> usize {
        self.rng.in_range(0, limit as u64 - 1) as usize
    }

    fn width(&mut self) -> usize {
        WIDTHS[self.below(WIDTHS.len())]
    }

    fn wide(&mut self) -> usize {
        WIDTHS[1 + self.below(WIDTHS.len() - 1)]
    }

    fn number(&mut self, width: usize) -> u64 {
        let value = match self.below(4) {
            0 => 0,
            1 => u64::MAX,
            2 => self.rng.next_u64() & 7,
            _ => self.rng.next_u64(),
        };
        value & (u64::MAX >> (64 - width))
    }

    /// A value for an input.
    pub fn input(&mut self, width: usize) -> u128 {
        self.number(width).into()
    }

    /// A kernel of `statements` statements (after the defaults) with expressions of this depth.
    pub fn program(&mut self, statements: usize, depth: usize) -> Vec<S> {
        let mut program = vec![];
        for kind in ['l', 'o', 'd'] {
            for width in WIDTHS {
                // A default may only use what has one already: inputs and registers.
                let value = match kind {
                    'd' => E::Signal('r', *width),
                    _ => self.expression(*width, 1, &['a', 'b', 'r']),
                };
                program.push(S::Assign((kind, *width), value));
            }
        }
        program.extend((0..statements).map(|_| self.statement(depth, 2)));
        program
    }

    fn statement(&mut self, depth: usize, nesting: usize) -> S {
        match self.below(if nesting == 0 { 1 } else { 4 }) {
            0 | 1 => {
                let target = (['l', 'o', 'd'][self.below(3)], self.width());
                S::Assign(target, self.any(target.1, depth))
            }
            2 => {
                let condition = self.any(1, depth);
                S::If(
                    condition,
                    self.block(depth, nesting),
                    self.block(depth, nesting),
                )
            }
            _ => {
                let narrow = E::Binary(Op::And, Box::new(self.any(6, depth)), Box::new(E::Raw(3)));
                let arms = (0..self.below(4) as u64)
                    .map(|v| (v, self.block(depth, nesting)))
                    .collect();
                S::Match(narrow, arms, self.block(depth, nesting))
            }
        }
    }

    fn block(&mut self, depth: usize, nesting: usize) -> Vec<S> {
        (0..self.below(3))
            .map(|_| self.statement(depth, nesting - 1))
            .collect()
    }

    fn any(&mut self, width: usize, depth: usize) -> E {
        self.expression(width, depth, &['a', 'b', 'l', 'o', 'r'])
    }

    fn expression(&mut self, width: usize, depth: usize, kinds: &[char]) -> E {
        if depth == 0 || self.below(8) == 0 {
            return match self.below(4) {
                0 => E::Literal(self.number(width), width),
                _ => E::Signal(kinds[self.below(kinds.len())], width),
            };
        }
        let depth = depth - 1;
        let boxed = |g: &mut Self, w: usize| Box::new(g.expression(w, depth, kinds));
        let logic = [Op::And, Op::Or, Op::Xor];
        match (width, self.below(10)) {
            (_, 0) => E::Not(boxed(self, width)),
            (_, 1) => {
                let from = self.width();
                E::Cast(width, boxed(self, from))
            }
            (_, 2) => {
                let from = self.wide();
                let at = Box::new(self.position(from, depth, kinds));
                E::Slice(width, boxed(self, from), at)
            }
            (1, 3..=5) => {
                let of = self.wide();
                let op = [Op::Eq, Op::Ne, Op::Lt, Op::Le, Op::Gt, Op::Ge][self.below(6)];
                let left = boxed(self, of);
                let right = if self.below(2) == 0 {
                    Box::new(E::Raw(self.number(of)))
                } else {
                    boxed(self, of)
                };
                E::Compare(op, left, right)
            }
            (1, 6..=7) => {
                let of = self.wide();
                E::Reduce(
                    [Op::Any, Op::All, Op::Parity][self.below(3)],
                    boxed(self, of),
                )
            }
            (1, _) => E::Binary(logic[self.below(3)], boxed(self, 1), boxed(self, 1)),
            (_, 3) => {
                let op = [Op::Shl, Op::Shr][self.below(2)];
                let amount = match self.below(3) {
                    0 => Box::new(E::Raw(self.below(width + 2) as u64)),
                    1 => boxed(self, 6),
                    _ => boxed(self, 8),
                };
                E::Shift(op, boxed(self, width), amount)
            }
            (_, 4) => {
                let at = Box::new(self.position(width, depth, kinds));
                E::ReplaceBit(boxed(self, width), at, boxed(self, 1))
            }
            _ => {
                let op = [Op::Add, Op::Sub, Op::And, Op::Or, Op::Xor][self.below(5)];
                let left = boxed(self, width);
                let right = if self.below(4) == 0 {
                    Box::new(E::Raw(self.number(width)))
                } else {
                    boxed(self, width)
                };
                E::Binary(op, left, right)
            }
        }
    }

    /// A bit position below `width`: rust-hdl panics on others.
    fn position(&mut self, width: usize, depth: usize, kinds: &[char]) -> E {
        if self.below(2) == 0 {
            return E::Raw(self.below(width) as u64);
        }
        let limit = (width as u64 + 1).next_power_of_two() / 2 - 1;
        let index = self.expression(6, depth, kinds);
        match limit >= 63 {
            true => index,
            false => E::Binary(Op::And, Box::new(index), Box::new(E::Raw(limit))),
        }
    }
}
