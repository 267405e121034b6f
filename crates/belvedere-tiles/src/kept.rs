//! Surveys that are kept: looked at once, with balls that all questions share.

use crate::cell_sizes::CellSizes;
use crate::inputs::{hash, remarks_on_files};
use crate::make_plan::PlanParams;
use crate::plan::Plan;
use crate::sealed::sealed;
use belvedere::control::Control;
use belvedere::io::{cloud_files, read_las_head, web_address};
use belvedere::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// Memory that a model of a whole cloud takes for each point, and without any, bytes. As measured in docs/costs.md.
const BYTES_PER_POINT: u64 = 600;
const MIN_BYTES: u64 = 100_000_000;

/// Most files on a server whose headers are looked at: each is a request or two.
const MAX_REMOTE: usize = 64;

/// Memory that one model of all these files takes, bytes: what tiles are for where that is too much. `None` for files
/// of which tiles cannot be made, such as tables of points, and for many files on servers.
#[must_use]
pub fn memory_of_whole(clouds: &[PathBuf]) -> Option<u64> {
    let files = cloud_files(clouds).ok()?;
    if files.iter().filter(|file| web_address(file).is_some()).count() > MAX_REMOTE {
        return None;
    }
    let points = files.iter().map(|file| Some(read_las_head(file.as_path()).ok()?.points));
    let points: u64 = points.sum::<Option<u64>>()?;
    Some(points.saturating_mul(BYTES_PER_POINT).saturating_add(MIN_BYTES))
}

impl Plan {
    /// The plan of a survey without a question that is kept in `folder`, or is made and kept there. Its tiles fit into
    /// the memory of `params`; cells come later ([`Plan::with_cells`]).
    ///
    /// # Errors
    /// Those of [`Plan::make`] and [`Plan::write`].
    pub fn kept_in(folder: &Path, params: &PlanParams, control: &Control<'_>) -> Result<Self> {
        let files = cloud_files(&params.clouds)?;
        let is_of_these = |plan: &Self| {
            plan.program == params.program
                && plan.crs == params.crs
                && plan.insistence() == params.crs_against_files
                && plan.inputs.iter().map(|input| &input.path).eq(&files)
        };
        let plan = match Self::read(folder).ok().filter(is_of_these) {
            Some(plan) => Self { remarks: remarks_on_files(&plan.inputs)?, ..plan },
            None => {
                let whole = PlanParams { cells: CellSizes::default(), memory: None, ..params.clone() };
                let plan = Self::make(&whole, control)?;
                let plan = Self { proves: plan.can_prove(), ..plan };
                fs::create_dir_all(folder).map_err(Error::io(folder))?;
                plan.write(folder)?;
                // numbers are those of the file from the first command on
                Self { remarks: plan.remarks, ..Self::read(folder)? }
            }
        };
        match params.memory {
            Some(memory) => plan.fitting(memory),
            None => Ok(plan),
        }
    }

    /// This with questions, written into a folder of its own below that of the survey, whose balls all of its plans
    /// share; and that folder.
    ///
    /// # Errors
    /// Those of [`Plan::write`].
    pub fn ready_in(self, survey: &Path) -> Result<(Self, PathBuf)> {
        let balls = survey.join(self.survey_fingerprint(survey)?);
        let text = sealed(&self).map_err(|e| Error::malformed(survey, format!("cannot be written: {e}")))?;
        let run = balls.join(hash(text.as_bytes()));
        fs::create_dir_all(&run).map_err(Error::io(&run))?;
        self.write(&run)?;
        let plan = Self { shared_balls: Some(balls), remarks: self.remarks, ..Self::read(&run)? };
        Ok((plan, run))
    }
}
