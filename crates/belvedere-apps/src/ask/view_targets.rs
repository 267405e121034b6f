//! Targets of one view: points, or the faces of a mesh, from the sun, along a direction, from a camera or all around.

use super::answers::{Answers, Ask};
use super::context::Context;
use super::depth_map::ViewFrom;
use super::how_sure::{HowSure, remark_from_ground};
use super::places::{Places, moved, other};
use super::scene::Scene;
use super::sections::{AnsweredBy, FacesSection, LinesSection, TargetsSection};
use super::viewer::{remark_on_inside, remark_on_outside, remark_on_targets_beside, remark_on_targets_inside};
use crate::targets::{Measure, MeshParams};
use belvedere_core::depth::{ItemBuffer, depth_map};
use belvedere_core::query::{
    Answer, AnswerCounts, BackFaces, BlockRule, CertifiedReport, MedialScene, MeshTargetParams, Scope, SeenArea,
    SurfacePieces, UnprovenAs, Viewer, query_points, seen_faces, seen_in_all,
};
use belvedere_data::control::Control;
use belvedere_data::report::{percent, rounded};
use belvedere_data::view::View;
use belvedere_data::{Mesh, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// Visibility of the targets of one view.
///
/// Lines of sight decide. A parallel view of balls that are not carved is answered by its depth map, as in the paper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ViewTargetsQuestion {
    /// Position and projection of the view; must be set by whoever reads a question from text.
    #[serde(skip)]
    pub from: Option<ViewFrom>,
    /// True if targets outside the picture of a parallel view have no answer, as with a camera. False if the picture
    /// sets only the direction. Default: false.
    pub within_picture: bool,
    /// Tolerance of points, metres: their depth behind a depth map, or the length of a line inside balls. `None` for
    /// that of the map, or of the scene.
    pub bias: Option<f32>,
    /// Treatment of unproven answers; `None` to report them if pulses are known.
    pub unproven: Option<UnprovenAs>,
    /// Request for the certainty of answers of points.
    pub how_sure: HowSure,
    /// Treatment of faces of a mesh that are turned away.
    pub back_faces: BackFaces,
}

/// Results for points or faces.
#[derive(Clone, Debug, Default)]
pub struct ViewTargetsResults {
    /// The answers of points, with unproven ones counted as requested.
    pub answers: Vec<Answer>,
    /// Visible area of each face of a mesh.
    pub faces: Vec<SeenArea>,
}

/// Views of one viewer.
struct Views {
    views: Vec<View>,
    scope: Scope,
    eye: Option<[f64; 3]>,
    viewer: Viewer<'static>,
    /// True for a parallel picture that has a plane of its own.
    is_fixed: bool,
}

impl Views {
    fn new(from: &ViewFrom, within_picture: bool) -> Result<Self> {
        let eye = from.eye();
        let (views, is_picture) = match *from {
            ViewFrom::View(view) => (vec![view], eye.is_some() || within_picture),
            ViewFrom::Panorama { eye, width } => (View::panorama(eye, width)?.to_vec(), false),
        };
        let towards = views[0].frame.forward.map(|v| -v);
        let viewer = eye.map_or(Viewer::Direction(towards), Viewer::Eye);
        let scope = if is_picture { Scope::View } else { Scope::Viewer };
        Ok(Self { views, scope, eye, viewer, is_fixed: within_picture })
    }

    /// The views on targets. One that fits the scene has no plane of its own that a target could lie before.
    fn on(&self, targets: &[[f32; 3]]) -> Vec<View> {
        let moved = |view: &View| if self.is_fixed { *view } else { view.moved_before(targets) };
        self.views.iter().map(moved).collect()
    }
}

impl ViewTargetsQuestion {
    fn settled_as(&self) -> UnprovenAs {
        self.unproven.unwrap_or(UnprovenAs::Reported)
    }

    /// Obstacles to lines of sight of points.
    fn blockers(&self, scene: &Scene, control: &Control<'_>) -> Result<Arc<MedialScene>> {
        // probabilities need the pulses
        let unproven = if self.how_sure.is_wanted() { UnprovenAs::Reported } else { self.settled_as() };
        match self.bias {
            None => scene.blockers(unproven, control),
            Some(bias) => {
                let rule = BlockRule { bias: f64::from(bias), ..*scene.rule() };
                Ok(Arc::new(scene.model().scene(&rule, unproven, control)?))
            }
        }
    }

    fn points(
        &self,
        targets: &[[f32; 3]],
        views: &Views,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Answers<ViewTargetsResults>> {
        let is_by_lines = scene.model().is_carved() || views.eye.is_some();
        let (answers, measures, by) = match is_by_lines {
            true => self.by_lines_of_sight(targets, views, scene, context, control)?,
            false => {
                let (answers, by) = self.by_depth_map(targets, &views.on(targets)[0], scene, control)?;
                (answers, Vec::new(), by)
            }
        };
        let section = TargetsSection::of(&answers, self.settled_as(), by);
        context.add(remark_on_outside(section.outside_cloud, answers.len(), "targets"));
        context.add(remark_on_targets_beside(scene.model().coverage().as_ref(), targets, "targets"));
        context.add(remark_on_targets_inside(section.inside_obstacle, answers.len()));
        section.summarise(context);
        context.report.answers = Some(section);
        let answers = answers.into_iter().map(|answer| self.settled_as().settle(answer)).collect();
        Ok(Answers::new(ViewTargetsResults { answers, ..ViewTargetsResults::default() }, measures))
    }

    /// Answers from the depth map of a parallel view, as the paper has them.
    fn by_depth_map(
        &self,
        targets: &[[f32; 3]],
        view: &View,
        scene: &Scene,
        control: &Control<'_>,
    ) -> Result<(Vec<Answer>, AnsweredBy)> {
        // by the CPU: pictures of other devices have a tolerance, answers have none
        let (balls, profile) = (scene.model().balls(), scene.rule().profile);
        let map =
            control.stage("drawing depth map", 0, || depth_map(balls, view, profile, ItemBuffer::Without, control))?;
        let bias = self.bias.unwrap_or_else(|| map.default_depth_bias());
        let mut answers = control.stage("querying", 0, || Ok(query_points(&map, targets, bias)))?;
        if let Some(coverage) = scene.model().coverage() {
            coverage.mark_outside(Viewer::Direction(view.frame.forward.map(|v| -v)), targets, &mut answers);
        }
        Ok((answers, AnsweredBy::DepthMap { method: "depth map", depth_bias_m: rounded(f64::from(bias), 4) }))
    }

    /// Answers by exact lines of sight, separated into proven and unproven by pulses where these are known; and their
    /// certainty.
    fn by_lines_of_sight(
        &self,
        targets: &[[f32; 3]],
        views: &Views,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<(Vec<Answer>, Vec<Measure>, AnsweredBy)> {
        let blockers = self.blockers(scene, control)?;
        let Views { scope, eye, viewer, .. } = *views;
        context.add(eye.and_then(|eye| remark_on_inside(&blockers, eye, "eye")));
        let (answers, report) = control.stage("querying", 0, || {
            let (mut answers, report) = blockers.visible_in_views(&views.on(targets), scope, targets, control)?;
            blockers.mark_inside_obstacles(viewer, targets, &mut answers, control).map(|()| (answers, report))
        })?;
        let by = AnsweredBy::of_lines(&blockers, eye, report);
        if !self.how_sure.is_wanted() {
            return Ok((answers, Vec::new(), by));
        }
        context.add(remark_from_ground(&blockers));
        let mut probabilities = control.stage("computing probabilities", targets.len(), || {
            blockers.visible_probabilities(viewer, targets, control)
        })?;
        // a target beside the picture has no answer, and no probability
        for (probability, _) in probabilities.iter_mut().zip(&answers).filter(|(_, of)| **of == Answer::OutsideView) {
            *probability = f32::NAN;
        }
        let uncertain = self.how_sure.uncertain(&probabilities, |row| answers[row] == Answer::Unproven)?;
        let measures = self.how_sure.measures(probabilities, uncertain, "");
        Ok((answers, measures, by))
    }

    fn faces(
        &self,
        (mesh, params): (&Mesh, &MeshParams),
        views: &Views,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Answers<ViewTargetsResults>> {
        let unproven = self.settled_as();
        let blockers = scene.blockers(unproven, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        context.add(views.eye.and_then(|eye| remark_on_inside(&blockers, eye, "eye")));
        let surface = control.stage("sampling mesh", 0, || {
            SurfacePieces::of_mesh(mesh, scene.frame().origin, params.spacing, params.seed)
        })?;
        let on_faces = MeshTargetParams { back_faces: self.back_faces, lift: params.lift };
        let faces = control.stage("querying", 0, || {
            seen_faces(&surface, views.viewer, &on_faces, |places| {
                let (answers, _) = blockers.visible_in_views(&views.on(places), views.scope, places, control)?;
                Ok(answers.into_iter().map(|answer| unproven.settle(answer)).collect())
            })
        })?;
        let section = FacesSection::of(&faces, &surface, params.spacing);
        section.summarise(context);
        context.report.faces = Some(section);
        let places: Vec<[f32; 3]> = surface.pieces.iter().map(|piece| piece.place).collect();
        let coverage = scene.model().coverage();
        let outside = coverage.map_or(0, |coverage| coverage.outside_count(&places));
        let things = "sample points of the mesh";
        context.add(remark_on_outside(outside, places.len(), things));
        context.add(remark_on_targets_beside(coverage.as_ref(), &places, things));
        Ok(Answers::new(ViewTargetsResults { faces, ..ViewTargetsResults::default() }, Vec::new()))
    }
}

impl Ask for ViewTargetsQuestion {
    type Found = ViewTargetsResults;

    fn check(&self) -> Result<()> {
        self.how_sure.check()
    }

    fn answer(
        &self,
        scene: &Scene,
        places: &Places,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Answers<ViewTargetsResults>> {
        let from = ViewFrom::given(self.from)?;
        if self.unproven.is_some() {
            scene.check_proof()?;
        }
        context.add(from.remark(scene.model().coverage().as_ref()));
        context.report.view = Some(from.section());
        let views = Views::new(&from, self.within_picture)?;
        // targets outside the cloud have an answer of their own
        let targets = match places {
            Places::Mesh(mesh, params) => return self.faces((mesh, params), &views, scene, context, control),
            Places::Points(positions, _) => Cow::Borrowed(positions),
            Places::Own(_) => Cow::Borrowed(&scene.cloud().positions),
            Places::Cloud(cloud, _) if cloud.frame == *scene.frame() => Cow::Borrowed(&cloud.positions),
            Places::Cloud(cloud, _) => Cow::Owned(moved(cloud, scene)?),
            _ => return other(Parameter::Targets, "neither points nor a mesh", "points or a mesh"),
        };
        self.how_sure.check_scene(scene)?;
        self.points(&targets, &views, scene, context, control)
    }
}

impl AnsweredBy {
    fn of_lines(blockers: &MedialScene, eye: Option<[f64; 3]>, report: Option<CertifiedReport>) -> Self {
        let (rule, proof) = (blockers.params(), blockers.proof());
        let by_map = report.map(|report| percent(report.settled_count, report.target_count));
        Self::LinesOfSight {
            depth_bias_m: rounded(rule.bias, 4),
            shell_m: rounded(rule.shell, 4),
            balls_around_eye: eye.map(|eye| blockers.around_eye_count(eye)),
            proof_distance_m: proof.map(|proof| rounded(proof.nearness(), 3)),
            max_unproven_length_m: proof.map(|proof| rounded(proof.tolerance(), 3)),
            method: if by_map.is_some() { "certified depth map and lines of sight" } else { "lines of sight" },
            decided_by_map_percent: by_map,
        }
    }
}

impl TargetsSection {
    fn of(answers: &[Answer], unproven: UnprovenAs, by: AnsweredBy) -> Self {
        let settled: Vec<Answer> = answers.iter().map(|&answer| unproven.settle(answer)).collect();
        let [raw, counts] = [answers, &settled].map(AnswerCounts::of);
        Self {
            targets: answers.len(),
            visible: counts.visible,
            unproven: (unproven == UnprovenAs::Reported).then_some(raw.unproven),
            blocked: counts.blocked,
            unproven_within: (unproven == UnprovenAs::Blocked).then_some(raw.unproven),
            outside_view: counts.outside_view,
            outside_cloud: counts.outside_cloud,
            inside_obstacle: counts.inside_obstacle,
            visible_percent: percent(counts.visible, answers.len()),
            by,
        }
    }

    fn summarise(&self, context: &mut Context) {
        let Self { targets, visible_percent, blocked, inside_obstacle, .. } = self;
        context.headline(format!("visible {visible_percent} % of {targets} targets"));
        context.headline(format!("blocked: {blocked} targets"));
        if let Some(unproven) = self.unproven {
            context.headline(format!("unproven: {unproven} targets"));
        }
        context.headline(format!("inside an obstacle: {inside_obstacle} targets"));
    }
}

impl FacesSection {
    fn of(faces: &[SeenArea], surface: &SurfacePieces, spacing: f64) -> Self {
        let all = seen_in_all(faces);
        Self {
            count: faces.len(),
            spacing_m: rounded(spacing, 4),
            sample_points: surface.pieces.len(),
            area_m2: rounded(all.area, 2),
            visible_m2: rounded(all.visible, 2),
            standard_error_m2: rounded(all.standard_error(), 2),
            visible_percent: rounded(100.0 * all.visible_share(), 2),
            unproven_m2: rounded(all.unproven, 2),
        }
    }

    fn summarise(&self, context: &mut Context) {
        let Self { count, area_m2, visible_m2, standard_error_m2, visible_percent, unproven_m2, .. } = self;
        context.headline(format!(
            "visible {visible_percent} % of {area_m2} m2 on {count} faces ({visible_m2} m2, standard error \
             {standard_error_m2} m2)"
        ));
        context.headline(format!("unproven: {unproven_m2} m2"));
    }
}
