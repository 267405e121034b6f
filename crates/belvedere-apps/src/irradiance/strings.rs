//! Panels in strings: between the loss of radiation and the loss of a plane whose cells are wired in rows.

use super::irradiation::{Irradiation, on_plane};
use super::period::PeriodRadiation;
use crate::rows::RowBlock;
use belvedere_core::query::VisibilityMatrix;
use belvedere_data::error::check_length;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Result};

/// Energy of a plane of cells over a period.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaneIrradiation {
    /// Mean of its cells for each group of the period, kWh/m². Its loss is the least that a plant loses: that of panels
    /// that each work for themselves.
    pub mean: Vec<Irradiation>,
    /// The same where a row of cells gets only the light that all of its cells get at once. It is the maximum loss of a
    /// plant whose rows are strings without bypass diodes.
    pub string_limited: Vec<Irradiation>,
    /// Light of each direction.
    pub light: PlaneLight,
    /// Cells that are counted: those that see anything of the sky.
    pub cell_count: usize,
}

/// Shares of the light from each of [`PeriodRadiation::directions`] that reach the cells of a plane, 0 to 1, (D).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaneLight {
    /// Mean of the cells.
    pub mean: Vec<f32>,
    /// Mean of the least of each string, weighted with its cells.
    pub string_limited: Vec<f32>,
}

/// Computes the energy of a plane with a unit `normal`, upward, whose cells are rows of `block` from `first` on.
/// `strings`, (C), numbers the string of each cell; cells of a string are together. Crowns have a
/// [`factor`](crate::tree_light::CrownLight::factor). Cells that see nothing at all lie inside an obstacle or under a
/// roof, where no panel is put, and do not count. A plane without cells gets nothing.
///
/// # Errors
/// [`Error::LengthMismatch`] where the matrix has fewer rows or other directions.
pub fn plane_irradiation(
    block: &RowBlock<'_>,
    (first, strings): (usize, &[usize]),
    normal: [f64; 3],
    radiation: &PeriodRadiation,
    factor: f64,
) -> Result<PlaneIrradiation> {
    let matrix = &block.matrix;
    check_length("directions of sun and sky", radiation.directions().len(), matrix.direction_count())?;
    let found = matrix.target_count();
    if found < first + strings.len() {
        return Err(Error::LengthMismatch { what: "cells of a plane", expected: first + strings.len(), found });
    }
    let group_count = radiation.group_count();
    let mut sums = PlaneIrradiation {
        mean: vec![Irradiation::default(); group_count],
        string_limited: vec![Irradiation::default(); group_count],
        light: PlaneLight::default(),
        cell_count: (first..first + strings.len()).filter(|&target| sees_sky(matrix, target)).count(),
    };
    let [mut of_cells, mut of_strings] = [(); 2].map(|()| vec![0.0_f64; matrix.direction_count()]);
    let share = 1.0 / sums.cell_count.max(1) as f64;
    let mut groups = vec![Irradiation::default(); group_count];
    let mut cell = first;
    for string in strings.chunk_by(|a, b| a == b) {
        let mut all = vec![1.0_f64; matrix.direction_count()];
        let open: Vec<usize> = (cell..cell + string.len()).filter(|&target| sees_sky(matrix, target)).collect();
        for &target in &open {
            let light = block.light(target, factor);
            on_plane(radiation, normal, |direction| light.get(direction).copied().unwrap_or(0.0), &mut groups);
            add(&mut sums.mean, &groups, share);
            all.iter_mut().zip(&light).for_each(|(all, own)| *all = all.min(*own));
            of_cells.iter_mut().zip(&light).for_each(|(sum, own)| *sum += share * own);
        }
        on_plane(radiation, normal, |direction| all.get(direction).copied().unwrap_or(0.0), &mut groups);
        let weight = share * open.len() as f64;
        add(&mut sums.string_limited, &groups, weight);
        of_strings.iter_mut().zip(&all).for_each(|(sum, own)| *sum += weight * own);
        cell += string.len();
    }
    let single = |shares: Vec<f64>| shares.into_iter().map(to_f32).collect();
    sums.light = PlaneLight { mean: single(of_cells), string_limited: single(of_strings) };
    Ok(sums)
}

fn sees_sky(matrix: &VisibilityMatrix, target: usize) -> bool {
    matrix.row(target).iter().any(|&word| word != 0)
}

fn add(sums: &mut [Irradiation], groups: &[Irradiation], weight: f64) {
    for (sum, group) in sums.iter_mut().zip(groups) {
        *sum = Irradiation::sum(&[*sum, group.scaled(weight)]);
    }
}
