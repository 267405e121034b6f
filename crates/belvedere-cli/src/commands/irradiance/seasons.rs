//! Energy of places and planes, with trees that let a share of it through in each season.

use super::super::tree_light::TreeLight;
use belvedere::Result;
use belvedere::apps::irradiance::{
    Irradiation, PeriodRadiation, PlaneIrradiation, plane_irradiation, scene_irradiation,
};
use belvedere::control::Control;
use belvedere::query::{MedialScene, visibility_matrix};

/// What the days send on which trees let the same share through.
pub(super) struct Season {
    pub(super) radiation: PeriodRadiation,
    /// Share of the light that gets through crowns; 0 where trees are opaque.
    pub(super) share: f64,
}

/// What stands in the way of sun and sky, and what they send.
pub(super) struct Light<'a> {
    pub(super) blockers: &'a MedialScene,
    pub(super) trees: Option<&'a TreeLight>,
    /// One at least.
    pub(super) seasons: &'a [Season],
}

/// A plane of a roof with its rows among the places of all planes.
pub(super) struct PlaneCells<'a> {
    pub(super) normal: [f64; 3],
    /// The string of each cell.
    pub(super) strings: &'a [usize],
}

impl Light<'_> {
    /// Sums kept of each place.
    pub(super) fn group_count(&self) -> usize {
        self.seasons.first().map_or(1, |season| season.radiation.group_count())
    }

    /// Directions that are asked, over all seasons.
    pub(super) fn direction_count(&self) -> usize {
        self.seasons.iter().map(|season| season.radiation.directions().len()).sum()
    }

    /// How often each place is looked from.
    pub(super) fn look_count(&self) -> usize {
        self.seasons.len() * if self.trees.is_some() { 2 } else { 1 }
    }

    /// The energy of places: for each a row of groups. Progress counts places, [`Self::look_count`] times each.
    pub(super) fn of_places(
        &self,
        places: &[[f32; 3]],
        normals: Option<&[[f32; 3]]>,
        control: &Control<'_>,
    ) -> Result<Vec<Irradiation>> {
        let mut sums = vec![Irradiation::default(); places.len() * self.group_count()];
        for season in self.seasons {
            let of = |scene| scene_irradiation(scene, places, normals, &season.radiation, control);
            let mut own = of(self.blockers)?;
            if let Some(trees) = self.trees {
                mix(&mut own, &of(&trees.opaque)?, season.share);
            }
            add(&mut sums, &own);
        }
        Ok(sums)
    }

    /// The energy of planes, whose cells stand at `places` one plane after the other.
    pub(super) fn of_planes(&self, places: &[[f32; 3]], planes: &[PlaneCells<'_>]) -> Result<Vec<PlaneIrradiation>> {
        let mut sums: Vec<PlaneIrradiation> = Vec::new();
        for season in self.seasons {
            let mut own = planes_among(self.blockers, places, planes, &season.radiation)?;
            if let Some(trees) = self.trees {
                let opaque = planes_among(&trees.opaque, places, planes, &season.radiation)?;
                for (own, opaque) in own.iter_mut().zip(&opaque) {
                    mix(&mut own.mean, &opaque.mean, season.share);
                    mix(&mut own.string_limited, &opaque.string_limited, season.share);
                }
            }
            if sums.is_empty() {
                sums = own;
                continue;
            }
            for (sum, own) in sums.iter_mut().zip(&own) {
                add(&mut sum.mean, &own.mean);
                add(&mut sum.string_limited, &own.string_limited);
            }
        }
        Ok(sums)
    }
}

fn planes_among(
    scene: &MedialScene,
    places: &[[f32; 3]],
    planes: &[PlaneCells<'_>],
    radiation: &PeriodRadiation,
) -> Result<Vec<PlaneIrradiation>> {
    let matrix = visibility_matrix(scene, places, &radiation.directions(), &Control::none())?;
    let mut first = 0;
    let of_plane = |plane: &PlaneCells<'_>| {
        let found = plane_irradiation(&matrix, first, plane.strings, plane.normal, radiation);
        first += plane.strings.len();
        found
    };
    planes.iter().map(of_plane).collect()
}

fn mix(all: &mut [Irradiation], opaque: &[Irradiation], share: f64) {
    for (all, opaque) in all.iter_mut().zip(opaque) {
        *all = all.through_crowns(opaque, share);
    }
}

fn add(sums: &mut [Irradiation], own: &[Irradiation]) {
    for (sum, own) in sums.iter_mut().zip(own) {
        *sum = Irradiation::sum(&[*sum, *own]);
    }
}
