//! Where to scan again, so that lines of sight of a question that are unproven today become proven.
//!
//! A line is unproven because no pulse came near to pieces of it. These pieces are cut into *places*. A scan from a
//! candidate is simulated in the model: along each of its ways runs a pulse up to the first surface. A place is proven
//! if a pulse passes near to it and returns. A line is *settled* when no more of it is unproven than
//! [`Proof::tolerance`](belvedere_core::query::Proof::tolerance).
//!
//! Stations are chosen by [`place_cameras`]: places and lines are its targets.

use crate::cameras::{CoverageTable, Goal, Placement, PlacementParams, place_cameras};
use belvedere_core::ground::Ground;
use belvedere_core::pulses::FreeSegmentParams;
use belvedere_core::query::{MedialScene, Proof};
use belvedere_data::control::Control;
use belvedere_data::vector::{cross, dot, length, sub, unit};
use belvedere_data::view::panorama_direction;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};

/// Height of a scanner on a tripod above the ground, metres.
pub const STATION_HEIGHT: f64 = 1.8;
/// Side of the cells in which unproven pieces of lines are one place, as a share of how near a pulse must pass.
const CELL_PER_NEARNESS: f64 = 0.5;
/// Columns of the ways of a simulated scan: half a degree. Within 80 m they are nearer to each other than a pulse must
/// pass.
const COLUMNS: usize = 720;
/// Rings of ways that are tried around a place: radius as a share of how near they must pass, and number.
const RINGS: [(f64, u32); 3] = [(0.0, 1), (0.5, 6), (0.9, 12)];
/// How much of the worth of a line its proven share is. The rest counts for a station that settles the line alone.
const WORTH_OF_SHARE: f64 = 0.25;

/// What a scanner can do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ScannerParams {
    /// Greatest range at which a surface returns pulses, metres, above 0. Default 100: medium-range scanners on tripods
    /// reach 100 to 130 m on most surfaces.
    pub max_range: f64,
    /// Angle between neighbouring pulses, radians, above 0. Default 0.1°: a coarse scan, of a minute or two.
    pub angular_step: f64,
}

belvedere_data::setters!(ScannerParams {
    with_max_range(max_range: f64),
    with_angular_step(angular_step: f64),
});

impl Default for ScannerParams {
    fn default() -> Self {
        Self { max_range: 100.0, angular_step: 0.1_f64.to_radians() }
    }
}

impl ScannerParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        let invalid = |parameter, value: f64, expected| {
            Err(Error::InvalidParameter { parameter, value: value.to_string(), expected })
        };
        if !(self.max_range.is_finite() && self.max_range > 0.0) {
            return invalid(Parameter::MaxDistance, self.max_range, "finite and above zero metres");
        }
        if !(self.angular_step > 0.0 && self.angular_step <= FRAC_PI_2) {
            return invalid(Parameter::AngleStep, self.angular_step.to_degrees(), "above 0, and at most 90");
        }
        Ok(())
    }
}

/// What stations prove of unproven lines.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurveyGain {
    /// Lines that are settled.
    pub settled: usize,
    /// Length of unproven pieces that is proven, over all lines, metres.
    pub proven: f64,
}

/// Stations that were chosen, and what is expected of them.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyPlan {
    /// Candidates that were chosen, those that add most first.
    pub chosen: Vec<usize>,
    /// What the first stations prove together, (chosen + 1); that of no station comes first.
    pub curve: Vec<SurveyGain>,
    /// What each candidate would prove alone.
    pub alone: Vec<SurveyGain>,
    /// What all candidates would prove together.
    pub reachable: SurveyGain,
    /// Unproven length of all lines, metres.
    pub unproven: f64,
    /// By how much the worth of the choice is at most below the best possible, as a share of that.
    pub gap: f64,
}

/// Unproven pieces of lines, cut into places.
struct OpenSpace {
    /// Local metres.
    places: Vec<[f64; 3]>,
    lines: Vec<OpenLine>,
    /// Unproven length of a line that is settled even so, metres.
    tolerance: f64,
}

/// What is unproven of a line.
struct OpenLine {
    /// Places on it, and the length that each stands for, metres.
    parts: Vec<(usize, f64)>,
    length: f64,
}

impl OpenLine {
    fn proven(&self, is_proven: impl Fn(usize) -> bool) -> f64 {
        self.parts.iter().filter(|(place, _)| is_proven(*place)).map(|(_, length)| length).sum()
    }
}

impl OpenSpace {
    fn of(lines: &[Vec<[[f64; 3]; 2]>], proof: &Proof) -> Self {
        let side = CELL_PER_NEARNESS * proof.nearness();
        let (mut places, mut by_cell) = (Vec::new(), HashMap::new());
        let mut open_line = |pieces: &Vec<[[f64; 3]; 2]>| {
            let mut parts = Vec::new();
            for &[from, to] in pieces {
                let along = sub(to, from);
                let size = length(along);
                let count = (size / side).ceil().max(1.0);
                let middles = (0..).map(f64::from).take_while(|number| *number < count);
                for at in middles.map(|number| (number + 0.5) / count) {
                    let place: [f64; 3] = std::array::from_fn(|i| from[i] + at * along[i]);
                    #[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
                    let cell = place.map(|v| (v / side).floor() as i64);
                    let number = *by_cell.entry(cell).or_insert_with(|| {
                        places.push(place);
                        places.len() - 1
                    });
                    parts.push((number, size / count));
                }
            }
            let length = parts.iter().map(|(_, length)| length).sum();
            OpenLine { parts, length }
        };
        let lines = lines.iter().map(&mut open_line).collect();
        Self { places, lines, tolerance: proof.tolerance() }
    }

    fn is_settled(&self, line: &OpenLine, is_proven: impl Fn(usize) -> bool) -> bool {
        line.length - line.proven(is_proven) <= self.tolerance
    }

    fn gain(&self, is_proven: impl Fn(usize) -> bool) -> SurveyGain {
        let mut gain = SurveyGain::default();
        for line in &self.lines {
            gain.settled += usize::from(self.is_settled(line, &is_proven));
            gain.proven += line.proven(&is_proven);
        }
        gain
    }

    /// How much each place counts, and then each line.
    fn weights(&self) -> Vec<f64> {
        let mut weights = vec![0.0; self.places.len()];
        for line in &self.lines {
            for &(place, length) in &line.parts {
                weights[place] += WORTH_OF_SHARE * length / line.length;
            }
        }
        weights.extend(self.lines.iter().map(|_| 1.0 - WORTH_OF_SHARE));
        weights
    }
}

/// Chooses `count` of the candidates at `eyes`, (N) local metres, NaN for one that is not to be used. `lines` are the
/// unproven lines of sight of a question: of each the pieces that no pulse came near to
/// ([`MedialScene::unproven_pieces`]), which must be longer than what the proof of `scene` tolerates. Where the model
/// ends, pulses return from the level of `ground` below the station. Control counts candidates. The same for any number
/// of threads.
///
/// # Errors
/// [`Error::MissingAttribute`] for a scene without pulses, those of [`ScannerParams::validate`] and of
/// [`place_cameras`], and [`Error::Cancelled`].
pub fn plan_survey(
    (scene, ground): (&MedialScene, Option<&Ground>),
    eyes: &[[f64; 3]],
    lines: &[Vec<[[f64; 3]; 2]>],
    count: usize,
    params: &ScannerParams,
    control: &Control<'_>,
) -> Result<SurveyPlan> {
    params.validate()?;
    let proof = scene.proof().ok_or_else(missing_pulses)?;
    let open = OpenSpace::of(lines, proof);
    let around: Vec<[f64; 2]> = RINGS.iter().flat_map(|&(radius, count)| ring(radius, count)).collect();
    let proven_by = |&eye: &[f64; 3]| {
        control.check()?;
        let scan = VirtualScan::new((scene, ground), eye, params);
        let proven = scan.map_or_else(Vec::new, |scan| scan.proven(&open.places, proof.nearness(), &around));
        control.advance(1);
        Ok(proven)
    };
    let proven: Vec<Vec<usize>> = eyes.par_iter().map(proven_by).collect::<Result<_>>()?;
    let in_all = |candidates: &[usize]| {
        let mut is_proven = vec![false; open.places.len()];
        candidates.iter().flat_map(|&candidate| &proven[candidate]).for_each(|&place| is_proven[place] = true);
        is_proven
    };
    let covered_and_gain = |candidate: usize| {
        let is_proven = in_all(&[candidate]);
        let settled =
            (0..open.lines.len()).filter(|&line| open.is_settled(&open.lines[line], |place| is_proven[place]));
        let covered = proven[candidate].iter().copied().chain(settled.map(|line| open.places.len() + line)).collect();
        (covered, open.gain(|place| is_proven[place]))
    };
    let (covered, alone): (Vec<Vec<usize>>, Vec<SurveyGain>) =
        (0..eyes.len()).into_par_iter().map(covered_and_gain).unzip();
    let table = CoverageTable::of_lists(open.places.len() + open.lines.len(), &covered)?;
    // exchanges find what a search would, and the bound says how much could be missing
    let params = PlacementParams::new(Goal::Count(count)).with_search_limit(Some(0));
    let placed: Option<Placement> =
        (!lines.is_empty()).then(|| place_cameras(&table, &open.weights(), &params, control)).transpose()?;
    let chosen = placed.as_ref().map_or_else(Vec::new, |placed| placed.chosen.clone());
    let of_all = |candidates: &[usize]| {
        let is_proven = in_all(candidates);
        open.gain(|place| is_proven[place])
    };
    let everything: Vec<usize> = (0..eyes.len()).collect();
    Ok(SurveyPlan {
        curve: (0..=chosen.len()).map(|first| of_all(&chosen[..first])).collect(),
        alone,
        reachable: of_all(&everything),
        unproven: open.lines.iter().map(|line| line.length).sum(),
        gap: placed.map_or(0.0, |placed| placed.gap()),
        chosen,
    })
}

/// A scene that does not know its pulses, as an error.
pub(crate) fn missing_pulses() -> Error {
    Error::MissingAttribute {
        attribute: "pulses with known scanner positions",
        needed_for: "a plan of what to scan again",
        advice: "without them no line of sight is unproven: give scanner positions with --orient (trajectory=FILE, stations=FILE or scanner=X,Y,Z), \
                 or an .npz ball file of a cloud that had them",
    }
}

/// Places on a circle.
fn ring(radius: f64, count: u32) -> impl Iterator<Item = [f64; 2]> {
    (0..count).map(move |number| {
        let (sin, cos) = (TAU * f64::from(number) / f64::from(count)).sin_cos();
        [radius * cos, radius * sin]
    })
}

/// A scan of the model from one place, whose ways are followed when they are first needed.
struct VirtualScan<'a> {
    scene: &'a MedialScene,
    params: &'a ScannerParams,
    eye: [f64; 3],
    /// Height of the ground below, local metres.
    floor: f64,
    /// Length that a pulse proves along each way, metres: 0 where it does not return, NaN where it is not known yet.
    lengths: Vec<f32>,
}

impl<'a> VirtualScan<'a> {
    /// `None` for an eye that is not finite.
    fn new(
        (scene, ground): (&'a MedialScene, Option<&Ground>),
        eye: [f64; 3],
        params: &'a ScannerParams,
    ) -> Option<Self> {
        // who looks at what nobody saw may stand on ground that nobody saw
        let known = ground.and_then(|ground| ground.height_at([eye[0], eye[1]]));
        let floor = known.unwrap_or(eye[2] - STATION_HEIGHT);
        let lengths = vec![f32::NAN; COLUMNS * COLUMNS / 2];
        eye.iter().all(|v| v.is_finite()).then_some(Self { scene, params, eye, floor, lengths })
    }

    /// The numbers of the places that it proves.
    fn proven(mut self, places: &[[f64; 3]], nearness: f64, around: &[[f64; 2]]) -> Vec<usize> {
        (0..places.len()).filter(|&place| self.proves(places[place], nearness, around)).collect()
    }

    /// Whether a pulse passes near to a place and returns.
    fn proves(&mut self, place: [f64; 3], nearness: f64, around: &[[f64; 2]]) -> bool {
        let offset = sub(place, self.eye);
        let distance = length(offset);
        // a way stands for the pulse nearest to it, which runs up to half a diagonal of their grid beside it
        let near = nearness - FRAC_1_SQRT_2 * self.params.angular_step * distance;
        if !(near > 0.0 && distance <= self.params.max_range) {
            return false;
        }
        let Some(ahead) = unit(offset) else { return false };
        let right = unit(cross(ahead, [0.0, 0.0, 1.0])).unwrap_or([1.0, 0.0, 0.0]);
        let up = cross(right, ahead);
        around.iter().any(|[x, y]| {
            let towards = std::array::from_fn(|i| offset[i] + near * (x * right[i] + y * up[i]));
            let (direction, proven) = self.way(towards);
            let at = dot(offset, direction).clamp(0.0, proven);
            let beside = sub(offset, direction.map(|v| at * v));
            proven > 0.0 && dot(beside, beside) <= near * near
        })
    }

    /// The way nearest to a direction: its unit vector, and the length that its pulse proves, metres.
    fn way(&mut self, towards: [f64; 3]) -> ([f64; 3], f64) {
        let [x, y, z] = towards;
        let step = TAU / COLUMNS as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a pixel; `as` saturates")]
        let cell = |angle: f64, count: usize| ((angle / step) as usize).min(count - 1);
        let column = cell(x.atan2(y) + PI, COLUMNS);
        let row = cell(FRAC_PI_2 - z.atan2(x.hypot(y)), COLUMNS / 2);
        let direction = panorama_direction(COLUMNS, [column, row]);
        let number = row * COLUMNS + column;
        if self.lengths[number].is_nan() {
            #[expect(clippy::cast_possible_truncation, reason = "a range in metres")]
            let found = self.follow(direction) as f32;
            self.lengths[number] = found;
        }
        (direction, f64::from(self.lengths[number]))
    }

    fn follow(&self, direction: [f64; 3]) -> f64 {
        let max_range = self.params.max_range;
        let seen = self.scene.seen_along(self.eye, direction, max_range).map(|(_, range)| range);
        // where the model has nothing, the ground goes on below the cloud, and nothing returns from above
        let range = seen.or_else(|| {
            let range = (self.eye[2] - self.floor) / -direction[2];
            let foot = std::array::from_fn(|i| self.eye[i] + range * direction[i]);
            let is_known = self.scene.coverage().is_none_or(|coverage| coverage.holds_on_map(foot));
            (direction[2] < 0.0 && (0.0..=max_range).contains(&range) && is_known).then_some(range)
        });
        let margin = f64::from(FreeSegmentParams::default().end_margin);
        range.map_or(0.0, |range| (range - margin).max(0.0))
    }
}
