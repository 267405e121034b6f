//! Viewsheds of carved balls on a simulated town, against the rays of its exact mesh.

use belvedere::Result;
use belvedere::apps::viewshed::{Observer, SightLimits, ViewshedParams, cell_targets, tested_height, viewshed};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundParams, MapGrid};
use belvedere::medial::MedialBalls;
use belvedere::pulses::{FreeSegmentParams, FreeSegments};
use belvedere::query::{Answer, BlockRule, BlockingTriangles, MedialScene, Proof, ProofParams};
use belvedere_baselines::medial::{MedialParams, Outward, scene_model};
use belvedere_baselines::simulated::SurveyedScene;
use belvedere_scenes::Preset;

/// How far from an observer cells are judged, metres: beyond, few are seen by anybody in a street.
const REACH: f64 = 150.0;

/// A town, its survey and the balls made of it.
pub(crate) struct ViewshedTown {
    pub(crate) town: SurveyedScene,
    pub(crate) balls: MedialBalls,
    triangles: Option<BlockingTriangles>,
    pub(crate) ground: Ground,
    /// Exact height of the ground in each cell, absolute, where it is bare of buildings.
    exact_ground: Vec<Option<f64>>,
    /// Eyes of people in streets, local metres.
    pub(crate) eyes: Vec<[f64; 3]>,
}

/// Cells by what they truly are and by what they were taken for, over all observers: unproven ones for visible in the
/// first counts, and left out of the second.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ViewshedScore {
    pub(crate) truly_visible: usize,
    pub(crate) truly_blocked: usize,
    pub(crate) false_visible: usize,
    pub(crate) false_blocked: usize,
    /// Sum over observers of the cells seen by both by those seen by either, unproven ones taken for visible, and left
    /// out.
    pub(crate) iou_sums: [f64; 2],
    pub(crate) unproven: usize,
    pub(crate) observers: usize,
}

impl ViewshedScore {
    /// Mean share of the cells seen by both in those seen by either: unproven ones taken for visible, and left out.
    pub(crate) fn ious(&self) -> [f64; 2] {
        self.iou_sums.map(|sum| sum / self.observers.max(1) as f64)
    }

    pub(crate) fn false_visible_share(&self) -> f64 {
        self.false_visible as f64 / self.truly_blocked.max(1) as f64
    }

    pub(crate) fn false_blocked_share(&self) -> f64 {
        self.false_blocked as f64 / self.truly_visible.max(1) as f64
    }
}

impl ViewshedTown {
    /// A town of `extent` metres with cells of `cell` metres, and `eyes` people in its streets.
    pub(crate) fn new(preset: Preset, extent: f64, cell: f64, eyes: usize, seed: u64) -> Result<Self> {
        let town = SurveyedScene::flown(preset, extent, seed, 8.0)?;
        let origin = town.cloud.frame.origin;
        let model = scene_model(&town.input(), Outward::Survey, &MedialParams::carved())?;
        let triangles = model.triangles().cloned();
        let balls = model.into_parts().balls;
        let (low, high) = town.cloud.bounds().unwrap_or_default().on_map();
        let site = town.site();
        let grid = MapGrid::covering(low, high, cell, [origin[0], origin[1]])?;
        let (ground, _) = Ground::of_cloud(&town.cloud, grid, &GroundParams::default(), &Control::none())?;
        let exact_ground = (0..grid.len())
            .map(|i| {
                let [x, y] = grid.center(i % grid.width, i / grid.width);
                site.ground_height([x + origin[0], y + origin[1]])
            })
            .collect();
        let eyes = site.street_observers(eyes, seed).into_iter().map(|eye| town.eye(eye)).collect();
        Ok(Self { town, balls, triangles, ground, exact_ground, eyes })
    }

    /// What blocks: the balls, and the surfaces of buildings.
    pub(crate) fn blockers(&self) -> Result<MedialScene> {
        Ok(MedialScene::new(&self.balls, &BlockRule::carved())?.with_triangles(self.triangles.clone()))
    }

    /// What people in the streets see of targets `height` metres above the ground.
    pub(crate) fn judge(&self, height: f64) -> Result<ViewshedScore> {
        let scene = self.blockers()?;
        let (free_segments, _) = FreeSegments::of_cloud(
            &self.town.cloud,
            &self.town.scanner,
            &FreeSegmentParams::default(),
            &Control::none(),
        )?;
        let scene = scene.with_pulses(Proof::new(free_segments, &ProofParams::default())?);
        let targets = cell_targets(&self.ground, tested_height(height));
        let mut score = ViewshedScore::default();
        for &eye in &self.eyes {
            let limits = SightLimits { distance: [0.0, REACH], ..SightLimits::default() };
            let observer = Observer { eye, limits };
            let seen = viewshed(&scene, &[observer], &targets, &ViewshedParams::default(), &Control::none())?;
            let (mut both, mut either) = ([0, 0], [0, 0]);
            let queried = targets.iter().zip(&self.exact_ground).zip(&seen.answers);
            let queried: Vec<([f64; 3], Answer)> = queried
                .filter(|(_, answer)| **answer != Answer::OutsideView)
                .filter_map(|((target, ground), answer)| {
                    let [x, y, _] = self.town.absolute(*target);
                    Some(([x, y, (*ground)? + height], *answer))
                })
                .collect();
            let places: Vec<[f64; 3]> = queried.iter().map(|(place, _)| *place).collect();
            let occluded = self.town.truth.occluded_each(&places, self.town.absolute_of(eye));
            for ((_, answer), occluded) in queried.iter().zip(occluded) {
                let (seen, truly) = (*answer != Answer::Blocked, !occluded);
                for i in 0..if *answer == Answer::Unproven { 1 } else { 2 } {
                    both[i] += usize::from(seen && truly);
                    either[i] += usize::from(seen || truly);
                }
                score.unproven += usize::from(*answer == Answer::Unproven);
                score.truly_visible += usize::from(truly);
                score.truly_blocked += usize::from(!truly);
                score.false_visible += usize::from(seen && !truly);
                score.false_blocked += usize::from(!seen && truly);
            }
            for i in 0..2 {
                score.iou_sums[i] += both[i] as f64 / either[i].max(1) as f64;
            }
            score.observers += 1;
        }
        Ok(score)
    }
}
