//! Estimates scanner positions from the scan angles of the points.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};
use rayon::prelude::*;

use super::sensor_fit::median;
use crate::pulses::Pulses;
use crate::pulses::flight_parts::{AngleVerdict, ScanAngleParams, ScanAnglePart};
use crate::pulses::line_path::{FoundBy, Knot, LinePath, Stretch};
use belvedere_data::control::Control;
use belvedere_data::trajectory::MAX_GAP_S;
use belvedere_data::vector::length;
use belvedere_data::{Error, Parameter, PointCloud, Result};

/// Points of a part that are used at most, evenly over its time: more only cost time.
const MAX_POINTS: usize = 20_000;
/// Fewest points of a part.
const MIN_POINTS: usize = 200;
/// Rounds in which height and lateral offsets are made to agree; relief of a tenth of the height settles in four.
const ROUNDS: usize = 6;
/// Minimum number of pulses with several returns in a part for the test of whether they agree.
const MIN_PAIRS: usize = 20;
/// Minimum distance between first and last return for a pulse to give its direction, metres.
const MIN_LENGTH: f64 = 3.0;

/// Columns of a point that the fit needs.
#[derive(Clone, Copy)]
struct AngleSample {
    line: u16,
    time: f64,
    place: [f64; 3],
    tangent: f64,
}

/// The paths of flight lines that follow from scan angles, by line, and the parts of lines that were looked at. None
/// for a cloud without angles (or whose angles are all 0) or times.
///
/// Taken across the flight, an angle a puts a point beside the scanner's path by (height) tan a. Position, velocity,
/// height and direction of the scan lines that fit this best follow from linear least squares. How far the scanner
/// looks ahead, the angles do not show; the pulses with several returns among `pulses` do, where there are some. A line
/// is not trusted where points miss their place, where scan lines are bent, or where those pulses point elsewhere: all
/// that cones and tilted scanners give away.
///
/// # Errors
/// [`Error::InvalidParameter`] for a length of parts outside 0.5 to 60 s.
///
/// # Source
/// This project's own.
pub(in crate::pulses) fn paths_from_angles(
    cloud: &PointCloud,
    pulses: Option<&Pulses>,
    params: &ScanAngleParams,
    control: &Control<'_>,
) -> Result<(Vec<LinePath>, Vec<ScanAnglePart>)> {
    if !(0.5..=60.0).contains(&params.part_s) {
        let value = format!("{} for the part of a flight line", params.part_s);
        return Err(Error::invalid(Parameter::ScannerEstimate, value, "0.5 to 60 s"));
    }
    let attributes = &cloud.attributes;
    let (Some(times), Some(angles)) = (&attributes.gps_time, &attributes.scan_angle) else {
        return Ok((Vec::new(), Vec::new()));
    };
    if angles.iter().all(|angle| *angle == 0.0) {
        return Ok((Vec::new(), Vec::new()));
    }
    let line = |row: usize| attributes.point_source_id.as_ref().and_then(|ids| ids.get(row)).copied().unwrap_or(0);
    let sample = |(row, ((place, &time), &angle)): (usize, ((&[f32; 3], &f64), &f32))| {
        let is_usable = time.is_finite() && time != 0.0 && angle.is_finite();
        let tangent = f64::from(angle).tan();
        is_usable.then(|| AngleSample { line: line(row), time, place: place.map(f64::from), tangent })
    };
    let mut samples: Vec<AngleSample> =
        cloud.positions.iter().zip(times).zip(angles).enumerate().filter_map(sample).collect();
    // in an order that does not depend on that of the points, and with it neither do the sums
    let key = |s: &AngleSample| (s.line, s.time, s.place);
    samples.par_sort_unstable_by(|a, b| {
        let (a, b) = (key(a), key(b));
        let places = (0..3).fold(std::cmp::Ordering::Equal, |order, i| order.then(a.2[i].total_cmp(&b.2[i])));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(places)
    });
    let pairs = pulses.map(|pulses| pairs(cloud, pulses)).unwrap_or_default();
    let passes = samples.chunk_by(|a, b| a.line == b.line && b.time - a.time <= MAX_GAP_S);
    let parts: Vec<&[AngleSample]> = passes.flat_map(|pass| cut(pass, params.part_s)).collect();
    let found: Vec<(ScanAnglePart, Option<LinePath>)> = parts
        .into_par_iter()
        .map(|part| control.check().map(|()| estimate(part, &pairs, params)))
        .collect::<Result<_>>()?;
    let (parts, paths): (Vec<_>, Vec<_>) = found.into_iter().unzip();
    Ok((paths.into_iter().flatten().collect(), parts))
}

/// Equal parts of `pass` of at most `longest` seconds.
fn cut(pass: &[AngleSample], longest: f64) -> impl Iterator<Item = &[AngleSample]> {
    let start = pass.first().map_or(0.0, |s| s.time);
    let span = pass.last().map_or(0.0, |s| s.time) - start;
    let count = (span / longest).ceil().max(1.0);
    let part_of =
        move |s: &AngleSample| ((s.time - start) / span.max(f64::MIN_POSITIVE) * count).floor().min(count - 1.0);
    pass.chunk_by(move |a, b| part_of(a).total_cmp(&part_of(b)).is_eq())
}

/// A pulse with several returns: its line, time, first return, and unit vector from its last return to its first.
type Direction = (u16, f64, Vector3<f64>, Vector3<f64>);

/// In order of line and time.
fn pairs(cloud: &PointCloud, pulses: &Pulses) -> Vec<Direction> {
    let place = |row: &u32| cloud.positions.get(*row as usize).map(|p| Vector3::from(p.map(f64::from)));
    let pair = |pulse: usize| {
        let returns = pulses.returns_of(pulse);
        let (first, last) = (place(returns.first()?)?, place(returns.last()?)?);
        let length = (first - last).norm();
        let line = *pulses.source_ids.get(pulse)?;
        (length >= MIN_LENGTH).then(|| (line, pulses.times[pulse], first, (first - last) / length))
    };
    let mut pairs: Vec<Direction> = (0..pulses.len()).filter_map(pair).collect();
    pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    pairs
}

fn estimate(part: &[AngleSample], pairs: &[Direction], params: &ScanAngleParams) -> (ScanAnglePart, Option<LinePath>) {
    let [first, last] = [part.first(), part.last()].map(|s| s.map_or(f64::NAN, |s| s.time));
    let middle = f64::midpoint(first, last);
    let mut result = ScanAnglePart {
        source_id: part.first().map_or(0, |s| s.line),
        times: [first, last],
        point_count: part.len(),
        position: [f64::NAN; 3],
        velocity: [f64::NAN; 3],
        height: f64::NAN,
        misses: [f64::NAN; 2],
        pitch: 0.0,
        contradiction: f64::NAN,
        verdict: AngleVerdict::TooFewPoints,
    };
    if part.len() < MIN_POINTS {
        return (result, None);
    }
    let samples: Vec<AngleSample> = part.iter().step_by(part.len().div_ceil(MAX_POINTS)).copied().collect();
    result.verdict = AngleVerdict::TooNarrow;
    let Some(fit) = ScanLineFit::of(&samples, middle) else { return (result, None) };
    if fit.angle_spread < params.min_spread || !fit.is_finite() {
        return (result, None);
    }
    result.position = fit.position;
    result.velocity = fit.velocity;
    result.height = fit.height;
    result.misses = fit.misses;
    let of_line =
        pairs.partition_point(|pair| pair.0 < result.source_id || (pair.0 == result.source_id && pair.1 < first));
    let within = pairs.iter().skip(of_line).take_while(|pair| pair.0 == result.source_id && pair.1 <= last);
    let within: Vec<&Direction> = within.collect();
    if within.len() >= MIN_PAIRS {
        result.pitch = fit.pitch(&within, middle);
        let ahead = fit.height * result.pitch.tan();
        result.position = std::array::from_fn(|i| fit.position[i] - ahead * fit.forward.get(i).copied().unwrap_or(0.0));
        let apart = within.iter().map(|(_, time, place, direction)| {
            let scanner: Vector3<f64> = Vector3::from(result.position) + Vector3::from(fit.velocity) * (time - middle);
            (scanner - place).angle(direction)
        });
        result.contradiction = median(apart.collect());
    }
    result.verdict = fit.verdict(result.contradiction, params);
    let path = (result.verdict == AngleVerdict::Accepted).then(|| {
        // misses of a whole line share their cause, so that their number makes nothing surer
        let aside = fit.height * fit.misses[0].max(fit.misses[1]);
        let position_sd = [aside, aside, aside / fit.angle_spread.tan() * 0.1];
        let knot = Knot { time: middle, position: result.position, velocity: fit.velocity };
        let stretch = Stretch { times: [first, last], position_sd, median_angle: fit.misses[0].hypot(fit.misses[1]) };
        LinePath::new(result.source_id, FoundBy::ScanAngle, vec![stretch], vec![knot])
    });
    (result, path)
}

/// Straight flight and straight scan lines that fit the points of a part best.
struct ScanLineFit {
    position: [f64; 3],
    velocity: [f64; 3],
    /// Level unit vector of the flight.
    forward: [f64; 2],
    /// Above the mean of the points.
    height: f64,
    /// Standard deviation of the angles, radians.
    angle_spread: f64,
    /// Tangent of the angle between scan lines and the perpendicular of the flight.
    crab: f64,
    /// Median angles by which points miss their place across and along the flight.
    misses: [f64; 2],
    /// Along the flight, for each metre of height and square of the tangent.
    bend: f64,
    bend_sd: f64,
}

/// Fits the scanner path to scan angles by least squares: coefficients of x and y (at time `middle`, per second, per
/// tangent of the scan angle) and the flying height above `ground`, the mean height of the points.
fn path_and_height(samples: &[AngleSample], middle: f64, ground: f64) -> Option<([Vector3<f64>; 2], f64)> {
    let mut height = f64::INFINITY;
    let mut columns = [Vector3::zeros(); 2];
    for _ in 0..ROUNDS {
        // the tangent counts for more where the ground is lower
        let row = |s: &AngleSample| {
            let lower = 1.0 - (s.place[2] - ground) / height;
            Vector3::new(1.0, s.time - middle, s.tangent * lower)
        };
        let (mut normal, mut right) = (Matrix3::zeros(), [Vector3::zeros(); 2]);
        for sample in samples {
            let row = row(sample);
            normal += row * row.transpose();
            right[0] += row * sample.place[0];
            right[1] += row * sample.place[1];
        }
        let factors = normal.cholesky()?;
        columns = right.map(|right| factors.solve(&right));
        height = columns[0][2].hypot(columns[1][2]);
        if !(height.is_finite() && height > 1.0) {
            return None;
        }
    }
    Some((columns, height))
}

impl ScanLineFit {
    /// Judges the fit; pulses with several returns contradict it by an angle of `contradiction`, radians.
    fn verdict(&self, contradiction: f64, params: &ScanAngleParams) -> AngleVerdict {
        let [slowest, fastest] = params.speeds;
        let is_plausible = (slowest..=fastest).contains(&length(self.velocity)) && self.height >= params.min_height;
        if self.misses.iter().any(|miss| *miss > params.greatest_miss) || self.crab > params.greatest_crab {
            AngleVerdict::NotAcross
        } else if self.bend.abs() > params.greatest_bend || !(self.bend_sd < params.greatest_bend) {
            AngleVerdict::Bent
        } else if !is_plausible {
            AngleVerdict::Implausible
        } else if contradiction > params.greatest_contradiction {
            AngleVerdict::Contradicted
        } else {
            AngleVerdict::Accepted
        }
    }

    fn of(samples: &[AngleSample], middle: f64) -> Option<Self> {
        let count = samples.len() as f64;
        let mean = |value: &dyn Fn(&AngleSample) -> f64| samples.iter().map(value).sum::<f64>() / count;
        let ground = mean(&|s| s.place[2]);
        let mean_tangent = mean(&|s| s.tangent);
        let angle_spread = mean(&|s| (s.tangent - mean_tangent).powi(2)).sqrt().atan();
        let ([x, y], height) = path_and_height(samples, middle, ground)?;
        let speed = x[1].hypot(y[1]);
        let forward = [x[1] / speed, y[1] / speed];
        let right = [forward[1], -forward[0]];
        let part_along = |axis: [f64; 2]| axis[0] * x[2] + axis[1] * y[2];
        let (mut across, mut along) = (Vec::new(), Vec::new());
        // along the flight, with a bend
        let (mut normal, mut sums) = (Matrix4::zeros(), Vector4::zeros());
        let bent_row = |s: &AngleSample| Vector4::new(1.0, s.time - middle, s.tangent, s.tangent * s.tangent);
        for sample in samples {
            let lower = 1.0 - (sample.place[2] - ground) / height;
            let row = Vector3::new(1.0, sample.time - middle, sample.tangent * lower);
            let off = [sample.place[0] - x.dot(&row), sample.place[1] - y.dot(&row)];
            across.push((off[0] * right[0] + off[1] * right[1]).abs() / height);
            let ahead = (off[0] * forward[0] + off[1] * forward[1]) / height;
            along.push(ahead);
            normal += bent_row(sample) * bent_row(sample).transpose();
            sums += bent_row(sample) * ahead;
        }
        let inverse = normal.try_inverse()?;
        let bent = inverse * sums;
        let squares: f64 = samples.iter().zip(&along).map(|(s, ahead)| (ahead - bent.dot(&bent_row(s))).powi(2)).sum();
        Some(Self {
            position: [x[0], y[0], ground + height],
            velocity: [x[1], y[1], 0.0],
            forward,
            height,
            angle_spread,
            crab: (part_along(forward) / part_along(right)).abs(),
            misses: [median(across), median(along.iter().map(|v| v.abs()).collect())],
            bend: bent[3],
            bend_sd: (squares / count * inverse[(3, 3)]).max(0.0).sqrt(),
        })
    }

    /// Angle by which pulses look ahead of where scan angles put the scanner, radians.
    fn pitch(&self, pairs: &[&Direction], middle: f64) -> f64 {
        let along = |v: &Vector3<f64>| (v.x * self.forward[0] + v.y * self.forward[1]) / v.z;
        let off = |(_, time, place, direction): &&Direction| {
            let scanner = Vector3::from(self.position) + Vector3::from(self.velocity) * (time - middle);
            along(&(scanner - place)) - along(direction)
        };
        median(pairs.iter().map(off).collect()).atan()
    }

    fn is_finite(&self) -> bool {
        let values = self.position.iter().chain(&self.velocity).chain(&self.misses);
        values.chain([&self.crab, &self.bend, &self.bend_sd]).all(|v| v.is_finite())
    }
}
