//! Undulating ground with a height formula.

use std::f64::consts::{PI, TAU};

use crate::random::Random;
use crate::scene::{Material, ObjectPart};
use crate::solids::PlanPlacement;

/// Ground as a formula: an inclined plane with gentle hills.
///
/// The mesh of a scene has its vertices on the formula and flat triangles between, see [`Terrain::height`].
#[derive(Clone, Debug)]
pub struct Terrain {
    centre: [f64; 3],
    gradient: [f64; 2],
    hills: Vec<Hill>,
    canal: Option<Canal>,
}

/// Dry canal: a straight trench with smooth banks, right across the scene.
#[derive(Clone, Debug)]
pub(crate) struct Canal {
    /// Place on the middle line, with u along it.
    pub(crate) placement: PlanPlacement,
    /// Width from bank to bank, metres.
    pub(crate) width: f64,
    /// Depth below the ground at its middle, metres.
    pub(crate) depth: f64,
}

impl Canal {
    /// Returns the depth of the bed below the ground that was there before the canal, metres; 0 outside the canal.
    fn depth_at(&self, x: f64, y: f64) -> f64 {
        let (sin, cos) = self.placement.angle.sin_cos();
        let across = (y - self.placement.origin[1]) * cos - (x - self.placement.origin[0]) * sin;
        let share = across.abs() / (self.width / 2.0);
        if share < 1.0 { self.depth * (0.5 + 0.5 * (share * PI).cos()) } else { 0.0 }
    }
}

/// Wave of the ground.
#[derive(Clone, Debug)]
struct Hill {
    amplitude: f64,
    wave: [f64; 2],
    phase: f64,
}

/// Wavelengths of the ground, metres: longer than a building, so that none stands on a ridge.
const WAVELENGTHS: [f64; 3] = [160.0, 110.0, 75.0];
/// Side of the squares of the mesh, metres.
pub(crate) const CELL: f64 = 2.0;

impl Terrain {
    /// Returns ground about `centre` (absolute, metres) that rises by `slope` (metres per metre) in a random direction.
    /// Hills rise and fall by up to `hill_height` metres.
    pub(crate) fn new(centre: [f64; 3], slope: f64, hill_height: f64, seed: u64) -> Self {
        let mut random = Random::new(seed, 1);
        let (sin, cos) = random.between(0.0, TAU).sin_cos();
        let hills = WAVELENGTHS.iter().map(|wavelength| {
            let (sin, cos) = random.between(0.0, TAU).sin_cos();
            let frequency = TAU / wavelength;
            Hill {
                amplitude: hill_height / WAVELENGTHS.len() as f64,
                wave: [frequency * cos, frequency * sin],
                phase: random.between(0.0, TAU),
            }
        });
        Self { centre, gradient: [slope * cos, slope * sin], hills: hills.collect(), canal: None }
    }

    /// Returns this ground with a trench in it.
    pub(crate) fn with_canal(mut self, canal: Option<Canal>) -> Self {
        self.canal = canal;
        self
    }

    /// Returns the height of the ground at absolute (x, y), all in metres.
    ///
    /// The mesh lies on this height at its vertices. Between them it departs from it by less than 4 mm per metre of
    /// hill height. That is half the squared circumradius of its triangles times the greatest curvature. In a canal it
    /// departs by up to 0.4 m, because the banks are steep for the size of the triangles.
    #[must_use]
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - self.centre[0], y - self.centre[1]);
        let hills = self.hills.iter().map(|h| h.amplitude * (h.wave[0] * dx + h.wave[1] * dy + h.phase).sin());
        let natural = self.centre[2] + self.gradient[0] * dx + self.gradient[1] * dy + hills.sum::<f64>();
        self.canal.as_ref().map_or(natural, |canal| natural - canal.depth_at(x, y))
    }

    /// Returns the lowest height within the box around `footprint`, sampled every metre.
    pub(crate) fn lowest(&self, footprint: &[[f64; 2]]) -> f64 {
        let fold =
            |axis: usize, start: f64, pick: fn(f64, f64) -> f64| footprint.iter().map(|p| p[axis]).fold(start, pick);
        let low = [0, 1].map(|axis| fold(axis, f64::INFINITY, f64::min));
        let high = [0, 1].map(|axis| fold(axis, f64::NEG_INFINITY, f64::max));
        let steps = [0, 1].map(|axis| whole(high[axis] - low[axis]) + 1);
        (0..=steps[1])
            .flat_map(|j| (0..=steps[0]).map(move |i| (i, j)))
            .map(|(i, j)| self.height(low[0] + f64::from(i), low[1] + f64::from(j)))
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the mesh of the square of side `extent` about the centre.
    pub(crate) fn mesh(&self, extent: f64) -> ObjectPart {
        let cells = whole((extent / CELL).ceil()).max(1) as usize;
        let coordinate = |i: usize| extent * (i as f64 / cells as f64 - 0.5);
        let mut part = ObjectPart::default();
        for j in 0..=cells {
            for i in 0..=cells {
                let (x, y) = (self.centre[0] + coordinate(i), self.centre[1] + coordinate(j));
                part.vertices.push([x, y, self.height(x, y)]);
            }
        }
        let vertex = |i: usize, j: usize| j * (cells + 1) + i;
        for j in 0..cells {
            for i in 0..cells {
                let [a, b] = [vertex(i, j), vertex(i + 1, j)];
                let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
                part.add_polygon(&[a, b, c], Material::Terrain);
                part.add_polygon(&[a, c, d], Material::Terrain);
            }
        }
        part
    }
}

#[expect(clippy::cast_possible_truncation, reason = "`as` saturates, lengths are not negative")]
fn whole(length: f64) -> u32 {
    length as u32
}
