//! The live page: what it is answered, whom it refuses, what becomes of it when a card goes, and how it is in a browser.

mod crowd;

use crate::hosts::{
    quick_service_port, quick_text, quicker_service_file, slow_card, Served, SERVICE,
};
use crate::program::{self, begun, Dir};
use crate::tools;
use endat_card::Door;
use endat_config::parse;
use endat_sim::rng::Rng;
use serde_json::Value;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command};
use std::thread;
use std::time::{Duration, Instant};

/// A card whose sets are made by arithmetic: for what does not look at positions.
const LOAD: &str = "load";

/// `view` in a folder of its own.
struct View {
    program: Child,
    /// `HOST:PORT` of the page.
    address: String,
    /// What it has printed.
    line: String,
    dir: Dir,
}

impl View {
    fn new(name: &str, port: &str, more: &[&str]) -> Self {
        let dir = Dir::new(name);
        let mut command = program::endat();
        let command = command.args(["view", "--port", port]).args(more);
        let (program, line) = begun(command.current_dir(&dir.0));
        let (_, url) = line.split_once("http://").expect(&line);
        // Where it listens for all, the name of the machine is for the user to know.
        let address = url.split('/').next().unwrap().replace("NAME", "127.0.0.1");
        Self {
            program,
            address,
            line,
            dir,
        }
    }

    fn local(name: &str, port: &str) -> Self {
        Self::new(name, port, &["--listen", "127.0.0.1:0"])
    }

    /// What the address that it has printed ends with.
    fn token(&self) -> &str {
        let (_, token) = self.line.split_once("?token=").expect(&self.line);
        token.split_whitespace().next().unwrap()
    }

    /// Status and body of a request with these headers.
    fn with(&self, method: &str, path: &str, headers: &str) -> (u16, String) {
        let text = format!("{method} {path} HTTP/1.1\r\n{headers}\r\n");
        let all = sent(&self.address, text.as_bytes());
        let all = String::from_utf8(all).unwrap();
        let status = all.split(' ').nth(1).and_then(|s| s.parse().ok());
        let body = all.split_once("\r\n\r\n").map_or("", |(_, body)| body);
        (status.unwrap_or(0), body.to_owned())
    }

    fn ask(&self, method: &str, path: &str) -> (u16, Value) {
        let (status, body) = self.with(method, path, &format!("Host: {}\r\n", self.address));
        let value = serde_json::from_str(&body);
        (
            status,
            value.unwrap_or_else(|e| panic!("{path}: {e}: {body}")),
        )
    }

    fn get(&self, path: &str) -> Value {
        let (status, value) = self.ask("GET", path);
        assert_eq!(status, 200, "{path}: {value}");
        value
    }

    fn now(&self) -> Value {
        self.get("/api/now")
    }

    /// Waits until this holds of `/api/now`.
    fn until(&self, what: &str, holds: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + Duration::from_secs(120);
        loop {
            let now = self.now();
            if holds(&now) {
                return now;
            }
            assert!(Instant::now() < end, "{what}: {now}");
            thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for View {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// Rows of the one recording, which is whole.
fn recorded(view: &View) -> Vec<String> {
    let mut files = fs::read_dir(view.dir.0.join("recordings")).unwrap();
    let text = fs::read_to_string(files.next().unwrap().unwrap().path()).unwrap();
    assert!(files.next().is_none() && text.ends_with('\n'), "{text}");
    assert!(text.starts_with("trigger,time_s,missing,ch0_raw,ch0_deg"));
    let rows: Vec<String> = text.lines().skip(1).map(str::to_owned).collect();
    assert!(
        rows.iter().all(|row| row.split(',').count() == 13),
        "{text}"
    );
    rows
}

/// What is answered to these bytes.
fn sent(address: &str, bytes: &[u8]) -> Vec<u8> {
    let mut stream = TcpStream::connect(address).unwrap();
    stream
        .set_read_timeout(Some(Duration::from_secs(30)))
        .unwrap();
    // It may have answered and gone before it has read all.
    let _ = stream
        .write_all(bytes)
        .and_then(|()| stream.shutdown(std::net::Shutdown::Write));
    let mut all = Vec::new();
    let _ = stream.read_to_end(&mut all);
    all
}

fn is_text(value: &Value, part: &str) -> bool {
    value["error"]
        .as_str()
        .is_some_and(|text| text.contains(part))
}

#[test]
fn a_page_has_positions_plots_registers_parameters_and_recordings() {
    let view = View::local("view-api", quick_service_port());
    let card = view.get("/api/card");
    assert_eq!(card["channels"][1]["unit"], "deg");
    assert!(card["channels"][0]["plate"]
        .as_str()
        .unwrap()
        .contains("29 bits"));
    assert!(card["causes"]["crc"][1]
        .as_str()
        .is_some_and(|helps| !helps.is_empty()));
    let now = view.until("a hundred rows", |now| now["rows"].as_u64() > Some(100));
    let one = &now["channels"][0];
    let raw = u64::from_str_radix(one["raw"].as_str().unwrap(), 16).unwrap();
    let degrees = raw as f64 * 360.0 / f64::from(1 << 29);
    assert!(
        (one["value"].as_f64().unwrap() - degrees).abs() < 1e-9,
        "{one}"
    );
    assert_eq!(
        (&now["bad"], &now["missing"], &one["fresh"]),
        (&0.into(), &0.into(), &true.into())
    );
    assert!(
        (now["rate_hz"].as_f64().unwrap() - 5_000.0).abs() < 1.0,
        "{now}"
    );
    // Both turn evenly, the second one half as fast again.
    let plot = view
        .get("/api/plot?from=0&to=0.01&buckets=10&traces=position0,velocity0,velocity1,difference");
    let of = |trace: &str, side: &str, n: usize| plot["traces"][trace][side][n].as_f64().unwrap();
    for n in 1..10 {
        assert!(of("position0", "min", n) > of("position0", "max", n - 1));
        assert!(of("position0", "min", n) < of("position0", "max", n));
        let ratio = of("velocity1", "max", n) / of("velocity0", "max", n);
        assert!((1.4..1.6).contains(&ratio), "{ratio}");
    }
    let read = view.get("/api/register?name=config0.frame.position_bits");
    assert_eq!(read["value"], 29);
    let all = view.get("/api/registers");
    let names = all
        .as_array()
        .unwrap()
        .iter()
        .map(|r| r["name"].as_str().unwrap());
    assert!(names.clone().any(|n| n == "service1.request"));
    // The search of the page looks through the fields.
    let word = |name: &str| all.as_array().unwrap().iter().find(|r| r["name"] == name);
    let fields = &word("config0.frame").unwrap()["fields"];
    assert!(
        fields
            .as_array()
            .unwrap()
            .iter()
            .any(|f| f[0] == "position_bits"),
        "{fields}"
    );
    assert!(
        !names
            .clone()
            .any(|n| n.starts_with("direct") || n.starts_with("line0")),
        "parts that the card lacks"
    );
    let (status, word) = view.ask("POST", "/api/parameter?channel=0&area=0xA1&address=13");
    assert_eq!(
        (status, &word["value"]),
        (200, &Value::from(0x801D)),
        "{word}"
    );
    for (method, path, status, text) in [
        ("GET", "/api/plot?from=x", 400, "from = x: is not a number"),
        ("GET", "/api/plot?from=2&to=1", 400, "is before"),
        ("GET", "/api/plot?buckets=1e9", 400, "outside"),
        (
            "GET",
            "/api/plot?traces=nothing",
            400,
            "there are position0",
        ),
        (
            "GET",
            "/api/register?name=result9.status",
            400,
            "result0 to result1",
        ),
        (
            "GET",
            "/api/register?name=card.stream_data",
            400,
            "takes a byte of the stream away",
        ),
        ("GET", "/api/margin.svg?channel=0", 400, "no part `margin`"),
        ("POST", "/api/parameter?channel=2", 400, "channel = 2"),
        ("POST", "/api/parameter?area=256", 400, "area = 256"),
        // What does something is not done for a picture of another page.
        (
            "GET",
            "/api/parameter?channel=0",
            405,
            "request = GET /api/parameter: is asked for with POST",
        ),
        ("GET", "/api/record", 405, "GET /api/record"),
        ("GET", "/api/nwo", 405, "did you mean /api/now?"),
        (
            "GET",
            "/api/margin.svg?channel=2",
            400,
            "channel = 2: outside 0..1",
        ),
        ("POST", "/api/inject?fault=unplug", 405, "view --rehearse"),
    ] {
        let told = view.ask(method, path);
        assert!(
            told.0 == status && is_text(&told.1, text),
            "{path}: {told:?}"
        );
    }
    let icon = view.with(
        "GET",
        "/favicon.ico",
        &format!("Host: {}\r\n", view.address),
    );
    assert!(icon.0 == 200 && icon.1.starts_with("<svg"), "{icon:?}");
    let (_, begun) = view.ask("POST", "/api/record?path=/tmp/elsewhere.csv");
    let path = view.dir.0.join(begun["path"].as_str().unwrap());
    assert!(path.starts_with(view.dir.0.join("recordings")), "{begun}");
    let second = view.ask("POST", "/api/record");
    assert!(
        second.0 == 409 && is_text(&second.1, "stop it before"),
        "{second:?}"
    );
    view.until("rows in the file", |now| {
        now["recording"]["rows"].as_u64() > Some(50)
    });
    assert_eq!(view.ask("POST", "/api/stop").1["path"], Value::Null);
    assert!(path.is_file() && recorded(&view).len() > 50);
}

/// Catches an encoder of T-format of which the page tells nothing, where `id` does.
#[test]
fn a_page_has_what_a_t_format_encoder_tells_of_itself() {
    let view = View::local("view-t-format", "virtual:mixed_protocols");
    let card = view.get("/api/card");
    let channels = card["channels"].as_array().unwrap();
    let mut of_t_format = channels.iter().filter(|c| c["protocol"] == "T-format");
    let plate = of_t_format.next().unwrap()["plate"].as_str().unwrap();
    assert!(
        plate.contains("(ENID)") && plate.contains("status, alarm     0x00, 0x00"),
        "{plate}"
    );
    let of_endat = channels.iter().find(|c| c["protocol"] == "EnDat").unwrap();
    assert_ne!(of_endat["plate"], plate);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_page_with_a_whole_recording() {
    let mut view = View::local("view-ended", LOAD);
    assert_eq!(view.ask("POST", "/api/record").0, 200);
    view.until("rows in the file", |now| {
        now["recording"]["rows"].as_u64() > Some(50)
    });
    program::signal(&view.program, "INT");
    assert_eq!(view.program.wait().unwrap().code(), Some(0));
    assert!(recorded(&view).len() > 50);
}

#[test]
fn others_are_refused_and_nonsense_ends_in_an_error() {
    nonsense_ends_in_an_error("view-refused", 300);
}

#[test]
#[ignore = "slow: requests of random bytes to the live page"]
fn much_nonsense_ends_in_an_error() {
    nonsense_ends_in_an_error("view-much", 1_500);
}

/// Requests that others make, and so many that are no requests.
fn nonsense_ends_in_an_error(test: &str, count: u32) {
    let view = View::local(test, LOAD);
    let host = format!("Host: {}\r\n", view.address);
    let ask = |path: &str, headers: &str| view.with("GET", path, headers).0;
    assert_eq!(ask("/api/now", &host), 200);
    assert_eq!(ask("/api/now", "Host: evil.example\r\n"), 403);
    assert_eq!(
        ask(
            "/api/now",
            &format!("{host}Origin: http://evil.example\r\n")
        ),
        403
    );
    let posted = format!("{host}Origin: http://evil.example\r\n");
    assert_eq!(view.with("POST", "/api/record", &posted).0, 403);
    assert_eq!(view.now()["recording"], Value::Null);
    for path in [
        "/../Cargo.toml",
        "/%2e%2e/%2e%2e/etc/passwd",
        "//etc/passwd",
        "/recordings/",
        "/view.js/..",
        "/api/../view.css/x",
    ] {
        let status = ask(path, &host);
        assert!([404, 405].contains(&status), "{path}: {status}");
    }
    let mut rng = Rng::new(7);
    let mut below = |end: usize| rng.in_range(0, end as u64 - 1) as usize;
    let good = format!("GET /api/now HTTP/1.1\r\n{host}\r\n");
    for n in 0..count {
        let mut bytes = good.clone().into_bytes();
        match n % 3 {
            // A byte that is another one, a text that ends, nothing but noise.
            0 => {
                let at = below(bytes.len());
                bytes[at] = below(256) as u8;
            }
            1 => bytes.truncate(below(bytes.len())),
            _ => bytes = (0..below(3_000)).map(|_| below(256) as u8).collect(),
        }
        let told = sent(&view.address, &bytes);
        let is_answer = told.starts_with(b"HTTP/1.1 ") || told.is_empty();
        assert!(is_answer, "{bytes:?}: {told:?}");
    }
    let long = format!("GET / HTTP/1.1\r\nX: {}", "y".repeat(20_000));
    assert!(sent(&view.address, long.as_bytes()).starts_with(b"HTTP/1.1 431 "));
    let big = format!("POST /api/record HTTP/1.1\r\n{host}Content-Length: 99999999\r\n\r\n");
    assert!(sent(&view.address, big.as_bytes()).starts_with(b"HTTP/1.1 413 "));
    assert_eq!(view.now()["recording"], Value::Null);
}

/// What listens for others needs the token that is printed; without it nothing is told.
#[test]
fn a_page_that_others_may_open_has_a_token() {
    let view = View::new("view-token", LOAD, &["--listen", "0.0.0.0:0"]);
    let token = view.token();
    assert_eq!(token.len(), 32, "{token}");
    let ask =
        |path: &str, headers: &str| view.with("GET", path, &format!("Host: card.lab\r\n{headers}"));
    for path in [
        "/",
        "/view.js",
        "/api/now",
        "/?token=0123456789abcdef0123456789abcdef",
    ] {
        assert_eq!(ask(path, "").0, 403, "{path}");
    }
    assert_eq!(ask(&format!("/?token={token}"), "").0, 303);
    assert_eq!(
        ask("/api/now", &format!("Cookie: endat-token={token}\r\n")).0,
        200
    );
    assert_eq!(
        ask("/api/now", &format!("Authorization: Bearer {token}\r\n")).0,
        200
    );
}

/// Ten pages, and many who do not go on: nobody else waits for them, and the card loses nothing.
#[test]
fn slow_clients_harm_nobody() {
    let view = View::local("view-slow", LOAD);
    let mut stalled: Vec<TcpStream> = Vec::new();
    for n in 0..40 {
        let mut stream = TcpStream::connect(&view.address).unwrap();
        let text: &[u8] = match n % 2 {
            0 => b"GET /api/now HTTP/1.1\r\nHost:",
            _ => b"",
        };
        stream.write_all(text).unwrap();
        stalled.push(stream);
    }
    thread::scope(|scope| {
        for _ in 0..10 {
            scope.spawn(|| {
                for _ in 0..10 {
                    view.now();
                    view.get("/api/plot?traces=position0,velocity1");
                }
            });
        }
    });
    // Those that did not go on have been told so; those that said nothing are told nothing.
    for (n, mut stream) in stalled.into_iter().enumerate() {
        stream
            .set_read_timeout(Some(Duration::from_secs(30)))
            .unwrap();
        let mut told = Vec::new();
        stream.read_to_end(&mut told).unwrap();
        match n % 2 {
            0 => assert!(told.starts_with(b"HTTP/1.1 408 "), "{told:?}"),
            _ => assert!(told.is_empty(), "{told:?}"),
        }
    }
    let now = view.now();
    assert_eq!(
        (&now["missing"], &now["bad"]),
        (&0.into(), &0.into()),
        "{now}"
    );
}

/// The page outlives its card: it says what is wrong, and goes on with the one that answers next.
#[test]
fn a_card_that_dies_and_comes_back_is_shown_again() {
    let card = Served::new(slow_card(), || Door::tcp("127.0.0.1:0").unwrap());
    let address = card.name.trim_start_matches("tcp:").to_owned();
    let view = View::local("view-dies", &card.name);
    view.until("rows", |now| now["rows"].as_u64() > Some(10));
    view.ask("POST", "/api/record");
    drop(card);
    view.until("a lost link", |now| {
        now["link"] == false || now["error"].is_string()
    });
    view.until("old numbers", |now| {
        now["silent_s"].as_f64() > Some(1.0) && now["rate_hz"].is_null()
    });
    let _again = Served::new(slow_card(), move || loop {
        // The system keeps the port for a moment.
        match Door::tcp(&address) {
            Ok(door) => break door,
            Err(_) => thread::sleep(Duration::from_millis(50)),
        }
    });
    let now = view.until("another session", |now| {
        now["session"] == 1 && now["rows"].as_u64() > Some(10)
    });
    assert_eq!(
        (&now["error"], &now["link"]),
        (&Value::Null, &true.into()),
        "{now}"
    );
    assert!(now["silent_s"].is_null(), "{now}");
    // A recording is of one card.
    assert_eq!(now["recording"], Value::Null);
    recorded(&view);
}

#[test]
fn what_cannot_be_served_is_told_at_once() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    for (arguments, text) in [
        (vec!["--port", "virtual", "--listen", &taken], "--listen = "),
        (
            vec!["--port", "virtual", "--listen", "nowhere"],
            "give HOST:PORT",
        ),
        (
            vec!["--port", "virtual", "--token", "short"],
            "can be guessed",
        ),
        (
            vec!["--port", "virtual", "--token", "a;b=c\r\nd-e-f-g-h"],
            "letters and digits",
        ),
        (vec!["--port", ""], "is empty"),
        (
            vec![
                "--port",
                "virtual",
                "--folder",
                "/dev/null/recordings",
                "--listen",
                "127.0.0.1:0",
            ],
            "/dev/null is no folder",
        ),
        (
            vec!["--port", "virtual:nope", "--listen", "127.0.0.1:0"],
            "unknown preset",
        ),
        (
            vec!["--port", "virtual:async_dsp", "--listen", "127.0.0.1:0"],
            "async_dsp",
        ),
    ] {
        let output = program::endat()
            .arg("view")
            .args(&arguments)
            .output()
            .unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && told.contains(text),
            "{arguments:?}: {told}"
        );
    }
}

/// In a browser that has come with the token: a live plot, what keys and the mouse do, no error.
#[test]
fn a_browser_shows_the_page_and_obeys_its_keys() {
    in_a_browser("keys");
}

/// All parts of the page, wide and narrow, light and dark; leaves its pictures for people to look at.
#[test]
#[ignore = "slow: every part of the live page in a browser"]
fn a_browser_shows_every_part_of_the_page_wide_and_narrow() {
    in_a_browser("all");
}

fn in_a_browser(what: &str) {
    let check = "the live page is opened in a browser";
    let browser = match tools::has("google-chrome") && !tools::has("chromium") {
        true => "google-chrome",
        false => "chromium",
    };
    if !tools::require_all(&[browser, "chromedriver"], check)
        || !tools::require_python("selenium", check)
    {
        return;
    }
    let dir = tools::folder(&format!("view-{what}"));
    let text = quick_text(SERVICE);
    let (before, line) = text.split_once("\n[line]").unwrap();
    let line = line.replacen("parts = []", "parts = [\"alignment\", \"margin\"]", 1);
    let project = parse("card.toml", &format!("{before}\n[line]{line}")).unwrap();
    let card = Served::new(project, || Door::tcp("127.0.0.1:0").unwrap());
    let more = ["--listen", "0.0.0.0:0", "--rehearse"];
    let view = View::new(&format!("view-browser-{what}"), &card.name, &more);
    let url = format!("http://{}/?token={}", view.address, view.token());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/view/browser.py");
    let output = Command::new("python3")
        .args([script, &url])
        .arg(&dir)
        .args([browser, what])
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(
        output.status.success(),
        "{}{}",
        text(&output.stdout),
        text(&output.stderr)
    );
}

/// Catches a page that makes faults in a card that nobody has called a virtual one, and one whose words are not looked at.
#[test]
fn only_a_page_that_rehearses_makes_faults() {
    let text = fs::read_to_string(quicker_service_file()).unwrap();
    let project = parse("service.toml", &text).unwrap();
    let card = Served::new(project, || Door::tcp("127.0.0.1:0").unwrap());
    let inject = "/api/inject?fault=crc&channel=1&value=1000000";
    let plain = View::local("view_no_rehearsal", &card.name);
    assert_eq!(plain.ask("POST", inject).0, 405);
    assert_eq!(
        plain.ask("GET", "/api/card").1["faults"],
        serde_json::json!([])
    );
    drop(plain);
    let view = View::new(
        "view_rehearsal",
        &card.name,
        &["--listen", "127.0.0.1:0", "--rehearse"],
    );
    let all = view.ask("GET", "/api/card").1["faults"].clone();
    assert!(
        all.as_array().unwrap().iter().any(|f| f[0] == "unplug"),
        "{all}"
    );
    let wrong = view.ask("POST", "/api/inject?fault=unplgu&channel=0");
    assert_eq!(wrong.0, 400);
    assert!(
        wrong.1["error"]
            .as_str()
            .unwrap()
            .contains("did you mean unplug?"),
        "{wrong:?}"
    );
    assert_eq!(view.ask("GET", inject).0, 405);
    let (status, told) = view.ask("POST", inject);
    assert_eq!(status, 200, "{told}");
    let begin = Instant::now();
    while view.ask("GET", "/api/now").1["channels"][1]["cause"] != "crc" {
        assert!(begin.elapsed() < Duration::from_secs(60), "never");
        thread::sleep(Duration::from_millis(100));
    }
    // A channel without its encoder takes no triggers, and its rows have no position. The card holds the last good one, and so does the page, as
    // `read` and `monitor` do.
    let unplug = view.ask("POST", "/api/inject?fault=unplug&channel=1");
    assert_eq!(unplug.0, 200, "{unplug:?}");
    let held = view.until("an unplugged channel", |now| {
        now["channels"][1]["cause"] == "not_taken"
    });
    let one = &held["channels"][1];
    assert!(
        one["fresh"] == false && one["raw"].is_string() && one["value"].is_number(),
        "{held}"
    );
}
