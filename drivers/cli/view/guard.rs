//! Who may ask: programs on this machine and pages of this program, or who has the token.

use super::http::{Request, Response};
use std::collections::BTreeSet;
use std::net::SocketAddr;

/// Name of the cookie and of the query that have the token.
const TOKEN: &str = "token";

/// What is asked of a request before anything else.
pub struct Guard {
    /// Names under which this machine alone is reached; none where others may come.
    hosts: Option<BTreeSet<String>>,
    token: Option<String>,
}

/// Compares without telling by its time how much was right.
fn is_same(one: &str, other: &str) -> bool {
    let differ = one
        .bytes()
        .zip(other.bytes())
        .fold(0, |all, (a, b)| all | (a ^ b));
    one.len() == other.len() && differ == 0
}

impl Guard {
    /// For a server that listens at this address.
    pub fn new(address: SocketAddr, token: Option<String>) -> Self {
        let port = address.port();
        let own = ["localhost".into(), "127.0.0.1".into(), "[::1]".into()];
        let own = own.into_iter().chain([match address {
            SocketAddr::V4(at) => at.ip().to_string(),
            SocketAddr::V6(at) => format!("[{}]", at.ip()),
        }]);
        let hosts = own.flat_map(|name: String| match port {
            80 => vec![name.clone(), format!("{name}:80")],
            _ => vec![format!("{name}:{port}")],
        });
        Self {
            hosts: address.ip().is_loopback().then(|| hosts.collect()),
            token,
        }
    }

    /// An answer if the request may not be answered otherwise.
    pub fn refuses(&self, request: &Request) -> Option<Response> {
        let header = |name: &str| request.headers.get(name).map(String::as_str);
        let refused = |why: &str| Some(Response::text(403, format!("refused: {why}\n")));
        let Some(host) = header("host") else {
            return Some(Response::text(
                400,
                "Host: is missing; send the name of this server\n",
            ));
        };
        // A foreign name that leads here is another page's way in.
        if self
            .hosts
            .as_ref()
            .is_some_and(|known| !known.contains(&host.to_ascii_lowercase()))
        {
            return refused(
                "this is not the name of this server; open http://localhost with its port",
            );
        }
        let is_own = |origin: &str| {
            origin
                .strip_prefix("http://")
                .is_some_and(|o| o.eq_ignore_ascii_case(host))
        };
        let another =
            "another page asks, and only pages of this server may; open this address itself";
        if header("origin").is_some_and(|origin| !is_own(origin)) {
            return refused(another);
        }
        if header("sec-fetch-site").is_some_and(|from| !["same-origin", "none"].contains(&from))
            && request.path != "/"
        {
            return refused(another);
        }
        let token = self.token.as_ref()?;
        if let Some(given) = request.query.get(TOKEN).filter(|_| request.path == "/") {
            if !is_same(given, token) {
                return refused(
                    "the token is another one; open the address that the program has printed",
                );
            }
            let mut response = Response::text(303, "");
            let cookie = format!("endat-{TOKEN}={token}; HttpOnly; SameSite=Strict; Path=/");
            response.headers = vec![("Set-Cookie", cookie), ("Location", "/".into())];
            return Some(response);
        }
        let prefix = format!("endat-{TOKEN}=");
        let cookies = header("cookie").into_iter().flat_map(|all| all.split(';'));
        let mut given = cookies
            .filter_map(|one| one.trim().strip_prefix(&prefix))
            .chain(header("authorization").and_then(|a| a.strip_prefix("Bearer ")));
        match given.any(|given| is_same(given, token)) {
            true => None,
            false => refused("open the address that the program has printed; it has the token"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(path: &str, headers: &[(&str, &str)]) -> Request {
        let (path, query) = path.split_once('?').unwrap_or((path, ""));
        let query = query.split_once('=').into_iter();
        Request {
            method: "GET".into(),
            path: path.into(),
            query: query.map(|(n, v)| (n.into(), v.into())).collect(),
            headers: headers
                .iter()
                .map(|(n, v)| ((*n).into(), (*v).into()))
                .collect(),
        }
    }

    fn status(guard: &Guard, path: &str, headers: &[(&str, &str)]) -> u16 {
        guard
            .refuses(&request(path, headers))
            .map_or(200, |r| r.status)
    }

    #[test]
    fn only_pages_of_this_server_ask_it() {
        let guard = Guard::new("127.0.0.1:8080".parse().unwrap(), None);
        let ask = |headers: &[(&str, &str)]| status(&guard, "/api/now", headers);
        assert_eq!(ask(&[("host", "127.0.0.1:8080")]), 200);
        assert_eq!(ask(&[("host", "LocalHost:8080")]), 200);
        assert_eq!(ask(&[]), 400);
        // A name of somebody else that has been made to lead here.
        assert_eq!(ask(&[("host", "evil.example:8080")]), 403);
        assert_eq!(ask(&[("host", "localhost:8081")]), 403);
        let from = |origin| ask(&[("host", "localhost:8080"), ("origin", origin)]);
        assert_eq!(from("http://localhost:8080"), 200);
        assert_eq!(from("http://evil.example"), 403);
        assert_eq!(from("null"), 403);
        assert_eq!(
            ask(&[("host", "localhost:8080"), ("sec-fetch-site", "cross-site")]),
            403
        );
        assert_eq!(
            ask(&[
                ("host", "localhost:8080"),
                ("sec-fetch-site", "same-origin")
            ]),
            200
        );
    }

    #[test]
    fn others_need_the_token() {
        let guard = Guard::new("0.0.0.0:80".parse().unwrap(), Some("secret".into()));
        let host = ("host", "card.lab");
        assert_eq!(status(&guard, "/", &[host]), 403);
        assert_eq!(status(&guard, "/?token=secreT", &[host]), 403);
        assert_eq!(status(&guard, "/?token=secret", &[host]), 303);
        assert_eq!(status(&guard, "/api/now?token=secret", &[host]), 403);
        assert_eq!(
            status(
                &guard,
                "/api/now",
                &[host, ("cookie", "a=b; endat-token=secret")]
            ),
            200
        );
        assert_eq!(
            status(&guard, "/api/now", &[host, ("cookie", "endat-token=")]),
            403
        );
        assert_eq!(
            status(
                &guard,
                "/api/now",
                &[host, ("authorization", "Bearer secret")]
            ),
            200
        );
    }
}
