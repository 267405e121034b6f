//! The paper's method as published and its relatives: unions of medial balls that nothing but the points has shrunk.

use crate::MethodInput;
use belvedere::Bounds;
use belvedere::cast::to_f32;
use belvedere::clean::CleanParams;
use belvedere::control::Control;
use belvedere::depth::{ItemBuffer, Profile, depth_map};
use belvedere::medial::{CarvedParams, MedialBalls, ShrinkMethod, ShrinkParams};
use belvedere::model::{BallParams, ModelParams, OrientBy, SceneModel};
use belvedere::normals::estimate::Neighborhood;
use belvedere::query::{BlockRule, MedialScene, Sight, UnprovenAs, Viewer, Visibility, query_points};
use belvedere::view::View;
use belvedere::{Mesh, Result};

/// Side of a pixel of the depth maps that the published method answers from, metres: half the spacing of usual airborne
/// scans, and the default of Belvedere's own maps.
const PIXEL_SIZE: f64 = 0.25;

/// How far a target may lie inside a ball and still count as visible where spheres are cut exactly, metres.
///
/// Balls stand out over noisy surfaces by about a decimetre, and sight lines meet surfaces at a slant. It is the bias
/// that `notes` on comparable scenes used for every point-based method; splats and voxels here have the same allowance.
pub const DEPTH_BIAS: f64 = 0.25;

/// Which balls are made, and how they hide targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MedialParams {
    /// Neighbours that make a normal, 3 to 256.
    pub neighbors: usize,
    /// How balls are made.
    pub making: BallParams,
    /// How lines of sight of parallel views are answered.
    pub parallel_views: ParallelViews,
    /// How balls block lines of sight.
    pub blocking: BlockRule,
}

/// How targets in a parallel view are answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParallelViews {
    /// From a depth map, as the paper does, with square pixels of a quarter of a metre.
    DepthMap,
    /// By exact lines of sight, as in all other views.
    Rays,
}

impl MedialParams {
    /// Peters, Ledoux & Biljecki 2015 as published: normals from six neighbours, masbcpp's angles and initial radius,
    /// the printed Algorithm 1 (a cone) and no bias.
    #[must_use]
    pub fn published() -> Self {
        Self {
            neighbors: 6,
            making: BallParams::Shrunk(ShrinkParams::angles()),
            parallel_views: ParallelViews::DepthMap,
            blocking: BlockRule { profile: Profile::PaperCone, bias: 0.0, shell: 0.0 },
        }
    }

    /// The same balls with their true surface, the sphere, cut exactly.
    #[must_use]
    pub fn published_with_spheres() -> Self {
        Self {
            parallel_views: ParallelViews::Rays,
            blocking: BlockRule { profile: Profile::Sphere, bias: DEPTH_BIAS, shell: 0.0 },
            ..Self::published()
        }
    }

    /// Jalba, Kustra & Telea 2013: the union of all medial balls of a dense cloud, none left out and none refused.
    /// Every ball shrinks until it is empty; normals from sixteen neighbours, since the source presumes good ones.
    #[must_use]
    pub fn unfiltered_union() -> Self {
        let method = ShrinkMethod::Angles { first_separation_angle: 0.0, next_separation_angle: 0.0 };
        Self {
            neighbors: 16,
            making: BallParams::Shrunk(ShrinkParams { method, ..ShrinkParams::angles() }),
            ..Self::published_with_spheres()
        }
    }

    /// Balls cut by what each pulse proves empty: what Belvedere does by default.
    #[must_use]
    pub fn carved() -> Self {
        let making = BallParams::Carved(CarvedParams::default());
        Self { neighbors: 16, making, blocking: BlockRule::carved(), ..Self::published_with_spheres() }
    }

    /// Balls of bounded penetration, cut down to half a metre: what Belvedere does without pulses, `--method tau`.
    #[must_use]
    pub fn cut_to_half_a_metre() -> Self {
        Self { neighbors: 16, making: BallParams::Shrunk(ShrinkParams::tau()), ..Self::published_with_spheres() }
    }
}

/// How the normals are turned outward.
#[derive(Clone, Copy)]
pub enum Outward<'a> {
    /// Towards the scanner; where it is unknown, upward.
    Survey,
    /// By a city model, as the paper does.
    Model(&'a Mesh),
}

/// A cloud as a union of its interior medial balls.
pub struct MedialBaseline {
    scene: MedialScene,
    balls: MedialBalls,
    bounds: [[f64; 3]; 2],
    params: MedialParams,
    /// The same scene with its pulses, where they are known.
    proving: Option<MedialScene>,
}

/// The scene model of a survey.
///
/// # Errors
/// Those of [`SceneModel::build`]; an empty cloud is one.
pub fn scene_model(survey: &MethodInput<'_>, outward: Outward<'_>, params: &MedialParams) -> Result<SceneModel> {
    let orient = match outward {
        Outward::Model(mesh) => OrientBy::Mesh(mesh.clone()),
        // carving fails without a scanner rather than assume one
        Outward::Survey if survey.scanner.is_empty() && matches!(params.making, BallParams::Shrunk(_)) => OrientBy::Up,
        Outward::Survey => OrientBy::ScannerOfEachPoint(survey.scanner.to_vec()),
    };
    // methods are compared on the same points
    let params = ModelParams::default()
        .with_clean(CleanParams::nothing())
        .with_neighborhood(Neighborhood::Fixed { k: params.neighbors })
        .with_orient(orient)
        .with_balls(params.making);
    Ok(SceneModel::build(survey.cloud, &params, &Control::none())?.0)
}

impl MedialBaseline {
    /// Shrinks the balls of a survey.
    ///
    /// # Errors
    /// As [`scene_model`].
    pub fn new(survey: &MethodInput<'_>, outward: Outward<'_>, params: &MedialParams) -> Result<Self> {
        let model = scene_model(survey, outward, params)?;
        let triangles = model.triangles().cloned();
        let proving = match model.pulses() {
            Some(_) => Some(model.scene(&params.blocking, UnprovenAs::Reported, &Control::none())?),
            None => None,
        };
        let made = Self::of_balls(survey, model.into_parts().balls, params)?;
        Ok(Self { scene: made.scene.with_triangles(triangles), proving, ..made })
    }

    /// The balls that block.
    #[must_use]
    pub fn scene(&self) -> &MedialScene {
        &self.scene
    }

    /// The balls themselves.
    #[must_use]
    pub fn balls(&self) -> &MedialBalls {
        &self.balls
    }

    /// Takes balls that were made of a survey's cloud before.
    ///
    /// # Errors
    /// [`belvedere::Error::NoPoints`] for an empty cloud.
    pub fn of_balls(survey: &MethodInput<'_>, balls: MedialBalls, params: &MedialParams) -> Result<Self> {
        let Some(Bounds { low, high }) = survey.cloud.bounds() else {
            return Err(belvedere::Error::NoPoints { what: "a union of balls needs a cloud".to_owned() });
        };
        let scene = MedialScene::new(&balls, &params.blocking)?;
        let bounds = [low.map(f64::from), high.map(f64::from)];
        Ok(Self { scene, balls, bounds, params: *params, proving: None })
    }
}

impl Visibility for MedialBaseline {
    fn probabilities(&self, viewer: Viewer<'_>, targets: &[[f32; 3]]) -> Result<Option<Vec<f32>>> {
        let proving = self.proving.as_ref();
        proving.map(|scene| scene.visible_probabilities(viewer, targets, &Control::none())).transpose()
    }

    fn seen_from<'a>(&'a self, viewer: Viewer<'a>) -> Result<Sight<'a>> {
        let (Viewer::Direction(to_viewer), ParallelViews::DepthMap) = (viewer, self.params.parallel_views) else {
            return self.scene.seen_from(viewer);
        };
        viewer.validate()?;
        let [low, high] = self.bounds;
        let view = View::parallel(to_viewer.map(|v| -v), low, high, PIXEL_SIZE)?;
        let map = depth_map(&self.balls, &view, self.params.blocking.profile, ItemBuffer::Without, &Control::none())?;
        let bias = to_f32(self.params.blocking.bias);
        Ok(Box::new(move |targets| Ok(query_points(&map, targets, bias))))
    }
}
