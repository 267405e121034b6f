//! Eyes of isovists and horizons: from flags and files to places.

use crate::arguments::{EyesArguments, FarTerrainArguments, MapPosition, SceneInput};
use crate::outputs::formats::extension;
use crate::pipeline::{self, KeepPoints, ScenePart};
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::{self, Standing, remark_on_unused};
use belvedere::io::{ObserverRow, ObserverRows, RowsAre, TextRows, read_observers, read_table};
use belvedere::{Bounds, Frame};
use std::path::Path;

impl EyesArguments {
    /// Returns the minimum number of observers.
    pub(crate) fn min_count(&self) -> Result<usize> {
        min_count(self.eye.len(), self.eyes.as_deref())
    }

    /// The observers that were typed or are in the file named.
    pub(crate) fn standing(
        &self,
        (frame, bounds): (&Frame, &Bounds),
        run: &mut CommandContext,
    ) -> Result<Vec<Standing>> {
        let typed = |&MapPosition(place, z): &MapPosition| Standing::on_map(place, z, frame, bounds);
        let mut standing: Vec<Standing> = self.eye.iter().map(typed).collect::<belvedere::Result<_>>()?;
        if let Some(path) = &self.eyes {
            standing.extend(standing_rows(path, frame, run)?);
        }
        Ok(standing)
    }

    /// The scene around the observers, or the part of it that the question needs, before far terrain if there is any.
    pub(crate) fn scene(
        &self,
        input: &SceneInput,
        part: Option<ScenePart<'_>>,
        far: Option<&FarTerrainArguments>,
        run: &mut CommandContext,
    ) -> Result<ask::Scene> {
        let needs_ground = self.eyes.is_some() || self.eye.iter().any(|place| place.1.is_none());
        let points = if needs_ground { KeepPoints::Keep } else { KeepPoints::LetGo };
        let mut scene = pipeline::scene_in_reach(input, part, points, run)?;
        if let Some(far) = far {
            far.set(&mut scene, run)?;
        }
        scene.into_question_scene(needs_ground.then_some(&self.ground), None, run)
    }
}

/// Use of observers in a file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ObserverUse {
    /// Positions only.
    Places,
    /// And how far and where they look.
    Limits,
}

/// The observers of a file in local metres, with a remark on what of it is not used.
pub(crate) fn observer_rows(
    path: &Path,
    frame: &Frame,
    rows_are: RowsAre,
    needed: ObserverUse,
    run: &mut CommandContext,
) -> Result<Vec<ObserverRow>> {
    let ObserverRows { mut rows, unused, limits } = read_observers(path, &frame.crs, rows_are)?;
    let limits = if needed == ObserverUse::Places { &limits[..] } else { &[] };
    run.summary.remarks(remark_on_unused(&path.display().to_string(), &unused, limits));
    let corners = rows.iter_mut().flat_map(|row| &mut row.corners);
    corners.for_each(|corner| *corner = std::array::from_fn(|axis| corner[axis] - frame.origin[axis]));
    Ok(rows)
}

/// The observers of a file, at each corner of its shapes.
pub(crate) fn standing_rows(path: &Path, frame: &Frame, run: &mut CommandContext) -> Result<Vec<Standing>> {
    let rows = observer_rows(path, frame, RowsAre::Places, ObserverUse::Places, run)?;
    let standing = |row: ObserverRow| row.corners.into_iter().map(move |place| Standing { place, height: row.height });
    Ok(rows.into_iter().flat_map(standing).collect())
}

/// Returns the minimum number of observers: those typed, or the rows of a table; one for other files.
pub(crate) fn min_count(typed: usize, observers: Option<&Path>) -> Result<usize> {
    Ok(typed.max(rows_as_given(observers)?.row_count()).max(1))
}

/// The rows of a table of observers as they were given; none for other files and for observers that were typed.
pub(crate) fn rows_as_given(observers: Option<&Path>) -> Result<TextRows> {
    match observers.filter(|path| ["csv", "txt"].contains(&extension(path).as_str())) {
        Some(path) => Ok(read_table(path)?.into_text()),
        None => Ok(TextRows::default()),
    }
}
