//! Exact answers at the speed of a depth map: targets that bounds of depth settle, and lines of sight for the rest.

use super::view_line::{LineEnd, LineInView, line_in_view, viewer_of};
use super::{Answer, MedialScene};
use crate::blocking::Profile;
use crate::depth::DepthBounds;
use crate::ray_index::Ray;
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::view::{Projection, View};
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;

/// Targets handed to a thread at once.
const CHUNK: usize = 1024;
/// Depth beyond which bounds settle nothing, metres: there f64 itself errs by as much as bounds allow for.
const FARTHEST_SETTLED: f64 = 1e7;

/// Scope of the answers of a [`CertifiedMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Answers of [`MedialScene::query_view`]: the picture and its limits of depth count, and lines of sight end there.
    View,
    /// Answers of [`MedialScene::answer`] for every target, as `visible` returns them for the viewer of the view: an
    /// eye, or a viewer infinitely far away. The picture only saves lines of sight.
    Viewer,
}

/// Bounds of depth for each pixel of one view, or of several from one eye, over the balls of a [`MedialScene`]. A
/// target nearer than the lower bound of its pixel is visible, one farther than the upper bound is blocked; only those
/// between need a line of sight. Every answer is that of the scene; the resolution changes the cost only.
///
/// # Source
/// Bounds of the depth within a pixel serve as in Williams 1978, but from both sides; the proof is on the project's
/// page on depth maps.
pub struct CertifiedMap<'a> {
    scene: &'a MedialScene,
    bounds: Vec<DepthBounds>,
    scope: Scope,
}

/// Counts of answers of a [`CertifiedMap`] by how they were found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CertifiedReport {
    /// Targets queried.
    pub target_count: usize,
    /// Number settled by a bound, or outside the view.
    pub settled_count: usize,
}

/// Minimum number of targets for each pixel for which bounds cost less than the lines of sight that they save. A pixel
/// costs 0.4 to 1.2 µs, and a target saves 0.2 to 0.6 (a town of 700 000 balls on two cores).
const TARGETS_PER_PIXEL: usize = 5;

impl MedialScene {
    /// Returns the answer for each of `targets`, (M, 3) local metres, in `views` of one eye or of one parallel viewer.
    /// With more than a few targets a pixel it uses a [`CertifiedMap`] and returns its report, otherwise a line of
    /// sight each. The answers are the same.
    ///
    /// # Errors
    /// As [`CertifiedMap::new`], the paper's cone excepted, which lines of sight answer.
    pub fn visible_in_views(
        &self,
        views: &[View],
        scope: Scope,
        targets: &[[f32; 3]],
        control: &Control<'_>,
    ) -> Result<(Vec<Answer>, Option<CertifiedReport>)> {
        check_views(views)?;
        let pixel_count: usize = views.iter().map(|view| view.size_px[0] * view.size_px[1]).sum();
        if self.params().profile == Profile::Sphere && targets.len() / TARGETS_PER_PIXEL > pixel_count {
            let (answers, report) = CertifiedMap::new(self, views, scope, control)?.answers(targets, control)?;
            return Ok((answers, Some(report)));
        }
        let answer = |_, target: [f32; 3]| Some(self.answer_of(&line_of_sight(views.iter(), scope, target)?));
        let answers = self.answer_by(targets, control, answer)?;
        let answers = match views.first() {
            Some(view) => self.marked(viewer_of(view), targets, answers),
            None => answers,
        };
        Ok((answers, None))
    }
}

/// Refuses views of no or of several viewers.
fn check_views(views: &[View]) -> Result<()> {
    let invalid = |parameter, value: String, expected| Err(Error::invalid(parameter, value, expected));
    let Some((first, others)) = views.split_first() else {
        return invalid(Parameter::View, "missing".to_owned(), "given");
    };
    match others.iter().find(|view| !(view.is_central() && first.is_central() && view.frame.eye == first.frame.eye)) {
        None => Ok(()),
        Some(other) => {
            let eyes = format!("{:?} and {:?}", first.frame.eye, other.frame.eye);
            invalid(Parameter::View, eyes, "from one eye, where there are several")
        }
    }
}

/// The line of sight of a target in the first of `views` that has one.
fn line_of_sight<'v>(mut views: impl Iterator<Item = &'v View>, scope: Scope, target: [f32; 3]) -> Option<LineInView> {
    match scope {
        Scope::View => views.find_map(|view| line_in_view(view, target)),
        Scope::Viewer => views.next().and_then(|view| viewer_of(view).sight(0, target)).map(LineInView::to_viewer),
    }
}

impl<'a> CertifiedMap<'a> {
    /// Draws the bounds of `scene` for `views`: one, or several from the same eye of which a target is looked up in the
    /// first that shows it, such as [`View::panorama`].
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for no view, for several that do not look from one eye, for balls with
    /// [`Profile::PaperCone`], and as [`depth_bounds`](crate::depth::depth_bounds).
    pub fn new(scene: &'a MedialScene, views: &[View], scope: Scope, control: &Control<'_>) -> Result<Self> {
        check_views(views)?;
        let params = scene.params();
        if params.profile != Profile::Sphere {
            return Err(Error::invalid(
                Parameter::BallProfile,
                "the paper's cone",
                "the sphere, for certified answers",
            ));
        }
        let bounds_of = |view: &View| {
            let start = match scope {
                Scope::View => view.limits()[0],
                Scope::Viewer if view.is_central() => 0.0,
                Scope::Viewer => f64::NEG_INFINITY,
            };
            scene.prepared()?.depth(view, start, control)
        };
        Ok(Self { scene, bounds: views.iter().map(bounds_of).collect::<Result<_>>()?, scope })
    }

    /// The bounds of each view.
    #[must_use]
    pub fn bounds(&self) -> &[DepthBounds] {
        &self.bounds
    }

    /// The answer for each of `targets`, (M, 3) local metres, in their order, and how many were settled without a line
    /// of sight.
    ///
    /// # Errors
    /// [`Error::Cancelled`].
    pub fn answers(&self, targets: &[[f32; 3]], control: &Control<'_>) -> Result<(Vec<Answer>, CertifiedReport)> {
        let mut answers = vec![Answer::OutsideView; targets.len()];
        let settled_count = answers
            .par_chunks_mut(CHUNK)
            .zip(targets.par_chunks(CHUNK))
            .map(|(answers, targets)| {
                control.check()?;
                let mut settled = 0;
                for (answer, &target) in answers.iter_mut().zip(targets) {
                    let way;
                    (*answer, way) = self.answer(target);
                    settled += usize::from(way == BoundCheck::Settled);
                }
                Ok(settled)
            })
            .sum::<Result<usize>>()?;
        if let Some(bounds) = self.bounds.first() {
            answers = self.scene.marked(viewer_of(&bounds.view), targets, answers);
        }
        Ok((answers, CertifiedReport { target_count: targets.len(), settled_count }))
    }

    fn answer(&self, target: [f32; 3]) -> (Answer, BoundCheck) {
        let line = line_of_sight(self.bounds.iter().map(|bounds| &bounds.view), self.scope, target);
        let Some(line) = line else { return (Answer::OutsideView, BoundCheck::Settled) };
        let bias = self.scene.params().bias;
        // a bias below zero lets balls behind an eye block, and one above lets those just before it block nothing
        let Ray { origin, direction, ranges: [_, range] } = line.sight;
        let is_eye = line.end == LineEnd::Viewer && range.is_finite();
        match self.bounds.iter().find_map(|bounds| self.bracket(bounds, target)) {
            Some((depth, [lower, _])) if depth < lower && (bias >= 0.0 || !is_eye) => {
                (self.scene.answer_unblocked(origin, direction, range), BoundCheck::Settled)
            }
            // before its surface a target may lie in the shell of a ball that reaches past it
            Some((depth, [_, upper])) if depth > upper && bias >= 0.0 && (upper > bias || !is_eye) => {
                (Answer::Blocked, BoundCheck::Settled)
            }
            _ => (self.scene.answer_of(&line), BoundCheck::ByLineOfSight),
        }
    }

    /// The depth of a target less the bias, and the bounds of its pixel, where the picture shows it.
    fn bracket(&self, bounds: &DepthBounds, target: [f32; 3]) -> Option<(f64, [f64; 2])> {
        let view = &bounds.view;
        let [x, y, depth] = view.project(target)?;
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        // bounds are ranges in views from an eye
        let depth = match view.projection {
            Projection::Perspective { .. } => {
                view.frame.view_from_local(target).map(|v| v * v).iter().sum::<f64>().sqrt()
            }
            _ => depth,
        };
        let (column, row) = (to_index(x), to_index(y));
        let bracket = bounds.bounds.get(column, row)?.map(f64::from);
        (depth.abs() < FARTHEST_SETTLED).then_some((depth - self.scene.params().bias, bracket))
    }
}

/// Result of comparing a target with the bounds.
#[derive(Clone, Copy, PartialEq, Eq)]
enum BoundCheck {
    Settled,
    ByLineOfSight,
}
