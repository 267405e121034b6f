//! Kept surveys: read once, with balls that all questions share.

use crate::inputs::{absolute, hash, remarks_on_file};
use crate::plan::Plan;
use crate::plan::cell_sizes::CellSizes;
use crate::plan::make_plan::PlanParams;
use crate::sealed::sealed;
use belvedere::apps::ask::Remark;
use belvedere::control::Control;
use belvedere::io::{cloud_sources, read_las_head};
use belvedere::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

impl Plan {
    /// Returns the plan of a survey without a question from `folder`, or makes it and keeps it there. The plan has
    /// default cells and the usual size of tiles ([`Plan::with_grid_cells`], [`Plan::fitting`]).
    ///
    /// # Errors
    /// Those of [`Plan::make`] and of writing.
    pub fn kept_in(folder: &Path, params: &PlanParams, control: &Control<'_>) -> Result<Self> {
        let (sources, contradictions) = cloud_sources(&params.clouds)?;
        let files: Vec<PathBuf> = sources.iter().map(|source| absolute(source.name())).collect::<Result<_>>()?;
        let is_of_these = |plan: &Self| {
            plan.program == params.program
                && plan.crs == params.crs
                && plan.insistence() == params.crs_against_files
                && plan.flown() == params.flown
                && plan.inputs.iter().map(|input| &input.path).eq(&files)
        };
        if let Some(plan) = Self::read(folder).ok().filter(is_of_these) {
            let mut remarks: Vec<Remark> = contradictions.into_iter().filter_map(Remark::of_contradiction).collect();
            for source in sources {
                let path = absolute(source.name())?;
                remarks.extend(remarks_on_file(&path, &read_las_head(source)?));
            }
            return Ok(Self { remarks, ..plan });
        }
        let plan = Self::make(&PlanParams { cells: CellSizes::default(), memory: None, ..params.clone() }, control)?;
        let plan = Self { proves: plan.can_prove(), ..plan };
        fs::create_dir_all(folder).map_err(Error::io(folder))?;
        plan.write_here(folder)?;
        Ok(Self { remarks: plan.remarks, ..Self::read(folder)? })
    }

    /// Writes this plan with its questions into a folder of its own below the folder of the survey. All plans of the
    /// survey share its balls. Returns the plan and its folder.
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
