//! `belvedere balls`.

use super::{check_output, check_parent, extension, is_folder, is_same};
use crate::arguments::{Balls, Cleaning, Global, MethodChoice, SideChoice, Usage};
use crate::pipeline::{self, BallParams, Carving, Prepared};
use crate::progress::Stages;
use crate::summary::{Summary, percent};
use anyhow::Result;
use belvedere::PointCloud;
use belvedere::io::{MasbcppFolder, write_balls, write_masbcpp};
use belvedere::medial::feature_size::{FeatureSizeParams, SimplifyParams, local_feature_size, simplify};
use belvedere::medial::{MedialBalls, NO_TOUCH, Side};
use std::borrow::Cow;

pub(crate) fn run(arguments: &Balls, global: &Global) -> Result<Summary> {
    let is_folder = is_folder(&arguments.output);
    if !is_folder && (arguments.nan || arguments.simplify.is_some()) {
        return Err(
            Usage("--nan and --simplify write into a folder: give -o a name without extension".to_owned()).into()
        );
    }
    if is_folder {
        check_parent(&arguments.output)?;
    } else {
        check_output("-o", &arguments.output, &["npz", "ply", "laz", "las"])?;
    }
    let method = match (is_folder, arguments.side) {
        (true, _) => MethodChoice::Angles,
        (false, SideChoice::Interior) => MethodChoice::Carved,
        (false, SideChoice::Exterior) => MethodChoice::Tau,
    };
    let params = arguments.shrinking.params(method)?;
    if params.carving() == Carving::Wanted && (is_folder || arguments.side == SideChoice::Exterior) {
        let what =
            "--method carved makes interior balls in a ball file; a folder and --side exterior need tau or angles";
        return Err(Usage(what.to_owned()).into());
    }
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let cloud = if is_folder {
        pipeline::read_every_row(&arguments.input, &mut stages, &mut summary)?
    } else {
        pipeline::read(&arguments.input, &mut stages, &mut summary)?
    };
    let nothing = Cleaning::nothing();
    let cleaning = if is_folder { &nothing } else { &arguments.cleaning };
    let (orienting, carving) = (&arguments.orienting, params.carving());
    let prepared = pipeline::prepare(Cow::Borrowed(&cloud), cleaning, orienting, carving, &mut stages, &mut summary)?;
    if is_folder {
        write_folder(arguments, global, &cloud, &prepared, params, &mut stages, &mut summary)?;
    } else {
        let side = match arguments.side {
            SideChoice::Interior => Side::Interior,
            SideChoice::Exterior => Side::Exterior,
        };
        let mut made = pipeline::shrink_side(&prepared, side, params, &mut stages, &mut summary)?;
        made.balls = made.balls.shrunk();
        // rows of the cloud as read, not as cleaned
        for row in made.balls.source.iter_mut().chain(&mut made.balls.touch) {
            // a pulse has no row
            *row = prepared.kept.get(*row as usize).copied().unwrap_or(*row);
        }
        let pulses = prepared.pulses();
        if pulses.is_some() && extension(&arguments.output) != "npz" {
            summary.add("not_written", "pulses: only .npz keeps what tells visible from unproven");
        }
        let provenance = [
            ("program", concat!("belvedere ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("side", format!("{side:?}").to_lowercase()),
            ("method", params.settled(&prepared).name().to_owned()),
            ("parameters", format!("{:?}", params.settled(&prepared))),
            ("input", arguments.input.clouds.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(" ")),
        ];
        let saved = pipeline::saved(made, &cloud.frame, prepared.bounds, pulses, provenance);
        stages.run("writing", 0, |_| write_balls(&arguments.output, &saved))?;
    }
    summary.add("written", arguments.output.display().to_string());
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}

fn write_folder(
    arguments: &Balls,
    global: &Global,
    cloud: &PointCloud,
    prepared: &Prepared,
    params: BallParams,
    stages: &mut Stages,
    summary: &mut Summary,
) -> Result<()> {
    let interior = pipeline::shrink_side(prepared, Side::Interior, params, stages, summary)?.balls;
    let exterior = pipeline::shrink_side(prepared, Side::Exterior, params, stages, summary)?.balls;
    let mut folder = MasbcppFolder::default();
    let centers = |balls: &MedialBalls| {
        let mut centers = pipeline::file_coordinates(cloud, &balls.centers);
        if arguments.nan {
            centers.iter_mut().zip(&balls.touch).filter(|(_, t)| **t == NO_TOUCH).for_each(|(c, _)| *c = [f32::NAN; 3]);
        }
        centers
    };
    // NO_TOUCH has the bits of -1
    let touch = |balls: &MedialBalls| balls.touch.iter().map(|t| t.cast_signed()).collect::<Vec<i32>>();
    let (coords, inner, outer) =
        (pipeline::file_coordinates(cloud, &cloud.positions), centers(&interior), centers(&exterior));
    let (inner_touch, outer_touch) = (touch(&interior), touch(&exterior));
    let is_input = arguments.input.clouds.iter().any(|input| is_same(input, &arguments.output));
    // what was read from this folder stays as it is: its coordinates may be finer than the layout's f32
    folder.coords = (!is_input).then_some(&coords);
    folder.normals = (!is_input || cloud.attributes.normals.is_none()).then_some(prepared.oriented.normals());
    folder.ma_coords_in = Some(&inner);
    folder.ma_coords_out = Some(&outer);
    folder.ma_qidx_in = Some(&inner_touch);
    folder.ma_qidx_out = Some(&outer_touch);
    let (sizes, keep);
    if let Some(spacing) = arguments.simplify {
        sizes = stages.run("feature size", 0, |_| {
            local_feature_size(&cloud.positions, &[&interior, &exterior], &FeatureSizeParams::default())
        })?;
        let params =
            SimplifyParams { spacing, cell_size: arguments.cell_size, seed: global.seed, ..SimplifyParams::default() };
        keep = pipeline::flagged("--simplify, --cell", simplify(&cloud.positions, &sizes, &params))?
            .into_iter()
            .map(u8::from)
            .collect::<Vec<u8>>();
        let kept = keep.iter().filter(|&&k| k == 1).count();
        summary.add("kept_by_thinning_percent", percent(kept, keep.len()));
        folder.lfs = Some(&sizes);
        folder.decimate_lfs = Some(&keep);
    }
    stages.run("writing", 0, |_| write_masbcpp(&arguments.output, &folder))?;
    Ok(())
}
