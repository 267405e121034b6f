//! What blocks beside what was surveyed: buildings that are planned, and mountains beyond the survey.

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

/// A file beside the survey, as it was when the plan was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SideFile {
    path: PathBuf,
    /// CRC-32 of its bytes, as hexadecimal digits.
    fingerprint: String,
}

impl SideFile {
    /// A file as it is now.
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

    /// Where it lies.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Its bytes, refused unless they are what they were.
    ///
    /// # Errors
    /// [`Error::Io`], and [`Error::Malformed`] for a file that changed since.
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

/// What blocks beside what was surveyed.
pub(crate) struct Others {
    pub(crate) added: Option<BlockingTriangles>,
    pub(crate) far_terrain: FarTerrain,
}

impl Others {
    /// Nothing else blocks.
    pub(crate) fn none() -> Self {
        Self { added: None, far_terrain: FarTerrain::default() }
    }
}

/// What lies beyond a survey between `survey`, local metres of `frame`: an elevation raster and a horizon, where they
/// are given.
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

/// The triangles of `meshes` in local metres of `frame`; `None` without a mesh. They must meet the space of `coverage`.
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
