//! North of azimuths: true north, or grid north if that is wanted or true north is unknown.

use crate::arguments::NorthArguments;
use crate::pipeline::LoadedScene;
use crate::summary::{Summary, rounded};
use belvedere::Frame;
use belvedere::apps::ask;
use belvedere::apps::horizon::convergence;

/// Name of the north of azimuths if the scene does not give true north.
const UNKNOWN_NORTH: &str =
    "grid north, because true north is unknown: the scene has no usable reference system (see --crs)";

/// The north of the azimuths of a command.
#[derive(Clone, Copy)]
pub(crate) struct CommandNorth {
    /// Azimuth of grid north, clockwise from the north of azimuths, radians. Subtract it from a given azimuth to get
    /// one in the grid, and add it to an azimuth in the grid to report it.
    pub(crate) of_grid: f64,
    name: &'static str,
}

impl NorthArguments {
    /// Returns the typed north.
    pub(crate) fn choice(&self) -> ask::North {
        if self.grid_north { ask::North::Grid } else { ask::North::True }
    }

    /// The north at the middle of the scene.
    pub(crate) fn of_scene(&self, scene: &LoadedScene) -> CommandNorth {
        let (low, high) = scene.model.bounds().corners();
        self.at(scene, [0, 1].map(|i| f64::midpoint(low[i], high[i])))
    }

    /// The north at a local place.
    pub(crate) fn at(&self, scene: &LoadedScene, place: [f64; 2]) -> CommandNorth {
        self.of_frame(&scene.cloud.frame, place)
    }

    /// The north at a local place of a frame.
    pub(crate) fn of_frame(&self, frame: &Frame, place: [f64; 2]) -> CommandNorth {
        if self.grid_north {
            return CommandNorth { of_grid: 0.0, name: "grid north" };
        }
        let [x, y] = [0, 1].map(|i| frame.origin[i] + place[i]);
        match convergence(&frame.crs, [x, y]) {
            Ok(of_grid) => CommandNorth { of_grid, name: "true north" },
            Err(_) => CommandNorth { of_grid: 0.0, name: UNKNOWN_NORTH },
        }
    }
}

impl CommandNorth {
    /// States the north, and how far grid north is from it.
    pub(crate) fn report(&self, summary: &mut Summary) {
        summary.add("azimuths_from", self.name);
        if self.name == UNKNOWN_NORTH {
            summary.add("note", format!("azimuths are from {UNKNOWN_NORTH}"));
        }
        if self.of_grid != 0.0 {
            summary.add("meridian_convergence_deg", rounded(self.of_grid.to_degrees(), 4));
        }
    }
}
