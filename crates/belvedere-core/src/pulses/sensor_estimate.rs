//! Where the scanner was when it sent each pulse: from a trajectory, or from the pulses themselves.

use nalgebra::{Vector3, Vector6};
use rayon::prelude::*;

use super::Pulses;
use super::line_path::{Knot, LinePath, Stretch, position_on, smoothed};
use super::scanner_report::FoundBy;
use super::sensor_fit::{Fit, Pair, fit, median};
use belvedere_data::control::Control;
use belvedere_data::trajectory::{ClockOffset, MAX_GAP_S, Trajectory};
use belvedere_data::vector::length;
use belvedere_data::{Error, PointCloud, Result};

/// How [`SensorPositions::from_returns`] works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorEstimateParams {
    /// Longest part of a flight line that is taken for straight and evenly flown, seconds, 0.5 to 60. Default 5: gusts move
    /// an aircraft by a metre in that time, and a tile cut from a line often holds no more.
    pub part_s: f64,
    /// Least distance between first and last return for a pulse to tell its direction, metres, 0.5 to 50. Default 3: with
    /// 2 cm noise the direction is then good to half a degree.
    pub least_length: f64,
    /// Fewest such pulses in a part, 6 to 100 000. Default 30.
    pub least_pair_count: usize,
    /// Standard deviation of the vertical speed about zero, metres per second, 0.1 to 100. Default 2: surveys fly level, and
    /// a tile that took two seconds to pass hardly tells climb from scale.
    pub vertical_speed_sd: f64,
    /// Standard deviation of the acceleration, white over a second, that the parts of a line are joined with, metres per
    /// second squared, 0.01 to 100. Default 1: an autopilot in gusts.
    pub acceleration_sd: f64,
    /// Greatest standard deviation of the position that is accepted, horizontal and vertical, metres. Default 20 and 50:
    /// seen from 450 m below, 20 m sideways tilt a pulse by 2.5°; upwards they tilt it less.
    pub greatest_sd: [f64; 2],
    /// Speeds that are accepted, metres per second. Default 15 to 120: helicopters to jets.
    pub speeds: [f64; 2],
    /// Least height above the middle of the returns that is accepted, metres. Default 30.
    pub least_height: f64,
}

impl Default for SensorEstimateParams {
    fn default() -> Self {
        Self {
            part_s: 5.0,
            least_length: 3.0,
            least_pair_count: 30,
            vertical_speed_sd: 2.0,
            acceleration_sd: 1.0,
            greatest_sd: [20.0, 50.0],
            speeds: [15.0, 120.0],
            least_height: 30.0,
        }
    }
}

/// Scanner position of each pulse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorPositions {
    /// Local metres, (P, 3); NaN where unknown.
    pub per_pulse: Vec<[f32; 3]>,
}

/// How scanner positions were found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorReport {
    /// Pulses in all.
    pub pulse_count: usize,
    /// Pulses whose scanner position is known.
    pub known_count: usize,
    /// How GPS times became those of the trajectory, where one was used.
    pub clock: Option<ClockOffset>,
    /// The parts of flight lines that were estimated, by line and time.
    pub parts: Vec<SensorPart>,
}

/// Estimate for a part of a flight line.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorPart {
    /// Flight line.
    pub source_id: u16,
    /// Time of its first and last pulse, seconds.
    pub times: [f64; 2],
    /// Its pulses.
    pub pulse_count: usize,
    /// Pulses whose first and last return lie far enough apart.
    pub pair_count: usize,
    /// Position half-way between the two times, local metres, together with what its neighbours say; NaN where nothing could be
    /// computed.
    pub position: [f64; 3],
    /// Its standard deviation by the residuals, metres.
    pub position_sd: [f64; 3],
    /// Metres per second.
    pub velocity: [f64; 3],
    /// Height above the middle one of its first returns, metres; NaN where there is no position.
    pub height: f64,
    /// Median angle between the pulses and the directions to the estimated path, radians.
    pub median_angle: f64,
    /// Whether it is used.
    pub verdict: Verdict,
}

/// Whether the estimate for a part of a flight line is used, and why not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Used.
    Accepted,
    /// Used, though its own pulses do not suffice: other parts of the line tell where it must have been.
    Bridged,
    /// Too few pulses with returns far enough apart.
    TooFewPairs,
    /// The pulses do not fix a position, or not well enough: too parallel, or too few.
    Uncertain,
    /// No aircraft flies so slowly or so fast, or so low.
    Implausible,
}

impl Verdict {
    /// Whether the part has a position that is used.
    #[must_use]
    pub fn is_used(self) -> bool {
        matches!(self, Self::Accepted | Self::Bridged)
    }
}

impl SensorPositions {
    /// Positions at the times of `pulses` on `trajectory`; unknown where it has no position.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where it has none at any of the times.
    pub fn from_trajectory(
        cloud: &PointCloud,
        pulses: &Pulses,
        trajectory: &Trajectory,
    ) -> Result<(Self, SensorReport)> {
        let (per_pulse, clock) = trajectory.scanner_positions_at(&pulses.times, cloud)?;
        let known_count = per_pulse.iter().filter(|p| is_known(p)).count();
        let report =
            SensorReport { pulse_count: pulses.len(), known_count, clock: Some(clock), ..SensorReport::default() };
        Ok((Self { per_pulse }, report))
    }

    /// Positions from the directions of pulses with several returns, by flight line.
    ///
    /// A line is cut where nothing was scanned for two seconds and then into equal parts of at most
    /// [`SensorEstimateParams::part_s`]. In each part the scanner moves evenly, S + V t, such that the last return of each
    /// pulse lies as near as possible to the line from the scanner through the first. Misses that stand out count less, and level flight is
    /// assumed where the pulses tell nothing. The parts of a line are then joined to one path by a smoother that knows how far an
    /// aircraft leaves a constant velocity; it also places parts with too few pulses between or beside good ones, as long as it
    /// is sure enough. Parts whose estimate is not fit for use are unknown; [`SensorReport::parts`] says why.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a parameter outside its range.
    ///
    /// # Source
    /// The idea: Gatziolis & McGaughey 2019; Roussel, Bourdon & Achim 2020. Weights: Huber 1964. One least-squares problem
    /// with velocity for each part instead of pairs of pulses is ours.
    pub fn from_returns(
        cloud: &PointCloud,
        pulses: &Pulses,
        params: &SensorEstimateParams,
        control: &Control<'_>,
    ) -> Result<(Self, SensorReport)> {
        let (paths, parts) = paths_from_returns(cloud, pulses, params, control)?;
        let position = |(&line, &time): (&u16, &f64)| match position_on(&paths, line, time) {
            Some((_, place)) => belvedere_data::cloud::to_local(place, [0.0; 3]),
            None => [f32::NAN; 3],
        };
        let per_pulse: Vec<[f32; 3]> = pulses.source_ids.iter().zip(&pulses.times).map(position).collect();
        let known_count = per_pulse.iter().filter(|p| is_known(p)).count();
        Ok((Self { per_pulse }, SensorReport { pulse_count: pulses.len(), known_count, clock: None, parts }))
    }

    /// Scanner position of each point of the cloud that `pulses` were grouped from, (N, 3), local metres; NaN where unknown.
    #[must_use]
    pub fn per_point(&self, pulses: &Pulses, point_count: usize) -> Vec<[f32; 3]> {
        let mut per_point = vec![[f32::NAN; 3]; point_count];
        for (pulse, position) in self.per_pulse.iter().enumerate() {
            for &row in pulses.returns_of(pulse) {
                if let Some(of_point) = per_point.get_mut(row as usize) {
                    *of_point = *position;
                }
            }
        }
        per_point
    }
}

fn is_known(position: &[f32; 3]) -> bool {
    position.iter().all(|v| v.is_finite())
}

impl SensorEstimateParams {
    fn validate(&self) -> Result<()> {
        let check = |name, value: f64, range: std::ops::RangeInclusive<f64>, expected| {
            let wrong = || Error::InvalidParameter { name, value: value.to_string(), expected };
            range.contains(&value).then_some(()).ok_or_else(wrong)
        };
        check("part of a flight line", self.part_s, 0.5..=60.0, "0.5 to 60 s")?;
        check("minimum length of a pulse", self.least_length, 0.5..=50.0, "0.5 to 50 m")?;
        check("deviation of the vertical speed", self.vertical_speed_sd, 0.1..=100.0, "0.1 to 100 m/s")?;
        check("deviation of the acceleration", self.acceleration_sd, 0.01..=100.0, "0.01 to 100 m/s2")?;
        check("minimum number of pulses", self.least_pair_count as f64, 6.0..=1e5, "6 to 100000")
    }
}

/// Pulses of each part of each flight line, in order of time.
fn parts(pulses: &Pulses, longest: f64) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..pulses.len()).collect();
    let key = |&pulse: &usize| (pulses.source_ids[pulse], pulses.times[pulse]);
    // lines may hold several channels, each in order of time
    order.sort_by(|a, b| key(a).0.cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)));
    let mut parts = Vec::new();
    for pass in order.chunk_by(|a, b| key(a).0 == key(b).0 && key(b).1 - key(a).1 <= MAX_GAP_S) {
        let (Some(first), Some(last)) = (pass.first(), pass.last()) else { continue };
        let (start, length) = (key(first).1, key(last).1 - key(first).1);
        let count = (length / longest).ceil().max(1.0);
        // the very last pulse belongs to the last part
        let part_of = |pulse: &usize| {
            let share = (key(pulse).1 - start) / length.max(f64::MIN_POSITIVE);
            (share * count).floor().min(count - 1.0)
        };
        parts.extend(pass.chunk_by(|a, b| part_of(a).total_cmp(&part_of(b)).is_eq()).map(<[usize]>::to_vec));
    }
    parts
}

/// A part of a flight line on its way to a path.
struct Estimate {
    part: SensorPart,
    /// What its own pulses say, where that is to be used.
    knot: Option<Knot>,
    /// Middle height of its first returns, metres.
    ground: f64,
}

fn estimate(cloud: &PointCloud, pulses: &Pulses, members: &[usize], params: &SensorEstimateParams) -> Estimate {
    let time = |at: Option<&usize>| at.and_then(|&pulse| pulses.times.get(pulse)).copied().unwrap_or(f64::NAN);
    let times = [time(members.first()), time(members.last())];
    let middle = f64::midpoint(times[0], times[1]);
    let place = |row: &u32| {
        let p = cloud.positions.get(*row as usize).copied().unwrap_or([f32::NAN; 3]);
        Vector3::from(p.map(f64::from))
    };
    let pair = |&pulse: &usize| {
        let returns = pulses.returns_of(pulse);
        let (first, last) = (place(returns.first()?), place(returns.last()?));
        ((last - first).norm() >= params.least_length).then(|| Pair::new(first, last, pulses.times[pulse] - middle))
    };
    let pairs: Vec<Pair> = members.iter().filter_map(pair).collect();
    let firsts = members.iter().filter_map(|&pulse| Some(place(pulses.returns_of(pulse).first()?).z));
    let ground = median(firsts.collect());
    let mut part = SensorPart {
        source_id: members.first().map_or(0, |&pulse| pulses.source_ids[pulse]),
        times,
        pulse_count: members.len(),
        pair_count: pairs.len(),
        position: [f64::NAN; 3],
        position_sd: [f64::INFINITY; 3],
        velocity: [f64::NAN; 3],
        height: f64::NAN,
        median_angle: f64::NAN,
        verdict: Verdict::TooFewPairs,
    };
    let mut knot = None;
    if pairs.len() >= params.least_pair_count {
        part.verdict = Verdict::Uncertain;
        if let Some(Fit { state, covariance, median_angle }) = fit(&pairs, params.vertical_speed_sd) {
            let found = Knot { time: middle, state, covariance };
            part.median_angle = median_angle;
            part.put(&found, ground);
            if part.is_sure(params) {
                part.verdict = if part.is_plausible(params) { Verdict::Accepted } else { Verdict::Implausible };
            }
            knot = Some(found).filter(|_| part.verdict == Verdict::Accepted);
        }
    }
    Estimate { part, knot, ground }
}

/// Joins the parts of a line, and gives its path over those that are used.
fn join(line: &mut [Estimate], params: &SensorEstimateParams) -> Option<LinePath> {
    let times: Vec<f64> = line.iter().map(|e| f64::midpoint(e.part.times[0], e.part.times[1])).collect();
    let own: Vec<Option<Knot>> = line.iter().map(|estimate| estimate.knot.clone()).collect();
    let (mut stretches, mut path) = (Vec::new(), Vec::new());
    for (estimate, knot) in line.iter_mut().zip(smoothed(&times, &own, params.acceleration_sd)) {
        let Some(knot) = knot else { continue };
        let part = &mut estimate.part;
        let before = part.clone();
        part.put(&knot, estimate.ground);
        if part.verdict != Verdict::Accepted {
            if !(part.is_sure(params) && part.is_plausible(params)) {
                *part = before;
                continue;
            }
            part.verdict = Verdict::Bridged;
        }
        // no pulse between two parts of a pass, yet perhaps points that belong to none
        let before: Option<&mut Stretch> = stretches.last_mut();
        if let Some(before) = before.filter(|before| part.times[0] - before.times[1] <= MAX_GAP_S) {
            before.times[1] = part.times[0];
        }
        stretches.push(Stretch { times: part.times, position_sd: part.position_sd, median_angle: part.median_angle });
        path.push(knot);
    }
    let source_id = line.first()?.part.source_id;
    (!path.is_empty()).then(|| LinePath::new(source_id, FoundBy::Returns, stretches, path))
}

/// The paths of flight lines that pulses with several returns tell, by line, and the parts of lines they were found in.
///
/// # Errors
/// [`Error::InvalidParameter`] for a parameter outside its range.
pub(super) fn paths_from_returns(
    cloud: &PointCloud,
    pulses: &Pulses,
    params: &SensorEstimateParams,
    control: &Control<'_>,
) -> Result<(Vec<LinePath>, Vec<SensorPart>)> {
    params.validate()?;
    let mut estimates: Vec<Estimate> = parts(pulses, params.part_s)
        .into_par_iter()
        .map(|members| control.check().map(|()| estimate(cloud, pulses, &members, params)))
        .collect::<Result<_>>()?;
    let lines = estimates.chunk_by_mut(|a, b| a.part.source_id == b.part.source_id);
    let paths = lines.filter_map(|line| join(line, params)).collect();
    Ok((paths, estimates.into_iter().map(|estimate| estimate.part).collect()))
}

impl SensorPart {
    fn put(&mut self, knot: &Knot, ground: f64) {
        let state: &Vector6<f64> = &knot.state;
        self.position = [state[0], state[1], state[2]];
        self.velocity = [state[3], state[4], state[5]];
        self.position_sd = knot.position_sd();
        self.height = state[2] - ground;
    }

    fn is_sure(&self, params: &SensorEstimateParams) -> bool {
        let [x_sd, y_sd, z_sd] = self.position_sd;
        x_sd.max(y_sd) <= params.greatest_sd[0] && z_sd <= params.greatest_sd[1]
    }

    fn is_plausible(&self, params: &SensorEstimateParams) -> bool {
        let [slowest, fastest] = params.speeds;
        (slowest..=fastest).contains(&length(self.velocity)) && self.height >= params.least_height
    }
}
