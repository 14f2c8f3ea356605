//! What a page asks, and what it is answered.

use super::collect::{call, Shared};
use super::guard::Guard;
use super::history::names;
use super::http::{Request, Response};
#[cfg(feature = "virtual")]
use crate::inject;
use crate::reg;
use crate::simulated::FAULTS;
use crate::{id, margin};
use endat_console::did_you_mean;
use endat_console::error::{shown, CommandError};
use endat_console::number;
use endat_draw::edges_svg;
use endat_host::feed::NO_CAUSES;
use endat_host::range;
use endat_host::registers::Place;
use endat_host::{causes, HostError};
use serde_json::{json, Value};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The page.
const FILES: [(&str, &str, &str); 4] = [
    (
        "/",
        "text/html; charset=utf-8",
        include_str!("page/index.html"),
    ),
    (
        "/view.js",
        "text/javascript; charset=utf-8",
        include_str!("page/view.js"),
    ),
    (
        "/view.css",
        "text/css; charset=utf-8",
        include_str!("page/view.css"),
    ),
    // Browsers ask for it whether a page names one or not, and complain where there is none.
    (
        "/favicon.ico",
        "image/svg+xml",
        include_str!("page/icon.svg"),
    ),
];

/// What can be asked for.
#[derive(Clone, Copy)]
enum Call {
    Card,
    Now,
    Plot,
    Registers,
    Register,
    Margin,
    Parameter,
    Record,
    Stop,
    Inject,
}

/// Makes a fault.
const INJECT: &str = "/api/inject";

/// What does something is a POST: no link and no picture of another page can ask for it.
const CALLS: [(&str, &str, Call); 10] = [
    ("GET", "/api/card", Call::Card),
    ("GET", "/api/now", Call::Now),
    ("GET", "/api/plot", Call::Plot),
    ("GET", "/api/registers", Call::Registers),
    ("GET", "/api/register", Call::Register),
    ("GET", "/api/margin.svg", Call::Margin),
    ("POST", "/api/parameter", Call::Parameter),
    ("POST", "/api/record", Call::Record),
    ("POST", "/api/stop", Call::Stop),
    ("POST", INJECT, Call::Inject),
];
/// Buckets of a plot.
const BUCKETS_MAX: f64 = 4_000.0;
/// Unless a page asks for another number.
const BUCKETS: f64 = 800.0;
/// No card runs for so long.
const SECONDS_MAX: f64 = 1e9;

/// A read of this register takes a byte of the stream away, which is a row of the page.
const TAKES_AWAY: &str = "stream_data";

/// Answers requests.
pub struct Api {
    /// The card.
    pub shared: Arc<Shared>,
    /// Who may ask.
    pub guard: Guard,
    /// Where recordings go.
    pub folder: PathBuf,
    /// The card as the user named it.
    pub port: String,
    /// How long nothing may come before what is shown is old.
    pub may_be_silent: Duration,
    /// The card is a virtual one, and the page may make faults in it.
    pub rehearses: bool,
}

/// An error that a page shows.
struct Refusal(u16, String);

impl From<HostError> for Refusal {
    fn from(error: HostError) -> Self {
        let status = match error {
            HostError::Name(_) | HostError::Part { .. } => 400,
            _ => 502,
        };
        Self(status, error.to_string())
    }
}

impl From<CommandError> for Refusal {
    fn from(error: CommandError) -> Self {
        Self(400, error.messages().join("\n"))
    }
}

fn bad(text: impl Into<String>) -> Refusal {
    Refusal(400, text.into())
}

/// A number of the query; the default if it is not there.
fn decimal(request: &Request, name: &str, usual: f64, range: [f64; 2]) -> Result<f64, Refusal> {
    let [low, high] = range;
    match request.query.get(name) {
        None => Ok(usual),
        Some(text) => Ok(number::decimal(name, text, low..=high)?),
    }
}

/// A whole number within bounds, decimal or as `0xA1`.
fn whole(request: &Request, name: &str, most: u64) -> Result<u64, Refusal> {
    let text = request.query.get(name).map(String::as_str).unwrap_or("0");
    Ok(number::number(name, text, 0..=most)?)
}

/// An answer as JSON.
fn told(result: Result<Value, Refusal>) -> Response {
    let (status, value) = match result {
        Ok(value) => (200, value),
        Err(Refusal(status, text)) => (status, json!({ "error": text })),
    };
    Response::new(status, "application/json", value.to_string())
}

impl Api {
    /// The answer to a request.
    pub fn answer(&self, request: &Request) -> Response {
        if let Some(refused) = self.guard.refuses(request) {
            return refused;
        }
        let file = FILES.iter().find(|(path, ..)| *path == request.path);
        if let (Some((_, kind, text)), "GET") = (file, request.method.as_str()) {
            return Response::new(200, kind, *text);
        }
        let Some(call) = self.call(request) else {
            return match request.path.starts_with("/api/") {
                true => told(Err(self.no_call(request))),
                false => Response::text(
                    404,
                    format!(
                        "path = {}: there is nothing here; the page is at /\n",
                        shown(&request.path)
                    ),
                ),
            };
        };
        told(match call {
            Call::Card => Ok(self.card()),
            Call::Now => Ok(self.now()),
            Call::Plot => self.plot(request),
            Call::Registers => self.registers(),
            Call::Register => self.register(request),
            Call::Margin => match self.margin(request) {
                Ok(svg) => return Response::new(200, "image/svg+xml", svg),
                Err(refusal) => Err(refusal),
            },
            Call::Parameter => self.parameter(request),
            Call::Record => self.record(true),
            Call::Stop => self.record(false),
            Call::Inject => self.inject(request),
        })
    }

    /// What this server does for pages: faults only where the card is known to be a virtual one.
    fn calls(&self) -> impl Iterator<Item = &'static (&'static str, &'static str, Call)> + '_ {
        CALLS
            .iter()
            .filter(|(.., call)| self.rehearses || !matches!(call, Call::Inject))
    }

    fn call(&self, request: &Request) -> Option<Call> {
        let asked = (request.method.as_str(), request.path.as_str());
        let mut calls = self.calls();
        let found = calls.find(|(method, path, _)| (*method, *path) == asked);
        found.map(|(.., call)| *call)
    }

    /// Why a request is none of the calls.
    fn no_call(&self, request: &Request) -> Refusal {
        let path = request.path.as_str();
        let mut calls = self.calls();
        let remedy = match calls.find(|(_, known, _)| *known == path) {
            Some((method, ..)) => format!("is asked for with {method}"),
            None => {
                let paths: Vec<&str> = self.calls().map(|(_, path, _)| *path).collect();
                let why = match path == INJECT && !self.rehearses {
                    true => "faults are made with `view --rehearse` only".into(),
                    false => did_you_mean::guess(path, paths.iter().copied())
                        .unwrap_or_else(|| format!("there are {}", paths.join(", "))),
                };
                format!("is nothing that this server does; {why}")
            }
        };
        Refusal(
            405,
            format!("request = {} {}: {remedy}", request.method, shown(path)),
        )
    }

    fn card(&self) -> Value {
        let state = self.shared.state();
        let identity = &state.identity;
        let channels = state.scales.iter().enumerate().map(|(n, scale)| {
            let plate = state.plates[n].as_ref();
            let text = match (plate, state.others[n].as_ref()) {
                (Some(plate), _) => Some(id::plate_text(plate, identity.system_hz)),
                (None, told) => told.map(|told| id::other_text(identity.protocol(n), told)),
            };
            json!({
                "protocol": identity.protocol(n).name(),
                "unit": scale.convert(0).unit,
                "digits": scale.digits(),
                "wraps_at": scale.wraps_at(),
                "unknown": (!scale.is_known()).then(|| range::refusal(n)),
                "plate": text,
                "serial": plate.and_then(|p| p.serial.clone()),
            })
        });
        let traces = state.history.traces().iter();
        let traces =
            traces.map(|t| json!({"name": t.name, "unit": t.unit, "wraps_at": t.wraps_at}));
        let all = causes::ALL.iter().map(|c| c.name);
        let all = all.filter_map(|name| Some((name.to_owned(), json!(causes::advice(name)?))));
        let others = NO_CAUSES
            .iter()
            .map(|(name, means)| ((*name).to_owned(), json!([means, ""])));
        json!({
            "session": state.session,
            "port": self.port,
            "map": identity.version.map(|n| n.to_string()).join("."),
            "hash": format!("{:08x}", identity.configuration_hash),
            "system_hz": identity.system_hz,
            "parts": identity.parts().map(|p| p.named().name).collect::<Vec<_>>(),
            "channels": channels.collect::<Vec<_>>(),
            "traces": traces.collect::<Vec<_>>(),
            "causes": all.chain(others).collect::<serde_json::Map<_, _>>(),
            "folder": self.folder.display().to_string(),
            "faults": if self.rehearses { &FAULTS[..] } else { &[] },
        })
    }

    fn now(&self) -> Value {
        let state = self.shared.state();
        let system_hz = f64::from(state.identity.system_hz.max(1));
        let channels = state.scales.iter().enumerate().map(|(n, scale)| {
            let cell = state.last.as_ref().and_then(|row| row.cells.get(n));
            let result = state.results.get(n);
            // A row without a position says why; the card still holds the last good one.
            let held = result.filter(|r| r.valid).map(|r| r.position);
            let position = cell.and_then(|c| c.position.or(held));
            let units = position.map(|p| scale.convert(p));
            let ns = |cycles: u16| f64::from(cycles) * 1e9 / system_hz;
            let counts = state.count.causes().filter(|(channel, ..)| *channel == n);
            let counts = counts.map(|(_, cause, count)| (cause.to_owned(), json!(count)));
            json!({
                "value": units.map(|u| u.value),
                "continuous": state.history.position(n),
                "turns": units.and_then(|u| u.turns),
                "raw": position.map(|p| format!("{p:X}")),
                "fresh": cell.is_some_and(|c| c.fresh),
                "cause": cell.map(|c| c.cause),
                "age_us": result.map(|r| r.age_us),
                "delay_ns": result.map(|r| ns(r.delay_cycles)),
                "recovery_us": result.map(|r| ns(r.recovery_cycles) / 1e3),
                "counts": counts.collect::<serde_json::Map<_, _>>(),
            })
        });
        let recording = state.recording.as_ref();
        let silent = state.silent(self.may_be_silent);
        let rates_hz = state.rates_hz().filter(|_| silent.is_none());
        json!({
            "session": state.session,
            "span_s": state.history.span_s().map(|(from, to)| [from, to]),
            "rows": state.count.rows,
            "bad": state.count.bad,
            "missing": state.count.missing,
            "dropped": state.losses.dropped,
            "damaged": state.losses.damaged,
            "rate_hz": rates_hz.map(|[triggers, _]| triggers),
            "rows_hz": rates_hz.map(|[_, rows]| rows),
            "silent_s": silent.map(|s| s.as_secs_f64()),
            "link": state.link.is_open,
            "error": state.error,
            "notice": state.notice,
            "recording": recording.map(|r| json!({"path": r.path.display().to_string(), "rows": r.rows})),
            "channels": channels.collect::<Vec<_>>(),
        })
    }

    fn plot(&self, request: &Request) -> Result<Value, Refusal> {
        let state = self.shared.state();
        let (first, last) = state.history.span_s().unwrap_or((0.0, 0.0));
        let time = |name, usual| decimal(request, name, usual, [-SECONDS_MAX, SECONDS_MAX]);
        let (from, to) = (time("from", first)?, time("to", last)?);
        let buckets = decimal(request, "buckets", BUCKETS, [1.0, BUCKETS_MAX])?;
        if to < from {
            return Err(bad(format!(
                "to = {to}: is before from = {from}; give a later time"
            )));
        }
        // A moment has no length.
        let to = to.max(from + 1e-9);
        let plot = state.history.plot(from, to, buckets as usize);
        let wanted = request
            .query
            .get("traces")
            .map(String::as_str)
            .unwrap_or("");
        let mut traces = serde_json::Map::new();
        for name in wanted.split(',').filter(|name| !name.is_empty()) {
            let Some(n) = state.history.traces().iter().position(|t| t.name == name) else {
                let known: Vec<&str> = (state.history.traces().iter())
                    .map(|t| t.name.as_str())
                    .collect();
                return Err(bad(format!(
                    "traces = {}: there is none of that name; there are {}",
                    shown(name),
                    known.join(", ")
                )));
            };
            let side = |which: usize| {
                plot.extremes[n]
                    .iter()
                    .map(|e| e[which])
                    .collect::<Vec<f64>>()
            };
            traces.insert(name.into(), json!({"min": side(0), "max": side(1)}));
        }
        // Few buckets have a cause.
        let causes = plot.causes.iter().map(|channel| {
            let set = channel.iter().enumerate().filter(|(_, bits)| **bits != 0);
            set.map(|(n, bits)| json!([n, names(*bits)]))
                .collect::<Vec<_>>()
        });
        Ok(json!({
            "session": state.session,
            "from": plot.from_s,
            "to": plot.to_s,
            "buckets": buckets as usize,
            "traces": traces,
            "causes": causes.collect::<Vec<_>>(),
        }))
    }

    fn registers(&self) -> Result<Value, Refusal> {
        let places = call(&self.shared.jobs(), |owner| {
            let card = &owner.card;
            let all = Place::words(card.identity().channels);
            let there = all.filter(|place| card.place(&place.to_string()).is_ok());
            Ok(there.collect::<Vec<_>>())
        })?;
        let all = places.iter().map(|place| {
            json!({
                "name": place.to_string(),
                "access": place.register.access.short(),
                "meaning": place.register.meaning,
                "fields": place.register.fields.iter().map(|f| [f.name, f.meaning]).collect::<Vec<_>>(),
            })
        });
        Ok(all.collect())
    }

    fn register(&self, request: &Request) -> Result<Value, Refusal> {
        let name = request.query.get("name").cloned().unwrap_or_default();
        let told = call(&self.shared.jobs(), move |owner| {
            let place = owner.card.place(&name)?;
            if place.register.name == TAKES_AWAY {
                return Err(HostError::Name(format!(
                    "name = {place}: a read takes a byte of the stream away, which is a row of this page; `endat reg read` reads it when the page has ended"
                )));
            }
            reg::as_json(&mut owner.card, &place)
        });
        Ok(told?)
    }

    /// A channel that the card has.
    fn channel(&self, request: &Request) -> Result<usize, Refusal> {
        let channels = self.shared.state().identity.channels as u64;
        whole(request, "channel", channels - 1).map(|n| n as usize)
    }

    /// The drawing of `margin --svg`.
    fn margin(&self, request: &Request) -> Result<String, Refusal> {
        let channel = self.channel(request)?;
        let told = call(&self.shared.jobs(), move |owner| {
            margin::needs("channel", &owner.card, channel)?;
            margin::edges(&mut owner.card, channel)
        });
        Ok(edges_svg(
            &told?,
            &format!("Edges of DATA, channel {channel}"),
        ))
    }

    fn parameter(&self, request: &Request) -> Result<Value, Refusal> {
        let channel = self.channel(request)?;
        let (area, address) = (
            whole(request, "area", 0xFF)? as u8,
            whole(request, "address", 0xFF)? as u8,
        );
        let told = call(&self.shared.jobs(), move |owner| {
            owner.card.read_parameter(channel, area, address)
        });
        Ok(json!({ "value": told?.data }))
    }

    fn record(&self, on: bool) -> Result<Value, Refusal> {
        let mut state = self.shared.state();
        let done = match on {
            true => state.record(&self.folder),
            false => state.end_recording(),
        };
        done.map_err(|text| Refusal(409, text))?;
        let path = state
            .recording
            .as_ref()
            .map(|r| r.path.display().to_string());
        Ok(json!({ "path": path }))
    }

    /// A fault of the virtual card.
    #[cfg(not(feature = "virtual"))]
    fn inject(&self, _: &Request) -> Result<Value, Refusal> {
        Err(CommandError::input("inject: this program is built without virtual cards, which faults are made in; build it with the feature virtual").into())
    }

    #[cfg(feature = "virtual")]
    fn inject(&self, request: &Request) -> Result<Value, Refusal> {
        let of = |name: &str| request.query.get(name).map_or("", |text| text.trim());
        let words = [of("fault"), of("channel"), of("value")];
        let words: Vec<&str> = words.into_iter().filter(|w| !w.is_empty()).collect();
        Ok(json!({ "done": inject::make(&self.port, &words)? }))
    }
}
