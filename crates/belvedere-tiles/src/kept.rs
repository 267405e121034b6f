//! Surveys that are kept: looked at once, with balls that all questions share.

use crate::cell_sizes::CellSizes;
use crate::inputs::{hash, remarks_on_files};
use crate::make_plan::PlanParams;
use crate::plan::Plan;
use crate::sealed::sealed;
use belvedere::control::Control;
use belvedere::io::cloud_files;
use belvedere::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

impl Plan {
    /// The plan of a survey without a question that is kept in `folder`, or is made and kept there. Its cells and the
    /// size of its tiles are usual ones ([`Plan::with_grid_cells`], [`Plan::fitting`]).
    ///
    /// # Errors
    /// Those of [`Plan::make`] and of writing.
    pub fn kept_in(folder: &Path, params: &PlanParams, control: &Control<'_>) -> Result<Self> {
        let files = cloud_files(&params.clouds)?;
        let is_of_these = |plan: &Self| {
            plan.program == params.program
                && plan.crs == params.crs
                && plan.insistence() == params.crs_against_files
                && plan.inputs.iter().map(|input| &input.path).eq(&files)
        };
        if let Some(plan) = Self::read(folder).ok().filter(is_of_these) {
            return Ok(Self { remarks: remarks_on_files(&plan.inputs)?, ..plan });
        }
        let plan = Self::make(&PlanParams { cells: CellSizes::default(), memory: None, ..params.clone() }, control)?;
        let plan = Self { proves: plan.can_prove(), ..plan };
        fs::create_dir_all(folder).map_err(Error::io(folder))?;
        plan.write_here(folder)?;
        Ok(Self { remarks: plan.remarks, ..Self::read(folder)? })
    }

    /// This with questions, written into a folder of its own below that of the survey, whose balls all of its plans
    /// share; and that folder.
    ///
    /// # Errors
    /// Those of writing.
    pub fn ready_in(self, survey: &Path) -> Result<(Self, PathBuf)> {
        let balls = survey.join(self.survey_fingerprint(survey)?);
        let text = sealed(&self).map_err(|e| Error::malformed(survey, format!("cannot be written: {e}")))?;
        let run = balls.join(hash(text.as_bytes()));
        fs::create_dir_all(&run).map_err(Error::io(&run))?;
        self.write_here(&run)?;
        let plan = Self { shared_balls: Some(balls), remarks: self.remarks, ..Self::read(&run)? };
        Ok((plan, run))
    }
}
