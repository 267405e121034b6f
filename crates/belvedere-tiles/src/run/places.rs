//! Questions about places of a survey of any size: only tiles that may block their light are built.

use crate::answer::obstacles::ObstacleSearch;
use crate::answer::tile_scene::SurveyScene;
use crate::plan::Plan;
use belvedere::apps::ask::Scene;
use belvedere::{Error, Result};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Survey of any size as a scene of questions about the light of places.
pub struct SurveyPlaces {
    /// Scene without cloud and balls of its own.
    pub scene: Scene,
    search: Arc<Mutex<ObstacleSearch>>,
}

impl SurveyPlaces {
    /// Takes the survey of a plan that is kept in `folder`. Points of places may take `memory` bytes.
    ///
    /// # Errors
    /// Those of reading planned objects and far terrain, and of writing the plan.
    pub fn new(plan: Plan, folder: &Path, memory: u64) -> Result<Self> {
        let proves = plan.can_prove();
        let (plan, run) = Plan { proves, ..plan }.ready_in(folder)?;
        let others = plan.others()?;
        let far = others.far_terrain.clone();
        let (plan, search) = (Arc::new(plan), Arc::default());
        let survey = SurveyScene {
            plan: Arc::clone(&plan),
            run,
            others: Arc::new(others),
            max_balls: plan.balls_at_a_time(),
            memory,
            makes_balls: true,
            search: Arc::clone(&search),
        };
        Ok(Self { scene: plan.scene(Arc::new(survey), far)?, search })
    }

    /// Refuses answers that missing balls may change.
    ///
    /// # Errors
    /// [`Error::NoPoints`].
    pub fn check(&self) -> Result<()> {
        let search = self.search.lock().unwrap_or_else(PoisonError::into_inner);
        if search.missing.is_empty() {
            return Ok(());
        }
        let what = "balls of a tile that may block the light could not be built; ask again to try it once more";
        Err(Error::NoPoints { what: what.to_owned() })
    }
}
