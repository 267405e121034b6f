//! Places in questions: coordinates of the file, as the command line takes them.

use super::Asked;
use crate::replies::Refusal;
use serde_json::{Value, json};

/// A place, local metres.
pub(super) fn local(asked: &Asked<'_>, place: [f64; 3]) -> Result<[f64; 3], Refusal> {
    if !place.iter().all(|v| v.is_finite()) {
        return Err(Refusal("the place has a coordinate that is not a number".to_owned()));
    }
    Ok(asked.scene.model.frame().local_from_file(place))
}

/// Coordinates as they are typed.
pub(super) fn typed(place: &[f64]) -> String {
    place.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// A local place in the coordinates of the file, to the millimetre.
pub(super) fn shown(asked: &Asked<'_>, local: [f64; 3]) -> [f64; 3] {
    asked.scene.model.frame().file_from_local(local).map(|v| rounded(v, 3))
}

pub(super) fn rounded(value: f64, decimals: i32) -> f64 {
    belvedere::report::rounded(value, decimals)
}

/// A number, or null where it is none.
pub(super) fn number(value: f64, decimals: i32) -> Value {
    if value.is_finite() { json!(rounded(value, decimals)) } else { Value::Null }
}

/// The command with the scene of this page.
pub(super) fn command(asked: &Asked<'_>, name: &str, flags: &str) -> String {
    format!("belvedere {name} {} {flags}", asked.text.input)
}

/// The same for commands that need the ground, which a ball file does not have.
pub(super) fn command_on_ground(asked: &Asked<'_>, name: &str, flags: &str) -> String {
    match &asked.text.cloud_beside {
        Some(cloud) => command(asked, name, &format!("--ground cloud={cloud} {flags}")),
        None => command(asked, name, flags),
    }
}

/// The same for targets that the command line reads from a table.
pub(super) fn command_at(asked: &Asked<'_>, place: [f64; 3], name: &str, flags: &str) -> String {
    format!(
        "printf 'x,y,z\\n{}\\n' > place.csv\n{}",
        typed(&place),
        command(asked, name, &format!("--targets place.csv {flags}"))
    )
}
