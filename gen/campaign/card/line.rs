//! A host's program, one for each lane, that runs beside the simulation: it waits for bytes and for time, and nothing else is known to it.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::future::{poll_fn, Future};
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

/// What the host and the simulation hand each other.
struct Shelf<S, V> {
    now: u64,
    inbox: VecDeque<u8>,
    outbox: Vec<u8>,
    /// When the last byte came.
    heard: u64,
    /// The host wants to go on then at the latest.
    wake_at: u64,
    trigger: bool,
    seen: Option<S>,
    verdict: Option<V>,
}

/// The host's end: `S` is what it has seen, `V` what the judge says to that.
pub struct Line<S, V>(Rc<RefCell<Shelf<S, V>>>);

impl<S, V> Line<S, V> {
    /// System clock cycles so far.
    pub fn now(&self) -> u64 {
        self.0.borrow().now
    }

    /// When the last byte came.
    pub fn heard(&self) -> u64 {
        self.0.borrow().heard
    }

    /// Queues bytes.
    pub fn send(&self, bytes: &[u8]) {
        self.0.borrow_mut().outbox.extend(bytes);
    }

    /// A pulse at the trigger pin.
    pub fn trigger(&self) {
        self.0.borrow_mut().trigger = true;
    }

    /// Waits.
    pub async fn until(&self, cycle: u64) {
        poll_fn(|_| {
            let mut shelf = self.0.borrow_mut();
            shelf.wake_at = cycle;
            match shelf.now >= cycle {
                true => Poll::Ready(()),
                false => Poll::Pending,
            }
        })
        .await;
    }

    /// The next byte, if it comes by then.
    pub async fn byte(&self, by: u64) -> Option<u8> {
        poll_fn(|_| {
            let mut shelf = self.0.borrow_mut();
            shelf.wake_at = by;
            match shelf.inbox.pop_front() {
                Some(byte) => Poll::Ready(Some(byte)),
                None if shelf.now >= by => Poll::Ready(None),
                None => Poll::Pending,
            }
        })
        .await
    }

    /// Bytes that have come.
    pub fn take(&self) -> VecDeque<u8> {
        std::mem::take(&mut self.0.borrow_mut().inbox)
    }

    /// Says what it has seen, and hears what to do next.
    pub async fn tell(&self, seen: S) -> V {
        self.0.borrow_mut().seen = Some(seen);
        poll_fn(|_| match self.0.borrow_mut().verdict.take() {
            Some(verdict) => Poll::Ready(verdict),
            None => Poll::Pending,
        })
        .await
    }
}

/// A host's program on its way.
pub struct Host<S, V> {
    shelf: Rc<RefCell<Shelf<S, V>>>,
    program: Pin<Box<dyn Future<Output = ()>>>,
}

impl<S: 'static, V: 'static> Host<S, V> {
    /// Begins a program.
    pub fn new<P: Future<Output = ()> + 'static>(program: impl FnOnce(Line<S, V>) -> P) -> Self {
        let shelf = Rc::new(RefCell::new(Shelf {
            now: 0,
            inbox: VecDeque::new(),
            outbox: vec![],
            heard: 0,
            wake_at: 0,
            trigger: false,
            seen: None,
            verdict: None,
        }));
        let line = Line(shelf.clone());
        Self {
            shelf,
            program: Box::pin(program(line)),
        }
    }

    /// A byte has come.
    pub fn hear(&self, now: u64, byte: u8) {
        let mut shelf = self.shelf.borrow_mut();
        shelf.inbox.push_back(byte);
        shelf.heard = now;
    }

    /// When it wants to go on, if no byte comes before that.
    pub fn wake_at(&self) -> u64 {
        self.shelf.borrow().wake_at
    }

    /// What it has seen, if it waits for a verdict.
    pub fn seen(&self) -> Option<S> {
        self.shelf.borrow_mut().seen.take()
    }

    /// The verdict.
    pub fn answer(&self, verdict: V) {
        self.shelf.borrow_mut().verdict = Some(verdict);
    }

    /// Goes on as far as it can; whether it has ended.
    pub fn go_on(&mut self, now: u64) -> bool {
        self.shelf.borrow_mut().now = now;
        let mut context = Context::from_waker(Waker::noop());
        self.program.as_mut().poll(&mut context).is_ready()
    }

    /// Bytes that it sends, and whether it triggers.
    pub fn acts(&self) -> (Vec<u8>, bool) {
        let mut shelf = self.shelf.borrow_mut();
        let bytes = std::mem::take(&mut shelf.outbox);
        (bytes, std::mem::take(&mut shelf.trigger))
    }
}
