//! A laser pulse: a narrow cone that may meet several surfaces.

use crate::random::Random;
use crate::scene::{Material, Scene};
use crate::truth::{CONTACT, Truth};
use crate::vector::{add_scaled, cross, dot, sub, unit};

/// Shape of a pulse and how its echoes are told apart.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamParams {
    /// Full angle of the cone that holds all but 1/e² of the energy, radians, 0 to 0.01. Default 0.0004: usual for airborne
    /// scanners, 18 cm on the ground from 450 m.
    pub divergence: f64,
    /// Echoes closer together than this merge into one, metres, 0.1 to 10. Default 0.8: a pulse of 5 ns.
    pub range_resolution: f64,
    /// Share of the energy of the pulse below which an echo goes unnoticed, 0 to 1. Default 0.15: more than one of the six
    /// outer rays, less than the centre ray.
    pub weakest_echo: f64,
    /// Most echoes recorded per pulse, the first ones, 1 to 15. Default 5.
    pub max_returns: u8,
    /// Probability that a ray passes through the hull of a crown, at entry and again at exit, 0 to 1. Default 0.35: a
    /// seventh of the energy reaches the ground below, as in trees in leaf.
    pub crown_porosity: f64,
}

impl Default for BeamParams {
    fn default() -> Self {
        Self { divergence: 4e-4, range_resolution: 0.8, weakest_echo: 0.15, max_returns: 5, crown_porosity: 0.35 }
    }
}

/// Rays that stand for a pulse: one in the centre, six on a ring.
const RING: u8 = 6;
/// Energy of the centre ray: what a Gaussian beam holds within 0.4 of its 1/e² radius, 1 − exp(−2 · 0.4²).
const CENTRE_ENERGY: f64 = 0.274;
/// Radius of the ring in 1/e² radii: half of the energy outside the centre lies within, 1 − exp(−2 · 0.71²) ≈ 0.637.
const RING_RADIUS: f64 = 0.71;

/// Where a pulse starts and points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) origin: [f64; 3],
    /// Unit vector along the pulse.
    pub(crate) direction: [f64; 3],
    /// Unit vectors across the pulse and each other.
    pub(crate) across: [[f64; 3]; 2],
}

impl Axis {
    /// Unit vector at small angles from the axis, radians along each of `across`.
    pub(crate) fn tilted(&self, direction: [f64; 3], angles: [f64; 2]) -> [f64; 3] {
        let tilted = add_scaled(add_scaled(direction, self.across[0], angles[0]), self.across[1], angles[1]);
        unit(tilted).unwrap_or(direction)
    }
}

/// An echo of a pulse.
///
/// It is placed at the strongest of the rays that make it up, not at their mean, so that it lies exactly on a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Echo {
    pub(crate) range: f64,
    /// Unit vector of the ray that stands for the echo.
    pub(crate) direction: [f64; 3],
    pub(crate) triangle: u32,
    pub(crate) material: Material,
    /// Share of the energy of the pulse that met the surfaces of this echo.
    pub(crate) energy: f64,
    /// Share that comes back: energy times reflectance times cosine of incidence.
    pub(crate) brightness: f64,
}

/// Echoes of one pulse.
pub(crate) struct PulseEchoes {
    /// By increasing range, farther apart than the range resolution.
    pub(crate) echoes: Vec<Echo>,
    /// Echoes left out as too weak or too many.
    pub(crate) dropped: usize,
}

/// Sends a pulse into a scene.
pub(crate) fn pulse_echoes(
    scene: &Scene,
    truth: &Truth,
    axis: &Axis,
    beam: &BeamParams,
    random: &mut Random,
) -> PulseEchoes {
    let mut rays: Vec<Echo> = Vec::new();
    for (angles, energy) in sub_rays(beam.divergence) {
        let direction = axis.tilted(axis.direction, angles);
        rays.extend(ray_echo(scene, truth, axis.origin, direction, energy, beam.crown_porosity, random));
    }
    rays.sort_by(|a, b| a.range.total_cmp(&b.range));

    let mut echoes: Vec<Echo> = Vec::new();
    let clusters = rays.chunk_by(|near, far| far.range - near.range <= beam.range_resolution);
    let cluster_count = clusters.clone().count();
    for cluster in clusters {
        let Some(&first) = cluster.first() else { continue };
        let strongest = cluster.iter().fold(first, |best, ray| if ray.energy > best.energy { *ray } else { best });
        let energy: f64 = cluster.iter().map(|ray| ray.energy).sum();
        if energy >= beam.weakest_echo && echoes.len() < usize::from(beam.max_returns) {
            let brightness = cluster.iter().map(|ray| ray.brightness).sum();
            echoes.push(Echo { energy, brightness, ..strongest });
        }
    }
    PulseEchoes { dropped: cluster_count - echoes.len(), echoes }
}

/// Angles from the axis and energy of each ray of a pulse.
fn sub_rays(divergence: f64) -> impl Iterator<Item = ([f64; 2], f64)> {
    let ring_energy = (1.0 - CENTRE_ENERGY) / f64::from(RING);
    let ring = (0..RING).map(move |i| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / f64::from(RING)).sin_cos();
        let angle = RING_RADIUS * divergence / 2.0;
        ([angle * cos, angle * sin], ring_energy)
    });
    std::iter::once(([0.0; 2], CENTRE_ENERGY)).chain(ring)
}

/// The surface that stops a ray, or `None` where it leaves the scene.
fn ray_echo(
    scene: &Scene,
    truth: &Truth,
    origin: [f64; 3],
    direction: [f64; 3],
    energy: f64,
    crown_porosity: f64,
    random: &mut Random,
) -> Option<Echo> {
    let mut passed = 0.0;
    loop {
        let hit = truth.first_hit_between(origin, direction, passed + CONTACT, f64::INFINITY)?;
        let material = *scene.materials.get(hit.triangle as usize)?;
        if material == Material::TreeCrown && random.chance(crown_porosity) {
            passed = hit.range;
            continue;
        }
        let [a, b, c] = scene.corners(hit.triangle as usize)?;
        let cosine = unit(cross(sub(b, a), sub(c, a))).map_or(0.0, |normal| dot(normal, direction).abs());
        return Some(Echo {
            range: hit.range,
            direction,
            triangle: hit.triangle,
            material,
            energy,
            brightness: energy * material.reflectance() * cosine,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::{Placement, extruded};

    fn downward(x: f64) -> Axis {
        Axis { origin: [x, 0.0, 500.0], direction: [0.0, 0.0, -1.0], across: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }

    /// A plate 1 m high that ends at x = 0, over a plate that reaches on to x = 20.
    fn step(height: f64) -> Scene {
        let mut scene = Scene::default();
        let at = |x| Placement { origin: [x, 0.0], angle: 0.0 };
        scene.add_object("low", &[extruded(&at(0.0).rectangle(40.0, 40.0), -1.0, 0.0)]);
        scene.add_object("high", &[extruded(&at(-10.0).rectangle(20.0, 20.0), -0.5, height)]);
        scene
    }

    fn echoes_at(x: f64, height: f64, beam: &BeamParams) -> PulseEchoes {
        let scene = step(height);
        pulse_echoes(&scene, &Truth::new(&scene), &downward(x), beam, &mut Random::new(0, 0))
    }

    #[test]
    fn energies_add_up_to_one_pulse() {
        assert!((sub_rays(4e-4).map(|(_, energy)| energy).sum::<f64>() - 1.0).abs() < 1e-12);
        let gaussian = |radius: f64| 1.0 - (-2.0 * radius * radius).exp();
        assert!((gaussian(0.4) - CENTRE_ENERGY).abs() < 1e-3);
        assert!((gaussian(RING_RADIUS) - (1.0 + CENTRE_ENERGY) / 2.0).abs() < 2e-3);
    }

    #[test]
    fn pulse_on_an_edge_gives_two_echoes_only_beyond_the_range_resolution() {
        let beam = BeamParams::default();
        let split = echoes_at(0.01, 5.0, &beam).echoes;
        assert_eq!(split.len(), 2);
        assert!((split[0].range - 495.0).abs() < 1e-3 && (split[1].range - 500.0).abs() < 1e-3);
        // Two rays of the ring lie beyond 1 cm − 7.1 cm · cos(60°) to the left, and one at 7.1 cm: three in all.
        assert!((split[0].energy - 3.0 * (1.0 - CENTRE_ENERGY) / 6.0).abs() < 1e-12);
        assert_eq!(echoes_at(0.01, 0.5, &beam).echoes.len(), 1);
        assert_eq!(echoes_at(0.3, 5.0, &beam).echoes.len(), 1);
        assert_eq!(echoes_at(-0.3, 5.0, &beam).echoes.len(), 1);
    }

    #[test]
    fn weak_and_surplus_echoes_are_counted() {
        // A single ray of the ring, an eighth of the energy, reaches the plate at x < 0.
        let weak = echoes_at(0.05, 5.0, &BeamParams::default());
        assert_eq!((weak.echoes.len(), weak.dropped), (1, 1));
        let surplus = echoes_at(0.01, 5.0, &BeamParams { max_returns: 1, ..BeamParams::default() });
        assert_eq!((surplus.echoes.len(), surplus.dropped), (1, 1));
        assert!((surplus.echoes[0].range - 495.0).abs() < 1e-3, "the first echo is the one kept");
    }
}
