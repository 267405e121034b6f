//! Names of files and addresses as they are shown: without users, passwords and keys, and without control characters.
//!
//! # Source
//! RFC 3986 (Berners-Lee, Fielding & Masinter 2005), section 3: the parts of an address.

use std::borrow::Cow;
use std::fmt::{Display, Formatter, Write};
use std::path::Path;

/// Placeholder for all that was cut from an address.
pub const CUT: &str = "?***";

/// A path or an address, displayed so that it can be shown to anybody and printed on a terminal.
///
/// ```
/// use belvedere_data::shown::ShownPath;
/// let address = ShownPath("https://ann:pw@example.org/tile.laz?key=123".as_ref());
/// assert_eq!(address.to_string(), "https://example.org/tile.laz?***");
/// assert_eq!(ShownPath("red\u{1b}[31m.laz".as_ref()).to_string(), "red\\u{1b}[31m.laz");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ShownPath<'a>(pub &'a Path);

impl Display for ShownPath<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        let text = self.0.to_string_lossy();
        let cut = match Address::at_end_of(&text) {
            Some((start, address)) if address.has_secrets() => {
                Cow::Owned(format!("{start}{}", address.without_secrets(CUT)))
            }
            _ => text,
        };
        // a name of two lines could pass for two messages
        cut.chars().try_for_each(|c| if c == '\n' { formatter.write_str("\\n") } else { write_printable(c, formatter) })
    }
}

/// An address: `SCHEME://USER@SERVER/PATH?QUERY`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address<'a> {
    /// The scheme with `://`.
    pub scheme: &'a str,
    /// User and password with their `@`; empty where there are none.
    pub user: &'a str,
    /// Server and port.
    pub server: &'a str,
    /// The path, from its first `/` on.
    pub path: &'a str,
    /// All behind the path, such as a key, with its `?` or `#`; empty where there is nothing.
    pub query: &'a str,
}

impl<'a> Address<'a> {
    /// The address that a text is.
    #[must_use]
    pub fn parse(text: &'a str) -> Option<Self> {
        Self::at_end_of(text).and_then(|(start, address)| start.is_empty().then_some(address))
    }

    /// The first address of a text, which goes on to its end, and the text before it.
    #[must_use]
    pub fn at_end_of(text: &'a str) -> Option<(&'a str, Self)> {
        let colon = text.find("://")?;
        let is_of_scheme = |c: char| c.is_ascii_alphanumeric() || "+.-".contains(c);
        let start = text.get(..colon)?.trim_end_matches(is_of_scheme).len();
        let (scheme, rest) = text.get(start..)?.split_at_checked(colon + 3 - start)?;
        // one letter is a disk
        if scheme.len() < 5 {
            return None;
        }
        let end_of_server = |text: &str| text.find(['/', '?', '#']).unwrap_or(text.len());
        let mut user = rest.get(..end_of_server(rest))?.rfind('@').map_or(0, |at| at + 1);
        let port = rest.get(..end_of_server(rest))?.rsplit_once(':').map_or("", |(_, port)| port);
        // a password with a slash: what looks like a port is none
        if user == 0 && !port.bytes().all(|byte| byte.is_ascii_digit()) && !port.ends_with(']') {
            user = rest.rfind('@').map_or(0, |at| at + 1);
        }
        let (user, rest) = rest.split_at_checked(user)?;
        let (server, rest) = rest.split_at_checked(end_of_server(rest))?;
        let (path, query) = rest.split_at_checked(rest.find(['?', '#']).unwrap_or(rest.len()))?;
        Some((text.get(..start)?, Self { scheme, user, server, path, query }))
    }

    /// Returns true if parts of it may not be shown: any user and any query, since keys have many names.
    #[must_use]
    pub fn has_secrets(&self) -> bool {
        !self.user.is_empty() || (self.query.len() > 1 && self.cut_number().is_none())
    }

    /// The digits behind [`CUT`], where that is all of the query.
    #[must_use]
    pub fn cut_number(&self) -> Option<&'a str> {
        self.query.strip_prefix(CUT).filter(|number| number.bytes().all(|byte| byte.is_ascii_digit()))
    }

    /// The address with `cut` instead of its secrets.
    #[must_use]
    pub fn without_secrets(&self, cut: &str) -> String {
        let Self { scheme, server, path, .. } = self;
        format!("{scheme}{server}{path}{cut}")
    }
}

/// A text without users, passwords and keys of the addresses in it; these end at blanks and quotation marks.
#[must_use]
pub fn without_secrets(text: &str) -> Cow<'_, str> {
    if !text.contains("://") {
        return Cow::Borrowed(text);
    }
    let mut cut = String::with_capacity(text.len());
    for word in text.split_inclusive(|c: char| c.is_whitespace() || "\"'`<>".contains(c)) {
        match Address::at_end_of(word) {
            Some((start, address)) if address.has_secrets() => {
                let _ = write!(cut, "{start}{}", address.without_secrets(CUT));
                // what parted the words is no part of the address
                cut.extend(word.chars().next_back().filter(|c| c.is_whitespace() || "\"'`<>".contains(*c)));
            }
            _ => cut.push_str(word),
        }
    }
    Cow::Owned(cut)
}

/// A text in which characters that command a terminal, or turn the direction of writing, are escaped; lines stay.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_command) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 8);
    // writing to a text never fails
    let _ = text.chars().try_for_each(|c| write_printable(c, &mut escaped));
    Cow::Owned(escaped)
}

/// Returns true if a character commands a terminal or changes the direction of writing.
#[must_use]
pub fn is_command(c: char) -> bool {
    (c.is_control() && !matches!(c, '\n' | '\t'))
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

fn write_printable(c: char, to: &mut impl Write) -> std::fmt::Result {
    if is_command(c) { write!(to, "{}", c.escape_unicode()) } else { to.write_char(c) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn users_passwords_and_keys_are_cut_from_addresses_of_any_scheme() {
        for (whole, shown) in [
            ("https://example.org/a.laz", "https://example.org/a.laz"),
            ("https://u@example.org/a.laz", "https://example.org/a.laz?***"),
            ("HTTP://u:p@example.org:80", "HTTP://example.org:80?***"),
            ("https://u:p@w@example.org/a@2.laz", "https://example.org/a@2.laz?***"),
            ("https://u:p/w@example.org/a.laz", "https://example.org/a.laz?***"),
            ("https://example.org/a@2.laz", "https://example.org/a@2.laz"),
            ("https://[::1]:80/a.laz#key", "https://[::1]:80/a.laz?***"),
            ("s3://key:secret@bucket/a.laz", "s3://bucket/a.laz?***"),
            ("/vsicurl/https://u:p@h/a.laz?k", "/vsicurl/https://h/a.laz?***"),
            ("https://h/a.laz?***", "https://h/a.laz?***"),
            ("https://h/a.laz?***12", "https://h/a.laz?***12"),
            ("https://h/a.laz?***1a", "https://h/a.laz?***"),
            ("folder/a?b.laz", "folder/a?b.laz"),
            ("C://u@folder/a.laz", "C://u@folder/a.laz"),
        ] {
            assert_eq!(ShownPath(whole.as_ref()).to_string(), shown);
        }
        assert_eq!(without_secrets("get \"https://u:p@h/a?k\": no"), "get \"https://h/a?***\": no");
    }

    #[test]
    fn what_commands_a_terminal_is_escaped_and_lines_of_a_text_stay() {
        assert_eq!(printable("a\nb\tc é 測"), "a\nb\tc é 測");
        assert_eq!(printable("\u{1b}[2J\u{9b}1m\r\u{202e}"), "\\u{1b}[2J\\u{9b}1m\\u{d}\\u{202e}");
        assert_eq!(ShownPath("a\nerror: b".as_ref()).to_string(), "a\\nerror: b");
    }
}
