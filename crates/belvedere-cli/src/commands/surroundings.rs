//! Eyes of isovists and horizons: from flags and files to places.

use super::sights::{self, local};
use crate::arguments::{Eyes, Usage};
use crate::pipeline::{Scene, flagged};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::apps::viewshed::{OBSERVER_HEIGHT, cell_for};
use belvedere::ground::MapGrid;
use belvedere::io::{RowsAre, read_observers};
use belvedere::query::MedialScene;

/// Ground made around eyes, metres.
const MARGIN: f64 = 10.0;
/// Most notes on eyes that are in something solid.
const MOST_NOTES: usize = 5;

/// The eyes that were typed or are in the file named, local metres.
pub(super) fn eyes(
    arguments: &Eyes,
    scene: &mut Scene,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Vec<[f64; 3]>> {
    let usual = arguments.height.unwrap_or(OBSERVER_HEIGHT);
    let mut rows: Vec<([f64; 3], f64)> = Vec::new();
    for place in &arguments.eye {
        let ([x, y], z) = (place.0, place.1);
        rows.push((local(&scene.cloud, [x, y, z.unwrap_or(f64::NAN)]), usual));
    }
    if let Some(path) = &arguments.eyes {
        for row in read_observers(path, &scene.cloud.frame.crs, RowsAre::Places)? {
            let height = row.height.unwrap_or(usual);
            let place = |corner: &[f64; 3]| std::array::from_fn(|i| corner[i] - scene.cloud.frame.origin[i]);
            rows.extend(row.corners.iter().map(|corner| (place(corner), height)));
        }
    }
    let grounded: Vec<[f64; 2]> = rows.iter().filter(|row| row.0[2].is_nan()).map(|row| [row.0[0], row.0[1]]).collect();
    if !grounded.is_empty() {
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, start: f64| {
            grounded.iter().map(|place| place[axis]).fold(start, pick)
        };
        let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY) - MARGIN);
        let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY) + MARGIN);
        let origin = [scene.cloud.frame.origin[0], scene.cloud.frame.origin[1]];
        let grid = flagged("--observer", MapGrid::covering(low, high, cell_for(low, high), origin))?;
        let (cloud, points) = sights::ground_cloud(&arguments.ground, scene, stages)?;
        let ground = sights::ground(&cloud, points, grid, stages, summary)?;
        for (number, (place, height)) in rows.iter_mut().enumerate().filter(|(_, row)| row.0[2].is_nan()) {
            let Some(level) = ground.height_at([place[0], place[1]]) else {
                let [x, y, _] = sights::file(&cloud, *place);
                bail!(
                    "eye {} at {x:.3},{y:.3}: the ground below is unknown; is the position in the coordinates of the cloud? If so, give its height as a third number",
                    number + 1
                );
            };
            place[2] = level + *height;
        }
    }
    if let Some((place, _)) = rows.iter().find(|(place, _)| !place.iter().all(|v| v.is_finite())) {
        return Err(Usage(format!("--observer, --observer-height: the eye is at {place:?}, but must be finite")).into());
    }
    Ok(rows.into_iter().map(|row| row.0).collect())
}

/// Reports on eyes that are inside what the cloud takes for solid.
pub(super) fn note_enclosed(blockers: &MedialScene, eyes: &[[f64; 3]], summary: &mut Summary) {
    let note =
        |(number, &eye): (usize, &[f64; 3])| sights::enclosure_note(blockers, eye, &format!("eye {}", number + 1));
    let mut notes: Vec<String> = eyes.iter().enumerate().filter_map(note).collect();
    if notes.len() > MOST_NOTES {
        let more = format!("and {} more notes of this type", notes.len() - MOST_NOTES);
        notes.truncate(MOST_NOTES);
        notes.push(more);
    }
    summary.add("notes", notes);
}

/// Whether the points of the scene are needed for the ground below eyes.
pub(super) fn needs_ground(arguments: &Eyes) -> bool {
    arguments.eyes.is_some() || arguments.eye.iter().any(|place| place.1.is_none())
}
