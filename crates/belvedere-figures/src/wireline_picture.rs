//! Wirelines: terrain, obstacles and towers as lines on a picture plane, with names, azimuths and elevations.

use crate::font::{HEIGHT, draw_text, fitted, text_width, wrapped};
use crate::picture::{INK, PAPER, Picture};
use belvedere_data::cast::{to_index, to_u8};

const SCALE: usize = 2;
const LINE_HEIGHT: usize = (HEIGHT + 4) * SCALE;
const MARGIN: usize = 8 * SCALE;
/// Rows of names above towers at most: more names than fit are drawn over each other.
const NAME_ROWS: usize = 5;
/// Maximum rows above and below the level of the eye: what is farther up or down is cut.
const MAX_ROWS: f64 = 1400.0;
const SKY: [u8; 3] = [238, 244, 250];
const NEAR: [u8; 3] = [152, 170, 122];
const FAR: [u8; 3] = [206, 216, 226];
const RIDGE: [u8; 3] = [104, 118, 104];
const SOLID: [u8; 3] = [128, 131, 140];
const SOLID_EDGE: [u8; 3] = [84, 87, 96];
const SEEN: [u8; 3] = [190, 20, 30];
const SWEPT: [u8; 3] = [240, 160, 150];
/// Visible parts of towers and discs that no pulse proves.
const SEEN_UNPROVEN: [u8; 3] = [225, 135, 0];
const SWEPT_UNPROVEN: [u8; 3] = [250, 205, 140];
const HIDDEN: [u8; 3] = [226, 120, 120];
const FAINT: [u8; 3] = [130, 132, 138];
const LEVEL: [u8; 3] = [120, 140, 175];
/// Distances of the colours near and far, metres.
const COLOR_DISTANCES: [f64; 2] = [200.0, 20_000.0];
/// Ratio of distances behind a piece of terrain from which its upper end is drawn as a ridge.
const RIDGE_RATIO: f64 = 1.08;

/// A picture plane and what is seen on it. Places are columns to the right of its middle and rows above the level of
/// the eye.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WirelinePlane {
    /// Rows of the skyline of the obstacles, and their distance in metres, in each column.
    pub skyline: Vec<[f64; 2]>,
    /// Visible pieces of terrain in each column, from near to far: rows and distances, metres, of both ends.
    pub terrain: Vec<Vec<[[f64; 2]; 2]>>,
    /// The towers.
    pub towers: Vec<DrawnTower>,
    /// Columns and texts of azimuths.
    pub azimuths: Vec<(f64, String)>,
    /// Rows and texts of elevations.
    pub elevations: Vec<(f64, String)>,
    /// Rows below the level of the eye at least.
    pub below: f64,
    /// Rows above the level of the eye at least.
    pub above: f64,
}

/// A tower on a picture plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnTower {
    /// Its name and distance.
    pub label: String,
    /// Column.
    pub column: f64,
    /// Rows of foot and tip.
    pub rows: [f64; 2],
    /// Visible parts: rows.
    pub visible: Vec<[f64; 2]>,
    /// Lines through the swept disc: column and visible rows.
    pub disc: Vec<(f64, Vec<[f64; 2]>)>,
    /// Columns of a line through the disc.
    pub disc_line: f64,
    /// True if no pulse proves that it is visible.
    pub is_unproven: bool,
}

/// Planes below each other, with a title above and a legend below.
#[must_use]
pub fn wireline_picture(planes: &[WirelinePlane], title: &str, legend: &str) -> Picture {
    let sheets: Vec<Picture> = planes.iter().map(draw_plane).collect();
    let width = sheets.iter().map(|sheet| sheet.width).max().unwrap_or(0).max(600);
    let legend = wrapped(legend, width - 2 * MARGIN, SCALE);
    let title_height = MARGIN + LINE_HEIGHT;
    let height = title_height + sheets.iter().map(|sheet| sheet.height).sum::<usize>() + legend.len() * LINE_HEIGHT;
    let mut whole = Picture::filled(width, height + MARGIN, PAPER);
    draw_text(&mut whole, MARGIN, MARGIN, &fitted(title, width - 2 * MARGIN, SCALE), SCALE, INK);
    let mut top = title_height;
    for sheet in &sheets {
        whole.paste(sheet, [0, top]);
        top += sheet.height;
    }
    for line in &legend {
        draw_text(&mut whole, MARGIN, top, line, SCALE, INK);
        top += LINE_HEIGHT;
    }
    whole
}

/// A plane within margins, in pixels.
struct Sheet {
    picture: Picture,
    left: usize,
    right: usize,
    top: usize,
    bottom: usize,
    /// Row of the level of the eye.
    level: f64,
    middle: f64,
}

impl Sheet {
    fn row(&self, above: f64) -> usize {
        let row = (self.level - above).round().clamp(self.top as f64, self.bottom as f64);
        to_index(row)
    }

    /// The pixel of a column; `None` outside of the plane.
    fn column(&self, aside: f64) -> Option<usize> {
        let column = (self.middle + aside).floor();
        (column >= self.left as f64 && column < self.right as f64).then_some(to_index(column))
    }

    fn fill(&mut self, column: usize, [low, high]: [f64; 2], width: usize, color: [u8; 3]) {
        let (top, bottom) = (self.row(high.max(low)), self.row(low));
        let width = width.min(self.right.saturating_sub(column));
        self.picture.fill_rectangle([column, top], [width, (bottom - top).max(1)], color);
    }
}

fn draw_plane(plane: &WirelinePlane) -> Picture {
    let columns = plane.skyline.len();
    let names = placed_names(&plane.towers, columns);
    let top = (1 + names.iter().map(|name| name.row).max().unwrap_or(0)) * LINE_HEIGHT;
    let left = MARGIN + text_width("-00°", SCALE) + 3 * SCALE;
    let highest = plane.towers.iter().map(|tower| tower.rows[1]).fold(plane.above, f64::max).min(MAX_ROWS);
    let lowest = plane.towers.iter().map(|tower| -tower.rows[0]).fold(plane.below, f64::max).min(MAX_ROWS);
    let [above, below] = [highest, lowest].map(|rows| to_index(rows.ceil()));
    let bottom = top + above + below;
    let width = left + columns + MARGIN;
    let mut sheet = Sheet {
        picture: Picture::filled(width, bottom + 2 * LINE_HEIGHT, PAPER),
        left,
        right: left + columns,
        top,
        bottom,
        level: (top + above) as f64,
        middle: left as f64 + columns as f64 / 2.0,
    };
    sheet.picture.fill_rectangle([left, top], [columns, bottom - top], SKY);
    draw_surroundings(&mut sheet, plane);
    for tower in &plane.towers {
        draw_tower(&mut sheet, tower);
    }
    draw_names(&mut sheet, &names);
    draw_scales(&mut sheet, plane);
    sheet.picture
}

/// Draws terrain and obstacles: those behind first.
fn draw_surroundings(sheet: &mut Sheet, plane: &WirelinePlane) {
    for (column, &[skyline, range]) in plane.skyline.iter().enumerate() {
        let pieces = plane.terrain.get(column).map_or(&[][..], Vec::as_slice);
        let at = sheet.left + column;
        let before = pieces.partition_point(|[_, distances]| distances[1] < range);
        draw_terrain(sheet, at, pieces, before..pieces.len());
        if range.is_finite() {
            sheet.fill(at, [-MAX_ROWS, skyline], 1, SOLID);
            let beside = column.checked_sub(1).and_then(|before| plane.skyline.get(before));
            let beside = beside.map_or(skyline, |[row, _]| *row).max(-MAX_ROWS);
            sheet.fill(at, [skyline.min(beside) - 1.0, skyline.max(beside)], 1, SOLID_EDGE);
        }
        draw_terrain(sheet, at, pieces, 0..before);
    }
    let level = [0.0, 0.0];
    for column in (sheet.left..sheet.right).step_by(12) {
        sheet.fill(column, level, 6, LEVEL);
    }
}

/// Draws pieces of terrain in a column, the far ones first: each down to the lower edge, which nearer ones cover.
fn draw_terrain(sheet: &mut Sheet, column: usize, pieces: &[[[f64; 2]; 2]], which: std::ops::Range<usize>) {
    let [near, far] = COLOR_DISTANCES.map(f64::ln);
    let share = |distance: f64| ((distance.max(1.0).ln() - near) / (far - near)).clamp(0.0, 1.0);
    for [rows, distances] in pieces[which.clone()].iter().rev() {
        sheet.fill(column, [-MAX_ROWS, rows[1]], 1, mixed(NEAR, FAR, share(distances[1])));
    }
    // last, since rounding lets a piece reach a row into the one behind
    for number in which {
        let [rows, distances] = pieces[number];
        let behind = pieces.get(number + 1).map_or(f64::INFINITY, |[_, distances]| distances[0]);
        if behind > distances[1] * RIDGE_RATIO {
            sheet.fill(column, [rows[1] - 1.0, rows[1]], 1, mixed(RIDGE, FAR, share(distances[1]) * 0.5));
        }
    }
}

/// A colour between two.
fn mixed(from: [u8; 3], to: [u8; 3], share: f64) -> [u8; 3] {
    std::array::from_fn(|i| {
        let value = f64::from(from[i]) + share * (f64::from(to[i]) - f64::from(from[i]));
        to_u8(value.round())
    })
}

fn draw_tower(sheet: &mut Sheet, tower: &DrawnTower) {
    let width = to_index(tower.disc_line.ceil()).clamp(1, 64);
    let [seen, swept] = if tower.is_unproven { [SEEN_UNPROVEN, SWEPT_UNPROVEN] } else { [SEEN, SWEPT] };
    for (column, spans) in &tower.disc {
        let Some(column) = sheet.column(column - tower.disc_line / 2.0) else { continue };
        for &span in spans {
            sheet.fill(column, span, width, swept);
        }
    }
    let Some(column) = sheet.column(tower.column - 1.0) else { return };
    let [low, high] = tower.rows;
    let mut from = low;
    while from < high {
        sheet.fill(column + 1, [from, (from + 3.0).min(high)], 1, HIDDEN);
        from += 7.0;
    }
    for &span in &tower.visible {
        sheet.fill(column, span, 3, seen);
    }
}

/// A name above a plane.
struct Name<'a> {
    tower: &'a DrawnTower,
    label: String,
    /// Pixels from the left edge of the plane.
    left: usize,
    /// Row of text, the lowest first.
    row: usize,
}

/// Places names in rows so that they do not meet.
fn placed_names<'a>(towers: &'a [DrawnTower], columns: usize) -> Vec<Name<'a>> {
    let mut order: Vec<&DrawnTower> = towers.iter().collect();
    order.sort_by(|a, b| a.column.total_cmp(&b.column));
    let mut ends = [0; NAME_ROWS];
    let place = |tower: &'a DrawnTower| {
        let label = fitted(&tower.label, columns, SCALE);
        let width = text_width(&label, SCALE);
        let left = (tower.column + columns as f64 / 2.0 - width as f64 / 2.0).max(0.0);
        let left = to_index(left).min(columns.saturating_sub(width));
        let row = ends.iter().position(|end| *end <= left).unwrap_or(NAME_ROWS - 1);
        ends[row] = left + width + 4 * SCALE;
        Name { tower, label, left, row }
    };
    order.into_iter().map(place).collect()
}

/// Draws names, with a line down to each tip.
fn draw_names(sheet: &mut Sheet, names: &[Name<'_>]) {
    for Name { tower, label, left, row } in names {
        let Some(column) = sheet.column(tower.column) else { continue };
        let top = sheet.top - (row + 1) * LINE_HEIGHT + SCALE;
        let color = if tower.visible.is_empty() { FAINT } else { INK };
        let from = top + HEIGHT * SCALE + SCALE;
        let tip = sheet.row(tower.rows[1]);
        sheet.picture.fill_rectangle([column, from], [1, tip.saturating_sub(from + 2)], FAINT);
        draw_text(&mut sheet.picture, sheet.left + left, top, label, SCALE, color);
    }
}

fn draw_scales(sheet: &mut Sheet, plane: &WirelinePlane) {
    let (left, bottom) = (sheet.left, sheet.bottom);
    for (row, text) in &plane.elevations {
        let on_sheet = sheet.level - row;
        if !(sheet.top as f64..=sheet.bottom as f64).contains(&on_sheet) {
            continue;
        }
        let row = sheet.row(*row);
        sheet.picture.fill_rectangle([left - 3 * SCALE, row], [3 * SCALE, 1], INK);
        let text_left = left.saturating_sub(text_width(text, SCALE) + 4 * SCALE);
        draw_text(&mut sheet.picture, text_left, row.saturating_sub(4 * SCALE), text, SCALE, INK);
    }
    for (aside, text) in &plane.azimuths {
        let Some(column) = sheet.column(*aside) else { continue };
        sheet.picture.fill_rectangle([column, bottom], [1, 3 * SCALE], INK);
        let text_left = column.saturating_sub(text_width(text, SCALE) / 2);
        draw_text(&mut sheet.picture, text_left, bottom + 4 * SCALE, text, SCALE, INK);
    }
    sheet.picture.fill_rectangle([left, bottom], [sheet.right - left, 1], INK);
    sheet.picture.fill_rectangle([left, sheet.top], [1, bottom - sheet.top], INK);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(visible: Vec<[f64; 2]>) -> WirelinePlane {
        let tower = DrawnTower {
            label: "T1".to_owned(),
            column: 0.5,
            rows: [-20.0, 120.0],
            visible,
            disc: vec![(30.5, vec![[60.0, 100.0]])],
            disc_line: 1.0,
            is_unproven: false,
        };
        WirelinePlane {
            skyline: vec![[40.0, 100.0]; 201],
            // a hill before the obstacles, and one behind them
            terrain: vec![vec![[[-50.0, 10.0], [50.0, 52.0]], [[10.0, 80.0], [900.0, 940.0]]]; 201],
            towers: vec![tower],
            azimuths: vec![(0.0, "90°".to_owned())],
            elevations: vec![(0.0, "0°".to_owned())],
            below: 60.0,
            above: 150.0,
        }
    }

    #[test]
    fn what_is_nearer_is_drawn_over_what_is_behind() {
        let picture = draw_plane(&plane(vec![[80.0, 120.0]]));
        let level = LINE_HEIGHT + 150;
        let left = picture.width - MARGIN - 201;
        let at = |column: usize, above: i64| {
            picture.get(left + column, usize::try_from(level as i64 - above).unwrap()).unwrap()
        };
        // sky, the far hill, obstacles, the near hill
        assert_eq!([at(10, 100), at(10, 30)], [SKY, SOLID]);
        assert!(at(10, 60) != SOLID && at(10, 60) != SKY && at(10, -20) != SOLID, "{:?}", at(10, 60));
        assert_eq!([at(100, 100), at(130, 80)], [SEEN, SWEPT]);
        // the hidden part is dotted
        let rows = |color| (-20..80).filter(|&above| at(101, above) == color).count();
        assert!(rows(SEEN) == 0 && (30..60).contains(&rows(HIDDEN)), "{}", rows(HIDDEN));
        let mut unproven = plane(vec![[80.0, 120.0]]);
        unproven.towers[0].is_unproven = true;
        let picture = draw_plane(&unproven);
        assert_eq!(
            [100, 130].map(|column| picture.get(left + column, level - 90).unwrap()),
            [SEEN_UNPROVEN, SWEPT_UNPROVEN]
        );
        let whole = wireline_picture(&[plane(Vec::new()), plane(Vec::new())], "title", "legend");
        assert!(whole.width == 600 && whole.height > 2 * picture.height);
    }
}
