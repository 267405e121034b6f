//! The server of `belvedere view`, queried with the requests of its page.

use super::Workplace;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// A program that runs the server of a page; it is ended after the test.
pub(crate) struct Page {
    pub(crate) program: Child,
    pub(crate) host: String,
    token: String,
}

impl Drop for Page {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

impl Page {
    pub(crate) fn open(place: &Workplace, arguments: &str) -> Self {
        let mut program = place
            .command(&format!("view {arguments} --no-browser"))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut url = String::new();
        BufReader::new(program.stdout.take().unwrap()).read_line(&mut url).unwrap();
        let (host, token) = url.trim().strip_prefix("http://").unwrap().split_once('/').unwrap();
        let page = Self { program, host: host.to_owned(), token: token.trim_end_matches('/').to_owned() };
        let start = Instant::now();
        while page.state()["scene"].is_null() {
            assert!(start.elapsed() < Duration::from_secs(120), "{}", page.state());
            std::thread::sleep(Duration::from_millis(30));
        }
        page
    }

    /// Status and body of a request.
    pub(crate) fn request(&self, method: &str, path: &str, body: &str) -> (u16, Vec<u8>) {
        self.request_of("application/json", method, path, body)
    }

    pub(crate) fn request_of(&self, kind: &str, method: &str, path: &str, body: &str) -> (u16, Vec<u8>) {
        let mut stream = TcpStream::connect(&self.host).unwrap();
        let (host, token) = (&self.host, &self.token);
        write!(
            stream,
            "{method} /{token}/{path} HTTP/1.1\r\nHost: {host}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\
             Connection: close\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        let mut reply = Vec::new();
        stream.read_to_end(&mut reply).unwrap();
        let end = reply.windows(4).position(|four| four == b"\r\n\r\n").unwrap() + 4;
        let status = std::str::from_utf8(&reply[9..12]).unwrap().parse().unwrap();
        (status, reply.split_off(end))
    }

    pub(crate) fn state(&self) -> Value {
        serde_json::from_slice(&self.request("GET", "state", "").1).unwrap()
    }

    /// Named values of an answer, and its bytes.
    pub(crate) fn ask(&self, question: &str, values: &Value) -> (Value, Vec<u8>) {
        self.ask_at(&format!("ask/{question}"), values)
    }

    /// The same of the scene with a plan.
    pub(crate) fn ask_of_plan(&self, plan: &Value, question: &str, values: &Value) -> (Value, Vec<u8>) {
        self.ask_at(&format!("plans/{}/ask/{question}", plan["plan"]), values)
    }

    fn ask_at(&self, question: &str, values: &Value) -> (Value, Vec<u8>) {
        self.answer("POST", question, &values.to_string())
    }

    pub(crate) fn answer(&self, method: &str, question: &str, body: &str) -> (Value, Vec<u8>) {
        let (status, mut reply) = self.request(method, question, body);
        assert_eq!(status, 200, "{question}: {}", String::from_utf8_lossy(&reply));
        let length = u32::from_le_bytes(reply[..4].try_into().unwrap()) as usize;
        let body = reply.split_off(4 + length);
        (serde_json::from_slice(&reply[4..]).unwrap(), body)
    }

    pub(crate) fn refusal(&self, question: &str, values: &Value) -> String {
        let (status, reply) = self.request("POST", &format!("ask/{question}"), &values.to_string());
        assert_eq!(status, 422, "{question}");
        serde_json::from_slice::<Value>(&reply).unwrap()["error"].as_str().unwrap().to_owned()
    }

    /// Coordinates of the points in the order in which they are sent.
    pub(crate) fn points(&self) -> Vec<[f64; 3]> {
        let shown = &self.state()["shown"];
        let number = |value: &Value| value.as_f64().unwrap();
        let mut points = Vec::new();
        for (i, chunk) in shown["chunks"].as_array().unwrap().iter().enumerate() {
            let (status, bytes) = self.request("GET", &format!("points/{i}"), "");
            assert_eq!((status, bytes.len()), (200, 8 * chunk["count"].as_u64().unwrap() as usize));
            for point in bytes.chunks(8) {
                points.push([0, 1, 2].map(|axis| {
                    let steps = f64::from(u16::from_le_bytes([point[2 * axis], point[2 * axis + 1]]));
                    number(&chunk["low"][axis]) + steps * number(&chunk["step"][axis]) + number(&shown["origin"][axis])
                }));
            }
        }
        points
    }
}
