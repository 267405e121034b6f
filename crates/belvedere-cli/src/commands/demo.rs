//! `belvedere demo`.

use crate::arguments::{Demo, Global};
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::Result;

pub(crate) fn run(_arguments: &Demo, global: &Global) -> Result<Summary> {
    let mut stages = Stages::new(global);
    let summary = Summary::default();
    stages.run("x", 0, |_| ());
    Ok(summary)
}
