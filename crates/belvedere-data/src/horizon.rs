//! The horizon of far terrain: below which elevation nothing is seen in each direction.

use crate::contradiction::HORIZON_ANGLES;
use crate::{Error, Parameter, Result};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Rows from which on a table all of whose azimuths lie within 0 to 2π is one in radians: a table in degrees has rows
/// of other azimuths then.
const MIN_ROWS: usize = 3;
/// Lowest and highest elevation of a table, degrees, from which on both are angles from the zenith: no terrain is that
/// steep all around.
const MIN_ZENITH_ANGLES: [f64; 2] = [45.0, 80.0];
/// Rounding of azimuths in tables, degrees.
const ROUNDING: f64 = 0.01;

/// Elevations of a horizon all around, linear between the azimuths that are given.
#[derive(Clone, Debug, PartialEq)]
pub struct HorizonProfile {
    /// Azimuths clockwise from north, 0 to below 2π, ascending, and elevations above the horizontal, radians.
    rows: Vec<[f64; 2]>,
}

impl HorizonProfile {
    /// The profile of azimuths clockwise from north (any turns) and elevations, radians, in any order. Of equal
    /// azimuths the higher elevation counts.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a profile without rows, and for a number that is not finite or an elevation
    /// beyond a right angle.
    pub fn new(rows: impl IntoIterator<Item = [f64; 2]>) -> Result<Self> {
        let mut rows: Vec<[f64; 2]> = rows.into_iter().collect();
        let is_wrong = |row: &&[f64; 2]| !(row[0].is_finite() && row[1].abs() <= FRAC_PI_2 + 1e-9);
        if let Some([azimuth, elevation]) = rows.iter().find(is_wrong) {
            return Err(Error::invalid(
                Parameter::Horizon,
                format!("a row of azimuth {}, elevation {} degrees", azimuth.to_degrees(), elevation.to_degrees()),
                "a finite azimuth and an elevation of -90 to 90 degrees",
            ));
        }
        if rows.is_empty() {
            return Err(Error::invalid(Parameter::Horizon, "without rows", "at least one azimuth with its elevation"));
        }
        rows.iter_mut().for_each(|row| row[0] = row[0].rem_euclid(TAU));
        // the higher first, which stays of those with equal azimuths
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
        rows.dedup_by(|next, row| next[0] == row[0]);
        Ok(Self { rows })
    }

    /// The profile of a table of azimuths and elevations, degrees, all around, from a file or a user.
    ///
    /// # Errors
    /// - Errors of [`HorizonProfile::new`].
    /// - [`Error::InvalidParameter`] for azimuths beyond a full circle, such as those in gon, for azimuths that look
    ///   like radians, for elevations that look like angles from the zenith, and for a table without half of the circle
    ///   ([`HORIZON_ANGLES`]).
    pub fn of_degrees(rows: &[[f64; 2]]) -> Result<Self> {
        let profile = Self::new(rows.iter().map(|row| row.map(f64::to_radians)))?;
        let refused = |value: String, expected| Err(Error::invalid(Parameter::Horizon, value, expected));
        let ends = |column: usize| {
            let values = || rows.iter().map(|row| row[column]);
            [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
        };
        let ([west, east], [lowest, steepest]) = (ends(0), ends(1));
        if lowest >= MIN_ZENITH_ANGLES[0] && steepest >= MIN_ZENITH_ANGLES[1] {
            let value = format!("elevations from {lowest} to {steepest}, which look like angles from the zenith");
            return refused(value, "in degrees above the level: subtract them from 90");
        }
        if west < -180.0 - ROUNDING || east > 360.0 + ROUNDING {
            let value = format!("azimuths from {west} to {east}");
            return refused(value, "in degrees, from -180 or 0 to a full circle; 400 gon are 360 degrees");
        }
        if rows.len() >= MIN_ROWS && west >= -PI - ROUNDING && east <= TAU + ROUNDING && steepest <= FRAC_PI_2 {
            let value = format!("azimuths from {west} to {east}, which look like radians");
            return refused(value, "in degrees; multiply azimuths and elevations by 57.29578");
        }
        let [first, last] = [profile.rows.first(), profile.rows.last()].map(|row| row.map_or(0.0, |row| row[0]));
        let between = profile.rows.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        let widest = between.fold(first + TAU - last, f64::max).to_degrees();
        if HORIZON_ANGLES.is_exceeded_by((widest - ROUNDING).max(0.0)) {
            let value = format!("{} rows, of which two are {widest:.0} degrees apart", profile.rows.len());
            return refused(value, "rows all around, at most 180 degrees apart");
        }
        Ok(profile)
    }

    /// Azimuths clockwise from north and elevations, radians, ascending.
    #[must_use]
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.rows
    }

    /// The same with azimuths that are `by` radians larger: from another north.
    #[must_use]
    pub fn turned(&self, by: f64) -> Self {
        let mut rows: Vec<[f64; 2]> = self.rows.iter().map(|row| [(row[0] + by).rem_euclid(TAU), row[1]]).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self { rows }
    }

    /// Elevation at an azimuth clockwise from north, radians.
    #[must_use]
    pub fn elevation_at(&self, azimuth: f64) -> f64 {
        let azimuth = azimuth.rem_euclid(TAU);
        let after = self.rows.partition_point(|row| row[0] <= azimuth);
        let (Some(&first), Some(&last)) = (self.rows.first(), self.rows.last()) else { return -FRAC_PI_2 };
        let before = after.checked_sub(1).map_or([last[0] - TAU, last[1]], |row| self.rows[row]);
        let after = self.rows.get(after).copied().unwrap_or([first[0] + TAU, first[1]]);
        let share = if after[0] > before[0] { (azimuth - before[0]) / (after[0] - before[0]) } else { 0.0 };
        before[1] + share * (after[1] - before[1])
    }

    /// Returns true if the unit vector `direction` (x east, y north, z up) points below the horizon.
    #[must_use]
    pub fn hides(&self, [x, y, z]: [f64; 3]) -> bool {
        z.atan2(x.hypot(y)) < self.elevation_at(x.atan2(y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_in_other_angles_and_of_half_a_circle_are_refused() {
        let all_around = |step: f64, unit: f64| -> Vec<[f64; 2]> {
            (0_u8..).map(|i| f64::from(i) * step).take_while(|&a| a < 360.0).map(|a| [a * unit, 7.0 * unit]).collect()
        };
        for step in [3.0, 10.0, 45.0, 90.0, 120.0, 180.0] {
            assert!(HorizonProfile::of_degrees(&all_around(step, 1.0)).is_ok(), "{step}");
        }
        let from_south: Vec<[f64; 2]> = all_around(30.0, 1.0).iter().map(|row| [row[0] - 180.0, row[1]]).collect();
        assert!(HorizonProfile::of_degrees(&from_south).is_ok());
        let radian = 1_f64.to_radians();
        for (rows, words) in [
            (all_around(10.0, radian), "radians"),
            (all_around(90.0, radian), "radians"),
            (all_around(10.0, 400.0 / 360.0), "gon"),
            (vec![[0.0, 5.0], [90.0, 5.0], [180.0, 5.0], [400.0, 5.0]], "gon"),
            (vec![[0.0, 5.0], [-270.0, 5.0], [180.0, 5.0]], "full circle"),
            (vec![[0.0, 88.0], [90.0, 81.0], [180.0, 62.0], [270.0, 89.5]], "zenith"),
            (vec![[77.0, 5.0]], "1 rows"),
            (vec![[10.0, 5.0], [60.0, 5.0], [120.0, 3.0]], "250 degrees apart"),
        ] {
            let error = HorizonProfile::of_degrees(&rows).unwrap_err().to_string();
            assert!(error.contains(words), "{words}: {error}");
        }
    }

    #[test]
    fn elevations_are_linear_between_azimuths_all_around() {
        let degrees = |rows: &[[f64; 2]]| HorizonProfile::new(rows.iter().map(|row| row.map(f64::to_radians)));
        // a hill in the north-east, given from -180 to 180
        let profile = degrees(&[[-90.0, 0.0], [0.0, 10.0], [90.0, 20.0], [180.0, 0.0], [-180.0, 2.0]]).unwrap();
        let at = |azimuth: f64| profile.elevation_at(azimuth.to_radians()).to_degrees();
        for (azimuth, expected) in [
            (0.0, 10.0),
            (45.0, 15.0),
            (90.0, 20.0),
            (135.0, 11.0),
            (180.0, 2.0),
            (225.0, 1.0),
            (315.0, 5.0),
            (-45.0, 5.0),
            (720.0, 10.0),
        ] {
            assert!((at(azimuth) - expected).abs() < 1e-9, "{azimuth}: {}", at(azimuth));
        }
        let east = |elevation: f64| {
            let (sin, cos) = elevation.to_radians().sin_cos();
            profile.hides([cos, 0.0, sin])
        };
        assert!(east(19.99) && !east(20.01));
        let turned = profile.turned(30f64.to_radians());
        assert!((turned.elevation_at(120f64.to_radians()).to_degrees() - 20.0).abs() < 1e-9);
        assert_eq!(degrees(&[[77.0, 5.0]]).unwrap().elevation_at(3.0), 5f64.to_radians());
        for wrong in [&[][..], &[[0.0, 91.0]], &[[f64::NAN, 0.0]]] {
            assert!(degrees(wrong).is_err(), "{wrong:?}");
        }
    }
}
