//! Replies to the page: text, JSON, bytes, and errors in words.

use axum::body::Body;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

/// What a question is answered with.
pub(crate) struct QuestionReply {
    /// Named values.
    pub(crate) head: Value,
    /// A value for each of many places.
    pub(crate) body: Vec<u8>,
}

/// Why a question is not answered, in words for people.
#[derive(Debug)]
pub(crate) struct Refusal(pub(crate) String);

impl From<belvedere::Error> for Refusal {
    fn from(error: belvedere::Error) -> Self {
        match error {
            belvedere::Error::NoObserver { what, .. } => Self(format!("Nobody can look from this place: {what}.")),
            other => Self(other.to_string()),
        }
    }
}

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Self(message)
    }
}

impl QuestionReply {
    /// Named values alone.
    pub(crate) fn of(head: Value) -> Self {
        Self { head, body: Vec::new() }
    }
}

impl IntoResponse for QuestionReply {
    /// The length of the head as JSON in 4 bytes, little endian, the head filled up with blanks to a multiple of 4
    /// bytes, and the body.
    fn into_response(self) -> Response {
        let mut head = self.head.to_string().into_bytes();
        head.resize(head.len().next_multiple_of(4), b' ');
        let Ok(length) = u32::try_from(head.len()) else { return StatusCode::INTERNAL_SERVER_ERROR.into_response() };
        let bytes = [&length.to_le_bytes(), &head[..], &self.body].concat();
        binary(bytes)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        refused(StatusCode::UNPROCESSABLE_ENTITY, &self.0)
    }
}

/// An error as the page reads it.
pub(crate) fn refused(status: StatusCode, message: &str) -> Response {
    (status, [(header::CONTENT_TYPE, "application/json")], json!({ "error": message }).to_string()).into_response()
}

/// Bytes of our own.
pub(crate) fn binary(bytes: Vec<u8>) -> Response {
    ([(header::CONTENT_TYPE, "application/octet-stream")], Body::from(bytes)).into_response()
}
