//! PTX (Leica) text files: gridded scans, each with its scanner position and a transformation.

use std::io::{BufRead, Read};
use std::path::Path;

use crate::files::source::Input;
use crate::points::file_part::FilePart;
use crate::points::read_options::Reading;
use crate::points::rows::{POSITION, Role, Row, Rows};
use crate::points::sky::ScanGrid;
use crate::text::scan_pose::fault_of_rotation;
use belvedere_data::cast::to_i64;
use belvedere_data::contradiction::{FoundContradiction, SCAN_POSE};
use belvedere_data::{Error, Result};

/// A line longer than this is no point.
const MAX_LINE: u64 = 1 << 12;

/// Lines of a scan's header: two sizes, scanner position and axes, a 4 x 4 matrix.
const HEADER_LINES: usize = 10;

/// The points of all scans of the source. Grid cells at (0, 0, 0), without a return, are no points; those that see the
/// sky show empty space.
///
/// # Errors
/// [`Error::Malformed`] for a header that is no scan's, a transformation that is no rotation with a shift, an
/// unreadable line, or a scan that is cut off.
pub(crate) fn read(input: Input<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let Input { name, reader: file, size } = input;
    let path = name.as_path();
    let mut lines = PtxLines { path, file, number: 0, bytes: Vec::new() };
    let mut part = FilePart::new(path, "PTX");
    let mut rows: Option<(usize, Rows)> = None;
    let mut scanner_index: Vec<u16> = Vec::new();
    let mut empty = 0;
    while let Some(header) = read_header(&mut lines)? {
        if let Some(fault) = header.fault() {
            let scan = part.scanners.len() + 1;
            let what = format!(
                "its transformation, in lines {} to {}, {fault}; only a rotation and a shift can be used, so export the scan again",
                header.line + 6,
                header.line + 9
            );
            return Err(Error::malformed(path, format!("scan {scan}: {what}")));
        }
        if let Some(found) = header.contradiction(part.scanners.len() + 1) {
            part.contradict(found);
        }
        // A point takes at least "0 0 0" and a line break.
        if header.cells.saturating_mul(6) > size + 1 {
            let what = format!("announces {} grid cells, more than its {size} bytes can hold", header.cells);
            return Err(Error::malformed(path, what));
        }
        part.scanners.push(header.scanner);
        let index = u16::try_from(part.scanners.len() - 1).unwrap_or(u16::MAX);
        let mut grid = ScanGrid::new(header.size);
        for cell in 0..header.cells {
            let values = lines.next()?.ok_or_else(|| lines.malformed("ends within a scan"))?;
            let (width, rows) = rows.get_or_insert_with(|| {
                let rows = Rows::new(roles(values.len())).with_numbers(reading.options.row_numbers);
                (values.len(), rows)
            });
            reading.check(rows.count())?;
            if values.len() != *width || *width < 3 {
                return Err(lines.malformed("does not have as many numbers as the first point"));
            }
            if values.starts_with(&[0.0; 3]) {
                empty += 1;
                rows.pass_over();
                continue;
            }
            rows.push(&row(&header, &values));
            scanner_index.push(index);
            if let (Some(grid), &[x, y, z, ..]) = (&mut grid, &values[..]) {
                // column by column
                grid.add_return([cell % header.size[0], cell / header.size[0]], [x, y, z]);
            }
        }
        if let Some(grid) = &mut grid {
            grid.add_all_cells();
            let axes = [0, 1, 2].map(|axis| [0, 1, 2].map(|i| header.matrix[axis][i]));
            part.skies.add(grid, index, axes, reading.options.up);
        }
    }
    let scans = part.scanners.len();
    part.report.format = format!("PTX, {scans} scan{}", if scans == 1 { "" } else { "s" });
    if let Some((_, rows)) = rows {
        rows.finish(&mut part);
        part.attributes.scanner_index = Some(scanner_index);
    }
    part.leave_out(empty, "grid cells without a return");
    Ok(part)
}

/// The head of programs that write the matrix alone: a place of zeros, and the axes of the file.
const NO_HEAD: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

struct PtxHeader {
    /// Its first line, from 1.
    line: usize,
    /// Rows and columns.
    size: [u64; 2],
    cells: u64,
    scanner: [f64; 3],
    /// Position and axes of the scanner as the head of the scan gives them.
    head: [[f64; 3]; 4],
    /// Rows of the matrix that turns scan into file coordinates; points are row vectors multiplied from the left.
    matrix: [[f64; 4]; 4],
}

impl PtxHeader {
    /// Why the matrix is not a rotation with a shift.
    fn fault(&self) -> Option<String> {
        let [x, y, z, shift] = self.matrix;
        if [x[3], y[3], z[3]] != [0.0; 3] || shift[3] != 1.0 {
            return Some("has a last column that is not 0, 0, 0, 1".to_owned());
        }
        if !shift.iter().all(|v| v.is_finite()) {
            return Some("has a shift that is not finite".to_owned());
        }
        fault_of_rotation([x, y, z].map(|[a, b, c, _]| [a, b, c]))
    }

    /// Contradiction of the head of the scan with this number and the matrix; `None` for a head that was not filled.
    fn contradiction(&self, number: usize) -> Option<FoundContradiction> {
        if self.head == NO_HEAD {
            return None;
        }
        let [place, axes @ ..] = self.head;
        let apart = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
        let [x, y, z, _] = self.matrix.map(|[a, b, c, _]| [a, b, c]);
        let (off, turn) =
            (apart(place, self.scanner), (0..3).map(|i| apart(axes[i], [x, y, z][i])).fold(0.0, f64::max));
        if ![off, turn].into_iter().any(|by| SCAN_POSE.is_exceeded_by(by)) {
            return None;
        }
        let line = self.line;
        let text = format!(
            "scan {number}: its head, in lines {} to {}, puts the scanner {off:.2} units from where its matrix does, with axes {turn:.3} apart; the matrix was used",
            line + 2,
            line + 5
        );
        Some(SCAN_POSE.found(text).with("scan", number as f64).with("off", off).with("axes", turn))
    }
}

/// The header of the next scan, or `None` at the end of the file.
fn read_header<R: BufRead>(lines: &mut PtxLines<'_, R>) -> Result<Option<PtxHeader>> {
    let Some(columns) = lines.next()? else { return Ok(None) };
    let line = lines.number;
    let mut all = vec![columns];
    while all.len() < HEADER_LINES {
        all.push(lines.next()?.ok_or_else(|| lines.malformed("ends within the header of a scan"))?);
    }
    let lengths: Vec<usize> = all.iter().map(Vec::len).collect();
    if lengths != [1, 1, 3, 3, 3, 3, 4, 4, 4, 4] {
        return Err(lines.malformed("ends before a complete header of a PTX scan"));
    }
    let value = |line: usize, i: usize| all.get(line).and_then(|v| v.get(i)).copied().unwrap_or(0.0);
    let (columns, rows) = (value(0, 0), value(1, 0));
    if ![columns, rows].iter().all(|n| n.fract() == 0.0 && (0.0..1e9).contains(n)) {
        return Err(lines.malformed("follows a grid size that is not a whole number"));
    }
    let [rows, columns] = [rows, columns].map(|count| to_i64(count).unsigned_abs());
    Ok(Some(PtxHeader {
        line,
        size: [rows, columns],
        cells: rows * columns,
        scanner: std::array::from_fn(|i| value(9, i)),
        head: std::array::from_fn(|line| std::array::from_fn(|i| value(2 + line, i))),
        matrix: std::array::from_fn(|row| std::array::from_fn(|column| value(6 + row, column))),
    }))
}

/// Returns the meanings of the numbers of a point: x y z, intensity, colour.
fn roles(width: usize) -> impl Iterator<Item = Role> {
    const ALL: [Role; 7] = [Role::X, Role::Y, Role::Z, Role::Intensity, Role::Red, Role::Green, Role::Blue];
    ALL.into_iter().take(width)
}

fn row(header: &PtxHeader, values: &[f64]) -> Row {
    let mut row = Row::default();
    for (role, &value) in roles(values.len()).zip(values) {
        row.set(role, value);
    }
    let p = row.three(POSITION);
    let m = &header.matrix;
    for (i, role) in POSITION.into_iter().enumerate() {
        row.set(role, p[0] * m[0][i] + p[1] * m[1][i] + p[2] * m[2][i] + m[3][i]);
    }
    row
}

struct PtxLines<'a, R> {
    path: &'a Path,
    file: R,
    number: usize,
    bytes: Vec<u8>,
}

impl<R: BufRead> PtxLines<'_, R> {
    /// The numbers of the next line that is not empty.
    fn next(&mut self) -> Result<Option<Vec<f64>>> {
        loop {
            self.bytes.clear();
            let read = self.file.by_ref().take(MAX_LINE).read_until(b'\n', &mut self.bytes);
            if read.map_err(Error::io(self.path))? == 0 {
                return Ok(None);
            }
            self.number += 1;
            let line = String::from_utf8_lossy(&self.bytes);
            if line.trim().is_empty() {
                continue;
            }
            let numbers: Option<Vec<f64>> = line.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
            return numbers.map(Some).ok_or_else(|| self.malformed("holds something that is not a number"));
        }
    }

    fn malformed(&self, what: &str) -> Error {
        Error::malformed(self.path, format!("line {} {what}", self.number))
    }
}
