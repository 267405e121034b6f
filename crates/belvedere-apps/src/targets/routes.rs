//! Places along routes.

use super::{TargetLayout, Targets};
use crate::exposure::route_lengths;
use belvedere_data::frame::Frame;
use belvedere_data::vector::to_f32;

/// Places along a line, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Local metres, (N, 3), as [`crate::viewshed::places_along`] makes them; a height that is NaN is not known.
    pub places: Vec<[f64; 3]>,
}

impl Route {
    /// Way from the first place to each, on the map, metres, (N).
    #[must_use]
    pub fn distances(&self) -> Vec<f64> {
        let mut along = 0.0;
        let mut distances = Vec::with_capacity(self.places.len());
        for (i, place) in self.places.iter().enumerate() {
            if let Some(before) = i.checked_sub(1).and_then(|before| self.places.get(before)) {
                along += (place[0] - before[0]).hypot(place[1] - before[1]);
            }
            distances.push(along);
        }
        distances
    }

    /// Its length on the map, metres.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.distances().last().copied().unwrap_or(0.0)
    }
}

impl Targets {
    /// The places of `routes`, one group each, weighted by the length of route that they represent; a place without a
    /// height has no weight.
    #[must_use]
    pub fn along_routes(routes: &[Route], frame: Frame) -> Self {
        let (mut positions, mut weights, mut groups) = (Vec::new(), Vec::new(), Vec::new());
        for route in routes {
            groups.push(positions.len()..positions.len() + route.places.len());
            for (place, length) in route.places.iter().zip(route_lengths(&route.places)) {
                weights.push(if place[2].is_finite() { length } else { 0.0 });
                positions.push(place.map(to_f32));
            }
        }
        Self { weights, groups, ..Self::at(frame, positions, None, TargetLayout::Points) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_places_of_a_route_are_the_lengths_they_represent() {
        let route = Route { places: vec![[0.0, 0.0, 1.0], [3.0, 4.0, 1.0], [3.0, 14.0, f64::NAN]] };
        assert_eq!((route.distances(), route.length()), (vec![0.0, 5.0, 15.0], 15.0));
        let single = Route { places: vec![[5.0, 5.0, 0.0]] };
        let targets = Targets::along_routes(&[route, single], Frame::default());
        assert_eq!(targets.weights, [2.5, 7.5, 0.0, 1.0]);
        assert_eq!(targets.groups, [0..3, 3..4]);
        assert_eq!(targets.target_count(), 3);
    }
}
