//! The report of reading a cloud.

use super::read_cloud::ReadReport;
use serde::{Serialize, Serializer, ser::SerializeMap};

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
            map.serialize_entry("skipped_files_without_x_y_z", &names)?;
        }
        map.serialize_entry("notes", &notes)?;
        map.end()
    }
}
