//! Creates scenes that answer lines of sight from a scene model.

use super::SceneModel;
use crate::medial::without_vegetation;
use crate::pulses::FreeSegmentColumns;
use crate::query::{BallTree, BlockRule, Coverage, MedialScene, Proof, ProofParams, UnprovenAs};
use belvedere_data::Result;
use belvedere_data::control::Control;
use std::sync::Arc;

impl SceneModel {
    /// Over which space the cloud of this model lies; `None` where its bounds say nothing.
    #[must_use]
    pub fn coverage(&self) -> Option<Coverage> {
        Coverage::of(self.bounds())
    }

    /// Returns the default rule by which the balls of this model block lines of sight: carved balls give way to targets
    /// at their surface, others have a bias.
    #[must_use]
    pub fn rule(&self) -> BlockRule {
        if self.is_carved() { BlockRule::carved() } else { BlockRule::uncarved() }
    }

    /// Orders its balls into a tree, which all its scenes and copies then share.
    ///
    /// # Errors
    /// Those of [`BallTree::new`]; [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn index(&mut self, control: &Control<'_>) -> Result<()> {
        if self.tree.is_none() {
            let balls = self.balls();
            self.tree = Some(control.stage("indexing balls", balls.len(), || BallTree::new(balls, &self.rule()))?);
        }
        Ok(())
    }

    /// The scene that answers lines of sight by `rule`.
    ///
    /// Its answers distinguish unproven from visible where the pulses are known. With [`UnprovenAs::Visible`] that
    /// makes no difference, and the pulses are left out. They are indexed when a line of sight first needs them.
    /// Targets beside or below the cloud have no answer ([`SceneModel::coverage`]).
    ///
    /// # Errors
    /// Those of [`BallTree::new`] and [`Proof::from_columns`]; [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn scene(&self, rule: &BlockRule, unproven: UnprovenAs, control: &Control<'_>) -> Result<MedialScene> {
        let balls = self.balls();
        let tree = match &self.tree {
            Some(tree) => tree.with_rule(rule)?,
            None => control.stage("indexing balls", balls.len(), || BallTree::new(balls, rule))?,
        };
        let scene = self.completed(MedialScene::of_tree(tree)).with_freed(&self.freed);
        let proof = if unproven == UnprovenAs::Visible { None } else { self.proof()? };
        Ok(match proof {
            Some(proof) => scene.with_pulses(proof),
            None => scene,
        })
    }

    /// Indexes its pulses, which all its scenes and copies then share. Where all are upright, as those from the air
    /// are, also the space that they saw is found: most questions need it, and [`SceneModel::derived`] keeps it. Of
    /// others that takes long, so that it is found only where lines of sight run.
    ///
    /// # Errors
    /// Those of [`Proof::from_columns`]; [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    pub fn index_proof(&self, control: &Control<'_>) -> Result<()> {
        let Some(proof) = self.proof()? else { return Ok(()) };
        control.stage("indexing pulses", 0, || proof.prepare_all(control))
    }

    /// Returns the proof by its pulses; `None` without any.
    fn proof(&self) -> Result<Option<Proof>> {
        if let Some(proof) = self.proof.get() {
            return Ok(Some(proof.clone()));
        }
        let made = self.new_proof()?;
        Ok(made.map(|made| self.proof.get_or_init(|| made).clone()))
    }

    pub(super) fn new_proof(&self) -> Result<Option<Proof>> {
        let proof = |pulses: &FreeSegmentColumns| Proof::from_columns(pulses.clone(), &ProofParams::default());
        self.pulses().map(proof).transpose()
    }

    /// The scene of [`SceneModel::scene`] without the balls of vegetation, and without pulses: the obstacles if no tree
    /// stood.
    ///
    /// # Errors
    /// [`Error::LengthMismatch`](belvedere_data::Error::LengthMismatch) where it is not known which balls are
    /// vegetation, and those of [`MedialScene::new`].
    pub fn scene_without_vegetation(&self, rule: &BlockRule, control: &Control<'_>) -> Result<MedialScene> {
        let balls = without_vegetation(self.balls(), self.vegetation())?;
        let scene = control.stage("indexing balls without trees", balls.len(), || MedialScene::new(&balls, rule))?;
        Ok(self.completed(scene))
    }

    /// A scene of balls with all other obstacles, and the extent of the cloud.
    fn completed(&self, scene: MedialScene) -> MedialScene {
        let scene = scene.with_coverage(self.coverage()).with_triangles(self.triangles.clone());
        let scene = scene.with_far_terrain(self.far_terrain.clone());
        match &self.backend {
            Some(backend) => scene.with_backend(Arc::clone(backend)),
            None => scene,
        }
    }
}
