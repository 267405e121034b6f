//! North of azimuths: true north, or grid north if that is wanted or true north is unknown.

use super::context::Context;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::NorthReport;
use belvedere_data::report::rounded;
use serde::{Deserialize, Serialize};

/// North of azimuths: true or grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum North {
    /// True north; grid north where the scene has no usable reference system. Default.
    #[default]
    True,
    /// The north of the grid.
    Grid,
}

/// The north of a scene that azimuths count from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AzimuthNorth {
    /// Azimuth of grid north from there, clockwise, radians: subtract it from a given azimuth, add it to one of the
    /// grid.
    pub of_grid: f64,
    counted_from: CountedFrom,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CountedFrom {
    TrueNorth,
    GridNorth,
    /// True north was wanted.
    GridNorthForWantOfBetter,
}

const UNKNOWN: &str =
    "grid north, because true north is unknown: the scene has no usable reference system (EPSG code or WKT)";

impl North {
    /// The north at a local place of a scene.
    #[must_use]
    pub fn at(self, scene: &Scene, place: [f64; 2]) -> AzimuthNorth {
        self.of(scene.convergence_at(place))
    }

    /// The north at the middle of a scene.
    #[must_use]
    pub fn of_scene(self, scene: &Scene) -> AzimuthNorth {
        self.at(scene, scene.middle())
    }

    /// The north where grid north has this azimuth from true north, radians, if that is known.
    #[must_use]
    pub fn of(self, convergence: Option<f64>) -> AzimuthNorth {
        match (self, convergence) {
            (Self::Grid, _) => AzimuthNorth { of_grid: 0.0, counted_from: CountedFrom::GridNorth },
            (Self::True, Some(of_grid)) => AzimuthNorth { of_grid, counted_from: CountedFrom::TrueNorth },
            (Self::True, None) => AzimuthNorth { of_grid: 0.0, counted_from: CountedFrom::GridNorthForWantOfBetter },
        }
    }
}

impl AzimuthNorth {
    /// Returns true if azimuths count from true north.
    #[must_use]
    pub fn is_true(&self) -> bool {
        self.counted_from == CountedFrom::TrueNorth
    }

    /// For reports.
    #[must_use]
    pub fn report(&self) -> NorthReport {
        let degrees = rounded(self.of_grid.to_degrees(), 4);
        let meridian_convergence_deg = (self.of_grid != 0.0).then_some(degrees);
        let azimuths_from = match self.counted_from {
            CountedFrom::TrueNorth => "true north",
            CountedFrom::GridNorth => "grid north",
            CountedFrom::GridNorthForWantOfBetter => UNKNOWN,
        };
        NorthReport { azimuths_from, meridian_convergence_deg }
    }

    /// A note where true north was wanted and is unknown.
    #[must_use]
    pub fn remark(&self) -> Option<Remark> {
        (self.counted_from == CountedFrom::GridNorthForWantOfBetter)
            .then(|| Remark::note("true-north-unknown", format!("azimuths count from {UNKNOWN}")))
    }
}

impl Context {
    /// Reports on the north of azimuths.
    pub(super) fn north(&mut self, north: &AzimuthNorth) {
        self.report.north = Some(north.report());
        self.add(north.remark());
    }
}
