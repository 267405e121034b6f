//! Users, passwords and keys of addresses, kept apart from the names that are shown and written.
//!
//! A name in the program never holds a secret: [`hidden`] cuts it where an address comes in, and only the client of web
//! servers looks it up again. The parts cut stay in memory, as long as the process runs.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use belvedere_data::shown::{Address, CUT};

/// Secrets cut from addresses so far, by their number.
static SECRETS: Mutex<Vec<Secret>> = Mutex::new(Vec::new());

#[derive(PartialEq, Eq)]
struct Secret {
    /// Scheme and server: no other one is sent it.
    server: [String; 2],
    user: String,
    query: String,
}

/// The address without user, password and key, which readers of this process know from then on; other paths unchanged.
///
/// Files beside the address need the same secrets: names with the same ending, `?***`, on the same server get them.
#[must_use]
pub fn hidden(path: &Path) -> PathBuf {
    match path.to_str().and_then(hidden_text) {
        Some(text) => text.into(),
        None => path.to_owned(),
    }
}

/// A text that ends with an address, such as `--trajectory=https://…`, without the secrets of that; `None` where it has
/// none.
#[must_use]
pub fn hidden_text(text: &str) -> Option<String> {
    let (start, address) = Address::at_end_of(text).filter(|(_, address)| address.has_secrets())?;
    let Address { scheme, user, server, query, .. } = address;
    let [user, query] = [user, query].map(str::to_owned);
    let server = [scheme, server].map(str::to_ascii_lowercase);
    let secret = Secret { server, user, query };
    let mut known = SECRETS.lock().unwrap_or_else(PoisonError::into_inner);
    let number = known.iter().position(|other| *other == secret).unwrap_or_else(|| {
        known.push(secret);
        known.len() - 1
    });
    let number = if number == 0 { String::new() } else { (number + 1).to_string() };
    Some(format!("{start}{}", address.without_secrets(&format!("{CUT}{number}"))))
}

/// The whole of an address that was hidden; `None` for secrets that this process was not given.
#[cfg(feature = "http")]
pub(crate) fn whole(text: &str) -> Option<String> {
    let Some((address, number)) = Address::parse(text).and_then(|address| Some((address, address.cut_number()?)))
    else {
        return Some(text.to_owned());
    };
    let Address { scheme, server, path, .. } = address;
    let number = if number.is_empty() { 1 } else { number.parse::<usize>().ok()? };
    let known = SECRETS.lock().unwrap_or_else(PoisonError::into_inner);
    let secret = known.get(number.checked_sub(1)?)?;
    let is_of_server = secret.server == [scheme, server].map(str::to_ascii_lowercase);
    is_of_server.then(|| format!("{scheme}{}{server}{path}{}", secret.user, secret.query))
}

#[cfg(all(test, feature = "http"))]
mod tests {
    use super::*;

    #[test]
    fn a_hidden_address_is_known_to_the_client_alone_and_only_for_its_server() {
        let address = "https://ann:pw@example.org/dir/ept.json?sig=1";
        let name = hidden(Path::new(address));
        let text = name.to_str().unwrap();
        assert!(text.starts_with("https://example.org/dir/ept.json?***"), "{text}");
        assert_eq!(hidden(&name), name);
        assert_eq!(whole(text).as_deref(), Some(address));
        let beside = text.replace("ept.json", "ept-data/0-0-0-0.laz");
        assert_eq!(whole(&beside).as_deref(), Some("https://ann:pw@example.org/dir/ept-data/0-0-0-0.laz?sig=1"));
        // a catalogue cannot have them sent elsewhere
        for other in [text.replace("example.org", "example.com"), text.replace("https", "http"), format!("{text}00")] {
            assert_eq!(whole(&other), None, "{other}");
        }
        let other = hidden(Path::new("https://example.org/a.laz?sig=2"));
        assert_ne!(other.to_str().unwrap().split_once('?'), text.split_once('?'));
        assert_eq!(whole("https://example.org/a.laz").as_deref(), Some("https://example.org/a.laz"));
        assert_eq!(hidden_text("cloud=https://u:p@example.org/b.laz").unwrap().find("u:p"), None);
        assert_eq!(hidden_text("--sun=180,40"), None);
    }
}
