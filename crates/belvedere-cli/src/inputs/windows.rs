//! Windows: from files to places.

use crate::arguments::{refuse, refuse_given};
use crate::inputs::landmark_shape::objects_of;
use crate::outputs::formats::extension;
use crate::pipeline::mesh_in;
use crate::run::CommandContext;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::apps::ask::{GivenWindow, GivenWindows, SharedObject};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::apps::targets::Window;
use belvedere::io::{TextRows, is_mesh, read_table};
use std::path::Path;

/// Choice of the faces of a mesh that are windows, and their division.
#[derive(Default)]
pub(crate) struct FaceChoice<'a> {
    /// Longest side of a piece, metres.
    pub(crate) spacing: Option<f64>,
    /// Names of objects; all where none is named.
    pub(crate) objects: &'a [String],
}

/// Windows of a file as it gives them.
pub(crate) struct WindowFile {
    pub(crate) given: GivenWindows,
    /// Columns of the table of windows.
    columns: Vec<ResultColumn>,
    /// The rows of a table.
    pub(crate) rows: TextRows,
}

impl WindowFile {
    /// Windows of a table, or the faces of a mesh, in a frame.
    pub(crate) fn read(path: &Path, choice: &FaceChoice<'_>, frame: &Frame, run: &mut CommandContext) -> Result<Self> {
        if is_mesh(path) {
            let mesh = objects_of(mesh_in(path, &frame.crs, run)?, choice.objects, path)?;
            let given = GivenWindows::Faces(SharedObject::new(mesh));
            return Ok(Self { given, columns: Vec::new(), rows: TextRows::default() });
        }
        let of_meshes = [("--spacing", choice.spacing.is_some()), ("--object", !choice.objects.is_empty())];
        refuse_given(&of_meshes, "applies only to windows from a mesh")?;
        if !["csv", "txt"].contains(&extension(path).as_str()) {
            bail!("{}: windows are a table (.csv .txt) or a mesh (.obj .json .ply with faces)", path.display());
        }
        table(path, frame)
    }

    /// Returns true if the building of each window is known.
    pub(crate) fn names_buildings(&self) -> bool {
        match &self.given {
            GivenWindows::Each(_) => !self.buildings(&[]).is_empty(),
            GivenWindows::Faces(mesh) => !mesh.object_names.is_empty(),
        }
    }

    /// The building of each window: what a table calls it, or its object; empty where that is not known.
    pub(crate) fn buildings(&self, objects: &[String]) -> Vec<String> {
        self.column_of_words("name").unwrap_or_else(|| objects.to_vec())
    }

    /// A column of a table as it was given; `None` where there is none of that name.
    pub(crate) fn column_of_words(&self, name: &str) -> Option<Vec<String>> {
        let columns = self.rows.columns(0..self.rows.row_count());
        let (_, cells) = columns.iter().find(|(own, _)| own.eq_ignore_ascii_case(name))?;
        Some(cells.iter().map(|&cell| cell.to_owned()).collect())
    }

    /// Returns the position and properties of each window; the azimuth of grid north is `grid_north`, radians.
    pub(crate) fn columns(&self, windows: &[Window], frame: &Frame, grid_north: f64) -> Vec<ResultColumn> {
        if matches!(self.given, GivenWindows::Each(_)) {
            return self.columns.clone();
        }
        let centers: Vec<[f64; 3]> = windows.iter().map(|window| window.center).collect();
        let column = |name: &str, of: &dyn Fn(&Window) -> f64, decimals| {
            ResultColumn::real(name, windows.iter().map(of), decimals)
        };
        let mut columns = vec![column("face", &|window| window.face.map_or(f64::NAN, f64::from), 0)];
        columns.extend(ResultColumn::coordinates(frame, &centers));
        columns.extend([
            column("azimuth", &|window| (window.azimuth + grid_north).to_degrees().rem_euclid(360.0), 2),
            column("tilt", &|window| window.tilt.to_degrees(), 2),
            column("area_m2", &|window| window.area.unwrap_or(f64::NAN), 4),
        ]);
        columns
    }
}

fn table(path: &Path, frame: &Frame) -> Result<WindowFile> {
    let table = read_table(path)?;
    let full = |name: &str| table.full_column(path, name);
    let (x, y, z, azimuth) = (full("x")?, full("y")?, full("z")?, full("azimuth")?);
    let optional = |name: &str| -> Result<Vec<f64>> {
        let column = table.column(path, name)?;
        Ok((0..table.row_count()).map(|row| column.and_then(|c| c.get(row)).copied().unwrap_or(f64::NAN)).collect())
    };
    let (tilt, width, height) = (optional("tilt")?, optional("width")?, optional("height")?);
    if table.row_count() == 0 {
        bail!("{}: the file has no window", path.display());
    }
    let tilt: Vec<f64> = tilt.into_iter().map(|tilt| if tilt.is_nan() { 90.0 } else { tilt }).collect();
    let window = |row: usize| {
        let size = Some([width[row], height[row]]).filter(|size| size.iter().all(|v| v.is_finite()));
        let place = frame.local_from_file([x[row], y[row], z[row]]);
        GivenWindow { place, azimuth_deg: azimuth[row], tilt_deg: tilt[row], size }
    };
    let given = GivenWindows::Each((0..table.row_count()).map(window).collect());
    let columns = [("x", x, 3), ("y", y, 3), ("z", z, 3), ("azimuth", azimuth, 2), ("tilt", &tilt[..], 2)]
        .map(|(name, values, decimals)| ResultColumn::real(name, values.iter().copied(), decimals));
    Ok(WindowFile { given, columns: columns.to_vec(), rows: table.into_text() })
}

/// Refuses windows that are the faces of a mesh, which are too many to list.
pub(crate) fn refuse_mesh(path: &Path) -> Result<()> {
    match is_mesh(path) {
        true => refuse("--windows: give a table (.csv); `belvedere comfort` takes the faces of a mesh"),
        false => Ok(()),
    }
}
