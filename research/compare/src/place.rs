//! Places to compare on: simulated towns, or a cloud with its exact mesh.

use super::case::Ingredients;
use super::scanners::ComparisonScanner;
use crate::arguments::Compare;
use anyhow::{Result, bail};
use belvedere::Mesh;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{ReadOptions, ReadReport, read_cloud, read_mesh, read_trajectory};
use belvedere_baselines::PlaceModel;
use belvedere_baselines::simulated::surveyed;
use belvedere_scenes::{Material, Preset, Regime, TriangleScene, blocks};
use std::path::{Path, PathBuf};

/// Names of the models of simulated towns.
pub(super) const MODELS: [&str; 3] = ["blocks", "no-trees", "exact"];

/// Reference system that simulated towns lie in: the Dutch grid with heights above NAP.
const SYSTEM: &str = "EPSG:7415";

/// A place by its description.
pub(super) enum ComparisonPlace {
    Simulated { preset: Preset, extent: f64, seed: u64, regime: Regime, pulses_per_m2: f64, is_only_scanner: bool },
    Given { clouds: Vec<PathBuf>, mesh: PathBuf, trajectory: Option<PathBuf>, models: Vec<(String, PathBuf)> },
}

impl ComparisonPlace {
    /// The requested places.
    pub(super) fn all(arguments: &Compare) -> Vec<Self> {
        if let Some(mesh) = &arguments.mesh {
            let models = arguments.model.iter().map(|m| (m.name.clone(), m.file.clone())).collect();
            let (clouds, trajectory) = (arguments.scene.clone(), arguments.trajectory.clone());
            return vec![Self::Given { clouds, mesh: mesh.clone(), trajectory, models }];
        }
        // held-out pulses alone need no town, unless one was requested
        let usual = if arguments.held_out.is_empty() { &[Preset::Town][..] } else { &[] };
        let presets = if arguments.presets.is_empty() { usual } else { &arguments.presets }.iter();
        let scanners: Vec<(Regime, f64)> = arguments
            .regimes
            .iter()
            .flat_map(|&regime| {
                let all = arguments.densities();
                let densities = if regime.flies() { all } else { &all[..1] };
                densities.iter().map(move |&density| (regime, density))
            })
            .collect();
        let mut places = Vec::new();
        for &preset in presets {
            for &seed in &arguments.seeds {
                places.extend(scanners.iter().map(|&(regime, pulses_per_m2)| Self::Simulated {
                    preset,
                    extent: arguments.extent,
                    seed,
                    regime,
                    pulses_per_m2,
                    is_only_scanner: scanners.len() == 1,
                }));
            }
        }
        places
    }

    /// Name in tables and file names.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Simulated { preset, extent, seed, regime, pulses_per_m2, is_only_scanner } => {
                let town = format!("{}-{extent:.0}m-{seed}", preset.name());
                match (is_only_scanner, regime.flies()) {
                    (true, _) => town,
                    (false, true) => format!("{town}-{}-{pulses_per_m2}", regime.name()),
                    (false, false) => format!("{town}-{}", regime.name()),
                }
            }
            Self::Given { clouds, .. } => file_name(clouds.first().map_or(Path::new("scene"), PathBuf::as_path)),
        }
    }

    /// What scans it, where that is simulated.
    pub(super) fn scanner(&self) -> Option<ComparisonScanner> {
        match self {
            Self::Simulated { regime, pulses_per_m2, .. } => {
                let pulses_per_m2 = regime.flies().then_some(*pulses_per_m2);
                Some(ComparisonScanner { name: regime.name().to_owned(), pulses_per_m2 })
            }
            Self::Given { .. } => None,
        }
    }

    /// Everything that its results depend on.
    pub(super) fn made_from(&self) -> String {
        match self {
            Self::Simulated { preset, extent, seed, regime, pulses_per_m2, .. } => {
                let (preset, regime) = (preset.name(), regime.name());
                format!("{preset} {extent} m, seed {seed}, {regime}, {pulses_per_m2} pulses/m2")
            }
            Self::Given { clouds, mesh, trajectory, models } => {
                let files = clouds.iter().chain([mesh]).chain(trajectory).chain(models.iter().map(|(_, file)| file));
                files.map(|file| state_of(file)).collect::<Vec<_>>().join(", ")
            }
        }
    }

    /// Simulates it, or reads it with warnings of files that are cut off.
    pub(super) fn make(&self) -> Result<(Ingredients, Vec<String>)> {
        match self {
            Self::Simulated { preset, extent, seed, regime, pulses_per_m2, .. } => {
                let params = regime.town(preset.params(*extent, *seed));
                let scene = regime.scene(&params);
                let scan = regime.scan(&scene, &params, *pulses_per_m2);
                if scan.x.is_empty() {
                    bail!(
                        "the {} passes nothing in {}: give a larger --extent, 100 at least",
                        regime.name(),
                        self.name()
                    );
                }
                let (mut cloud, scanner) = surveyed(&scan)?;
                // as in the file that `belvedere simulate` writes
                cloud.frame.crs = Crs::parse(SYSTEM)?;
                cloud.attributes.scan_angle = Some(scan.scan_angle_deg.iter().map(|a| a.to_radians()).collect());
                cloud.attributes.intensity = Some(scan.intensity);
                let models = vec![
                    PlaceModel { name: MODELS[0].to_owned(), mesh: mesh_of(&blocks(&scene), |_| true) },
                    PlaceModel { name: MODELS[1].to_owned(), mesh: mesh_of(&scene, |material| !is_loose(material)) },
                    PlaceModel { name: MODELS[2].to_owned(), mesh: mesh_of(&scene, |_| true) },
                ];
                Ok((Ingredients { cloud, scanner, models, scene }, Vec::new()))
            }
            Self::Given { clouds, mesh, trajectory, models } => {
                let (cloud, report) = read_cloud(clouds, &ReadOptions::default(), &Control::none())?;
                let warnings = missing_points(&report);
                let in_metres =
                    |path: &Path| -> Result<Mesh> { Ok(read_mesh(path)?.0.scaled_to_metres(&cloud.frame.crs)) };
                let mesh = in_metres(mesh)?;
                let scene = TriangleScene::from_model(mesh.vertices, mesh.triangles, mesh.objects, mesh.object_names);
                let scanner = match trajectory {
                    Some(path) => read_trajectory(path, &cloud.frame.crs)?.0.scanner_positions(&cloud)?.0,
                    None => Vec::new(),
                };
                let models = models
                    .iter()
                    .map(|(name, path)| Ok(PlaceModel { name: name.clone(), mesh: in_metres(path)? }))
                    .collect::<Result<_>>()?;
                Ok((Ingredients { cloud, scanner, models, scene }, warnings))
            }
        }
    }
}

/// A warning for each file that holds fewer points than its header says.
pub(super) fn missing_points(report: &ReadReport) -> Vec<String> {
    let cut_off = report.files.iter().filter(|file| file.missing_points > 0);
    let warning = |path: &Path, count| {
        format!("{}: the file is cut off: {count} points of its header are missing; copy it again", path.display())
    };
    cut_off.map(|file| warning(&file.path, file.missing_points)).collect()
}

/// Whether city models usually leave it out: vegetation and furniture.
fn is_loose(material: Material) -> bool {
    use Material::{Car, Fence, Leaf, Mast, TreeCrown, Trunk, Wire};
    matches!(material, TreeCrown | Trunk | Leaf | Car | Fence | Mast | Wire)
}

/// The triangles of a scene whose material is wanted.
fn mesh_of(scene: &TriangleScene, wanted: impl Fn(Material) -> bool) -> Mesh {
    let triangles = scene.triangles.iter().zip(&scene.materials).filter(|(_, material)| wanted(**material));
    let triangles = triangles.map(|(corners, _)| *corners).collect();
    Mesh { vertices: scene.vertices.clone(), triangles, ..Mesh::default() }
}

/// A file's name without folder and extension, as a name of its own.
pub(super) fn file_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase()).unwrap_or_default();
    stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
}

/// Path, size and time of change of a file.
pub(super) fn state_of(file: &Path) -> String {
    let state = std::fs::metadata(file).ok();
    let changed = state.as_ref().and_then(|m| m.modified().ok());
    let seconds = changed.and_then(|t| t.duration_since(std::time::UNIX_EPOCH).ok()).map_or(0, |d| d.as_secs());
    format!("{} ({} bytes, {seconds})", file.display(), state.map_or(0, |m| m.len()))
}
