//! Observers, with limits of distance and direction.

use belvedere_data::{Error, Parameter, Result};
use std::f64::consts::TAU;

/// Someone, or a camera, that looks around.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observer {
    /// Position of the eye, local metres.
    pub eye: [f64; 3],
    /// Limits of distance and direction.
    pub limits: SightLimits,
}

/// Directions and distances that an observer looks at; targets outside are not tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SightLimits {
    /// First and last azimuth, radians clockwise from grid north: from 5.2 to 1 runs through north. `None`, the
    /// default: all around.
    pub azimuth: Option<[f64; 2]>,
    /// Minimum and maximum angle above the horizon, radians, −π/2 to π/2. `None`, the default: all.
    pub elevation: Option<[f64; 2]>,
    /// Minimum and maximum distance on the map, metres, 0 or more; the second may be infinite. Default: 0 to infinity.
    pub distance: [f64; 2],
}

impl Default for SightLimits {
    fn default() -> Self {
        Self { azimuth: None, elevation: None, distance: [0.0, f64::INFINITY] }
    }
}

impl SightLimits {
    /// Checks the limits.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for limits that are not numbers or leave nothing.
    pub fn validate(&self) -> Result<()> {
        let invalid = |parameter, value: [f64; 2], expected| {
            Err(Error::invalid(parameter, format!("{} to {}", value[0], value[1]), expected))
        };
        if let Some(azimuth) = self.azimuth
            && !azimuth.iter().all(|v| v.is_finite())
        {
            return invalid(Parameter::Azimuth, azimuth.map(f64::to_degrees), "two finite angles");
        }
        let right = std::f64::consts::FRAC_PI_2 + 1e-9;
        if let Some(elevation) = self.elevation
            && !(elevation[0] < elevation[1] && elevation[0] >= -right && elevation[1] <= right)
        {
            return invalid(
                Parameter::Elevation,
                elevation.map(f64::to_degrees),
                "in ascending order, from -90 to 90 degrees",
            );
        }
        let [min, max] = self.distance;
        if !(min >= 0.0 && min.is_finite() && max > min) {
            return invalid(Parameter::Distance, self.distance, "in ascending order, from 0 metres");
        }
        Ok(())
    }

    /// Returns true if an eye with these limits looks at `target`, both local metres. False for a target that is not
    /// finite.
    #[must_use]
    pub fn allow(&self, eye: [f64; 3], target: [f64; 3]) -> bool {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| target[i] - eye[i]);
        let distance = x.hypot(y);
        if !(distance >= self.distance[0] && distance <= self.distance[1] && z.is_finite()) {
            return false;
        }
        if let Some([from, to]) = self.azimuth
            && to - from < TAU
            && (x.atan2(y) - from).rem_euclid(TAU) > (to - from).rem_euclid(TAU)
        {
            return false;
        }
        self.elevation.is_none_or(|[min, max]| {
            let elevation = z.atan2(distance);
            (min..=max).contains(&elevation)
        })
    }
}

/// Returns places `step` metres apart along a path through `corners`, measured in plan, local metres. The first and
/// last corner are included, so that the last piece may be shorter. Heights are linear between corners; NaN stays NaN.
///
/// # Errors
/// [`Error::InvalidParameter`] for a step that is not above zero or gives more than a million places.
pub fn places_along(corners: &[[f64; 3]], step: f64) -> Result<Vec<[f64; 3]>> {
    /// Observers of more than this are a slipped digit.
    const MAX_PLACES: f64 = 1e6;
    let size = |pair: &[[f64; 3]]| match pair {
        [a, b] => (b[0] - a[0]).hypot(b[1] - a[1]),
        _ => 0.0,
    };
    let total: f64 = corners.windows(2).map(size).sum();
    if !(step > 0.0 && total / step <= MAX_PLACES) {
        let expected = "above zero, and large enough for at most a million places";
        return Err(Error::invalid(Parameter::PathStep, format!("{step} m on {total} m"), expected));
    }
    let mut places: Vec<[f64; 3]> = corners.first().copied().into_iter().collect();
    let mut left = step;
    for pair in corners.windows(2) {
        let &[a, b] = pair else { continue };
        let length = size(pair);
        let mut along = left;
        while along < length {
            places.push(std::array::from_fn(|i| a[i] + along / length * (b[i] - a[i])));
            along += step;
        }
        left = along - length;
    }
    // the end is a place of its own unless a step just reached it
    if let Some(&last) = corners.last()
        && corners.len() > 1
        && left < step * (1.0 - 1e-9)
    {
        places.push(last);
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_run_clockwise_from_north_and_through_it() {
        let limits = |from: f64, to: f64| SightLimits {
            azimuth: Some([from.to_radians(), to.to_radians()]),
            ..SightLimits::default()
        };
        let (north, east, west) = ([0.0, 9.0, 0.0], [9.0, 0.0, 0.0], [-9.0, 0.0, 0.0]);
        let seen = |limits: SightLimits| [north, east, west].map(|target| limits.allow([0.0; 3], target));
        assert_eq!(seen(limits(300.0, 60.0)), [true, false, false]);
        assert_eq!(seen(limits(-60.0, 60.0)), [true, false, false]);
        assert_eq!(seen(limits(45.0, 135.0)), [false, true, false]);
        assert_eq!(seen(limits(0.0, 360.0)), [true; 3]);
    }

    #[test]
    fn distances_are_those_on_the_map_and_elevations_above_the_horizon() {
        let near = SightLimits { distance: [2.0, 10.0], ..SightLimits::default() };
        assert!(near.allow([0.0; 3], [9.0, 0.0, 50.0]) && !near.allow([0.0; 3], [1.0, 0.0, 50.0]));
        assert!(!near.allow([0.0; 3], [f64::NAN, 0.0, 0.0]) && !near.allow([0.0; 3], [5.0, 0.0, f64::NAN]));
        let level = SightLimits { elevation: Some([-0.1, 0.1]), ..SightLimits::default() };
        assert!(level.allow([0.0; 3], [10.0, 0.0, 0.5]) && !level.allow([0.0; 3], [10.0, 0.0, 2.0]));
    }

    #[test]
    fn limits_that_leave_nothing_are_refused() {
        let wrong = [
            SightLimits { distance: [5.0, 5.0], ..SightLimits::default() },
            SightLimits { distance: [-1.0, 5.0], ..SightLimits::default() },
            SightLimits { distance: [0.0, f64::NAN], ..SightLimits::default() },
            SightLimits { elevation: Some([0.2, 0.1]), ..SightLimits::default() },
            SightLimits { elevation: Some([0.0, 3.0]), ..SightLimits::default() },
            SightLimits { azimuth: Some([f64::NAN, 1.0]), ..SightLimits::default() },
        ];
        assert!(wrong.iter().all(|limits| limits.validate().is_err()));
        assert!(SightLimits::default().validate().is_ok());
    }

    #[test]
    fn a_path_has_a_place_at_each_step_and_at_its_end() {
        let places = places_along(&[[0.0, 0.0, 1.0], [5.0, 0.0, 2.0], [5.0, 3.0, 2.0]], 2.0).unwrap();
        let on_map: Vec<[f64; 2]> = places.iter().map(|p| [p[0], p[1]]).collect();
        assert_eq!(on_map, [[0.0, 0.0], [2.0, 0.0], [4.0, 0.0], [5.0, 1.0], [5.0, 3.0]]);
        assert!((places[1][2] - 1.4).abs() < 1e-12);
        assert_eq!(places_along(&[[1.0; 3]], 2.0).unwrap(), [[1.0; 3]]);
        for step in [0.0, f64::NAN, 1e-9] {
            assert!(places_along(&[[0.0; 3], [5.0; 3]], step).is_err());
        }
    }
}
