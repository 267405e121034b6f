//! Areas and classes to clear.

use belvedere_data::cast::to_i64;
use belvedere_data::cloud::GROUND;
use belvedere_data::polygon::{PolygonIndex, simple_rings};
use belvedere_data::{Bounds, Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
/// Side of the squares whose polygons are cleared together, metres: columns of the usual width over one are fewer than
/// [`MAX_CELLS`].
const AREA_SIDE: f64 = 256.0;

/// Corners of an outline and of its holes.
type Rings = Vec<Vec<[f64; 2]>>;

/// Area or class to clear.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ClearedArea {
    /// Everything above the ground inside rings, local metres in plan: an outline and its holes.
    Polygon(Vec<Vec<[f64; 2]>>),
    /// The same inside several polygons, as [`ClearedArea::of_polygons`] joins them.
    Polygons(Vec<Vec<Vec<[f64; 2]>>>),
    /// The points of a class, and the balls at them.
    Class(u8),
}

impl ClearedArea {
    /// Areas of `polygons` in which objects are removed. Each polygon is an outline and its holes, local metres on the
    /// map. Polygons near each other form one area, which is faster than an area for each.
    #[must_use]
    pub fn of_polygons(polygons: Vec<Vec<Vec<[f64; 2]>>>) -> Vec<Self> {
        let mut squares: BTreeMap<[i64; 2], Vec<Rings>> = BTreeMap::new();
        for rings in polygons {
            let corner = rings.iter().flatten().next().copied().unwrap_or_default();
            let square = corner.map(|v| to_i64((v / AREA_SIDE).floor()));
            squares.entry(square).or_default().push(rings);
        }
        let area = |mut polygons: Vec<Rings>| match polygons.pop() {
            Some(only) if polygons.is_empty() => Self::Polygon(only),
            last => Self::Polygons(polygons.into_iter().chain(last).collect()),
        };
        squares.into_values().map(area).collect()
    }

    /// Its polygons; none for a class.
    fn polygons(&self) -> &[Vec<Vec<[f64; 2]>>] {
        match self {
            Self::Polygon(rings) => std::slice::from_ref(rings),
            Self::Polygons(polygons) => polygons,
            Self::Class(_) => &[],
        }
    }

    /// The index of its polygons; an empty one for a class.
    #[must_use]
    pub fn index(&self) -> PolygonIndex {
        PolygonIndex::of_polygons(self.polygons().iter().map(Vec::as_slice))
    }

    /// The rectangle around polygons on the map, from their lowest to their highest corner, as far as it lies on
    /// `bounds`, local metres from `origin`; `None` for a class.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a polygon beside `bounds`, for one that is none, and for the class of the
    /// ground.
    pub fn rectangle_on(&self, bounds: &Bounds, origin: [f64; 3]) -> Result<Option<([f64; 2], [f64; 2])>> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::ClearedArea, value, expected));
        match self {
            Self::Class(GROUND) => return invalid("class 2".to_owned(), "a class that stands on the ground"),
            Self::Class(_) => return Ok(None),
            Self::Polygon(_) | Self::Polygons(_) => {}
        }
        let (first, last) = bounds.on_map();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for rings in self.polygons() {
            if rings.is_empty() {
                return invalid("0 corners".to_owned(), "a polygon: three corners or more in each ring");
            }
            simple_rings(rings).map_err(|fault| fault.refusal(Parameter::ClearedArea))?;
            let bound = |pick: fn(f64, f64) -> f64, start: f64| {
                [0, 1].map(|axis| rings.iter().flatten().map(|corner| corner[axis]).fold(start, pick))
            };
            let (own_low, own_high) = (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY));
            if (0..2).any(|axis| own_low[axis] > last[axis] || own_high[axis] < first[axis]) {
                let [[x, y], [west, south], [east, north]] =
                    [own_low, first, last].map(|corner| [0, 1].map(|axis| corner[axis] + origin[axis]));
                return invalid(
                    format!(
                        "from x {x:.1}, y {y:.1} m on (the points reach from {west:.0}, {south:.0} to {east:.0}, {north:.0})"
                    ),
                    "on the cloud, in its coordinates",
                );
            }
            low = [0, 1].map(|axis| low[axis].min(own_low[axis]));
            high = [0, 1].map(|axis| high[axis].max(own_high[axis]));
        }
        let within = |axis: usize| (low[axis].max(first[axis]), high[axis].min(last[axis]));
        let (x, y) = (within(0), within(1));
        Ok(Some(([x.0, y.0], [x.1, y.1])))
    }
}
