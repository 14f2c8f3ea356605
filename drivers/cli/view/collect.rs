//! Takes what the card sends, and keeps what pages ask for.

use super::history::History;
use endat_driver::Reading;
use endat_host::card::Identity;
use endat_host::feed::Row;
use endat_host::name_plate::NamePlate;
use endat_host::name_plate::Told;
use endat_host::owner::{Handle, Jobs, Losses};
use endat_host::transport::LinkState;
use endat_host::units::Scale;
use endat_host::{HostError, Transport};
use endat_recording::count::{Count, Judge};
use endat_recording::keep::Entry;
use endat_recording::layout::Layout;
use endat_recording::lines::Lines;
use endat_recording::sheet::{Sheet, Text};
use endat_regs::Part;
use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

/// Rows that are taken at once.
const ROWS: usize = 8_192;
/// Between two looks at delay, recovery time and losses.
const HEALTH: Duration = Duration::from_millis(500);
/// Before a card that is gone is looked for again.
const AGAIN: Duration = Duration::from_secs(1);
/// The rate is that of so long.
const RATE_OVER_S: f64 = 0.5;

/// What an encoder without a name plate has told, or why it has not.
type Asked = Result<Told, String>;

/// A recording that a page has begun.
pub struct Recording {
    /// Where it is.
    pub path: PathBuf,
    /// Rows in it.
    pub rows: u64,
    sheet: Sheet<Lines<File>>,
}

/// What is known of the card.
pub struct State {
    /// Counts the cards that were found, one after the other: what was drawn before is not of this one.
    pub session: u64,
    /// Who it is.
    pub identity: Identity,
    /// Name plates of its encoders.
    pub plates: Vec<Option<NamePlate>>,
    /// What those that have none have told, or why they have not.
    pub others: Vec<Option<Asked>>,
    /// What a measuring step is.
    pub scales: Vec<Scale>,
    /// Rows until now.
    pub history: History,
    /// Bad rows, by channel and cause.
    pub count: Count,
    /// The last row.
    pub last: Option<Row>,
    /// Results of all channels, twice a second.
    pub results: Vec<Reading>,
    /// What was lost on the way.
    pub losses: Losses,
    /// The link.
    pub link: LinkState,
    /// What is wrong now.
    pub error: Option<String>,
    /// What became of the last recording, if it has not ended as it should.
    pub notice: Option<String>,
    /// A recording.
    pub recording: Option<Recording>,
    /// When the last rows came.
    heard: Instant,
    /// Moments, triggers and rows of a while, for the rates.
    recent: VecDeque<(f64, u64, u64)>,
}

impl State {
    fn new(
        session: u64,
        identity: Identity,
        (plates, others): (Vec<Option<NamePlate>>, Vec<Option<Asked>>),
        scales: Vec<Scale>,
    ) -> Self {
        let judge = Judge {
            own_triggers: identity.has(Part::OwnTrigger),
        };
        Self {
            session,
            history: History::new(&scales),
            count: Count::new(judge),
            last: None,
            results: Vec::new(),
            losses: Losses::default(),
            link: LinkState::default(),
            error: None,
            notice: None,
            recording: None,
            heard: Instant::now(),
            recent: VecDeque::new(),
            identity,
            plates,
            others,
            scales,
        }
    }

    /// Triggers, and rows, per second of the card's time; those of a card that is read one by one differ.
    pub fn rates_hz(&self) -> Option<[f64; 2]> {
        let (first, last) = (self.recent.front()?, self.recent.back()?);
        let span_s = last.0 - first.0;
        let counts = [last.1 - first.1, last.2 - first.2];
        (span_s > 0.0).then(|| counts.map(|count| count as f64 / span_s))
    }

    /// How long nothing has come; none while that is no longer than it may be.
    pub fn silent(&self, may_be: Duration) -> Option<Duration> {
        let slow = self.rates_hz().map_or(0.0, |[hz, _]| 3.0 / hz.max(1e-3));
        let limit = may_be.max(Duration::from_secs_f64(slow));
        Some(self.heard.elapsed()).filter(|silent| *silent > limit)
    }

    fn take(&mut self, rows: Vec<Row>) {
        let hz = f64::from(self.identity.system_hz.max(1));
        self.heard = Instant::now();
        for row in rows {
            let time_s = row.cycles as f64 / hz;
            self.history.push(time_s, &row);
            self.count.note(&row);
            let entry = Entry {
                row,
                values: Vec::new(),
            };
            self.keep(|recording| {
                recording.rows += 1;
                recording.sheet.row(&entry)
            });
            let row = entry.row;
            self.recent
                .push_back((time_s, row.trigger, self.count.rows));
            while self.recent.len() > 2 && time_s - self.recent[1].0 >= RATE_OVER_S {
                self.recent.pop_front();
            }
            self.last = Some(row);
        }
    }

    /// Does something with the recording, if there is one; where that fails it has ended.
    fn keep(&mut self, act: impl FnOnce(&mut Recording) -> io::Result<()>) {
        let Some(recording) = &mut self.recording else {
            return;
        };
        if let Err(error) = act(recording) {
            let rows = recording.rows;
            let why = failed(&recording.path, &error);
            self.notice = Some(format!("the recording has ended after {rows} rows: {why}"));
            self.recording = None;
        }
    }

    /// Begins a recording in this folder; nobody else says what it is called.
    pub fn record(&mut self, folder: &Path) -> Result<(), String> {
        if let Some(recording) = &self.recording {
            let path = recording.path.display();
            return Err(format!(
                "record = {path}: is under way; stop it before you begin another one"
            ));
        }
        let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        // Colons are no part of a name everywhere.
        let path = folder.join(format!("endat-{}.csv", now.replace(':', "-")));
        let file = fs::create_dir_all(folder).and_then(|()| File::create_new(&path));
        let sheet = file.and_then(|file| {
            let hz = f64::from(self.identity.system_hz.max(1));
            let mut layout = Layout::of(self.scales.clone());
            layout.additional_data = self.identity.stream_additional_data;
            Sheet::new(Text::Csv, Lines::file(file), layout, hz, None)
        });
        let sheet = sheet.map_err(|e| failed(&path, &e))?;
        self.notice = None;
        self.recording = Some(Recording {
            path,
            rows: 0,
            sheet,
        });
        Ok(())
    }

    /// Ends it; the file is whole.
    pub fn end_recording(&mut self) -> Result<(), String> {
        match self.recording.take() {
            None => Ok(()),
            Some(mut recording) => {
                let flushed = recording.sheet.out.flush();
                flushed.map_err(|e| failed(&recording.path, &e))
            }
        }
    }
}

fn failed(path: &Path, error: &io::Error) -> String {
    format!(
        "{}: cannot write: {error}; is the disk full, may this program write there?",
        path.display()
    )
}

/// A card and what pages share.
pub struct Shared {
    state: Mutex<State>,
    jobs: Mutex<Jobs>,
}

/// Finds the card.
pub type Find = Arc<dyn Fn() -> Result<Handle, HostError> + Send + Sync>;

/// Does a job with a card, and waits for it as long as it takes.
pub fn call<R: Send + 'static>(
    jobs: &Jobs,
    job: impl FnOnce(&mut endat_host::owner::Owner) -> Result<R, HostError> + Send + 'static,
) -> Result<R, HostError> {
    let patient = || Ok::<(), HostError>(());
    jobs.call(job, patient)?
}

/// Asks a card who it is, and begins to record.
fn begin(jobs: &Jobs, session: u64) -> Result<State, HostError> {
    call(jobs, move |owner| {
        owner.card.settle(|| ())?;
        let identity = *owner.card.identity();
        let plates = owner.card.name_plates()?;
        let channels = 0..identity.channels;
        let others = channels.map(|n| owner.card.ask_encoder(n));
        let others = others.collect::<Result<_, _>>()?;
        owner.begin(false)?;
        let told = (plates, others);
        Ok(State::new(session, identity, told, owner.scales.clone()))
    })
}

impl Shared {
    /// What is known now.
    pub fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What does jobs with the card.
    pub fn jobs(&self) -> Jobs {
        self.jobs
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Finds the card and collects in a thread until `stop`; its end is that of the thread.
    pub fn collect(
        find: Find,
        stop: Arc<AtomicBool>,
    ) -> Result<(Arc<Self>, thread::JoinHandle<()>), HostError> {
        let mut handle = find()?;
        let shared = Arc::new(Self {
            state: Mutex::new(begin(&handle.jobs(), 0)?),
            jobs: Mutex::new(handle.jobs()),
        });
        let mine = shared.clone();
        let thread = thread::spawn(move || {
            while !stop.load(Ordering::Relaxed) {
                let why = mine.session(&handle.jobs(), &stop);
                if stop.load(Ordering::Relaxed) {
                    break;
                }
                mine.state().error = why
                    .err()
                    .map(|e| format!("{e}; looking for the card again"));
                handle = match mine.again(handle, &find, &stop) {
                    Some(handle) => handle,
                    None => return,
                };
            }
            handle.close();
        });
        Ok((shared, thread))
    }

    /// Another session, with whatever card answers then; a recording goes on only with the one that it was.
    fn again(&self, old: Handle, find: &Find, stop: &AtomicBool) -> Option<Handle> {
        old.close();
        let _ = self.state().end_recording();
        loop {
            thread::sleep(AGAIN);
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let found = find().and_then(|handle| {
                let session = self.state().session + 1;
                Ok((begin(&handle.jobs(), session)?, handle))
            });
            match found {
                Ok((state, handle)) => {
                    *self.state() = state;
                    *self.jobs.lock().unwrap_or_else(PoisonError::into_inner) = handle.jobs();
                    return Some(handle);
                }
                Err(error) => self.state().error = Some(error.to_string()),
            }
        }
    }

    /// Collects until the card is another one, or `stop`.
    fn session(&self, jobs: &Jobs, stop: &AtomicBool) -> Result<(), HostError> {
        let mut looked = None;
        while !stop.load(Ordering::Relaxed) {
            match call(jobs, |owner| owner.take(ROWS)) {
                Ok(rows) if rows.is_empty() => {}
                Ok(rows) => {
                    let mut state = self.state();
                    state.error = None;
                    state.take(rows);
                }
                // It may send again.
                Err(error @ HostError::NoSample { .. }) => {
                    self.state().error = Some(error.to_string());
                    thread::sleep(AGAIN);
                }
                Err(error) => return Err(error),
            }
            if looked.is_none_or(|at: Instant| at.elapsed() > HEALTH) {
                looked = Some(Instant::now());
                self.look(jobs);
            }
        }
        Ok(())
    }

    /// Asks for what rows do not have. A card that does not answer has said so by sending nothing.
    fn look(&self, jobs: &Jobs) {
        let seen = call(jobs, |owner| {
            let losses = owner.losses();
            let link = owner.card.bridge().transport().state();
            let results = match link.is_open {
                true => owner.card.results().map(|r| r.channels).unwrap_or_default(),
                false => Vec::new(),
            };
            Ok((losses, link, results))
        });
        let Ok((losses, link, results)) = seen else {
            return;
        };
        let mut state = self.state();
        (state.losses, state.link) = (losses, link);
        if !results.is_empty() {
            state.results = results;
        }
        state.keep(|recording| recording.sheet.out.flush());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use endat_host::feed::Cell;
    use endat_regs::Protocols;

    /// Catches a recording that has stopped and looks as if it went on, or whose end is told for a moment only.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_ends_a_recording_and_is_told_until_the_next_one() {
        let identity = Identity {
            version: [1, 0, 0],
            channels: 1,
            max_position_bits: 48,
            features: 0,
            system_hz: 1_000_000,
            configuration_hash: 0,
            protocols: Protocols::ENDAT,
            stream_additional_data: false,
        };
        let scales = vec![Scale::singleturn(10)];
        let mut state = State::new(0, identity, (vec![None], vec![None]), scales.clone());
        let full = File::options().write(true).open("/dev/full").unwrap();
        let sheet =
            Sheet::new(Text::Csv, Lines::file(full), Layout::of(scales), 1e6, None).unwrap();
        state.recording = Some(Recording {
            path: "night.csv".into(),
            rows: 0,
            sheet,
        });
        let row = |trigger| Row {
            run: None,
            trigger,
            cycles: trigger * 100,
            missing: 0,
            cells: vec![Cell {
                position: Some(trigger % 1_024),
                fresh: true,
                cause: "none",
                infos: [None; 2],
            }],
        };
        // What is buffered fails when it is written: twice a second, or when it is much.
        state.take((0..10).map(row).collect());
        state.keep(|recording| recording.sheet.out.flush());
        assert!(state.recording.is_none() && state.count.rows == 10);
        state.take((10..20).map(row).collect());
        let told = state.notice.clone().unwrap();
        assert!(
            told.contains("night.csv") && told.contains("disk full"),
            "{told}"
        );
        let folder = tempfile::tempdir().unwrap();
        state.record(folder.path()).unwrap();
        assert_eq!(state.notice, None);
        state.take((20..30).map(row).collect());
        state.end_recording().unwrap();
        let file = fs::read_dir(folder.path())
            .unwrap()
            .next()
            .unwrap()
            .unwrap();
        assert_eq!(fs::read_to_string(file.path()).unwrap().lines().count(), 11);
    }
}
