//! Glare: from when to when flat panels and glass reflect the sun to observers.
//!
//! # Source
//! Ho, Ghanbari & Diver 2011, Methodology to assess potential glint and glare hazards from concentrating solar power
//! plants, J. Solar Energy Engineering 133: irradiance of the retina and thresholds. Exact lines of sight: Peters,
//! Ledoux & Biljecki 2015, section 3.

use crate::exposure::plane_normal;
use crate::irradiance::glass_reflectance;
use crate::sun::SunSchedule;
use crate::targets::{TARGET_LIFT, Window};
use belvedere_core::query::MedialScene;
use belvedere_data::control::Control;
use belvedere_data::error::check_length;
use belvedere_data::vector::{cross, dot, length, sub, to_f32, unit};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Half of the angle that the sun subtends, radians: 9.3 mrad (Ho et al. 2011).
const SUN_RADIUS: f64 = 0.00465;
/// Diameter of the pupil by day and focal length of the eye, metres, and transmission of the eye (Ho et al. 2011).
const PUPIL: f64 = 0.002;
const FOCAL_LENGTH: f64 = 0.017;
const EYE_TRANSMISSION: f64 = 0.5;
/// Irradiance of the retina from which an after-image stays: factor, W/cm², and exponent of the angle of the source,
/// radians (Ho et al. 2011).
const AFTER_IMAGE: [f64; 2] = [3.59e-5, -1.77];
/// Square metres of a square centimetre.
const CM2: f64 = 1e-4;
/// Sides of reflectors, metres: a pane, and a field of panels.
const SIDES: [f64; 2] = [0.01, 10_000.0];
/// Maximum difference of the end of a step and the start of the next that follows it, hours: rounding of f32.
const ROUNDING: f32 = 1e-4;

/// A flat rectangle that reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflector {
    center: [f64; 3],
    /// Unit vectors: away from the surface, along its level side, and along the other.
    normal: [f64; 3],
    sides: [[f64; 3]; 2],
    /// Half of its width and height, metres.
    half: [f64; 2],
}

/// Optical properties of reflectors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GlareParams {
    /// Angle by which the surface spreads a beam beyond the width of the sun, to each side, radians, 0 to 0.2. Default:
    /// 13.1 mrad (0.75°), twice the slope error of 6.55 mrad of smooth glass (Ho et al. 2011).
    pub scatter: f64,
    /// Minimum angle between the reflection and the sun itself, as the eye sees both, radians, 0 to π: nearer to it the
    /// sun dazzles anyway. Default: 0. German authorities take 10° (LAI 2012, annex 2).
    pub min_separation: f64,
}

/// Glare at an eye.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EyeGlare {
    /// Stretches of each reflector.
    pub of_reflectors: Vec<Vec<GlareStretch>>,
    /// Stretches in which any of them dazzles. A step has an after-image if one of them gives it, and is unproven if
    /// all are.
    pub of_any: Vec<GlareStretch>,
}

/// Time without a break in which a reflector dazzles an observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareStretch {
    /// Row of the day in the schedule.
    pub day: usize,
    /// Start and end, hours on the clocks of the zone from the beginning of the date.
    pub start: f32,
    /// End, likewise.
    pub end: f32,
    /// Hours of it that may leave an after-image.
    pub after_image: f32,
    /// Hours of it whose lines run too far through space that no pulse came near to.
    pub unproven: f32,
}

/// A reflection of the sun that reaches an eye.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reflection {
    has_after_image: bool,
    is_unproven: bool,
}

impl Default for GlareParams {
    fn default() -> Self {
        Self { scatter: 0.0131, min_separation: 0.0 }
    }
}

impl GlareParams {
    /// Checks the range.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`].
    pub fn validate(&self) -> Result<()> {
        let invalid = |parameter, radians: f64, expected| {
            Err(Error::invalid(parameter, format!("{} degrees", radians.to_degrees()), expected))
        };
        if !(0.0..=0.2).contains(&self.scatter) {
            return invalid(Parameter::Scatter, self.scatter, "0 to 11.4 degrees");
        }
        if !(0.0..=PI).contains(&self.min_separation) {
            return invalid(Parameter::MinSeparation, self.min_separation, "0 to 180 degrees");
        }
        Ok(())
    }
}

impl GlareStretch {
    /// Duration, hours.
    #[must_use]
    pub fn hours(&self) -> f32 {
        self.end - self.start
    }
}

impl Reflector {
    /// The rectangle of a window with a size.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one without a place, a direction or sides of 0.01 to 10 000 m.
    pub fn of(window: &Window) -> Result<Self> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Reflector, value, expected));
        let normal =
            unit(plane_normal(window.azimuth, window.tilt)).filter(|normal| normal.iter().all(|v| v.is_finite()));
        let (Some(normal), true) = (normal, window.center.iter().all(|v| v.is_finite())) else {
            return invalid(format!("at {:?}", window.center), "finite, with a direction");
        };
        let Some(size) = window.size else {
            return invalid("without a size".to_owned(), "a rectangle with width and height in metres");
        };
        if !size.iter().all(|side| (SIDES[0]..=SIDES[1]).contains(side)) {
            return invalid(format!("{} m by {} m", size[0], size[1]), "with sides of 0.01 to 10000 m");
        }
        // the level side, by the azimuth also where it looks straight up; without one east
        let (sin, cos) = window.azimuth.sin_cos();
        let across = if window.azimuth.is_finite() { [-cos, sin, 0.0] } else { [1.0, 0.0, 0.0] };
        let sides = [across, cross(normal, across)];
        Ok(Self { center: window.center, normal, sides, half: size.map(|side| side / 2.0) })
    }

    /// The place at distances from the middle along both sides, metres.
    fn place(&self, [across, along]: [f64; 2]) -> [f64; 3] {
        std::array::from_fn(|i| self.center[i] + across * self.sides[0][i] + along * self.sides[1][i])
    }

    /// The place before its middle that light leaves from.
    #[must_use]
    pub fn front(&self) -> [f64; 3] {
        self.lifted(self.center)
    }

    /// A place in front of one on the surface.
    fn lifted(&self, place: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| place[i] + TARGET_LIFT * self.normal[i])
    }

    /// The direction in which `eye` sees the sun in the plane of the reflector; `None` where one of them is behind it.
    fn mirrored(&self, eye: [f64; 3], to_sun: [f64; 3]) -> Option<[f64; 3]> {
        let cosine = dot(self.normal, to_sun);
        let is_before = cosine > 0.0 && dot(self.normal, sub(eye, self.center)) > 0.0;
        is_before.then(|| std::array::from_fn(|i| to_sun[i] - 2.0 * cosine * self.normal[i]))
    }

    /// The place of the rectangle nearest to the mirrored sun as seen from `eye`, if it is at most `reach` radians away
    /// from its middle.
    fn nearest_place(&self, eye: [f64; 3], to_sun: [f64; 3], reach: f64) -> Option<[f64; 3]> {
        let towards = self.mirrored(eye, to_sun)?;
        let from_center = sub(eye, self.center);
        let distance = dot(self.normal, from_center) / -dot(self.normal, towards);
        let hit: [f64; 3] = std::array::from_fn(|i| from_center[i] + distance * towards[i]);
        let [across, along] = self.sides.map(|side| dot(side, hit));
        if across.abs() <= self.half[0] && along.abs() <= self.half[1] {
            return Some(self.place([across, along]));
        }
        let [w, h] = self.half;
        let corners = [[-w, -h], [w, -h], [w, h], [-w, h]].map(|corner| self.place(corner));
        let of_edge = |number: usize| nearest_on_edge(eye, towards, corners[number], corners[(number + 1) % 4]);
        let nearest = (0..4).map(of_edge).max_by(|a, b| a.0.total_cmp(&b.0))?;
        (nearest.0 >= reach.cos()).then_some(nearest.1)
    }

    /// Angle that the rectangle subtends from `eye`, radians: that of a disc of the same apparent area.
    fn subtended(&self, eye: [f64; 3]) -> f64 {
        let from_center = sub(eye, self.center);
        let distance = length(from_center).max(f64::MIN_POSITIVE);
        let area = 4.0 * self.half[0] * self.half[1] * dot(self.normal, from_center).abs() / distance;
        2.0 * (area / PI).sqrt() / distance
    }
}

/// The greatest cosine of the angle between `towards` and the directions from `eye` to the places of an edge, and that
/// place.
fn nearest_on_edge(eye: [f64; 3], towards: [f64; 3], from: [f64; 3], to: [f64; 3]) -> (f64, [f64; 3]) {
    let (start, edge) = (sub(from, eye), sub(to, from));
    let [p, q] = [dot(start, towards), dot(edge, towards)];
    let [square, mixed, edge_square] = [dot(start, start), dot(start, edge), dot(edge, edge)];
    // where the derivative of (p + qt) / |start + t edge| is zero
    let stationary = (p * mixed - q * square) / (q * mixed - p * edge_square);
    let at = |share: f64| {
        let seen: [f64; 3] = std::array::from_fn(|i| start[i] + share * edge[i]);
        let cosine = dot(seen, towards) / length(seen);
        (cosine, std::array::from_fn(|i| eye[i] + seen[i]))
    };
    let inner = if (0.0..=1.0).contains(&stationary) { stationary } else { 0.0 };
    let tried = [at(0.0), at(inner), at(1.0)];
    tried.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_else(|| at(0.0))
}

/// Computes the glare of `reflectors` at each of `eyes`, local metres. `direct` is the direct radiation of each
/// direction of `schedule`, W/m², (D). An eye that is not finite has none. Progress counts pairs.
///
/// The sun counts as a disc, and the reflector spreads its beam by [`GlareParams::scatter`]. The line from the place of
/// the reflector nearest to the mirrored sun must be free to the sun and to the eye.
///
/// # Errors
/// [`Error::LengthMismatch`] unless each direction has a radiation; [`Error::InvalidParameter`]; [`Error::Cancelled`].
pub fn glare(
    scene: &MedialScene,
    (eyes, reflectors): (&[[f64; 3]], &[Reflector]),
    (schedule, direct): (&SunSchedule, &[f64]),
    params: &GlareParams,
    control: &Control<'_>,
) -> Result<Vec<EyeGlare>> {
    params.validate()?;
    check_length("direct radiation", schedule.directions.len(), direct.len())?;
    let of_pair = |eye: [f64; 3], reflector: &Reflector| -> Vec<Option<Reflection>> {
        if !eye.iter().all(|v| v.is_finite()) {
            return vec![None; direct.len()];
        }
        let suns = schedule.directions.par_iter().zip(direct);
        suns.map(|(&to_sun, &direct)| reflection(scene, (eye, reflector), (to_sun, direct), params)).collect()
    };
    let of_eye = |&eye: &[f64; 3]| {
        let mut any = vec![None; direct.len()];
        let mut of_reflectors = Vec::new();
        for reflector in reflectors {
            control.check()?;
            let reflections = of_pair(eye, reflector);
            any = any.into_iter().zip(&reflections).map(|(any, &own)| Reflection::either(any, own)).collect();
            of_reflectors.push(stretches(schedule, &reflections));
            control.advance(1);
        }
        Ok(EyeGlare { of_reflectors, of_any: stretches(schedule, &any) })
    };
    eyes.iter().map(of_eye).collect()
}

impl Reflection {
    /// What two reflections at the same time are together.
    fn either(a: Option<Self>, b: Option<Self>) -> Option<Self> {
        let (Some(one), Some(other)) = (a, b) else { return a.or(b) };
        Some(Self {
            has_after_image: one.has_after_image || other.has_after_image,
            is_unproven: one.is_unproven && other.is_unproven,
        })
    }
}

/// The reflection of a sun in a reflector that reaches an eye.
fn reflection(
    scene: &MedialScene,
    (eye, reflector): ([f64; 3], &Reflector),
    (to_sun, direct): ([f64; 3], f64),
    params: &GlareParams,
) -> Option<Reflection> {
    let reach = SUN_RADIUS + params.scatter;
    let place = reflector.nearest_place(eye, to_sun, reach)?;
    let seen = unit(sub(place, eye))?;
    if length(cross(seen, to_sun)).atan2(dot(seen, to_sun)) < params.min_separation {
        return None;
    }
    let start = reflector.lifted(place);
    let to_eye = sub(eye, start);
    let distance = length(to_eye);
    let to_eye = unit(to_eye)?;
    let is_hidden = scene.first_block(start, to_eye, distance).is_some()
        || scene.first_block(start, to_sun, f64::INFINITY).is_some()
        || scene.far_terrain().hides(start, to_sun);
    if is_hidden {
        return None;
    }
    let is_unproven = scene.is_unproven(start, to_sun, f64::INFINITY) || scene.is_unproven(start, to_eye, distance);
    let cosine = dot(reflector.normal, to_sun);
    let spread = 2.0 * reach;
    let has_after_image = retinal_irradiance(direct * glass_reflectance(cosine), spread)
        >= after_image_from(spread.min(reflector.subtended(eye)));
    Some(Reflection { has_after_image, is_unproven })
}

/// Irradiance of the retina, W/cm², below a beam of `irradiance` W/m² before spreading, that spreads to an angle of
/// `spread` radians: the radiance of the source stays, whatever its distance.
fn retinal_irradiance(irradiance: f64, spread: f64) -> f64 {
    irradiance * CM2 * EYE_TRANSMISSION * (PUPIL / (FOCAL_LENGTH * spread)).powi(2)
}

/// Irradiance of the retina from which a source of an angle, radians, leaves an after-image, W/cm².
fn after_image_from(angle: f64) -> f64 {
    AFTER_IMAGE[0] * angle.powf(AFTER_IMAGE[1])
}

/// Joins the steps of a schedule with reflections.
fn stretches(schedule: &SunSchedule, reflections: &[Option<Reflection>]) -> Vec<GlareStretch> {
    let mut joined: Vec<GlareStretch> = Vec::new();
    for (day, light) in schedule.days.iter().enumerate() {
        for step in &light.steps {
            let Some(found) = reflections.get(step.direction as usize).copied().flatten() else { continue };
            let hours = |counts: bool| if counts { step.hours } else { 0.0 };
            let (after_image, unproven) = (hours(found.has_after_image), hours(found.is_unproven));
            let end = step.start + step.hours;
            match joined.last_mut() {
                Some(last) if last.day == day && step.start <= last.end + ROUNDING => {
                    last.end = end;
                    last.after_image += after_image;
                    last.unproven += unproven;
                }
                _ => joined.push(GlareStretch { day, start: step.start, end, after_image, unproven }),
            }
        }
    }
    joined
}

/// Minutes of stretches in each hour of the clock, of each month, (12, 24).
#[must_use]
pub fn glare_by_hour(stretches: &[GlareStretch], schedule: &SunSchedule) -> [[f32; 24]; 12] {
    let mut minutes = [[0.0; 24]; 12];
    for stretch in stretches {
        let Some(day) = schedule.days.get(stretch.day) else { continue };
        let month = usize::from(day.date.month().unsigned_abs()).saturating_sub(1).min(11);
        // the day of the sun may reach beyond the date
        for shift in [-24.0, 0.0, 24.0] {
            let (start, end) = (stretch.start + shift, stretch.end + shift);
            for (hour, sum) in minutes[month].iter_mut().enumerate() {
                let hour = to_f32(hour as f64);
                *sum += 60.0 * (end.min(hour + 1.0) - start.max(hour)).max(0.0);
            }
        }
    }
    minutes
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// A pane of 2 m by 1 m in a wall that faces south, 10 m up.
    fn pane() -> Reflector {
        Reflector::of(&Window::new([0.0, 0.0, 10.0], PI, FRAC_PI_2, Some([2.0, 1.0]))).unwrap()
    }

    fn direction(azimuth_deg: f64, elevation_deg: f64) -> [f64; 3] {
        let [azimuth, elevation] = [azimuth_deg, elevation_deg].map(f64::to_radians);
        [elevation.cos() * azimuth.sin(), elevation.cos() * azimuth.cos(), elevation.sin()]
    }

    #[test]
    fn a_mirror_sends_the_sun_down_at_its_own_elevation() {
        let pane = pane();
        // sun in the south, 30 degrees high: 20 m before the wall, the light of the middle is 11.547 m lower
        let sun = direction(180.0, 30.0);
        let eye = |down: f64| [0.0, -20.0, 10.0 - down];
        let deep = 20.0 * 30_f64.to_radians().tan();
        let place = pane.nearest_place(eye(deep), sun, 0.0).unwrap();
        assert!(length(sub(place, [0.0, 0.0, 10.0])) < 1e-12);
        // the light of the edges of a perfect mirror, half a metre above and below, and no farther
        for (down, hits) in [(0.49, true), (0.51, false), (-0.49, true), (-0.51, false)] {
            assert_eq!(pane.nearest_place(eye(deep + down), sun, 0.0).is_some(), hits, "{down}");
        }
        // behind the wall, and with the sun behind it, there is nothing
        assert_eq!(pane.nearest_place([0.0, 20.0, 0.0], sun, 0.1), None);
        assert_eq!(pane.nearest_place(eye(deep), direction(0.0, 30.0), 0.1), None);
    }

    #[test]
    fn the_nearest_place_is_that_of_a_fine_grid() {
        for case in 0..300_u64 {
            let mut counter = 0;
            let mut between = |low: f64, high: f64| {
                counter += 1;
                low + (high - low) * belvedere_data::random::uniform(case, counter)
            };
            let window = Window::new(
                [0.0; 3],
                between(0.0, 6.2),
                between(0.1, 1.5),
                Some([between(0.2, 5.0), between(0.2, 5.0)]),
            );
            let reflector = Reflector::of(&window).unwrap();
            let eye = [0, 1, 2].map(|i| 12.0 * reflector.normal[i] + between(-9.0, 9.0));
            let sun = direction(between(0.0, 360.0), between(1.0, 80.0));
            let Some(towards) = reflector.mirrored(eye, sun) else { continue };
            let angle_to = |place: [f64; 3]| {
                let seen = unit(sub(place, eye)).unwrap();
                length(cross(seen, towards)).atan2(dot(seen, towards))
            };
            let found = angle_to(reflector.nearest_place(eye, sun, PI).unwrap());
            let steps = 200;
            let part = |step: i32, half: f64| half * (2.0 * f64::from(step) / f64::from(steps) - 1.0);
            let grid = (0..=steps).flat_map(|i| (0..=steps).map(move |j| [i, j]));
            let best = grid
                .map(|[i, j]| angle_to(reflector.place([part(i, reflector.half[0]), part(j, reflector.half[1])])))
                .fold(f64::INFINITY, f64::min);
            // a step of the grid is seen below an angle of 0.03 m over 3 m
            assert!(found <= best + 1e-9 && best - found < 0.02, "{found} {best}");
        }
    }

    #[test]
    fn the_sun_itself_lies_between_after_image_and_burn() {
        // Ho et al. 2011: a look at the sun, 0.1 W/cm2 and 9.3 mrad, gives 8 W/cm2 on the retina, above the limit of an
        // after-image and below that of a burn, 0.118 / 0.0093 = 12.7 W/cm2
        let sun = retinal_irradiance(1000.0, 2.0 * SUN_RADIUS);
        assert!((sun - 8.0).abs() < 0.05, "{sun}");
        assert!(after_image_from(2.0 * SUN_RADIUS) < 0.15 && sun < 12.7);
    }

    #[test]
    fn two_reflections_together_are_strong_if_one_is_and_unproven_if_both_are() {
        let one = |has_after_image, is_unproven| Some(Reflection { has_after_image, is_unproven });
        assert_eq!(Reflection::either(one(true, true), one(false, false)), one(true, false));
        assert_eq!(Reflection::either(one(false, true), one(false, true)), one(false, true));
        assert_eq!(Reflection::either(None, one(false, true)), one(false, true));
        assert_eq!(Reflection::either(None, None), None);
    }

    #[test]
    fn level_panels_lie_as_their_azimuth_says() {
        let of = |tilt: f64| Reflector::of(&Window::new([0.0; 3], FRAC_PI_2, tilt, Some([20.0, 1.0]))).unwrap();
        for (level, tilted) in of(0.0).sides.iter().zip(of(1e-9).sides) {
            assert!(length(sub(*level, tilted)) < 1e-6, "{level:?} {tilted:?}");
        }
    }

    #[test]
    fn windows_without_a_size_and_odd_scatter_are_refused() {
        for size in [None, Some([0.0, 1.0]), Some([1.0, f64::NAN])] {
            assert!(Reflector::of(&Window::new([0.0; 3], 0.0, 0.5, size)).is_err(), "{size:?}");
        }
        assert!(Reflector::of(&Window::new([f64::NAN; 3], 0.0, 0.5, Some([1.0, 1.0]))).is_err());
        for scatter in [-0.01, 0.3, f64::NAN] {
            assert!(GlareParams { scatter, ..GlareParams::default() }.validate().is_err());
            assert!(GlareParams { min_separation: 20.0 * scatter, ..GlareParams::default() }.validate().is_err());
        }
        assert!(GlareParams::default().validate().is_ok());
    }
}
