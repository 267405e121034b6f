//! `belvedere trajectory`.

use crate::arguments::{Global, TrajectoryArguments, refuse};
use crate::outputs::formats::check_output;
use crate::pipeline;
use crate::run::CommandContext;
use crate::summary::{Summary, sections};
use anyhow::Result;
use belvedere::io::write_found_trajectory;
use belvedere::pulses::{LocateParams, Means, locate, path_samples};

pub(crate) fn run(arguments: &TrajectoryArguments, global: &Global) -> Result<Summary> {
    check_output("-o", &arguments.output, &["csv", "txt"])?;
    if !(0.01..=2.0).contains(&arguments.step) {
        let step = arguments.step;
        return refuse(format!(
            "--time-step-s is {step}, but must be 0.01 to 2 s, because readers do not bridge longer gaps"
        ));
    }
    let mut run = CommandContext::new(global);
    let cloud = pipeline::read(&arguments.input, &mut run)?;
    let (_, report) = run.stage("estimating scanner positions", 0, |control| {
        locate(&cloud, &Means::Pulses, &LocateParams::default(), control)
    })?;
    run.summary.add("scanner", Summary::of(&report));
    run.summary.add("scanner_by_line", sections(&report.lines()));
    let samples = path_samples(&report.paths, cloud.frame.origin, arguments.step)?;
    run.summary.add("positions", samples.len());
    run.stage("writing", 0, |_| write_found_trajectory(&arguments.output, &samples, &cloud.frame.crs))?;
    run.summary
        .headline("<positions> scanner positions, found by <scanner.found_by>")
        .headline("scanner known for <scanner.scanner_known_percent> % of the points[, <scanner.height_above_ground_m> m above the ground]")
        .headline("deviation of a position: <scanner.position_deviation_m> m");
    run.summary.add("written", arguments.output.display().to_string());
    Ok(run.finish())
}
