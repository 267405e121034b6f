//! A small web server that gives files, in good manners and in bad ones.

use std::collections::HashMap;
use std::io::{BufRead, BufReader, Result, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Behaviour of a server.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// The requested part.
    Parts,
    /// The whole file for any request, as Python's `http.server` does.
    Whole,
    /// A part that was not requested.
    AnotherPart,
    /// Every part of another version of the file.
    Changing,
    /// After the first answer, the file is shorter, or gone.
    Shrinking,
    Vanishing,
    /// In compressed form, although this was not requested.
    Compressed,
    /// The first answer to each part is this status.
    FirstStatus(u16),
    /// The first answer to each part ends in the middle.
    FirstCut,
    /// The requested part, for addresses that end with [`KEY`]; others are refused.
    Keyed,
    /// Every answer is this status.
    Status(u16),
}

/// End of addresses on a server that requires a key.
pub(crate) const KEY: &str = "?sv=2024&sig=a/b.c%3D";

/// Files by their names, as long as the process runs.
pub(crate) struct WebServer {
    port: u16,
    counts: Arc<RequestCounts>,
}

#[derive(Default)]
struct RequestCounts {
    requests: AtomicUsize,
    bytes: AtomicU64,
}

impl WebServer {
    pub(crate) fn start(files: impl IntoIterator<Item = (&'static str, Vec<u8>)>, manner: Manner) -> Self {
        let files: HashMap<String, Vec<u8>> =
            files.into_iter().map(|(name, bytes)| (format!("/{name}"), bytes)).collect();
        let (files, counts) = (Arc::new(files), Arc::new(RequestCounts::default()));
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let own = Arc::clone(&counts);
        std::thread::spawn(move || {
            for connection in listener.incoming() {
                let (files, counts) = (Arc::clone(&files), Arc::clone(&own));
                // a client that goes away is no fault of the server
                std::thread::spawn(move || connection.and_then(|stream| serve(stream, &files, &counts, manner)));
            }
        });
        Self { port, counts }
    }

    pub(crate) fn address(&self, name: &str) -> String {
        format!("http://127.0.0.1:{}/{name}", self.port)
    }

    /// Answers so far, and bytes of files in them.
    pub(crate) fn sent(&self) -> (usize, u64) {
        (self.counts.requests.load(Ordering::Relaxed), self.counts.bytes.load(Ordering::Relaxed))
    }
}

/// Answers one connection until it ends.
fn serve(stream: TcpStream, files: &HashMap<String, Vec<u8>>, counts: &RequestCounts, manner: Manner) -> Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?);
    let mut stream = stream;
    loop {
        let (mut start_line, mut range) = (String::new(), None);
        if lines.read_line(&mut start_line)? == 0 {
            return Ok(());
        }
        loop {
            let mut line = String::new();
            lines.read_line(&mut line)?;
            if line.trim().is_empty() {
                break;
            }
            if let Some(bytes) = line.to_ascii_lowercase().strip_prefix("range: bytes=") {
                range = bytes.trim().split_once('-').map(|(first, last)| [first, last].map(|v| v.parse().unwrap()));
            }
        }
        let number = counts.requests.fetch_add(1, Ordering::Relaxed);
        let path = start_line.split(' ').nth(1).unwrap_or_default();
        let file = files.get(path.split('?').next().unwrap_or_default());
        let failure = match manner {
            Manner::Status(status) => Some(status),
            Manner::Keyed if !path.ends_with(KEY) => Some(403),
            Manner::Vanishing if number > 0 => Some(404),
            Manner::FirstStatus(status) if number.is_multiple_of(2) => Some(status),
            _ => None,
        };
        let (Some(file), None) = (file, failure) else {
            write!(stream, "HTTP/1.1 {} No\r\nContent-Length: 0\r\n\r\n", failure.unwrap_or(404))?;
            continue;
        };
        let shorter = &file[..file.len() / 2];
        let file = if manner == Manner::Shrinking && number > 0 { shorter } else { &file[..] };
        let [first, last]: [usize; 2] = range.unwrap_or([0, usize::MAX]);
        let (first, end) = (first.min(file.len()), last.saturating_add(1).min(file.len()));
        let end = if manner == Manner::AnotherPart { (first + 1).min(end) } else { end };
        let is_cut = manner == Manner::FirstCut && number.is_multiple_of(2);
        let version = if manner == Manner::Changing { number } else { 0 };
        if first >= file.len() {
            write!(stream, "HTTP/1.1 416 No\r\nContent-Range: bytes */{}\r\nContent-Length: 0\r\n\r\n", file.len())?;
            continue;
        }
        let part = if manner == Manner::Whole { file } else { &file[first..end] };
        if manner == Manner::Whole {
            write!(stream, "HTTP/1.1 200 OK\r\n")?;
        } else {
            let (last, size) = (end - 1, file.len());
            write!(
                stream,
                "HTTP/1.1 206 Part\r\nContent-Range: bytes {first}-{last}/{size}\r\nETag: \"{version}\"\r\n"
            )?;
        }
        if manner == Manner::Compressed {
            write!(stream, "Content-Encoding: gzip\r\n")?;
        }
        write!(stream, "Content-Length: {}\r\n\r\n", part.len())?;
        let part = if is_cut { &part[..part.len() / 2] } else { part };
        counts.bytes.fetch_add(part.len() as u64, Ordering::Relaxed);
        stream.write_all(part)?;
        if is_cut {
            return stream.shutdown(std::net::Shutdown::Both);
        }
    }
}
