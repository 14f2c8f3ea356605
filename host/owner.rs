//! A thread that owns a card: it does one job after the other, and takes what a real card pushes even while its user does something else.

use crate::card::Card;
use crate::feed::{Feed, Row};
use crate::units::Scale;
use crate::{HostError, Transport};
use std::collections::VecDeque;
use std::sync::mpsc::{channel, Receiver, RecvTimeoutError, Sender, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// A card, whatever it is behind.
pub type AnyCard = Card<Box<dyn Transport>>;
/// A job, done in the worker's thread.
type Job = Box<dyn FnOnce(&mut Owner) + Send>;

/// Rows that wait to be fetched at most, a minute and a half at 10 kHz; what comes then is lost in the card, and counted there.
const ROWS_MAX: usize = 1_000_000;
/// How long the link is listened to between two looks for jobs.
const SLICE: Duration = Duration::from_millis(20);
/// No row for so long: something is wrong.
const SILENCE: Duration = Duration::from_secs(20);
/// How often a caller who waits may look around.
const LOOK: Duration = Duration::from_millis(50);

/// What the thread has.
pub struct Owner {
    /// The card.
    pub card: AnyCard,
    /// What a measuring step is, of every channel.
    pub scales: Vec<Scale>,
    /// The recording that is under way.
    pub recording: Option<Recording>,
    /// The card has its own time: its rows come whether anybody asks for them or not.
    is_real: bool,
    /// The user has gone.
    is_over: bool,
}

/// A recording.
pub struct Recording {
    /// Where the rows come from.
    pub feed: Feed,
    /// Rows that have come and are not fetched.
    pub rows: VecDeque<Row>,
    heard: Instant,
    /// What ended it; told when all rows before it have been fetched.
    broken: Option<HostError>,
}

/// What was lost between the card and its user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Frames damaged on the link.
    pub damaged: u64,
    /// Sets that the card itself has dropped.
    pub dropped: u64,
}

impl Owner {
    /// Begins a recording, of a card that something triggers.
    pub fn begin(&mut self, polls: bool) -> Result<(), HostError> {
        if self.recording.is_some() {
            return Err(HostError::Refused(
                "a recording of this card is under way; end it first".into(),
            ));
        }
        self.card
            .needs_trigger("for example the timer: write 1 to card_config.trigger_sources.timer")?;
        self.scales = self.card.scales()?;
        self.recording = Some(Recording {
            feed: Feed::begin(&mut self.card, polls)?,
            rows: VecDeque::new(),
            heard: Instant::now(),
            broken: None,
        });
        Ok(())
    }

    /// What was lost on the way of the recording that is under way.
    pub fn losses(&mut self) -> Losses {
        let recording = self.recording.as_ref();
        Losses {
            damaged: self.card.bridge().decoder().damaged(),
            dropped: recording.map_or(0, |r| r.feed.lost_in_card()),
        }
    }

    /// Ends it: the link is as it was before.
    pub fn end(&mut self) -> Result<(), HostError> {
        match self.recording.take() {
            Some(recording) => Ok(recording.feed.end(&mut self.card)?),
            None => Ok(()),
        }
    }

    /// Listens a while. A card that does not answer may do so again.
    fn listen(&mut self) {
        let Some(now) = &mut self.recording else {
            return;
        };
        let before = now.rows.len();
        let filled = now.feed.fill(&mut self.card, &mut now.rows, SLICE);
        if now.rows.len() > before {
            now.heard = Instant::now();
        }
        now.broken = match filled {
            Err(HostError::Silent { .. }) | Ok(()) => None,
            Err(error) => Some(error),
        };
    }

    fn is_listening(&self) -> bool {
        let is_wanted = |r: &Recording| r.rows.len() < ROWS_MAX && r.broken.is_none();
        self.is_real && self.recording.as_ref().is_some_and(is_wanted)
    }

    /// Takes up to `count` rows, after listening once if there are fewer; an error when there will be no more.
    pub fn take(&mut self, count: usize) -> Result<Vec<Row>, HostError> {
        let wants = |r: &Recording| r.rows.len() < count && r.broken.is_none();
        if self.recording.as_ref().is_some_and(wants) {
            self.listen();
        }
        let Some(now) = &mut self.recording else {
            return Err(HostError::Refused("no recording is under way".into()));
        };
        let rows: Vec<Row> = now.rows.drain(..count.min(now.rows.len())).collect();
        if rows.is_empty() {
            if let Some(error) = now.broken.take() {
                return Err(error);
            }
            if now.heard.elapsed() > SILENCE {
                return Err(HostError::NoSample {
                    seconds: SILENCE.as_secs(),
                });
            }
        }
        Ok(rows)
    }

    fn work(mut self, jobs: &Receiver<Job>) {
        while !self.is_over {
            let next = match self.is_listening() {
                true => jobs.try_recv(),
                false => jobs.recv().map_err(|_| TryRecvError::Disconnected),
            };
            match next {
                Ok(job) => job(&mut self),
                Err(TryRecvError::Empty) => self.listen(),
                Err(TryRecvError::Disconnected) => break,
            }
        }
        // Nobody is left to be told.
        let _ = self.end();
    }
}

/// What does jobs in the thread.
#[derive(Clone)]
pub struct Jobs(Sender<Job>);

/// The user's end of the thread.
pub struct Handle {
    jobs: Jobs,
    thread: thread::JoinHandle<()>,
}

/// Waits for something of the thread, and meanwhile calls `look`, whose error ends the wait.
fn wait<R, E>(
    answer: &Receiver<R>,
    mut look: impl FnMut() -> Result<(), E>,
) -> Result<Option<R>, E> {
    loop {
        match answer.recv_timeout(LOOK) {
            Ok(answer) => return Ok(Some(answer)),
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) => look()?,
        }
    }
}

impl Handle {
    /// Finds a card in a thread of its own. `is_real`: its time goes on whether anybody listens or not.
    pub fn open<E>(
        find: impl FnOnce() -> Result<AnyCard, HostError> + Send + 'static,
        is_real: bool,
        look: impl FnMut() -> Result<(), E>,
    ) -> Result<Result<Self, HostError>, E> {
        let (jobs, todo) = channel::<Job>();
        let (tell, told) = channel();
        let thread = thread::spawn(move || match find() {
            Ok(card) => {
                let _ = tell.send(Ok(()));
                drop(tell);
                let owner = Owner {
                    card,
                    scales: Vec::new(),
                    recording: None,
                    is_real,
                    is_over: false,
                };
                owner.work(&todo);
            }
            Err(error) => {
                let _ = tell.send(Err(error));
            }
        });
        let opened = wait(&told, look)?.unwrap_or_else(|| Err(gone()));
        Ok(opened.map(|()| Self {
            jobs: Jobs(jobs),
            thread,
        }))
    }

    /// What does jobs in it.
    pub fn jobs(&self) -> Jobs {
        self.jobs.clone()
    }

    /// Ends the thread, with the recording that may be under way.
    pub fn close(self) {
        // Others may still have it.
        let _ = self.jobs.0.send(Box::new(|owner| owner.is_over = true));
        let _ = self.thread.join();
    }
}

impl Jobs {
    /// Does a job in the thread and waits for what comes of it.
    pub fn call<R: Send + 'static, E>(
        &self,
        job: impl FnOnce(&mut Owner) -> Result<R, HostError> + Send + 'static,
        look: impl FnMut() -> Result<(), E>,
    ) -> Result<Result<R, HostError>, E> {
        let (tell, told) = channel();
        let job: Job = Box::new(move |owner| {
            let _ = tell.send(job(owner));
        });
        let sent = self.0.send(job);
        if sent.is_err() {
            return Ok(Err(gone()));
        }
        Ok(wait(&told, look)?.unwrap_or_else(|| Err(gone())))
    }
}

fn gone() -> HostError {
    let text = "the thread of the card has ended; this is a fault of the library, please report it";
    HostError::NoCard(text.into())
}
