//! One file per command.

mod balls;
mod cameras;
mod city;
mod comfort;
#[cfg(feature = "compare")]
mod compare;
mod demo;
mod depth_map;
mod describe;
mod difference;
mod envelope;
mod far_terrain;
mod heights;
mod horizon;
mod info;
mod irradiance;
mod isovist;
mod landmark;
mod line_of_sight;
mod mesh_targets;
mod normals;
mod north;
mod protected_view;
mod query;
mod shadow;
mod shapes;
mod sights;
mod simulate;
mod sky_view;
mod sun;
mod sun_hours;
mod sun_position;
mod surroundings;
mod targets;
mod trajectory;
mod tree_light;
#[cfg(feature = "view")]
mod view;
mod viewshed;
mod window_views;
mod windows;

use crate::arguments::{Cli, Command, Usage};
use crate::help;
use crate::summary::Summary;
use anyhow::{Context, Result, bail};
use belvedere::crs::Crs;
use belvedere::io::{ExtraColumn, ExtraValues, Source, atomic};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Runs the command that was typed.
pub(crate) fn run(cli: &Cli) -> Result<Summary> {
    let global = &cli.global;
    if let Some(threads) = global.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().context("--threads")?;
    }
    crate::device::choose(global)?;
    let mut summary = run_command(cli)?;
    crate::device::report(&mut summary);
    Ok(summary)
}

fn run_command(cli: &Cli) -> Result<Summary> {
    let global = &cli.global;
    match &cli.command {
        Command::Demo(arguments) => demo::run(arguments, global),
        Command::Simulate(arguments) => simulate::run(arguments, global),
        Command::Info(arguments) => info::run(arguments, global),
        Command::Trajectory(arguments) => trajectory::run(arguments, global),
        Command::Normals(arguments) => normals::run(arguments, global),
        Command::Balls(arguments) => balls::run(arguments, global),
        Command::DepthMap(arguments) => depth_map::run(arguments, global),
        Command::Query(arguments) => query::run(arguments, global),
        Command::LineOfSight(arguments) => line_of_sight::run(arguments, global),
        Command::Viewshed(arguments) => viewshed::run(arguments, global),
        Command::Landmark(arguments) => landmark::run(arguments, global),
        Command::ProtectedView(arguments) => protected_view::run(arguments, global),
        Command::Cameras(arguments) => cameras::run(arguments, global),
        Command::Isovist(arguments) => isovist::run(arguments, global),
        Command::Horizon(arguments) => horizon::run(arguments, global),
        Command::Shadow(arguments) => shadow::run(arguments, global),
        Command::SkyView(arguments) => sky_view::run(arguments, global),
        Command::Irradiance(arguments) => irradiance::run(arguments, global),
        Command::SunHours(arguments) => sun_hours::run(arguments, global),
        Command::SunPosition(arguments) => sun_position::run(arguments, global),
        Command::Envelope(arguments) => envelope::run(arguments, global),
        Command::Comfort(arguments) => comfort::run(arguments, global),
        Command::WindowViews(arguments) => window_views::run(arguments, global),
        #[cfg(feature = "view")]
        Command::View(arguments) => view::run(arguments, global),
        Command::City(arguments) => city::run(arguments, global),
        #[cfg(feature = "compare")]
        Command::Compare(arguments) => compare::run(arguments, global),
        Command::Difference(arguments) => difference::run(arguments, global),
        Command::Describe => Ok(describe::run()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut help::command(), "belvedere", &mut script);
            print_raw(&script)
        }
        Command::Man => {
            let mut page = Vec::new();
            clap_mangen::Man::new(help::command()).render(&mut page)?;
            print_raw(&page)
        }
    }
}

fn print_raw(text: &[u8]) -> Result<Summary> {
    let mut output = std::io::stdout().lock();
    output.write_all(text).and_then(|()| output.flush()).context("standard output")?;
    Ok(Summary::default())
}

/// The extension of a path in lower case, empty where it has none.
fn extension(path: &Path) -> String {
    Source::path(path).extension()
}

/// Normals as columns of their own, for formats that have no other place for them.
struct NormalColumns([Vec<f32>; 3]);

impl NormalColumns {
    fn new(normals: &[[f32; 3]]) -> Self {
        Self([0, 1, 2].map(|axis| normals.iter().map(|n| n[axis]).collect()))
    }

    /// The columns under the names that readers of the format at `path` look for.
    fn columns(&self, path: &Path) -> [ExtraColumn<'_>; 3] {
        let names = if is_las(path) { ["NormalX", "NormalY", "NormalZ"] } else { ["nx", "ny", "nz"] };
        let descriptions = ["outward unit normal, east", "outward unit normal, north", "outward unit normal, up"];
        std::array::from_fn(|axis| ExtraColumn {
            name: names[axis],
            description: descriptions[axis],
            values: ExtraValues::F32(&self.0[axis]),
        })
    }
}

fn is_las(path: &Path) -> bool {
    matches!(extension(path).as_str(), "las" | "laz")
}

/// Whether an output is meant as a folder: it is one, or its name has no extension.
fn is_folder(path: &Path) -> bool {
    path.is_dir() || extension(path).is_empty()
}

/// Refuses an output of an unknown format or in a folder that is not there, before hours of work go into it.
fn check_output(flag: &str, path: &Path, known: &[&str]) -> Result<()> {
    if !known.contains(&extension(path).as_str()) {
        let known = known.join(" .");
        return Err(Usage(format!("{flag} {}: the extension must be one of .{known}", path.display())).into());
    }
    check_parent(path)
}

/// Warns of GeoJSON whose coordinates are not those that its standard promises.
fn warn_of_geojson(outputs: &[PathBuf], crs: &Crs, summary: &mut Summary) {
    if !outputs.iter().any(|output| extension(output) == "geojson") || crs.geographic_projection().is_ok() {
        return;
    }
    summary.warn(
        "geojson-without-reference-system",
        "GeoJSON has the coordinates of the cloud, not longitude and latitude: the reference system of the scene is unknown. Other \
                   programs will misplace it; give --crs EPSG:CODE where the balls are built",
    );
}

/// Refuses an output in a folder that is not there.
fn check_parent(path: &Path) -> Result<()> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            bail!("{}: the folder {} does not exist; create it first", path.display(), parent.display())
        }
        _ => Ok(()),
    }
}

/// Refuses an output folder that cannot be made, before hours of work go into it.
fn check_folder(path: &Path) -> Result<()> {
    let is_new = !path.exists();
    atomic::make_folder(path)?;
    if is_new {
        std::fs::remove_dir(path).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Whether a folder in the layout of masbcpp is written where it was read. Its coordinates then stay as they are: they may be finer than
/// the f32 of the layout.
fn is_written_back(inputs: &[PathBuf], folder: &Path) -> bool {
    let same = |a: &Path, b: &Path| matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b);
    inputs.iter().any(|input| same(input, folder) || same(input, &folder.join("coords.npy")))
}
