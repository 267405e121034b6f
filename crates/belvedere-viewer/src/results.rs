//! Results of commands beside the cloud: points and cells with values, and shapes on the ground.

use crate::chunks::{STEPS, to_steps};
use crate::replies::QuestionReply;
use crate::scene::PageScene;
use belvedere::apps::ask::scene::KnownGround;
use belvedere::cast::{to_index, to_u8};
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::io::{FeatureShape, Georeference, MapFeature, PlacedRaster, PointResults};
use belvedere::{Bounds, Error, Frame, Result};
use serde_json::{Value, json};
use std::path::Path;

/// Byte of a value that is none.
const NONE: u8 = 255;
/// Byte of the greatest value.
const GREATEST: f32 = 253.0;
/// Maximum number of cells of a raster that are sent; larger rasters are thinned to every second, third … row and
/// column.
const MAX_CELLS: usize = 4_000_000;
/// Height above the ground at which cells are drawn, metres: above the scatter of points. Lines are drawn above cells.
const ABOVE: f64 = 0.15;
const LINES_ABOVE: f64 = 0.6;
/// Piece of a line that follows the ground, metres, and most of them.
const PIECE: f64 = 2.0;
const MAX_PIECES: f64 = 1e4;
/// Height of a pin that marks a point, metres.
const PIN: f64 = 4.0;

/// Points that have results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointsOf {
    /// The cloud that is shown: its columns can be chosen.
    Cloud,
    /// A file beside it, which is shown at once.
    Other,
}

/// Contents of a file of results, local metres in plan.
pub(crate) enum ResultsFile {
    Points { positions: Vec<[f32; 3]>, columns: Vec<(String, Vec<f32>)> },
    Cells(Box<PlacedRaster>),
    Shapes(Vec<FeatureShape>),
}

/// A file of results.
pub(crate) struct ResultFile {
    name: String,
    results: ResultsFile,
    /// True if it is shown before anybody chooses it.
    is_shown_first: bool,
}

impl ResultFile {
    /// Points with values, in the coordinates of the file of the scene.
    ///
    /// # Errors
    /// [`Error::Malformed`] for points that all lie beside the scene.
    pub(crate) fn of_points(
        path: &Path,
        (results, points): (PointResults, PointsOf),
        frame: &Frame,
        bounds: &Bounds,
    ) -> Result<Self> {
        check_places(path, results.places.iter().map(|&place| frame.local_from_file(place)), bounds)?;
        let local = |&place: &[f64; 3]| to_local(frame.local_from_file(place), [0.0; 3]);
        let positions = results.places.iter().map(local).collect();
        let results = ResultsFile::Points { positions, columns: results.columns };
        Ok(Self { name: name_of(path), results, is_shown_first: points == PointsOf::Other })
    }

    /// A raster that lies on the map.
    ///
    /// # Errors
    /// [`Error::Malformed`] for one that says nothing of its place or lies beside the scene, and [`Error::UnusableCrs`]
    /// for one in another system.
    pub(crate) fn of_raster(path: &Path, raster: PlacedRaster, frame: &Frame, bounds: &Bounds) -> Result<Self> {
        let Some(place) = &raster.place else {
            return Err(Error::malformed(path, "does not say where it lies on the map: write it as a GeoTIFF"));
        };
        place.crs.check_for(&frame.crs, "raster", path)?;
        let size = [raster.values.width(), raster.values.height()];
        let all = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| [column, row]));
        check_places(path, all.map(|cell| center(place, cell, frame)).map(|[x, y]| [x, y, 0.0]), bounds)?;
        Ok(Self { name: name_of(path), results: ResultsFile::Cells(Box::new(raster)), is_shown_first: true })
    }

    /// Shapes in absolute metres.
    ///
    /// # Errors
    /// [`Error::Malformed`] for shapes that all lie beside the scene.
    pub(crate) fn of_shapes(path: &Path, features: Vec<MapFeature>, frame: &Frame, bounds: &Bounds) -> Result<Self> {
        let shapes: Vec<FeatureShape> = features.into_iter().map(|feature| feature.shape).collect();
        let corners = shapes.iter().flat_map(|shape| match shape {
            FeatureShape::Point(place) => vec![*place],
            FeatureShape::Line(corners) => corners.clone(),
            FeatureShape::Polygon(rings) => rings.concat(),
        });
        check_places(path, corners.map(|corner| std::array::from_fn(|i| corner[i] - frame.origin[i])), bounds)?;
        Ok(Self { name: name_of(path), results: ResultsFile::Shapes(shapes), is_shown_first: false })
    }

    /// Describes it for the menu of the page.
    pub(crate) fn describe(&self) -> Value {
        let columns: Vec<&str> = match &self.results {
            ResultsFile::Points { columns, .. } => columns.iter().map(|(name, _)| name.as_str()).collect(),
            ResultsFile::Cells(_) => vec![""],
            ResultsFile::Shapes(_) => Vec::new(),
        };
        json!({ "name": self.name, "columns": columns, "covers_cloud": matches!(self.results, ResultsFile::Points { .. }), "is_shown_first": self.is_shown_first })
    }

    /// Places and values, or lines. Places without a height lie on the ground of the scene.
    pub(crate) fn drawn(&self, scene: &PageScene, control: &Control<'_>) -> Result<QuestionReply> {
        let on_ground = OnGround { ground: scene.ground(control).ok(), low: f64::from(scene.model().bounds().low[2]) };
        let frame = scene.model().frame();
        match &self.results {
            ResultsFile::Points { positions, columns } => Ok(layer(positions, columns, None)),
            ResultsFile::Cells(raster) => Ok(cells(raster, frame, &on_ground)),
            ResultsFile::Shapes(shapes) => {
                let segments = shapes.iter().flat_map(|shape| segments(shape, frame, &on_ground));
                let body: Vec<u8> =
                    segments.flatten().flat_map(|place| to_local(place, [0.0; 3])).flat_map(f32::to_le_bytes).collect();
                Ok(QuestionReply { head: json!({ "lines": body.len() / 24 }), body })
            }
        }
    }
}

/// Refuses results whose places, local metres, all lie on one side of the scene.
fn check_places(path: &Path, places: impl Iterator<Item = [f64; 3]>, bounds: &Bounds) -> Result<()> {
    let (low, high) = bounds.on_map();
    let mut extent = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for place in places {
        extent[0] = [0, 1].map(|i| extent[0][i].min(place[i]));
        extent[1] = [0, 1].map(|i| extent[1][i].max(place[i]));
    }
    if (0..2).all(|i| extent[0][i] <= high[i] && extent[1][i] >= low[i]) {
        return Ok(());
    }
    Err(Error::malformed(path, "lies beside the cloud: give results of the same place, in the same reference system"))
}

/// The middle of a cell, local metres.
fn center(place: &Georeference, cell: [usize; 2], frame: &Frame) -> [f64; 2] {
    let [across, down] = cell.map(|index| index as f64 + 0.5);
    let at = |i: usize| place.upper_left[i] + across * place.column_step[i] + down * place.row_step[i];
    let [x, y, _] = frame.local_from_file([at(0), at(1), 0.0]);
    [x, y]
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Heights of the ground, local metres.
struct OnGround {
    ground: Option<std::sync::Arc<KnownGround>>,
    low: f64,
}

impl OnGround {
    fn height(&self, [x, y]: [f64; 2]) -> f64 {
        let height = self.ground.as_ref().and_then(|ground| ground.ground.height_at([x, y]));
        height.map_or(self.low, f64::from)
    }
}

fn cells(raster: &PlacedRaster, frame: &Frame, on_ground: &OnGround) -> QuestionReply {
    let Some(place) = &raster.place else { return layer(&[], &[], None) };
    let (width, height) = (raster.values.width(), raster.values.height());
    let stride = (1..).find(|stride| width.div_ceil(*stride) * height.div_ceil(*stride) <= MAX_CELLS).unwrap_or(1);
    let (mut positions, mut values) = (Vec::new(), Vec::new());
    for row in (0..height).step_by(stride) {
        for column in (0..width).step_by(stride) {
            let Some(value) = raster.values.get(column, row).filter(|value| value.is_finite()) else { continue };
            let [x, y] = center(place, [column, row], frame);
            positions.push(to_local([x, y, on_ground.height([x, y]) + ABOVE], [0.0; 3]));
            values.push(value);
        }
    }
    let size = place.column_step[0].hypot(place.column_step[1]) * frame.crs.metres_per_unit * stride as f64;
    layer(&positions, &[(String::new(), values)], Some(size))
}

/// Eight bytes for each point as chunks have them, and a byte for the value of each column: 0 for the least, 253 for
/// the greatest, 255 for none.
fn layer(positions: &[[f32; 3]], columns: &[(String, Vec<f32>)], size: Option<f64>) -> QuestionReply {
    let end = |pick: fn(f32, f32) -> f32, start: f32| {
        positions.iter().fold([start; 3], |end, place| std::array::from_fn(|i| pick(end[i], place[i])))
    };
    let (low, high) = (end(f32::min, f32::INFINITY), end(f32::max, f32::NEG_INFINITY));
    let step: [f32; 3] = std::array::from_fn(|i| ((high[i] - low[i]) / STEPS).max(1e-6));
    let mut body = Vec::with_capacity(positions.len() * (8 + columns.len()));
    for place in positions {
        for axis in 0..3 {
            body.extend(to_steps(((place[axis] - low[axis]) / step[axis]).round()).to_le_bytes());
        }
        body.extend([0, 0]);
    }
    let mut described = Vec::new();
    for (name, values) in columns {
        let finite = values.iter().copied().filter(|value| value.is_finite());
        let [min, greatest] = finite.clone().fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        // answers are codes of their own
        let are_codes = min >= 0.0 && greatest <= 4.0 && finite.into_iter().all(|value| value.fract() == 0.0);
        let (from, to) = if are_codes { (0.0, GREATEST) } else { (min, greatest.max(min + f32::MIN_POSITIVE)) };
        body.extend(values.iter().map(|&value| {
            let byte = to_u8(f64::from(((value - from) / (to - from) * GREATEST).round()));
            if value.is_finite() { byte } else { NONE }
        }));
        described.push(json!({
            "name": name,
            "are_codes": are_codes,
            "least": min.is_finite().then_some(min),
            "greatest": greatest.is_finite().then_some(greatest),
        }));
    }
    let head = json!({ "count": positions.len(), "low": low, "step": step, "size_m": size, "columns": described });
    QuestionReply { head, body }
}

/// The lines that draw a shape, local metres: pairs of ends. Lines without heights follow the ground, points stand on
/// it as pins.
fn segments(shape: &FeatureShape, frame: &Frame, on_ground: &OnGround) -> Vec<[[f64; 3]; 2]> {
    let local = |place: &[f64; 3]| {
        let [x, y, z] = std::array::from_fn(|i| place[i] - frame.origin[i]);
        [x, y, if z.is_finite() { z } else { on_ground.height([x, y]) }]
    };
    match shape {
        FeatureShape::Point(place) => {
            let [x, y, z] = local(place);
            let top = [x, y, z + PIN];
            let bar = |dx: f64, dy: f64| [[x - dx, y - dy, z + PIN], [x + dx, y + dy, z + PIN]];
            vec![[[x, y, z], top], bar(0.4, 0.0), bar(0.0, 0.4)]
        }
        FeatureShape::Line(corners) => line(corners, &local, on_ground),
        FeatureShape::Polygon(rings) => rings.iter().flat_map(|ring| line(ring, &local, on_ground)).collect(),
    }
}

fn line(corners: &[[f64; 3]], local: &dyn Fn(&[f64; 3]) -> [f64; 3], on_ground: &OnGround) -> Vec<[[f64; 3]; 2]> {
    let mut found = Vec::new();
    for pair in corners.windows(2) {
        let [a, b] = [&pair[0], &pair[1]].map(local);
        let is_flat = pair.iter().any(|corner| !corner[2].is_finite());
        let count = if is_flat {
            to_index(((b[0] - a[0]).hypot(b[1] - a[1]) / PIECE).ceil().clamp(1.0, MAX_PIECES))
        } else {
            1
        };
        let at = |part: usize| -> [f64; 3] {
            let share = part as f64 / count as f64;
            let [x, y, z] = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
            [x, y, if is_flat { on_ground.height([x, y]) } else { z } + LINES_ABOVE]
        };
        found.extend((0..count).map(|part| [at(part), at(part + 1)]));
    }
    found
}
