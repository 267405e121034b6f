//! Folders of surveys in tiles: what in them is the program's, by place and name.

use super::mark::{TAG, is_own_folder, make_new};
use crate::Result;
use std::fs;
use std::path::{Path, PathBuf};

/// The file that says what a survey is of.
pub(super) const PLAN: &str = "plan.json";
/// Endings of files of tiles, behind the name of the tile.
const OF_TILES: [&str; 5] = [".npz", ".pulses.npz", ".crowns.npz", ".json", ".tif"];

/// The folder of a survey in tiles, which the program made itself.
#[derive(Clone, Debug)]
pub struct SurveyFolder {
    path: PathBuf,
}

/// Purpose of a folder within that of a survey.
#[derive(Clone, Copy)]
enum Place {
    /// The survey: its plan, and a folder for each version of its balls.
    Survey,
    /// Balls of one version, ground, and a folder for each plan with questions.
    Version,
    /// A plan with questions, and a folder for each question.
    Run,
    /// Files of tiles.
    Tiles,
    /// Ground of squares.
    Ground,
}

/// Files of the program in a folder and those below it, and the folders, the innermost first.
#[derive(Default)]
struct OwnItems {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl SurveyFolder {
    /// The folder at `path`, made if it is not there.
    ///
    /// # Errors
    /// [`crate::Error::Io`] for a folder that this program did not make, for a link, and for one that cannot be made.
    pub fn make(path: impl Into<PathBuf>) -> Result<Self> {
        let path = path.into();
        make_new(&path)?;
        Ok(Self { path })
    }

    /// The folder at `path`, if this program made it.
    pub(super) fn find(path: PathBuf) -> Option<Self> {
        is_own_folder(&path).then_some(Self { path })
    }

    /// Returns its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes of the files that this program made in it.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.items().files.iter().filter_map(|file| Some(file.symlink_metadata().ok()?.len())).sum()
    }

    /// Removes what this program made in it, file by file, and the folder if nothing else is left. What cannot be
    /// removed stays.
    pub fn remove(&self) {
        let OwnItems { files, folders } = self.items();
        files.iter().for_each(|file| drop(fs::remove_file(file)));
        // a folder with other files is not empty, and stays
        folders.iter().for_each(|folder| drop(fs::remove_dir(folder)));
        let is_rest = |row: std::io::Result<fs::DirEntry>| row.is_ok_and(|row| row.file_name() == TAG);
        if self.path.read_dir().is_ok_and(|mut rows| rows.all(is_rest)) {
            let _ = fs::remove_file(self.path.join(TAG));
            let _ = fs::remove_dir(&self.path);
        }
    }

    fn items(&self) -> OwnItems {
        let mut items = OwnItems::default();
        if is_own_folder(&self.path) {
            items.add(&self.path, Place::Survey);
        }
        items
    }
}

impl OwnItems {
    fn add(&mut self, folder: &Path, place: Place) {
        for row in folder.read_dir().into_iter().flatten().flatten() {
            let (path, name, Ok(kind)) = (row.path(), row.file_name(), row.file_type()) else { continue };
            let Some(name) = name.to_str() else { continue };
            // links are followed by neither
            if kind.is_file() && place.has_file(finished(name), folder) {
                self.files.push(path);
            } else if kind.is_dir()
                && let Some(inner) = place.folder(name)
            {
                let before = self.files.len();
                self.add(&path, inner);
                if self.files.len() > before || inner.is_named() {
                    self.folders.push(path);
                }
            }
        }
    }
}

impl Place {
    /// Returns the purpose of a folder of this name; `None` for one of others.
    fn folder(self, name: &str) -> Option<Self> {
        match (self, name) {
            (Self::Survey, _) => is_sum(name).then_some(Self::Version),
            (Self::Version, "balls") => Some(Self::Tiles),
            (Self::Version, "ground") => Some(Self::Ground),
            (Self::Version, _) => is_sum(name).then_some(Self::Run),
            // questions have names of their own
            (Self::Run, _) => Some(Self::Tiles),
            (Self::Tiles | Self::Ground, _) => None,
        }
    }

    fn has_file(self, name: &str, folder: &Path) -> bool {
        match self {
            Self::Survey => name == PLAN,
            Self::Version => false,
            Self::Run => {
                let of_question = |name: &str| name.strip_suffix(".vrt").is_some_and(|name| folder.join(name).is_dir());
                [PLAN, "report.md"].contains(&name) || of_question(name)
            }
            Self::Tiles => OF_TILES.iter().any(|end| name.strip_suffix(end).is_some_and(is_tile)),
            Self::Ground => name.strip_suffix(".npz").is_some_and(is_sum),
        }
    }

    /// Returns true if the name alone identifies a folder as the program's, even if it is empty.
    fn is_named(self) -> bool {
        !matches!(self, Self::Survey | Self::Tiles)
    }
}

/// A checksum of 32 bits.
fn is_sum(name: &str) -> bool {
    name.len() == 8 && name.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// The name of a tile: `e12_n-3`.
fn is_tile(name: &str) -> bool {
    let parts = name.strip_prefix('e').and_then(|rest| rest.split_once("_n"));
    let is_number = |text: &str| text.parse::<i64>().is_ok_and(|number| number.to_string() == text);
    parts.is_some_and(|(east, north)| is_number(east) && is_number(north))
}

/// The name that an unfinished file will have; other names as they are.
fn finished(name: &str) -> &str {
    let maker = |rest: &str| rest.split('-').count() == 3 && rest.bytes().all(|b| b == b'-' || b.is_ascii_hexdigit());
    let parts = name.strip_prefix('.').and_then(|rest| rest.strip_suffix(".part")?.rsplit_once('.'));
    parts.filter(|(_, rest)| maker(rest)).map_or(name, |(target, _)| target)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_of_the_program_are_its_own() {
        for name in ["e0_n0", "e12_n-3", "e-1_n99999"] {
            assert!(is_tile(name), "{name}");
        }
        for name in ["e1", "e1_n", "e01_n2", "e1_n2 ", "e+1_n2", "tile", "e1_n2_n3", "E1_N2"] {
            assert!(!is_tile(name), "{name}");
        }
        assert!(is_sum("0123abcd") && !is_sum("0123ABCD") && !is_sum("0123abc") && !is_sum("0123abcde"));
        assert_eq!(finished(".e1_n2.npz.0a1b-12-0.part"), "e1_n2.npz");
        for name in [".notes.part", ".e1_n2.npz.part", "e1_n2.npz.0-1-2.part", ".e1_n2.npz.0-1.part"] {
            assert_eq!(finished(name), name);
        }
    }
}
