//! Towns with exact answers: folders of another simulator, and those of our own.

use super::AnyResult;
use belvedere::PointCloud;
use belvedere::cloud::to_local;
use belvedere::control::Control;
use belvedere::io::{ReadOptions, read_cloud};
use belvedere::view::to_sun;
use belvedere_baselines::simulated::{SurveyedScene, preset};
use belvedere_scenes::QuerySet;
use npyz::{Deserialize, NpyFile};
use std::fs::File;
use std::io::Read;
use std::path::Path;
use zip::ZipArchive;

/// Azimuths from grid north and elevations of suns.
pub(super) const SUNS_DEG: [[f64; 2]; 3] = [[110.0, 20.0], [180.0, 65.0], [240.0, 35.0]];
/// Names of targets in files, and what our own simulator calls them.
const SETS: [(&str, QuerySet); 3] =
    [("pedestrians", QuerySet::Pedestrians), ("roofs", QuerySet::Roofs), ("facades", QuerySet::Facades)];
/// Corner of the exact towns in their reference system, metres.
const CORNER: [f64; 3] = [576_000.0, 5_073_500.0, 120.0];
/// Extent of simulated towns, metres, and their pulses a square metre.
const EXTENT: f64 = 150.0;
const DENSITY: f64 = 12.0;
/// Targets of each kind in simulated towns, and people in their streets.
const TARGETS: usize = 6000;
const PEOPLE: usize = 120;

/// A cloud, and questions with exact answers.
pub(super) struct JudgedTown {
    pub(super) cloud: PointCloud,
    pub(super) sets: Vec<JudgedSet>,
    /// Eyes and those they look at, local metres, and whether they are hidden from each other.
    pub(super) street: (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<bool>),
}

/// Targets of a kind, local metres, and whether each is dark under each sun.
pub(super) struct JudgedSet {
    pub(super) name: &'static str,
    pub(super) targets: Vec<[f32; 3]>,
    pub(super) blocked: Vec<Vec<bool>>,
}

impl JudgedTown {
    /// The town of a folder, or of a kind and a seed.
    pub(super) fn new(name: &str) -> AnyResult<Self> {
        match name.split_once(':') {
            Some((kind, seed)) if !Path::new(name).exists() => Self::simulated(kind, seed.parse()?),
            _ => Self::of_folder(Path::new(name)),
        }
    }

    fn of_folder(folder: &Path) -> AnyResult<Self> {
        let (cloud, _) = read_cloud([&*folder.join("cloud.laz")], &ReadOptions::default(), &Control::none())?;
        let mut archive = ZipArchive::new(File::open(folder.join("targets.npz"))?)?;
        let local = |places: Vec<f32>| -> Vec<[f32; 3]> {
            let absolute = |p: &[f32; 3]| std::array::from_fn(|i| f64::from(p[i]) + CORNER[i]);
            places.as_chunks::<3>().0.iter().map(|p| to_local(absolute(p), cloud.frame.origin)).collect()
        };
        let mut sets = Vec::new();
        for (name, _) in SETS {
            let targets = local(array(&mut archive, name)?);
            let mut blocked = Vec::new();
            for [azimuth, elevation] in SUNS_DEG {
                let bits = array(&mut archive, &format!("blocked_{name}_sun_az{azimuth}_el{elevation}"))?;
                blocked.push(unpacked(&bits, targets.len()));
            }
            sets.push(JudgedSet { name, targets, blocked });
        }
        let (eyes, targets) = (local(array(&mut archive, "street_a")?), local(array(&mut archive, "street_b")?));
        let hidden = unpacked(&array(&mut archive, "blocked_street")?, eyes.len());
        Ok(Self { cloud, sets, street: (eyes, targets, hidden) })
    }

    fn simulated(kind: &str, seed: u64) -> AnyResult<Self> {
        let town = SurveyedScene::flown(preset(kind)?, EXTENT, seed, DENSITY)?;
        let site = town.site();
        let places = |set: QuerySet| site.targets(set, TARGETS, seed).positions;
        let set = |(name, kind): (&'static str, QuerySet)| {
            let places = places(kind);
            let blocked = SUNS_DEG.iter().map(|[azimuth, elevation]| {
                town.truth.occluded_towards_each(&places, to_sun(azimuth.to_radians(), elevation.to_radians()))
            });
            let targets = places.iter().map(|&p| town.local(p)).collect();
            JudgedSet { name, blocked: blocked.collect(), targets }
        };
        let sets = SETS.into_iter().map(set).collect();
        let people = site.street_observers(PEOPLE, seed);
        let mut street = (Vec::new(), Vec::new(), Vec::new());
        for (number, &eye) in people.iter().enumerate() {
            for &other in &people[number + 1..] {
                street.0.push(town.local(eye));
                street.1.push(town.local(other));
                street.2.push(town.truth.occluded(other, eye));
            }
        }
        Ok(Self { cloud: town.cloud, sets, street })
    }
}

/// An array of an archive of NumPy.
fn array<T: Deserialize>(archive: &mut ZipArchive<File>, name: &str) -> AnyResult<Vec<T>> {
    let mut bytes = Vec::new();
    archive.by_name(&format!("{name}.npy"))?.read_to_end(&mut bytes)?;
    Ok(NpyFile::new(&bytes[..])?.into_vec()?)
}

/// The first bits of bytes, the most significant of each first.
fn unpacked(bytes: &[u8], count: usize) -> Vec<bool> {
    (0..count).map(|i| bytes.get(i / 8).is_some_and(|byte| byte >> (7 - i % 8) & 1 == 1)).collect()
}
