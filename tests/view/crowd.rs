//! The live page beside connections that say nothing, that say too much, and that say two things.

use super::{sent, View, LOAD};
use std::io::Read;
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

/// Connections from one address that the page has at once.
const OF_ONE_ADDRESS: usize = 64;

/// Catches a page that nobody can open because others hold all of its places, and say nothing.
#[test]
fn silent_connections_keep_nobody_from_the_page() {
    let view = View::local("view-silent", LOAD);
    let address: SocketAddr = view.address.parse().unwrap();
    let open = || TcpStream::connect(address).unwrap();
    let mut silent: Vec<TcpStream> = (0..80).map(|_| open()).collect();
    let end = Instant::now() + Duration::from_secs(2);
    let mut longest = Duration::ZERO;
    let mut answers = 0;
    while Instant::now() < end {
        let begin = Instant::now();
        view.now();
        longest = longest.max(begin.elapsed());
        answers += 1;
        // They are renewed, ten at a time.
        silent.drain(..10);
        silent.extend((0..10).map(|_| open()));
    }
    assert!(
        longest < Duration::from_secs(1) && answers > 10,
        "{longest:?} {answers}"
    );
    // One that had to make room is told so, whole.
    let mut first = open();
    let others: Vec<TcpStream> = (0..OF_ONE_ADDRESS).map(|_| open()).collect();
    first
        .set_read_timeout(Some(Duration::from_secs(20)))
        .unwrap();
    let mut told = String::new();
    first.read_to_string(&mut told).unwrap();
    assert!(
        told.starts_with("HTTP/1.1 503 ")
            && told.ends_with("request: too many connections at once; try again\n"),
        "{told}"
    );
    drop(others);
}

/// Catches an answer that is lost because more has come than was read.
#[test]
fn what_is_too_long_or_there_twice_is_answered_as_documented() {
    let view = View::local("view-wrong", LOAD);
    let host = format!("Host: {}\r\n", view.address);
    let status = |text: &str| {
        let told = sent(&view.address, text.as_bytes());
        let text = String::from_utf8_lossy(&told).into_owned();
        text.split(' ').nth(1).unwrap_or_default().to_owned()
    };
    let long = "y".repeat(3_000_000);
    for (text, wanted) in [
        (format!("GET /{long} HTTP/1.1\r\n{host}\r\n"), "431"),
        (format!("GET / HTTP/1.1\r\n{host}X: {long}\r\n\r\n"), "431"),
        (format!("GET / HTTP/1.1\r\n{host}{host}\r\n"), "400"),
        (
            format!("GET / HTTP/1.1\r\n{host}Host: evil.example\r\n\r\n"),
            "400",
        ),
        (
            format!(
                "POST /api/stop HTTP/1.1\r\n{host}Content-Length: 0\r\nContent-Length: 3\r\n\r\n"
            ),
            "400",
        ),
        (
            format!("POST /api/stop HTTP/1.1\r\n{host}Content-Length: 3000000\r\n\r\n{long}"),
            "413",
        ),
        (format!("{long}\r\n\r\n"), "431"),
        (format!("GET /api/now HTTP/1.1\r\n{host}\r\n"), "200"),
    ] {
        for _ in 0..5 {
            assert_eq!(status(&text), wanted, "{}", &text[..text.len().min(80)]);
        }
    }
}
