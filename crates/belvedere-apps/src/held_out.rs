//! A truth that every airborne cloud carries: pulses that were left out when the model was built.
//!
//! The way of a pulse to its first return is free, and the space just behind its last return is not seen from the
//! scanner. Behind trees, fences and wires that is less certain than behind ground and buildings: a part of the beam
//! may pass beside them, too weak for another return. Pulses that a method never saw therefore show how often it blocks
//! free space and sees through solid space. Neighbouring pulses that it did see lie close by: the test says nothing of
//! space that no pulse reached.

use belvedere_core::pulses::{Pulses, SensorPositions};
use belvedere_core::query::{Answer, UnprovenAs};
use belvedere_data::cloud::to_local;
use belvedere_data::error::check_length;
use belvedere_data::vector::{length, sub, unit};
use belvedere_data::{Error, Parameter, PointCloud, Result};

/// Selection of held-out pulses, and of places whose visibility is queried.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldOutParams {
    /// Any number; another one holds out other pulses. Default 1.
    pub seed: u64,
    /// Share of the pulses held out, 0 to 1, both excluded. Default 0.1.
    pub share: f64,
    /// Distance before the first return at which the queried path begins, metres, above `clearance`. Default 30: above
    /// everything except towers, whose own pulses are queried too.
    pub path_length: f64,
    /// Distance before the first return at which the path ends, metres, 0 to 10. Default 0.3: some ten times the noise.
    pub clearance: f64,
    /// Distances behind the last return at which visibility is queried, metres, each 0 to 10. Default 0.3, 0.5 and 1.
    pub depths: Vec<f64>,
}

impl Default for HeldOutParams {
    fn default() -> Self {
        Self { seed: 1, share: 0.1, path_length: 30.0, clearance: 0.3, depths: vec![0.3, 0.5, 1.0] }
    }
}

/// Surface that a pulse met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MetSurface {
    /// Ground or water, class 2 or 9.
    Ground,
    /// Building, class 6.
    Building,
    /// Anything else, mostly trees; also where the cloud has no classes.
    Other,
}

/// Pairs of target and eye, each of a held-out pulse.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeldOutPairs {
    /// Local metres, (M, 3).
    pub targets: Vec<[f32; 3]>,
    /// Local metres, (M, 3).
    pub eyes: Vec<[f32; 3]>,
    /// Surface at the return of the target, (M).
    pub surfaces: Vec<MetSurface>,
}

/// A cloud without some of its pulses, and the pairs known from those pulses.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeldOut {
    /// Points to build from: all but the returns of pulses held out. Points that belong to no pulse are among them.
    pub kept: Vec<u32>,
    /// Pulses held out whose scanner position is known: the others give no queries.
    pub pulse_count: usize,
    /// Paths that are free: from before the first return to higher up the pulse.
    pub free: HeldOutPairs,
    /// Places that are not seen, by how far they lie behind the last return, metres; the eye is the scanner.
    pub behind: Vec<(f64, HeldOutPairs)>,
}

/// Number of wrong answers of a kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ErrorTally {
    /// Wrong answers.
    pub wrong_count: usize,
    /// Answers, right and wrong.
    pub answered_count: usize,
    /// [`Answer::OutsideView`]. [`Answer::Unproven`] counts as visible: nothing blocks the line of sight.
    pub undecided_count: usize,
}

impl ErrorTally {
    /// Wrong answers as a share of all answers, 0 to 1; NaN without any.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.wrong_count as f64 / self.answered_count as f64
    }

    /// Counts an answer where `wrong`, visible or blocked, is known not to be true.
    pub fn count(&mut self, answer: Answer, wrong: Answer) {
        let answer = UnprovenAs::Visible.settle(answer);
        if !matches!(answer, Answer::Visible | Answer::Blocked) {
            self.undecided_count += 1;
            return;
        }
        self.add(answer == wrong);
    }

    /// Counts an answer that is known to be right or wrong.
    pub fn add(&mut self, is_wrong: bool) {
        self.answered_count += 1;
        self.wrong_count += usize::from(is_wrong);
    }
}

impl HeldOutPairs {
    fn push(&mut self, target: [f64; 3], eye: [f64; 3], surface: MetSurface) {
        self.targets.push(to_local(target, [0.0; 3]));
        self.eyes.push(to_local(eye, [0.0; 3]));
        self.surfaces.push(surface);
    }

    /// The pairs of pulses that met a surface accepted by `keeps`.
    #[must_use]
    pub fn of_surfaces(&self, keeps: impl Fn(MetSurface) -> bool) -> Self {
        let rows = (0..self.surfaces.len()).filter(|&row| keeps(self.surfaces[row]));
        rows.fold(Self::default(), |mut kept, row| {
            kept.targets.push(self.targets[row]);
            kept.eyes.push(self.eyes[row]);
            kept.surfaces.push(self.surfaces[row]);
            kept
        })
    }
}

/// Holds out a random share of `pulses` with all their returns, and makes queries from those whose position in
/// `scanner` is known.
///
/// Which pulses are held out depends on the seed and their order alone. A pulse whose first return is missing gives no
/// queries on the path to it, and one whose last return is missing gives none behind it. A free path ends at the
/// scanner if that is nearer than [`HeldOutParams::path_length`].
///
/// # Errors
/// [`Error::InvalidParameter`] for a parameter outside its range, [`Error::LengthMismatch`] where `scanner` is of other
/// pulses, [`Error::MissingAttribute`] where the scanner is known for no pulse held out.
///
/// # Source
/// This project's own.
pub fn split(
    cloud: &PointCloud,
    pulses: &Pulses,
    scanner: &SensorPositions,
    params: &HeldOutParams,
) -> Result<HeldOut> {
    cloud.validate()?;
    params.validate()?;
    check_length("scanner positions of the pulses", pulses.len(), scanner.per_pulse.len())?;
    let mut is_kept = vec![true; cloud.len()];
    let mut held_out =
        HeldOut { behind: params.depths.iter().map(|&d| (d, HeldOutPairs::default())).collect(), ..HeldOut::default() };
    let place = |row: u32| cloud.positions.get(row as usize).map(|p| p.map(f64::from));
    for (pulse, scanner) in scanner.per_pulse.iter().enumerate() {
        if belvedere_data::random::uniform(params.seed, pulse as u64) >= params.share {
            continue;
        }
        for &row in pulses.returns_of(pulse) {
            if let Some(kept) = is_kept.get_mut(row as usize) {
                *kept = false;
            }
        }
        let scanner = scanner.map(f64::from);
        if !scanner.iter().all(|v| v.is_finite()) {
            continue;
        }
        held_out.pulse_count += 1;
        let sight = |row: u32| {
            let from = place(row)?;
            let sight = sub(scanner, from);
            unit(sight).map(|towards| (from, towards, length(sight)))
        };
        let along =
            |from: [f64; 3], towards: [f64; 3], range: f64| std::array::from_fn(|i| from[i] + range * towards[i]);
        if let Some(row) = pulses.first_return(pulse)
            && let Some((from, towards, range)) = sight(row)
            && range > params.clearance
        {
            let target = along(from, towards, params.clearance);
            held_out.free.push(target, along(from, towards, params.path_length.min(range)), surface(cloud, row));
        }
        if let Some(row) = pulses.last_return(pulse)
            && let Some((from, towards, _)) = sight(row)
        {
            for (depth, pairs) in &mut held_out.behind {
                pairs.push(along(from, towards, -*depth), scanner, surface(cloud, row));
            }
        }
    }
    if held_out.pulse_count == 0 {
        return Err(Error::MissingAttribute {
            attribute: "scanner position of a held-out pulse",
            needed_for: "the test by held-out pulses",
            advice: "give a trajectory",
        });
    }
    held_out.kept = (0_u32..).zip(&is_kept).filter(|(_, kept)| **kept).map(|(row, _)| row).collect();
    Ok(held_out)
}

fn surface(cloud: &PointCloud, row: u32) -> MetSurface {
    match cloud.attributes.classification.as_deref().and_then(|classes| classes.get(row as usize)) {
        Some(2 | 9) => MetSurface::Ground,
        Some(6) => MetSurface::Building,
        _ => MetSurface::Other,
    }
}

impl HeldOutParams {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for the first that is outside its range.
    pub fn validate(&self) -> Result<()> {
        if !(self.share > 0.0 && self.share < 1.0) {
            return Err(Error::invalid(Parameter::HeldOutShare, self.share, "above 0 and below 1, such as 0.1"));
        }
        let wrong = |name: &str, value: String, expected| {
            Err(Error::invalid(Parameter::MethodSetting, format!("{value} for the {name}"), expected))
        };
        if !(0.0..=10.0).contains(&self.clearance) {
            return wrong("clearance before the first return", self.clearance.to_string(), "0 to 10 m");
        }
        if !(self.path_length > self.clearance) {
            return wrong("length of the free path", self.path_length.to_string(), "above the clearance");
        }
        if !self.depths.iter().all(|depth| (0.0..=10.0).contains(depth)) {
            return wrong("depths behind the last return", format!("{:?}", self.depths), "0 to 10 m");
        }
        Ok(())
    }
}
