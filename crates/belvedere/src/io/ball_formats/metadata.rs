//! What ball files say about themselves, as JSON.

use serde_json::{Map, Value, json};

use crate::crs::{Crs, CrsKind};
use crate::io::balls::SavedBalls;

/// Origin, reference system and provenance of `balls`; `units` says what the numbers beside it mean.
pub(super) fn to_json(balls: &SavedBalls, units: &str) -> String {
    let crs = &balls.crs;
    let provenance: Map<String, Value> =
        balls.provenance.iter().map(|(k, v)| (k.clone(), Value::String(v.clone()))).collect();
    json!({
        "format": "belvedere balls 1",
        "units": units,
        "origin": balls.origin,
        "crs": {
            "wkt": crs.wkt,
            "epsg": crs.epsg,
            "vertical_epsg": crs.vertical_epsg,
            "metres_per_unit": crs.metres_per_unit,
            "vertical_metres_per_unit": crs.vertical_metres_per_unit,
        },
        "provenance": provenance,
    })
    .to_string()
}

/// Balls without rows from what [`to_json`] wrote, and the origin where it is given. What is missing gets its default.
pub(super) fn from_json(text: &str) -> (SavedBalls, Option<[f64; 3]>) {
    let value: Value = serde_json::from_str(text).unwrap_or(Value::Null);
    let code = |key: &str| value["crs"][key].as_u64().and_then(|v| u32::try_from(v).ok());
    let unit = |key: &str| value["crs"][key].as_f64().filter(|v| v.is_finite() && *v > 0.0).unwrap_or(1.0);
    let crs = Crs {
        wkt: value["crs"]["wkt"].as_str().map(str::to_owned),
        epsg: code("epsg"),
        vertical_epsg: code("vertical_epsg"),
        metres_per_unit: unit("metres_per_unit"),
        vertical_metres_per_unit: unit("vertical_metres_per_unit"),
        // balls are only ever made in a plane
        kind: if crs_is_known(&value["crs"]) { CrsKind::Projected } else { CrsKind::Unknown },
    };
    let provenance = value["provenance"]
        .as_object()
        .into_iter()
        .flatten()
        .filter_map(|(k, v)| Some((k.clone(), v.as_str()?.to_owned())))
        .collect();
    let origin = match [0, 1, 2].map(|i| value["origin"][i].as_f64()) {
        [Some(x), Some(y), Some(z)] => Some([x, y, z]),
        _ => None,
    };
    (SavedBalls { crs, provenance, origin: origin.unwrap_or_default(), ..SavedBalls::default() }, origin)
}

fn crs_is_known(crs: &Value) -> bool {
    crs["wkt"].is_string() || crs["epsg"].is_number()
}
