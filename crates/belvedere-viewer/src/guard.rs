//! Access control: requests must know the token, name this server as their host, and come from its own page.

use axum::http::{HeaderMap, StatusCode, header};

/// Token and port that a request must know.
#[derive(Debug)]
pub(crate) struct Guard {
    /// The first part of every path.
    pub(crate) token: String,
    pub(crate) port: u16,
}

impl Guard {
    /// A guard with a new token of 128 random bits.
    pub(crate) fn new(port: u16) -> std::io::Result<Self> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|error| std::io::Error::other(error.to_string()))?;
        Ok(Self { token: bytes.iter().map(|byte| format!("{byte:02x}")).collect(), port })
    }

    /// Returns the address that opens the page.
    pub(crate) fn url(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Refuses a request of others: a name that only leads here (DNS rebinding), another page, or a wrong token.
    pub(crate) fn refusal(&self, headers: &HeaderMap, path: &str) -> Option<(StatusCode, &'static str)> {
        let text = |name| headers.get(name).and_then(|value| value.to_str().ok());
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !text(header::HOST).is_some_and(|host| hosts.iter().any(|own| own == host)) {
            return Some((StatusCode::FORBIDDEN, "this server answers only as 127.0.0.1"));
        }
        if headers.contains_key(header::ORIGIN)
            && !text(header::ORIGIN).is_some_and(|origin| hosts.iter().any(|own| origin == format!("http://{own}")))
        {
            return Some((StatusCode::FORBIDDEN, "this server answers only its own page"));
        }
        let token = path.strip_prefix('/').and_then(|path| path.split('/').next()).unwrap_or_default();
        if !is_same(token, &self.token) {
            return Some((
                StatusCode::FORBIDDEN,
                "the address has no valid token: use the one that `belvedere view` printed",
            ));
        }
        None
    }
}

/// Compares in a time that does not depend on how many characters agree.
fn is_same(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}
