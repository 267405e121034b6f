//! The scene that questions are put to: a model with its cloud, and derived data that take long to make and several
//! questions need.

use super::context::Context;
pub use super::known_ground::KnownGround;
use super::remark::Remark;
use super::survey_parts::{SurveyParts, needs_whole};
use super::terrain_heights::{remark_on_ground_cloud, remark_on_terrain};
use super::viewer::remark_on_doubt;
use crate::horizon::convergence;
use belvedere_core::ground::{Ground, GroundBySquares, GroundParams, GroundPoints, MapGrid};
use belvedere_core::model::SceneModel;
use belvedere_core::query::{BlockRule, MedialScene, UnprovenAs};
use belvedere_core::strips::move_strips;
use belvedere_data::contradiction::{AREA_OF_USE, GROUND_ELSEWHERE};
use belvedere_data::control::Control;
use belvedere_data::crs::CrsKind;
use belvedere_data::crs::evidence::{CONTRADICTION_DISTANCE, distance_in_words};
use belvedere_data::frame::{Bounds, Frame};
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, PointCloud, Result};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A model with the points that it was made from, and data that questions share: made when first needed, and kept.
pub struct Scene {
    model: SceneModel,
    /// In the frame of the model; without points for a ball file alone.
    cloud: Arc<PointCloud>,
    /// The points that show the ground.
    ground_cloud: Arc<PointCloud>,
    rule: BlockRule,
    proving: OnceResult<MedialScene>,
    plain: OnceResult<MedialScene>,
    without_vegetation: OnceResult<MedialScene>,
    ground: Mutex<MadeGround>,
    ground_store: Option<Arc<dyn GroundStore>>,
    /// Obstacles of a survey of which only parts are in memory; the model has none.
    parts: Option<Arc<dyn SurveyParts>>,
}

/// Location of a scene, as suns and norths need it.
#[derive(Clone, Copy, Debug)]
pub struct Whereabouts<'a> {
    /// Frame of local coordinates.
    pub frame: &'a Frame,
    /// The box around the points.
    pub bounds: Bounds,
    /// True if terrain beyond the cloud counts.
    pub has_far_terrain: bool,
}

impl Whereabouts<'_> {
    /// The middle on the map, local metres.
    #[must_use]
    pub fn middle(&self) -> [f64; 2] {
        let (low, high) = self.bounds.corners();
        [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]))
    }

    /// Azimuth of grid north from true north at a local place, clockwise, radians; `None` where true north is unknown.
    #[must_use]
    pub fn convergence_at(&self, place: [f64; 2]) -> Option<f64> {
        convergence(&self.frame.crs, [0, 1].map(|axis| self.frame.origin[axis] + place[axis])).ok()
    }

    /// Adds remarks on evidence against the reference system.
    pub fn remark(&self, context: &mut Context) {
        let (crs, origin) = (&self.frame.crs, self.frame.origin);
        context.add(remark_on_doubt(crs.doubt.as_deref()));
        let middle = self.middle();
        let of_file = [0, 1].map(|axis| (origin[axis] + middle[axis]) / crs.metres_per_unit);
        let distance = crs.distance_to_area_of_use(of_file).filter(|&distance| distance > OUTSIDE_AREA);
        context.add(distance.and_then(|distance| {
            let how_far = if distance.is_finite() { distance_in_words(distance) } else { "far".to_owned() };
            let text = format!("the scene lies {how_far} outside of the area of use of {}", crs.describe());
            let found = AREA_OF_USE.found(text);
            let remark = Remark::of_contradiction(match distance.is_finite() {
                true => found.with("distance_km", rounded(distance / 1000.0, 1)),
                false => found,
            });
            // countries use zones beyond their edges
            if distance > CONTRADICTION_DISTANCE { remark } else { remark.map(Remark::into_note) }
        }));
    }

    /// Returns the addition to titles if far terrain counts.
    pub(super) fn far_in_words(&self) -> &'static str {
        if self.has_far_terrain { ", with far terrain" } else { "" }
    }
}

/// Boxes of areas of use are rounded, metres.
const OUTSIDE_AREA: f64 = 2e3;

/// Maximum number of cells of a ground that is not made from the whole cloud once more: 25 times the need of one place.
const FEW_CELLS: usize = 40_000;

/// The ground that was made so far.
#[derive(Default)]
struct MadeGround {
    last: Option<(MapGrid, GroundPoints, Arc<KnownGround>)>,
    /// True if a ground of few cells was made: the next one finds all its input sorted.
    has_few: bool,
    by_squares: Option<GroundBySquares>,
}

/// Keeps ground for later scenes of the same cloud.
pub trait GroundStore: Send + Sync {
    /// The ground on a grid, if it was kept.
    fn find(&self, grid: &MapGrid, params: &GroundParams) -> Option<KnownGround>;

    /// Keeps ground that was made. Ground that cannot be kept is made again.
    fn keep(&self, params: &GroundParams, known: &KnownGround);

    /// The index of the ground for grids of few cells, if it was kept.
    fn find_index(&self, params: &GroundParams) -> Option<GroundBySquares>;

    /// Keeps the index of the ground for grids of few cells.
    fn keep_index(&self, index: &GroundBySquares);
}

/// Something that is made when first needed, and can fail.
struct OnceResult<T>(Mutex<Option<Arc<T>>>);

impl<T> Default for OnceResult<T> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<T> OnceResult<T> {
    fn get(&self, make: impl FnOnce() -> Result<T>) -> Result<Arc<T>> {
        let mut kept = locked(&self.0);
        if let Some(made) = &*kept {
            return Ok(Arc::clone(made));
        }
        let made = Arc::new(make()?);
        *kept = Some(Arc::clone(&made));
        Ok(made)
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Scene {
    /// A model, and its cloud in the same frame; a cloud without points for a ball file alone. Balls block by the rule
    /// of the model.
    ///
    /// Heights of flight lines that the model fitted to each other are those of the cloud, too.
    #[must_use]
    pub fn new(model: SceneModel, mut cloud: Arc<PointCloud>) -> Self {
        let findings = model.findings();
        if !(findings.moved_strips().is_empty() || cloud.is_empty()) {
            move_strips(Arc::make_mut(&mut cloud), findings.moved_strips());
        }
        Self::of_fitted(model, cloud)
    }

    /// Creates a scene as [`Scene::new`], for the cloud of another scene, whose heights are fitted already.
    #[must_use]
    pub fn of_fitted(model: SceneModel, cloud: Arc<PointCloud>) -> Self {
        Self {
            rule: model.rule(),
            ground_cloud: Arc::clone(&cloud),
            model,
            cloud,
            proving: OnceResult::default(),
            plain: OnceResult::default(),
            without_vegetation: OnceResult::default(),
            ground: Mutex::default(),
            ground_store: None,
            parts: None,
        }
    }

    /// Creates a scene of a survey of which only parts are in memory. `model` has its frame, its bounds and the terrain
    /// beyond it, and no balls.
    #[must_use]
    pub fn in_parts(model: SceneModel, parts: Arc<dyn SurveyParts>) -> Self {
        let cloud = Arc::new(PointCloud::in_frame(model.frame().clone()));
        Self { parts: Some(parts), ..Self::of_fitted(model, cloud) }
    }

    /// Returns the obstacles of a survey of which only parts are in memory.
    #[must_use]
    pub fn parts(&self) -> Option<&Arc<dyn SurveyParts>> {
        self.parts.as_ref()
    }

    /// This, with the ground of another cloud in the same frame.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for a cloud that lies beside the scene on the map.
    pub fn with_ground_of(self, ground_cloud: Arc<PointCloud>) -> Result<Self> {
        if let Some(own) = ground_cloud.bounds() {
            let of_scene = self.model.bounds();
            let gap =
                |axis: usize| f64::from((own.low[axis] - of_scene.high[axis]).max(of_scene.low[axis] - own.high[axis]));
            let distance = gap(0).max(0.0).hypot(gap(1).max(0.0));
            if GROUND_ELSEWHERE.is_exceeded_by(distance) {
                return Err(Error::invalid(
                    Parameter::Ground,
                    format!("a cloud that lies {} beside the scene", distance_in_words(distance)),
                    "a cloud of the same place, in the coordinates of the scene",
                ));
            }
        }
        Ok(Self { ground_cloud, ground: Mutex::default(), ground_store: None, ..self })
    }

    /// This, with a store for the ground of its cloud.
    #[must_use]
    pub fn with_ground_store(self, store: Option<Arc<dyn GroundStore>>) -> Self {
        Self { ground_store: store, ..self }
    }

    /// This, with balls that block by another rule.
    #[must_use]
    pub fn with_rule(self, rule: BlockRule) -> Self {
        let (proving, plain, without_vegetation) =
            (OnceResult::default(), OnceResult::default(), OnceResult::default());
        Self { rule, proving, plain, without_vegetation, ..self }
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &SceneModel {
        &self.model
    }

    /// The cloud; without points for a ball file alone.
    #[must_use]
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// The points that show the ground.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where there are none.
    pub fn ground_cloud(&self) -> Result<&Arc<PointCloud>> {
        if self.ground_cloud.is_empty() {
            let expected = "shown by points, and a ball file has none: give its cloud";
            return Err(Error::invalid(Parameter::Ground, "unknown", expected));
        }
        Ok(&self.ground_cloud)
    }

    /// Returns the points that show the ground of a grid, and what covers it.
    ///
    /// # Errors
    /// Those of [`Scene::ground_cloud`] and [`SurveyParts::points_over`].
    pub(super) fn points_over(&self, grid: &MapGrid, control: &Control<'_>) -> Result<Arc<PointCloud>> {
        match &self.parts {
            Some(parts) => parts.points_over(grid, control),
            None => self.ground_cloud().cloned(),
        }
    }

    /// Returns the frame of local coordinates. A scene without a reference system has that of the cloud that shows its
    /// ground.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        let frame = self.model.frame();
        if frame.crs.kind == CrsKind::Unknown { &self.ground_cloud.frame } else { frame }
    }

    /// Returns the rule by which balls block.
    #[must_use]
    pub fn rule(&self) -> &BlockRule {
        &self.rule
    }

    /// Returns the obstacles to lines of sight. Pulses are left out if nothing depends on them.
    ///
    /// # Errors
    /// Those of [`SceneModel::scene`], and [`Error::InvalidParameter`] for a survey of which only parts are in memory.
    pub fn blockers(&self, unproven: UnprovenAs, control: &Control<'_>) -> Result<Arc<MedialScene>> {
        self.check_whole()?;
        let kept = if unproven == UnprovenAs::Visible { &self.plain } else { &self.proving };
        kept.get(|| self.model.scene(&self.rule, unproven, control))
    }

    /// Returns the obstacles to lines of sight without vegetation.
    ///
    /// # Errors
    /// Those of [`SceneModel::scene_without_vegetation`].
    pub fn without_vegetation(&self, control: &Control<'_>) -> Result<Arc<MedialScene>> {
        self.without_vegetation.get(|| self.model.scene_without_vegetation(&self.rule, control))
    }

    /// The ground on a grid. The last one is kept. From the second grid of few cells on, so are the points that show
    /// the ground, by squares; from the first one on where a store keeps them.
    ///
    /// # Errors
    /// Those of [`Scene::ground_cloud`] and [`Ground::of_cloud`].
    pub fn ground(&self, grid: MapGrid, points: GroundPoints, control: &Control<'_>) -> Result<Arc<KnownGround>> {
        let mut made = locked(&self.ground);
        if let Some((_, _, known)) = made.last.as_ref().filter(|(of, from, _)| *of == grid && *from == points) {
            return Ok(Arc::clone(known));
        }
        let cloud = &self.points_over(&grid, control)?;
        let points = match &self.parts {
            Some(parts) if points == GroundPoints::Auto => parts.ground_points(),
            _ => points,
        };
        let params = GroundParams { points, ..GroundParams::default() };
        let has_few = grid.len() <= FEW_CELLS;
        let store = self.ground_store.as_deref();
        if has_few && (made.has_few || store.is_some()) {
            let last = made.by_squares.take().filter(|kept| *kept.params() == params);
            let by_squares = match last.or_else(|| store.and_then(|store| store.find_index(&params))) {
                Some(kept) => kept,
                None => {
                    let new = || GroundBySquares::new(cloud, &params, control);
                    let index = control.stage("computing ground", 0, new)?;
                    store.into_iter().for_each(|store| store.keep_index(&index));
                    index
                }
            };
            let (ground, report) = made.by_squares.insert(by_squares).make(grid, control)?;
            return Ok(Arc::new(KnownGround { ground, report }));
        }
        let known = match store.and_then(|store| store.find(&grid, &params)) {
            Some(known) => known,
            None => {
                let (ground, report) =
                    control.stage("computing ground", 0, || Ground::of_cloud(cloud, grid, &params, control))?;
                let known = KnownGround { ground, report };
                store.into_iter().for_each(|store| store.keep(&params, &known));
                known
            }
        };
        let known = Arc::new(known);
        made.has_few |= has_few;
        made.last = Some((grid, points, Arc::clone(&known)));
        Ok(known)
    }

    /// Refuses surveys of which only parts are in memory.
    pub(super) fn check_whole(&self) -> Result<()> {
        if self.parts.is_none() { Ok(()) } else { Err(needs_whole()) }
    }

    /// Returns true if pulses are known.
    pub(super) fn has_pulses(&self) -> bool {
        match &self.parts {
            Some(parts) => parts.proves(),
            None => self.model.pulses().is_some(),
        }
    }

    /// Refuses scenes whose pulses are unknown, where the user sets how unproven answers count.
    pub(super) fn check_proof(&self) -> Result<()> {
        self.check_pulses(Parameter::UnprovenAs)
    }

    /// Refuses scenes whose pulses are unknown, where a parameter needs them.
    pub(super) fn check_pulses(&self, parameter: Parameter) -> Result<()> {
        if self.has_pulses() {
            return Ok(());
        }
        Err(Error::invalid(
            parameter,
            "given",
            "left out: it needs pulses, from a cloud with known scanner positions or an .npz ball file of such a cloud",
        ))
    }

    /// A warning where far terrain and the scene disagree on heights.
    pub(super) fn remark_on_terrain(&self) -> Option<Remark> {
        let grid = self.model.far_terrain().grid()?;
        remark_on_terrain(grid, self.tops(), self.model.frame().origin[2])
    }

    /// A warning where the scene and another cloud that shows its ground disagree on heights.
    pub(super) fn remark_on_ground_cloud(&self) -> Option<Remark> {
        let is_another = !self.ground_cloud.is_empty() && !Arc::ptr_eq(&self.ground_cloud, &self.cloud);
        if is_another { remark_on_ground_cloud(&self.ground_cloud.positions, self.tops()) } else { None }
    }

    /// Places on surfaces: tops of balls, which lie in the surface where a ball is in the ground.
    fn tops(&self) -> impl ExactSizeIterator<Item = [f64; 3]> {
        let balls = self.model.balls();
        let top = |(center, radius): (&[f32; 3], &f32)| {
            let [x, y, z] = center.map(f64::from);
            [x, y, z + f64::from(*radius)]
        };
        balls.centers.iter().zip(&balls.radii).map(top)
    }

    /// Returns its location.
    #[must_use]
    pub fn whereabouts(&self) -> Whereabouts<'_> {
        let has_far_terrain = !self.model.far_terrain().is_empty();
        Whereabouts { frame: self.frame(), bounds: self.model.bounds(), has_far_terrain }
    }

    /// The middle of the scene on the map, local metres.
    #[must_use]
    pub fn middle(&self) -> [f64; 2] {
        self.whereabouts().middle()
    }

    /// Azimuth of grid north from true north at a local place, clockwise, radians; `None` where true north is unknown.
    #[must_use]
    pub fn convergence_at(&self, place: [f64; 2]) -> Option<f64> {
        self.whereabouts().convergence_at(place)
    }
}
