//! Texts of reports in the languages of the page.

use crate::apps::sun::Date;

/// Texts: a key and its text in each language, separated by semicolons.
const TABLE: &str = include_str!("words.csv");

/// Language of a report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// English. Default.
    #[default]
    English,
    /// Dutch.
    Dutch,
    /// German.
    German,
    /// French.
    French,
}

impl Language {
    /// All languages with their codes (ISO 639-1), in the order of the columns.
    pub const ALL: [(&'static str, Self); 4] =
        [("en", Self::English), ("nl", Self::Dutch), ("de", Self::German), ("fr", Self::French)];

    /// Returns its code.
    #[must_use]
    pub fn code(self) -> &'static str {
        Self::ALL.iter().find(|(_, language)| *language == self).map_or("en", |(code, _)| code)
    }
}

/// Texts in one language.
pub(super) struct Words {
    language: Language,
    texts: std::collections::BTreeMap<&'static str, &'static str>,
}

impl Words {
    pub(super) fn of(language: Language) -> Self {
        let column = Language::ALL.iter().position(|(_, other)| *other == language).unwrap_or(0) + 1;
        let row = |line: &'static str| {
            let cells: Vec<&str> = line.split(';').collect();
            Some((*cells.first()?, *cells.get(column)?))
        };
        Self { language, texts: TABLE.lines().skip(1).filter_map(row).collect() }
    }

    /// Returns the text of a key; the key itself where it is missing, which a test excludes.
    pub(super) fn get(&self, key: &'static str) -> &'static str {
        self.texts.get(key).copied().unwrap_or(key)
    }

    /// Returns the text of a key with values in the place of names in braces.
    pub(super) fn with(&self, key: &'static str, values: &[(&str, &str)]) -> String {
        let mut text = self.get(key).to_owned();
        for (name, value) in values {
            text = text.replace(&format!("{{{name}}}"), value);
        }
        text
    }

    /// Returns a number as the language writes it: 11.3 or 11,3; 163,095 or 163.095 or 163 095.
    pub(super) fn number(&self, value: f64, decimals: usize) -> String {
        let (point, group) = match self.language {
            Language::English => (".", ","),
            Language::Dutch | Language::German => (",", "."),
            Language::French => (",", "\u{202f}"),
        };
        let text = format!("{:.decimals$}", value.abs());
        let (whole, rest) = text.split_once('.').unwrap_or((&text, ""));
        let mut grouped = String::new();
        for (place, digit) in whole.chars().enumerate() {
            if place > 0 && (whole.len() - place).is_multiple_of(3) {
                grouped += group;
            }
            grouped.push(digit);
        }
        let sign = if value < 0.0 { "−" } else { "" };
        let point = if rest.is_empty() { "" } else { point };
        format!("{sign}{grouped}{point}{rest}")
    }

    fn month(&self, date: Date) -> &'static str {
        let number = usize::try_from(date.month()).unwrap_or(1);
        self.get("months").split('|').nth(number.max(1) - 1).unwrap_or_default()
    }

    /// A day such as 21 March.
    pub(super) fn short_date(&self, date: Date) -> String {
        let dot = if self.language == Language::German { "." } else { "" };
        format!("{}{dot} {}", date.day(), self.month(date))
    }

    /// A date such as 21 March 2026.
    pub(super) fn date(&self, date: Date) -> String {
        format!("{} {}", self.short_date(date), date.year())
    }
}

/// Text of HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sources that use texts.
    const USERS: [&str; 6] = [
        include_str!("page.rs"),
        include_str!("area_tables.rs"),
        include_str!("sentences.rs"),
        include_str!("charts.rs"),
        include_str!("mod.rs"),
        include_str!("words.rs"),
    ];

    #[test]
    fn every_text_is_there_in_every_language_and_is_used() {
        let names = |text: &str| -> Vec<String> {
            let pieces = text.split('{').skip(1).filter_map(|piece| piece.split_once('}'));
            let mut names: Vec<String> = pieces.map(|(name, _)| name.to_owned()).collect();
            names.sort();
            names
        };
        for line in TABLE.lines().skip(1) {
            let cells: Vec<&str> = line.split(';').collect();
            assert_eq!(cells.len(), 5, "{line}");
            assert!(cells.iter().all(|cell| !cell.trim().is_empty() && *cell == cell.trim()), "{line}");
            assert!(cells[2..].iter().all(|cell| names(cell) == names(cells[1])), "{line}");
            let quoted = format!("\"{}\"", cells[0]);
            assert!(USERS.iter().any(|source| source.contains(&quoted)), "{quoted} is not used");
        }
        for source in USERS {
            for (at, _) in source.match_indices("words.get(\"").chain(source.match_indices("words.with(\"")) {
                let key = source[at..].split('"').nth(1).unwrap();
                assert!(TABLE.lines().any(|line| line.split(';').next() == Some(key)), "{key} has no text");
            }
        }
    }

    #[test]
    fn numbers_are_those_of_the_language() {
        let of = |language| [(163_095.0, 0), (11.34, 1), (-0.5, 1)].map(|(v, n)| Words::of(language).number(v, n));
        assert_eq!(of(Language::English), ["163,095", "11.3", "−0.5"]);
        assert_eq!(of(Language::German), ["163.095", "11,3", "−0,5"]);
        assert_eq!(of(Language::French), ["163\u{202f}095", "11,3", "−0,5"]);
    }

    #[test]
    fn dates_are_those_of_the_language() {
        let date = Date::new(2026, 3, 21).unwrap();
        let of = |language| Words::of(language).date(date);
        assert_eq!(of(Language::English), "21 March 2026");
        assert_eq!(of(Language::Dutch), "21 maart 2026");
        assert_eq!(of(Language::German), "21. März 2026");
        assert_eq!(of(Language::French), "21 mars 2026");
    }

    #[test]
    fn names_of_others_are_no_markup() {
        assert_eq!(escaped("<b>\"A & B\"</b>"), "&lt;b&gt;&quot;A &amp; B&quot;&lt;/b&gt;");
    }
}
