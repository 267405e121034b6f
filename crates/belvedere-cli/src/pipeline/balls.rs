//! Which balls are asked for, and their making.

use super::Prepared;
use crate::arguments::{MethodChoice, Shrinking, TreesChoice, Usage};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::{Result, bail};
use belvedere::Error;
use belvedere::medial::{
    CarvedBalls, CarvedInput, CarvedParams, CarvedReport, CrownParams, MedialBalls, ShrinkMethod, ShrinkParams,
    ShrinkReport, Side, Trees, carved_balls, shrink,
};

/// Whether balls are to be cut by pulses.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carving {
    /// Or the run ends.
    Wanted,
    /// If there are pulses to do it.
    IfPossible,
    Unwanted,
}

/// How balls are made.
#[derive(Clone, Copy, Debug)]
pub(crate) enum BallParams {
    /// By the points alone.
    Shrunk(ShrinkParams),
    /// By points and pulses.
    Carved(CarvedParams),
    /// By points and pulses, or by the points alone where pulses cannot carve.
    CarvedIfPossible(CarvedParams, ShrinkParams),
}

impl BallParams {
    pub(crate) fn carving(&self) -> Carving {
        match self {
            Self::Shrunk(_) => Carving::Unwanted,
            Self::Carved(_) => Carving::Wanted,
            Self::CarvedIfPossible(..) => Carving::IfPossible,
        }
    }

    /// What is done with a cloud that was made ready.
    pub(crate) fn settled(self, prepared: &Prepared) -> Self {
        match self {
            Self::CarvedIfPossible(carved, _) if prepared.carving.is_some() => Self::Carved(carved),
            Self::CarvedIfPossible(_, shrunk) => Self::Shrunk(shrunk),
            settled => settled,
        }
    }

    /// The method as typed.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Carved(_) | Self::CarvedIfPossible(..) => "carved",
            Self::Shrunk(ShrinkParams { method: ShrinkMethod::Tau { .. }, .. }) => "tau",
            Self::Shrunk(ShrinkParams { method: ShrinkMethod::Angles { .. }, .. }) => "angles",
        }
    }
}

impl Shrinking {
    /// Parameters as typed; without a method those of `default`, where carving gives way to what is possible.
    pub(crate) fn params(&self, default: MethodChoice) -> Result<BallParams> {
        match (self.method, default) {
            (None, MethodChoice::Carved) => {
                if self.first_angle.is_some() || self.next_angle.is_some() {
                    return Err(angles_only());
                }
                Ok(BallParams::CarvedIfPossible(self.carved()?, self.shrunk(MethodChoice::Tau)?))
            }
            (Some(MethodChoice::Carved), _) => Ok(BallParams::Carved(self.carved()?)),
            (method, default) => {
                if self.trees.is_some() || !self.without.is_empty() {
                    return Err(Usage("--trees and --without belong to --method carved".to_owned()).into());
                }
                Ok(BallParams::Shrunk(self.shrunk(method.unwrap_or(default))?))
            }
        }
    }

    fn shrunk(&self, method: MethodChoice) -> Result<ShrinkParams> {
        let mut params = if method == MethodChoice::Tau { ShrinkParams::tau() } else { ShrinkParams::angles() };
        if let Some(radius) = self.initial_radius {
            params.initial_radius = radius;
        }
        if let Some(radius) = self.max_radius {
            params.max_radius = radius;
        }
        match &mut params.method {
            ShrinkMethod::Tau { penetration } => {
                if self.first_angle.is_some() || self.next_angle.is_some() {
                    return Err(angles_only());
                }
                *penetration = self.penetration.unwrap_or(*penetration);
            }
            ShrinkMethod::Angles { first_separation_angle, next_separation_angle } => {
                if self.penetration.is_some() {
                    return Err(Usage("--penetration belongs to --method tau and carved".to_owned()).into());
                }
                let typed = |angle: Option<f64>, default: f64| angle.map_or(default, f64::to_radians);
                *first_separation_angle = typed(self.first_angle, *first_separation_angle);
                *next_separation_angle = typed(self.next_angle, *next_separation_angle);
            }
        }
        check_shrinking(&params)?;
        Ok(params)
    }

    fn carved(&self) -> Result<CarvedParams> {
        if self.first_angle.is_some() || self.next_angle.is_some() {
            return Err(angles_only());
        }
        let mut params = CarvedParams::default();
        params.penetration = self.penetration.unwrap_or(params.penetration);
        params.initial_radius = self.initial_radius.unwrap_or(params.initial_radius);
        params.max_radius = self.max_radius.unwrap_or(params.max_radius);
        check_shrinking(&params.shrinking())?;
        if let Some(trees) = self.trees {
            let trees = match trees {
                TreesChoice::Opaque => Trees::Opaque,
                TreesChoice::Porous => Trees::Porous,
                TreesChoice::Measured => Trees::Measured,
            };
            params.crowns = params.crowns.map(|crowns| CrownParams { trees, ..crowns });
        }
        Ok(self.without.iter().fold(params, |params, &rule| params.without(rule)))
    }
}

fn angles_only() -> anyhow::Error {
    Usage("--first-angle and --next-angle belong to --method angles".to_owned()).into()
}

/// Makes a parameter out of range an error about its flag.
fn check_shrinking(params: &ShrinkParams) -> Result<()> {
    params.check().map_err(|error| match error {
        Error::InvalidParameter { name, .. } => {
            let flag = match name {
                "separation angle" => "--first-angle, --next-angle".to_owned(),
                "greatest radius" => "--max-radius".to_owned(),
                _ => format!("--{}", name.replace(' ', "-")),
            };
            anyhow::Error::from(Usage(format!("{flag}: {error}")))
        }
        other => other.into(),
    })
}

/// Balls of a cloud.
pub(crate) struct Made {
    pub(crate) balls: MedialBalls,
    /// As in [`CarvedBalls`].
    pub(crate) transmission: Vec<f32>,
}

/// Balls on one side, reported.
pub(crate) fn shrink_side(
    prepared: &Prepared,
    side: Side,
    params: BallParams,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<Made> {
    let name = match side {
        Side::Interior => "interior_balls",
        Side::Exterior => "exterior_balls",
    };
    let count = prepared.oriented.len();
    let (oriented, index) = (&prepared.oriented, &prepared.index);
    let (made, section) = match (params.settled(prepared), &prepared.carving) {
        (BallParams::Carved(params) | BallParams::CarvedIfPossible(params, _), Some(input)) => {
            let (attributes, needles, pulses) = (&input.kinds, &input.needles, input.pulses.as_ref());
            let input = CarvedInput { oriented, index, attributes, needles, pulses };
            let CarvedBalls { balls, transmission, report } =
                stages.run("making balls", count, |progress| carved_balls(&input, &params, progress))?;
            (Made { balls, transmission }, carved_section(&report))
        }
        (BallParams::Carved(_) | BallParams::CarvedIfPossible(..), None) => {
            bail!("pulses were not asked for, so that nothing can carve")
        }
        (BallParams::Shrunk(params), _) => {
            let (balls, report) =
                stages.run("shrinking balls", count, |progress| shrink(oriented, index, side, &params, progress))?;
            (Made { balls, transmission: Vec::new() }, balls_section(&report))
        }
    };
    summary.add(name, section);
    Ok(made)
}

fn carved_section(report: &CarvedReport) -> Summary {
    let mut section = balls_section(&report.shrinking);
    section
        .add("cut_by_pulses", report.carving.carved)
        .add("limited", report.carving.limited)
        .add("grown_to_least_radius", report.carving.grown)
        .add("told_to_be_vegetation", report.told_vegetation)
        .add("in_crowns_with_gaps", report.in_crowns_with_gaps)
        .add("balls_that_fill_crowns", report.crown_fills)
        .add("on_fences_wires_and_the_like", report.slender)
        .add("balls_that_fill_fences", report.slender_fills)
        .add("on_thin_surfaces", report.thin)
        .add("superfluous", report.pruned);
    section
}

fn balls_section(report: &ShrinkReport) -> Summary {
    let mut section = Summary::default();
    section
        .add("shrunk", report.shrunk)
        .add("never_shrunk_and_unused", report.never_shrunk)
        .add("without_normal", report.without_normal);
    section
}
