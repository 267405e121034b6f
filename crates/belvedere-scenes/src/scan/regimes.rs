//! Scanners and what they scan by name, so that a comparison can go through all of them.

use crate::room::furnished_rooms;
use crate::scan::Scan;
use crate::scan::airborne::{AirborneParams, scan_airborne};
use crate::scan::beam::BeamParams;
use crate::scan::mobile::{MobileParams, scan_mobile};
use crate::scan::order::PointOrder;
use crate::scan::scan_pattern::{MirrorMotion, ScanPattern};
use crate::scan::terrestrial::{Stations, TerrestrialParams, scan_terrestrial};
use crate::scene::TriangleScene;
use crate::town::roofs::RoofDetails;
use crate::town::trees::CrownMaterial;
use crate::town::{TownParams, town};

/// Tripods in a town: a few metres see what none of the others does.
const TRIPODS: u16 = 12;
/// Angle between their pulses, radians: 9 cm at 10 m, coarse, because all sizes that matter here are larger.
const TRIPOD_STEP: f64 = 0.5 / 180.0 * std::f64::consts::PI;
/// Lines of the car per second, and pulses in each: 20 cm from line to line, as coarse.
const CAR_LINES: f64 = 40.0;
const CAR_PULSES: u32 = 400;
/// Height of the drone, metres, its speed, metres per second, and its greatest angle from nadir, radians.
const DRONE: (f64, f64, f64) = (60.0, 10.0, 0.6);

/// A scanner and its scene. All but [`Regime::Room`] scan a town; each but the first differs from that in one way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Regime {
    /// [`AirborneParams::covering`]: 450 m up, a rotating mirror, 2 cm of noise, a beam of 0.4 mrad.
    Air,
    /// Without noise of ranges and directions.
    NoNoise,
    /// With 5 cm of noise of ranges.
    MuchNoise,
    /// With a beam that has no width.
    ThinBeam,
    /// With a beam of 1 mrad, half a metre on the ground.
    WideBeam,
    /// With an oscillating mirror.
    Oscillating,
    /// With a cone of 20°.
    Conical,
    /// From 60 m, up to 34° from nadir.
    Drone,
    /// Over trees of single leaves with gaps, instead of closed crowns.
    Leaves,
    /// Over trees without leaves: trunks and branches.
    Bare,
    /// Over roofs without eaves, parapets and boxes.
    PlainRoofs,
    /// Over houses that all have eaves, and flat roofs that all have parapets.
    Eaves,
    /// With the points of the file in random order.
    Shuffled,
    /// Twelve tripods, half a degree from pulse to pulse.
    Tripods,
    /// A car along each street, 20 cm from line to line. Towns below 100 m have no street.
    Car,
    /// Two furnished rooms instead of a town, with a tripod in each, half a degree from pulse to pulse.
    Room,
}

impl Regime {
    /// Every one.
    pub const ALL: [Self; 16] = [
        Self::Air,
        Self::NoNoise,
        Self::MuchNoise,
        Self::ThinBeam,
        Self::WideBeam,
        Self::Oscillating,
        Self::Conical,
        Self::Drone,
        Self::Leaves,
        Self::Bare,
        Self::PlainRoofs,
        Self::Eaves,
        Self::Shuffled,
        Self::Tripods,
        Self::Car,
        Self::Room,
    ];

    /// Name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Air => "air",
            Self::NoNoise => "noise-0-cm",
            Self::MuchNoise => "noise-5-cm",
            Self::ThinBeam => "beam-0-mrad",
            Self::WideBeam => "beam-1-mrad",
            Self::Oscillating => "oscillating",
            Self::Conical => "conical",
            Self::Drone => "drone",
            Self::Leaves => "leaves",
            Self::Bare => "bare",
            Self::PlainRoofs => "plain-roofs",
            Self::Eaves => "eaves",
            Self::Shuffled => "shuffled",
            Self::Tripods => "tripods",
            Self::Car => "car",
            Self::Room => "room",
        }
    }

    /// Whether the scanner flies: only then its pulses have a density to choose.
    #[must_use]
    pub fn flies(self) -> bool {
        !matches!(self, Self::Tripods | Self::Car | Self::Room)
    }

    /// The town as this needs it.
    #[must_use]
    pub fn town(self, params: TownParams) -> TownParams {
        match self {
            Self::Leaves => TownParams { crowns: CrownMaterial::Porous, ..params },
            Self::Bare => TownParams { crowns: CrownMaterial::Bare, ..params },
            Self::PlainRoofs => TownParams { roofs: RoofDetails::PLAIN, ..params },
            Self::Eaves => {
                let roofs = RoofDetails { eaves: 1.0, parapets: 1.0, ..params.roofs };
                TownParams { roofs, ..params }
            }
            _ => params,
        }
    }

    /// What is scanned: the town of `params`, or the rooms of their seed.
    #[must_use]
    pub fn scene(self, params: &TownParams) -> TriangleScene {
        if self == Self::Room { furnished_rooms(params.seed).0 } else { town(params) }
    }

    /// A survey of `scene`, which [`Regime::scene`] made of `params`, with their seed, and with `pulses_per_m2` where
    /// the scanner flies.
    #[must_use]
    pub fn scan(self, scene: &TriangleScene, params: &TownParams, pulses_per_m2: f64) -> Scan {
        let seed = params.seed;
        let usual = AirborneParams { seed, beam: BeamParams::in_leaf(), ..AirborneParams::default() };
        let beam = |divergence: f64| BeamParams { divergence, ..BeamParams::in_leaf() };
        let from_tripods = |stations: Stations| {
            let usual = TerrestrialParams::default();
            scan_terrestrial(scene, &TerrestrialParams { seed, stations, angular_step: TRIPOD_STEP, ..usual })
        };
        let flown = match self {
            Self::Tripods => return from_tripods(Stations::Chosen(TRIPODS)),
            Self::Room => return from_tripods(Stations::At(furnished_rooms(seed).1.to_vec())),
            Self::Car => {
                let (line_rate, pulses_per_line) = (CAR_LINES, CAR_PULSES);
                let usual = MobileParams::default();
                let params = MobileParams { seed, runs: params.lanes(), line_rate, pulses_per_line, ..usual };
                return scan_mobile(scene, &params);
            }
            Self::Air | Self::Leaves | Self::Bare | Self::PlainRoofs | Self::Eaves | Self::Shuffled => usual,
            Self::NoNoise => AirborneParams { range_sd: 0.0, pointing_sd: 0.0, boresight_sd: 0.0, ..usual },
            Self::MuchNoise => AirborneParams { range_sd: 0.05, ..usual },
            Self::ThinBeam => AirborneParams { beam: beam(0.0), ..usual },
            Self::WideBeam => AirborneParams { beam: beam(1e-3), ..usual },
            Self::Oscillating => AirborneParams { pattern: ScanPattern::Oscillating(MirrorMotion::default()), ..usual },
            Self::Conical => {
                AirborneParams { pattern: ScanPattern::Conical { half_angle: 20_f64.to_radians() }, ..usual }
            }
            Self::Drone => {
                let (flying_height, speed, half_angle) = DRONE;
                AirborneParams { flying_height, speed, half_angle, ..usual }
            }
        };
        let order = if self == Self::Shuffled { PointOrder::Shuffled } else { PointOrder::Flight };
        scan_airborne(scene, &flown.spread_over(scene, None, pulses_per_m2)).in_order(order, seed)
    }
}
