//! JSON with a checksum: its first member is a checksum of the rest.

use crate::inputs::hash;
use serde::Serialize;

const START: &str = "{\"checksum\":\"";

/// Returns a value as JSON with a checksum.
pub(crate) fn sealed(value: &impl Serialize) -> serde_json::Result<String> {
    let text = serde_json::to_string(value)?;
    let rest = text.strip_prefix('{').unwrap_or_default();
    Ok(format!("{START}{}\",{rest}", hash(rest.as_bytes())))
}

/// Returns true if JSON with a checksum is unchanged.
pub(crate) fn is_sound(bytes: &[u8]) -> bool {
    let parts = bytes.strip_prefix(START.as_bytes()).and_then(|bytes| bytes.split_at_checked(8));
    let rest = parts.and_then(|(sum, rest)| Some((sum, rest.strip_prefix(b"\",")?)));
    rest.is_some_and(|(sum, rest)| hash(rest).as_bytes() == sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_change_is_found_and_the_members_are_read_as_before() {
        let text = sealed(&serde_json::json!({ "a": 1, "b": [2.5] })).unwrap();
        assert!(is_sound(text.as_bytes()));
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!((&value["a"], &value["b"][0]), (&1.into(), &2.5.into()));
        for at in 0..text.len() {
            let mut changed = text.clone().into_bytes();
            changed[at] ^= 1;
            assert!(!is_sound(&changed), "{at}");
            assert!(!is_sound(&text.as_bytes()[..at]), "{at}");
        }
        assert!(!is_sound(b"{}") && !is_sound(b""));
    }
}
