//! Planes of roofs, and the lines on which surfaces of buildings end.

use crate::frame::{FARTHEST, is_near_f64};
use crate::polygon::PolygonIndex;
use crate::vector::{dot, sub};
use crate::{Error, Parameter, Result};

/// Maximum distance of a point of a plane from it, in multiples of the noise of the plane: that of the points that a
/// plane is fitted to.
const NOISES: f64 = 3.0;
/// Addition to that distance, metres: positions have steps of a millimetre or two in files and on pages.
const STEP: f64 = 0.005;

/// A plane of a roof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoofPlane {
    /// Unit vector upward and outward.
    pub normal: [f64; 3],
    /// A point of the plane, the middle of its points, local metres.
    pub center: [f64; 3],
    /// Lowest and highest corner of the box of its points, local metres.
    pub bounds: [[f64; 3]; 2],
    /// Points on it.
    pub count: usize,
    /// Root mean square distance of these points, metres.
    pub noise: f64,
    /// Standard deviation of its height at the middle, metres.
    pub sd: f64,
}

/// A straight line on which a roof ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Both ends, local metres. Seen from the first to the second the roof lies to the left.
    pub ends: [[f64; 3]; 2],
    /// Row of its plane among [`BuildingOutlines::planes`].
    pub plane: usize,
    /// Standard deviation of its place across the line, in plan, metres.
    pub sd: f64,
    /// Number of sides between a return and a pulse that passed whose middles lie on it.
    pub count: usize,
    /// Median depth of the surface below along the edge, metres below the roof.
    pub drop: f64,
}

/// A line in which two planes of a roof meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ridge {
    /// Both ends, local metres.
    pub ends: [[f64; 3]; 2],
    /// Rows of its planes.
    pub planes: [usize; 2],
    /// True for a ridge or hip, from which both planes fall; false for a valley.
    pub is_convex: bool,
}

/// An upright wall below an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// Both ends in plan, local metres. Seen from the first to the second the house lies to the left.
    pub ends: [[f64; 2]; 2],
    /// Height of its lowest point, and of the roof above its middle, local metres.
    pub heights: [f64; 2],
    /// Row of the edge above it among [`BuildingOutlines::edges`].
    pub edge: usize,
    /// Points on it.
    pub count: usize,
    /// Root mean square distance of these points, metres.
    pub noise: f64,
    /// Standard deviation of its place across, at its middle, metres.
    pub sd: f64,
    /// Share of the points below the edge that lie on it, 0 to 1.
    pub share: f64,
    /// Overhang of the edge before it, metres.
    pub eaves: f64,
}

/// Planes, edges, ridges and walls, without their points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildingOutlines {
    /// Planes of roofs; those that reach over several blocks of 64 m are in each of them.
    pub planes: Vec<RoofPlane>,
    /// Edges of roofs, cut to blocks.
    pub edges: Vec<Edge>,
    /// Ridges, hips and valleys, cut to blocks.
    pub ridges: Vec<Ridge>,
    /// Walls, cut to blocks.
    pub walls: Vec<Wall>,
}

impl BuildingOutlines {
    /// Returns true if it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.planes.is_empty()
    }

    /// The plane that a measured point, local metres, lies on: the nearest one within whose box and three times whose
    /// noise it lies.
    #[must_use]
    pub fn plane_at(&self, point: [f64; 3]) -> Option<&RoofPlane> {
        let distance = |plane: &RoofPlane| dot(plane.normal, sub(point, plane.center)).abs();
        let is_on = |plane: &&RoofPlane| {
            let [low, high] = plane.bounds;
            (0..3).all(|i| (low[i] - STEP..=high[i] + STEP).contains(&point[i]))
                && distance(plane) <= NOISES * plane.noise + STEP
        };
        self.planes.iter().filter(is_on).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Removes the planes whose middles lie in polygons, local metres in plan, the lines that end these, and those
    /// whose own middles lie there.
    #[must_use]
    pub fn outside(self, index: &PolygonIndex) -> Self {
        let is_out = |[a, b]: [[f64; 2]; 2]| !index.holds([0, 1].map(|i| f64::midpoint(a[i], b[i])));
        let on_map = |ends: [[f64; 3]; 2]| ends.map(|[x, y, _]| [x, y]);
        let (planes, plane_at) = retain_with_places(self.planes, |plane| is_out(on_map([plane.center; 2])));
        let edges = self.edges.into_iter().map(|edge| {
            let plane = plane_at.get(edge.plane).copied().flatten().filter(|_| is_out(on_map(edge.ends)));
            plane.map(|plane| Edge { plane, ..edge })
        });
        let edges: Vec<Option<Edge>> = edges.collect();
        let (edges, edge_at) = retain_with_places(edges, Option::is_some);
        let ridges = self.ridges.into_iter().filter(|ridge| is_out(on_map(ridge.ends))).filter_map(|ridge| {
            let [a, b] = ridge.planes.map(|plane| plane_at.get(plane).copied().flatten());
            Some(Ridge { planes: [a?, b?], ..ridge })
        });
        let walls = self.walls.into_iter().filter(|wall| is_out(wall.ends));
        let walls = walls.filter_map(|wall| Some(Wall { edge: edge_at.get(wall.edge).copied().flatten()?, ..wall }));
        let (ridges, walls) = (ridges.collect(), walls.collect());
        Self { planes, edges: edges.into_iter().flatten().collect(), ridges, walls }
    }

    /// Checks that all places are near the origin, and that rows of planes and edges are there.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for the first fault.
    pub fn validate(&self) -> Result<()> {
        let planes = self.planes.iter().flat_map(|plane| [plane.center, plane.bounds[0], plane.bounds[1]]);
        let lines = self.edges.iter().flat_map(|edge| edge.ends).chain(self.ridges.iter().flat_map(|ridge| ridge.ends));
        let walls =
            self.walls.iter().flat_map(|wall| [0, 1].map(|i| [wall.ends[i][0], wall.ends[i][1], wall.heights[i]]));
        let invalid = |value, expected| Err(Error::invalid(Parameter::Obstacle, value, expected));
        if let Some(place) = planes.chain(lines).chain(walls).find(|place| !is_near_f64(*place)) {
            let value = format!("a surface of a building at {place:?}, farther than {FARTHEST} m away");
            return invalid(value, "within 10000 km of the origin");
        }
        let of_planes =
            self.edges.iter().map(|edge| edge.plane).chain(self.ridges.iter().flat_map(|ridge| ridge.planes));
        let is_there = of_planes.max().is_none_or(|plane| plane < self.planes.len())
            && self.walls.iter().all(|wall| wall.edge < self.edges.len());
        if is_there {
            Ok(())
        } else {
            invalid("a line of a building".to_owned(), "of a plane or an edge that is there")
        }
    }
}

/// The median standard deviation of edges, metres; `None` without any.
#[must_use]
pub fn median_sd(edges: &[Edge]) -> Option<f64> {
    let mut deviations: Vec<f64> = edges.iter().map(|edge| edge.sd).collect();
    deviations.sort_unstable_by(f64::total_cmp);
    deviations.get(deviations.len() / 2).copied()
}

/// Returns the items to keep, and the new index of each item, if kept.
fn retain_with_places<T>(all: Vec<T>, is_kept: impl Fn(&T) -> bool) -> (Vec<T>, Vec<Option<usize>>) {
    let mut left = Vec::new();
    let place = |one: T| {
        let place = is_kept(&one).then_some(left.len());
        left.extend(place.is_some().then_some(one));
        place
    };
    let places = all.into_iter().map(place).collect();
    (left, places)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two square roofs side by side, of 10 m, 5 and 7 m high, each with an edge above a wall, and the line between.
    fn two_roofs() -> BuildingOutlines {
        let plane = |x: f64, z: f64| RoofPlane {
            normal: [0.0, 0.0, 1.0],
            center: [x, 5.0, z],
            bounds: [[x - 5.0, 0.0, z - 0.02], [x + 5.0, 10.0, z + 0.02]],
            count: 400,
            noise: 0.02,
            sd: 0.001,
        };
        let edge =
            |plane, x: f64, z| Edge { ends: [[x, 0.0, z], [x + 10.0, 0.0, z]], plane, sd: 0.03, count: 20, drop: z };
        let wall = |edge, x: f64, z| Wall {
            ends: [[x, 0.0], [x + 10.0, 0.0]],
            heights: [0.0, z],
            edge,
            count: 10,
            noise: 0.03,
            sd: 0.01,
            share: 0.8,
            eaves: 0.0,
        };
        BuildingOutlines {
            planes: vec![plane(5.0, 5.0), plane(15.0, 7.0)],
            edges: vec![edge(0, 0.0, 5.0), edge(1, 10.0, 7.0)],
            ridges: vec![Ridge { ends: [[10.0, 0.0, 5.0], [10.0, 10.0, 5.0]], planes: [0, 1], is_convex: false }],
            walls: vec![wall(0, 0.0, 5.0), wall(1, 10.0, 7.0)],
        }
    }

    #[test]
    fn a_point_lies_on_the_plane_that_it_scatters_about() {
        let roofs = two_roofs();
        assert_eq!(roofs.plane_at([3.0, 3.0, 5.02]), Some(&roofs.planes[0]));
        assert_eq!(roofs.plane_at([13.0, 3.0, 6.99]), Some(&roofs.planes[1]));
        // above it, beside it, and at the height of the other
        for place in [[3.0, 3.0, 5.1], [3.0, 11.0, 5.0], [13.0, 3.0, 5.0], [f64::NAN; 3]] {
            assert_eq!(roofs.plane_at(place), None, "{place:?}");
        }
    }

    #[test]
    fn lines_go_with_their_planes() {
        let area = vec![vec![[-1.0, -1.0], [9.0, -1.0], [9.0, 11.0], [-1.0, 11.0]]];
        let left = two_roofs().outside(&PolygonIndex::new(&area));
        assert!(left.validate().is_ok() && left.ridges.is_empty(), "{left:?}");
        let all = two_roofs();
        assert_eq!((left.planes, left.walls.len()), (vec![all.planes[1]], 1));
        assert_eq!((left.edges[0].ends, left.edges[0].plane, left.walls[0].edge), (all.edges[1].ends, 0, 0));
        assert_eq!(all.clone().outside(&PolygonIndex::new(&[])), all);
    }

    #[test]
    fn rows_that_are_not_there_are_refused() {
        let all = two_roofs();
        assert!(all.validate().is_ok());
        let mut without = all.clone();
        without.planes.pop();
        assert!(without.validate().is_err());
        let mut without = all.clone();
        without.edges.pop();
        assert!(without.validate().is_err());
        let mut far = all;
        far.walls[0].heights[1] = f64::NAN;
        assert!(far.validate().is_err());
    }
}
