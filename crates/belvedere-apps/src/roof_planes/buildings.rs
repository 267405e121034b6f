//! Buildings that planes of roofs belong to: planes that touch in plan, or outlines that are given.

use super::{PlaneCells, RoofPlane};
use belvedere_data::polygon::{Footprint, PolygonIndex};
use std::collections::HashMap;

/// Maximum gap in plan between planes of one building, metres: the reach from point to point of a plane.
const MAX_GAP: f64 = 1.0;
/// Share of a plane within one footprint below which it reaches over several buildings.
const MIN_SHARE: f64 = 0.5;

/// The buildings of planes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Buildings {
    /// Number of the building of each plane, from 1; `None` outside all footprints.
    pub of_plane: Vec<Option<u64>>,
    /// Names of the buildings from number 1 on; empty without footprints.
    pub names: Vec<String>,
    /// Planes that lie in their footprint with less than half of their area.
    pub reaching_over: usize,
}

impl Buildings {
    /// Returns the number of different buildings with a plane.
    #[must_use]
    pub fn count(&self) -> usize {
        let mut numbers: Vec<u64> = self.of_plane.iter().copied().flatten().collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers.len()
    }

    /// Groups planes whose extents lie within 1 m of each other in plan. Numbers follow the first plane of each group.
    #[must_use]
    pub fn of_touching(planes: &[RoofPlane]) -> Self {
        let places: Vec<Vec<[f64; 2]>> = planes.iter().map(|plane| places_in_plan(&plane.extent)).collect();
        // cells end half a side beyond their middles
        let reach = |a: usize, b: usize| MAX_GAP + 0.5 * (planes[a].extent.cell + planes[b].extent.cell);
        let widest = planes.iter().map(|plane| plane.extent.cell).fold(0.0, f64::max);
        let square = |[x, y]: [f64; 2]| [x, y].map(|v| (v / (MAX_GAP + widest)).floor());
        let key = |[x, y]: [f64; 2]| [x.to_bits(), y.to_bits()];
        let mut squares: HashMap<[u64; 2], Vec<(usize, [f64; 2])>> = HashMap::new();
        let mut group: Vec<usize> = (0..planes.len()).collect();
        for (plane, &place) in places.iter().enumerate().flat_map(|(plane, all)| all.iter().map(move |p| (plane, p))) {
            let [column, row] = square(place);
            for step in 0..9 {
                // adding zero makes one key of both zeros
                let near = [column + f64::from(step % 3 - 1) + 0.0, row + f64::from(step / 3 - 1) + 0.0];
                for &(other, beside) in squares.get(&key(near)).into_iter().flatten() {
                    let gap = (place[0] - beside[0]).hypot(place[1] - beside[1]);
                    let [a, b] = [plane, other].map(|one| first_of(&group, one));
                    if a != b && gap <= reach(plane, other) {
                        group[a.max(b)] = a.min(b);
                    }
                }
            }
            squares.entry(key([column + 0.0, row + 0.0])).or_default().push((plane, place));
        }
        let mut numbers: HashMap<usize, u64> = HashMap::new();
        let of_plane = (0..planes.len())
            .map(|plane| {
                let next = numbers.len() as u64 + 1;
                Some(*numbers.entry(first_of(&group, plane)).or_insert(next))
            })
            .collect();
        Self { of_plane, ..Self::default() }
    }

    /// Assigns each plane to the footprint, local metres, that holds most of its extent.
    #[must_use]
    pub fn of_footprints(planes: &[RoofPlane], footprints: &[Footprint]) -> Self {
        let index = |footprint: &Footprint| PolygonIndex::of_polygons(footprint.polygons.iter().map(Vec::as_slice));
        let indexes: Vec<(PolygonIndex, [[f64; 2]; 2])> =
            footprints.iter().map(|footprint| (index(footprint), footprint.bounds())).collect();
        let mut found = Self { names: footprints.iter().map(|one| one.name.clone()).collect(), ..Self::default() };
        for plane in planes {
            let places = places_in_plan(&plane.extent);
            let low = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min));
            let high = [0, 1].map(|axis| places.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max));
            let meets = |bounds: &[[f64; 2]; 2]| (0..2).all(|i| bounds[0][i] <= high[i] && low[i] <= bounds[1][i]);
            let held = (1_u64..)
                .zip(&indexes)
                .filter(|(_, (_, bounds))| meets(bounds))
                .map(|(number, (index, _))| (places.iter().filter(|&&place| index.holds(place)).count(), number));
            // of equal shares the first footprint
            let most = held.filter(|(count, _)| *count > 0).max_by_key(|(count, number)| (*count, u64::MAX - number));
            found.reaching_over +=
                usize::from(most.is_some_and(|(count, _)| (count as f64) < MIN_SHARE * places.len() as f64));
            found.of_plane.push(most.map(|(_, number)| number));
        }
        found
    }

    /// Keeps the planes that are flagged, and numbers their buildings anew unless these have names.
    #[must_use]
    pub fn of_kept(mut self, kept: impl IntoIterator<Item = bool>) -> Self {
        let of_plane = std::mem::take(&mut self.of_plane).into_iter().zip(kept);
        self.of_plane = of_plane.filter_map(|(number, is_kept)| is_kept.then_some(number)).collect();
        if self.names.is_empty() {
            let mut numbers: HashMap<u64, u64> = HashMap::new();
            for number in self.of_plane.iter_mut().flatten() {
                let next = numbers.len() as u64 + 1;
                *number = *numbers.entry(*number).or_insert(next);
            }
        }
        self
    }
}

/// Returns the first plane of the group of a plane; each plane but it names an earlier one.
fn first_of(group: &[usize], mut plane: usize) -> usize {
    while group[plane] != plane {
        plane = group[plane];
    }
    plane
}

fn places_in_plan(extent: &PlaneCells) -> Vec<[f64; 2]> {
    extent.middles().into_iter().map(|([x, y, _], _)| [x, y]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use belvedere_data::raster::Raster;

    /// A level plane of cells of half a metre, from a corner on.
    fn plane([x, y]: [f64; 2], [width, height]: [usize; 2]) -> RoofPlane {
        let cells = PlaneCells {
            cell: 0.5,
            corner: [x, y, 5.0],
            along: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            filled: Raster::filled(width, height, true),
        };
        RoofPlane {
            points: Vec::new(),
            middle: [x, y, 5.0],
            normal: [0.0, 0.0, 1.0],
            roughness: 0.0,
            extent: cells.clone(),
            cells,
            area: 1.0,
        }
    }

    #[test]
    fn planes_that_touch_are_one_building() {
        // two that meet, one 0.9 m beside them, one 3 m away, and one that joins only the last
        let planes = [
            plane([0.0, 0.0], [8, 8]),
            plane([-10.0, 0.0], [4, 4]),
            plane([4.0, 0.0], [8, 8]),
            plane([8.9, 1.0], [2, 2]),
            plane([-10.0, 2.5], [4, 4]),
        ];
        let found = Buildings::of_touching(&planes);
        assert_eq!(found.of_plane, [1, 2, 1, 1, 2].map(Some));
        assert_eq!(found.count(), 2);
        let kept = found.of_kept([false, true, false, false, true]);
        assert_eq!(kept.of_plane, [Some(1), Some(1)]);
    }

    #[test]
    fn planes_belong_to_the_footprint_that_holds_most_of_them() {
        let square = |x: f64| vec![vec![[x, 0.0], [x + 4.0, 0.0], [x + 4.0, 4.0], [x, 4.0]]];
        let footprints: Vec<Footprint> = [("west", 0.0), ("middle", 4.0), ("east", 8.0)]
            .map(|(name, x)| Footprint { name: name.to_owned(), polygons: vec![square(x)] })
            .to_vec();
        let planes = [
            plane([0.5, 0.5], [6, 6]),
            plane([3.5, 0.5], [6, 6]),
            plane([30.0, 0.0], [4, 4]),
            // a terrace over all three
            plane([1.0, 0.0], [20, 8]),
        ];
        let found = Buildings::of_footprints(&planes, &footprints);
        assert_eq!(found.of_plane, [Some(1), Some(2), None, Some(2)]);
        assert_eq!((found.count(), found.reaching_over), (2, 1));
        assert_eq!(found.names, ["west", "middle", "east"]);
    }
}
