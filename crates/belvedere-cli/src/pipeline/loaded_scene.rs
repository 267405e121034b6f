//! A scene that a command read.

use crate::arguments::{GroundChoice, refuse};
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::apps::ask;
use belvedere::apps::ask::scene::GroundStore;
use belvedere::crs::CrsKind;
use belvedere::depth::Profile;
use belvedere::io::{ReadOptions, ReadReport, read_cloud};
use belvedere::model::SceneModel;
use belvedere::query::BlockRule;
use std::sync::Arc;

/// A scene model, and the cloud it was made from unless it was read from a file.
#[derive(Clone)]
pub(crate) struct LoadedScene {
    pub(crate) model: SceneModel,
    /// Points in the frame of the model; none where the model was read from a file, or they are not needed.
    pub(crate) cloud: Arc<PointCloud>,
    /// Rows of the files that reading left out.
    pub(crate) left_out: ReadReport,
    /// Shape that represents a ball.
    pub(crate) profile: Profile,
    /// Keeps the ground of the cloud; `None` without a cache, and where the cloud is not as it was read.
    pub(crate) ground_store: Option<Arc<dyn GroundStore>>,
}

impl LoadedScene {
    /// A model that comes without the points that it was made from.
    pub(crate) fn without_points(model: SceneModel, profile: Profile) -> Self {
        let cloud = Arc::new(PointCloud::in_frame(model.frame().clone()));
        Self { model, cloud, left_out: ReadReport::default(), profile, ground_store: None }
    }

    /// The scene that questions are put to, with the ground and the shell of the flags.
    pub(crate) fn into_question_scene(
        self,
        ground: Option<&GroundChoice>,
        shell: Option<f32>,
        run: &CommandContext,
    ) -> Result<ask::Scene> {
        if shell.is_some() && !self.model.is_carved() {
            return refuse("--shell applies only to carved balls, and these are not carved");
        }
        let usual = self.model.rule();
        let rule = BlockRule { profile: self.profile, shell: shell.map_or(usual.shell, f64::from), ..usual };
        let frame = self.cloud.frame.clone();
        let scene = ask::Scene::new(self.model, self.cloud).with_rule(rule).with_ground_store(self.ground_store);
        let Some(GroundChoice::Cloud(path)) = ground else { return Ok(scene) };
        let (cloud, _) = run.stage("reading ground", 0, |control| {
            read_cloud(std::slice::from_ref(path), &ReadOptions::default(), control)
        })?;
        cloud.frame.crs.check_for(&frame.crs, "ground", path)?;
        // a scene that knows no system takes that of its ground
        let own = Some(cloud.frame.crs.clone()).filter(|crs| crs.kind != CrsKind::Unknown);
        let mut cloud = cloud.moved_to(&frame);
        if let Some(crs) = own {
            cloud.frame.crs = crs;
        }
        Ok(scene.with_ground_of(Arc::new(cloud))?)
    }
}
