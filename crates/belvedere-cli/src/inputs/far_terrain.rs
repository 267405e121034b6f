//! Flags of what stands beyond the cloud.

use crate::arguments::FarTerrainArguments;
use crate::pipeline::LoadedScene;
use crate::run::CommandContext;
use crate::summary::{Summary, rounded};
use anyhow::Result;
use belvedere::apps::ask::scene::Whereabouts;
use belvedere::io::{read_horizon, read_terrain};
use belvedere::model::TerrainReport;
use std::path::Path;

impl FarTerrainArguments {
    /// The title of a map, which says that far terrain counts where it does.
    pub(crate) fn titled(&self, title: &str) -> String {
        let counts = self.terrain.is_some() || self.horizon.is_some();
        format!("{title}{}", if counts { ", with far terrain" } else { "" })
    }

    /// Puts the scene before the far terrain that was given.
    pub(crate) fn set(&self, scene: &mut LoadedScene, run: &mut CommandContext) -> Result<()> {
        if let Some(path) = &self.terrain {
            set_terrain(path, scene, run)?;
        }
        if let Some(path) = &self.horizon {
            let horizon = run.stage("reading horizon", 0, |_| read_horizon(path))?;
            let (frame, bounds) = (&scene.cloud.frame, scene.model.bounds());
            let place = Whereabouts { frame, bounds, has_far_terrain: false };
            let of_grid = place.convergence_at(place.middle()).unwrap_or(0.0);
            let highest = horizon.rows().iter().map(|row| row[1]).fold(f64::NEG_INFINITY, f64::max);
            let mut section = Summary::default();
            section.add("azimuths", horizon.rows().len()).add("max_elevation_deg", rounded(highest.to_degrees(), 3));
            run.summary.add("far_horizon", section);
            scene.model = std::mem::take(&mut scene.model).with_horizon(horizon.turned(-of_grid));
        }
        Ok(())
    }
}

/// Puts the scene before the terrain of an elevation raster.
pub(crate) fn set_terrain(path: &Path, scene: &mut LoadedScene, run: &mut CommandContext) -> Result<()> {
    let model = std::mem::take(&mut scene.model);
    let frame = model.frame().clone();
    let terrain = run.stage("reading terrain", 0, |_| read_terrain(path, &frame))?;
    let report = TerrainReport::of(&terrain, model.bounds(), &frame);
    let name = path.display().to_string();
    scene.model = run.stage("ordering terrain", 0, |_| model.with_terrain(terrain, &name))?;
    run.summary.add("terrain", Summary::of(&report));
    Ok(())
}
