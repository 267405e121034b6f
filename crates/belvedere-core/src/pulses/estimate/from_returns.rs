//! The path of a scanner along flight lines, from pulses with several returns.

use nalgebra::Vector3;
use rayon::prelude::*;

use super::sensor_fit::{ReturnPair, SensorFit, fit, median};
use super::smoother::{ScannerState, smoothed};
use crate::pulses::Pulses;
use crate::pulses::flight_parts::{PartVerdict, SensorEstimateParams, SensorPart};
use crate::pulses::line_path::{FoundBy, LinePath, Stretch};
use belvedere_data::control::Control;
use belvedere_data::trajectory::MAX_GAP_S;
use belvedere_data::vector::length;
use belvedere_data::{PointCloud, Result};

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
struct PartEstimate {
    part: SensorPart,
    /// State from the pulses of this part alone, if they are accepted.
    knot: Option<ScannerState>,
    /// Middle height of its first returns, metres.
    ground: f64,
}

fn estimate(cloud: &PointCloud, pulses: &Pulses, members: &[usize], params: &SensorEstimateParams) -> PartEstimate {
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
        ((last - first).norm() >= params.min_length).then(|| ReturnPair::new(first, last, pulses.times[pulse] - middle))
    };
    let pairs: Vec<ReturnPair> = members.iter().filter_map(pair).collect();
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
        verdict: PartVerdict::TooFewPairs,
    };
    let mut knot = None;
    if pairs.len() >= params.min_pair_count {
        part.verdict = PartVerdict::Uncertain;
        if let Some(SensorFit { state, covariance, median_angle }) = fit(&pairs, params.vertical_speed_sd) {
            let found = ScannerState { time: middle, state, covariance };
            part.median_angle = median_angle;
            part.put(&found, ground);
            if part.is_sure(params) {
                part.verdict = if part.is_plausible(params) { PartVerdict::Accepted } else { PartVerdict::Implausible };
            }
            knot = Some(found).filter(|_| part.verdict == PartVerdict::Accepted);
        }
    }
    PartEstimate { part, knot, ground }
}

/// Joins the parts of a line, and gives its path over those that are used.
fn join(line: &mut [PartEstimate], params: &SensorEstimateParams) -> Option<LinePath> {
    let times: Vec<f64> = line.iter().map(|e| f64::midpoint(e.part.times[0], e.part.times[1])).collect();
    let own: Vec<Option<ScannerState>> = line.iter().map(|estimate| estimate.knot.clone()).collect();
    let (mut stretches, mut path) = (Vec::new(), Vec::new());
    for (estimate, knot) in line.iter_mut().zip(smoothed(&times, &own, params.acceleration_sd)) {
        let Some(knot) = knot else { continue };
        let part = &mut estimate.part;
        let before = part.clone();
        part.put(&knot, estimate.ground);
        if part.verdict != PartVerdict::Accepted {
            if !(part.is_sure(params) && part.is_plausible(params)) {
                *part = before;
                continue;
            }
            part.verdict = PartVerdict::Bridged;
        }
        // no pulse between two parts of a pass, yet perhaps points that belong to none
        let before: Option<&mut Stretch> = stretches.last_mut();
        if let Some(before) = before.filter(|before| part.times[0] - before.times[1] <= MAX_GAP_S) {
            before.times[1] = part.times[0];
        }
        stretches.push(Stretch { times: part.times, position_sd: part.position_sd, median_angle: part.median_angle });
        path.push(knot.to_knot());
    }
    let source_id = line.first()?.part.source_id;
    (!path.is_empty()).then(|| LinePath::new(source_id, FoundBy::Returns, stretches, path))
}

/// The paths of flight lines that follow from pulses with several returns, by line, and the parts of lines they were
/// found in.
///
/// # Errors
/// [`Error::InvalidParameter`] for a parameter outside its range.
pub(in crate::pulses) fn paths_from_returns(
    cloud: &PointCloud,
    pulses: &Pulses,
    params: &SensorEstimateParams,
    control: &Control<'_>,
) -> Result<(Vec<LinePath>, Vec<SensorPart>)> {
    params.validate()?;
    let mut estimates: Vec<PartEstimate> = parts(pulses, params.part_s)
        .into_par_iter()
        .map(|members| control.check().map(|()| estimate(cloud, pulses, &members, params)))
        .collect::<Result<_>>()?;
    let lines = estimates.chunk_by_mut(|a, b| a.part.source_id == b.part.source_id);
    let paths = lines.filter_map(|line| join(line, params)).collect();
    Ok((paths, estimates.into_iter().map(|estimate| estimate.part).collect()))
}

impl SensorPart {
    fn put(&mut self, state: &ScannerState, ground: f64) {
        self.position = state.position();
        self.velocity = state.velocity();
        self.position_sd = state.position_sd();
        self.height = self.position[2] - ground;
    }

    fn is_sure(&self, params: &SensorEstimateParams) -> bool {
        let [x_sd, y_sd, z_sd] = self.position_sd;
        x_sd.max(y_sd) <= params.greatest_sd[0] && z_sd <= params.greatest_sd[1]
    }

    fn is_plausible(&self, params: &SensorEstimateParams) -> bool {
        let [slowest, fastest] = params.speeds;
        (slowest..=fastest).contains(&length(self.velocity)) && self.height >= params.min_height
    }
}
