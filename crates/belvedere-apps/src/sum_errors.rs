//! Errors of sums over directions: hours of sun, views of the sky.
//!
//! Errors of neighbouring directions are correlated, since they come from the same edges. The error of a sum is
//! therefore not the sum of the errors of its directions. The relevant figure is the change of the sum if the outlines
//! of all obstacles before suns or sky moved by a degree. It is the length of these outlines, between directions that a
//! target sees and those that it does not.
//!
//! For classes of that figure, errors in simulated towns with exact answers give the mean and the interval that holds
//! 90 % of them (`research/`, program `confidence`; docs/methods/confidence.md).
//!
//! # Source
//! This project's own; prediction intervals by classes of a measure of difficulty (Vovk et al. 2005, chapter 4).

use crate::rows::{RowBlock, SkyObstacles, normals_of};
use crate::targets::{Measure, Targets};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, to_f32};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::LazyLock;

/// Targets handed to a thread at once.
const CHUNK: usize = 256;
/// Directions up to so many times as far away as the nearest one usually is are neighbours.
const NEIGHBORS_WITHIN: f64 = 1.6;
/// Upper ends of the classes of the share of a sum that moves with outlines, per degree; the last class has none.
const MOVED_CLASSES: [f64; 8] = [1e-9, 0.004, 0.006, 0.01, 0.014, 0.02, 0.03, 0.05];
/// Classes: targets inside obstacles, and the others by how much of the sum moves.
pub const CLASSES: usize = 2 + MOVED_CLASSES.len();
/// The errors that were found.
const ERRORS: &str = include_str!("sum_errors.csv");

/// Ends of the names of the measures for the interval of a sum, and their meanings.
pub const INTERVAL_MEASURES: [(&str, &str); 3] =
    [("expected", "expected value"), ("low", "5 % are lower in truth"), ("high", "5 % are higher in truth")];

/// Choice to give intervals with sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Intervals {
    /// They do not.
    #[default]
    Without,
    /// They do.
    With,
}

impl Intervals {
    /// Returns the choice for a flag.
    #[must_use]
    pub fn wanted(are_wanted: bool) -> Self {
        if are_wanted { Self::With } else { Self::Without }
    }

    /// Flags the `targets` among `obstacles` that are inside one, if that is needed.
    pub(crate) fn are_inside(
        self,
        obstacles: SkyObstacles<'_>,
        targets: &Targets,
        control: &Control<'_>,
    ) -> Result<Option<Vec<bool>>> {
        match self {
            Self::Without => Ok(None),
            Self::With => obstacles.are_inside_obstacles(&targets.positions, control).map(Some),
        }
    }
}

/// Kind of sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SumKind {
    /// Hours of sun.
    Sun,
    /// Views of the sky.
    Sky,
    /// Energy of sun and sky at a place.
    Energy,
    /// Energy of sun and sky, the mean of the cells of a plane.
    Plane,
}

impl SumKind {
    /// All, with their names in the file of errors.
    pub const ALL: [(Self, &str); 4] =
        [(Self::Sun, "sun"), (Self::Sky, "sky"), (Self::Energy, "energy"), (Self::Plane, "plane")];
}

/// Truth less the sum, as a share of the maximum possible sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SumError {
    /// Mean.
    pub mean: f64,
    /// Ends of the interval that holds 90 %: as many are below as above.
    pub interval: [f64; 2],
}

impl SumError {
    /// Returns the error of sums of a kind and class.
    #[must_use]
    pub fn of(kind: SumKind, class: u8) -> Self {
        FOUND[kind as usize].get(usize::from(class)).copied().unwrap_or_default()
    }

    /// The expected value of a sum of at most `max`, and the ends of its interval.
    #[must_use]
    pub fn interval(&self, sum: f64, max: f64) -> [f64; 3] {
        let Self { mean, interval: [low, high] } = *self;
        [mean, low, high].map(|error| (sum + error * max).clamp(0.0, max.max(0.0)))
    }
}

static FOUND: LazyLock<[[SumError; CLASSES]; SumKind::ALL.len()]> = LazyLock::new(|| read_errors(ERRORS));

/// Errors from lines of kind, class, mean, low and high end. A class without any has those of the next one that has.
fn read_errors(text: &str) -> [[SumError; CLASSES]; SumKind::ALL.len()] {
    let mut errors = [[None; CLASSES]; SumKind::ALL.len()];
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [name, class, mean, low, high, ..] = fields[..] else { continue };
        let kind = SumKind::ALL.iter().position(|(_, of_kind)| *of_kind == name);
        let numbers = [mean, low, high].map(|text| text.parse().unwrap_or_default());
        if let (Some(kind), Ok(class)) = (kind, class.parse::<usize>())
            && let Some(error) = errors[kind].get_mut(class)
        {
            *error = Some(SumError { mean: numbers[0], interval: [numbers[1], numbers[2]] });
        }
    }
    errors.map(|of_kind| {
        std::array::from_fn(|class| {
            let from_here = of_kind[class..].iter().chain(of_kind[..class].iter().rev());
            from_here.flatten().next().copied().unwrap_or_default()
        })
    })
}

/// Directions with their neighbours, of which weighted sums are taken.
pub struct Outlines {
    directions: Vec<[f64; 3]>,
    weights: Vec<f64>,
    neighbors: Vec<Vec<u32>>,
    /// Median distance of a direction from its nearest neighbour, degrees.
    spacing: f64,
}

impl Outlines {
    /// Directions, (D, 3) unit vectors, with the weight of each in a sum.
    #[must_use]
    pub fn new(directions: &[[f64; 3]], weights: &[f64]) -> Self {
        let angle = |a: [f64; 3], b: [f64; 3]| dot(a, b).clamp(-1.0, 1.0).acos();
        let nearest = |&(number, &direction): &(usize, &[f64; 3])| {
            let others = directions.iter().enumerate().filter(|(other, _)| *other != number);
            others.map(|(_, &other)| angle(direction, other)).fold(FRAC_PI_2, f64::min)
        };
        let numbered: Vec<(usize, &[f64; 3])> = directions.iter().enumerate().collect();
        let mut spacings: Vec<f64> = numbered.par_iter().map(nearest).collect();
        spacings.sort_by(f64::total_cmp);
        let spacing = spacings.get(spacings.len() / 2).copied().unwrap_or(FRAC_PI_2);
        let near = NEIGHBORS_WITHIN * spacing;
        let neighbors = numbered.par_iter().map(|&(number, &direction)| {
            let others = (0..).zip(directions).filter(|&(other, _)| other as usize != number);
            others.filter(|(_, other)| angle(direction, **other) < near).map(|(other, _)| other).collect()
        });
        Self {
            neighbors: neighbors.collect(),
            directions: directions.to_vec(),
            weights: weights.to_vec(),
            spacing: spacing.to_degrees(),
        }
    }

    /// The share of the sum of all weights that would move with outlines by a degree, where `is_free` says which
    /// directions a target sees.
    #[must_use]
    pub fn moved_share(&self, is_free: impl Fn(usize) -> bool) -> f64 {
        let all: f64 = self.weights.iter().sum();
        if all > 0.0 { self.moved(is_free, |number| self.weights[number]) / all } else { 0.0 }
    }

    /// The sum of weights that would move with outlines by a degree, where directions have other weights.
    #[must_use]
    pub fn moved(&self, is_free: impl Fn(usize) -> bool, weight: impl Fn(usize) -> f64) -> f64 {
        let is_at_outline = |number: &usize| {
            let own = is_free(*number);
            self.neighbors[*number].iter().any(|&other| is_free(other as usize) != own)
        };
        // directions on both sides of an outline are counted
        (0..self.directions.len()).filter(is_at_outline).map(weight).sum::<f64>() / (2.0 * self.spacing)
    }

    /// The class of each target of a block, whose first columns are these directions and whose crowns have a
    /// [`factor`](crate::tree_light::CrownLight::factor), by which of the targets are inside obstacles. A target that
    /// is turned away from a direction by its normal does not see it.
    ///
    /// # Errors
    /// Those of [`RowBlock::free_lines`].
    pub fn classes(
        &self,
        (block, factor): (&RowBlock<'_>, f64),
        are_inside: &[bool],
        normals: Option<&[[f32; 3]]>,
    ) -> Result<Vec<u8>> {
        let free = block.free_lines(factor)?;
        let normals = normals_of(normals, &block.rows);
        let class = |row: usize| {
            let normal = normals.and_then(|normals| normals.get(row)).map(|normal| normal.map(f64::from));
            let is_free = |number: usize| {
                free.is_free(row, number) && normal.is_none_or(|n| dot(n, self.directions[number]) > 0.0)
            };
            let is_inside = are_inside.get(block.rows.start + row) == Some(&true);
            class_of(is_inside, self.moved_share(is_free))
        };
        Ok((0..free.target_count()).into_par_iter().with_min_len(CHUNK).map(class).collect())
    }
}

/// The class of a target, by whether it is inside an obstacle and how much of its sum moves with outlines.
#[must_use]
pub fn class_of(is_inside_obstacle: bool, moved_share: f64) -> u8 {
    if is_inside_obstacle {
        return 0;
    }
    let end = MOVED_CLASSES.iter().take_while(|end| moved_share >= **end).count();
    u8::try_from(1 + end).unwrap_or(u8::MAX)
}

/// Returns measures of the true value of `sums` of a kind, each at most `max`: the expected value and the ends of the
/// interval that holds the truth in 90 % of cases. Each target has its class; their names begin with `stem`.
#[must_use]
pub fn expected_measures(
    stem: &str,
    sums: &Measure,
    max: impl Fn(usize) -> f64,
    kind: SumKind,
    classes: &[u8],
) -> Vec<Measure> {
    let of_row = |(row, (&sum, &class)): (usize, (&f32, &u8))| match sum.is_nan() {
        true => [f64::NAN; 3],
        false => SumError::of(kind, class).interval(f64::from(sum), max(row)),
    };
    let found: Vec<[f64; 3]> = sums.values.iter().zip(classes).enumerate().map(of_row).collect();
    let measure = |(number, (suffix, text)): (usize, &(&str, &'static str))| {
        let values = found.iter().map(|ends| to_f32(ends[number])).collect();
        Measure { name: format!("{stem}_{suffix}"), values, ..sums.clone().with_description(text) }
    };
    INTERVAL_MEASURES.iter().enumerate().map(measure).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky_view::SkyDirections;
    use std::f64::consts::TAU;

    #[test]
    fn the_outline_of_a_wall_moves_the_share_that_a_great_circle_does() {
        // half of the sky is hidden: half a great circle of 180 degrees, which sweeps 180 square degrees in one degree
        let sky = SkyDirections::even(2000).unwrap();
        let outlines = Outlines::new(&sky.directions, &sky.solid_angles);
        let found = outlines.moved_share(|number| sky.directions[number][0] > 0.0);
        let expected = 180.0 / (TAU * 1f64.to_degrees() * 1f64.to_degrees());
        // directions have six neighbours at most: a row of them on each side of the outline, and some of the next
        assert!((found / expected - 1.0).abs() < 0.4, "{found} {expected}");
        let none = outlines.moved_share(|_| true);
        assert!(none.abs() < 1e-12 && outlines.moved_share(|_| false).abs() < 1e-12);
    }

    #[test]
    fn suns_of_a_day_move_by_their_spacing() {
        // one sun each two degrees along a great circle; light from the 20th to the 59th of 90: two ends
        let directions: Vec<[f64; 3]> = (0..90)
            .map(|step| (2.0 * f64::from(step) + 1.0).to_radians().sin_cos())
            .map(|(z, x)| [x, 0.0, z])
            .collect();
        let outlines = Outlines::new(&directions, &[1.0; 90]);
        let found = outlines.moved_share(|number| (20..60).contains(&number));
        // each end moves half a sun a degree
        assert!((found - 2.0 * 0.5 / 90.0).abs() < 1e-9, "{found}");
    }

    #[test]
    fn a_class_without_errors_has_those_of_a_class_beside_it() {
        let errors = read_errors("kind,class,mean,low,high,cases\nsun,3,0.1,-0.2,0.3,60\nsun,1,0,0,0,70\n");
        assert_eq!(errors[0][1].interval, [0.0, 0.0]);
        let third = SumError { mean: 0.1, interval: [-0.2, 0.3] };
        assert_eq!([errors[0][2], errors[0][3], errors[0][9]], [third; 3]);
    }

    #[test]
    fn intervals_lie_around_the_expected_value_and_within_what_is_possible() {
        let sums = Measure::new("sun_hours", vec![0.0, 4.0, 10.0, f32::NAN]);
        for class in 0..u8::try_from(CLASSES).unwrap() {
            for kind in SumKind::ALL.map(|(kind, _)| kind) {
                let found = expected_measures("hours", &sums, |_| 10.0, kind, &[class; 4]);
                let names: Vec<&str> = found.iter().map(|measure| measure.name.as_str()).collect();
                assert_eq!(names, ["hours_expected", "hours_low", "hours_high"]);
                for row in 0..3 {
                    let [expected, low, high] = [0, 1, 2].map(|i: usize| found[i].values[row]);
                    assert!((0.0..=10.0).contains(&low) && low <= high && high <= 10.0, "{class} {low} {high}");
                    assert!((0.0..=10.0).contains(&expected));
                }
                assert!(found.iter().all(|measure| measure.values[3].is_nan()));
            }
        }
        assert_eq!([class_of(true, 0.5), class_of(false, 0.0), class_of(false, 0.005)], [0, 1, 3]);
        assert_eq!(usize::from(class_of(false, 1.0)), CLASSES - 1);
    }
}
