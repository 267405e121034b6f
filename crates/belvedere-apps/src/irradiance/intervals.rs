//! Intervals of energies, by the change if the outlines of obstacles before sun and sky moved.

use super::period::PeriodRadiation;
use crate::rows::{RowBlock, normals_of};
use crate::sum_errors::{Outlines, class_of};
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::Result;
use belvedere_data::vector::{dot, length};
use rayon::prelude::*;
use std::ops::Range;

/// Targets handed to a thread at once.
const CHUNK: usize = 64;

/// The directions of a period's radiation with their neighbours, suns and sky apart.
pub(super) struct EnergyOutlines<'a> {
    radiation: &'a PeriodRadiation,
    /// Radiation times the vector to the sun for each of its directions, Wh/m².
    of_suns: Vec<[f64; 3]>,
    sun: Outlines,
    sky: Outlines,
}

impl<'a> EnergyOutlines<'a> {
    pub(super) fn new(radiation: &'a PeriodRadiation) -> Self {
        let mut of_suns = vec![[0.0; 3]; radiation.sun_directions.len()];
        for share in &radiation.sun {
            if let Some(sum) = of_suns.get_mut(share.direction) {
                *sum = std::array::from_fn(|axis| sum[axis] + share.beam[axis] + share.around[axis]);
            }
        }
        let weights: Vec<f64> = of_suns.iter().map(|vector| length(*vector)).collect();
        Self {
            sun: Outlines::new(&radiation.sun_directions, &weights),
            sky: Outlines::new(&radiation.sky.directions, &radiation.sky.solid_angles),
            radiation,
            of_suns,
        }
    }

    /// Share of the unobstructed energy of a plane with a unit `normal` that would change if outlines moved by a
    /// degree. `is_free` flags the free ones of [`PeriodRadiation::directions`].
    pub(super) fn moved_share(&self, normal: [f64; 3], is_free: impl Fn(usize) -> bool) -> f64 {
        let Self { radiation, of_suns, sun, sky } = self;
        let first_patch = of_suns.len();
        let of_sun = |number: usize| dot(of_suns[number], normal).max(0.0);
        let from_sun: f64 = (0..first_patch).map(of_sun).sum();
        let on_plane =
            |patch: usize| dot(radiation.sky.directions[patch], normal).max(0.0) * radiation.sky.solid_angles[patch];
        let all_patches: f64 = (0..radiation.sky.directions.len()).map(on_plane).sum();
        let from_sky = self.diffuse(normal);
        let whole = f64::midpoint(1.0, normal[2]);
        let reflected = radiation.evenly.iter().map(|evenly| evenly.global).sum::<f64>() * radiation.params.albedo;
        let all = from_sun + from_sky + reflected * (1.0 - whole);
        let moved_sun = sun.moved(&is_free, of_sun);
        let moved_sky = sky.moved(|patch| is_free(first_patch + patch), on_plane) / all_patches.max(f64::MIN_POSITIVE);
        if all > 0.0 { (moved_sun + from_sky * moved_sky) / all } else { 0.0 }
    }

    /// Returns the radiation from the sky without the part around the sun, Wh/m².
    fn diffuse(&self, normal: [f64; 3]) -> f64 {
        let Self { radiation, .. } = self;
        let whole = f64::midpoint(1.0, normal[2]);
        let tilt_sine = (1.0 - normal[2] * normal[2]).max(0.0).sqrt();
        let evenly: f64 = radiation.evenly.iter().map(|e| e.even * whole + e.horizon * tilt_sine).sum();
        let groups = radiation.patches.chunks(radiation.group_count().max(1));
        let of_patch = |(patch, groups): (&[f64; 3], &[f64])| dot(*patch, normal).max(0.0) * groups.iter().sum::<f64>();
        evenly + radiation.sky.directions.iter().zip(groups).map(of_patch).sum::<f64>()
    }

    /// The class of each target of a block, whose crowns have a
    /// [`factor`](crate::tree_light::CrownLight::factor), by which of all targets are inside obstacles.
    ///
    /// # Errors
    /// Those of [`RowBlock::free_lines`].
    pub(super) fn classes(
        &self,
        (block, factor): (&RowBlock<'_>, f64),
        are_inside: &[bool],
        normals: Option<&[[f32; 3]]>,
    ) -> Result<Vec<u8>> {
        let free = block.free_lines(factor)?;
        let normals = normals_of(normals, &block.rows);
        let class = |row: usize| {
            let normal = normals.and_then(|normals| normals.get(row)).map_or([0.0, 0.0, 1.0], |n| n.map(f64::from));
            let is_inside = are_inside.get(block.rows.start + row) == Some(&true);
            class_of(is_inside, self.moved_share(normal, |direction| free.is_free(row, direction)))
        };
        Ok((0..free.target_count()).into_par_iter().with_min_len(CHUNK).map(class).collect())
    }

    /// The mean share that moves of those cells of a plane, rows of `matrix`, that see anything.
    pub(super) fn moved_share_of_plane(&self, matrix: &VisibilityMatrix, cells: Range<usize>, normal: [f64; 3]) -> f64 {
        let open = cells.into_par_iter().filter(|&cell| matrix.row(cell).iter().any(|&word| word != 0));
        let shares: Vec<f64> =
            open.map(|cell| self.moved_share(normal, |direction| matrix.is_free(cell, direction))).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    }
}
