//! Errors by scanner and by density: a table, and curves where there are several densities.

use super::report::{ComparisonResults, pair};
use super::table::TextTable;
use anyhow::Result;
use belvedere::figures::{Curves, Picture, curves_picture, side_by_side, write_png};
use std::path::Path;

/// Sets and views that are shown, with their heading.
const COLUMNS: [(&str, &str, &str); 6] = [
    ("PED", "suns", "PED sun"),
    ("ROOF", "suns", "ROOF sun"),
    ("FACADE", "suns", "FACADE sun"),
    ("OWN", "observers", "OWN eye"),
    ("STREET", "street", "street"),
    ("LOS", "pairs", "LOS"),
];
/// Those of them that have curves.
const CURVES: [(&str, &str, &str); 2] =
    [("PED", "suns", "pedestrians under suns"), ("STREET", "street", "people in streets")];
/// Name of the picture of the curves.
pub(super) const PICTURE: &str = "errors_by_density.png";

/// A scanner and its density, in pulses per square metre, where that was chosen.
#[derive(Clone, PartialEq, serde::Serialize, serde::Deserialize, Debug)]
pub(super) struct ComparisonScanner {
    pub(super) name: String,
    pub(super) pulses_per_m2: Option<f64>,
}

impl ComparisonScanner {
    fn title(&self) -> String {
        match self.pulses_per_m2 {
            Some(density) => format!("{}, {density} pulses/m²", self.name),
            None => self.name.clone(),
        }
    }
}

impl ComparisonResults {
    /// Scanners in the order in which they occur first.
    fn scanners(&self) -> Vec<&ComparisonScanner> {
        let mut scanners: Vec<&ComparisonScanner> = Vec::new();
        for scanner in self.methods.iter().filter_map(|result| result.scanner.as_ref()) {
            if !scanners.contains(&scanner) {
                scanners.push(scanner);
            }
        }
        scanners
    }

    /// Errors of each method with each scanner; `None` where there is only one.
    pub(super) fn by_scanner(&self) -> Option<TextTable> {
        let scanners = self.scanners();
        let headings = COLUMNS.map(|(_, _, heading)| heading);
        let mut table = TextTable::new(
            "False-blocked / false-visible by scanner, %",
            "Means over the places with this scanner.",
            [&["scanner", "method"], headings.as_slice()].concat(),
        );
        for scanner in &scanners {
            let found = self.with(scanner);
            for (key, title) in found.method_names() {
                let cells = COLUMNS.map(|(set, views, _)| {
                    let [blocked, visible] = found.error_shares(key, (set, views));
                    pair(blocked, visible)
                });
                table.add(&scanner.title(), [title.to_owned()].into_iter().chain(cells));
            }
        }
        (scanners.len() > 1).then_some(table)
    }

    /// Writes the curves of errors over the densities of the first scanner that has several, and says whether there is
    /// one.
    pub(super) fn write_curves(&self, folder: &Path) -> Result<bool> {
        let scanners = self.scanners();
        let of_name = |name: &str| -> Vec<&ComparisonScanner> {
            let mut own: Vec<&ComparisonScanner> =
                scanners.iter().copied().filter(|scanner| scanner.name == name).collect();
            own.sort_by(|a, b| a.pulses_per_m2.partial_cmp(&b.pulses_per_m2).unwrap_or(std::cmp::Ordering::Equal));
            own
        };
        let Some(chosen) = scanners.iter().map(|scanner| of_name(&scanner.name)).find(|own| own.len() > 1) else {
            return Ok(false);
        };
        let positions: Vec<String> =
            chosen.iter().filter_map(|scanner| scanner.pulses_per_m2).map(|density| density.to_string()).collect();
        let by_density: Vec<Self> = chosen.iter().map(|scanner| self.with(scanner)).collect();
        let panel = |(set, views, what): (&str, &str, &str), side: usize| {
            let curve = |(key, title): (&str, &str)| {
                let error = |found: &Self| found.error_shares(key, (set, views))[side].map_or(f64::NAN, |v| 100.0 * v);
                (title.to_owned(), by_density.iter().map(error).collect())
            };
            let curves: Vec<(String, Vec<f64>)> = self.method_names().into_iter().map(curve).collect();
            let error = ["false-blocked", "false-visible"][side];
            let title = format!("{what}: {error} %, by pulses/m²");
            curves_picture(&Curves { title: &title, positions: &positions, curves: &curves })
        };
        let rows: Vec<Picture> =
            CURVES.iter().map(|&shown| side_by_side(&[panel(shown, 0), panel(shown, 1)], &["", ""])).collect();
        let [width, height] =
            [rows.iter().map(|row| row.width).max().unwrap_or(0), rows.iter().map(|row| row.height).sum()];
        let mut sheet = Picture::filled(width, height, [255; 3]);
        let mut top = 0;
        for row in &rows {
            sheet.paste(row, [0, top]);
            top += row.height;
        }
        write_png(&folder.join(PICTURE), &sheet)?;
        Ok(true)
    }

    /// What was found with one scanner.
    fn with(&self, scanner: &ComparisonScanner) -> Self {
        let own = self.methods.iter().filter(|result| result.scanner.as_ref() == Some(scanner));
        Self { methods: own.cloned().collect(), ..Self::default() }
    }
}
