//! Position of an edge by maximum likelihood, from the pulses that ended on its plane and those that passed it.
//!
//! Across an edge the share of pulses that end on the plane falls from nearly all to nearly none. The estimate is the
//! mean of all lines near the one through the middles of sides, each weighted by the likelihood of every pulse. It is
//! nearer to the edge than that line, and the spread of the weights gives its standard deviation.

use super::line::PlanLine;
use super::samples::Samples;
use belvedere_data::cast::{to_i32, to_index};

/// Lines tried on each side of the first, by place and by turn.
const STEPS: i32 = 4;
/// Places of the table for each width, and how many widths it holds on each side.
const TABLE_STEPS: f64 = 16.0;
const TABLE_WIDTHS: f64 = 8.0;

/// Parameters of the likelihood of edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LikelihoodParams {
    /// Share of pulses with the opposite outcome, whatever the edge: noise, holes, objects on roofs. Default 0.02.
    pub(super) outlier_share: f64,
    /// Maximum distance of pulses across the line, spacings. Default 3.2.
    pub(super) reach_spacings: f64,
    /// Widths of the change from nearly all to nearly none with which the place is found, spacings. Default 0.3, then
    /// 0.12.
    pub(super) widths_spacings: [f64; 2],
    /// The same with which it is measured, metres. Default 0.03.
    pub(super) width: f64,
    /// Maximum distance between lines across the edge at first, spacings. Default 0.8.
    pub(super) first_reach_spacings: f64,
    /// The same later, in standard deviations so far. Default 2.2.
    pub(super) reach_sd: f64,
}

impl Default for LikelihoodParams {
    fn default() -> Self {
        Self {
            outlier_share: 0.02,
            reach_spacings: 3.2,
            widths_spacings: [0.3, 0.12],
            width: 0.03,
            first_reach_spacings: 0.8,
            reach_sd: 2.2,
        }
    }
}

/// Logarithms of the likelihood that a pulse ends on a plane, by its distance from the edge.
pub(super) struct LikelihoodTable {
    params: LikelihoodParams,
    values: Vec<f64>,
}

impl LikelihoodTable {
    pub(super) fn new(params: &LikelihoodParams) -> Self {
        let last = to_i32(TABLE_STEPS * TABLE_WIDTHS);
        let value = |place: i32| {
            let outside = f64::from(place) / TABLE_STEPS;
            (params.outlier_share + (1.0 - 2.0 * params.outlier_share) / (1.0 + outside.exp())).ln()
        };
        Self { params: *params, values: (-last..=last).map(value).collect() }
    }

    /// Logarithm of the likelihood that a pulse ended on the plane, so many widths outside of the edge.
    fn of(&self, outside: f64) -> f64 {
        let place = (outside.clamp(-TABLE_WIDTHS, TABLE_WIDTHS) + TABLE_WIDTHS) * TABLE_STEPS;
        let place = to_index(place + 0.5);
        self.values[place]
    }

    /// The mean of likely edges near a line, and its standard deviation across, metres.
    pub(super) fn likeliest(&self, samples: &Samples, line: &PlanLine, spacing: f64) -> (PlanLine, f64) {
        let params = &self.params;
        let reach = params.reach_spacings * spacing;
        let middle = f64::midpoint(line.ends[0], line.ends[1]);
        let half = (line.length() / 2.0).max(1e-3);
        // range from the middle in half lengths, distance to the right, and 1 for returns, -1 for pulses that passed
        let mut pulses: Vec<[f64; 3]> = Vec::new();
        let mut add = |p: [f64; 2], sign: f64| {
            let [t, d] = line.of(p);
            if d.abs() <= reach && (line.ends[0]..=line.ends[1]).contains(&t) {
                pulses.push([(t - middle) / half, d, sign]);
            }
        };
        samples.inside.iter().for_each(|&p| add(p, 1.0));
        samples.deep().for_each(|passed| add(passed.p, -1.0));
        let (mut place, mut turn, mut sd) = (0.0, 0.0, 0.0);
        let mut most = params.first_reach_spacings * spacing;
        let widths = params.widths_spacings.map(|width| width * spacing).into_iter().chain([params.width]);
        for width in widths {
            let mut found: Vec<[f64; 3]> = Vec::with_capacity(81);
            for i in -STEPS..=STEPS {
                for k in -STEPS..=STEPS {
                    let [c, r] = [i, k].map(|step| most * f64::from(step) / f64::from(STEPS));
                    let (c, r) = (place + c, turn + r);
                    let log: f64 = pulses.iter().map(|[t, d, sign]| self.of(sign * (d - c - r * t) / width)).sum();
                    found.push([log, c, r]);
                }
            }
            let best = found.iter().map(|line| line[0]).fold(f64::NEG_INFINITY, f64::max);
            let (mut sum, mut sums, mut squares) = (0.0, [0.0; 2], 0.0);
            for [log, c, r] in found {
                let weight = (log - best).exp();
                sum += weight;
                sums = [sums[0] + weight * c, sums[1] + weight * r];
                squares += weight * (c * c + r * r / 3.0);
            }
            let means = sums.map(|v| v / sum);
            // along the line: that of the place, and a third of that of its ends
            sd = (squares / sum - means[0].powi(2) - means[1].powi(2) / 3.0).max(0.0).sqrt();
            [place, turn] = means;
            most = (params.reach_sd * sd).min(most);
        }
        let angle = (turn / half).atan();
        let [a, b] = line.along;
        // to the right with growing range
        let along = [a * angle.cos() + b * angle.sin(), b * angle.cos() - a * angle.sin()];
        let point = line.at(middle, place);
        let ends = line.ends.map(|end| (end - middle) / angle.cos());
        (PlanLine { point, along, ends }, sd)
    }
}
