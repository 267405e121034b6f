//! The reference system that stands beside a file.

#[cfg(feature = "las")]
use crate::files::source::Content;
use crate::files::source::{Source, SystemBeside};
#[cfg(feature = "las")]
use crate::las::ept;
use belvedere_data::crs::Crs;
use std::path::Path;

/// Well-known text longer than this names no system.
const MAX_PRJ_BYTES: usize = 1 << 20;

impl Source<'_> {
    /// The system of the source where it names none itself: that of its entwine point tiles, or of the file with the
    /// extension `.prj` beside it on this machine. `None` where there is neither.
    #[must_use]
    pub fn system_beside(&self) -> Option<SystemBeside> {
        let found = self.system.clone();
        #[cfg(feature = "las")]
        let found = found.or_else(|| match &self.content {
            Content::Path => ept::system_of_node(&self.name),
            Content::Reader(_) => None,
        });
        found.or_else(|| if self.is_on_disk() { prj_beside(&self.name) } else { None })
    }
}

/// Reads a file `.prj` beside `path`: `tile.prj` beside `tile.laz`, and beside `tile.copc.laz` too.
fn prj_beside(path: &Path) -> Option<SystemBeside> {
    let whole = path.file_stem()?;
    let short = Path::new(whole).file_stem().filter(|short| *short != whole);
    let names = [Some(whole), short].into_iter().flatten().flat_map(|stem| {
        ["prj", "PRJ"].map(|extension| {
            let mut name = stem.to_owned();
            name.push(".");
            name.push(extension);
            path.with_file_name(name)
        })
    });
    let found = names.into_iter().find(|name| name.is_file())?;
    let found_in = found.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let text = Source::path(&found).read_text().ok().filter(|(_, bytes)| bytes.len() <= MAX_PRJ_BYTES);
    let text = text.map(|(_, bytes)| String::from_utf8_lossy(&bytes).into_owned());
    match text.and_then(|text| Crs::parse(text.trim()).ok()) {
        Some(crs) => Some(SystemBeside::Known { crs, found_in }),
        None => Some(SystemBeside::Unreadable { found_in }),
    }
}
