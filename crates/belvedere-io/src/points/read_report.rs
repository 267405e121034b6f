//! The report of reading a cloud.

use std::path::PathBuf;

use belvedere_data::contradiction::FoundContradiction;
use serde::{Serialize, Serializer, ser::SerializeMap};

/// Report of reading a cloud.
#[derive(Clone, Debug, Default)]
pub struct ReadReport {
    /// One entry per file, in the order of their points.
    pub files: Vec<FileReport>,
    /// The reference system of the cloud in words, see [`Crs::describe`](belvedere_data::crs::Crs::describe).
    pub crs: String,
    /// Source of it, such as "WKT record" or "option"; empty if none is known.
    pub crs_source: String,
    /// Evidence in the files against the reference system; `None` without any.
    pub doubt: Option<String>,
    /// Attributes that only some of the files have and the cloud therefore lacks.
    pub dropped_attributes: Vec<&'static str>,
    /// Files of a folder that are no point clouds although their names look so: tables of something else, such as
    /// trajectories, and grids of heights.
    pub skipped_files: Vec<PathBuf>,
    /// Notes for users of the cloud.
    pub notes: Vec<String>,
    /// Contradictions in folders and catalogues.
    pub contradictions: Vec<FoundContradiction>,
    /// Row of each point among the points of its file, from 0, where
    /// [`ReadOptions::row_numbers`](crate::ReadOptions::row_numbers) requests it; empty otherwise. The points of the
    /// files follow each other as in `files`.
    pub rows: Vec<u64>,
}

/// Report of reading one file.
#[derive(Clone, Debug, Default)]
pub struct FileReport {
    /// The path, or the name of the source.
    pub path: PathBuf,
    /// Its format, such as "LAS 1.2, point format 1, LAZ".
    pub format: String,
    /// Points taken from it.
    pub points: usize,
    /// Points left out, by reason.
    pub left_out: Vec<LeftOut>,
    /// Number of points that the header announces but the file lacks: it is cut off.
    pub missing_points: usize,
    /// Names of the attributes found, as in [`belvedere_data::cloud::Attributes::columns`].
    pub attributes: Vec<&'static str>,
    /// Its reference system in words; empty where it gives none.
    pub crs: String,
    /// Source of it; empty if there is none.
    pub crs_source: String,
    /// Oddities of the file.
    pub notes: Vec<String>,
    /// Contradictions in it, and with the announcements of other files.
    pub contradictions: Vec<FoundContradiction>,
}

/// Points left out for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Number of points.
    pub count: usize,
    /// Why.
    pub reason: String,
}

impl ReadReport {
    /// Points left out of all files.
    #[must_use]
    pub fn left_out_count(&self) -> usize {
        self.files.iter().flat_map(|file| &file.left_out).map(|left_out| left_out.count).sum()
    }

    /// Returns the contradictions in all files, each with the name of its file.
    #[must_use]
    pub fn contradictions(&self) -> Vec<FoundContradiction> {
        let of_files = self.files.iter().flat_map(|file| {
            let name = file.path.display();
            file.contradictions
                .iter()
                .map(move |found| FoundContradiction { text: format!("{name}: {}", found.text), ..found.clone() })
        });
        self.contradictions.iter().cloned().chain(of_files).collect()
    }
}

/// Reference system, points left out by reason, attributes that only some files have, and notes that begin with the
/// name of the file they are about.
impl Serialize for ReadReport {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let left_out: Vec<String> = self
            .files
            .iter()
            .flat_map(|file| &file.left_out)
            .map(|left_out| format!("{} {}", left_out.count, left_out.reason))
            .collect();
        let of_files = self.files.iter().flat_map(|file| {
            let name = file.path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
            file.notes.iter().map(move |note| format!("{name}: {note}"))
        });
        let notes: Vec<String> = self.doubt.iter().chain(&self.notes).cloned().chain(of_files).collect();
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("reference_system", if self.crs.is_empty() { "unknown" } else { &self.crs })?;
        map.serialize_entry("left_out", &left_out)?;
        map.serialize_entry("attributes_not_in_every_file", &self.dropped_attributes)?;
        if !self.skipped_files.is_empty() {
            let names: Vec<String> = self.skipped_files.iter().map(|file| file.display().to_string()).collect();
            map.serialize_entry("skipped_file_count", &names.len())?;
            map.serialize_entry("skipped_tables", &names)?;
        }
        map.serialize_entry("notes", &notes)?;
        let contradictions: Vec<String> = self.contradictions().into_iter().map(|found| found.text).collect();
        if !contradictions.is_empty() {
            map.serialize_entry("contradictions", &contradictions)?;
        }
        map.end()
    }
}
