//! Point clouds: f32 positions relative to an f64 origin, with the attributes a laser file carries as columns.

use crate::vector::box_around;
use std::path::PathBuf;

use crate::crs::Crs;
pub use crate::frame::to_local;
use crate::frame::{Bounds, Frame};
use crate::sky_region::SkyRegion;
use crate::{Error, Parameter, Result};

/// ASPRS class of ground.
pub const GROUND: u8 = 2;

/// A point cloud.
///
/// Positions are metres, x east, y north, z up, relative to the origin of its frame. f32 holds a tenth of a millimetre
/// within a kilometre of the origin, whereas projected coordinates in f32 would be off by centimetres. Every attribute
/// that is present has one value per point.
#[derive(Clone, Debug, Default)]
pub struct PointCloud {
    /// Frame of local positions, with the reference system and unit of the file.
    pub frame: Frame,
    /// Local positions, (N, 3), metres.
    pub positions: Vec<[f32; 3]>,
    /// Further attributes of each point.
    pub attributes: Attributes,
    /// Local positions of the scanner set-ups that [`Attributes::scanner_index`] refers to, (S, 3), metres.
    pub scanner_positions: Vec<[f32; 3]>,
    /// Regions of these set-ups in which pulses met nothing up to the sky, as far as the files have them.
    pub sky_regions: Vec<SkyRegion>,
    /// Places on the map, local metres, that the survey measured and whose points were cleared since, (C, 2): there is
    /// no hole in the survey.
    pub cleared_places: Vec<[f32; 2]>,
    /// The files of the points, for writers that keep columns and records that a cloud does not hold. Empty where
    /// points come from elsewhere.
    pub files: CloudFiles,
}

/// The files that the points of a cloud come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CloudFiles {
    /// The files, in the order of their points.
    pub files: Vec<CloudFile>,
    /// Rows of them that the points are.
    pub rows: FileRows,
}

/// A file of points, with its contents that a cloud has no place for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CloudFile {
    /// Its path, or its name where it is no file.
    pub path: PathBuf,
    /// Number of its points, with those that were not read.
    pub row_count: u64,
    /// Attributes of its points beside those of a cloud, in words.
    pub other_attributes: Vec<String>,
    /// Records of its header that a cloud has no place for, in words.
    pub records: Vec<String>,
}

/// Rows of files that the points of a cloud are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum FileRows {
    /// All of them, in their order.
    #[default]
    All,
    /// The row of each point, counted over all files after each other.
    Of(Vec<u64>),
    /// Unknown rows.
    Unknown,
}

impl CloudFiles {
    /// The files of the points at `indices`, in that order.
    #[must_use]
    pub fn select(&self, indices: &[u32]) -> Self {
        let rows = match &self.rows {
            FileRows::All => FileRows::Of(indices.iter().map(|&i| u64::from(i)).collect()),
            FileRows::Of(rows) => {
                let selected: Option<Vec<u64>> = indices.iter().map(|&i| rows.get(i as usize).copied()).collect();
                selected.map_or(FileRows::Unknown, FileRows::Of)
            }
            FileRows::Unknown => FileRows::Unknown,
        };
        Self { files: self.files.clone(), rows }
    }
}

/// Epoch of GPS times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GpsTimeKind {
    /// Seconds since Sunday midnight (LAS global encoding bit 0 clear).
    #[default]
    SecondsOfWeek,
    /// GPS time minus 1e9 s (LAS global encoding bit 0 set).
    AdjustedStandard,
}

/// Unix seconds at which adjusted standard GPS times are 0: 6 January 1980, 10⁹ s, less the leap seconds since 2017.
///
/// # Source
/// ASPRS 2019, LAS Specification 1.4 R15, global encoding.
pub const ADJUSTED_GPS_EPOCH: f64 = 315_964_800.0 + 1e9 - 18.0;

/// Defines [`Attributes`] by its per-point columns, and the methods that visit each of them.
macro_rules! attributes {
    ($($(#[$doc:meta])* $column:ident: $value:ty,)*) => {
        /// Attributes of the points of a [`PointCloud`], each with one value per point where present.
        #[derive(Clone, Debug, Default)]
        pub struct Attributes {
            $($(#[$doc])* pub $column: Option<Vec<$value>>,)*
            /// Epoch of the GPS times.
            pub gps_time_kind: GpsTimeKind,
        }

        impl Attributes {
            /// Selects the attributes of the points at `indices`, in that order. Columns that are too short for an
            /// index are dropped.
            #[must_use]
            pub fn select(&self, indices: &[u32]) -> Self {
                Self {
                    $($column: self.$column.as_ref().and_then(|values| {
                        indices.iter().map(|&i| values.get(i as usize).copied()).collect()
                    }),)*
                    gps_time_kind: self.gps_time_kind,
                }
            }

            /// Appends `other`, which belongs to `other_count` points, to these of `count` points. A column that only
            /// one of the two has is dropped, and its name returned.
            pub fn append(&mut self, count: usize, other: Self, other_count: usize) -> Vec<&'static str> {
                let mut dropped = Vec::new();
                if count == 0 {
                    *self = other;
                    return dropped;
                }
                if other_count == 0 {
                    return dropped;
                }
                if self.gps_time_kind != other.gps_time_kind && self.gps_time.is_some() {
                    self.gps_time = None;
                }
                $(match (&mut self.$column, other.$column) {
                    (Some(mine), Some(theirs)) => mine.extend(theirs),
                    (None, None) => {}
                    _ => {
                        self.$column = None;
                        dropped.push(stringify!($column));
                    }
                })*
                dropped
            }

            /// Lists name and length of every column present.
            #[must_use]
            pub fn columns(&self) -> Vec<(&'static str, usize)> {
                let columns = [$((stringify!($column), self.$column.as_ref().map(Vec::len)),)*];
                columns.into_iter().filter_map(|(name, length)| Some((name, length?))).collect()
            }
        }
    };
}

/// Calls the macro `$apply!` with documentation, name and type of each column of [`Attributes`].
#[doc(hidden)]
#[macro_export]
macro_rules! attribute_columns {
    ($apply:ident) => {
        $apply! {
            /// Unit normals as given by the file, (N, 3); (0, 0, 0) where the file has none for a point.
            normals: [f32; 3],
            /// ASPRS class.
            classification: u8,
            /// GPS time in seconds, see [`Attributes::gps_time_kind`].
            gps_time: f64,
            /// Number of the return in its pulse, from 1.
            return_number: u8,
            /// Number of returns of its pulse.
            return_count: u8,
            /// Scan angle in radians.
            scan_angle: f32,
            /// Flight line.
            point_source_id: u16,
            /// Channel of a multi-channel scanner.
            scanner_channel: u8,
            /// LAS flags: 1 synthetic, 2 key point, 4 withheld, 8 overlap.
            flags: u8,
            /// Intensity.
            intensity: u16,
            /// Red, green, blue, 0 to 65535 (readers widen 8-bit colours).
            color: [u16; 3],
            /// Index into [`PointCloud::scanner_positions`]; `u16::MAX` where unknown.
            scanner_index: u16,
        }
    };
}

attribute_columns!(attributes);

impl Attributes {
    /// Returns the class of a point, if it is known.
    #[must_use]
    pub fn class_of(&self, row: usize) -> Option<u8> {
        self.classification.as_deref()?.get(row).copied()
    }
}

impl PointCloud {
    /// A cloud without attributes from coordinates in metres, (N, 3), f64; the origin is chosen near their centre.
    ///
    /// Rows that are not finite are left out; their number is returned beside the cloud.
    #[must_use]
    pub fn from_coordinates(coordinates: &[[f64; 3]]) -> (Self, usize) {
        let origin = origin_of(coordinates.iter().copied());
        let positions: Vec<[f32; 3]> =
            coordinates.iter().filter(|c| c.iter().all(|v| v.is_finite())).map(|&c| to_local(c, origin)).collect();
        let left_out = coordinates.len() - positions.len();
        (Self { frame: Frame { origin, ..Frame::default() }, positions, ..Self::default() }, left_out)
    }

    /// A cloud without points in `frame`.
    #[must_use]
    pub fn in_frame(frame: Frame) -> Self {
        Self { frame, ..Self::default() }
    }

    /// The same cloud in another reference system: the meaning of its coordinates changes, not their numbers in metres.
    #[must_use]
    pub fn with_crs(mut self, crs: Crs) -> Self {
        self.frame.crs = crs;
        self
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns true if there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The smallest box around the points, or `None` without any.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        Bounds::around(self.positions.iter().copied())
    }

    /// The points at `indices`, in that order, with their attributes. Indices out of range are left out.
    #[must_use]
    pub fn select(&self, indices: &[u32]) -> Self {
        Self {
            frame: self.frame.clone(),
            positions: indices.iter().filter_map(|&i| self.positions.get(i as usize).copied()).collect(),
            attributes: self.attributes.select(indices),
            scanner_positions: self.scanner_positions.clone(),
            sky_regions: self.sky_regions.clone(),
            cleared_places: self.cleared_places.clone(),
            files: self.files.select(indices),
        }
    }

    /// This cloud with the local coordinates of another frame, whose reference system it takes over.
    ///
    /// A cloud without any information on its coordinates, neither a system nor a unit, is taken to have those of the
    /// frame's file. Set-ups of scanners are left out, with the sky seen by their pulses.
    #[must_use]
    pub fn moved_to(mut self, frame: &Frame) -> Self {
        let is_silent = self.frame.crs == Crs::default();
        let scale = if is_silent { frame.crs.metres_per_unit_xyz() } else { [1.0; 3] };
        let from = self.frame.origin;
        let moved = |position: [f32; 3]| {
            to_local(std::array::from_fn(|i| (f64::from(position[i]) + from[i]) * scale[i]), frame.origin)
        };
        for position in &mut self.positions {
            *position = moved(*position);
        }
        for place in &mut self.cleared_places {
            let [x, y, _] = moved([place[0], place[1], 0.0]);
            *place = [x, y];
        }
        self.scanner_positions = Vec::new();
        self.sky_regions = Vec::new();
        self.frame = frame.clone();
        self
    }

    /// Checks that every column has one value per point and every position is finite.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`] for the first column whose length differs, [`Error::InvalidParameter`] for a position
    /// that is not finite.
    pub fn validate(&self) -> Result<()> {
        let expected = self.len();
        if let Some((what, found)) = self.attributes.columns().into_iter().find(|&(_, length)| length != expected) {
            return Err(Error::LengthMismatch { what, expected, found });
        }
        if let Some(p) = self.positions.iter().find(|p| p.iter().any(|v| !v.is_finite())) {
            return Err(Error::invalid(Parameter::Position, format!("{p:?}"), "finite"));
        }
        Ok(())
    }
}

/// Spacing of the origins of surveys, metres. It is a multiple of blocks of 64 m, and large so that neighbouring
/// surveys share an origin.
const ORIGIN_STEP: f64 = 1024.0;
/// Width from which on a cloud has the origin of a survey, metres. Smaller objects need more digits.
const MIN_SURVEY: f64 = 64.0;

/// Origin of local coordinates of a survey between two corners, metres: near their middle, a corner of blocks of 64 m.
#[must_use]
pub fn survey_origin(low: [f64; 3], high: [f64; 3]) -> [f64; 3] {
    // adding zero turns −0 into 0, which prints better
    std::array::from_fn(|i| (f64::midpoint(low[i], high[i]) / ORIGIN_STEP).round() * ORIGIN_STEP + 0.0)
}

/// Origin of local coordinates of a cloud with these `coordinates`, metres: [`survey_origin`] of a wide one, otherwise
/// [`centre_rounded`]. Coordinates that are not finite are left out.
#[must_use]
pub fn origin_of(coordinates: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let [low, high] = box_around(coordinates.filter(|c| c.iter().all(|v| v.is_finite())));
    let is_survey = (0..2).any(|i| high[i] - low[i] >= MIN_SURVEY);
    if is_survey { survey_origin(low, high) } else { centre_rounded([low, high].into_iter()) }
}

/// Middle of the bounding box of the finite `coordinates`, rounded to whole metres so that it prints short; zero if
/// there is none.
pub fn centre_rounded(coordinates: impl Iterator<Item = [f64; 3]>) -> [f64; 3] {
    let [low, high] = box_around(coordinates.filter(|c| c.iter().all(|v| v.is_finite())));
    std::array::from_fn(|i| if low[i] <= high[i] { (low[i] / 2.0 + high[i] / 2.0).round() + 0.0 } else { 0.0 })
}
