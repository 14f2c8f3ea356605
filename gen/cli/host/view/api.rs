//! What a page asks, and what it is answered.

use super::super::reg;
use super::super::{id::plate_text, inject, margin};
use super::collect::{call, Shared};
use super::guard::Guard;
use super::history::names;
use super::http::{Request, Response};
use crate::error::GenError;
use crate::virtual_card::FAULTS;
use endat_host::feed::NO_CAUSES;
use endat_host::registers::Place;
use endat_host::{causes, HostError};
use endat_sim::diagram::edges_svg;
use serde_json::{json, Value};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// The page.
const FILES: [(&str, &str, &str); 3] = [
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
];
/// Buckets of a plot.
const BUCKETS_MAX: f64 = 4_000.0;
/// Unless a page asks for another number.
const BUCKETS: f64 = 800.0;

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

impl From<GenError> for Refusal {
    fn from(error: GenError) -> Self {
        Self(400, error.messages().join("\n"))
    }
}

fn bad(text: impl Into<String>) -> Refusal {
    Refusal(400, text.into())
}

/// A number of the query; the default if it is not there.
fn number(request: &Request, name: &str, default: Option<f64>) -> Result<f64, Refusal> {
    match (request.query.get(name), default) {
        (None, Some(default)) => Ok(default),
        (None, None) => Err(bad(format!("{name}: is missing; give a number"))),
        (Some(text), _) => {
            let number = text.parse().ok().filter(|n: &f64| n.is_finite());
            number.ok_or_else(|| bad(format!("{name} = {text:?}: is no number")))
        }
    }
}

/// A whole number within bounds, decimal or as `0xA1`.
fn whole(request: &Request, name: &str, most: u64) -> Result<u64, Refusal> {
    let text = request.query.get(name).map(String::as_str).unwrap_or("0");
    Ok(crate::number::number(name, text, 0..=most)?)
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
        let told = match (request.method.as_str(), request.path.as_str()) {
            ("GET", "/api/card") => Ok(self.card()),
            ("GET", "/api/now") => Ok(self.now()),
            ("GET", "/api/plot") => self.plot(request),
            ("GET", "/api/registers") => self.registers(),
            ("GET", "/api/register") => self.register(request),
            ("GET", "/api/margin.svg") => match self.margin(request) {
                Ok(svg) => return Response::new(200, "image/svg+xml", svg),
                Err(refusal) => Err(refusal),
            },
            // These do something: no link and no picture of another page can ask for them.
            ("POST", "/api/parameter") => self.parameter(request),
            ("POST", "/api/record") => self.record(true),
            ("POST", "/api/stop") => self.record(false),
            ("POST", "/api/inject") if self.rehearses => self.inject(request),
            (_, path) if path.starts_with("/api/") => Err(Refusal(
                405,
                format!(
                    "{} {path}: is nothing that this server does",
                    request.method
                ),
            )),
            _ => return Response::text(404, "there is nothing here\n"),
        };
        let (status, value) = match told {
            Ok(value) => (200, value),
            Err(Refusal(status, text)) => (status, json!({ "error": text })),
        };
        Response::new(status, "application/json", value.to_string())
    }

    fn card(&self) -> Value {
        let state = self.shared.state();
        let identity = &state.identity;
        let channels = state.scales.iter().enumerate().map(|(n, scale)| {
            let plate = state.plates[n].as_ref();
            json!({
                "protocol": if identity.is_t_format(n) { "T-format" } else { "EnDat" },
                "unit": scale.convert(0).unit,
                "digits": scale.digits(),
                "wraps_at": scale.wraps_at(),
                "plate": plate.map(|p| plate_text(p, identity.system_hz)),
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
            let units = cell.and_then(|c| c.position).map(|p| scale.convert(p));
            let result = state.results.get(n);
            let ns = |cycles: u16| f64::from(cycles) * 1e9 / system_hz;
            let counts = state.count.causes().filter(|(channel, ..)| *channel == n);
            let counts = counts.map(|(_, cause, count)| (cause.to_owned(), json!(count)));
            json!({
                "value": units.map(|u| u.value),
                "continuous": state.history.position(n),
                "turns": units.and_then(|u| u.turns),
                "raw": cell.and_then(|c| c.position).map(|p| format!("{p:X}")),
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
        let from = number(request, "from", Some(first))?;
        let to = number(request, "to", Some(last))?;
        let buckets = number(request, "buckets", Some(BUCKETS))?;
        if !(1.0..=BUCKETS_MAX).contains(&buckets) {
            return Err(bad(format!(
                "buckets = {buckets}: outside 1..{BUCKETS_MAX}"
            )));
        }
        if to < from {
            return Err(bad(format!("to = {to}: is before from = {from}")));
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
                return Err(bad(format!(
                    "traces = {name:?}: there is none of that name"
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
                    "{place}: reading it takes something away; it is not read here"
                )));
            }
            reg::as_json(&mut owner.card, &place)
        });
        Ok(told?)
    }

    /// The drawing of `margin --svg`.
    fn margin(&self, request: &Request) -> Result<String, Refusal> {
        let channel = whole(request, "channel", 7)? as usize;
        let told = call(&self.shared.jobs(), move |owner| {
            margin::needs(&owner.card, channel)?;
            margin::edges(&mut owner.card, channel)
        });
        Ok(edges_svg(
            &told?,
            &format!("Edges of DATA, channel {channel}"),
        ))
    }

    fn parameter(&self, request: &Request) -> Result<Value, Refusal> {
        let channels = self.shared.state().identity.channels as u64;
        let channel = whole(request, "channel", channels - 1)? as usize;
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
    fn inject(&self, request: &Request) -> Result<Value, Refusal> {
        let of = |name: &str| request.query.get(name).map_or("", |text| text.trim());
        let words = [of("fault"), of("channel"), of("value")];
        let words: Vec<&str> = words.into_iter().filter(|w| !w.is_empty()).collect();
        Ok(json!({ "done": inject::make(&self.port, &words)? }))
    }
}
