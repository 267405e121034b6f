//! Places as data: those of a question in JSON, in coordinates of the file.

use super::cells::GridCells;
use super::places::Places;
use super::scene::Scene;
use super::standing::{Reach, Standing, standing_on_map};
use crate::targets::CellLevel;
use belvedere_core::ground::GroundPoints;
use belvedere_data::cast::to_f32s;
use belvedere_data::{Frame, Result};
use serde::{Deserialize, Serialize};

/// Places of a question, in coordinates of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum GivenPlaces {
    /// The scene as a whole.
    Scene,
    /// The cells of a grid. Default.
    Cells(GivenCells),
    /// Single places. One without a height lies above the ground, or above what covers the ground there.
    At(Vec<GivenPlace>),
    /// Points: x, y and z of each.
    Points(Vec<[f64; 3]>),
    /// Observers. One without a height stands on the ground.
    Eyes(Vec<GivenPlace>),
    /// An observer and a target each. One without a height stands on the ground.
    Pairs(Vec<[GivenPlace; 2]>),
}

/// Cells of a grid over a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct GivenCells {
    /// Side, metres, above 0; `None` for 0.5, doubled until there are at most 4 million cells.
    pub cell: Option<f64>,
    /// Level of the cells.
    pub level: CellLevel,
    /// Height of the targets above that, metres, 0 or more; `None` for 0.1.
    pub height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// Rings of an area on the map, each of corners (x, y). Cells whose centre lies outside it are no targets. Empty
    /// for all cells.
    pub within: Vec<Vec<[f64; 2]>>,
}

/// A place: x and y, or x, y and z; also latitude and longitude in degrees, with or without z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("minItems" = 2, "maxItems" = 3)))]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub struct GivenPlace {
    /// Position on the map.
    pub on_map: [f64; 2],
    /// Height in the vertical system of the file, in its unit, where it is known.
    pub z: Option<f64>,
}

impl TryFrom<Vec<f64>> for GivenPlace {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> std::result::Result<Self, String> {
        match numbers[..] {
            [x, y] => Ok(Self { on_map: [x, y], z: None }),
            [x, y, z] => Ok(Self { on_map: [x, y], z: Some(z) }),
            _ => Err(format!("a place of {} numbers: give x and y, or x, y and z", numbers.len())),
        }
    }
}

impl From<GivenPlace> for Vec<f64> {
    fn from(place: GivenPlace) -> Self {
        place.on_map.into_iter().chain(place.z).collect()
    }
}

impl Default for GivenPlaces {
    fn default() -> Self {
        Self::Cells(GivenCells::default())
    }
}

impl GivenCells {
    /// Returns cells of a scene with this frame.
    #[must_use]
    pub fn grid_cells(&self, frame: &Frame) -> GridCells {
        let local = |&[x, y]: &[f64; 2]| {
            let [x, y, _] = frame.local_from_file([x, y, 0.0]);
            [x, y]
        };
        let within = self.within.iter().map(|ring| ring.iter().map(local).collect()).collect();
        GridCells { within, ..self.without_area() }
    }

    /// Returns these cells without their area, which needs the frame of a scene.
    #[must_use]
    pub fn without_area(&self) -> GridCells {
        let Self { cell, level, height, ground, .. } = *self;
        GridCells { cell, level, height, ground, ..GridCells::default() }
    }

    /// Returns the cells of a whole scene as data; `None` for those of a part of it.
    #[must_use]
    pub fn of_grid(cells: &GridCells) -> Option<Self> {
        let GridCells { cell, level, height, ground, .. } = *cells;
        let is_whole = cells.bounds.is_none() && cells.within.is_empty();
        is_whole.then(|| Self { cell, level, height, ground, within: Vec::new() })
    }
}

impl GivenPlaces {
    /// Returns these places of a scene.
    ///
    /// # Errors
    /// Those of [`standing_on_map`] and [`Standing::on_map`].
    pub fn of_scene(&self, scene: &Scene) -> Result<Places> {
        let (frame, bounds) = (scene.frame(), scene.model().bounds());
        let end = |place: &GivenPlace| Standing::on_map(place.on_map, place.z, frame, &bounds);
        Ok(match self {
            Self::Scene => Places::Scene,
            Self::Cells(cells) => Places::Cells(cells.grid_cells(frame)),
            Self::At(places) => {
                let places = places.iter().map(|place| (place.on_map, place.z));
                Places::At(standing_on_map(places, None, Reach::Cloud, scene)?, GroundPoints::Auto)
            }
            Self::Points(points) => {
                Places::Points(points.iter().map(|&point| to_f32s(frame.local_from_file(point))).collect(), None)
            }
            Self::Eyes(eyes) => Places::Eyes(eyes.iter().map(end).collect::<Result<_>>()?),
            Self::Pairs(pairs) => {
                Places::Pairs(pairs.iter().map(|[a, b]| Ok([end(a)?, end(b)?])).collect::<Result<_>>()?)
            }
        })
    }

    /// Returns the places on the map that are given one by one; none of cells.
    #[must_use]
    pub fn on_map(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Scene | Self::Cells(_) => Vec::new(),
            Self::At(places) | Self::Eyes(places) => places.iter().map(|place| place.on_map).collect(),
            Self::Points(points) => points.iter().map(|&[x, y, _]| [x, y]).collect(),
            Self::Pairs(pairs) => pairs.iter().flatten().map(|place| place.on_map).collect(),
        }
    }
}
