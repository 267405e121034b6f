//! Obstacles beside the surveyed ones: planned buildings, and mountains beyond the survey.

use crate::inputs::{absolute, hash};
use belvedere::apps::horizon::convergence;
use belvedere::crs::Crs;
use belvedere::io::{Source, read_horizon, read_mesh_in, read_terrain};
use belvedere::model::check_terrain;
use belvedere::query::{BlockingTriangles, Coverage, FarTerrain};
use belvedere::{Bounds, Error, Frame, Mesh, Result};
use serde::{Deserialize, Serialize};
use std::io::Read;
use std::path::{Path, PathBuf};

/// File beside the survey, in its state when the plan was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SideFile {
    path: PathBuf,
    /// CRC-32 of its bytes, as hexadecimal digits.
    fingerprint: String,
}

impl SideFile {
    /// Returns a file in its present state.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a folder.
    pub fn new(path: &Path) -> Result<Self> {
        if path.is_dir() {
            return Err(Error::malformed(path, "is a folder; give a file"));
        }
        let path = absolute(path)?;
        let fingerprint = hash(&bytes_of(&path)?);
        Ok(Self { path, fingerprint })
    }

    /// Returns the path of the file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns its bytes, and refuses a changed file.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a file that changed after the plan was made.
    pub(crate) fn read(&self) -> Result<Vec<u8>> {
        let bytes = bytes_of(&self.path)?;
        if hash(&bytes) != self.fingerprint {
            let what = "is no longer what it was when the plan was made; make the plan again";
            return Err(Error::malformed(&self.path, what));
        }
        Ok(bytes)
    }

    fn mesh(&self, crs: &Crs) -> Result<Mesh> {
        Ok(read_mesh_in(Source::bytes(&self.path, &self.read()?), crs)?.0)
    }
}

fn bytes_of(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    Source::path(path).into_reader()?.0.read_to_end(&mut bytes).map_err(Error::io(path))?;
    Ok(bytes)
}

/// Obstacles beside the surveyed ones.
pub(crate) struct Others {
    pub(crate) added: Option<BlockingTriangles>,
    pub(crate) far_terrain: FarTerrain,
}

impl Others {
    /// Returns no other obstacles.
    pub(crate) fn none() -> Self {
        Self { added: None, far_terrain: FarTerrain::default() }
    }
}

/// Returns the terrain beyond the box `survey`, local metres of `frame`: an elevation raster and a horizon, if given.
///
/// # Errors
/// Those of [`SideFile::read`], of [`read_terrain`], [`read_horizon`] and [`check_terrain`].
pub(crate) fn far_terrain(
    terrain: Option<&SideFile>,
    horizon: Option<&SideFile>,
    frame: &Frame,
    survey: Bounds,
) -> Result<FarTerrain> {
    let mut far = FarTerrain::default();
    if let Some(file) = terrain {
        let grid = read_terrain(Source::bytes(&file.path, &file.read()?), frame)?;
        check_terrain(&grid, &file.path.display().to_string(), survey, frame)?;
        far = far.with_grid(grid, Some(survey.on_map()));
    }
    if let Some(file) = horizon {
        let horizon = read_horizon(Source::bytes(&file.path, &file.read()?))?;
        let (low, high) = survey.on_map();
        let middle = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]) + frame.origin[axis]);
        far = far.with_profile(horizon.turned(-convergence(&frame.crs, middle).unwrap_or(0.0)));
    }
    Ok(far)
}

/// Returns the triangles of `meshes` in local metres of `frame`; `None` without a mesh. The triangles must meet the
/// space of `coverage`.
///
/// # Errors
/// Those of [`SideFile::read`], of [`read_mesh_in`] and of [`BlockingTriangles::new`].
pub(crate) fn added_meshes(
    meshes: &[SideFile],
    frame: &Frame,
    coverage: Option<&Coverage>,
) -> Result<Option<BlockingTriangles>> {
    let mut added = None;
    for file in meshes {
        let mesh = file.mesh(&frame.crs)?;
        let name = file.path.display().to_string();
        added = Some(BlockingTriangles::new(&mesh, &name, frame.origin, coverage, added.as_ref())?);
    }
    Ok(added)
}
