//! Files on web servers, read part by part.
//!
//! # Source
//! RFC 9110 (Fielding, Nottingham & Reschke 2022), section 14: range requests.

use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom};
use std::sync::{Arc, LazyLock};
use std::thread::sleep;
use std::time::{Duration, Instant};

use ureq::http::{HeaderMap, header};
use ureq::tls::{Certificate, RootCerts, TlsConfig};
use ureq::{Agent, Body};

use belvedere_data::shown::without_secrets;

/// Bytes requested at first: mostly a whole header. And those requested behind a gap, where the reader needs no more:
/// chunks and pages of COPC files may be small.
const FIRST_BYTES: u64 = 1 << 14;
const MIN_BYTES: u64 = 1 << 12;
/// Maximum number of bytes requested ahead of the reader: half of those that it read since the last gap, up to this.
const MAX_AHEAD: u64 = 1 << 20;
/// Maximum number of bytes of one request, however many the reader wants at once.
const MAX_BYTES: u64 = 1 << 24;
/// Bytes that are taken from a connection at once.
const BLOCK_BYTES: usize = 1 << 16;
/// Largest answer of a service, bytes: a thousand rows of a list with room to spare.
const MAX_TEXT: u64 = 1 << 25;
/// Largest file of a server that gives no parts: it is kept in memory.
const MAX_WHOLE: u64 = 1 << 28;
/// Time to wait before asking again, where a server was busy or a connection broke.
const PAUSES: [Duration; 3] = [Duration::from_millis(300), Duration::from_secs(1), Duration::from_secs(3)];
/// Maximum wait for a connection, for the next bytes, and for all of an answer: a whole file of the largest size at
/// half a megabyte a second.
const CONNECT: Duration = Duration::from_secs(20);
const NO_PROGRESS: Duration = Duration::from_secs(30);
const WHOLE_ANSWER: Duration = Duration::from_secs(600);

/// Minimum speed of a server after a wait of [`NO_PROGRESS`], bytes a second: a third of the slowest mobile networks.
/// One that sends a byte now and then would hold a command for ever.
const MIN_SPEED: u64 = 1000;

/// Message for a server that sends nothing for too long.
const SILENT: &str = "the server does not answer: it sent nothing for 30 s; try again later";
/// Message for a server that sends next to nothing.
const SLOW: &str = "the server sends less than a kilobyte a second; try again later, or download the file first";
/// Message for a file that changed since parts of it were read.
const CHANGED: &str = "the file on the server changed while it was read; run again";

/// Connections are kept open from one part to the next. The authorities that are trusted are those of the system.
static AGENT: LazyLock<Agent> = LazyLock::new(|| agent(NO_PROGRESS));

/// A client that gives up when a server sends nothing for so long.
fn agent(no_progress: Duration) -> Agent {
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let authorities = rustls_native_certs::load_native_certs().certs;
    let authorities = authorities.iter().map(|authority| Certificate::from_der(authority).to_owned()).collect();
    let tls = TlsConfig::builder()
        .root_certs(RootCerts::Specific(Arc::new(authorities)))
        .unversioned_rustls_crypto_provider(provider)
        .build();
    let config = Agent::config_builder()
        .tls_config(tls)
        .http_status_as_error(false)
        .user_agent(concat!("belvedere/", env!("CARGO_PKG_VERSION")))
        .timeout_resolve(Some(CONNECT))
        .timeout_connect(Some(CONNECT))
        .timeout_recv_response(Some(no_progress))
        .timeout_per_read(Some(no_progress))
        .timeout_recv_body(Some(WHOLE_ANSWER))
        .build();
    Agent::new_with_config(config)
}

/// A file on a server. Only those parts of it are transferred that are read.
pub(crate) struct Remote {
    address: String,
    size: u64,
    /// Version of the file named by the server; `None` if it names none.
    version: Option<String>,
    /// Position of the next byte to read.
    position: u64,
    /// The last part that came, and where it starts in the file.
    part: Vec<u8>,
    part_start: u64,
    /// Position of the last jump.
    run_start: u64,
    pace: Pace,
}

/// Transfer rate of a server so far.
#[derive(Clone, Copy)]
struct Pace {
    bytes: u64,
    waited: Duration,
    /// Time before the server is judged.
    patience: Duration,
}

impl Pace {
    fn new(patience: Duration) -> Self {
        Self { bytes: 0, waited: Duration::ZERO, patience }
    }

    /// Counts the bytes received since `start`; returns true if the server is too slow.
    fn is_too_slow(&self, start: Instant, bytes: usize) -> bool {
        let waited = self.waited + start.elapsed();
        waited > self.patience && ((self.bytes + bytes as u64) as f64) < waited.as_secs_f64() * MIN_SPEED as f64
    }
}

/// Reply of a server.
struct Reply {
    bytes: Vec<u8>,
    /// Size of the whole file.
    size: u64,
    version: Option<String>,
    /// True if this is the whole file, because the server gives no parts.
    is_whole: bool,
}

/// Why there is no reply.
struct Failure {
    error: Error,
    /// True if a second request may succeed.
    may_pass: bool,
}

/// A part of a file to request.
#[derive(Clone, Copy)]
struct Part {
    start: u64,
    length: u64,
    /// Size of the file, where an earlier answer said it.
    size: Option<u64>,
}

impl Remote {
    /// The file at `address`.
    ///
    /// # Errors
    /// Those of connecting and of the server, in words that give advice.
    pub(crate) fn open(address: &str) -> Result<Self> {
        let first = Part { start: 0, length: FIRST_BYTES, size: None };
        let mut pace = Pace::new(NO_PROGRESS);
        let Reply { bytes, size, version, .. } = patiently(|| request(&AGENT, address, first, &mut pace))?;
        let address = address.to_owned();
        Ok(Self { address, size, version, position: 0, part: bytes, part_start: 0, run_start: 0, pace })
    }

    /// Size of the file, bytes.
    pub(crate) fn size(&self) -> u64 {
        self.size
    }

    /// Returns the version of the file named by the server; `None` if it names none.
    pub(crate) fn version(&self) -> Option<&str> {
        self.version.as_deref()
    }

    /// The end of the last part that came.
    fn part_end(&self) -> u64 {
        self.part_start + self.part.len() as u64
    }

    /// Gets the part that starts at the position, of at least `wanted` bytes as far as the file and one request allow
    /// that.
    fn fetch(&mut self, wanted: u64) -> Result<()> {
        if self.position != self.part_end() {
            self.run_start = self.position;
        }
        let ahead = ((self.position - self.run_start) / 2).clamp(MIN_BYTES, MAX_AHEAD);
        let length = wanted.max(ahead).min(MAX_BYTES).min(self.size - self.position);
        let part = Part { start: self.position, length, size: Some(self.size) };
        let reply = patiently(|| request(&AGENT, &self.address, part, &mut self.pace))?;
        if reply.is_whole || reply.size != self.size || reply.version != self.version {
            return Err(Error::other(CHANGED));
        }
        self.part = reply.bytes;
        self.part_start = self.position;
        Ok(())
    }
}

impl Read for Remote {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        if self.position >= self.size || buffer.is_empty() {
            return Ok(0);
        }
        if !(self.part_start..self.part_end()).contains(&self.position) {
            self.fetch(buffer.len() as u64)?;
        }
        let from = usize::try_from(self.position - self.part_start).map_err(Error::other)?;
        let count = self.part.get(from..).unwrap_or_default().read(buffer)?;
        self.position += count as u64;
        Ok(count)
    }
}

impl Seek for Remote {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let position = match to {
            SeekFrom::Start(position) => Some(position),
            SeekFrom::End(offset) => self.size.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.position.checked_add_signed(offset),
        };
        self.position = position.ok_or(ErrorKind::InvalidInput)?;
        Ok(self.position)
    }
}

/// A file on a server.
#[cfg(feature = "las")]
pub(crate) struct FoundFile {
    /// Its size, where the server says it.
    pub(crate) bytes: Option<u64>,
}

/// Finds the file at `address`, without its content; `None` if the server has no such file, or a page in its place.
///
/// # Errors
/// Those of connecting and of the server.
#[cfg(feature = "las")]
pub(crate) fn find(address: &str) -> Result<Option<FoundFile>> {
    patiently(|| {
        let response = AGENT
            .get(address)
            .header(header::RANGE, "bytes=0-0")
            .header(header::ACCEPT_ENCODING, "identity")
            .call()
            .map_err(|error| Failure { may_pass: is_passing(&error), error: Error::other(described(&error)) })?;
        let text = |name| text_of(response.headers(), name);
        let is_page = text(header::CONTENT_TYPE).is_some_and(|kind| kind.starts_with("text/html"));
        let of_range = text(header::CONTENT_RANGE).and_then(ContentRange::parse).map(|range| range.size);
        match response.status().as_u16() {
            404 | 410 => Ok(None),
            200 | 206 if is_page => Ok(None),
            206 => Ok(Some(FoundFile { bytes: of_range })),
            200 => {
                let bytes = text(header::CONTENT_LENGTH).and_then(|length| length.parse().ok());
                Ok(Some(FoundFile { bytes }))
            }
            status => Err(of_status(status)),
        }
    })
}

/// The answer of a service as text.
///
/// # Errors
/// Those of connecting and of the server, and answers of more than 32 MiB.
#[cfg(feature = "las")]
pub(crate) fn text(address: &str) -> Result<String> {
    let mut pace = Pace::new(NO_PROGRESS);
    patiently(|| {
        let start = Instant::now();
        let mut response = AGENT
            .get(address)
            .header(header::ACCEPT_ENCODING, "identity")
            .call()
            .map_err(|error| Failure { may_pass: is_passing(&error), error: Error::other(described(&error)) })?;
        let status = response.status().as_u16();
        if status != 200 {
            return Err(of_status(status));
        }
        let bytes = read_body(response.body_mut(), MAX_TEXT + 1, (start, &mut pace))?;
        if bytes.len() as u64 > MAX_TEXT {
            return Err(lasting("the answer has more than 32 MiB; look at the page of the service".to_owned()));
        }
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    })
}

/// Asks again where that may help.
fn patiently<T>(mut ask: impl FnMut() -> std::result::Result<T, Failure>) -> Result<T> {
    for pause in PAUSES {
        match ask() {
            Err(Failure { may_pass: true, .. }) => sleep(pause),
            Err(Failure { error, .. }) => return Err(error),
            Ok(reply) => return Ok(reply),
        }
    }
    ask().map_err(|failure| failure.error)
}

/// Asks once for a part, or fewer bytes where the file ends before.
fn request(agent: &Agent, address: &str, part: Part, pace: &mut Pace) -> std::result::Result<Reply, Failure> {
    let start_of_wait = Instant::now();
    let Part { start, length, size: known } = part;
    let last = start.saturating_add(length).saturating_sub(1);
    let mut response = agent
        .get(address)
        .header(header::RANGE, format!("bytes={start}-{last}"))
        .header(header::ACCEPT_ENCODING, "identity")
        .call()
        .map_err(|error| Failure { may_pass: is_passing(&error), error: Error::other(described(&error)) })?;
    let status = response.status().as_u16();
    let headers = response.headers().clone();
    let text = |name| text_of(&headers, name);
    // the servers of a farm make tags of their own, such as from inodes, for the same file; when it was changed is the
    // same on all of them
    let tag = || text(header::ETAG).map(|tag| tag.trim_start_matches("W/"));
    let version = text(header::LAST_MODIFIED).or_else(tag).map(str::to_owned);
    if text(header::CONTENT_ENCODING).is_some_and(|encoding| encoding != "identity") {
        return Err(lasting("the server sends the file in compressed form only; download it first".to_owned()));
    }
    match (status, text(header::CONTENT_RANGE).and_then(ContentRange::parse)) {
        (206, Some(range)) if known.is_some_and(|size| size != range.size) => Err(lasting(CHANGED.to_owned())),
        (206, Some(range)) => {
            let end = start.saturating_add(length).min(range.size);
            if range.start != start || range.end != end {
                return Err(lasting(
                    "the server sends another part of the file than the one that is needed; download it first"
                        .to_owned(),
                ));
            }
            let bytes = body(response.body_mut(), end - start, (start_of_wait, pace))?;
            Ok(Reply { bytes, size: range.size, version, is_whole: false })
        }
        (200, _) => {
            let size = text(header::CONTENT_LENGTH).and_then(|length| length.parse().ok());
            let no_parts = "the server gives no parts of files (HTTP ranges)";
            match size {
                Some(size) if size <= MAX_WHOLE => {
                    let bytes = body(response.body_mut(), size, (start_of_wait, pace))?;
                    Ok(Reply { bytes, size, version, is_whole: true })
                }
                Some(_) => Err(lasting(format!("{no_parts}, and this one has more than 256 MiB; download it first"))),
                None => Err(lasting(format!("{no_parts} and does not say their size; download it first"))),
            }
        }
        // the first byte of an empty file is none
        (416, _) if start == 0 => Ok(Reply { bytes: Vec::new(), size: 0, version, is_whole: false }),
        // one server of a farm may not have it yet
        (404, _) if known.is_some() => Err(Failure { error: Error::other(CHANGED), may_pass: true }),
        // it ends earlier than before, or is gone
        (410 | 416, _) if known.is_some() => Err(lasting(CHANGED.to_owned())),
        _ => Err(of_status(status)),
    }
}

/// The failure that a status means.
fn of_status(status: u16) -> Failure {
    match status {
        401 | 403 | 407 => lasting(format!("the server refuses access (status {status})")),
        404 | 410 => lasting(format!("the server has no such file (status {status}); check the address")),
        408 | 429 | 500..=599 => {
            let error = Error::other(format!("the server cannot answer now (status {status}); try again later"));
            Failure { error, may_pass: true }
        }
        _ => lasting(format!("the server gives no answer that fits (status {status}); download the file first")),
    }
}

/// The first and the end of the bytes that were sent, and the size of the file: `bytes 0-99/5000`.
struct ContentRange {
    start: u64,
    end: u64,
    size: u64,
}

impl ContentRange {
    fn parse(text: &str) -> Option<Self> {
        let (range, size) = text.strip_prefix("bytes ")?.split_once('/')?;
        let (first, last) = range.split_once('-')?;
        let [start, last, size] = [first, last, size].map(|number| number.trim().parse::<u64>().ok());
        Some(Self { start: start?, end: last?.checked_add(1)?, size: size? })
    }
}

fn text_of(headers: &HeaderMap, name: header::HeaderName) -> Option<&str> {
    headers.get(name)?.to_str().ok()
}

/// All of a body of `length` bytes, for which is waited since `start`.
fn body(body: &mut Body, length: u64, (start, pace): (Instant, &mut Pace)) -> std::result::Result<Vec<u8>, Failure> {
    let bytes = read_body(body, length, (start, pace))?;
    if bytes.len() as u64 == length { Ok(bytes) } else { Err(broken(ErrorKind::UnexpectedEof.into())) }
}

/// A body up to its end, or to `length` bytes.
fn read_body(
    body: &mut Body,
    length: u64,
    (start, pace): (Instant, &mut Pace),
) -> std::result::Result<Vec<u8>, Failure> {
    let mut reader = body.with_config().limit(length.saturating_add(1)).reader().take(length);
    let (mut bytes, mut block) = (Vec::new(), vec![0; BLOCK_BYTES]);
    loop {
        match reader.read(&mut block) {
            Ok(0) => break,
            Ok(count) => bytes.extend_from_slice(block.get(..count).unwrap_or_default()),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(broken(error)),
        }
        if pace.is_too_slow(start, bytes.len()) {
            return Err(lasting(SLOW.to_owned()));
        }
    }
    pace.bytes += bytes.len() as u64;
    pace.waited += start.elapsed();
    Ok(bytes)
}

fn broken(error: Error) -> Failure {
    let of_client = error.get_ref().and_then(|inner| inner.downcast_ref::<ureq::Error>());
    // who was slow once will be slow again
    let may_pass = !matches!(of_client, Some(ureq::Error::Timeout(_)));
    if !may_pass {
        return lasting(SILENT.to_owned());
    }
    let what = format!("the connection to the server broke ({error}); try again");
    Failure { error: Error::new(error.kind(), what), may_pass }
}

fn lasting(what: String) -> Failure {
    Failure { error: Error::other(what), may_pass: false }
}

/// Returns true if a connection that failed may work when tried again.
fn is_passing(error: &ureq::Error) -> bool {
    let ureq::Error::Io(error) = error else { return false };
    matches!(
        error.kind(),
        ErrorKind::ConnectionReset | ErrorKind::ConnectionAborted | ErrorKind::BrokenPipe | ErrorKind::UnexpectedEof
    )
}

/// Describes the error and its remedy, without the secrets of the address, which the client may name.
fn described(error: &ureq::Error) -> String {
    let text = match error {
        ureq::Error::HostNotFound => "there is no such server; check the address and the connection".to_owned(),
        ureq::Error::Timeout(_) => SILENT.to_owned(),
        ureq::Error::TooManyRedirects | ureq::Error::RedirectFailed => {
            "the server sends on to nowhere; check the address".to_owned()
        }
        ureq::Error::BadUri(_) | ureq::Error::Http(_) => format!("is not an address: {error}"),
        ureq::Error::Io(io) if io.get_ref().is_some_and(|inner| inner.is::<rustls::Error>()) => format!(
            "there is no secure connection: {io}; the authorities that are trusted are those of the system (on Debian: ca-certificates) or of the file that \
             SSL_CERT_FILE names"
        ),
        _ => format!("cannot be reached: {error}; check the address and the connection"),
    };
    without_secrets(&text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::net::TcpListener;
    use std::time::Instant;

    #[test]
    fn a_server_that_stops_in_the_middle_is_given_up_soon_and_one_that_goes_on_slowly_is_not() {
        for (pause, ends) in [(Duration::from_millis(150), true), (Duration::from_secs(20), false)] {
            let listener = TcpListener::bind("127.0.0.1:0").unwrap();
            let address = format!("http://{}/a.las", listener.local_addr().unwrap());
            std::thread::spawn(move || {
                let (mut stream, _) = listener.accept().unwrap();
                let mut head = [0; 4096];
                let _ = stream.read(&mut head);
                let _ =
                    stream.write_all(b"HTTP/1.1 206 Part\r\nContent-Range: bytes 0-9/10\r\nContent-Length: 10\r\n\r\n");
                for byte in 0..10 {
                    sleep(pause);
                    let _ = stream.write_all(&[byte]);
                }
            });
            let begin = Instant::now();
            let part = Part { start: 0, length: 10, size: None };
            let reply = request(&agent(Duration::from_secs(1)), &address, part, &mut Pace::new(NO_PROGRESS));
            match reply {
                Ok(reply) => assert!(ends && reply.bytes.len() == 10),
                Err(failure) => {
                    let text = failure.error.to_string();
                    assert!(!ends && !failure.may_pass && text.contains("sent nothing for 30 s"), "{text}");
                    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
                }
            }
        }
        assert_eq!(AGENT.config().timeout_per_read(), Some(NO_PROGRESS));
    }

    #[test]
    fn a_server_that_sends_a_byte_now_and_then_is_given_up_whatever_the_size_of_parts() {
        // one long part, and parts that each end before a server is judged
        for length in [100_000_usize, 3] {
            let listener = TcpListener::bind("127.0.0.1:0").unwrap();
            let address = format!("http://{}/a.las", listener.local_addr().unwrap());
            std::thread::spawn(move || {
                for stream in listener.incoming() {
                    let mut stream = stream.unwrap();
                    std::thread::spawn(move || {
                        let mut head = [0; 4096];
                        while stream.read(&mut head).is_ok_and(|count| count > 0) {
                            let last = length - 1;
                            let head = format!(
                                "HTTP/1.1 206 Part\r\nContent-Range: bytes 0-{last}/{length}\r\nContent-Length: {length}\r\n\r\n"
                            );
                            let _ = stream.write_all(head.as_bytes());
                            for _ in 0..length {
                                sleep(Duration::from_millis(50));
                                if stream.write_all(b"x").is_err() {
                                    return;
                                }
                            }
                        }
                    });
                }
            });
            let part = Part { start: 0, length: length as u64, size: None };
            let (agent, mut pace) = (agent(Duration::from_secs(5)), Pace::new(Duration::from_millis(400)));
            let failure = (0..20).find_map(|_| request(&agent, &address, part, &mut pace).err()).unwrap();
            assert!(!failure.may_pass && failure.error.to_string() == SLOW, "{length}: {}", failure.error);
        }
    }
}
