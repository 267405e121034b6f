//! Scanners and their scenes by name, so that a comparison can go through all of them.

use crate::room::furnished_rooms;
use crate::scan::Scan;
use crate::scan::airborne::scan_airborne;
use crate::scan::beam::BeamParams;
use crate::scan::flight::AirborneParams;
use crate::scan::mobile::{MobileParams, scan_mobile};
use crate::scan::order::PointOrder;
use crate::scan::scan_pattern::{MirrorMotion, ScanPattern};
use crate::scan::terrestrial::{Stations, TerrestrialParams, scan_terrestrial};
use crate::scene::TriangleScene;
use crate::town::site::RoofDetails;
use crate::town::trees::CrownMaterial;
use crate::town::{TownParams, town};

/// Number of tripods in a town: each sees places that no other sees, over a few metres.
const TRIPODS: u16 = 12;
/// Angle between their pulses, radians: 9 cm at 10 m. It is coarse, because all relevant sizes here are larger.
const TRIPOD_STEP: f64 = 0.5 / 180.0 * std::f64::consts::PI;
/// Lines of the car per second, and pulses in each: 20 cm from line to line, equally coarse.
const CAR_LINES: f64 = 40.0;
const CAR_PULSES: u32 = 400;
/// Height of the drone, metres, its speed, metres per second, and its maximum angle from nadir, radians.
const DRONE: (f64, f64, f64) = (60.0, 10.0, 0.6);

/// Scanner and its scene. All except [`Regime::Room`] scan a town. Every other regime differs from the first in one
/// respect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Regime {
    /// [`AirborneParams::covering`]: 450 m up, a rotating mirror, 2 cm of noise, a beam of 0.4 mrad.
    Air,
    /// No noise of ranges and directions.
    NoNoise,
    /// Noise of ranges of 5 cm.
    MuchNoise,
    /// Beam without width.
    ThinBeam,
    /// Beam of 1 mrad, half a metre on the ground.
    WideBeam,
    /// Oscillating mirror.
    Oscillating,
    /// Cone of 20°.
    Conical,
    /// Drone at 60 m, with angles up to 34° from nadir.
    Drone,
    /// Trees of single leaves with gaps, instead of closed crowns.
    Leaves,
    /// Trees without leaves: trunks and branches.
    Bare,
    /// Roofs without eaves, parapets and boxes.
    PlainRoofs,
    /// Eaves on all houses, and parapets on all flat roofs.
    Eaves,
    /// Points of the file in random order.
    Shuffled,
    /// Twelve tripods, half a degree from pulse to pulse.
    Tripods,
    /// Car along each street, 20 cm from line to line. Towns below 100 m have no street.
    Car,
    /// Two furnished rooms instead of a town, with a tripod in each, half a degree from pulse to pulse.
    Room,
}

impl Regime {
    /// All regimes.
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

    /// Returns the name on the command line.
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

    /// Returns true if the scanner flies. Only then can the density of pulses be chosen.
    #[must_use]
    pub fn flies(self) -> bool {
        !matches!(self, Self::Tripods | Self::Car | Self::Room)
    }

    /// Returns the town with the changes that this regime needs.
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

    /// Returns the scanned scene: the town of `params`, or the rooms of their seed.
    #[must_use]
    pub fn scene(self, params: &TownParams) -> TriangleScene {
        if self == Self::Room { furnished_rooms(params.seed).0 } else { town(params) }
    }

    /// Returns a survey of `scene`, which [`Regime::scene`] made of `params`, with their seed. A flying scanner has
    /// `pulses_per_m2`.
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
