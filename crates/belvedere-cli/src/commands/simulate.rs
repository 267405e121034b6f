//! `belvedere simulate`: a town, a survey of it, and what is true about both.

use crate::arguments::{Global, PatternChoice, ScannerChoice, Simulate, refuse, refuse_given};
use crate::outputs::formats::check_folder;
use crate::outputs::text::write_text;
use crate::run::CommandContext;
use crate::simulated::{EPSG, SUNS_DEG, cloud_of, crs};
use crate::summary::{Summary, percent, rounded, whole};
use anyhow::{Result, bail};
use belvedere::cloud::GpsTimeKind;
use belvedere::io::{ExtraColumn, ExtraValues, VehicleHeading, atomic, write_cloud, write_trajectory};
use belvedere::trajectory::Trajectory;
use belvedere::view::to_sun;
use belvedere_scenes::{
    AirborneParams, BeamParams, DENSITY, MirrorMotion, Scan, ScanGrid, ScanPattern, Stations, TerrestrialParams,
    TriangleScene, Truth, blocks, scan_airborne, scan_terrestrial, town,
};
use std::io::Write;
use std::path::Path;

/// Maximum number of pulses: a scan of more would fill the memory of most machines, so that a slipped digit is an error
/// and no crash.
const MAX_PULSES: f64 = 5e8;

pub(crate) fn run(arguments: &Simulate, global: &Global) -> Result<Summary> {
    check_flags(arguments)?;
    check_pulses(arguments)?;
    let folder = &arguments.output;
    check_folder(folder)?;
    let mut run = CommandContext::new(global);

    let town_params = arguments.scene.params(arguments.extent, global.seed);
    let scene = run.compute("building town", || town(&town_params));
    let scan = match arguments.scanner {
        ScannerChoice::Airborne => {
            let params = airborne(arguments, &scene, global.seed);
            run.summary.add("survey", airborne_section(&params));
            run.compute("scanning", || scan_airborne(&scene, &params))
        }
        ScannerChoice::Terrestrial => {
            let params = terrestrial(arguments, global.seed);
            let scan = run.compute("scanning", || scan_terrestrial(&scene, &params));
            run.summary.add("survey", terrestrial_section(&params, &scan));
            scan
        }
    };
    if scan.is_empty() {
        bail!("no pulse returned from the town; use a lower --dropout, more --stations or a larger --max-range");
    }
    let scan = scan.in_order(arguments.order, global.seed);
    atomic::make_folder(folder)?;
    let lit = run.compute("testing shadow", || {
        let truth = Truth::new(&scene);
        SUNS_DEG.map(|sun| {
            let [azimuth, elevation] = sun.map(f64::to_radians);
            let lit = scan.lit_from(&scene, &truth, to_sun(azimuth, elevation));
            lit.into_iter().map(u8::from).collect::<Vec<u8>>()
        })
    });
    run.stage("writing cloud", 0, |_| write_lit_cloud(&folder.join("cloud.laz"), &scan, &lit))?;
    let mut files = vec!["cloud.laz"];
    if arguments.terrestrial.ptx {
        let grids = terrestrial(arguments, global.seed).grids(&scan);
        run.stage("writing scans", 0, |_| write_grids(&folder.join("scans.ptx"), &grids))?;
        files.push("scans.ptx");
    }
    files.extend(run.stage("writing trajectory", 0, |_| write_paths(folder, &scan))?);
    files.extend(run.stage("writing meshes", 0, |_| write_meshes(folder, &scene))?);

    run.summary.add("scene", arguments.scene.name());
    run.summary.add("objects", scene.object_names.len());
    run.summary.add("ground_truth_triangles", scene.triangles.len());
    run.summary.add("points", scan.len());
    run.summary.add("pulses", pulses_section(&scan));
    for (name, lit) in SUN_NAMES.iter().zip(&lit) {
        run.summary.add(&format!("{name}_percent"), percent(lit.iter().filter(|&&v| v == 1).count(), lit.len()));
    }
    run.summary
        .headline("<points> points of a simulated <scene> with <objects> objects")
        .headline("ground truth: <ground_truth_triangles> triangles");
    run.summary.add_paths("files", files.iter().map(|name| folder.join(name)));
    Ok(run.finish())
}

/// Refuses flags of the scanner that is not used.
fn check_flags(arguments: &Simulate) -> Result<()> {
    let (air, ground) = (&arguments.airborne, &arguments.terrestrial);
    let of_airborne = [
        ("--pattern", air.pattern.is_some()),
        ("--density", air.density.is_some()),
        ("--flying-height", air.flying_height.is_some()),
        ("--speed", air.speed.is_some()),
        ("--scan-angle", air.scan_angle.is_some()),
        ("--strips", air.strips.is_some()),
        ("--cross-strips", air.cross_strips.is_some()),
    ];
    let of_terrestrial = [
        ("--stations", ground.stations.is_some()),
        ("--angle-step-deg", ground.angular_step.is_some()),
        ("--max-range", ground.max_range.is_some()),
        ("--ptx", ground.ptx),
    ];
    let (unused, scanner): (&[(&str, bool)], &str) = match arguments.scanner {
        ScannerChoice::Airborne => (&of_terrestrial, "terrestrial"),
        ScannerChoice::Terrestrial => (&of_airborne, "airborne"),
    };
    refuse_given(unused, &format!("needs --scanner {scanner}"))
}

/// Refuses more pulses than a machine holds, before a large town is built for them.
fn check_pulses(arguments: &Simulate) -> Result<()> {
    let (count, advice) = match arguments.scanner {
        ScannerChoice::Airborne => {
            let density = arguments.airborne.density.unwrap_or(DENSITY);
            (density * arguments.extent.powi(2), "use a lower --density or --extent")
        }
        ScannerChoice::Terrestrial => {
            let params = terrestrial(arguments, 0);
            let stations = if let Stations::Chosen(count) = params.stations { f64::from(count) } else { 0.0 };
            (stations * params.pulses_per_station() as f64, "use a larger --angle-step-deg or fewer --stations")
        }
    };
    if count <= MAX_PULSES {
        return Ok(());
    }
    refuse(format!("{count:.1e} pulses are more than the {MAX_PULSES:.0e} that fit into memory; {advice}"))
}

fn airborne(arguments: &Simulate, scene: &TriangleScene, seed: u64) -> AirborneParams {
    let flags = &arguments.airborne;
    let density = flags.density.unwrap_or(DENSITY);
    let usual = AirborneParams::default();
    let angle = flags.scan_angle.map(f64::to_radians);
    let pattern = match flags.pattern {
        None | Some(PatternChoice::Rotating) => ScanPattern::Rotating,
        Some(PatternChoice::Oscillating) => ScanPattern::Oscillating(MirrorMotion::Sinusoidal),
        Some(PatternChoice::Conical) => {
            angle.map_or(ScanPattern::CONICAL_20, |half_angle| ScanPattern::Conical { half_angle })
        }
    };
    let params = AirborneParams {
        seed,
        pattern,
        flying_height: flags.flying_height.unwrap_or(usual.flying_height),
        speed: flags.speed.unwrap_or(usual.speed),
        half_angle: angle.unwrap_or(usual.half_angle),
        cross_strip_count: flags.cross_strips.unwrap_or(usual.cross_strip_count),
        beam: beam(arguments, BeamParams::in_leaf()),
        range_sd: arguments.pulses.noise.unwrap_or(usual.range_sd),
        dropout: arguments.pulses.dropout.unwrap_or(usual.dropout),
        ..usual
    };
    params.spread_over(scene, flags.strips, density)
}

fn terrestrial(arguments: &Simulate, seed: u64) -> TerrestrialParams {
    let flags = &arguments.terrestrial;
    let usual = TerrestrialParams::default();
    let stations = flags.stations.map_or(usual.stations.clone(), Stations::Chosen);
    TerrestrialParams {
        seed,
        stations,
        angular_step: flags.angular_step.map_or(usual.angular_step, f64::to_radians),
        max_range: flags.max_range.unwrap_or(usual.max_range),
        beam: beam(arguments, usual.beam.clone()),
        range_sd: arguments.pulses.noise.unwrap_or(usual.range_sd),
        dropout: arguments.pulses.dropout.unwrap_or(usual.dropout),
        ..usual
    }
}

fn beam(arguments: &Simulate, usual: BeamParams) -> BeamParams {
    BeamParams {
        divergence: arguments.pulses.divergence.map_or(usual.divergence, |mrad| mrad / 1000.0),
        foliage_depth: arguments.pulses.foliage_depth.unwrap_or(usual.foliage_depth),
        ..usual
    }
}

fn airborne_section(params: &AirborneParams) -> Summary {
    let pattern = match params.pattern {
        ScanPattern::Rotating => "rotating",
        ScanPattern::Oscillating(_) => "oscillating",
        ScanPattern::Conical { .. } => "conical",
    };
    let mut section = Summary::default();
    section
        .add("pattern", pattern)
        .add("flying_height_m", rounded(params.flying_height, 1))
        .add("strips", params.strip_count + params.cross_strip_count)
        .add("strip_width_m", rounded(params.swath(), 1))
        .add("strip_spacing_m", rounded(params.strip_spacing, 1))
        .add("pulses_per_second", whole(params.pulse_rate()))
        .add("lines_per_second", rounded(params.line_rate(), 1));
    section
}

fn terrestrial_section(params: &TerrestrialParams, scan: &Scan) -> Summary {
    let mut section = Summary::default();
    section
        .add("stations", scan.stations.len())
        .add("pulses_per_station", params.pulses_per_station())
        .add("angle_step_deg", rounded(params.angular_step.to_degrees(), 4));
    section
}

fn pulses_section(scan: &Scan) -> Summary {
    let firsts = scan.return_number.iter().zip(&scan.return_count).filter(|(number, _)| **number == 1);
    let (recorded, several) =
        firsts.fold((0, 0), |(all, several), (_, &count)| (all + 1, several + usize::from(count > 1)));
    let mut section = Summary::default();
    section
        .add("pulses_sent", scan.report.pulses)
        .add("pulses_outside_town", scan.report.missed_pulses)
        .add("pulses_lost", scan.report.dropped_pulses)
        .add("pulses_recorded", recorded)
        .add("pulses_with_several_returns_percent", percent(several, recorded));
    section
}

/// Names of the columns for [`SUNS_DEG`].
const SUN_NAMES: [&str; 3] = ["lit_110_20", "lit_180_65", "lit_240_35"];

fn write_lit_cloud(path: &Path, scan: &Scan, lit: &[Vec<u8>; 3]) -> Result<()> {
    let columns: [ExtraColumn<'_>; 3] = std::array::from_fn(|i| ExtraColumn {
        name: SUN_NAMES[i],
        description: "1 lit 0 in shadow, by the mesh",
        values: ExtraValues::U8(&lit[i]),
    });
    write_cloud(path, &cloud_of(scan)?, &columns)?;
    Ok(())
}

/// Writes the pulses of each place of a tripod, one place after the other.
fn write_grids(path: &Path, grids: &[ScanGrid]) -> Result<()> {
    atomic::write(path, |file| {
        let mut write = |grid: &ScanGrid| file.write_all(grid.to_ptx().as_bytes());
        grids.iter().try_for_each(&mut write).map_err(belvedere::Error::io(path))
    })?;
    Ok(())
}

/// Writes where the scanner was; the names of the files.
fn write_paths(folder: &Path, scan: &Scan) -> Result<Vec<&'static str>> {
    let path = &scan.sensor_path;
    let trajectory = Trajectory { times: path.times.clone(), positions: path.positions.clone() };
    let mut files = vec!["trajectory.csv", "trajectory.sbet"];
    for name in &files {
        let headings = VehicleHeading::Given(&path.headings);
        write_trajectory(&folder.join(name), &trajectory, GpsTimeKind::AdjustedStandard, &crs()?, headings)?;
    }
    if !scan.stations.is_empty() {
        write_text(&folder.join("stations.csv"), &scan.stations_to_csv())?;
        files.push("stations.csv");
    }
    Ok(files)
}

/// Writes what was scanned; the names of the files.
fn write_meshes(folder: &Path, scene: &TriangleScene) -> Result<Vec<&'static str>> {
    let files = vec!["mesh.obj", "mesh.city.json", "blocks.obj"];
    let texts = [scene.to_obj(), scene.to_cityjson(&scene.parts, EPSG), blocks(scene).to_obj()];
    for (name, text) in files.iter().zip(texts) {
        write_text(&folder.join(name), &text)?;
    }
    Ok(files)
}
