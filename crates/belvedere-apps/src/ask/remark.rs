//! Remarks: warnings that a user must know to read an answer correctly, and further notes.

use belvedere_data::contradiction::{FoundContradiction, Outcome};
use belvedere_data::report::percent;
use belvedere_data::shown::{ShownPath, printable};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::path::Path;

/// Severity of a remark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Results mislead a user who does not know it.
    Warning,
}

/// A warning or note on an answer. Each is made in one place, so that every face says the same.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Remark {
    /// Its name, which stays the same from version to version: lower case, words joined by hyphens.
    pub key: &'static str,
    /// Severity.
    pub severity: Severity,
    /// Its numbers by name.
    #[serde(serialize_with = "as_map", skip_serializing_if = "Vec::is_empty")]
    pub numbers: Vec<(&'static str, f64)>,
    /// A plain sentence, without a full stop.
    pub text: String,
}

fn as_map<S: Serializer>(numbers: &[(&'static str, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(numbers.len()))?;
    for (name, number) in numbers {
        map.serialize_entry(name, number)?;
    }
    map.end()
}

impl Remark {
    /// A warning. Characters of its text that command a terminal are escaped: names come from files of others.
    #[must_use]
    pub fn warning(key: &'static str, text: impl Into<String>) -> Self {
        Self { key, severity: Severity::Warning, numbers: Vec::new(), text: printable(&text.into()).into_owned() }
    }

    /// A note.
    #[must_use]
    pub fn note(key: &'static str, text: impl Into<String>) -> Self {
        Self { severity: Severity::Note, ..Self::warning(key, text) }
    }

    /// This as a note.
    #[must_use]
    pub fn into_note(self) -> Self {
        Self { severity: Severity::Note, ..self }
    }

    /// This with a number.
    #[must_use]
    pub fn with(mut self, name: &'static str, number: f64) -> Self {
        self.numbers.push((name, number));
        self
    }

    /// A contradiction that was found; `None` for one that is refused, which an error says.
    #[must_use]
    pub fn of_contradiction(found: FoundContradiction) -> Option<Self> {
        let FoundContradiction { row, text, numbers } = found;
        let remark = Self { numbers, ..Self::warning(row.key, text) };
        match row.outcome {
            Outcome::Refused => None,
            Outcome::Warned => Some(remark),
            Outcome::Noted => Some(remark.into_note()),
        }
    }

    /// A warning that `part` of `whole` things are so, such as "3 of 40 targets (7.5 %) are outside the cloud"; `None`
    /// where none is.
    #[must_use]
    pub fn of_share(key: &'static str, part: usize, whole: usize, things: &str, are_so: &str) -> Option<Self> {
        let share = percent(part, whole);
        let remark = || Self::warning(key, format!("{part} of {whole} {things} ({share} %) {are_so}"));
        (part > 0).then(|| remark().with("count", part as f64).with("of", whole as f64).with("percent", share))
    }
}

/// Warns that the written file `output` lacks attributes of the input, `names`.
#[must_use]
pub fn remark_on_left_out(output: &Path, names: &[String]) -> Option<Remark> {
    let text = || format!("{} does not have what the input has: {}", ShownPath(output), names.join(", "));
    (!names.is_empty()).then(|| Remark::warning("not-written", text()).with("count", names.len() as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_the_row_of_every_contradiction() {
        let page = include_str!("../../../../docs/troubleshooting.md");
        for row in belvedere_data::contradiction::ALL {
            let line = format!(
                "| {} | {} | {} {} | {} `{}` |",
                row.given,
                row.known,
                row.tolerance,
                row.unit,
                row.outcome.name(),
                row.key
            );
            assert!(page.lines().any(|own| own == line), "docs/troubleshooting.md lacks the line\n{line}");
        }
    }

    #[test]
    fn a_contradiction_is_a_remark_unless_it_is_refused() {
        use belvedere_data::contradiction::{GROUND_ELSEWHERE, SIGHT_LEAVES_ROOM, TERRAIN_HEIGHTS};
        let severity = |row: &'static belvedere_data::contradiction::Contradiction| {
            Remark::of_contradiction(row.found("a")).map(|remark| remark.severity)
        };
        assert_eq!(severity(&TERRAIN_HEIGHTS), Some(Severity::Warning));
        assert_eq!(severity(&SIGHT_LEAVES_ROOM), Some(Severity::Note));
        assert_eq!(severity(&GROUND_ELSEWHERE), None);
    }

    #[test]
    fn a_share_has_its_numbers_as_fields_and_in_words() {
        let remark = Remark::of_share("targets-outside-cloud", 3, 40, "targets", "are outside the cloud").unwrap();
        assert_eq!(remark.text, "3 of 40 targets (7.5 %) are outside the cloud");
        assert_eq!(remark.numbers, [("count", 3.0), ("of", 40.0), ("percent", 7.5)]);
        assert_eq!(Remark::of_share("targets-outside-cloud", 0, 40, "targets", ""), None);
    }
}
