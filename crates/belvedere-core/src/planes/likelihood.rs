//! Position of an edge by maximum likelihood, from the pulses that ended on its plane and those that passed it.
//!
//! Across an edge the share of pulses that end on the plane falls from nearly all to nearly none. The estimate is the
//! mean of all lines near the one through the middles of sides, each weighted by the likelihood of every pulse. It is
//! nearer to the edge than that line, and the spread of the weights gives its standard deviation.

use super::edges::Outline;
use super::line::PlanLine;

/// Share of pulses with the opposite outcome, whatever the edge: noise, holes, objects on roofs.
const OTHER: f64 = 0.02;
/// Distance across the line within which pulses count, spacings.
const REACH_SPACINGS: f64 = 3.2;
/// Widths of the change from nearly all to nearly none: wide ones in spacings find the place, the last one, metres,
/// measures it.
const WIDTHS_SPACINGS: [f64; 2] = [0.3, 0.12];
const WIDTH: f64 = 0.03;
/// Maximum distance between lines across the edge: at first, spacings; later, in standard deviations so far.
const FIRST_REACH_SPACINGS: f64 = 0.8;
const REACH_SD: f64 = 2.2;
/// Lines tried on each side of the first, by place and by turn.
const STEPS: i32 = 4;
/// Places of the table for each width, and how many widths it holds on each side.
const TABLE_STEPS: f64 = 16.0;
const TABLE_WIDTHS: f64 = 8.0;

/// Logarithms of the likelihood that a pulse ends on a plane, by its distance from the edge.
pub(super) struct LikelihoodTable {
    values: Vec<f64>,
}

impl LikelihoodTable {
    pub(super) fn new() -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "the size of a small table")]
        let last = (TABLE_STEPS * TABLE_WIDTHS) as i32;
        let value = |place: i32| {
            let outside = f64::from(place) / TABLE_STEPS;
            (OTHER + (1.0 - 2.0 * OTHER) / (1.0 + outside.exp())).ln()
        };
        Self { values: (-last..=last).map(value).collect() }
    }

    /// Logarithm of the likelihood that a pulse ended on the plane, so many widths outside of the edge.
    fn of(&self, outside: f64) -> f64 {
        let place = (outside.clamp(-TABLE_WIDTHS, TABLE_WIDTHS) + TABLE_WIDTHS) * TABLE_STEPS;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the table")]
        let place = (place + 0.5) as usize;
        self.values[place]
    }
}

/// The mean of likely edges near a line, and its standard deviation across, metres.
pub(super) fn likeliest(outline: &Outline, line: &PlanLine, spacing: f64, table: &LikelihoodTable) -> (PlanLine, f64) {
    let reach = REACH_SPACINGS * spacing;
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
    outline.inside.iter().for_each(|&p| add(p, 1.0));
    outline.passed.iter().filter(|passed| passed.depth > super::edges::PASSED).for_each(|passed| add(passed.p, -1.0));
    let (mut place, mut turn, mut sd) = (0.0, 0.0, 0.0);
    let mut most = FIRST_REACH_SPACINGS * spacing;
    let widths = WIDTHS_SPACINGS.map(|width| width * spacing).into_iter().chain([WIDTH]);
    for width in widths {
        let mut found: Vec<[f64; 3]> = Vec::with_capacity(81);
        for i in -STEPS..=STEPS {
            for k in -STEPS..=STEPS {
                let [c, r] = [i, k].map(|step| most * f64::from(step) / f64::from(STEPS));
                let (c, r) = (place + c, turn + r);
                let log: f64 = pulses.iter().map(|[t, d, sign]| table.of(sign * (d - c - r * t) / width)).sum();
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
        most = (REACH_SD * sd).min(most);
    }
    let angle = (turn / half).atan();
    let [a, b] = line.along;
    // to the right with growing range
    let along = [a * angle.cos() + b * angle.sin(), b * angle.cos() - a * angle.sin()];
    let point = line.at(middle, place);
    let ends = line.ends.map(|end| (end - middle) / angle.cos());
    (PlanLine { point, along, ends }, sd)
}
