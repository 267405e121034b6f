//! Converts flags to the parameters of a scene model.

use crate::arguments::{Cleaning, MethodChoice, NeighborChoice, OrientChoice, Shrinking, Usage, refuse};
use crate::run::CommandContext;
use crate::scene_config::BallParameters;
use anyhow::Result;
use belvedere::clean::CleanParams;
use belvedere::crs::Crs;
use belvedere::io::{read_mesh_in, read_stations, read_trajectory};
use belvedere::medial::{CarvedParams, ShrinkMethod, ShrinkParams};
use belvedere::model::{BallParams, ModelParams, OrientBy, StripHeights};
use belvedere::normals::estimate::Neighborhood;
use belvedere::strips::StripParams;

/// Parameters of a model as typed, with the trajectory or the mesh that they name, for a cloud in `crs`.
pub(crate) fn model(
    parameters: &BallParameters,
    balls: BallParams,
    crs: &Crs,
    run: &mut CommandContext,
) -> Result<ModelParams> {
    let defaults = ModelParams::default();
    let neighborhood = match parameters.orienting.neighbors {
        None => defaults.neighborhood,
        Some(NeighborChoice::Fixed(k)) => Neighborhood::Fixed { k },
        Some(NeighborChoice::Adaptive) => Neighborhood::adaptive(),
    };
    parameters.naming(neighborhood.check().map_err(Into::into))?;
    let orient = match parameters.orienting.orient.as_ref().unwrap_or(&OrientChoice::Auto) {
        OrientChoice::Auto => OrientBy::Auto,
        OrientChoice::Given => OrientBy::Given,
        OrientChoice::Up => OrientBy::Up,
        OrientChoice::Scanner => OrientBy::Scanner,
        OrientChoice::ScannerAt(position) => OrientBy::ScannerAt(*position),
        OrientChoice::Pulses => OrientBy::Pulses,
        OrientChoice::Stations(path) => {
            OrientBy::Stations(run.stage("reading stations", 0, |_| read_stations(path, crs))?)
        }
        OrientChoice::Trajectory(path) => {
            let (trajectory, _) = run.stage("reading trajectory", 0, |_| read_trajectory(path, crs))?;
            OrientBy::Trajectory(trajectory)
        }
        OrientChoice::Mesh(path) => {
            // like every position that is typed or read, in the unit of the cloud's file
            OrientBy::Mesh(run.stage("reading mesh", 0, |_| read_mesh_in(path, crs))?.0)
        }
    };
    Ok(defaults
        .with_clean(parameters.cleaning.params())
        .with_strips(parameters.cleaning.strips())
        .with_neighborhood(neighborhood)
        .with_orient(orient)
        .with_balls(balls))
}

impl Cleaning {
    /// Parameters as typed.
    pub(crate) fn params(&self) -> CleanParams {
        let mut params = CleanParams::default();
        if self.keep_noise {
            params = params.keeping_noise();
        }
        if self.keep_duplicates {
            params = params.keeping_duplicates();
        }
        if self.keep_isolated {
            params = params.keeping_isolated();
        }
        params
    }

    /// Returns the treatment of flight lines that differ.
    pub(crate) fn strips(&self) -> StripHeights {
        if self.keep_strips { StripHeights::Kept(StripParams::default()) } else { StripHeights::default() }
    }

    /// Flags that clean nothing away.
    pub(crate) fn nothing() -> Self {
        Self { keep_noise: true, keep_duplicates: true, keep_isolated: true, keep_strips: true }
    }
}

impl BallParameters {
    /// Parameters of balls; without a method those of `default`, where carving gives way to what is possible.
    pub(crate) fn balls(&self, default: MethodChoice) -> Result<BallParams> {
        self.naming(self.shrinking.params(default))
    }
}

impl Shrinking {
    fn params(&self, default: MethodChoice) -> Result<BallParams> {
        match (self.method, default) {
            (None, MethodChoice::Carved) => {
                if self.first_angle.is_some() || self.next_angle.is_some() {
                    return Err(angles_only());
                }
                let mut shrunk = self.shrunk(MethodChoice::Tau)?;
                shrunk.max_spacings = ShrinkParams::tau_by_spacing().max_spacings;
                Ok(BallParams::CarvedIfPossible(self.carved()?, shrunk))
            }
            (Some(MethodChoice::Carved), _) => Ok(BallParams::Carved(self.carved()?)),
            (method, default) => {
                if self.trees.is_some() || !self.without.is_empty() {
                    return refuse("--trees and --without need --method carved");
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
                    return refuse("--penetration needs --method tau or carved");
                }
                let typed = |angle: Option<f64>, default: f64| angle.map_or(default, f64::to_radians);
                *first_separation_angle = typed(self.first_angle, *first_separation_angle);
                *next_separation_angle = typed(self.next_angle, *next_separation_angle);
            }
        }
        params.check()?;
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
        params.shrinking().check()?;
        if let Some(trees) = self.trees {
            params = params.with_trees(trees);
        }
        Ok(self.without.iter().fold(params, |params, &rule| params.without(rule)))
    }
}

fn angles_only() -> anyhow::Error {
    Usage("--first-angle and --next-angle need --method angles".to_owned()).into()
}
