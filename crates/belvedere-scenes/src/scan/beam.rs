//! Laser pulse: a narrow cone that may meet several surfaces.

use crate::random::Random;
use crate::scene::{Material, TriangleScene};
use crate::truth::{CONTACT, Truth};
use crate::vector::{add_scaled, cross, dot, sub, unit};

/// Shape of a pulse and separation of its echoes.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamParams {
    /// Full angle of the cone that contains all but 1/e² of the energy, radians, 0 to 0.01. Default 0.0004: usual for
    /// airborne scanners, 18 cm on the ground from 450 m.
    pub divergence: f64,
    /// Minimum distance between two echoes, metres, 0.1 to 10; closer ones merge. Default 0.8: a pulse of 5 ns.
    pub range_resolution: f64,
    /// Share of the energy of the pulse below which an echo is not detected, 0 to 1. Default 0.15: more than one of the
    /// six outer rays, less than the centre ray.
    pub weakest_echo: f64,
    /// Maximum number of echoes recorded per pulse, the first ones, 1 to 15. Default 5.
    pub max_returns: u8,
    /// Probability that a ray passes through the hull of a crown at entry, 0 to 1. Without
    /// [`BeamParams::foliage_depth`] it applies again at exit. Default 0.35: a seventh of the energy reaches the ground
    /// below, as in trees in leaf.
    pub crown_porosity: f64,
    /// Mean free path of a ray among the leaves inside a crown, metres, 0 to 100. Default 0: only the hull stops rays,
    /// so that every return lies on a triangle. Otherwise a ray that passed the hull is stopped after an exponentially
    /// distributed path inside the crown, or leaves the crown freely.
    pub foliage_depth: f64,
}

impl Default for BeamParams {
    fn default() -> Self {
        Self {
            divergence: 4e-4,
            range_resolution: 0.8,
            weakest_echo: 0.15,
            max_returns: 5,
            crown_porosity: 0.35,
            foliage_depth: 0.0,
        }
    }
}

impl BeamParams {
    /// Returns a pulse that enters crowns, for a receiver that detects weak echoes; other values are the defaults. Half
    /// of the rays pass the hull and then reach a mean depth of 1.5 m.
    ///
    /// Four fifths of the pulses that meet a crown then give several returns, and a quarter reach the ground. Half of
    /// the returns inside crowns lie within a metre of the hull. Over a town with a twelfth of its ground under crowns,
    /// 7 % of all pulses give several returns. In AHN3 over Delft, with more trees, it is 21 %.
    #[must_use]
    pub fn in_leaf() -> Self {
        Self { weakest_echo: 0.1, crown_porosity: 0.5, foliage_depth: 1.5, ..Self::default() }
    }
}

/// Number of rays on a ring that represent a pulse, besides one in the centre.
const RING: u8 = 6;
/// Energy of the centre ray: the share of a Gaussian beam within 0.4 of its 1/e² radius, 1 − exp(−2 · 0.4²).
const CENTRE_ENERGY: f64 = 0.274;
/// Radius of the ring in 1/e² radii. Half of the energy outside the centre lies within it, 1 − exp(−2 · 0.71²) ≈ 0.637.
const RING_RADIUS: f64 = 0.71;

/// Origin and direction of a pulse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) origin: [f64; 3],
    /// Unit vector along the pulse.
    pub(crate) direction: [f64; 3],
    /// Unit vectors perpendicular to the pulse and to each other.
    pub(crate) across: [[f64; 3]; 2],
}

impl Axis {
    /// Returns the unit vector at small angles from the axis, radians along each of `across`.
    pub(crate) fn tilted(&self, direction: [f64; 3], angles: [f64; 2]) -> [f64; 3] {
        let tilted = add_scaled(add_scaled(direction, self.across[0], angles[0]), self.across[1], angles[1]);
        unit(tilted).unwrap_or(direction)
    }
}

/// Echo of a pulse.
///
/// Range and direction of the echo are those of the strongest of its rays, not a mean. That ray met one surface, or
/// leaves inside one crown. A scanner knows the range of an echo but not the part of the beam that met a surface. It
/// therefore reports the echo at this range on the axis of the pulse, up to half a beam beside the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Echo {
    pub(crate) range: f64,
    /// Unit vector of the ray that represents the echo, which ends on the surface; not the axis of the pulse.
    pub(crate) direction: [f64; 3],
    /// Triangle that the ray met; for leaves in a crown, the triangle through which the ray entered.
    pub(crate) triangle: u32,
    pub(crate) material: Material,
    /// Share of the energy of the pulse that met the surfaces of this echo.
    pub(crate) energy: f64,
    /// Share of the energy that returns: energy times reflectance times cosine of incidence.
    pub(crate) brightness: f64,
}

/// Echoes of one pulse.
pub(crate) struct PulseEchoes {
    /// Echoes by increasing range, farther apart than the range resolution.
    pub(crate) echoes: Vec<Echo>,
    /// Number of echoes left out as too weak or too many.
    pub(crate) dropped: usize,
}

/// Sends a pulse into a scene; surfaces farther than `max_range` metres give no echo.
pub(crate) fn pulse_echoes(
    scene: &TriangleScene,
    truth: &Truth,
    axis: &Axis,
    beam: &BeamParams,
    max_range: f64,
    random: &mut Random,
) -> PulseEchoes {
    let mut rays: Vec<Echo> = Vec::new();
    for (angles, energy) in sub_rays(beam.divergence) {
        let direction = axis.tilted(axis.direction, angles);
        let ray = SubRay { origin: axis.origin, direction, energy, max_range };
        rays.extend(ray_echo(scene, truth, &ray, beam, random));
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

/// Returns the angles from the axis and the energy of each ray of a pulse.
fn sub_rays(divergence: f64) -> impl Iterator<Item = ([f64; 2], f64)> {
    let ring_energy = (1.0 - CENTRE_ENERGY) / f64::from(RING);
    let ring = (0..RING).map(move |i| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / f64::from(RING)).sin_cos();
        let angle = RING_RADIUS * divergence / 2.0;
        ([angle * cos, angle * sin], ring_energy)
    });
    std::iter::once(([0.0; 2], CENTRE_ENERGY)).chain(ring)
}

/// One of the rays that represent a pulse.
struct SubRay {
    origin: [f64; 3],
    /// Unit vector.
    direction: [f64; 3],
    /// Share of the energy of the pulse.
    energy: f64,
    max_range: f64,
}

impl SubRay {
    fn echo(&self, range: f64, triangle: u32, material: Material, cosine: f64) -> Echo {
        let brightness = self.energy * material.reflectance() * cosine;
        Echo { range, direction: self.direction, triangle, material, energy: self.energy, brightness }
    }
}

/// Cosine of incidence on a leaf: the mean over leaves of all orientations.
const LEAF_COSINE: f64 = 0.5;

/// Planned end of a ray inside crowns.
struct CrownStop {
    range: f64,
    /// Triangle through which the ray entered.
    triangle: u32,
    /// Number of crowns that the ray is in; those of neighbouring trees may overlap.
    crown_count: u32,
}

/// Returns the echo of the surface that stops a ray; `None` for a ray that leaves the scene.
fn ray_echo(
    scene: &TriangleScene,
    truth: &Truth,
    ray: &SubRay,
    beam: &BeamParams,
    random: &mut Random,
) -> Option<Echo> {
    let mut passed = 0.0;
    let mut foliage: Option<CrownStop> = None;
    loop {
        let hit = truth.first_hit_between(ray.origin, ray.direction, passed + CONTACT, ray.max_range);
        if let Some(leaves) = foliage.as_ref().filter(|f| hit.is_none_or(|hit| f.range < hit.range)) {
            let within = leaves.range <= ray.max_range;
            return within.then(|| ray.echo(leaves.range, leaves.triangle, Material::TreeCrown, LEAF_COSINE));
        }
        let hit = hit?;
        let material = *scene.materials.get(hit.triangle as usize)?;
        let [a, b, c] = scene.corners(hit.triangle as usize)?;
        let towards = unit(cross(sub(b, a), sub(c, a))).map_or(0.0, |normal| dot(normal, ray.direction));
        if material == Material::TreeCrown {
            let enters = towards < 0.0;
            if beam.foliage_depth > 0.0 && (foliage.is_some() || !enters) {
                foliage = foliage.and_then(|f| {
                    let crown_count = if enters { f.crown_count + 1 } else { f.crown_count - 1 };
                    (crown_count > 0).then_some(CrownStop { crown_count, ..f })
                });
                passed = hit.range;
                continue;
            }
            if random.chance(beam.crown_porosity) {
                if beam.foliage_depth > 0.0 {
                    let path = -beam.foliage_depth * (1.0 - random.uniform()).ln();
                    foliage = Some(CrownStop { range: hit.range + path, triangle: hit.triangle, crown_count: 1 });
                }
                passed = hit.range;
                continue;
            }
        }
        return Some(ray.echo(hit.range, hit.triangle, material, towards.abs()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solids::{PlanPlacement, extruded};

    fn downward(x: f64) -> Axis {
        Axis { origin: [x, 0.0, 500.0], direction: [0.0, 0.0, -1.0], across: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] }
    }

    /// Returns a plate that ends at x = 0, `height` metres above a plate that continues to x = 20.
    fn step(height: f64) -> TriangleScene {
        let mut scene = TriangleScene::default();
        let at = |x| PlanPlacement { origin: [x, 0.0], angle: 0.0 };
        scene.add_object("low", &[extruded(&at(0.0).rectangle(40.0, 40.0), -1.0, 0.0)]);
        scene.add_object("high", &[extruded(&at(-10.0).rectangle(20.0, 20.0), -0.5, height)]);
        scene
    }

    fn echoes_at(x: f64, height: f64, beam: &BeamParams) -> PulseEchoes {
        let scene = step(height);
        pulse_echoes(&scene, &Truth::new(&scene), &downward(x), beam, f64::INFINITY, &mut Random::new(0, 0))
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

    /// Returns a crown of 8 m over the ground, as a block of leaves.
    fn crown_over_ground() -> TriangleScene {
        let mut scene = TriangleScene::default();
        let at = PlanPlacement { origin: [0.0, 0.0], angle: 0.0 };
        scene.add_object("ground", &[extruded(&at.rectangle(40.0, 40.0), -1.0, 0.0)]);
        let crown = extruded(&at.rectangle(20.0, 20.0), 4.0, 12.0).with_material(Material::TreeCrown);
        scene.add_object("crown", &[crown]);
        scene
    }

    #[test]
    fn rays_in_a_crown_are_stopped_after_an_exponential_path() {
        let scene = crown_over_ground();
        let truth = Truth::new(&scene);
        // One ray per pulse and a pulse without width, so that the share of the rays is visible.
        let beam = BeamParams { divergence: 0.0, foliage_depth: 3.0, crown_porosity: 0.6, ..BeamParams::default() };
        let ray = SubRay { origin: [1.0, 2.0, 500.0], direction: [0.0, 0.0, -1.0], energy: 1.0, max_range: 1e9 };
        let ranges: Vec<f64> = (0..40_000)
            .filter_map(|i| Some(ray_echo(&scene, &truth, &ray, &beam, &mut Random::new(5, i))?.range))
            .collect();
        assert_eq!(ranges.len(), 40_000, "the ground stops what the crown lets through");
        let share =
            |from: f64, to: f64| ranges.iter().filter(|r| (from..=to).contains(r)).count() as f64 / ranges.len() as f64;
        // The shares of 40 000 rays have a standard deviation of 0.0025 at most; the tolerance is four of them.
        let expected = |from: f64, to: f64| 0.6 * ((-from / 3.0).exp() - (-to / 3.0).exp());
        for (found, exact) in [
            (share(488.0 - 1e-6, 488.0 + 1e-6), 0.4),
            (share(488.0 + 1e-6, 489.0), expected(0.0, 1.0)),
            (share(489.0, 492.0), expected(1.0, 4.0)),
            (share(492.0, 496.0), expected(4.0, 8.0)),
            (share(500.0 - 1e-6, 500.0 + 1e-6), 0.6 * (-8.0_f64 / 3.0).exp()),
        ] {
            assert!((found - exact).abs() < 0.01, "{found} {exact}");
        }
    }

    #[test]
    fn echoes_in_leaves_name_the_hull_where_the_ray_entered() {
        let scene = crown_over_ground();
        let truth = Truth::new(&scene);
        let beam = BeamParams { crown_porosity: 1.0, foliage_depth: 2.0, ..BeamParams::default() };
        let top = truth.first_hit([1.0, 2.0, 500.0], [0.0, 0.0, -1.0], f64::INFINITY).map(|hit| hit.triangle);
        let ray = SubRay { origin: [1.0, 2.0, 500.0], direction: [0.0, 0.0, -1.0], energy: 1.0, max_range: 490.0 };
        let echoes = (0..1000).filter_map(|i| ray_echo(&scene, &truth, &ray, &beam, &mut Random::new(1, i)));
        let mut count = 0;
        for echo in echoes {
            assert!(echo.range > 488.0 && echo.range <= 490.0, "no echo from beyond the greatest range");
            assert_eq!((Some(echo.triangle), echo.material), (top, Material::TreeCrown));
            count += 1;
        }
        // 1 − 1/e of 1000, with a tolerance of four standard deviations of 15.
        assert!((572..=692).contains(&count), "{count}");
    }
}
