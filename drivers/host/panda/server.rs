//! Connections of both ports, and the acquisition.

use super::client::{Client, PATIENCE};
use super::control::{answer, changes, State, Wish};
use super::data::Times;
use super::{data, Column};
use crate::feed::{Feed, Row};
use crate::{Card, HostError, Transport};
use std::collections::VecDeque;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::time::{Duration, Instant, SystemTime};

/// Port for commands of clients.
pub const CONTROL_PORT: u16 = 8888;
/// Port for data to clients.
pub const DATA_PORT: u16 = 8889;

/// Longest time for answering lines before rows of the card are handled.
const TURN: Duration = Duration::from_millis(20);
/// Most connections to a port. If there are more, the one that has been silent for the longest is closed.
const CONNECTIONS: usize = 256;
/// Most lines of a data client that are answered at a time; it needs one.
const FORMS: usize = 16;
/// Most unread bytes of a data client before a card that can wait does.
const BEHIND: usize = 1 << 20;
/// Time limit for sending the ends of acquisitions when the server ends.
const FAREWELL: Duration = Duration::from_secs(1);
/// Waiting time for rows in one loop of the server.
const SLICE: Duration = Duration::from_millis(10);

/// Listening ports of the server.
pub struct Ports {
    control: TcpListener,
    data: TcpListener,
}

impl Ports {
    /// Listens on both ports of an address; 0 selects a free one.
    pub fn open(host: &str, control: u16, data: u16) -> io::Result<Self> {
        let open = |port| {
            let listener = TcpListener::bind((host, port))?;
            listener.set_nonblocking(true)?;
            Ok::<_, io::Error>(listener)
        };
        Ok(Self {
            control: open(control)?,
            data: open(data)?,
        })
    }

    /// Addresses of control and data.
    pub fn addresses(&self) -> io::Result<[SocketAddr; 2]> {
        Ok([self.control.local_addr()?, self.data.local_addr()?])
    }
}

struct DataClient {
    client: Client,
    form: Option<data::Form>,
    /// The client has the header of the acquisition under way.
    is_recording: bool,
}

impl DataClient {
    /// Processes the requested format.
    fn answer(&mut self, line: &str) {
        let answer = match data::form(line) {
            Ok(form) => {
                self.form = Some(form);
                "OK\n".to_owned()
            }
            Err(text) => text + "\n",
        };
        self.client.send(answer.as_bytes());
    }
}

struct Acquisition {
    feed: Feed,
    rows: u64,
    times: Times,
}

/// A card with the two ports.
pub struct Server<'c, T> {
    card: &'c mut Card<T>,
    columns: Vec<Column>,
    ports: Ports,
    controls: Vec<Client>,
    /// Client whose line was answered last.
    turn: usize,
    datas: Vec<DataClient>,
    patience: Duration,
    /// The card waits for slow clients.
    waits: bool,
    acquisition: Option<Acquisition>,
    /// An acquisition ends automatically after this many rows.
    limit: Option<u64>,
    latest: Option<Vec<i64>>,
    completion: &'static str,
    captured: u64,
}

impl<'c, T: Transport> Server<'c, T> {
    /// Serves a card; each acquisition ends after `limit` rows, or when it is disarmed.
    pub fn new(
        card: &'c mut Card<T>,
        columns: Vec<Column>,
        ports: Ports,
        limit: Option<u64>,
    ) -> Self {
        Self {
            card,
            columns,
            ports,
            controls: Vec::new(),
            turn: 0,
            patience: PATIENCE,
            waits: false,
            datas: Vec::new(),
            acquisition: None,
            limit,
            latest: None,
            completion: "Ok",
            captured: 0,
        }
    }

    /// Sets the time after which a client with a waiting byte is dropped [5 s].
    pub fn set_patience(&mut self, patience: Duration) {
        self.patience = patience;
    }

    /// The card's time advances only when it is polled, so it waits for slow clients, and no row is lost.
    pub fn set_waits(&mut self) {
        self.waits = true;
    }

    /// Serves until `stop` returns true.
    pub fn run(&mut self, mut stop: impl FnMut() -> bool) -> Result<(), HostError> {
        while !stop() {
            let began = Instant::now();
            self.listen();
            self.answer_controls()?;
            self.answer_datas();
            match self.acquisition {
                Some(_) if !self.is_behind() => self.pump()?,
                Some(_) => std::thread::sleep(SLICE / 10),
                None => std::thread::sleep(SLICE.saturating_sub(began.elapsed())),
            }
        }
        self.end("Disarmed")?;
        let end = Instant::now() + FAREWELL;
        while self.datas.iter().any(|d| d.client.waiting() > 0) && Instant::now() < end {
            self.answer_datas();
            self.datas.retain(|d| !d.client.is_gone());
            std::thread::sleep(SLICE / 10);
        }
        Ok(())
    }

    fn listen(&mut self) {
        self.controls.retain(|c| !c.is_gone() && !c.is_served());
        // A client that has left reads as one that sends nothing more, and has no data to receive.
        (self.datas).retain(|d| !d.client.is_gone() && !d.client.has_ended());
        while let Ok((stream, _)) = self.ports.control.accept() {
            if self.controls.len() >= CONNECTIONS {
                let heard = self.controls.iter().map(Client::heard).enumerate();
                if let Some((place, _)) = heard.min_by_key(|(_, heard)| *heard) {
                    self.controls.swap_remove(place);
                }
            }
            (self.controls).extend(Client::new(stream, self.patience).ok());
        }
        while let Ok((stream, _)) = self.ports.data.accept() {
            if self.datas.len() >= CONNECTIONS {
                let heard = self.datas.iter().enumerate();
                // A recording client may be silent for hours.
                let heard = heard.map(|(n, d)| (n, (d.is_recording, d.client.heard())));
                if let Some((place, _)) = heard.min_by_key(|(_, order)| *order) {
                    self.datas.swap_remove(place);
                }
            }
            let client = Client::new(stream, self.patience).ok();
            self.datas.extend(client.map(|client| DataClient {
                client,
                form: None,
                is_recording: false,
            }));
        }
    }

    /// Answers a line of each client in turn, until no lines are left or the time is over; the rest follow next time.
    fn answer_controls(&mut self) -> Result<(), HostError> {
        let end = Instant::now() + TURN;
        self.controls.iter_mut().for_each(Client::read);
        let count = self.controls.len();
        let mut without = 0;
        while without < count && Instant::now() < end {
            self.turn = (self.turn + 1) % count;
            match self.controls[self.turn].line() {
                None => without += 1,
                Some(line) => {
                    without = 0;
                    if self.answer(self.turn, &line)? {
                        break;
                    }
                }
            }
        }
        self.controls.iter_mut().for_each(Client::flush);
        Ok(())
    }

    /// Answers a line; returns true if this accessed the card, which takes time.
    fn answer(&mut self, index: usize, line: &str) -> Result<bool, HostError> {
        let card = format!("{:08x}", self.card.identity().configuration_hash);
        let state = State {
            software: env!("CARGO_PKG_VERSION"),
            card: &card,
            columns: &self.columns,
            latest: self.latest.as_deref(),
            is_armed: self.acquisition.is_some(),
            completion: self.completion,
            captured: self.captured,
        };
        let news = changes(line, &state, &mut self.controls[index].seen);
        let (text, wish) = match news {
            Some(text) => (text, None),
            None => answer(line, &state),
        };
        let text = match wish {
            Some(Wish::Arm) if self.acquisition.is_some() => {
                "ERR Readout still taking place\n".into()
            }
            Some(Wish::Arm) => {
                self.arm()?;
                text
            }
            Some(Wish::Disarm) => {
                self.end("Disarmed")?;
                text
            }
            None => text,
        };
        self.controls[index].send(text.as_bytes());
        Ok(wish.is_some())
    }

    fn answer_datas(&mut self) {
        for each in &mut self.datas {
            each.client.read();
            for _ in 0..FORMS {
                let Some(line) = each.client.line() else {
                    break;
                };
                each.answer(&line);
            }
        }
        // A late client gets the remaining rows.
        let times = self.acquisition.as_ref().map(|a| a.times);
        if let Some(times) = times.filter(|times| times.start.is_some()) {
            self.send_headers(times);
        }
        self.datas.iter_mut().for_each(|d| d.client.flush());
    }

    /// True if the card waits for a client.
    fn is_behind(&self) -> bool {
        let mut recording = self.datas.iter().filter(|d| d.is_recording);
        self.waits && recording.any(|d| !d.client.is_gone() && d.client.waiting() > BEHIND)
    }

    /// Begins the acquisition for clients that have requested data and do not have its header.
    fn send_headers(&mut self, times: Times) {
        for each in self.datas.iter_mut().filter(|d| !d.is_recording) {
            if let Some(form) = each.form {
                let header = data::header(form, &self.columns, times);
                each.client.send(header.as_bytes());
                each.is_recording = true;
            }
        }
    }

    fn arm(&mut self) -> Result<(), HostError> {
        let feed = Feed::begin(self.card, false)?;
        let times = Times {
            arm: SystemTime::now(),
            start: None,
        };
        self.acquisition = Some(Acquisition {
            feed,
            rows: 0,
            times,
        });
        self.captured = 0;
        // Every connected client gets every row.
        self.answer_datas();
        Ok(())
    }

    fn pump(&mut self) -> Result<(), HostError> {
        let Some(acquisition) = &mut self.acquisition else {
            return Ok(());
        };
        let mut queue = VecDeque::new();
        // Read everything received so far, not only the first piece: otherwise a fast card falls behind when clients send many queries.
        let end = Instant::now() + TURN;
        let (mut wait, mut before) = (SLICE, 0);
        loop {
            acquisition.feed.fill(self.card, &mut queue, wait)?;
            if queue.len() == before || Instant::now() >= end {
                break;
            }
            (wait, before) = (Duration::ZERO, queue.len());
        }
        // A row of PandABlocks belongs to a trigger.
        let mut rows: Vec<Row> = queue.into_iter().filter(|r| r.run.is_none()).collect();
        // Rows after a gap do not belong to this acquisition.
        let gap = rows
            .iter()
            .position(|r| acquisition.feed.streams() && r.missing > 0);
        rows.truncate(gap.unwrap_or(rows.len()));
        let left = self.limit.map(|limit| limit - acquisition.rows);
        if let Some(left) = left {
            rows.truncate(left.min(rows.len() as u64) as usize);
        }
        acquisition.rows += rows.len() as u64;
        self.captured = acquisition.rows;
        let is_over = self.limit == Some(acquisition.rows);
        if let Some(last) = rows.last() {
            acquisition.times.start.get_or_insert_with(SystemTime::now);
            let times = acquisition.times;
            self.send_headers(times);
            self.latest = Some(self.columns.iter().map(|c| c.raw(last)).collect());
            for each in self.datas.iter_mut().filter(|d| d.is_recording) {
                if let Some(form) = each.form {
                    each.client.send(&data::rows(form, &self.columns, &rows));
                }
            }
        }
        match (is_over, gap) {
            (true, _) => self.end("Ok"),
            (_, Some(_)) => self.end("Data overrun"),
            _ => Ok(()),
        }
    }

    fn end(&mut self, reason: &'static str) -> Result<(), HostError> {
        let Some(acquisition) = self.acquisition.take() else {
            return Ok(());
        };
        self.completion = reason;
        // Every end needs a begin, even without a row.
        self.send_headers(acquisition.times);
        for each in self.datas.iter_mut().filter(|d| d.is_recording) {
            each.client
                .send(data::end(acquisition.rows, reason).as_bytes());
            each.is_recording = false;
        }
        acquisition.feed.end(self.card)
    }
}
