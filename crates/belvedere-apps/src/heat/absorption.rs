//! Radiation that bodies absorb, hour by hour.

use super::body::{Receiver, black_body, radiance};
use super::hours::{HeatHour, HeatHours};
use super::materials::{GroundCover, Material};
use super::seen_surfaces::{FAR, SKY, SceneSurfaces, SeenSurfaces, Surface, body_directions, sky_of_bodies};
use crate::rows::{Obstacles, RowBlock, fold_rows};
use crate::sky_view::SkyDirections;
use crate::tree_light::CrownLight;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::{dot, to_f32};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// Targets whose surfaces are held at a time.
const BLOCK: usize = 1 << 15;
/// Share of the light on the ground and on walls that reaches other surfaces: an albedo of 0.2, seen half.
const SECOND_BOUNCE: f64 = 0.1;

/// Radiation absorbed by some targets on one day.
#[derive(Clone, Debug)]
pub struct AbsorbedBlock {
    /// The targets.
    pub rows: Range<usize>,
    /// Number of the day.
    pub day: usize,
    /// For each target a value for each hour of the day, W/m².
    pub absorbed: Vec<Vec<f64>>,
}

/// Computes the radiation that a receiver absorbs at each of `targets`, (M, 3) local metres, in each hour of `days`,
/// W/m² of its surface, and passes it to `fold`, block after block. Targets that are not finite get NaN. Progress
/// counts targets, [`Obstacles::matrix_count`] times and one more.
///
/// # Errors
/// Those of [`SceneSurfaces::validate`] and [`fold_rows`].
///
/// # Source
/// This project's own sum over directions. Shortwave by patches: Wallenberg, Lindberg, Holmer & Thorsson 2020; longwave
/// by patches: Wallenberg, Holmer, Lindberg & Rayner 2023. Fluxes: Lindberg, Holmer & Thorsson 2008.
pub fn fold_absorbed(
    (obstacles, surfaces): (Obstacles<'_>, &SceneSurfaces<'_>),
    targets: &[[f32; 3]],
    receiver: Receiver,
    days: &[&HeatHours],
    control: &Control<'_>,
    mut fold: impl FnMut(AbsorbedBlock) -> Result<()>,
) -> Result<()> {
    surfaces.validate()?;
    let sky = sky_of_bodies()?;
    let directions = body_directions()?;
    let crowns = obstacles.trees.map(|trees| trees.crowns);
    for (number, block) in targets.chunks(BLOCK).enumerate() {
        let first = number * BLOCK;
        fold_rows(obstacles.into(), block, &sky.directions, control, |rows| {
            let own = &block[rows.rows.clone()];
            let seen = SeenSurfaces::find(surfaces, own, &rows, &directions, control)?;
            let mut shares = Vec::new();
            let mut factor_of_shares = None;
            for (day, hours) in days.iter().enumerate() {
                let of_day = DayOfBlock { obstacles, crowns, receiver, cover: surfaces.cover, hours };
                // crowns change with the season, and with them the sky of what lies below
                let factor = hours.iter().find(|hour| !hour.suns.is_empty()).map_or(0.0, |hour| of_day.factor(hour));
                if factor_of_shares != Some(factor) {
                    let count = seen.surfaces.len() * obstacles.matrix_count();
                    shares = control.stage("testing the sky of surfaces", count, || {
                        sky_shares((obstacles, factor), &seen.surfaces, &sky, control)
                    })?;
                    factor_of_shares = Some(factor);
                }
                let count = (seen.surfaces.len() + own.len()) * obstacles.matrix_count();
                let absorbed = control.stage("testing the sun of surfaces", count, || {
                    of_day.absorbed((own, &rows), (&seen, &shares), &directions, control)
                })?;
                fold(AbsorbedBlock { rows: first + rows.rows.start..first + rows.rows.end, day, absorbed })?;
            }
            Ok(())
        })?;
    }
    Ok(())
}

/// Light of one part of a row of weather at each target.
struct Lit {
    /// (hours) rows of (targets): direct radiation times the receiving area, W/m²; and the share of the row in the sun.
    hours: Vec<Vec<[f32; 2]>>,
}

/// One day of a block of targets.
struct DayOfBlock<'a> {
    obstacles: Obstacles<'a>,
    crowns: Option<CrownLight>,
    receiver: Receiver,
    cover: GroundCover,
    hours: &'a [HeatHour],
}

impl DayOfBlock<'_> {
    fn factor(&self, hour: &HeatHour) -> f64 {
        let season = hour.suns.first().map(|sun| sun.season);
        self.crowns.map_or(0.0, |crowns| crowns.factor(season))
    }

    /// The light of the suns of each hour at places, which have an area towards each sun.
    fn lit(
        &self,
        places: &[[f32; 3]],
        area: impl Fn(usize, [f64; 3]) -> f64 + Sync,
        control: &Control<'_>,
    ) -> Result<Lit> {
        let suns: Vec<[f64; 3]> = self.hours.iter().flat_map(|hour| hour.suns.iter().map(|sun| sun.to_sun)).collect();
        let mut lit = Lit { hours: vec![vec![[0.0; 2]; places.len()]; self.hours.len()] };
        if suns.is_empty() {
            return Ok(lit);
        }
        fold_rows(self.obstacles.into(), places, &suns, control, |rows| {
            let mut first = 0;
            for (hour, lit) in self.hours.iter().zip(&mut lit.hours) {
                let factor = self.factor(hour);
                let of_row = |(row, lit): (usize, &mut [f32; 2])| {
                    let mut sums = [0.0; 2];
                    for (column, sun) in hour.suns.iter().enumerate() {
                        let area = area(rows.rows.start + row, sun.to_sun);
                        if area > 0.0 {
                            let share = rows.line(row, first + column).share(factor);
                            sums = [sums[0] + area * share * sun.direct, sums[1] + share];
                        }
                    }
                    *lit = sums.map(|sum| to_f32(sum / hour.parts as f64));
                };
                lit[rows.rows.clone()].par_iter_mut().enumerate().with_min_len(256).for_each(of_row);
                first += hour.suns.len();
            }
            Ok(())
        })?;
        Ok(lit)
    }

    fn absorbed(
        &self,
        (targets, rows): (&[[f32; 3]], &RowBlock<'_>),
        (seen, shares): (&SeenSurfaces, &[f64]),
        directions: &[([f64; 3], f64)],
        control: &Control<'_>,
    ) -> Result<Vec<Vec<f64>>> {
        let direct = self.lit(targets, |_, to_sun| self.receiver.projected_to_sun(to_sun), control)?;
        let of_surface = |row: usize, to_sun: [f64; 3]| match seen.surfaces.get(row).and_then(|s| s.normal) {
            Some(normal) => dot(normal.map(f64::from), to_sun).max(0.0),
            None => 0.25,
        };
        let places: Vec<[f32; 3]> = seen.surfaces.iter().map(|surface| surface.position).collect();
        let light = self.lit(&places, of_surface, control)?;
        let of_number = |(number, (surface, share)): (usize, (&Surface, &f64))| {
            let light = light.hours.iter().map(|hour| hour[number].map(f64::from));
            self.radiances(surface.material, *share, light)
        };
        let glow: Vec<Vec<f32>> =
            seen.surfaces.par_iter().zip(shares).enumerate().with_min_len(256).map(of_number).collect();
        let open = self.hours.iter().map(|hour| {
            let sum: f64 = hour.suns.iter().map(|sun| sun.direct * sun.to_sun[2]).sum();
            [sum / hour.parts as f64, hour.suns.len() as f64 / hour.parts as f64]
        });
        let far = self.radiances(Material::Ground(self.cover), 1.0, open);
        let [short, long] = self.receiver.absorbed_shares();
        let areas = areas(self.receiver, directions);
        let patches = rows.matrix.direction_count();
        let of_target = |row: usize| {
            if !targets[row].iter().all(|v| v.is_finite()) {
                return vec![f64::NAN; self.hours.len()];
            }
            let mut sums: Vec<f64> = direct.hours.iter().map(|hour| short * f64::from(hour[row][0])).collect();
            let seen = &seen.seen[row * directions.len()..(row + 1) * directions.len()];
            for (column, (&number, (_, angle))) in seen.iter().zip(directions).enumerate() {
                let area = areas[column];
                if area == 0.0 {
                    continue;
                }
                let line = (column < patches).then(|| rows.line(row, column));
                let glow = match number {
                    SKY => None,
                    FAR => Some(&far),
                    number => glow.get(number as usize),
                };
                for (number, (hour, sum)) in self.hours.iter().zip(&mut sums).enumerate() {
                    let share = line.map_or(0.0, |line| line.share(self.factor(hour)));
                    if share > 0.0 {
                        let sky = radiance(short * hour.diffuse + long * hour.sky_longwave);
                        *sum += area * share * angle * sky;
                    }
                    if let Some(glow) = glow.filter(|_| share < 1.0) {
                        *sum += area * (1.0 - share) * angle * f64::from(glow[number]);
                    }
                }
            }
            sums
        };
        Ok((0..targets.len()).into_par_iter().with_min_len(16).map(of_target).collect())
    }

    /// The radiance of a surface in each hour, as far as the receiver absorbs it, W/(m² sr). `share` is the part of its
    /// half space that is sky; `light` the direct radiation on it and the share of the hour that it is lit.
    fn radiances(&self, material: Material, share: f64, light: impl Iterator<Item = [f64; 2]>) -> Vec<f32> {
        let [short, long] = self.receiver.absorbed_shares();
        let mut warmth = 0.0;
        let of_hour = |(hour, [direct, lit]): (&HeatHour, [f64; 2])| {
            let excess = material.warmed().map_or(0.0, |number| hour.warming[number]) * lit;
            warmth = excess * (1.0 - hour.memory) + warmth * hour.memory;
            let received = direct + hour.diffuse * share + SECOND_BOUNCE * (1.0 - share) * hour.global;
            let around = share * hour.sky_longwave + (1.0 - share) * black_body(hour.air.temperature);
            let emitted = material.emissivity() * black_body(hour.air.temperature + warmth);
            let sent = long * (emitted + (1.0 - material.emissivity()) * around);
            to_f32(radiance(short * material.albedo() * received + sent))
        };
        self.hours.iter().zip(light).map(of_hour).collect()
    }
}

/// The area of a receiver in each direction, scaled so that even radiation from everywhere is summed exactly.
fn areas(receiver: Receiver, directions: &[([f64; 3], f64)]) -> Vec<f64> {
    let areas: Vec<f64> = directions.iter().map(|(direction, _)| receiver.projected(*direction)).collect();
    let sum: f64 = areas.iter().zip(directions).map(|(area, (_, angle))| area * angle).sum();
    areas.into_iter().map(|area| area * PI / sum).collect()
}

/// The share of the half space of each surface that is sky, by the cosine to its normal. Crowns, whose light has a
/// [`CrownLight::factor`], let a share through. Leaves have a half at most.
fn sky_shares(
    (obstacles, factor): (Obstacles<'_>, f64),
    surfaces: &[Surface],
    sky: &SkyDirections,
    control: &Control<'_>,
) -> Result<Vec<f64>> {
    let places: Vec<[f32; 3]> = surfaces.iter().map(|surface| surface.position).collect();
    let mut shares = Vec::with_capacity(surfaces.len());
    fold_rows(obstacles.into(), &places, &sky.directions, control, |rows| {
        let of_row = |row: usize| {
            let normal = surfaces.get(rows.rows.start + row).and_then(|surface| surface.normal);
            let patches = sky.directions.iter().zip(&sky.solid_angles).enumerate();
            let part = |(column, (direction, angle)): (usize, (&[f64; 3], &f64))| {
                let cosine = normal.map_or(0.25, |normal| dot(normal.map(f64::from), *direction).max(0.0));
                if cosine > 0.0 { angle * cosine * rows.line(row, column).share(factor) } else { 0.0 }
            };
            let sum: f64 = patches.map(part).sum();
            sum / PI
        };
        shares.extend((0..rows.matrix.target_count()).into_par_iter().with_min_len(64).map(of_row).collect::<Vec<_>>());
        Ok(())
    })?;
    Ok(shares)
}
