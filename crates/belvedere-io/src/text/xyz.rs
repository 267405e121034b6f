//! Text files with one point a line: blanks, tabs, commas or semicolons between numbers, with or without a header. A
//! first line of nothing but a count makes the file PTS, which may have a count before each of its scans.

use std::io::BufRead;
use std::path::Path;

use crate::files::source::{Input, Source};
use crate::points::file_part::FilePart;
use crate::points::read_options::Reading;
use crate::points::rows::{Role, Row, Rows, contradict_twice, roles_of};
use crate::text::text_rows::TextRows;
use belvedere_data::{Error, Result};

/// A line longer than this is no point.
const MAX_LINE: u64 = 1 << 16;

/// Number of lines read to recognise the columns after z.
const LOOK_AHEAD: usize = 1000;

/// Line numbers of unreadable lines that the report names.
const NAMED_LINES: usize = 5;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Separator {
    Blank,
    Character(char),
}

impl Separator {
    fn split(self, line: &str) -> impl Iterator<Item = &str> {
        let (by_character, by_blank) = match self {
            Self::Character(c) => (Some(Parted { rest: Some(line), by: c }), None),
            Self::Blank => (None, Some(line.split_ascii_whitespace())),
        };
        by_character.into_iter().flatten().chain(by_blank.into_iter().flatten())
    }
}

/// Cells parted by a character, without surrounding blanks and quotation marks. Within quotation marks the character is
/// a part of the cell.
struct Parted<'a> {
    rest: Option<&'a str>,
    by: char,
}

impl<'a> Iterator for Parted<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let rest = self.rest?;
        let quotation =
            rest.trim_start().strip_prefix('"').and_then(|inside| inside.split_at_checked(closing(inside)?));
        let (cell, behind) = match quotation {
            // what follows the closing mark up to the next separator is no part of the cell
            Some((cell, behind)) => (cell, behind.find(self.by).map(|at| &behind[at..])),
            None => match rest.find(self.by) {
                Some(at) => (rest[..at].trim().trim_matches('"'), Some(&rest[at..])),
                None => (rest.trim().trim_matches('"'), None),
            },
        };
        self.rest = behind.map(|behind| &behind[self.by.len_utf8()..]);
        Some(cell)
    }
}

/// Index of the quotation mark that ends the text `inside`; a doubled mark is part of the text.
fn closing(inside: &str) -> Option<usize> {
    let mut marks = inside.match_indices('"').map(|(at, _)| at);
    while let Some(at) = marks.next() {
        if inside[at + 1..].starts_with('"') {
            marks.next();
        } else {
            return Some(at);
        }
    }
    None
}

/// The points of the source.
///
/// # Errors
/// [`Error::Malformed`] for decimal commas, for a header without x, y and z, and where more than half of the lines
/// cannot be read.
pub(crate) fn read(input: Input<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let Input { name, reader: mut file, size } = input;
    let path = name.as_path();
    let mut part = FilePart::new(path, "text");
    let mut lines = XyzLines { path, file: &mut file, number: 0, bytes: Vec::new(), announced: None };
    let Some(start) = find_start(path, &mut part, &mut lines)? else {
        part.report.format = "text, empty".to_owned();
        return Ok(part);
    };
    let Start { separator, columns, ahead, .. } = start;
    part.report.format = format!("text, {}", columns_in_words(separator, &columns));
    let mut rows = Rows::new(columns.iter().copied().flatten()).with_numbers(reading.options.row_numbers);
    let mut bad = Bad::default();
    let mut take = |number: usize, line: &str| match parse(line, separator, &columns) {
        Some(row) => {
            rows.push(&row);
            bad.good += 1;
        }
        None => {
            rows.pass_over();
            bad.add(number);
        }
    };
    for (number, line) in &ahead {
        take(*number, line);
    }
    while let Some((number, line)) = lines.next_data()? {
        reading.check(number as u64)?;
        take(number, &line);
    }
    bad.judge(&mut part, path)?;
    debug_assert!(bad.good as u64 <= size, "every line has a byte");
    let (announced, found) = (lines.announced.unwrap_or(0), (bad.good + bad.count) as u64);
    if announced > found {
        part.note(format!("its counts announce {announced} points, but it has only {found} lines of points"));
        part.leave_out_missing(announced - found);
    }
    rows.finish(&mut part);
    Ok(part)
}

/// The lines of points as they are, with the names of their columns.
pub(crate) fn read_text(input: Input<'_>) -> Result<TextRows> {
    let Input { name, reader: mut file, .. } = input;
    let path = name.as_path();
    let mut part = FilePart::new(path, "text");
    let mut lines = XyzLines { path, file: &mut file, number: 0, bytes: Vec::new(), announced: None };
    let Some(start) = find_start(path, &mut part, &mut lines)? else { return Ok(TextRows::default()) };
    let Start { separator, mut names, ahead, .. } = start;
    let width = ahead.first().map_or(0, |(_, line)| separator.split(line).count());
    if names.is_empty() {
        names = ["x", "y", "z"].map(str::to_owned).to_vec();
    }
    while names.len() < width {
        names.push(format!("column_{}", names.len() + 1));
    }
    let mut rows = TextRows::new(names);
    let mut take = |line: &str| rows.push(separator.split(line).map(|cell| cell.replace("\"\"", "\"")));
    for (_, line) in &ahead {
        take(line);
    }
    while let Some((_, line)) = lines.next_data()? {
        take(&line);
    }
    Ok(rows)
}

/// Returns true if a text file is a table of something else than points: its first line has names, but not of x, y and
/// z. With `beside_scans`, also if another name precedes these, as in `time,x,y,z` of a trajectory and `station,x,y,z`.
pub(crate) fn is_another_table(input: Input<'_>, beside_scans: bool) -> bool {
    let Input { name, reader: mut file, .. } = input;
    let mut lines = XyzLines { path: &name, file: &mut file, number: 0, bytes: Vec::new(), announced: None };
    let Ok(Some((_, line))) = lines.next_data() else { return false };
    is_names(&line) && header(&line).is_none_or(|(columns, _)| beside_scans && columns.first() != Some(&Some(Role::X)))
}

/// Returns true if a first line is that of an ESRI ASCII grid, whose files share the extension `.asc` with text clouds.
fn is_grid(line: &str) -> bool {
    line.split_ascii_whitespace().next().is_some_and(|word| word.eq_ignore_ascii_case("ncols"))
}

/// Returns true if a first line has names of columns.
fn is_names(line: &str) -> bool {
    line.contains(|c: char| c.is_ascii_alphabetic()) && !is_numeric(line)
}

/// Contents of the first lines.
struct Start {
    separator: Separator,
    columns: Vec<Option<Role>>,
    /// Names of the columns; none where no line has them.
    names: Vec<String>,
    /// Data lines read already, with their numbers.
    ahead: Vec<(usize, String)>,
}

struct XyzLines<'a, R> {
    path: &'a Path,
    file: &'a mut R,
    number: usize,
    bytes: Vec<u8>,
    /// Points that the counts of a PTS file announce; `None` for other files.
    announced: Option<u64>,
}

impl<R: BufRead> XyzLines<'_, R> {
    /// The next line and its number, from 1, without surrounding blanks.
    fn next(&mut self) -> Result<Option<(usize, String)>> {
        self.bytes.clear();
        let read = std::io::Read::take(&mut *self.file, MAX_LINE).read_until(b'\n', &mut self.bytes);
        if read.map_err(Error::io(self.path))? == 0 {
            return Ok(None);
        }
        self.number += 1;
        let line = String::from_utf8_lossy(&self.bytes);
        Ok(Some((self.number, line.trim().trim_start_matches('\u{feff}').to_owned())))
    }

    /// The next line that is neither empty nor a comment, nor a count of a PTS file.
    fn next_data(&mut self) -> Result<Option<(usize, String)>> {
        while let Some((number, line)) = self.next()? {
            if !line.is_empty() && !is_comment(&line) && !self.takes_count(&line) {
                return Ok(Some((number, line)));
            }
        }
        Ok(None)
    }

    /// Returns true if a line is the count of another scan of a PTS file.
    fn takes_count(&mut self, line: &str) -> bool {
        let sum = self.announced.and_then(|sum| sum.checked_add(line.parse().ok()?));
        self.announced = sum.or(self.announced);
        sum.is_some()
    }
}

fn is_comment(line: &str) -> bool {
    line.starts_with('#') || line.starts_with("//")
}

/// Reads on to the data; `None` where there is none.
fn find_start<R: BufRead>(path: &Path, part: &mut FilePart, lines: &mut XyzLines<'_, R>) -> Result<Option<Start>> {
    let mut names: Option<XyzHeader> = None;
    let mut ahead: Vec<(usize, String)> = Vec::new();
    let mut header_seen = false;
    while ahead.len() < LOOK_AHEAD {
        let Some((number, line)) = lines.next()? else { break };
        if is_comment(&line) {
            if ahead.is_empty() && names.is_none() {
                names = header(line.trim_start_matches(['#', '/']));
            }
            continue;
        }
        if line.is_empty() {
            continue;
        }
        if ahead.is_empty() && !header_seen && is_names(&line) {
            header_seen = true;
            if is_grid(&line) {
                let (own, tif) = (path.display(), path.with_extension("tif").display().to_string());
                let what = format!(
                    "is a grid of heights (ESRI ASCII), not a point cloud; for terrain convert it: gdal_translate {own} {tif}"
                );
                return Err(Error::malformed(path, what));
            }
            names = header(&line);
            if names.is_none() {
                let what = format!("has a header line ({number}) without columns x, y and z: {}", shorten(&line));
                return Err(Error::malformed(path, what));
            }
            continue;
        }
        // A first line with nothing but a count is how PTS files begin.
        if ahead.is_empty() && !header_seen && line.parse::<u64>().is_ok() {
            header_seen = true;
            lines.announced = Some(0);
        }
        if lines.takes_count(&line) {
            continue;
        }
        ahead.push((number, line));
    }
    let Some((number, first)) = ahead.first() else { return Ok(None) };
    let separator = separator(first);
    refuse_decimal_comma(path, *number, first, separator)?;
    if let (Some((roles, _)), Separator::Character(',')) = (&names, separator)
        && separator.split(first).count() > roles.len()
    {
        let what = format!(
            "line {number} has {} cells, but the header has {} ({}); for decimal commas separate cells by semicolons and replace commas by points",
            separator.split(first).count(),
            roles.len(),
            shorten(first)
        );
        return Err(Error::malformed(path, what));
    }
    let (columns, names) = names.unwrap_or_else(|| (guess_columns(part, separator, &ahead), Vec::new()));
    contradict_twice(part, &roles_of(names.iter().map(String::as_str)).1);
    let without_role = names.iter().zip(&columns).filter(|(_, role)| role.is_none());
    part.other_attributes.extend(without_role.map(|(name, _)| name.clone()));
    if separator.split(first).count() > columns.len() {
        part.note(format!("columns ignored: all after number {}", columns.len()));
    }
    Ok(Some(Start { separator, columns, names, ahead }))
}

fn is_numeric(line: &str) -> bool {
    let separator = separator(line);
    separator.split(line).all(|token| token.parse::<f64>().is_ok())
}

/// The roles of columns, and their names.
type XyzHeader = (Vec<Option<Role>>, Vec<String>);

/// The names in a header line and their roles, or `None` where x, y and z are not among them.
fn header(line: &str) -> Option<XyzHeader> {
    let names: Vec<String> = separator(line).split(line).map(str::to_owned).collect();
    let (columns, _) = roles_of(names.iter().map(String::as_str));
    [Role::X, Role::Y, Role::Z].iter().all(|&role| columns.contains(&Some(role))).then_some((columns, names))
}

fn separator(line: &str) -> Separator {
    [';', '\t', ',']
        .into_iter()
        .find(|&c| line.contains(c))
        .filter(|&c| c != '\t' || line.split('\t').all(|token| !token.trim().contains(' ')))
        .map_or(Separator::Blank, Separator::Character)
}

fn refuse_decimal_comma(path: &Path, number: usize, line: &str, separator: Separator) -> Result<()> {
    let comma = match separator {
        // split at commas, "1,5 2,5 3,5" leaves tokens of two numbers
        Separator::Character(',') => separator.split(line).any(|token| {
            let mut words = token.split_whitespace();
            token.contains(char::is_whitespace) && words.all(|word| word.parse::<f64>().is_ok())
        }),
        _ => separator.split(line).take(3).any(|token| token.contains(',')),
    };
    if comma {
        let what = format!(
            "line {number} has decimal commas ({}); replace them by points, for example with: tr ',' '.'",
            shorten(line)
        );
        return Err(Error::malformed(path, what));
    }
    Ok(())
}

/// Guesses the meanings of nameless columns, from their number and values.
fn guess_columns(part: &mut FilePart, separator: Separator, ahead: &[(usize, String)]) -> Vec<Option<Role>> {
    let values: Vec<Vec<f64>> = ahead
        .iter()
        .map(|(_, line)| separator.split(line).map_while(|token| token.parse().ok()).collect::<Vec<f64>>())
        .filter(|row| row.len() >= 3)
        .collect();
    let width = values.iter().map(Vec::len).min().unwrap_or(3);
    let last_three = |row: &Vec<f64>| [row[width - 3], row[width - 2], row[width - 1]];
    let unit = |v: [f64; 3]| (v.iter().map(|c| c * c).sum::<f64>().sqrt() - 1.0).abs() < 0.05;
    let byte = |v: [f64; 3]| v.iter().all(|c| c.fract() == 0.0 && (0.0..=65535.0).contains(c));
    let normals = || values.iter().all(|row| unit(last_three(row)));
    let colors = || values.iter().all(|row| byte(last_three(row)));
    let position = [Role::X, Role::Y, Role::Z];
    let more: &[Role] = match width {
        4 => &[Role::Intensity],
        6 if normals() => &[Role::NormalX, Role::NormalY, Role::NormalZ],
        6 if colors() => &[Role::Red, Role::Green, Role::Blue],
        7 if colors() => &[Role::Intensity, Role::Red, Role::Green, Role::Blue],
        _ => &[],
    };
    if width > 3 {
        let taken = if more.is_empty() { "nothing".to_owned() } else { format!("{more:?}") };
        part.note(format!("the columns have no names; those after x, y, z are read as {taken}"));
    }
    position.iter().chain(more).map(|&role| Some(role)).collect()
}

fn parse(line: &str, separator: Separator, columns: &[Option<Role>]) -> Option<Row> {
    let mut row = Row::default();
    let mut tokens = separator.split(line);
    for column in columns {
        let token = tokens.next()?;
        if let Some(role) = column {
            row.set(*role, token.parse().ok()?);
        }
    }
    Some(row)
}

/// Lines that could not be read.
#[derive(Default)]
struct Bad {
    good: usize,
    count: usize,
    first: Vec<usize>,
}

impl Bad {
    fn add(&mut self, number: usize) {
        self.count += 1;
        if self.first.len() < NAMED_LINES {
            self.first.push(number);
        }
    }

    fn judge(&self, part: &mut FilePart, path: &Path) -> Result<()> {
        let lines: Vec<String> = self.first.iter().map(ToString::to_string).collect();
        let lines = format!("lines {}{}", lines.join(", "), if self.count > NAMED_LINES { ", …" } else { "" });
        if self.count > self.good {
            let total = self.count + self.good;
            let what = format!("{} of {total} lines are not points ({lines}); is this a point cloud?", self.count);
            return Err(Error::malformed(path, what));
        }
        part.leave_out(self.count, format!("unreadable: {lines}"));
        Ok(())
    }
}

fn columns_in_words(separator: Separator, columns: &[Option<Role>]) -> String {
    let by = match separator {
        Separator::Blank => "blanks",
        Separator::Character('\t') => "tabs",
        Separator::Character(',') => "commas",
        Separator::Character(_) => "semicolons",
    };
    let named = columns.iter().filter(|column| column.is_some()).count();
    format!("{named} columns between {by}")
}

fn shorten(line: &str) -> String {
    line.chars().take(40).collect()
}

/// Reads the rows of a text file of points (.csv .txt .xyz) as they are: one for each line that
/// [`read_cloud`](crate::read_cloud) reads or leaves out. Columns without a name are called x, y, z, column_4 and so
/// on.
///
/// # Errors
/// Those of reading the points.
pub fn read_text_rows<'a>(source: impl Into<Source<'a>>) -> Result<TextRows> {
    read_text(source.into().open_text()?)
}
