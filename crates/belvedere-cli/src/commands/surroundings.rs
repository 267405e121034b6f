//! Eyes of isovists and horizons: from flags and files to places.

use super::{extension, sights};
use crate::arguments::{Eyes, GroundChoice};
use crate::pipeline::Scene;
use crate::run::Run;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::Frame;
use belvedere::apps::ask::Standing;
use belvedere::apps::targets::{grid_around, set_on_ground};
use belvedere::apps::viewshed::OBSERVER_HEIGHT;
use belvedere::io::{RowsAre, TextRows, read_observers, read_table};
use belvedere::query::MedialScene;
use std::path::Path;

/// Most notes on eyes that are in something solid.
const MOST_NOTES: usize = 5;

/// The eyes that were typed or are in the file named, local metres.
pub(super) fn eyes(arguments: &Eyes, scene: &mut Scene, run: &mut Run) -> Result<Vec<[f64; 3]>> {
    let usual = arguments.height.unwrap_or(OBSERVER_HEIGHT);
    let mut rows: Vec<([f64; 3], f64)> = Vec::new();
    for place in &arguments.eye {
        let ([x, y], z) = (place.0, place.1);
        rows.push((scene.cloud.frame.local_from_file([x, y, z.unwrap_or(f64::NAN)]), usual));
    }
    if let Some(path) = &arguments.eyes {
        for row in read_observers(path, &scene.cloud.frame.crs, RowsAre::Places)? {
            let height = row.height.unwrap_or(usual);
            let place = |corner: &[f64; 3]| std::array::from_fn(|i| corner[i] - scene.cloud.frame.origin[i]);
            rows.extend(row.corners.iter().map(|corner| (place(corner), height)));
        }
    }
    let coverage = scene.model.coverage();
    // ground is made where there are points: one eye far away would make its cells large for all
    let over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    let grid = grid_around(rows.iter().map(|row| row.0).filter(over), scene.cloud.frame.origin);
    if let Some(grid) = grid? {
        let (cloud, points) = sights::ground_cloud(&arguments.ground, scene, run)?;
        let ground = sights::ground(&cloud, points, grid, run)?;
        set_on_ground(rows.iter_mut().map(|(place, height)| (place, *height)), &ground);
        if matches!(arguments.ground, GroundChoice::OfScene(_)) {
            // a map needs it again
            scene.cloud = cloud;
        }
    }
    Ok(rows.into_iter().map(|row| row.0).collect())
}

impl Eyes {
    /// The eyes that were typed or are in the file named.
    pub(super) fn standing(&self, frame: &Frame) -> Result<Vec<Standing>> {
        let typed = self.eye.iter().map(|place| {
            let ([x, y], z) = (place.0, place.1);
            Standing { place: frame.local_from_file([x, y, z.unwrap_or(f64::NAN)]), height: None }
        });
        let mut standing: Vec<Standing> = typed.collect();
        if let Some(path) = &self.eyes {
            for row in read_observers(path, &frame.crs, RowsAre::Places)? {
                let place = |corner: &[f64; 3]| std::array::from_fn(|i| corner[i] - frame.origin[i]);
                standing.extend(row.corners.iter().map(|c| Standing { place: place(c), height: row.height }));
            }
        }
        Ok(standing)
    }
}

/// How many observers there are at least: those typed, or the rows of a table; one for other files.
pub(super) fn least_count(typed: usize, observers: Option<&Path>) -> Result<usize> {
    Ok(typed.max(rows_as_given(observers)?.row_count()).max(1))
}

/// The rows of a table of observers as they were given; none for other files and for observers that were typed.
pub(super) fn rows_as_given(observers: Option<&Path>) -> Result<TextRows> {
    match observers.filter(|path| ["csv", "txt"].contains(&extension(path).as_str())) {
        Some(path) => Ok(read_table(path)?.into_text()),
        None => Ok(TextRows::default()),
    }
}

/// Skips eyes that cannot look, by making them NaN, and reports on those just inside the surface of an obstacle.
pub(super) fn check_eyes(blockers: &MedialScene, frame: &Frame, eyes: &mut [[f64; 3]], run: &mut Run) -> Result<()> {
    let report = sights::skip_unfit(blockers, None, ("observer", frame), eyes, run)?;
    run.summary.add("observers", Summary::of(&report));
    note_enclosed(blockers, eyes, &mut run.summary);
    Ok(())
}

fn note_enclosed(blockers: &MedialScene, eyes: &[[f64; 3]], summary: &mut Summary) {
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
