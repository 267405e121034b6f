//! Diffuse radiation on a tilted plane, in parts that obstacles reduce differently.

use super::atmosphere::air_mass;
use belvedere_data::weather::Irradiance;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Model of the sky's diffuse radiation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum SkyModel {
    /// The same from all of the sky.
    Isotropic,
    /// Hay & Davies: a part comes from the sun, the rest evenly.
    HayDavies,
    /// Perez et al. 1990: a part from the sun, a part from the horizon, the rest evenly.
    Perez,
    /// Perez et al. 1993: a radiance for each patch of the sky; whether a patch is seen is tested for each. Default: of
    /// the four the one that knows which part of an uneven sky an obstacle takes away.
    #[default]
    Patches,
}

impl std::fmt::Display for SkyModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Isotropic => "isotropic",
            Self::HayDavies => "Hay & Davies",
            Self::Perez => "Perez 1990",
            Self::Patches => "patches of the sky, Perez 1993",
        })
    }
}

/// Parts of diffuse radiation, W/m², that add up on a plane as `even · s + sun · max(cos a, 0) + horizon · sin t`. `s`
/// is the share of the sky that the plane faces, (1 + cos t)/2 without obstacles; `a` is the angle between sun and
/// normal, `t` the tilt. `sun` is given for a plane that faces the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DiffuseParts {
    /// The same from all of the sky.
    pub even: f64,
    /// Part around the sun: lost where the sun is hidden.
    pub sun: f64,
    /// Part along the horizon; negative where that is darker than the rest.
    pub horizon: f64,
}

impl DiffuseParts {
    /// Returns the radiation on a plane without obstacles, W/m², from its tilt, radians, and the cosine between its
    /// normal and the sun.
    #[must_use]
    pub fn unshaded(&self, tilt: f64, cosine: f64) -> f64 {
        let (sin, cos) = tilt.sin_cos();
        (self.even * f64::midpoint(1.0, cos) + self.sun * cosine.max(0.0) + self.horizon * sin).max(0.0)
    }
}

/// Coefficients of Perez et al. 1990, all sites together: F11, F12, F13, F21, F22, F23 for each of eight classes of
/// clearness.
const PEREZ: [[f64; 6]; 8] = [
    [-0.008, 0.588, -0.062, -0.060, 0.072, -0.022],
    [0.130, 0.683, -0.151, -0.019, 0.066, -0.029],
    [0.330, 0.487, -0.221, 0.055, -0.064, -0.026],
    [0.568, 0.187, -0.295, 0.109, -0.152, -0.014],
    [0.873, -0.392, -0.362, 0.226, -0.462, 0.001],
    [1.132, -1.237, -0.412, 0.288, -0.823, 0.056],
    [1.060, -1.600, -0.359, 0.264, -1.127, 0.131],
    [0.678, -0.327, -0.250, 0.156, -1.377, 0.251],
];
/// Upper bounds of all classes of clearness but the last.
const CLASSES: [f64; 7] = [1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];
/// Weight of the zenith's cube in the clearness, for angles in radians.
const KAPPA: f64 = 1.041;
/// Minimum cosine of the zenith that Hay & Davies' ratio divides by: a sun of one degree, as in pvlib.
const HAY_DAVIES_MIN: f64 = 0.01745;

/// Clearness and brightness of a sky, and the class of its clearness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SkyState {
    pub(super) clearness: f64,
    pub(super) brightness: f64,
    /// 0 (overcast) to 7 (clear).
    pub(super) class: usize,
}

/// The state of a sky under a sun at `zenith`, radians (apparent): Perez et al. 1990, equations 1 and 2. `None` at
/// night and without diffuse radiation.
pub(super) fn sky_state(irradiance: &Irradiance, zenith: f64, extraterrestrial: f64) -> Option<SkyState> {
    let air_mass = air_mass(zenith)?;
    let cube = KAPPA * zenith.powi(3);
    let clearness = ((irradiance.dhi + irradiance.dni) / irradiance.dhi + cube) / (1.0 + cube);
    let brightness = irradiance.dhi * air_mass / extraterrestrial;
    let class = CLASSES.iter().filter(|&&bound| clearness >= bound).count();
    (irradiance.dhi > 0.0 && clearness.is_finite() && brightness.is_finite()).then_some(SkyState {
        clearness,
        brightness,
        class,
    })
}

/// The parts of the diffuse radiation of `irradiance` under a sun at `zenith`, radians (apparent), where
/// `extraterrestrial` W/m² arrive above the atmosphere. All zero where Perez's model does not know the sky: for a sun
/// below the horizon and without diffuse radiation. [`SkyModel::Patches`], whose sky has more than three parts, gives
/// none.
///
/// # Source
/// Hay & Davies 1980; Perez, Ineichen, Seals, Michalsky & Stewart 1990, Modeling daylight availability and irradiance
/// components from direct and global irradiance, equations 9 to 11 and table 6.
#[must_use]
pub fn diffuse_parts(model: SkyModel, irradiance: &Irradiance, zenith: f64, extraterrestrial: f64) -> DiffuseParts {
    let dhi = irradiance.dhi.max(0.0);
    let cosine = zenith.cos();
    match model {
        SkyModel::Patches => DiffuseParts::default(),
        SkyModel::Isotropic => DiffuseParts { even: dhi, sun: 0.0, horizon: 0.0 },
        SkyModel::HayDavies => {
            let from_sun = if zenith < FRAC_PI_2 { (irradiance.dni / extraterrestrial).clamp(0.0, 1.0) } else { 0.0 };
            let sun = dhi * from_sun / cosine.max(HAY_DAVIES_MIN);
            DiffuseParts { even: dhi * (1.0 - from_sun), sun, horizon: 0.0 }
        }
        SkyModel::Perez => {
            let Some(state) = sky_state(irradiance, zenith, extraterrestrial) else { return DiffuseParts::default() };
            let [f11, f12, f13, f21, f22, f23] = PEREZ[state.class];
            let from_sun = (f11 + f12 * state.brightness + f13 * zenith).max(0.0);
            let from_horizon = f21 + f22 * state.brightness + f23 * zenith;
            let sun = dhi * from_sun / cosine.max(85f64.to_radians().cos());
            DiffuseParts { even: dhi * (1.0 - from_sun), sun, horizon: dhi * from_horizon }
        }
    }
}
