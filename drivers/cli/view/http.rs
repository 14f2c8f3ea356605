//! HTTP as far as a page of this program needs it: requests out of bytes, and bytes out of answers.

use std::collections::BTreeMap;

/// Bytes of a request's head, and of its body.
const HEAD_MAX: usize = 8_192;
const BODY_MAX: usize = 4_096;
const HEADERS_MAX: usize = 64;

/// A request.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Request {
    /// `GET`, `POST`.
    pub method: String,
    /// Without the query.
    pub path: String,
    /// Names and values behind `?`.
    pub query: BTreeMap<String, String>,
    /// By name in small letters.
    pub headers: BTreeMap<String, String>,
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Response {
    /// 200, 404 ...
    pub status: u16,
    /// Its `Content-Type`.
    pub kind: &'static str,
    /// Further headers.
    pub headers: Vec<(&'static str, String)>,
    /// What it says.
    pub body: Vec<u8>,
}

impl Response {
    /// With this body.
    pub fn new(status: u16, kind: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self {
            status,
            kind,
            headers: Vec::new(),
            body: body.into(),
        }
    }

    /// A text for people.
    pub fn text(status: u16, text: impl Into<String>) -> Self {
        Self::new(status, "text/plain; charset=utf-8", text.into())
    }
}

/// `%41` and `+` as they are meant.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, more @ ..] = rest {
        let hex = more.get(..2).and_then(|h| std::str::from_utf8(h).ok());
        match (*first, hex.and_then(|h| u8::from_str_radix(h, 16).ok())) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &more[2..];
            }
            (b'+', _) => {
                bytes.push(b' ');
                rest = more;
            }
            (byte, _) => {
                bytes.push(byte);
                rest = more;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// A request out of its head, and how many bytes follow; none while the head is not whole.
fn parse(head: &[u8]) -> Result<Option<(Request, usize, usize)>, String> {
    let mut headers = [httparse::EMPTY_HEADER; HEADERS_MAX];
    let mut parsed = httparse::Request::new(&mut headers);
    let length = match parsed.parse(head).map_err(|e| e.to_string())? {
        httparse::Status::Partial => return Ok(None),
        httparse::Status::Complete(length) => length,
    };
    // What two of them say nobody knows, and somebody between may take the other one.
    for name in ["host", "content-length", "transfer-encoding"] {
        let is_it = |h: &&httparse::Header<'_>| h.name.eq_ignore_ascii_case(name);
        let most = if name == "transfer-encoding" { 0 } else { 1 };
        if parsed.headers.iter().filter(is_it).count() > most {
            return Err(match most {
                0 => "Transfer-Encoding: is not taken; send Content-Length".to_owned(),
                _ => format!("{name}: is there twice; send it once"),
            });
        }
    }
    let target = parsed.path.unwrap_or_default();
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let pairs = query.split('&').filter(|pair| !pair.is_empty());
    let request = Request {
        method: parsed.method.unwrap_or_default().to_owned(),
        path: decoded(path),
        query: pairs
            .map(|pair| pair.split_once('=').unwrap_or((pair, "")))
            .map(|(name, value)| (decoded(name), decoded(value)))
            .collect(),
        headers: (parsed.headers.iter())
            .map(|h| {
                (
                    h.name.to_ascii_lowercase(),
                    String::from_utf8_lossy(h.value).into_owned(),
                )
            })
            .collect(),
    };
    let body = match request.headers.get("content-length") {
        None => 0,
        Some(text) => text
            .parse()
            .map_err(|_| "Content-Length is no number".to_owned())?,
    };
    Ok(Some((request, length, body)))
}

/// The request that begins with these bytes; none while it is not whole, and an answer if it is none.
pub fn request(bytes: &[u8]) -> Result<Option<Request>, Response> {
    let too_long = || {
        Response::text(
            431,
            format!("head: too long, at most {HEAD_MAX} bytes; send fewer headers"),
        )
    };
    let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
    if end.unwrap_or(bytes.len()) > HEAD_MAX {
        return Err(too_long());
    }
    match parse(bytes) {
        Err(why) => Err(Response::text(
            400,
            format!("request: {why}; this server speaks HTTP/1.1"),
        )),
        Ok(Some((_, _, body))) if body > BODY_MAX => Err(Response::text(
            413,
            format!("body = {body} bytes: too long, at most {BODY_MAX}; what is asked for stands in the query"),
        )),
        Ok(Some((request, head, body))) if bytes.len() >= head + body => Ok(Some(request)),
        Ok(_) => Ok(None),
    }
}

/// Headers of every answer: no other page may use it, nothing foreign runs in it, nothing is kept.
const ALWAYS: &str = "Connection: close\r\nCache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n\
    Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
    Content-Security-Policy: default-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'\r\n";

/// An answer as it goes out.
pub fn bytes(response: &Response) -> Vec<u8> {
    let Response {
        status,
        kind,
        headers,
        body,
    } = response;
    let more: String = headers
        .iter()
        .map(|(n, v)| format!("{n}: {v}\r\n"))
        .collect();
    let head = format!(
        "HTTP/1.1 {status} \r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{more}{ALWAYS}\r\n",
        body.len()
    );
    [head.as_bytes(), body].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_is_taken_apart() {
        let text =
            b"POST /a%20b?x=1%2B1&y&z=+ HTTP/1.1\r\nHost: h:1\r\nContent-Length: 3\r\n\r\nabc";
        let (request, head, body) = parse(text).unwrap().unwrap();
        assert_eq!((head, body), (text.len() - 3, 3));
        assert_eq!(
            (request.method.as_str(), request.path.as_str()),
            ("POST", "/a b")
        );
        let query: Vec<(&str, &str)> = request
            .query
            .iter()
            .map(|(n, v)| (n.as_str(), v.as_str()))
            .collect();
        assert_eq!(query, [("x", "1+1"), ("y", ""), ("z", " ")]);
        assert_eq!(request.headers["host"], "h:1");
        assert_eq!(parse(b"GET / HTTP/1.1\r\nHost"), Ok(None));
        assert!(parse(b"\x01\x02\r\n\r\n").is_err());
        assert!(parse(b"GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n").is_err());
        assert_eq!(decoded("%zz%4"), "%zz%4");
    }

    /// Whatever comes is a request, a request that is not whole, or an error; and only what is right in every byte that counts is a request for something.
    #[test]
    fn a_hundred_thousand_requests_that_were_spoilt_end_in_an_error() {
        let good = b"POST /api/parameter?channel=0&area=0xA1 HTTP/1.1\r\nHost: localhost:8480\r\nContent-Length: 0\r\n\r\n";
        let mut rng = endat_sim::rng::Rng::new(11);
        let mut below = |end: usize| rng.in_range(0, end as u64 - 1) as usize;
        let mut still = 0;
        for n in 0..100_000 {
            let mut bytes = good.to_vec();
            for _ in 0..1 + n % 4 {
                let at = below(bytes.len());
                match below(3) {
                    0 => bytes[at] = below(256) as u8,
                    1 => drop(bytes.remove(at)),
                    _ => bytes.insert(at, below(256) as u8),
                }
            }
            if let Ok(Some((request, head, _))) = parse(&bytes) {
                assert!(head <= bytes.len() && !request.method.is_empty());
                still += u32::from(request.path == "/api/parameter" && request.method == "POST");
            }
        }
        // A header or a value of the query that is another one is a request all the same.
        assert!((10_000..90_000).contains(&still), "{still}");
    }
}
