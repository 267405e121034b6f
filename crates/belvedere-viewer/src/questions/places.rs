//! Places in questions: coordinates of the file, as the command line takes them.

use super::context::RequestContext;
use crate::replies::Refusal;
use crate::scene_text::typed;
use serde_json::{Value, json};

/// A place, local metres.
pub(super) fn local(context: &RequestContext<'_>, place: [f64; 3]) -> Result<[f64; 3], Refusal> {
    if !place.iter().all(|v| v.is_finite()) {
        return Err(Refusal::Unanswerable("the place has a coordinate that is not a number".to_owned()));
    }
    Ok(context.scene.model().frame().local_from_file(place))
}

/// A local place in the coordinates of the file, to the millimetre.
pub(super) fn shown(context: &RequestContext<'_>, local: [f64; 3]) -> [f64; 3] {
    context.scene.model().frame().file_from_local(local).map(|v| rounded(v, 3))
}

pub(super) fn rounded(value: f64, decimals: i32) -> f64 {
    belvedere::report::rounded(value, decimals)
}

/// A number, or null where it is none.
pub(super) fn number(value: f64, decimals: i32) -> Value {
    if value.is_finite() { json!(rounded(value, decimals)) } else { Value::Null }
}

/// The command for targets that the command line reads from a table.
pub(super) fn command_at(context: &RequestContext<'_>, place: [f64; 3], name: &str, flags: &str) -> String {
    format!(
        "printf 'x,y,z\\n{}\\n' > place.csv\n{}",
        typed(&place),
        context.text.command(name, &format!("--targets place.csv {flags}"))
    )
}
