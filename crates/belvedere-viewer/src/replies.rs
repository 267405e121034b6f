//! Replies to the page: named values, bytes, and errors in words.

use belvedere::cast::to_row;
use serde_json::Value;

/// Reply to a question.
pub(crate) struct QuestionReply {
    /// Named values.
    pub(crate) head: Value,
    /// A value for each of many places.
    pub(crate) body: Vec<u8>,
}

/// Why something is not answered, in words for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// There is nothing at the address.
    Missing(&'static str),
    /// The scene is not built yet.
    NotReady,
    /// The question has no answer.
    Unanswerable(String),
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Missing(message) => message,
            Self::NotReady => "the scene is not ready yet",
            Self::Unanswerable(message) => message,
        })
    }
}

impl std::error::Error for Refusal {}

impl From<belvedere::Error> for Refusal {
    fn from(error: belvedere::Error) -> Self {
        Self::Unanswerable(match error {
            belvedere::Error::NoObserver { what, .. } => format!("Nobody can look from this place: {what}."),
            other => other.to_string(),
        })
    }
}

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Self::Unanswerable(message)
    }
}

impl QuestionReply {
    /// Named values alone.
    pub(crate) fn of(head: Value) -> Self {
        Self { head, body: Vec::new() }
    }

    /// The length of the head as JSON in 4 bytes, little endian, the head filled up with blanks to a multiple of 4
    /// bytes, and the body.
    pub(crate) fn into_bytes(self) -> Vec<u8> {
        let mut head = self.head.to_string().into_bytes();
        head.resize(head.len().next_multiple_of(4), b' ');
        [&to_row(head.len()).to_le_bytes(), &head[..], &self.body].concat()
    }
}
