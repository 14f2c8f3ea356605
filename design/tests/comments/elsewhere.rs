//! A part of a kernel in another file.

use rtl_design::kernel_parts;

#[kernel_parts(counting)]
impl Lamps {
    /// Counts, and
    /// shows.
    fn count_lamps(&mut self) {
        self.count.next = self.counter.q.val();
        // Two cases.
        match self.wanted.val().index() {
            0 => self.dark(),
            // This one is not handed on: it is about no statement.
            _ => {
                // Something is wanted.
                self.shown.next = self.wanted.val();
                if self.wanted.val().all() {
                    // Both.
                    self.counter.d.next = self.counter.q.val() + 1;
                }
            }
        }
    }
}
