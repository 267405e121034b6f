//! A place made ready: cloud, scanner, models, and targets with their exact answers.

use anyhow::Result;
use belvedere::query::Viewer;
use belvedere::view::to_sun;
use belvedere::{Bounds, Error, PointCloud};
use belvedere_baselines::agreement::Tiles;
use belvedere_baselines::audit::TruePoint;
use belvedere_baselines::simulated::SurveyedScene;
use belvedere_baselines::{MethodInput, PlaceModel};
use belvedere_scenes::{Material, QuerySet, TriangleScene};
use rayon::prelude::*;

/// Suns that methods answer for, azimuth and elevation in degrees: morning, noon and afternoon, from low to high.
const SUNS_DEG: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0]];
/// Side of the tiles that are resampled for intervals, metres: half a block of houses.
const TILE_SIDE: f32 = 25.0;
/// The cloud's own points, as a kind of target.
pub(super) const OWN: &str = "OWN";
/// Pedestrians as people in streets see them, and those people: one observer says little, since an error near it spoils
/// a whole sector of its view.
pub(super) const STREET: &str = "STREET";
pub(super) const STREET_GROUP: &str = "street";
/// People that look.
pub(super) const STREET_OBSERVERS: usize = 40;
/// Of other targets there are so many times more: each of these is looked at from many eyes.
const FEWER_STREET_TARGETS: usize = 5;

/// The box of a cloud, which an empty cloud does not have.
pub(crate) fn bounds_of(cloud: &PointCloud) -> Result<Bounds> {
    Ok(cloud.bounds().ok_or_else(|| Error::NoPoints { what: "none was read".to_owned() })?)
}

/// What a place consists of, before any query.
pub(super) struct Ingredients {
    pub(super) cloud: PointCloud,
    /// Local position of the scanner for each point; empty where unknown.
    pub(super) scanner: Vec<[f32; 3]>,
    pub(super) models: Vec<PlaceModel>,
    pub(super) scene: TriangleScene,
}

/// Who looks, and what the truth says to each set.
pub(super) struct CaseView {
    pub(super) group: &'static str,
    /// `None` for pairs.
    pub(super) from: Option<From>,
}

impl CaseView {
    /// Its group, or the elevation of its sun.
    pub(super) fn title(&self) -> String {
        match self.from {
            Some(From::Direction([.., up])) => format!("sun at {:.0}°", up.asin().to_degrees()),
            _ => self.group.to_owned(),
        }
    }
}

/// A common viewer.
#[derive(Clone, Copy)]
pub(super) enum From {
    Direction([f64; 3]),
    /// Local metres.
    Eye([f64; 3]),
}

/// Targets of one kind and their exact answers in each view that uses them.
pub(super) struct Set {
    pub(super) name: &'static str,
    pub(super) targets: Vec<[f32; 3]>,
    /// Other ends, for pairs.
    pub(super) eyes: Vec<[f32; 3]>,
    pub(super) tiles: Tiles,
    /// Number of the view, and for each target whether it is visible; `None` where that is not known.
    pub(super) truth: Vec<(usize, Vec<Option<bool>>)>,
}

/// A place with questions and answers.
pub(super) struct ComparisonCase {
    pub(super) place: SurveyedScene,
    pub(super) models: Vec<PlaceModel>,
    pub(super) views: Vec<CaseView>,
    pub(super) sets: Vec<Set>,
    /// What is known of the surface each point lies on.
    pub(super) sources: Vec<Option<TruePoint<Material>>>,
}

impl ComparisonCase {
    /// Draws `count` targets of each kind and answers them exactly.
    pub(super) fn new(ingredients: Ingredients, count: usize, seed: u64) -> Result<Self> {
        let Ingredients { cloud, scanner, models, scene } = ingredients;
        bounds_of(&cloud)?;
        let place = SurveyedScene::new(scene, (cloud, scanner));
        let site = place.site();

        let mut views: Vec<CaseView> = SUNS_DEG
            .iter()
            .map(|&[azimuth, elevation]| CaseView {
                group: "suns",
                from: Some(From::Direction(to_sun(azimuth.to_radians(), elevation.to_radians()))),
            })
            .collect();
        let local = |eye: [f64; 3]| place.eye(eye);
        let observers = site.observers(seed).into_iter().flatten();
        views.extend(observers.map(|eye| CaseView { group: "observers", from: Some(From::Eye(local(eye))) }));
        let street = site.street_observers(STREET_OBSERVERS, seed);
        views.extend(street.into_iter().map(|eye| CaseView { group: STREET_GROUP, from: Some(From::Eye(local(eye))) }));
        views.push(CaseView { group: "pairs", from: None });

        let sources = sources(&place);
        let mut sets = Vec::new();
        let kinds = QuerySet::ALL.map(|set| (set.name(), set, count));
        let street = (STREET, QuerySet::Pedestrians, (count / FEWER_STREET_TARGETS).max(1));
        for (name, set, count) in kinds.into_iter().chain([street]) {
            let drawn = site.targets(set, count, seed);
            let local = |points: &[[f64; 3]]| -> Vec<[f32; 3]> { points.iter().map(|&p| place.local(p)).collect() };
            let (targets, eyes) = (local(&drawn.positions), local(&drawn.eyes));
            // the truth for what is queried: for positions as f32 stores them
            let exact: Vec<Option<[f64; 3]>> = targets.iter().map(|&p| Some(place.absolute(p))).collect();
            let ends: Vec<[f64; 3]> = eyes.iter().map(|&p| place.absolute(p)).collect();
            sets.push(answered(name, targets, eyes, &exact, &ends, &views, &place));
        }
        // the returns themselves, as far as their surface is known
        let step = (place.cloud.len() / count.max(1)).max(1);
        let rows: Vec<usize> = (0..place.cloud.len()).step_by(step).filter(|&i| sources[i].is_some()).collect();
        let exact: Vec<Option<[f64; 3]>> = rows.iter().map(|&i| sources[i].map(|(_, outside)| outside)).collect();
        let own: Vec<[f32; 3]> = rows.iter().map(|&i| place.cloud.positions[i]).collect();
        sets.push(answered(OWN, own, Vec::new(), &exact, &[], &views, &place));
        sets.retain(|set| !set.targets.is_empty());

        let sources = sources.into_iter().map(|source| source.map(|(source, _)| source)).collect();
        Ok(Self { place, models, views, sets, sources })
    }

    pub(super) fn survey(&self) -> MethodInput<'_> {
        MethodInput { models: &self.models, ..self.place.input() }
    }

    /// Whether a local position lies in a solid or in the ground.
    pub(super) fn is_inside(&self, local: [f32; 3]) -> bool {
        self.place.site().is_inside(self.place.absolute(local))
    }

    pub(super) fn viewer<'a>(&'a self, view: usize, set: &'a Set) -> Viewer<'a> {
        match self.views[view].from {
            Some(From::Direction(direction)) => Viewer::Direction(direction),
            Some(From::Eye(eye)) => Viewer::Eye(eye),
            None => Viewer::Each(&set.eyes),
        }
    }
}

/// The exact answers of one set.
fn answered(
    name: &'static str,
    targets: Vec<[f32; 3]>,
    eyes: Vec<[f32; 3]>,
    exact: &[Option<[f64; 3]>],
    ends: &[[f64; 3]],
    views: &[CaseView],
    place: &SurveyedScene,
) -> Set {
    let truth = views
        .iter()
        .enumerate()
        .filter(|(_, view)| view.from.is_none() != eyes.is_empty() && (view.group == STREET_GROUP) == (name == STREET))
        .map(|(number, view)| {
            let visible = |(i, point): (usize, &Option<[f64; 3]>)| {
                let point = (*point)?;
                Some(!match view.from {
                    Some(From::Direction(direction)) => place.truth.occluded_towards(point, direction),
                    Some(From::Eye(eye)) => place.truth.occluded(point, place.absolute_of(eye)),
                    None => place.truth.occluded(point, *ends.get(i)?),
                })
            };
            (number, exact.par_iter().enumerate().map(visible).collect())
        })
        .collect();
    let tiles = Tiles::new(&targets, TILE_SIDE);
    Set { name, targets, eyes, tiles, truth }
}

/// For each point what its surface is, and a point just outside that surface; `None` where that is unknown.
fn sources(place: &SurveyedScene) -> Vec<Option<(TruePoint<Material>, [f64; 3])>> {
    let site = place.site();
    let source = |(i, &position): (usize, &[f32; 3])| {
        let from = place.scanner.get(i).copied().filter(|s| s.iter().all(|v| v.is_finite()))?;
        let (hit, outside) = site.surface_of_return(place.absolute(from), place.absolute(position))?;
        let normal = site.scene.normal(hit.triangle as usize)?;
        let kind = place.material(hit.triangle)?;
        Some((TruePoint { kind, normal }, outside))
    };
    place.cloud.positions.par_iter().enumerate().map(source).collect()
}
