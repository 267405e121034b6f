//! Radiation under a sky without clouds.

use super::atmosphere::{absolute_air_mass, air_mass, pressure};
use super::erbs::split_global;
use belvedere_data::weather::Irradiance;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Model of the radiation of a clear sky.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ClearSky {
    /// Ineichen & Perez, from the height of the place and the turbidity of the air.
    Ineichen {
        /// Linke turbidity: 2 for clean cold air, 3 for the usual, 5 and more for haze.
        linke: f64,
    },
    /// Haurwitz, from the sun's height alone; it knows global radiation only, which is split by [`split_global`].
    Haurwitz,
    /// Bird & Hulstrom, from the contents of the air.
    Bird(BirdParams),
}

impl std::fmt::Display for ClearSky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Ineichen { linke } => write!(f, "clear sky of Ineichen & Perez, Linke turbidity {linke}"),
            Self::Haurwitz => f.write_str("clear sky of Haurwitz"),
            Self::Bird(_) => f.write_str("clear sky of Bird & Hulstrom"),
        }
    }
}

impl Default for ClearSky {
    /// Ineichen & Perez with a turbidity of 3, the usual one of temperate lands (Remund et al. 2003).
    fn default() -> Self {
        Self::Ineichen { linke: 3.0 }
    }
}

/// State of the air for [`ClearSky::Bird`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BirdParams {
    /// Optical depth of aerosols at 380 nm, 0 or more. Default 0.15, of Bird & Hulstrom's standard atmosphere.
    pub aerosol_380: f64,
    /// Optical depth of aerosols at 500 nm, 0 or more. Default 0.1.
    pub aerosol_500: f64,
    /// Water above the place, cm, 0 or more. Default 1.5.
    pub water: f64,
    /// Ozone above the place, cm, 0 or more. Default 0.3.
    pub ozone: f64,
    /// Share of radiation scattered forward by aerosols, 0 to 1. Default 0.85.
    pub forward_scattering: f64,
    /// Reflectance of the ground, 0 to 1. Default 0.2.
    pub albedo: f64,
}

impl Default for BirdParams {
    fn default() -> Self {
        Self { aerosol_380: 0.15, aerosol_500: 0.1, water: 1.5, ozone: 0.3, forward_scattering: 0.85, albedo: 0.2 }
    }
}

impl ClearSky {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a turbidity that is not 1 to 20, and for parameters of Bird's model outside
    /// their range.
    pub fn validate(&self) -> Result<()> {
        let invalid =
            |parameter: Parameter, value: f64, expected: &'static str| Err(Error::invalid(parameter, value, expected));
        match self {
            Self::Ineichen { linke } if !(1.0..=20.0).contains(linke) => {
                invalid(Parameter::Turbidity, *linke, "1 to 20; 3 is usual")
            }
            Self::Bird(bird) => {
                let amounts = [bird.aerosol_380, bird.aerosol_500, bird.water, bird.ozone];
                if let Some(&amount) = amounts.iter().find(|v| !(0.0..=100.0).contains(*v)) {
                    return invalid(Parameter::AirContent, amount, "0 to 100");
                }
                let shares = [bird.forward_scattering, bird.albedo];
                match shares.iter().find(|v| !(0.0..=1.0).contains(*v)) {
                    Some(&share) => invalid(Parameter::AirContent, share, "0 to 1"),
                    None => Ok(()),
                }
            }
            _ => Ok(()),
        }
    }

    /// Radiation of a clear sky for a sun at `zenith`, radians (apparent), above a place at `height` metres above the
    /// sea, where `extraterrestrial` W/m² arrive above the atmosphere. Nothing for a sun at or below the horizon.
    #[must_use]
    pub fn irradiance(&self, zenith: f64, height: f64, extraterrestrial: f64) -> Irradiance {
        let cosine = zenith.cos();
        let (true, Some(relative), Some(absolute)) =
            (cosine > 0.0, air_mass(zenith), absolute_air_mass(zenith, height))
        else {
            return Irradiance::default();
        };
        match self {
            Self::Ineichen { linke } => ineichen(cosine, absolute, *linke, height, extraterrestrial),
            Self::Haurwitz => split_global(1098.0 * cosine * (-0.059 / cosine).exp(), zenith, extraterrestrial),
            Self::Bird(params) => bird(params, cosine, relative, pressure(height), extraterrestrial),
        }
    }
}

/// # Source
/// Ineichen & Perez 2002, A new airmass independent formulation for the Linke turbidity coefficient. The coefficient b
/// is as printed there (0.664 + 0.163 / fh1), without the exponent that Perez et al. 2002 add for global radiation.
fn ineichen(cosine: f64, absolute: f64, linke: f64, height: f64, extraterrestrial: f64) -> Irradiance {
    let (low, high) = ((-height / 8000.0).exp(), (-height / 1250.0).exp());
    let (gain, loss) = (5.09e-5 * height + 0.868, 3.92e-5 * height + 0.0387);
    let ghi = gain * extraterrestrial * cosine * (-loss * absolute * (low + high * (linke - 1.0))).exp();
    let beam = extraterrestrial * (0.664 + 0.163 / low) * (-0.09 * absolute * (linke - 1.0)).exp();
    // of a low sun the first form gives more than all that arrives
    let max = ghi * ((1.0 - (0.1 - 0.2 * (-linke).exp()) / (0.1 + 0.882 / low)) / cosine).max(0.0);
    let dni = beam.max(0.0).min(max);
    Irradiance { ghi, dni, dhi: (ghi - dni * cosine).max(0.0) }
}

/// # Source
/// Bird & Hulstrom 1981, A simplified clear sky model for direct and diffuse insolation on horizontal surfaces,
/// SERI/TR-642-761.
fn bird(params: &BirdParams, cosine: f64, relative: f64, pressure: f64, extraterrestrial: f64) -> Irradiance {
    let absolute = relative * pressure / 101_325.0;
    let rayleigh = (-0.0903 * absolute.powf(0.84) * (1.0 + absolute - absolute.powf(1.01))).exp();
    let ozone = params.ozone * relative;
    let ozone = 1.0
        - 0.1611 * ozone * (1.0 + 139.48 * ozone).powf(-0.3034)
        - 0.002_715 * ozone / (1.0 + 0.044 * ozone + 0.0003 * ozone * ozone);
    let gases = (-0.0127 * absolute.powf(0.26)).exp();
    let water = params.water * relative;
    let water = 1.0 - 2.4959 * water / ((1.0 + 79.034 * water).powf(0.6828) + 6.385 * water);
    let depth = 0.27583 * params.aerosol_380 + 0.35 * params.aerosol_500;
    let aerosol = (-depth.powf(0.873) * (1.0 + depth - depth.powf(0.7088)) * relative.powf(0.9108)).exp();
    let absorbed = 1.0 - 0.1 * (1.0 - relative + relative.powf(1.06)) * (1.0 - aerosol);
    let sky_albedo = 0.0685 + (1.0 - params.forward_scattering) * (1.0 - aerosol / absorbed);
    let dni = 0.9662 * extraterrestrial * aerosol * water * gases * ozone * rayleigh;
    let scattered = extraterrestrial
        * cosine
        * 0.79
        * ozone
        * gases
        * water
        * absorbed
        * (0.5 * (1.0 - rayleigh) + params.forward_scattering * (1.0 - aerosol / absorbed))
        / (1.0 - relative + relative.powf(1.02));
    let ghi = (dni * cosine + scattered) / (1.0 - params.albedo * sky_albedo);
    // of a sun at the horizon the model scatters less than nothing, by milliwatts
    Irradiance { ghi, dni, dhi: (ghi - dni * cosine).max(0.0) }
}
