//! Key of a kept scene: a name for all that it follows from.

use crate::PointCloud;
use crate::ground::{GroundParams, MapGrid};
use crate::io::{ReadOptions, Source, cloud_sources, web_address};
use crate::model::ModelParams;
use belvedere_data::attribute_columns;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};

/// The version of the program, and in its workspace the sources of the algorithms and of reading.
const PROGRAM: &str = concat!(env!("CARGO_PKG_VERSION"), " ", env!("BELVEDERE_SOURCES"));

/// Returns the SHA-256 of the contents of a file in hexadecimal digits.
///
/// # Errors
/// [`crate::Error::Io`].
#[cfg(feature = "figures")]
pub(crate) fn file_hash(path: &Path) -> crate::Result<String> {
    let mut file = File::open(path).map_err(crate::Error::io(path))?;
    let mut hasher = Sha256::new();
    std::io::copy(&mut file, &mut hasher).map_err(crate::Error::io(path))?;
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

/// The contents of a cloud: all that a scene of it follows from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CloudKey(pub(super) String);

impl CloudKey {
    /// The key of a cloud in memory.
    #[must_use]
    pub fn of(cloud: &PointCloud) -> Self {
        let mut key = Key::new("cloud");
        key.text(&format!("{:?}", cloud.frame));
        key.column("positions", Some(cloud.positions.as_flattened()));
        key.column("scanners", Some(cloud.scanner_positions.as_flattened()));
        for region in &cloud.sky_regions {
            // Debug prints every number so that it is read back as it is
            key.text(&format!("sky {region:?}"));
        }
        key.column("cleared", Some(cloud.cleared_places.as_flattened()));
        let attributes = &cloud.attributes;
        key.text(&format!("{:?}", attributes.gps_time_kind));
        macro_rules! columns {
            ($($(#[$doc:meta])* $column:ident: $value:ty,)*) => {
                $(key.column(stringify!($column), attributes.$column.as_deref());)*
            };
        }
        attribute_columns!(columns);
        Self(key.finish())
    }

    /// The key of a ball file; `None` for one on a server, which may change, and for one that cannot be read.
    pub(super) fn of_file(path: &Path) -> Option<Self> {
        let mut key = Key::new("balls");
        key.file(path).filter(|()| web_address(path).is_none())?;
        Some(Self(key.finish()))
    }

    /// The name of the scene of a cloud, which differs where anything does that the scene follows from.
    #[must_use]
    pub fn of_scene(&self, params: &ModelParams, has_normals: bool) -> String {
        let mut key = Key::new("scene");
        key.text(&self.0);
        key.text(if has_normals { "with normals" } else { "without" });
        // Debug prints every number so that it is read back as it is
        let _ = write!(key, "{params:?}");
        key.finish()
    }

    /// The name of the index of the ground of a cloud.
    pub(super) fn of_ground_index(&self, params: &GroundParams) -> String {
        let mut key = Key::new("ground index");
        key.text(&self.0);
        key.text(&format!("{params:?}"));
        key.finish()
    }

    /// The name of the ground of a cloud.
    pub(super) fn of_ground(&self, grid: &MapGrid, params: &GroundParams) -> String {
        let mut key = Key::new("ground");
        key.text(&self.0);
        key.text(&format!("{grid:?} {params:?}"));
        key.finish()
    }
}

/// The name of what reading these files gives: their contents, with what lies beside them under the same name, and how
/// they are read. `None` for files on servers, which may change, and for what cannot be read.
pub(super) fn of_files(paths: &[PathBuf], options: &ReadOptions) -> Option<String> {
    let mut key = Key::new("files");
    key.text(&format!("{paths:?} {options:?}"));
    if paths.iter().any(|path| web_address(path).is_some()) {
        return None;
    }
    let mut folders = BTreeMap::new();
    let (sources, contradictions) = cloud_sources(paths).ok()?;
    key.text(&format!("{contradictions:?}"));
    for source in sources {
        key.text(&source.announced_in_words());
        let file = source.name().to_owned();
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        let files = match folders.entry(folder) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(folder) => {
                let files = by_stem(folder.key())?;
                folder.insert(files)
            }
        };
        let together = files.get(file.file_stem()?)?;
        if !together.iter().any(|path| path.file_name() == file.file_name()) {
            return None;
        }
        for file in together {
            key.text(&file.to_string_lossy());
            key.file(file)?;
        }
        // a system beside a file may stand under another stem, or in another folder
        key.text(&format!("{:?}", Source::path(&file).system_beside()));
    }
    Some(key.finish())
}

/// The files of a folder, together where they differ in the extension alone.
fn by_stem(folder: &Path) -> Option<BTreeMap<OsString, Vec<PathBuf>>> {
    let mut files: Vec<PathBuf> = folder.read_dir().ok()?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    let mut together: BTreeMap<OsString, Vec<PathBuf>> = BTreeMap::new();
    for file in files.into_iter().filter(|file| file.is_file()) {
        let Some(stem) = file.file_stem() else { continue };
        together.entry(stem.to_owned()).or_default().push(file);
    }
    Some(together)
}

/// A sum of everything that is given to it, each with its length, so that none runs into the next.
struct Key(Sha256);

impl Key {
    fn new(what: &str) -> Self {
        let mut key = Self(Sha256::new());
        key.text(PROGRAM);
        key.text(what);
        key
    }

    fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    fn column<T: bytemuck::Pod>(&mut self, name: &str, values: Option<&[T]>) {
        self.text(name);
        self.text(if values.is_some() { "present" } else { "absent" });
        self.bytes(bytemuck::cast_slice(values.unwrap_or_default()));
    }

    fn file(&mut self, path: &Path) -> Option<()> {
        let mut contents = Key(Sha256::new());
        std::io::copy(&mut File::open(path).ok()?, &mut contents.0).ok()?;
        self.text(&contents.finish());
        Some(())
    }

    fn finish(self) -> String {
        self.0.finalize().iter().take(16).fold(String::new(), |mut text, byte| {
            let _ = write!(text, "{byte:02x}");
            text
        })
    }
}

impl std::fmt::Write for Key {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::GpsTimeKind;

    #[test]
    fn a_key_depends_on_every_number_of_a_cloud_and_of_the_parameters() {
        let cloud = PointCloud { positions: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], ..PointCloud::default() };
        let mut other = cloud.clone();
        let key = CloudKey::of(&cloud);
        assert_eq!(key, CloudKey::of(&other));
        other.positions[1][2] = f32::from_bits(6.0_f32.to_bits() + 1);
        assert_ne!(key, CloudKey::of(&other));
        other = cloud.clone();
        other.frame.origin[0] = 1.0;
        assert_ne!(key, CloudKey::of(&other));
        other = cloud.clone();
        other.attributes.gps_time_kind = GpsTimeKind::AdjustedStandard;
        assert_ne!(key, CloudKey::of(&other));
        // the same bytes in another column
        let [mut flags, mut counts] = [cloud.clone(), cloud.clone()];
        flags.attributes.flags = Some(vec![1, 2]);
        counts.attributes.return_count = Some(vec![1, 2]);
        assert_ne!(CloudKey::of(&flags), CloudKey::of(&counts));
        let params = ModelParams::default();
        let mut changed = params.clone();
        assert_eq!(key.of_scene(&params, true), key.of_scene(&changed, true));
        assert_ne!(key.of_scene(&params, true), key.of_scene(&params, false));
        changed.orient = crate::model::OrientBy::Up;
        assert_ne!(key.of_scene(&params, true), key.of_scene(&changed, true));
    }

    #[test]
    fn a_key_of_files_follows_what_is_in_them_and_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tile.xyz");
        let key = || of_files(std::slice::from_ref(&path), &ReadOptions::default());
        assert_eq!(key(), None);
        std::fs::write(&path, "1 2 3\n").unwrap();
        let first = key().unwrap();
        assert_eq!(key(), Some(first.clone()));
        std::fs::write(folder.path().join("other.prj"), "a").unwrap();
        assert_eq!(key(), Some(first.clone()));
        std::fs::write(folder.path().join("tile.prj"), "a").unwrap();
        let beside = key().unwrap();
        assert_ne!(beside, first);
        std::fs::write(&path, "1 2 4\n").unwrap();
        assert!(![Some(first), Some(beside)].contains(&key()));
        // a system beside a file of another stem, and that of point tiles
        let copc = folder.path().join("part.copc.laz");
        std::fs::write(&copc, "points").unwrap();
        let of_copc = || of_files(std::slice::from_ref(&copc), &ReadOptions::default());
        let without = of_copc().unwrap();
        std::fs::write(folder.path().join("part.prj"), "EPSG:28992").unwrap();
        let dutch = of_copc().unwrap();
        std::fs::write(folder.path().join("part.prj"), "EPSG:25832").unwrap();
        assert!(without != dutch && dutch != of_copc().unwrap());
        let tiles = folder.path().join("ept");
        std::fs::create_dir_all(tiles.join("ept-data")).unwrap();
        std::fs::create_dir_all(tiles.join("ept-hierarchy")).unwrap();
        std::fs::write(tiles.join("ept-data/0-0-0-0.laz"), "points").unwrap();
        let of_tiles = |code: u32, count: u32| {
            let description = format!(
                r#"{{"dataType": "laszip", "bounds": [0, 0, 0, 8, 8, 8], "srs": {{"authority": "EPSG", "horizontal": "{code}"}}}}"#
            );
            std::fs::write(tiles.join("ept.json"), description).unwrap();
            std::fs::write(tiles.join("ept-hierarchy/0-0-0-0.json"), format!(r#"{{"0-0-0-0": {count}}}"#)).unwrap();
            of_files(std::slice::from_ref(&tiles), &ReadOptions::default()).unwrap()
        };
        let first = of_tiles(28_992, 7);
        assert!(first == of_tiles(28_992, 7) && first != of_tiles(25_832, 7) && first != of_tiles(28_992, 8));
        let options = ReadOptions::default().with_classes([2]);
        assert_ne!(of_files(std::slice::from_ref(&path), &options), key());
        let address = PathBuf::from("https://example.org/tile.laz");
        assert_eq!(of_files(&[address], &ReadOptions::default()), None);
    }
}
