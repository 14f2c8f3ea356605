//! A thread that owns a card: it executes jobs in order, and receives pushed data even while its user is busy.

use crate::card::Card;
use crate::feed::{Feed, Row};
use crate::units::Scale;
use crate::{HostError, Transport};
use std::collections::VecDeque;
use std::sync::mpsc::{channel, Receiver, RecvTimeoutError, Sender, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// A card with any link.
pub type AnyCard = Card<Box<dyn Transport>>;
/// A job for the worker's thread.
type Job = Box<dyn FnOnce(&mut Owner) + Send>;

/// Most rows in the queue, a minute and a half at 10 kHz; the card drops and counts later ones.
const ROWS_MAX: usize = 1_000_000;
/// Listening time between two checks for jobs.
const SLICE: Duration = Duration::from_millis(20);
/// Timeout for a row.
const SILENCE: Duration = Duration::from_secs(20);
/// Interval at which a waiting caller is called back.
const LOOK: Duration = Duration::from_millis(50);

/// State of the thread.
pub struct Owner {
    /// The card.
    pub card: AnyCard,
    /// Measuring step of each channel.
    pub scales: Vec<Scale>,
    /// The recording that is under way.
    pub recording: Option<Recording>,
    /// The card has its own time: its rows arrive whether they are requested or not.
    is_real: bool,
    /// The user has ended.
    is_over: bool,
}

/// A recording.
pub struct Recording {
    /// Source of the rows.
    pub feed: Feed,
    /// Received rows that have not been fetched.
    pub rows: VecDeque<Row>,
    heard: Instant,
    /// Error that ended the recording; returned after all rows before it have been fetched.
    broken: Option<HostError>,
}

/// Losses between the card and its user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Frames damaged on the link.
    pub damaged: u64,
    /// Sets that the card has dropped.
    pub dropped: u64,
}

impl Owner {
    /// Begins a recording; the card must have a trigger.
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

    /// Losses of the recording under way.
    pub fn losses(&mut self) -> Losses {
        let recording = self.recording.as_ref();
        Losses {
            damaged: self.card.bridge().decoder().damaged(),
            dropped: recording.map_or(0, |r| r.feed.lost_in_card()),
        }
    }

    /// Ends the recording: restores the earlier state of the link.
    pub fn end(&mut self) -> Result<(), HostError> {
        match self.recording.take() {
            Some(recording) => Ok(recording.feed.end(&mut self.card)?),
            None => Ok(()),
        }
    }

    /// Listens for a while. A card that does not answer may answer again later.
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

    /// Returns up to `count` rows, after listening once if fewer are queued; an error if no more will come.
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
        // The user has ended: ignore the error.
        let _ = self.end();
    }
}

/// Sends jobs to the thread.
#[derive(Clone)]
pub struct Jobs(Sender<Job>);

/// The user's handle of the thread.
pub struct Handle {
    jobs: Jobs,
    thread: thread::JoinHandle<()>,
}

/// Waits for the thread, and calls `look` meanwhile; an error of `look` ends the wait.
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
    /// Finds a card in a separate thread. `is_real`: its time runs on whether the host listens or not.
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

    /// Sender of jobs for the thread.
    pub fn jobs(&self) -> Jobs {
        self.jobs.clone()
    }

    /// Ends the thread, with any recording.
    pub fn close(self) {
        // Other users may still hold it.
        let _ = self.jobs.0.send(Box::new(|owner| owner.is_over = true));
        let _ = self.thread.join();
    }
}

impl Jobs {
    /// Executes a job in the thread and waits for its result.
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
    let text = "the thread of the card has ended; this is a bug in the library, please report it";
    HostError::NoCard(text.into())
}
