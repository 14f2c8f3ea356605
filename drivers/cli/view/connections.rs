//! Connections to the live page. One thread looks at all of them; none waits for another one, and what each may cost has an end.
//!
//! ```text
//! new -> reads its request -> is answered, by a thread of its own -> takes the answer -> leaves
//! ```

use super::http::{self, Request, Response};
use std::collections::BTreeMap;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{channel, Receiver, TryRecvError};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// A request, and its answer, have this long.
const PATIENCE: Duration = Duration::from_secs(5);
/// What a client still sends behind the end of its answer is read for so long, and so many bytes of it: the system throws an answer away
/// that is followed by what nobody has read.
const LEAVING: Duration = Duration::from_secs(1);
const LEAVING_BYTES: usize = 1 << 24;
/// Connections at once, and those of one address.
const CONNECTIONS: usize = 128;
const OF_ONE_ADDRESS: usize = 64;
/// Connections that have been answered, and still send.
const LEAVERS: usize = 256;
/// New connections that are taken in one go.
const NEW_MAX: usize = 64;
/// Between two looks.
const LOOK: Duration = Duration::from_millis(5);

/// What a connection is about.
enum Stage {
    /// Its request has not come whole.
    Reads(Vec<u8>),
    /// Somebody works out the answer.
    Waits(Receiver<Response>),
    /// It takes the answer, of which so much has gone.
    Takes(Vec<u8>, usize),
    /// It has the answer, and has sent so much behind it.
    Leaves(usize),
    Gone,
}

struct Connection {
    stream: TcpStream,
    address: IpAddr,
    stage: Stage,
    /// When the stage began.
    since: Instant,
}

/// Answers what is asked.
type Answer = Arc<dyn Fn(&Request) -> Response + Send + Sync>;

/// What the system says of a connection on which there is nothing to do now.
fn waits(error: &io::Error) -> bool {
    [ErrorKind::WouldBlock, ErrorKind::Interrupted].contains(&error.kind())
}

impl Connection {
    fn enter(&mut self, stage: Stage) {
        self.stage = stage;
        self.since = Instant::now();
    }

    fn give(&mut self, response: &Response) {
        self.enter(Stage::Takes(http::bytes(response), 0));
    }

    /// Too many are here: this one has to make room.
    fn send_away(&mut self) {
        let text = "request: too many connections at once; try again\n";
        self.give(&Response::text(503, text));
        self.step_takes();
    }

    fn is_reading(&self) -> bool {
        matches!(self.stage, Stage::Reads(_))
    }

    fn has_left(&self) -> bool {
        matches!(self.stage, Stage::Leaves(_) | Stage::Gone)
    }

    /// Does what there is to do, without waiting.
    fn step(&mut self, answer: &Answer) {
        match self.stage {
            Stage::Reads(_) => self.step_reads(answer),
            Stage::Waits(_) => self.step_waits(),
            Stage::Takes(..) => self.step_takes(),
            Stage::Leaves(_) => self.step_leaves(),
            Stage::Gone => {}
        }
    }

    fn step_reads(&mut self, answer: &Answer) {
        let Stage::Reads(bytes) = &mut self.stage else {
            return;
        };
        let mut buffer = [0; 4_096];
        loop {
            let (count, is_open) = match self.stream.read(&mut buffer) {
                Ok(count) => (count, count > 0),
                Err(e) if waits(&e) => (0, true),
                Err(_) => (0, false),
            };
            bytes.extend_from_slice(&buffer[..count]);
            match http::request(bytes) {
                Err(response) => return self.give(&response),
                Ok(Some(request)) => {
                    let (give, take) = channel();
                    let answer = answer.clone();
                    thread::spawn(move || {
                        // Where the connection has gone nobody takes it.
                        let _ = give.send(answer(&request));
                    });
                    self.enter(Stage::Waits(take));
                    return;
                }
                Ok(None) if !is_open => return self.enter(Stage::Gone),
                Ok(None) if count == 0 => break,
                Ok(None) => {}
            }
        }
        if self.since.elapsed() < PATIENCE {
            return;
        }
        // Browsers open connections in advance, and would take an answer on one for that to what they ask later.
        match bytes.is_empty() {
            true => self.enter(Stage::Gone),
            false => {
                let text = "request: has not come whole in time; send it at once";
                self.give(&Response::text(408, text));
            }
        }
    }

    fn step_waits(&mut self) {
        let Stage::Waits(take) = &self.stage else {
            return;
        };
        match take.try_recv() {
            Ok(response) => {
                self.give(&response);
                self.step_takes();
            }
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => self.enter(Stage::Gone),
        }
    }

    fn step_takes(&mut self) {
        let Stage::Takes(bytes, gone) = &mut self.stage else {
            return;
        };
        while *gone < bytes.len() {
            match self.stream.write(&bytes[*gone..]) {
                Ok(0) => return self.enter(Stage::Gone),
                Ok(count) => *gone += count,
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) if e.kind() == ErrorKind::WouldBlock => {
                    if self.since.elapsed() > PATIENCE {
                        self.enter(Stage::Gone);
                    }
                    return;
                }
                Err(_) => return self.enter(Stage::Gone),
            }
        }
        let _ = self.stream.shutdown(Shutdown::Write);
        self.enter(Stage::Leaves(0));
        self.step_leaves();
    }

    fn step_leaves(&mut self) {
        let Stage::Leaves(count) = &mut self.stage else {
            return;
        };
        let mut buffer = [0; 1 << 14];
        let is_over = loop {
            match self.stream.read(&mut buffer) {
                Ok(0) => break true,
                Ok(more) => *count += more,
                Err(e) if waits(&e) => break false,
                Err(_) => break true,
            }
            if *count > LEAVING_BYTES {
                break true;
            }
        };
        if is_over || self.since.elapsed() > LEAVING {
            self.enter(Stage::Gone);
        }
    }
}

/// All connections.
struct Connections(Vec<Connection>);

impl Connections {
    /// Makes room for one of this address; false if there is none.
    fn make_room(&mut self, address: IpAddr) -> bool {
        let mut counts: BTreeMap<IpAddr, usize> = BTreeMap::new();
        for one in self.0.iter().filter(|one| !one.has_left()) {
            *counts.entry(one.address).or_default() += 1;
        }
        let all: usize = counts.values().sum();
        let own = counts.get(&address).copied().unwrap_or(0);
        // Where all places are taken the address with the most connections gives one up.
        let from = match (own >= OF_ONE_ADDRESS, all >= CONNECTIONS) {
            (true, _) => address,
            (false, false) => return true,
            (false, true) => match counts.into_iter().max_by_key(|(_, count)| *count) {
                Some((most, _)) => most,
                None => return true,
            },
        };
        let reading = self
            .0
            .iter_mut()
            .filter(|one| one.is_reading() && one.address == from);
        match reading.min_by_key(|one| one.since) {
            Some(oldest) => {
                oldest.send_away();
                true
            }
            None => false,
        }
    }

    fn take(&mut self, stream: TcpStream, address: IpAddr) {
        // It inherits that on some systems, and not on others.
        if stream
            .set_nonblocking(true)
            .and(stream.set_nodelay(true))
            .is_err()
        {
            return;
        }
        let mut new = Connection {
            stream,
            address,
            stage: Stage::Reads(Vec::new()),
            since: Instant::now(),
        };
        if !self.make_room(address) {
            new.send_away();
        }
        self.0.push(new);
    }

    /// Those that have gone make room, and of those that are leaving there are not too many.
    fn tidy(&mut self) {
        self.0.retain(|one| !matches!(one.stage, Stage::Gone));
        let leaving = self.0.iter().filter(|one| one.has_left()).count();
        let mut surplus = leaving.saturating_sub(LEAVERS);
        self.0.retain(|one| {
            let goes = surplus > 0 && one.has_left();
            surplus -= usize::from(goes);
            !goes
        });
    }
}

/// Answers requests until `stop`.
pub fn serve(
    listener: &TcpListener,
    stop: &AtomicBool,
    answer: impl Fn(&Request) -> Response + Send + Sync + 'static,
) -> io::Result<()> {
    listener.set_nonblocking(true)?;
    let answer: Answer = Arc::new(answer);
    let mut all = Connections(Vec::new());
    while !stop.load(Ordering::Relaxed) {
        let mut is_new = false;
        for _ in 0..NEW_MAX {
            let Ok((stream, address)) = listener.accept() else {
                break;
            };
            is_new = true;
            all.take(stream, address.ip());
        }
        all.0.iter_mut().for_each(|one| one.step(&answer));
        all.tidy();
        let is_busy = all.0.iter().any(|one| matches!(one.stage, Stage::Waits(_)));
        if !is_new {
            thread::sleep(if is_busy { LOOK / 5 } else { LOOK });
        }
    }
    Ok(())
}
