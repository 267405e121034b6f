//! Diffuse and direct radiation where only global radiation is known.

use belvedere_data::weather::Irradiance;

/// Sun below which the split is all diffuse, radians of zenith: the division by the cosine would make beams of noise.
const LOWEST_SUN: f64 = 87.0 * std::f64::consts::PI / 180.0;
/// Minimum cosine of the zenith that clearness is judged with: a sun of 3.7 degrees.
const MIN_COSINE: f64 = 0.065;

/// Splits global radiation on a level plane, W/m², for a sun at `zenith`, radians, where `extraterrestrial` W/m² arrive
/// above the atmosphere. All of it is diffuse for a sun within 3 degrees of the horizon and below.
///
/// # Source
/// Erbs, Klein & Duffie 1982, Estimation of the diffuse radiation fraction for hourly, daily and monthly-average global
/// radiation.
#[must_use]
pub fn split_global(ghi: f64, zenith: f64, extraterrestrial: f64) -> Irradiance {
    let clearness = (ghi / (extraterrestrial * zenith.cos().max(MIN_COSINE))).clamp(0.0, 1.0);
    let share = if clearness <= 0.22 {
        1.0 - 0.09 * clearness
    } else if clearness <= 0.8 {
        // Horner's form of the published quartic
        0.9511 + clearness * (-0.1604 + clearness * (4.388 + clearness * (-16.638 + clearness * 12.336)))
    } else {
        0.165
    };
    let dhi = share * ghi;
    let dni = (ghi - dhi) / zenith.cos();
    if zenith > LOWEST_SUN || !(dni >= 0.0) {
        return Irradiance { ghi, dni: 0.0, dhi: ghi };
    }
    Irradiance { ghi, dni, dhi }
}

/// Radiation of a row of which `dni` or `dhi` may be missing: the one follows from the other and `ghi`, and both from
/// [`split_global`] where neither is known. Given values stay unchanged.
#[must_use]
pub fn complete(ghi: f64, dni: Option<f64>, dhi: Option<f64>, zenith: f64, extraterrestrial: f64) -> Irradiance {
    let cosine = zenith.cos();
    match (dni, dhi) {
        (Some(dni), Some(dhi)) => Irradiance { ghi, dni, dhi },
        (Some(dni), None) => Irradiance { ghi, dni, dhi: (ghi - dni * cosine.max(0.0)).max(0.0) },
        (None, Some(dhi)) if zenith <= LOWEST_SUN => {
            // no beam is stronger than before the atmosphere
            Irradiance { ghi, dni: ((ghi - dhi).max(0.0) / cosine).min(extraterrestrial), dhi }
        }
        (None, Some(dhi)) => Irradiance { ghi, dni: 0.0, dhi },
        (None, None) => split_global(ghi, zenith, extraterrestrial),
    }
}
