//! The all-weather sky of Perez et al. 1993: how bright each patch of the sky is.

use super::diffuse::sky_state;
use crate::sky_view::SkyDirections;
use belvedere_data::vector::dot;
use belvedere_data::weather::Irradiance;

/// For each class of clearness a1 to a4, b1 to b4, c1 to c4, d1 to d4 and e1 to e4 of Perez, Seals & Michalsky 1993,
/// table 1.
const SHAPES: [[[f64; 4]; 5]; 8] = [
    [
        [1.3525, -0.2576, -0.2690, -1.4366],
        [-0.7670, 0.0007, 1.2734, -0.1233],
        [2.8000, 0.6004, 1.2375, 1.0000],
        [1.8734, 0.6297, 0.9738, 0.2809],
        [0.0356, -0.1246, -0.5718, 0.9938],
    ],
    [
        [-1.2219, -0.7730, 1.4148, 1.1016],
        [-0.2054, 0.0367, -3.9128, 0.9156],
        [6.9750, 0.1774, 6.4477, -0.1239],
        [-1.5798, -0.5081, -1.7812, 0.1080],
        [0.2624, 0.0672, -0.2190, -0.4285],
    ],
    [
        [-1.1000, -0.2515, 0.8952, 0.0156],
        [0.2782, -0.1812, -4.5000, 1.1766],
        [24.7219, -13.0812, -37.7000, 34.8438],
        [-5.0000, 1.5218, 3.9229, -2.6204],
        [-0.0156, 0.1597, 0.4199, -0.5562],
    ],
    [
        [-0.5484, -0.6654, -0.2672, 0.7117],
        [0.7234, -0.6219, -5.6812, 2.6297],
        [33.3389, -18.3000, -62.2500, 52.0781],
        [-3.5000, 0.0016, 1.1477, 0.1062],
        [0.4659, -0.3296, -0.0876, -0.0329],
    ],
    [
        [-0.6000, -0.3566, -2.5000, 2.3250],
        [0.2937, 0.0496, -5.6812, 1.8415],
        [21.0000, -4.7656, -21.5906, 7.2492],
        [-3.5000, -0.1554, 1.4062, 0.3988],
        [0.0032, 0.0766, -0.0656, -0.1294],
    ],
    [
        [-1.0156, -0.3670, 1.0078, 1.4051],
        [0.2875, -0.5328, -3.8500, 3.3750],
        [14.0000, -0.9999, -7.1406, 7.5469],
        [-3.4000, -0.1078, -1.0750, 1.5702],
        [-0.0672, 0.4016, 0.3017, -0.4844],
    ],
    [
        [-1.0000, 0.0211, 0.5025, -0.5119],
        [-0.3000, 0.1922, 0.7023, -1.6317],
        [19.0000, -5.0000, 1.2438, -1.9094],
        [-4.0000, 0.0250, 0.3844, 0.2656],
        [1.0468, -0.3788, -2.4517, 1.4656],
    ],
    [
        [-1.0500, 0.0289, 0.4260, 0.3590],
        [-0.3250, 0.1156, 0.7781, 0.0025],
        [31.0625, -14.5000, -46.1148, 55.3750],
        [-7.2312, 0.4050, 13.3500, 0.6234],
        [1.5000, -0.6426, 1.8564, 0.5636],
    ],
];
/// Range of brightness that the coefficients were fitted in.
const BRIGHTNESS: [f64; 2] = [0.01, 0.6];
/// Minimum brightness of the classes between overcast and clear, below which the fit gives darkness around the sun.
const MIN_BETWEEN: f64 = 0.2;
/// Minimum height of a place of the sky, since the gradation divides by it.
const MIN_UP: f64 = 0.01;

/// Computes the radiation of each patch of `sky` on a plane that faces it, W/m², (D): its radiance times its solid
/// angle, scaled so that a level plane gets the diffuse radiation of `irradiance` exactly. `sun` is the unit vector to
/// the sun in the axes of the sky, `zenith` its apparent angle from straight up, radians. A sky without a sun above the
/// horizon is even. Overwrites `patches`.
///
/// # Source
/// Perez, Seals & Michalsky 1993, All-weather model for sky luminance distribution — preliminary configuration and
/// validation, equations 1 to 8; the bounds of brightness are those of Delaunay 1994 in Radiance's gendaylit.
pub fn patch_radiation(
    sky: &SkyDirections,
    irradiance: &Irradiance,
    sun: [f64; 3],
    zenith: f64,
    extraterrestrial: f64,
    patches: &mut Vec<f64>,
) {
    patches.clear();
    let shape = sky_state(irradiance, zenith, extraterrestrial)
        .map(|state| RadianceShape::new(state.class, state.brightness, zenith));
    let mut level = 0.0;
    for (&direction, &solid_angle) in sky.directions.iter().zip(&sky.solid_angles) {
        let radiance = shape.as_ref().map_or(1.0, |shape| shape.radiance(direction[2], dot(direction, sun)));
        level += radiance * solid_angle * direction[2].max(0.0);
        patches.push(radiance * solid_angle);
    }
    let scale = if level > 0.0 { irradiance.dhi.max(0.0) / level } else { 0.0 };
    patches.iter_mut().for_each(|patch| *patch *= scale);
}

/// Distribution of radiance over the sky.
struct RadianceShape {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
}

impl RadianceShape {
    fn new(class: usize, brightness: f64, zenith: f64) -> Self {
        let mut brightness = brightness.clamp(BRIGHTNESS[0], BRIGHTNESS[1]);
        if (1..=4).contains(&class) {
            brightness = brightness.max(MIN_BETWEEN);
        }
        let [a, b, c, d, e] = SHAPES[class];
        let linear = |k: [f64; 4]| k[0] + k[1] * zenith + brightness * (k[2] + k[3] * zenith);
        let (c, d) = if class == 0 {
            let c = (brightness * (c[0] + c[1] * zenith)).powf(c[2]).exp() - c[3];
            (c, -(brightness * (d[0] + d[1] * zenith)).exp() + d[2] + brightness * d[3])
        } else {
            (linear(c), linear(d))
        };
        Self { a: linear(a), b: linear(b), c, d, e: linear(e) }
    }

    /// Radiance relative to the others at a height `up`, the sine of its elevation, and a cosine of the angle to the
    /// sun.
    fn radiance(&self, up: f64, cosine_to_sun: f64) -> f64 {
        let cosine = cosine_to_sun.clamp(-1.0, 1.0);
        let gradation = 1.0 + self.a * (self.b / up.max(MIN_UP)).exp();
        let around_sun = 1.0 + self.c * (self.d * cosine.acos()).exp() + self.e * cosine * cosine;
        (gradation * around_sun).max(0.0)
    }
}
