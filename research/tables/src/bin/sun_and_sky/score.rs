//! How far answers are from the truth, in hours of sun and shares of the sky.

use super::JudgedTargets;
use belvedere::Result;
use belvedere::apps::sky_view::SkyDirections;
use std::f64::consts::{PI, TAU};

/// Upper ends of the classes of elevation of the sun, degrees.
pub(crate) const ELEVATIONS_DEG: [f64; 5] = [5.0, 15.0, 30.0, 45.0, 90.0];

/// What is above or beside a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Setting {
    BelowCrown,
    BelowDeck,
    AtWall,
    Open,
}

impl Setting {
    pub(crate) const ALL: [Self; 4] = [Self::BelowCrown, Self::BelowDeck, Self::AtWall, Self::Open];
}

/// Directions of the sun through a day, and of the sky.
pub(crate) struct LightDirections {
    pub(crate) directions: Vec<[f64; 3]>,
    /// How many of them are of the sun; those of the sky follow.
    pub(crate) sun_count: usize,
    /// Hours that each direction of the sun represents.
    pub(super) hours: f64,
}

impl LightDirections {
    /// The sun of a declination at a latitude (radians) every `minutes` of a day while it is above the horizon, and
    /// `sky_count` directions of the sky.
    pub(crate) fn of_day(latitude: f64, declination: f64, minutes: f64, sky_count: usize) -> Result<Self> {
        let steps = (24.0 * 60.0 / minutes).round();
        let ((sin, cos), (sin_d, cos_d)) = (latitude.sin_cos(), declination.sin_cos());
        let mut directions = Vec::new();
        let mut step = 0.5;
        while step < steps {
            let (sin_t, cos_t) = (TAU * step / steps - PI).sin_cos();
            let to_sun = [-cos_d * sin_t, cos * sin_d - sin * cos_d * cos_t, sin * sin_d + cos * cos_d * cos_t];
            if to_sun[2] > 0.0 {
                directions.push(to_sun);
            }
            step += 1.0;
        }
        let sun_count = directions.len();
        directions.extend(SkyDirections::even(sky_count)?.directions);
        Ok(Self { directions, sun_count, hours: minutes / 60.0 })
    }

    /// Class of elevation of a direction.
    fn class(&self, direction: usize) -> usize {
        let elevation = self.directions.get(direction).map_or(0.0, |d| d[2].asin().to_degrees());
        ELEVATIONS_DEG.iter().position(|&max| elevation < max).unwrap_or(ELEVATIONS_DEG.len() - 1)
    }
}

/// How far answers are from the truth.
#[derive(Clone, Debug, Default)]
pub(crate) struct LightScore {
    /// Hours of sun: mean true, mean absolute error, and mean hours wrongly lit and wrongly shaded.
    pub(crate) sun: [f64; 4],
    /// These values with the sun above 5 degrees.
    pub(crate) sun_above_5: [f64; 4],
    /// Sky view factor of the level plane, and openness: mean true, mean absolute error, bias.
    pub(crate) factor: [f64; 3],
    pub(crate) openness: [f64; 3],
    /// Mean hours wrongly lit and wrongly shaded by class of elevation of the sun.
    pub(crate) by_elevation: [[f64; 2]; ELEVATIONS_DEG.len()],
    /// By what is above or beside: share of the targets, and what of the mean absolute error, of the hours wrongly lit
    /// and of the hours wrongly shaded they make; sky view factors likewise.
    pub(crate) by_setting: [[f64; 5]; Setting::ALL.len()],
}

impl LightScore {
    /// Of what `is_free` says of each target and direction.
    pub(super) fn new(places: &JudgedTargets, light: &LightDirections, is_free: &dyn Fn(usize, usize) -> bool) -> Self {
        let mut score = LightScore::default();
        let width = light.directions.len();
        let one = 1.0 / places.len().max(1) as f64;
        let sky_count = (width - light.sun_count) as f64;
        for (target, (free, setting)) in places.free.chunks(width).zip(&places.settings).enumerate() {
            let mut lit = [[0.0; 2]; 2];
            let mut wrong = [[0.0; 2]; 2];
            let mut sky = [[0.0; 2]; 2];
            for (column, (&truly, direction)) in free.iter().zip(&light.directions).enumerate() {
                let seen = is_free(target, column);
                if column >= light.sun_count {
                    for (i, is_free) in [truly, seen].into_iter().enumerate() {
                        sky[0][i] += f64::from(u8::from(is_free)) * 2.0 * direction[2] / sky_count;
                        sky[1][i] += f64::from(u8::from(is_free)) / sky_count;
                    }
                    continue;
                }
                let class = light.class(column);
                for above in 0..if class > 0 { 2 } else { 1 } {
                    lit[above][0] += if truly { light.hours } else { 0.0 };
                    lit[above][1] += if seen { light.hours } else { 0.0 };
                    if seen != truly {
                        wrong[above][usize::from(truly)] += light.hours;
                    }
                }
                if seen != truly {
                    score.by_elevation[class][usize::from(truly)] += one * light.hours;
                }
            }
            for (sums, (lit, wrong)) in
                [&mut score.sun, &mut score.sun_above_5].into_iter().zip(lit.into_iter().zip(wrong))
            {
                for (sum, value) in sums.iter_mut().zip([lit[0], (lit[1] - lit[0]).abs(), wrong[0], wrong[1]]) {
                    *sum += one * value;
                }
            }
            for (sums, [truly, seen]) in [&mut score.factor, &mut score.openness].into_iter().zip(sky) {
                for (sum, value) in sums.iter_mut().zip([truly, (seen - truly).abs(), seen - truly]) {
                    *sum += one * value;
                }
            }
            let row = Setting::ALL.iter().position(|other| other == setting).unwrap_or_default();
            let parts = [1.0, (lit[0][1] - lit[0][0]).abs(), wrong[0][0], wrong[0][1], (sky[0][1] - sky[0][0]).abs()];
            for (sum, value) in score.by_setting[row].iter_mut().zip(parts) {
                *sum += one * value;
            }
        }
        score
    }
}
