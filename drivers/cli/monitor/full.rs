//! The screen on a terminal: a thread looks at the card, so that keys are heard while it does not answer.

use super::look::Look;
use super::screen::{draw, Facts, Screen};
use super::{Opened, Pace};
use crate::id::plate_text;
use crate::port::{told, RangedPort};
use endat_console::error::CommandError;
use endat_terminal::colour;
use endat_terminal::outcome::Outcome;
use endat_terminal::work::interrupted;
use ratatui::crossterm::event::{self, Event, KeyEventKind};
use std::io;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{channel, Receiver, RecvTimeoutError, Sender, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

/// How long keys are waited for between two looks at what the card says.
const KEYS: Duration = Duration::from_millis(40);

/// What the thread tells.
enum News {
    /// The card answers.
    Facts(Box<Facts>),
    Look(Look),
    /// It does not now, and may do so again.
    Trouble(String),
    /// It is over.
    End(CommandError),
}

fn facts(opened: &mut Opened, port: &str) -> Result<Facts, CommandError> {
    let identity = *opened.card.identity();
    let plates = opened.card.name_plates().map_err(told)?;
    let about = format!(
        "{} channel{}, {} MHz",
        identity.channels,
        if identity.channels == 1 { "" } else { "s" },
        f64::from(identity.system_hz) / 1e6
    );
    let plate = |plate: Option<endat_host::name_plate::NamePlate>| match plate {
        Some(plate) => plate_text(&plate, identity.system_hz),
        None => String::new(),
    };
    Ok(Facts {
        port: port.to_owned(),
        about,
        scales: opened.scales.clone(),
        plates: plates.into_iter().map(plate).collect(),
    })
}

/// The thread: looks until nobody listens.
fn watch(port: &RangedPort, pace: Pace, tell: &Sender<News>) -> Result<(), CommandError> {
    let mut opened = Opened::new(port)?;
    let facts = facts(&mut opened, port.name())?;
    if tell.send(News::Facts(facts.into())).is_err() {
        return Ok(());
    }
    let mut done = 0;
    while pace.count != Some(done) {
        let begin = Instant::now();
        let news = match opened.watcher.look(&mut opened.card) {
            Ok(look) => News::Look(look),
            Err(error @ CommandError::CheckFailed(_)) => News::Trouble(error.to_string()),
            Err(error) => return Err(error),
        };
        if tell.send(news).is_err() {
            break;
        }
        done += 1;
        thread::sleep(pace.every.saturating_sub(begin.elapsed()));
    }
    Ok(())
}

/// The terminal is as it was before, however this ends.
struct Restore;

impl Drop for Restore {
    fn drop(&mut self) {
        ratatui::restore();
    }
}

/// Waits for the card before the terminal is taken: what is told until then stays on it.
fn first(
    news: &Receiver<News>,
    is_stopped: &dyn Fn() -> bool,
) -> Result<Option<Facts>, CommandError> {
    loop {
        match news.recv_timeout(KEYS) {
            Ok(News::Facts(facts)) => return Ok(Some(*facts)),
            Ok(News::End(error)) => return Err(error),
            Ok(_) => {}
            Err(RecvTimeoutError::Timeout) if is_stopped() => return Ok(None),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
        }
    }
}

/// Runs until q, Ctrl-C, the end of the looks, or of the card.
pub fn run(port: &RangedPort, pace: Pace) -> Result<Outcome, CommandError> {
    let stop = interrupted();
    let is_stopped = || stop.load(Ordering::Relaxed);
    let (tell, news) = channel();
    let watched = port.clone();
    thread::spawn(move || {
        if let Err(error) = watch(&watched, pace, &tell) {
            // Nobody is left to be told.
            let _ = tell.send(News::End(error));
        }
    });
    let Some(facts) = first(&news, &is_stopped)? else {
        return Ok(Outcome::default());
    };
    let fail = |e: io::Error| {
        CommandError::input(format!(
            "stdout: no screen can be made of it: {e}; --plain takes lines"
        ))
    };
    let mut terminal = ratatui::try_init().map_err(fail)?;
    let restore = Restore;
    let mut screen = Screen::new(facts, colour::is_wanted());
    let result = shown(&mut terminal, &mut screen, &news, &is_stopped);
    drop(restore);
    match result {
        Ok(None) => Ok(Outcome::default()),
        Ok(Some(error)) => Err(error),
        Err(error) => Err(fail(error)),
    }
}

fn shown(
    terminal: &mut ratatui::DefaultTerminal,
    screen: &mut Screen,
    news: &Receiver<News>,
    is_stopped: &dyn Fn() -> bool,
) -> io::Result<Option<CommandError>> {
    while !is_stopped() {
        loop {
            match news.try_recv() {
                Ok(News::Look(look)) => screen.look(look),
                Ok(News::Trouble(text)) => screen.trouble(text),
                Ok(News::End(error)) => return Ok(Some(error)),
                Ok(News::Facts(_)) => {}
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => return Ok(None),
            }
        }
        terminal.draw(|frame| draw(frame, screen))?;
        if !event::poll(KEYS)? {
            continue;
        }
        match event::read()? {
            Event::Key(key)
                if key.kind == KeyEventKind::Press && screen.key(key.code, key.modifiers) =>
            {
                return Ok(None);
            }
            // What has another size is drawn anew in the next round.
            _ => {}
        }
    }
    Ok(None)
}
