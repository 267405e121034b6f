//! `belvedere query`.

use super::extension;
use crate::arguments::{Global, Query, Usage};
use crate::pipeline;
use crate::progress::Stages;
use crate::summary::{Summary, percent, rounded};
use anyhow::{Context, Result};
use belvedere::PointCloud;
use belvedere::crs::Crs;
use belvedere::depth::{ItemBuffer, depth_map};
use belvedere::io::{ExtraColumn, ExtraValues, ReadOptions, read_cloud, write_cloud, write_npy_u8};
use belvedere::query::{AnswerCounts, query_points, random_targets};

pub(crate) fn run(arguments: &Query, global: &Global) -> Result<Summary> {
    let output = &arguments.output;
    let known = ["csv", "txt", "xyz", "laz", "las", "ply", "npy"];
    if !known.contains(&extension(output).as_str()) {
        return Err(Usage(format!("{}: write to one of .{}", output.display(), known.join(" ."))).into());
    }
    if let Some(bias) = arguments.bias
        && !bias.is_finite()
    {
        return Err(Usage(format!("--bias {bias} is not finite")).into());
    }
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let scene = pipeline::scene(&arguments.scene, &mut stages, &mut summary)?;
    let view = arguments.view.view(&scene, &mut summary)?;
    let targets = targets(arguments, scene.cloud, scene.bounds, global.seed, &mut stages)?;
    let map = stages.run("drawing depth map", 0, |_| {
        depth_map(&scene.balls, &view, arguments.scene.profile.into(), ItemBuffer::Without)
    })?;
    let bias = arguments.bias.unwrap_or_else(|| map.default_depth_bias());
    let answers = stages.run("querying", 0, |_| query_points(&map, &targets.positions, bias));
    let counts = AnswerCounts::of(&answers);
    let mut section = Summary::default();
    section
        .add("targets", answers.len())
        .add("visible", counts.visible)
        .add("blocked", counts.blocked)
        .add("outside_the_view", counts.outside_view)
        .add("visible_percent", percent(counts.visible, answers.len()))
        .add("depth_bias_m", rounded(f64::from(bias), 4));
    summary.add("answers", section);
    let codes: Vec<u8> = answers.iter().map(|&answer| answer as u8).collect();
    stages.run("writing", 0, |_| {
        if extension(output) == "npy" {
            return write_npy_u8(output, &codes);
        }
        let column = ExtraColumn {
            name: "answer",
            description: "0 blocked 1 visible 3 outside",
            values: ExtraValues::U8(&codes),
        };
        write_cloud(output, &targets, &[column]).map(|_| ())
    })?;
    summary.add("written", output.display().to_string());
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

/// The targets as a cloud in the frame of the scene.
fn targets(
    arguments: &Query,
    scene: PointCloud,
    (low, high): ([f32; 3], [f32; 3]),
    seed: u64,
    stages: &mut Stages,
) -> Result<PointCloud> {
    let frame =
        |positions| PointCloud { origin: scene.origin, crs: scene.crs.clone(), positions, ..PointCloud::default() };
    if let Some(count) = arguments.targets.random {
        return Ok(frame(stages.run("spreading targets", 0, |_| random_targets(low, high, count, seed))));
    }
    if let Some(path) = &arguments.targets.targets {
        let options = ReadOptions::default();
        let (mut cloud, report) =
            stages.run("reading targets", 0, |_| read_cloud(std::slice::from_ref(path), &options))?;
        if report.left_out_count() > 0 {
            let count = report.left_out_count();
            return Err(anyhow::anyhow!("{count} targets are not usable, so answers would not match their rows"))
                .with_context(|| path.display().to_string());
        }
        // a table of targets says nothing of its unit: it is in the coordinates of the scene's file
        let scale = scene.crs.metres_per_unit_xyz();
        let given = cloud.crs.metres_per_unit_xyz();
        let known = cloud.crs != Crs::default();
        let positions = cloud
            .positions
            .iter()
            .map(|p| {
                let metres: [f64; 3] = std::array::from_fn(|i| {
                    let value = f64::from(p[i]) + cloud.origin[i];
                    if known { value } else { value / given[i] * scale[i] }
                });
                belvedere::cloud::to_local(metres, scene.origin)
            })
            .collect();
        cloud.positions = positions;
        cloud.origin = scene.origin;
        cloud.crs = scene.crs.clone();
        cloud.scanner_positions = Vec::new();
        return Ok(cloud);
    }
    if scene.is_empty() {
        return Err(Usage("--self needs the cloud itself; a ball file holds no points".to_owned()).into());
    }
    Ok(scene)
}
