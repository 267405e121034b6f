//! The Universal Thermal Climate Index: the temperature of calm, shaded air with the same stress for a walker.

use serde::Serialize;
use std::ops::RangeInclusive;

/// Number of terms of a polynomial of degree 6 in four variables.
const TERMS: usize = 210;
/// Degree of the polynomial.
const DEGREE: usize = 6;
/// Range of air temperatures of the polynomial, °C.
const AIR: RangeInclusive<f64> = -50.0..=50.0;
/// Range of the mean radiant temperature above that of the air, K.
const RADIANT_EXCESS: RangeInclusive<f64> = -30.0..=70.0;
/// Range of wind speeds 10 m above the ground, m/s. Lower ones count as the least.
const WIND: RangeInclusive<f64> = 0.5..=17.0;

/// Air around a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Temperature, °C.
    pub temperature: f64,
    /// Vapour pressure, hPa.
    pub vapour_pressure: f64,
    /// Wind speed 10 m above the ground, m/s.
    pub wind: f64,
}

/// Returns the index, °C, for a mean radiant temperature, °C. `None` outside the range of the polynomial: air of -50 to
/// 50 °C, a mean radiant temperature 30 K below to 70 K above it, and wind up to 17 m/s.
///
/// The polynomial is 1.2 K (RMS) from the body model that it represents, 0.6 K in air above 10 °C.
///
/// # Source
/// Bröde, Fiala, Błażejczyk, Holmér, Jendritzky, Kampmann, Tinz & Havenith 2012, Deriving the operational procedure for
/// the Universal Thermal Climate Index (UTCI), Int. J. Biometeorol. 56.
#[must_use]
pub fn utci(air: &Air, mean_radiant: f64) -> Option<f64> {
    let excess = mean_radiant - air.temperature;
    let wind = air.wind.max(*WIND.start());
    let is_known = AIR.contains(&air.temperature) && RADIANT_EXCESS.contains(&excess) && WIND.contains(&wind);
    is_known.then(|| utci_polynomial(&Air { wind, ..*air }, mean_radiant))
}

/// The polynomial of [`utci`], °C, at any values: it is meaningless far outside its range.
#[must_use]
pub fn utci_polynomial(air: &Air, mean_radiant: f64) -> f64 {
    /// Sum of the terms in `variables` of up to `degree` by Horner's rule; the last of them is before `end`.
    fn sum(variables: &[f64], degree: usize, end: &mut usize) -> f64 {
        let Some((last, others)) = variables.split_last() else {
            *end -= 1;
            return COEFFICIENTS[*end];
        };
        (0..=degree).rev().fold(0.0, |value, power| value * last + sum(others, degree - power, end))
    }
    let excess = mean_radiant - air.temperature;
    let variables = [air.temperature, air.wind, excess, air.vapour_pressure / 10.0];
    air.temperature + sum(&variables, DEGREE, &mut { TERMS })
}

/// Strain of a body in the classes of the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stress {
    /// Below -40 °C.
    ExtremeCold,
    /// -40 to -27 °C.
    VeryStrongCold,
    /// -27 to -13 °C.
    StrongCold,
    /// -13 to 0 °C.
    ModerateCold,
    /// 0 to 9 °C.
    SlightCold,
    /// 9 to 26 °C.
    None,
    /// 26 to 32 °C.
    ModerateHeat,
    /// 32 to 38 °C.
    StrongHeat,
    /// 38 to 46 °C.
    VeryStrongHeat,
    /// Above 46 °C.
    ExtremeHeat,
}

impl Stress {
    /// Each class with the index up to which it goes, °C.
    const UP_TO: [(Self, f64); 10] = [
        (Self::ExtremeCold, -40.0),
        (Self::VeryStrongCold, -27.0),
        (Self::StrongCold, -13.0),
        (Self::ModerateCold, 0.0),
        (Self::SlightCold, 9.0),
        (Self::None, 26.0),
        (Self::ModerateHeat, 32.0),
        (Self::StrongHeat, 38.0),
        (Self::VeryStrongHeat, 46.0),
        (Self::ExtremeHeat, f64::INFINITY),
    ];

    /// The class of an index, °C; `None` for NaN.
    #[must_use]
    pub fn of(utci: f64) -> Option<Self> {
        Self::UP_TO.into_iter().find(|(_, end)| utci <= *end).map(|(class, _)| class)
    }

    /// Its name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ExtremeCold => "extreme cold stress",
            Self::VeryStrongCold => "very strong cold stress",
            Self::StrongCold => "strong cold stress",
            Self::ModerateCold => "moderate cold stress",
            Self::SlightCold => "slight cold stress",
            Self::None => "no thermal stress",
            Self::ModerateHeat => "moderate heat stress",
            Self::StrongHeat => "strong heat stress",
            Self::VeryStrongHeat => "very strong heat stress",
            Self::ExtremeHeat => "extreme heat stress",
        }
    }
}

/// Coefficients of the powers of vapour pressure, radiant excess, wind and air temperature, the last rising fastest.
#[rustfmt::skip]
const COEFFICIENTS: [f64; TERMS] = [
    6.07562052e-1, -2.27712343e-2, 8.06470249e-4, -1.54271372e-4, -3.24651735e-6, 7.32602852e-8, 1.35959073e-9,
    -2.25836520e0, 8.80326035e-2, 2.16844454e-3, -1.53347087e-5, -5.72983704e-7, -2.55090145e-9, -7.51269505e-1,
    -4.08350271e-3, -5.21670675e-5, 1.94544667e-6, 1.14099531e-8, 1.58137256e-1, -6.57263143e-5, 2.22697524e-7,
    -4.16117031e-8, -1.27762753e-2, 9.66891875e-6, 2.52785852e-9, 4.56306672e-4, -1.74202546e-7, -5.91491269e-6,
    3.98374029e-1, 1.83945314e-4, -1.73754510e-4, -7.60781159e-7, 3.77830287e-8, 5.43079673e-10, -2.00518269e-2,
    8.92859837e-4, 3.45433048e-6, -3.77925774e-7, -1.69699377e-9, 1.69992415e-4, -4.99204314e-5, 2.47417178e-7,
    1.07596466e-8, 8.49242932e-5, 1.35191328e-6, -6.21531254e-9, -4.99410301e-6, -1.89489258e-8, 8.15300114e-8,
    7.55043090e-4, -5.65095215e-5, -4.52166564e-7, 2.46688878e-8, 2.42674348e-10, 1.54547250e-4, 5.24110970e-6,
    -8.75874982e-8, -1.50743064e-9, -1.56236307e-5, -1.33895614e-7, 2.49709824e-9, 6.51711721e-7, 1.94960053e-9,
    -1.00361113e-8, -1.21206673e-5, -2.18203660e-7, 7.51269482e-9, 9.79063848e-11, 1.25006734e-6, -1.81584736e-9,
    -3.52197671e-10, -3.36514630e-8, 1.35908359e-10, 4.17032620e-10, -1.30369025e-9, 4.13908461e-10, 9.22652254e-12,
    -5.08220384e-9, -2.24730961e-11, 1.17139133e-10, 6.62154879e-10, 4.03863260e-13, 1.95087203e-12, -4.73602469e-12,
    5.12733497e0, -3.12788561e-1, -1.96701861e-2, 9.99690870e-4, 9.51738512e-6, -4.66426341e-7, 5.48050612e-1,
    -3.30552823e-3, -1.64119440e-3, -5.16670694e-6, 9.52692432e-7, -4.29223622e-2, 5.00845667e-3, 1.00601257e-6,
    -1.81748644e-6, -1.25813502e-3, -1.79330391e-4, 2.34994441e-6, 1.29735808e-4, 1.29064870e-6, -2.28558686e-6,
    -3.69476348e-2, 1.62325322e-3, -3.14279680e-5, 2.59835559e-6, -4.77136523e-8, 8.64203390e-3, -6.87405181e-4,
    -9.13863872e-6, 5.15916806e-7, -3.59217476e-5, 3.28696511e-5, -7.10542454e-7, -1.24382300e-5, -7.38584400e-9,
    2.20609296e-7, -7.32469180e-4, -1.87381964e-5, 4.80925239e-6, -8.75492040e-8, 2.77862930e-5, -5.06004592e-6,
    1.14325367e-7, 2.53016723e-6, -1.72857035e-8, -3.95079398e-8, -3.59413173e-7, 7.04388046e-7, -1.89309167e-8,
    -4.79768731e-7, 7.96079978e-9, 1.62897058e-9, 3.94367674e-8, -1.18566247e-9, 3.34678041e-10, -1.15606447e-10,
    -2.80626406e0, 5.48712484e-1, -3.99428410e-3, -9.54009191e-4, 1.93090978e-5, -3.08806365e-1, 1.16952364e-2,
    4.95271903e-4, -1.90710882e-5, 2.10787756e-3, -6.98445738e-4, 2.30109073e-5, 4.17856590e-4, -1.27043871e-5,
    -3.04620472e-6, 5.14507424e-2, -4.32510997e-3, 8.99281156e-5, -7.14663943e-7, -2.66016305e-4, 2.63789586e-4,
    -7.01199003e-6, -1.06823306e-4, 3.61341136e-6, 2.29748967e-7, 3.04788893e-4, -6.42070836e-5, 1.16257971e-6,
    7.68023384e-6, -5.47446896e-7, -3.59937910e-8, -4.36497725e-6, 1.68737969e-7, 2.67489271e-8, 3.23926897e-9,
    -3.53874123e-2, -2.21201190e-1, 1.55126038e-2, -2.63917279e-4, 4.53433455e-2, -4.32943862e-3, 1.45389826e-4,
    2.17508610e-4, -6.66724702e-5, 3.33217140e-5, -2.26921615e-3, 3.80261982e-4, -5.45314314e-9, -7.96355448e-4,
    2.53458034e-5, -6.31223658e-6, 3.02122035e-4, -4.77403547e-6, 1.73825715e-6, -4.09087898e-7, 6.14155345e-1,
    -6.16755931e-2, 1.33374846e-3, 3.55375387e-3, -5.13027851e-4, 1.02449757e-4, -1.48526421e-3, -4.11469183e-5,
    -6.80434415e-6, -9.77675906e-6, 8.82773108e-2, -3.01859306e-3, 1.04452989e-3, 2.47090539e-4, 1.48348065e-3,
];
