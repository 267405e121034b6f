//! Regenerates the experiments of the paper: Peters, Ledoux & Biljecki 2015, section 4.
//!
//! `cargo research paper -- OUTDIR` writes pictures like Figures 4 to 7 and `tables.md` with every figure that
//! docs/paper.md quotes. Data are looked for under `BELVEDERE_TEST_DATA` (default: `shared` beside the repository);
//! data sets that are not there are skipped, and the run says so.
#![allow(clippy::print_stdout, reason = "an example reports on the terminal")]
#![allow(clippy::cast_possible_truncation, reason = "sizes of pictures and local coordinates are small")]

mod experiment;
mod figures;
mod findings;
mod model;

use belvedere::Result;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud, read_mesh};
use belvedere::medial::ShrinkParams;
use experiment::{Look, compare_profiles, oblique, top_down};
use model::{NormalMethod, PaperModel, unlimited_tau, within_window};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A housing block inside the area of the city model, EPSG:28992: west, south, east, north. The paper's block has 24
/// 647 points.
const BLOCK: [f64; 4] = [84_905.0, 447_551.0, 84_955.0, 447_601.0];
/// A pitched roof, and a row of trees along a canal, for close views; EPSG:28992 as above.
pub(crate) const ROOF: [f64; 4] = [84_932.0, 447_578.0, 84_955.0, 447_601.0];
pub(crate) const TREES: [f64; 4] = [84_870.0, 447_500.0, 84_895.0, 447_525.0];
/// Towards the viewer of the oblique views: azimuth (clockwise from north) and elevation, degrees.
const VIEWER: [f64; 2] = [225.0, 35.0];
/// Neighbours for normals, besides the point itself.
const PAPER_K: usize = 6;

/// Tables in Markdown, printed as they grow.
#[derive(Default)]
pub(crate) struct Tables(String);

impl Tables {
    pub(crate) fn line(&mut self, line: &str) {
        println!("{line}");
        // writing to a String cannot fail
        let _ = writeln!(self.0, "{line}");
    }
}

/// The file or folder at `relative` below the test data, or `None` after saying that it is not there.
fn data(relative: &str) -> Option<PathBuf> {
    let root = std::env::var_os("BELVEDERE_TEST_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared")), PathBuf::from);
    let path = root.join(relative);
    if path.exists() {
        return Some(path);
    }
    println!("SKIPPED: {relative} is not under BELVEDERE_TEST_DATA");
    None
}

fn main() -> Result<()> {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        println!("say where to write to: cargo research paper -- OUTDIR");
        return Ok(());
    };
    std::fs::create_dir_all(&folder).map_err(belvedere::Error::io(&folder))?;
    let mut tables = Tables::default();
    artificial(&folder, &mut tables)?;
    amsterdam(&mut tables)?;
    delft(&folder, &mut tables)?;
    findings::simulated_town(&mut tables)?;
    let path = folder.join("tables.md");
    std::fs::write(&path, tables.0).map_err(belvedere::Error::io(&path))
}

/// The paper's first data set.
fn artificial(folder: &Path, tables: &mut Tables) -> Result<()> {
    let Some(path) = data("data/house_dyke_tree/house_dyke_tree.points.ply") else { return Ok(()) };
    let (cloud, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none())?;
    tables.line("\n## House, dyke and tree\n");
    if let Some(path) = data("reference/house_dyke_tree") {
        let (reference, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none())?;
        if let (Some(a), Some(b)) = (&cloud.attributes.normals, &reference.attributes.normals) {
            let agree = a.iter().zip(b).filter(|(a, b)| (0..3).map(|i| a[i] * b[i]).sum::<f32>() > 0.99).count();
            tables.line(&format!("normals of the PLY that equal those given to masbcpp: {agree} of {}", a.len()));
        }
    }
    let model = PaperModel::of_given_normals(cloud, ShrinkParams::angles())?;
    model.report(tables);
    let views = [("top-down", top_down(&model, 40.0)?), ("oblique", oblique(&model, VIEWER, 40.0)?)];
    let looks = compare_profiles(&model, &views, tables)?;
    figures::artificial(folder, &model, &looks[1])
}

/// A tile whose balls and shares were measured with masbcpp.
fn amsterdam(tables: &mut Tables) -> Result<()> {
    let Some(path) = data("reference/amsterdam") else { return Ok(()) };
    let (cloud, _) = read_cloud(&[path], &ReadOptions::default(), &Control::none())?;
    tables.line("\n## Amsterdam\n");
    let model = PaperModel::of_given_normals(cloud, ShrinkParams::angles())?;
    model.report(tables);
    let views = [("top-down", top_down(&model, 10.0)?), ("oblique", oblique(&model, VIEWER, 10.0)?)];
    compare_profiles(&model, &views, tables)?;
    Ok(())
}

/// A real tile and a housing block of it, oriented with a city model as in the paper.
fn delft(folder: &Path, tables: &mut Tables) -> Result<()> {
    let (Some(tile), Some(city)) = (data("data/delft_ahn3/ahn3_cropped_1.laz"), data("data/delft_ahn3/testarea.obj"))
    else {
        return Ok(());
    };
    let options = ReadOptions::new().with_crs("EPSG:7415");
    let (cloud, _) = read_cloud(&[tile], &options, &Control::none())?;
    let (mesh, _) = read_mesh(&city)?;
    let block = within_window(&cloud, BLOCK);
    let way = NormalMethod { neighbors: PAPER_K, mesh: &mesh };

    tables.line("\n## Delft, a housing block\n");
    let model = PaperModel::of_scan(&block, &way, ShrinkParams::angles())?;
    model.report(tables);
    let views = [("top-down", top_down(&model, 10.0)?), ("oblique", oblique(&model, VIEWER, 10.0)?)];
    let looks = compare_profiles(&model, &views, tables)?;
    let tau = PaperModel::of_scan(&block, &way, unlimited_tau())?;
    figures::block(folder, &model, &tau, &looks[1])?;
    figures::close_views(folder, &cloud, &way)?;

    tables.line("\n## Delft, the whole tile\n");
    let model = PaperModel::of_scan(&cloud, &way, ShrinkParams::angles())?;
    model.report(tables);
    let views = [("top-down", top_down(&model, 4.0)?), ("oblique", oblique(&model, VIEWER, 4.0)?)];
    let looks: Vec<Look> = compare_profiles(&model, &views, tables)?;
    figures::tile(folder, &model, &looks[1])?;
    findings::delft(model, &cloud, &mesh, tables)
}
