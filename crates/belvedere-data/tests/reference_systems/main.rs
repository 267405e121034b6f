//! Places of all reference systems against values of PROJ that `make_places.py` stored.

#![cfg(feature = "crs")]
#![allow(clippy::unwrap_used, reason = "tests")]

use belvedere_data::crs::Crs;

/// Steps between datums that need no grid are exact to a few metres, and PROJ has several of them to choose from.
const TOLERANCE: f64 = 20.0;

/// A line of the table.
struct Stored {
    code: u32,
    place: [f64; 2],
    coordinates: [f64; 2],
    /// True if PROJ knows the step between the datums. Otherwise the coordinates are those without a step.
    is_known: bool,
}

fn stored() -> Vec<Stored> {
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields[i].parse::<f64>().unwrap();
        Stored {
            code: fields[0].parse().unwrap(),
            place: [number(1), number(2)],
            coordinates: [number(3), number(4)],
            is_known: fields[5] == "known",
        }
    };
    include_str!("places.csv").lines().skip(1).map(line).collect()
}

/// Metres between the places of a row by its system and by PROJ; `None` where it is refused.
fn error_of(row: &Stored) -> Option<f64> {
    let crs = Crs::from_epsg(row.code)?;
    let [longitude, latitude] = row.place.map(f64::to_radians);
    let own = crs.geographic_projection().ok()?.project(latitude, longitude).ok()?;
    let metres = |coordinates: [f64; 2]| match crs.kind {
        belvedere_data::crs::CrsKind::Geographic => {
            [coordinates[0] * latitude.cos() * 111_200.0, coordinates[1] * 111_200.0]
        }
        _ => coordinates.map(|v| v * crs.metres_per_unit),
    };
    let own = if crs.kind == belvedere_data::crs::CrsKind::Geographic { metres(own) } else { own };
    let proj = metres(row.coordinates);
    Some((own[0] - proj[0]).hypot(own[1] - proj[1]))
}

#[test]
fn every_code_that_is_accepted_has_the_place_of_proj() {
    let rows = stored();
    let (mut accepted, mut wrong) = (0, Vec::new());
    for row in &rows {
        if let Some(error) = error_of(row) {
            accepted += 1;
            if !(error <= TOLERANCE) {
                wrong.push(format!("EPSG:{} {error:.0} m{}", row.code, if row.is_known { "" } else { " (a guess)" }));
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {accepted}: {}", wrong.len(), wrong.join(", "));
    assert!(accepted > 5000, "{accepted} of {}", rows.len());
}

#[test]
fn areas_of_use_hold_the_stored_places() {
    let mut count = 0;
    for row in stored() {
        let Some(crs) = Crs::from_epsg(row.code) else { continue };
        if let Some(distance) = crs.distance_to_area_of_use(row.coordinates) {
            count += 1;
            // places near an edge are moved by the step between datums
            assert!(distance < 1000.0, "EPSG:{} {distance}", row.code);
        }
    }
    assert!(count > 4500, "{count}");
}
