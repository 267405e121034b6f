//! `belvedere cache`.

use crate::arguments::{CacheArguments, Global};
use crate::environment;
use crate::run::CommandContext;
use crate::summary::{Summary, rounded, sections};
use anyhow::Result;
use belvedere::cache::CacheEntry;
use serde::Serialize;
use std::time::SystemTime;

pub(crate) fn run(arguments: &CacheArguments, global: &Global) -> Result<Summary> {
    let mut run = CommandContext::new(global);
    run.summary.is_report();
    let Some(cache) = environment::cache(global) else {
        run.summary.add("scenes", 0).answer("no folder is known where scenes could be kept: give --cache DIR");
        return Ok(run.finish());
    };
    run.summary.add("folder", cache.folder().display().to_string());
    run.summary.remarks(cache.remark());
    let entries = cache.entries()?;
    if arguments.clear {
        let bytes = cache.clear()?;
        run.summary.add("scenes_removed", entries.len()).add("megabytes_removed", megabytes(bytes));
        run.summary.headline("removed <scenes_removed> scenes, <megabytes_removed> MB");
        return Ok(run.finish());
    }
    let rows: Vec<Row> = entries.iter().map(Row::of).collect();
    run.summary.add("scenes", entries.len());
    run.summary.add("megabytes", megabytes(cache.bytes()?));
    run.summary.add("scene", sections(&rows));
    run.summary.headline("<scenes> scenes are kept, <megabytes> MB with their ground");
    Ok(run.finish())
}

/// A kept scene, as it is listed.
#[derive(Serialize)]
struct Row {
    of: String,
    megabytes: serde_json::Value,
    used_hours_ago: serde_json::Value,
}

impl Row {
    fn of(entry: &CacheEntry) -> Self {
        let seconds = SystemTime::now().duration_since(entry.used).map_or(0.0, |passed| passed.as_secs_f64());
        Self { of: entry.name.clone(), megabytes: megabytes(entry.bytes), used_hours_ago: rounded(seconds / 3600.0, 1) }
    }
}

fn megabytes(bytes: u64) -> serde_json::Value {
    rounded(bytes as f64 / 1e6, 1)
}
