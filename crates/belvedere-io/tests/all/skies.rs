//! Pulses of structured scans that returned nothing: those that see the sky are kept, and nothing else.

use belvedere_data::control::Control;
use belvedere_data::sky_region::SkyRegion;
use belvedere_data::{Frame, PointCloud};
use belvedere_io::{ReadOptions, ReadReport, Source, UpAxis, read_cloud};
use std::f64::consts::FRAC_PI_6;

/// Half of the side of a court, and the height of its walls, metres.
const HALF_SIDE: f64 = 10.0;
const HEIGHT: f64 = 8.0;
/// The scanner in its middle, metres above the floor.
const SCANNER_HEIGHT: f64 = 1.8;
/// Position of the scanner in the court, in the coordinates of the file; the scan is turned by 30°.
const STATION: [f64; 3] = [120.0, 450.0, 31.8];
const TURN: f64 = FRAC_PI_6;

/// Grid of pulses: their number around and up, the lowest, and the step upwards, radians.
#[derive(Clone, Copy)]
struct Pulses {
    columns: usize,
    rows: usize,
    lowest: f64,
    step: f64,
}

impl Pulses {
    /// Every degree from −50° to the zenith.
    const USUAL: Self = Self { columns: 360, rows: 140, lowest: -49.5 * DEGREE, step: DEGREE };

    /// Unit vector of a pulse along the axes of the scan.
    fn direction(&self, [row, column]: [usize; 2]) -> [f64; 3] {
        let (up, level) = (self.lowest + self.step * row as f64).sin_cos();
        let (sin, cos) = (2.0 - 360.0 * DEGREE * column as f64 / self.columns as f64).sin_cos();
        [level * cos, level * sin, up]
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Objects in the court beside its floor and walls.
#[derive(Clone, Copy, PartialEq)]
enum Court {
    Bare,
    /// The wall to the east of the scan has a window, and the floor a place that swallows pulses.
    WithWindowAndPuddle,
    /// Over it lies a ceiling of the height of the walls, in which a lamp of a metre returns nothing.
    Covered,
}

/// Returns the point at which a pulse along the axes of the scan meets the court; `None` without a return.
fn returned(court: Court, [x, y, z]: [f64; 3]) -> Option<[f64; 3]> {
    let to_wall = HALF_SIDE / x.abs().max(y.abs());
    let to_floor = if z < 0.0 { -SCANNER_HEIGHT / z } else { f64::INFINITY };
    let to_ceiling = if z > 0.0 { (HEIGHT - SCANNER_HEIGHT) / z } else { f64::INFINITY };
    let range = to_wall.min(to_floor);
    let found = [x, y, z].map(|v| v * range);
    let swallows = match court {
        Court::Bare => false,
        Court::WithWindowAndPuddle => {
            let is_window = found[0] > HALF_SIDE - 0.01 && found[1].abs() < 2.5 && (0.5..5.0).contains(&found[2]);
            let is_puddle = range == to_floor && (3.0..7.0).contains(&found[0]) && found[1].abs() < 2.0;
            is_window || is_puddle
        }
        Court::Covered if to_ceiling < range => {
            let found = [x, y, z].map(|v| v * to_ceiling);
            return (found[0].hypot(found[1]) > 0.5).then_some(found);
        }
        Court::Covered => false,
    };
    (found[2] < HEIGHT - SCANNER_HEIGHT && !swallows).then_some(found)
}

/// Text of a PTX file of one scan; the pulses of the columns in `order`.
fn ptx(court: Court, pulses: &Pulses, order: impl Iterator<Item = usize>) -> String {
    let (s, c) = TURN.sin_cos();
    let [x, y, z] = STATION;
    let header = format!(
        "{}\n{}\n{x} {y} {z}\n{c} {s} 0\n{} {c} 0\n0 0 1\n{c} {s} 0 0\n{} {c} 0 0\n0 0 1 0\n{x} {y} {z} 1\n",
        pulses.columns, pulses.rows, -s, -s
    );
    let mut text = header;
    for column in order {
        for row in 0..pulses.rows {
            let [x, y, z] = returned(court, pulses.direction([row, column])).unwrap_or_default();
            text.push_str(&format!("{x:.4} {y:.4} {z:.4} 0.5\n"));
        }
    }
    text
}

fn usual_ptx(court: Court, pulses: &Pulses) -> String {
    ptx(court, pulses, 0..pulses.columns)
}

fn read(name: &str, bytes: &[u8], options: &ReadOptions) -> (PointCloud, ReadReport) {
    read_cloud([Source::bytes(name, bytes)], options, &Control::none()).unwrap()
}

fn read_ptx(text: &str) -> (PointCloud, ReadReport) {
    read("court.ptx", text.as_bytes(), &ReadOptions::default())
}

/// Returns true if a direction in the coordinates of the file, for which z is up, passes over the walls.
fn is_sky([x, y, z]: [f64; 3]) -> bool {
    let (s, c) = TURN.sin_cos();
    let [x, y] = [c * x + s * y, c * y - s * x];
    z > 0.0 && HALF_SIDE / x.abs().max(y.abs()) * z > HEIGHT - SCANNER_HEIGHT
}

/// Solid angle of the open cells, steradians.
fn solid_angle(region: &SkyRegion) -> f64 {
    let cell = region.azimuth[1].abs() * region.elevation[1].abs();
    region.open_cells().map(|[row, _]| cell * region.elevation_of(row).cos()).sum()
}

/// Solid angle above the walls: that of a rectangle of a × b at the distance d, four times.
fn sky_above_walls() -> f64 {
    let (side, up) = (HALF_SIDE, HEIGHT - SCANNER_HEIGHT);
    4.0 * (side * side / (up * (2.0 * side * side + up * up).sqrt())).atan()
}

#[test]
fn empty_cells_over_the_walls_are_the_sky_and_those_of_glass_and_water_are_not() {
    for court in [Court::Bare, Court::WithWindowAndPuddle] {
        let (cloud, report) = read_ptx(&usual_ptx(court, &Pulses::USUAL));
        let [region] = &cloud.sky_regions[..] else { panic!("{:?}", cloud.sky_regions.len()) };
        assert_eq!(region.scanner, 0);
        assert!(region.open_cells().all(|cell| is_sky(region.direction(cell))), "a pulse that met something");
        // a margin of a degree is lost along the walls: 2π cos 30° of a radian at most
        let (seen, all) = (solid_angle(region), sky_above_walls());
        assert!(seen < all && seen > all - 2.5 * DEGREE * 2.0 * std::f64::consts::PI, "{seen} of {all}");
        // a thousandth of the returns comes from farther away: the tops of the corners, 15.4 m away
        let corner = (2.0 * HALF_SIDE * HALF_SIDE + (HEIGHT - SCANNER_HEIGHT).powi(2)).sqrt();
        assert!((corner - 0.5..corner).contains(&f64::from(region.range)), "{} of {corner}", region.range);
        let notes = &report.files[0].notes;
        assert!(notes.iter().any(|note| note.contains("see the sky")), "{notes:?}");
    }
}

#[test]
fn a_room_with_a_lamp_that_returns_nothing_has_no_sky() {
    let (cloud, report) = read_ptx(&usual_ptx(Court::Covered, &Pulses::USUAL));
    assert!(report.left_out_count() > 100, "the lamp must have cells");
    assert!(cloud.sky_regions.is_empty());
}

#[test]
fn a_grid_that_ends_below_45_degrees_has_no_sky() {
    let low = Pulses { rows: 90, ..Pulses::USUAL };
    let (cloud, report) = read_ptx(&usual_ptx(Court::Bare, &low));
    assert!(report.left_out_count() > 1000 && cloud.sky_regions.is_empty());
    let higher = Pulses { rows: 97, ..Pulses::USUAL };
    assert_eq!(read_ptx(&usual_ptx(Court::Bare, &higher)).0.sky_regions.len(), 1);
}

#[test]
fn cells_that_are_no_regular_grid_prove_nothing_and_are_noted() {
    let pulses = Pulses::USUAL;
    // seven times around, and in no order
    let ways: [fn(usize, usize) -> usize; 2] =
        [|column, count| column * 7 % count, |column, count| column * column % count];
    for way in ways {
        let (cloud, report) =
            read_ptx(&ptx(Court::Bare, &pulses, (0..pulses.columns).map(|column| way(column, pulses.columns))));
        assert!(cloud.sky_regions.is_empty());
        let notes = &report.files[0].notes;
        assert!(notes.iter().any(|note| note.contains("1 scan do not lie on a regular grid")), "{notes:?}");
    }
}

#[test]
fn rows_from_above_and_scans_whose_y_is_up_see_the_same_sky() {
    let (usual, _) = read_ptx(&usual_ptx(Court::Bare, &Pulses::USUAL));
    let from_above = Pulses { lowest: 89.5 * DEGREE, step: -DEGREE, ..Pulses::USUAL };
    let (turned, _) = read_ptx(&usual_ptx(Court::Bare, &from_above));
    let directions = |cloud: &PointCloud| -> Vec<[i64; 3]> {
        let region = &cloud.sky_regions[0];
        let rounded = |v: f64| (v * 1000.0).round() as i64;
        let mut all: Vec<[i64; 3]> = region.open_cells().map(|cell| region.direction(cell).map(rounded)).collect();
        all.sort_unstable();
        all
    };
    let expected = directions(&usual);
    let found = directions(&turned);
    assert_eq!(found.len(), expected.len());
    // steps and starts are estimated, and a thousandth may round either way
    let near = found.iter().zip(&expected).filter(|(a, b)| (0..3).all(|i| (a[i] - b[i]).abs() <= 1)).count();
    assert!(near > found.len() * 9 / 10, "{near} of {}", found.len());
    // (x, y, z) is written as (x, z, −y), and read as it was
    let y_up: String = usual_ptx(Court::Bare, &Pulses::USUAL)
        .lines()
        .enumerate()
        .map(|(number, line)| {
            let numbers: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
            match numbers[..] {
                [x, y, z, last] if (6..10).contains(&number) => format!("{x} {z} {} {last}\n", -y),
                _ => format!("{line}\n"),
            }
        })
        .collect();
    let options = ReadOptions::default().with_up(UpAxis::Y);
    let (cloud, _) = read("court.ptx", y_up.as_bytes(), &options);
    assert_eq!(directions(&cloud).len(), expected.len());
    assert!(cloud.sky_regions[0].open_cells().all(|cell| cloud.sky_regions[0].direction(cell)[2] > 0.0));
}

/// Representation of cells without a return in an E57 file.
#[derive(Clone, Copy, PartialEq)]
enum EmptyCells {
    Invalid,
    LeftOut,
}

fn e57(court: Court, pulses: &Pulses, empty: EmptyCells) -> Vec<u8> {
    use e57::{Record, RecordDataType, RecordName, RecordValue};
    let mut cursor = std::io::Cursor::new(Vec::new());
    let mut writer = e57::E57Writer::new(&mut cursor, "file").unwrap();
    let index = |name, count: usize| Record {
        name,
        data_type: RecordDataType::Integer { min: 0, max: i64::try_from(count).unwrap() - 1 },
    };
    let mut prototype = vec![
        Record::CARTESIAN_X_F64,
        Record::CARTESIAN_Y_F64,
        Record::CARTESIAN_Z_F64,
        Record::CARTESIAN_INVALID_STATE,
    ];
    prototype.push(index(RecordName::RowIndex, pulses.rows));
    prototype.push(index(RecordName::ColumnIndex, pulses.columns));
    let mut scan = writer.add_pointcloud("scan", prototype).unwrap();
    let (sin, cos) = (TURN / 2.0).sin_cos();
    scan.set_transform(Some(e57::Transform {
        rotation: e57::Quaternion { w: cos, x: 0.0, y: 0.0, z: sin },
        translation: e57::Translation { x: STATION[0], y: STATION[1], z: STATION[2] },
    }));
    for row in 0..pulses.rows {
        for column in 0..pulses.columns {
            let found = returned(court, pulses.direction([row, column]));
            if found.is_none() && empty == EmptyCells::LeftOut {
                continue;
            }
            let mut values = found.unwrap_or_default().map(RecordValue::Double).to_vec();
            values.push(RecordValue::Integer(if found.is_some() { 0 } else { 2 }));
            values.extend([row, column].map(|index| RecordValue::Integer(i64::try_from(index).unwrap())));
            scan.add_point(values).unwrap();
        }
    }
    scan.finalize().unwrap();
    writer.finalize().unwrap();
    drop(writer);
    cursor.into_inner()
}

#[test]
fn scans_of_e57_see_the_sky_that_those_of_ptx_see() {
    let court = Court::WithWindowAndPuddle;
    let (expected, _) = read_ptx(&usual_ptx(court, &Pulses::USUAL));
    let file = e57(court, &Pulses::USUAL, EmptyCells::Invalid);
    let (cloud, _) = read("court.e57", &file, &ReadOptions::default());
    let ([found], [expected]) = (&cloud.sky_regions[..], &expected.sky_regions[..]) else { panic!("no sky") };
    assert_eq!((found.columns, &found.is_open), (expected.columns, &expected.is_open));
    for cell in found.open_cells() {
        let (a, b) = (found.direction(cell), expected.direction(cell));
        // coordinates of the text are rounded to a tenth of a millimetre
        assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-4), "{a:?} {b:?}");
    }
    // a file that lists returns only does not say that pulses went higher
    let file = e57(court, &Pulses::USUAL, EmptyCells::LeftOut);
    assert!(read("court.e57", &file, &ReadOptions::default()).0.sky_regions.is_empty());
}

#[test]
fn fine_grids_are_put_together_in_blocks_that_no_return_lies_in() {
    let fine = Pulses { columns: 3600, ..Pulses::USUAL };
    let text = usual_ptx(Court::Bare, &fine);
    let (cloud, _) = read_ptx(&text);
    let [region] = &cloud.sky_regions[..] else { panic!("no sky") };
    assert_eq!(region.columns, 1800);
    assert!(region.open_cells().all(|cell| is_sky(region.direction(cell))), "a pulse that met something");
    let (seen, all) = (solid_angle(region), sky_above_walls());
    assert!(seen < all && seen > all - 2.5 * DEGREE * 2.0 * std::f64::consts::PI, "{seen} of {all}");
}

#[test]
fn skies_follow_their_scanners_when_files_are_joined() {
    let text = usual_ptx(Court::Bare, &Pulses::USUAL);
    let sources = [Source::bytes("a.ptx", text.as_bytes()), Source::bytes("b.ptx", text.as_bytes())];
    let (cloud, _) = read_cloud(sources, &ReadOptions::default(), &Control::none()).unwrap();
    assert_eq!(cloud.sky_regions.iter().map(|region| region.scanner).collect::<Vec<_>>(), [0, 1]);
    assert_eq!(cloud.select(&[0, 1, 2]).sky_regions, cloud.sky_regions);
    assert!(cloud.moved_to(&Frame::default()).sky_regions.is_empty());
}
