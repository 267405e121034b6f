//! Wirelines: terrain, obstacles and towers as an eye sees them, in the frames of visual impact assessments.
//!
//! # Source
//! Scottish Natural Heritage 2017, Visual Representation of Wind Farms: planar frames of 53.5° x 18.2°.

use crate::towers::Tower;
use belvedere_core::query::{Answer, EarthParams, MedialScene, VerticalLine, VisibleTerrain};
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Horizontal angle of a frame, degrees.
const FRAME_ANGLE_DEG: f64 = 53.5;
/// Columns of a frame.
pub const FRAME_COLUMNS: usize = 1600;
/// Maximum angle between towers of one frame, degrees: a margin is left at both sides.
const MAX_SPREAD_DEG: f64 = 46.0;
/// Azimuths of the skyline of the cloud: one for each 0.05 degrees.
const SKYLINE_AZIMUTHS: usize = 7200;
/// Vertical lines through a rotor at most.
const MAX_ROTOR_LINES: usize = 201;

/// View of towers from an eye, with what stands before and behind them.
#[derive(Clone, Debug, PartialEq)]
pub struct Wireline {
    /// The eye, local metres.
    pub eye: [f64; 3],
    /// Towers within the distance that counts, in the order of their azimuths within the frames.
    pub towers: Vec<TowerOutline>,
    /// Frames that hold all towers, clockwise.
    pub frames: Vec<WirelineFrame>,
}

/// A picture plane that an eye looks through.
#[derive(Clone, Debug, PartialEq)]
pub struct WirelineFrame {
    /// Azimuth of its middle, radians from grid north.
    pub azimuth: f64,
    /// Elevation of the skyline of the cloud in each column, radians, and its range, metres; −π/2 where it is empty.
    pub skyline: Vec<[f64; 2]>,
    /// Visible pieces of the terrain beyond the cloud in each column, from near to far.
    pub terrain: Vec<Vec<VisibleTerrain>>,
}

/// A tower as an eye sees it. Elevations are apparent ones, radians.
#[derive(Clone, Debug, PartialEq)]
pub struct TowerOutline {
    /// Number of the tower, from 0.
    pub number: usize,
    /// Azimuth, radians from grid north, 0 to 2π.
    pub azimuth: f64,
    /// Horizontal distance, metres.
    pub distance: f64,
    /// Elevations of foot and tip.
    pub elevations: [f64; 2],
    /// Elevation of the hub; `None` where it has none.
    pub hub: Option<f64>,
    /// Visible parts of the line from foot to tip: elevations.
    pub visible: Vec<[f64; 2]>,
    /// Their length together, metres.
    pub visible_metres: f64,
    /// True if the middle of the longest visible part is unproven; `None` if nothing is visible, or without pulses.
    pub is_unproven: Option<bool>,
    /// The swept disc, seen from the front; `None` without a hub.
    pub rotor: Option<RotorOutline>,
}

/// The disc that blades sweep, its face turned to the eye.
#[derive(Clone, Debug, PartialEq)]
pub struct RotorOutline {
    /// Azimuth of each vertical line through the disc, radians from grid north, and its visible parts: elevations.
    pub lines: Vec<(f64, Vec<[f64; 2]>)>,
    /// Angle between two lines, radians.
    pub line_width: f64,
    /// Visible share of the area.
    pub visible_share: f64,
}

impl WirelineFrame {
    /// Distance of the picture plane, columns.
    #[must_use]
    pub fn plane_distance() -> f64 {
        FRAME_COLUMNS as f64 / 2.0 / (FRAME_ANGLE_DEG / 2.0).to_radians().tan()
    }

    /// Azimuth of the middle of a column, radians from grid north.
    #[must_use]
    pub fn azimuth_of(middle: f64, column: usize) -> f64 {
        middle + ((column as f64 + 0.5 - FRAME_COLUMNS as f64 / 2.0) / Self::plane_distance()).atan()
    }

    /// Place of a direction on the plane, columns to the right of the middle and rows above the level of the eye;
    /// `None` for one that does not meet the plane within 80 degrees of its middle.
    #[must_use]
    pub fn on_plane(&self, azimuth: f64, elevation: f64) -> Option<[f64; 2]> {
        let aside = turn(azimuth - self.azimuth);
        (aside.abs() < 80f64.to_radians()).then(|| {
            let distance = Self::plane_distance();
            [distance * aside.tan(), distance * elevation.tan() / aside.cos()]
        })
    }

    fn new(scene: &MedialScene, eye: [f64; 3], azimuth: f64, skyline: &[[f64; 2]], earth: &EarthParams) -> Self {
        let azimuths = || (0..FRAME_COLUMNS).map(|column| Self::azimuth_of(azimuth, column));
        let nearest = |azimuth: f64| {
            let row = to_index((azimuth.rem_euclid(TAU) / TAU * skyline.len() as f64).round());
            skyline.get(row % skyline.len().max(1)).copied().unwrap_or([-PI / 2.0, f64::INFINITY])
        };
        let all: Vec<f64> = azimuths().collect();
        let terrain = all.par_iter().map(|&azimuth| scene.far_terrain().visible_pieces(eye, azimuth, earth)).collect();
        Self { azimuth, skyline: azimuths().map(nearest).collect(), terrain }
    }
}

/// An angle as −π to π.
fn turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The view of `towers` within `max_distance` metres from `eye`, local metres, over the earth of `earth`. An eye
/// without towers within that distance has no frames.
///
/// Visible parts of towers and rotors are exact for the model, as in [`crate::towers::towers_seen`]. The skyline has
/// steps of 0.05 degrees, and the terrain those of [`belvedere_core::query::FarTerrain::visible_pieces`].
///
/// # Errors
/// [`Error::InvalidParameter`] for an eye that is not finite, and [`Error::Cancelled`].
pub fn wireline(
    scene: &MedialScene,
    towers: &[Tower],
    eye: [f64; 3],
    (earth, max_distance): (&EarthParams, f64),
    control: &Control<'_>,
) -> Result<Wireline> {
    if !eye.iter().all(|v| v.is_finite()) {
        return Err(Error::invalid(Parameter::Eye, format!("{eye:?}"), "three finite coordinates"));
    }
    let within = |tower: &Tower| {
        let distance = (tower.line.foot[0] - eye[0]).hypot(tower.line.foot[1] - eye[1]);
        distance > 0.0 && distance <= max_distance
    };
    let shown: Vec<(usize, &Tower)> = towers.iter().enumerate().filter(|(_, tower)| within(tower)).collect();
    let outlines: Result<Vec<TowerOutline>> = shown
        .into_par_iter()
        .map(|(number, tower)| {
            control.check()?;
            Ok(TowerOutline::new(scene, number, tower, eye, earth))
        })
        .collect();
    let (towers, middles) = in_frames(outlines?);
    if middles.is_empty() {
        return Ok(Wireline { eye, towers, frames: Vec::new() });
    }
    let skyline = scene.skyline_of_cloud(eye, SKYLINE_AZIMUTHS, 0.0, earth, control)?;
    let skyline: Vec<[f64; 2]> = skyline.iter().map(|point| [point.elevation, point.range]).collect();
    let frame = |middle: f64| {
        control.check()?;
        Ok(WirelineFrame::new(scene, eye, middle, &skyline, earth))
    };
    let frames: Result<Vec<WirelineFrame>> = middles.into_iter().map(frame).collect();
    Ok(Wireline { eye, towers, frames: frames? })
}

/// Orders towers clockwise after the widest gap between them, and returns the middles of the frames that hold them.
fn in_frames(mut towers: Vec<TowerOutline>) -> (Vec<TowerOutline>, Vec<f64>) {
    towers.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth).then(a.number.cmp(&b.number)));
    let count = towers.len();
    let gap = |i: usize| (towers[i].azimuth - towers[(i + count - 1) % count].azimuth).rem_euclid(TAU);
    if let Some(first) = (0..count).max_by(|&a, &b| gap(a).total_cmp(&gap(b)).then(b.cmp(&a))) {
        towers.rotate_left(first);
    }
    let mut middles = Vec::new();
    let mut rest = &towers[..];
    while let Some(first) = rest.first() {
        let from = |tower: &TowerOutline| (tower.azimuth - first.azimuth).rem_euclid(TAU);
        let held = rest.iter().take_while(|tower| from(tower) <= MAX_SPREAD_DEG.to_radians()).count();
        middles.push((first.azimuth + from(&rest[held - 1]) / 2.0).rem_euclid(TAU));
        rest = &rest[held..];
    }
    (towers, middles)
}

impl TowerOutline {
    fn new(scene: &MedialScene, number: usize, tower: &Tower, eye: [f64; 3], earth: &EarthParams) -> Self {
        let VerticalLine { foot, height } = tower.line;
        let azimuth = (foot[0] - eye[0]).atan2(foot[1] - eye[1]).rem_euclid(TAU);
        let distance = (foot[0] - eye[0]).hypot(foot[1] - eye[1]);
        let (visible, visible_metres, longest) = seen(scene, tower.line, eye, earth);
        let at = |above: f64| earth.apparent_elevation(eye, [foot[0], foot[1], foot[2] + above]);
        let rotor = tower.hub.filter(|hub| height > *hub).map(|hub| {
            let center = [foot[0], foot[1], foot[2] + hub];
            RotorOutline::new(scene, (center, height - hub), (azimuth, distance), eye, earth)
        });
        let longest = longest.or(rotor.as_ref().and_then(|(_, longest)| *longest)).filter(|_| scene.proof().is_some());
        let is_unproven = |middle| scene.far_sight_answer(eye, middle, earth) == Answer::Unproven;
        Self {
            number,
            azimuth,
            distance,
            elevations: [at(0.0), at(height)],
            hub: tower.hub.map(at),
            visible,
            visible_metres,
            is_unproven: longest.map(is_unproven),
            rotor: rotor.map(|(rotor, _)| rotor),
        }
    }
}

impl RotorOutline {
    /// The disc at `center` of `radius`, metres, that faces an eye at `distance` in the direction `azimuth`.
    fn new(
        scene: &MedialScene,
        (center, radius): ([f64; 3], f64),
        (azimuth, distance): (f64, f64),
        eye: [f64; 3],
        earth: &EarthParams,
    ) -> (Self, Option<[f64; 3]>) {
        let columns = 2.0 * radius / distance * WirelineFrame::plane_distance();
        let count = to_index(columns.ceil().clamp(9.0, MAX_ROTOR_LINES as f64)) | 1;
        let across = [azimuth.cos(), -azimuth.sin()];
        let (mut whole, mut open, mut longest) = (0.0, 0.0, (0.0, None));
        let line = |i: usize| {
            let aside = radius * (2.0 * (i as f64 + 0.5) / count as f64 - 1.0);
            let half = (radius * radius - aside * aside).sqrt();
            let foot = [center[0] + aside * across[0], center[1] + aside * across[1], center[2] - half];
            let (visible, metres, middle) = seen(scene, VerticalLine { foot, height: 2.0 * half }, eye, earth);
            if metres > longest.0 {
                longest = (metres, middle);
            }
            whole += 2.0 * half;
            open += metres;
            ((foot[0] - eye[0]).atan2(foot[1] - eye[1]).rem_euclid(TAU), visible)
        };
        let lines = (0..count).map(line).collect();
        let outline = Self { lines, line_width: 2.0 * radius / count as f64 / distance, visible_share: open / whole };
        (outline, longest.1)
    }
}

/// The visible parts of a line as elevations, their length, metres, and the middle of the longest.
fn seen(
    scene: &MedialScene,
    line: VerticalLine,
    eye: [f64; 3],
    earth: &EarthParams,
) -> (Vec<[f64; 2]>, f64, Option<[f64; 3]>) {
    let spans = scene.vertical_sight(line, earth).seen_from(eye);
    let at = |above: f64| earth.apparent_elevation(eye, [line.foot[0], line.foot[1], line.foot[2] + above]);
    let metres = spans.iter().map(|[from, to]| to - from).fold(0.0, |sum, length| sum + length);
    let longest = spans.iter().copied().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let [x, y, z] = line.foot;
    let middle = longest.map(|[from, to]| [x, y, z + f64::midpoint(from, to)]);
    (spans.iter().map(|span| span.map(at)).collect(), metres, middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn towers(azimuths_deg: &[f64]) -> Vec<TowerOutline> {
        let outline = |(number, azimuth): (usize, &f64)| TowerOutline {
            number,
            azimuth: azimuth.to_radians(),
            distance: 1000.0,
            elevations: [0.0, 0.1],
            hub: None,
            visible: Vec::new(),
            visible_metres: 0.0,
            is_unproven: None,
            rotor: None,
        };
        azimuths_deg.iter().enumerate().map(outline).collect()
    }

    #[test]
    fn towers_across_north_share_a_frame_and_those_all_around_have_several() {
        let (order, middles) = in_frames(towers(&[10.0, 350.0, 5.0]));
        assert_eq!(order.iter().map(|tower| tower.number).collect::<Vec<_>>(), [1, 2, 0]);
        assert_eq!(middles.len(), 1);
        assert!(turn(middles[0]).abs() < 1e-9, "{middles:?}");
        let around: Vec<f64> = (0..36).map(|i| f64::from(i) * 10.0).collect();
        let (order, middles) = in_frames(towers(&around));
        assert_eq!(order.len(), 36);
        // five towers span 40 degrees
        assert_eq!(middles.len(), 8);
        let half = (MAX_SPREAD_DEG / 2.0).to_radians();
        assert!(order.iter().all(|tower| middles.iter().any(|m| turn(tower.azimuth - m).abs() <= half + 1e-9)));
        assert!(in_frames(Vec::new()).1.is_empty());
    }

    #[test]
    fn columns_and_directions_are_inverse() {
        let frame = WirelineFrame { azimuth: 6.2, skyline: Vec::new(), terrain: Vec::new() };
        for column in [0, 17, 800, 1599] {
            let azimuth = WirelineFrame::azimuth_of(frame.azimuth, column);
            let [x, y] = frame.on_plane(azimuth, 0.05).unwrap();
            assert!((x - (column as f64 + 0.5 - 800.0)).abs() < 1e-6);
            // level lines stay level: a place as far before the plane rises by the same rows
            let along = (azimuth - frame.azimuth).cos();
            assert!((y - WirelineFrame::plane_distance() * 0.05f64.tan() / along).abs() < 1e-9);
        }
        assert!(frame.on_plane(frame.azimuth + PI, 0.0).is_none());
    }
}
