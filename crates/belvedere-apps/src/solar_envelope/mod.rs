//! The solar envelope: the largest volume over a parcel that casts no shadow on protected pieces, at any of the suns.
//!
//! A sun at elevation e shades the place g up to the height h − d tan e from an object of height h that stands d metres
//! toward the sun. To keep g in the sun, h may be at most z(g) + d tan e. A protected edge swept toward the sun makes a
//! strip in plan, over which that bound is linear. The minimum over a column of the grid is found in closed form,
//! without sampling the line or marching.

mod blocks;
mod convex;
mod instants;
mod parcel;
mod protected;
mod strip;

pub use convex::ConvexPolygon;
pub(crate) use instants::check_hours;
pub use instants::{EnvelopeSun, envelope_suns};
pub use parcel::{Parcel, ParcelCell};
pub(crate) use protected::check_fence;
pub use protected::{ProtectedPiece, protected_faces, protected_line};

use belvedere_core::ground::{Ground, MapGrid};
use belvedere_core::query::{MedialScene, VisibilityMatrix};
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::raster::Raster;
use belvedere_data::vector::{dot, length, to_f32};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use strip::ShadingStrip;

/// A sun that stands this near to the zenith shades nothing beside a thing: cosine of its elevation.
const OVERHEAD: f64 = 1e-9;
/// Maximum number of pairs of a protected piece and a sun: some minutes of work.
const MAX_PAIRS: usize = 200_000_000;

/// Bounds of an envelope besides the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
#[non_exhaustive]
pub struct EnvelopeParams {
    /// Maximum height above the ground, metres, above 0: the limit of zoning. Default `None`: columns that no sun
    /// bounds are infinitely high.
    pub ceiling: Option<f64>,
}

belvedere_data::setters!(EnvelopeParams {
    with_ceiling(ceiling: Option<f64>),
});

impl EnvelopeParams {
    /// Checks these parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a ceiling that is not above zero.
    pub fn validate(&self) -> Result<()> {
        match self.ceiling {
            Some(ceiling) if !(ceiling > 0.0 && ceiling.is_finite()) => {
                Err(Error::invalid(Parameter::MaxHeight, ceiling, "above zero metres"))
            }
            _ => Ok(()),
        }
    }
}

/// A solar envelope over the cells of a grid.
#[derive(Clone, Debug)]
pub struct SolarEnvelope {
    /// Position of the cells.
    pub grid: MapGrid,
    /// The columns, in the order of their cells.
    pub columns: Vec<EnvelopeColumn>,
    /// Counts of suns and of pairs left out.
    pub report: EnvelopeReport,
}

/// Envelope over the part of a cell that lies on the parcel.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvelopeColumn {
    /// The part of the cell.
    pub footprint: ParcelCell,
    /// Height of the ground in the middle of the cell, local metres.
    pub ground: f64,
    /// Height of the envelope, local metres, the ground at least; infinite where nothing bounds it. It holds over the
    /// whole footprint, so that the columns together shade nothing.
    pub top: f64,
    /// Bound of the column; `None` for the ceiling, or no bound.
    pub binding: Option<Binding>,
}

impl EnvelopeColumn {
    /// Height above the ground, metres.
    #[must_use]
    pub fn height(&self) -> f64 {
        self.top - self.ground
    }
}

/// Bound of a column: the first of those that bound it equally.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Row of the protected piece.
    pub piece: usize,
    /// Row of the sun.
    pub sun: usize,
}

/// Counts of suns and of pairs left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnvelopeReport {
    /// Suns at or below the horizon, which shade nothing.
    pub sun_below_horizon_count: usize,
    /// Pairs of a piece and a sun above the horizon.
    pub pair_count: usize,
    /// Pairs whose face is turned away from the sun.
    pub turned_away_count: usize,
    /// Pairs that something shades already, which was credited.
    pub shaded_already_count: usize,
    /// Cells of the parcel below which no ground is known: they have no column.
    pub without_ground_count: usize,
}

/// Computes the solar envelope of `parcel` over the cells of `ground`. It keeps the sun for each piece of `protected`
/// at each of `suns`, (S, 3) unit vectors from the scene to the sun (x east, y grid north, z up).
///
/// Each column is bounded by the least bound over its whole footprint: nothing built within the columns shades a
/// protected piece, and no column can be raised without that. Where a bound lies below the ground nothing may be built,
/// and the height is 0. Protected edges that only touch a column from beside do not bound it.
///
/// `free`, a row for each piece's sample and a column for each sun, credits existing shade. Where it is not free, the
/// piece is in shade at that sun, and the pair bounds nothing.
///
/// # Errors
/// - [`Error::InvalidParameter`] for a sun that is not of unit length, a piece that is not finite, a ceiling that is
///   not above zero, and more than 200 million pairs.
/// - [`Error::LengthMismatch`] if `free` has other rows and columns.
/// - [`Error::NoPoints`] if no ground is known below the parcel.
/// - [`Error::Cancelled`].
///
/// # Source
/// Knowles 2003, The solar envelope: its meaning for energy and buildings, Energy and Buildings 35.
pub fn solar_envelope(
    parcel: &Parcel,
    ground: &Ground,
    protected: &[ProtectedPiece],
    suns: &[[f64; 3]],
    free: Option<&VisibilityMatrix>,
    params: &EnvelopeParams,
    control: &Control<'_>,
) -> Result<SolarEnvelope> {
    check(protected, suns, free, params)?;
    let grid = ground.grid;
    let mut report = EnvelopeReport::default();
    let mut columns: Vec<EnvelopeColumn> = Vec::new();
    for footprint in parcel.footprints(&grid) {
        let height = ground.heights.values().get(footprint.cell).copied().filter(|h| h.is_finite());
        match height.map(f64::from) {
            None => report.without_ground_count += 1,
            Some(ground) => {
                let top = params.ceiling.map_or(f64::INFINITY, |ceiling| ground + ceiling);
                columns.push(EnvelopeColumn { footprint, ground, top, binding: None });
            }
        }
    }
    if columns.is_empty() {
        let what = "the ground below the parcel is unknown; is the parcel in the coordinates of the cloud, and inside the cloud?";
        return Err(Error::NoPoints { what: what.to_owned() });
    }
    for (sun, &direction) in suns.iter().enumerate() {
        if !(direction[2] > 0.0) {
            report.sun_below_horizon_count += 1;
            continue;
        }
        report.pair_count += protected.len();
        let strips =
            strips(protected, direction, |piece| free.is_none_or(|free| free.is_free(piece, sun)), &mut report);
        let mut rows: Vec<&mut [EnvelopeColumn]> =
            columns.chunk_by_mut(|a, b| a.footprint.cell / grid.width == b.footprint.cell / grid.width).collect();
        rows.par_iter_mut().try_for_each(|row| {
            control.check()?;
            bound(row, &grid, &strips, sun);
            Ok(())
        })?;
        control.advance(1);
    }
    for column in &mut columns {
        column.top = column.top.max(column.ground);
    }
    Ok(SolarEnvelope { grid, columns, report })
}

/// Computes which of `suns` each of `protected` sees in `scene`: the existing shade, for [`solar_envelope`] to credit.
/// It has at most 200 million bits. Progress counts pieces.
///
/// # Errors
/// [`Error::InvalidParameter`] for more than 200 million pairs, and those of [`MedialScene::visibility_matrix`].
pub fn existing_shade(
    scene: &MedialScene,
    protected: &[ProtectedPiece],
    suns: &[[f64; 3]],
    control: &Control<'_>,
) -> Result<VisibilityMatrix> {
    check_pairs(protected.len(), suns.len())?;
    let samples: Vec<[f32; 3]> = protected.iter().map(|piece| piece.sample).collect();
    scene.visibility_matrix(&samples, suns, control)
}

fn check_pairs(pieces: usize, suns: usize) -> Result<()> {
    if pieces.saturating_mul(suns) <= MAX_PAIRS {
        return Ok(());
    }
    let expected = "at most 200 million; use longer time steps, or a larger spacing";
    Err(Error::invalid(Parameter::ProtectedPairs, format!("{pieces} x {suns}"), expected))
}

/// The strips of the protected edges that a sun above the horizon lights, each with the row of its piece.
fn strips(
    protected: &[ProtectedPiece],
    direction: [f64; 3],
    is_free: impl Fn(usize) -> bool,
    report: &mut EnvelopeReport,
) -> Vec<(ShadingStrip, usize)> {
    let across = direction[0].hypot(direction[1]);
    let to_sun = [direction[0] / across, direction[1] / across];
    let slope = direction[2] / across;
    let mut strips = Vec::new();
    for (number, piece) in protected.iter().enumerate() {
        if piece.normal.is_some_and(|normal| dot(normal, direction) <= 0.0) {
            report.turned_away_count += 1;
            continue;
        }
        if !is_free(number) {
            report.shaded_already_count += 1;
            continue;
        }
        if across < OVERHEAD {
            continue;
        }
        let mut add = |a, b| strips.push((ShadingStrip::new(a, b, to_sun, slope), number));
        // over a face the bound is linear too, hence least on its border
        match piece.corners[..] {
            [a] => add(a, a),
            [a, b] => add(a, b),
            [a, b, c] => [[a, b], [b, c], [c, a]].into_iter().for_each(|[a, b]| add(a, b)),
            _ => {}
        }
    }
    strips
}

/// Lowers the columns of one row of cells to the limits of the strips of a sun.
fn bound(columns: &mut [EnvelopeColumn], grid: &MapGrid, strips: &[(ShadingStrip, usize)], sun: usize) {
    let (Some(first), Some(last)) = (columns.first(), columns.last()) else { return };
    let column_of = |column: &EnvelopeColumn| column.footprint.cell % grid.width;
    let row = first.footprint.cell / grid.width;
    let [west, south] = grid.corner_at([column_of(first), row + 1]);
    let [east, north] = grid.corner_at([column_of(last) + 1, row]);
    let band = ConvexPolygon::of_box([west, south], [east, north]);
    let edges: Vec<f64> = columns.iter().map(|column| grid.corner_at([column_of(column), row])[0]).collect();
    for &(strip, piece) in strips {
        let Some([min, max]) = strip.span_x(&band) else { continue };
        let from = edges.partition_point(|west| west + grid.cell < min);
        let to = edges.partition_point(|west| *west <= max);
        for column in columns.get_mut(from..to).unwrap_or_default() {
            let limit = column.footprint.pieces.iter().filter_map(|piece| strip.limit(piece)).reduce(f64::min);
            if let Some(limit) = limit.filter(|limit| *limit < column.top) {
                column.top = limit;
                column.binding = Some(Binding { piece, sun });
            }
        }
    }
}

fn check(
    protected: &[ProtectedPiece],
    suns: &[[f64; 3]],
    free: Option<&VisibilityMatrix>,
    params: &EnvelopeParams,
) -> Result<()> {
    if let Some(sun) = suns.iter().find(|sun| !((length(**sun) - 1.0).abs() < 1e-6)) {
        return Err(Error::invalid(Parameter::SunDirection, format!("{sun:?}"), "a vector of length 1"));
    }
    let finite = |piece: &&ProtectedPiece| !piece.corners.as_flattened().iter().all(|v| v.is_finite());
    if let Some(piece) = protected.iter().find(finite) {
        return Err(Error::invalid(Parameter::ProtectedPlace, format!("{:?}", piece.corners), "finite"));
    }
    params.validate()?;
    check_pairs(protected.len(), suns.len())?;
    let Some(free) = free else { return Ok(()) };
    check_length("shade of protected pieces", protected.len(), free.target_count())?;
    check_length("shade at suns", suns.len(), free.direction_count())
}

impl SolarEnvelope {
    /// Height above the ground of each cell, metres; NaN beside the parcel, infinite where nothing bounds it.
    #[must_use]
    pub fn heights(&self) -> Raster<f32> {
        self.raster(EnvelopeColumn::height)
    }

    /// Height of the envelope in each cell above where heights of the system of the cloud count from, metres:
    /// `origin_height` is that of the local origin. NaN beside the parcel, infinite where nothing bounds it.
    #[must_use]
    pub fn tops(&self, origin_height: f64) -> Raster<f32> {
        self.raster(|column| column.top + origin_height)
    }

    fn raster(&self, value: impl Fn(&EnvelopeColumn) -> f64) -> Raster<f32> {
        let mut raster = Raster::filled(self.grid.width, self.grid.height, f32::NAN);
        for column in &self.columns {
            if let Some(cell) = raster.values_mut().get_mut(column.footprint.cell) {
                *cell = to_f32(value(column));
            }
        }
        raster
    }

    /// Volume between the ground and the envelope, m³; infinite where a column is.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.columns.iter().map(|column| column.footprint.area * column.height()).sum()
    }

    /// Area of the columns, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.columns.iter().map(|column| column.footprint.area).sum()
    }

    /// Returns the maximum height above the ground, metres; 0 without columns.
    #[must_use]
    pub fn greatest_height(&self) -> f64 {
        self.columns.iter().map(EnvelopeColumn::height).fold(0.0, f64::max)
    }

    /// For each of `count` keys the area of the columns whose binding has it, m².
    #[must_use]
    pub fn bound_areas(&self, count: usize, key: impl Fn(Binding) -> usize) -> Vec<f64> {
        let mut areas = vec![0.0; count];
        for (binding, area) in self.columns.iter().filter_map(|c| Some((c.binding?, c.footprint.area))) {
            if let Some(sum) = areas.get_mut(key(binding)) {
                *sum += area;
            }
        }
        areas
    }
}
