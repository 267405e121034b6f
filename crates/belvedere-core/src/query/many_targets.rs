//! Many targets of one viewer: the way of answering follows from how many there are.

use super::backend::Viewers;
use super::certified::{CertifiedMap, Scope};
use super::target_tree::TargetTree;
use super::{Answer, MedialScene, Viewer};
use crate::blocking::Profile;
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::vector::unit;
use belvedere_data::view::View;

/// Targets of an eye from which on ordering them into a tree costs less than the lines of sight that it saves.
const TREE_FROM: usize = 10_000;
/// Minimum number of targets of a viewer infinitely far away for which bounds of depth cost less than lines of sight.
/// Drawing those of a million balls takes as long as ten million lines of sight.
const MAP_FROM: usize = 16_000_000;
/// Pixel of these bounds, metres, where targets are many enough; smaller ones settle a little more but are more to
/// draw.
const PIXEL: f64 = 0.5;
/// Targets for each pixel, at least.
const TARGETS_PER_PIXEL: f64 = 16.0;

impl MedialScene {
    /// The answer for each of `targets`, (M, 3) local metres, seen by `viewer`, in their order; progress counts
    /// targets. Targets that are not finite, or the viewer itself, are [`Answer::OutsideView`]; targets beside or below
    /// the cloud [`Answer::OutsideCloud`].
    ///
    /// Every answer is that of [`MedialScene::answer`]. A few targets get a line of sight each. Many targets of one eye
    /// are ordered into a tree, and very many under one sun are compared with bounds of depth first.
    ///
    /// # Errors
    /// As [`super::Visibility::visible`], and [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn visible_from(&self, viewer: Viewer<'_>, targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<Answer>> {
        viewer.validate()?;
        viewer.validate_count(targets)?;
        match viewer {
            Viewer::Eye(_) if targets.len() >= TREE_FROM => {
                let answers = self.answer_among(viewer, &TargetTree::new(targets), control)?;
                control.advance(targets.len());
                Ok(answers)
            }
            Viewer::Direction(to_viewer)
                if let Some(answers) = self.visible_by_backend(to_viewer, targets, control)? =>
            {
                Ok(answers)
            }
            Viewer::Direction(to_viewer) if targets.len() >= MAP_FROM && self.params().profile == Profile::Sphere => {
                self.visible_by_map(to_viewer, targets, control)
            }
            _ => Ok(self.marked(viewer, targets, self.answer_each(viewer, targets, control)?)),
        }
    }

    /// The answers for one direction by lines of sight that the backend settles, if it is fast at that.
    fn visible_by_backend(
        &self,
        to_viewer: [f64; 3],
        targets: &[[f32; 3]],
        control: &Control<'_>,
    ) -> Result<Option<Vec<Answer>>> {
        let viewer = Viewer::Direction(to_viewer);
        let Some(towards) = unit(to_viewer).filter(|_| self.ball_count() > 0) else { return Ok(None) };
        let settled = self.prepared()?.settle_few(targets, Viewers::Directions(&[towards]), control)?;
        let Some(settled) = settled else { return Ok(None) };
        let answers = self.answer_by(targets, control, |number, target| {
            let (towards, range) = viewer.line_of_sight(0, target)?;
            Some(match self.sees(viewer, target, settled.line(number, 0)) {
                true => self.answer_unblocked(target.map(f64::from), towards, range),
                false => Answer::Blocked,
            })
        })?;
        Ok(Some(self.marked(viewer, targets, answers)))
    }

    /// The answers for one direction by bounds of depth, for spheres.
    fn visible_by_map(&self, to_viewer: [f64; 3], targets: &[[f32; 3]], control: &Control<'_>) -> Result<Vec<Answer>> {
        if self.ball_count() == 0 {
            return self.answer_each(Viewer::Direction(to_viewer), targets, control);
        }
        let index = self.tree().index();
        let corner = |sign: f64| std::array::from_fn(|i| index.center()[i] + sign * index.half_size()[i]);
        // at least the area of the picture of such a box
        let area = 4.0 * index.half_size().iter().map(|v| v * v).sum::<f64>();
        let pixel = PIXEL.max((area * TARGETS_PER_PIXEL / targets.len() as f64).sqrt());
        let view = View::parallel(to_viewer.map(|v| -v), corner(-1.0), corner(1.0), pixel)?;
        let map = CertifiedMap::new(self, &[view], Scope::Viewer, control)?;
        let (answers, _) = map.answers(targets, control)?;
        control.advance(targets.len());
        Ok(answers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blocking::BlockRule;
    use crate::medial::MedialBalls;
    use crate::query::random_targets;
    use belvedere_data::random::uniform;
    use belvedere_data::vector::to_f32;

    #[test]
    fn a_map_answers_as_lines_of_sight_do() {
        let count = 400;
        let random = |i: u64, k: u64| to_f32(uniform(4, 8 * i + k));
        let balls = MedialBalls {
            centers: (0..count).map(|i| [40.0 * random(i, 0), 40.0 * random(i, 1), 8.0 * random(i, 2)]).collect(),
            radii: (0..count).map(|i| 0.2 + 2.0 * random(i, 3)).collect(),
            source: vec![0; 400],
            touch: vec![0; 400],
            separation_angles: vec![1.0; 400],
        };
        let sun = [0.48, 0.6, 0.64];
        let mut targets = random_targets([-5.0; 3], [45.0, 45.0, 12.0], 20_000, 9);
        targets[7] = [f32::NAN; 3];
        for rule in [BlockRule::carved(), BlockRule::default()] {
            let scene = MedialScene::new(&balls, &rule).unwrap();
            let by_map = scene.visible_by_map(sun, &targets, &Control::none()).unwrap();
            let by_lines = scene.visible_from(Viewer::Direction(sun), &targets, &Control::none()).unwrap();
            assert_eq!(by_map, by_lines);
            assert!(by_lines.contains(&Answer::Blocked) && by_lines.contains(&Answer::Visible));
            assert_eq!(by_lines[7], Answer::OutsideView);
        }
        let nothing = MedialScene::new(&MedialBalls::default(), &BlockRule::carved()).unwrap();
        let answers = nothing.visible_by_map(sun, &targets[..3], &Control::none()).unwrap();
        assert_eq!(answers, [Answer::Visible; 3]);
    }
}
