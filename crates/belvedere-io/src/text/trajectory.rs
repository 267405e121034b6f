//! Trajectories: SBET and text tables.

use std::path::Path;

use crate::files::source::Source;
use belvedere_data::crs::Crs;
use belvedere_data::trajectory::Trajectory;
use belvedere_data::{Error, Result};

/// Bytes of an SBET record: 17 little-endian f64, of which time, latitude, longitude and altitude come first.
const SBET_RECORD_BYTES: usize = 17 * 8;

/// Counts of a trajectory file: records and those left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TrajectoryReport {
    /// Records in the file.
    pub record_count: usize,
    /// Records left out because another had the same time.
    pub duplicate_count: usize,
}

/// The trajectory in a file, in the metres of the cloud's reference system and increasing in time, and counts of the
/// records left out.
///
/// `.sbet` and `.out` hold 136-byte records with latitude and longitude in radians, which are projected. Their altitude
/// is unchanged, above the ellipsoid (tens of metres off the cloud's heights, harmless for the signs of normals).
///
/// `.csv` and `.txt` hold time, x, y, z in the unit of the cloud's file. Columns are found by a heading (time, gpstime
/// or t; x or easting; y or northing; z, alt or height), without one the first four count. Commas, semicolons, tabs and
/// blanks separate; lines that begin with # are skipped.
///
/// # Errors
/// - [`Error::Io`] if the file cannot be read.
/// - [`Error::UnknownFormat`] for other extensions.
/// - [`Error::UnusableCrs`] if SBET is to be projected but the cloud's system is unknown.
/// - [`Error::Malformed`] for values that are not finite, a size that is no multiple of 136, missing columns, and fewer
///   than two different times.
///
/// # Source
/// Field order of SBET: PDAL, `io/SbetCommon.hpp`.
pub fn read_trajectory<'a>(source: impl Into<Source<'a>>, cloud_crs: &Crs) -> Result<(Trajectory, TrajectoryReport)> {
    let source = source.into();
    let name = source.name().to_owned();
    let path = name.as_path();
    let records = match source.extension().as_str() {
        "sbet" | "out" => sbet_records(path, &source.read_all()?.1, cloud_crs)?,
        "csv" | "txt" => table_records(path, &source.read_text()?.1, cloud_crs)?,
        _ => {
            let supported = ".sbet, .out, .csv or .txt";
            return Err(Error::UnknownFormat { path: path.to_owned(), kind: "trajectory", supported });
        }
    };
    let record_count = records.len();
    if let Some((time, p)) = records.iter().find(|(time, p)| !(time.is_finite() && p.iter().all(|v| v.is_finite()))) {
        return Err(Error::malformed(path, format!("a record is not finite: time {time}, position {p:?}")));
    }
    let (trajectory, duplicate_count) = Trajectory::from_records(records);
    if trajectory.times.len() < 2 {
        let what = format!("a trajectory needs two different times, but this one has {}", trajectory.times.len());
        return Err(Error::malformed(path, what));
    }
    Ok((trajectory, TrajectoryReport { record_count, duplicate_count }))
}

fn sbet_records(path: &Path, bytes: &[u8], cloud_crs: &Crs) -> Result<Vec<(f64, [f64; 3])>> {
    if bytes.is_empty() || !bytes.len().is_multiple_of(SBET_RECORD_BYTES) {
        let what = format!("{} bytes, which is not a multiple of the 136 bytes of an SBET record", bytes.len());
        return Err(Error::malformed(path, what));
    }
    let projection = cloud_crs.geographic_projection().map_err(|e| Error::UnusableCrs {
        path: path.to_owned(),
        what: format!("latitude and longitude cannot be converted to the reference system of the cloud: {e}"),
    })?;
    let mut records = Vec::with_capacity(bytes.len() / SBET_RECORD_BYTES);
    for (row, record) in bytes.chunks_exact(SBET_RECORD_BYTES).enumerate() {
        let mut fields = [0.0; 4];
        for (field, bytes) in fields.iter_mut().zip(record.chunks_exact(8)) {
            *field = f64::from_le_bytes(bytes.try_into().unwrap_or_default());
        }
        let [time, latitude, longitude, altitude] = fields;
        let [x, y] = projection
            .project(latitude, longitude)
            .map_err(|e| Error::malformed(path, format!("record {row} (from 0): {e}")))?;
        records.push((time, [x, y, altitude]));
    }
    Ok(records)
}

/// Columns of time, x, y and z.
type ColumnIndices = [usize; 4];

fn table_records(path: &Path, bytes: &[u8], cloud_crs: &Crs) -> Result<Vec<(f64, [f64; 3])>> {
    let text = String::from_utf8_lossy(bytes);
    let scale = cloud_crs.metres_per_unit_xyz();
    let mut columns: Option<ColumnIndices> = None;
    let mut records = Vec::new();
    for (row, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let line = line.trim();
        let bare = line.trim_start_matches(['#', '/', '%']).trim();
        if bare.is_empty() {
            continue;
        }
        let commented = bare.len() < line.len();
        let fields = split_fields(bare);
        if fields.first().is_some_and(|first| number(first).is_none()) {
            match heading_columns(&fields) {
                Some(found) => columns = Some(found),
                None if commented => {}
                None => {
                    let what =
                        format!("line {} names no columns time, x, y and z, and is not a number: \"{bare}\"", row + 1);
                    return Err(Error::malformed(path, what));
                }
            }
            continue;
        }
        if commented {
            continue;
        }
        let mut values = [0.0; 4];
        for (value, &column) in values.iter_mut().zip(columns.get_or_insert([0, 1, 2, 3]).iter()) {
            *value = fields.get(column).and_then(|field| number(field)).ok_or_else(|| {
                Error::malformed(path, format!("line {}: no number in column {}: \"{bare}\"", row + 1, column + 1))
            })?;
        }
        let [time, x, y, z] = values;
        records.push((time, [x * scale[0], y * scale[1], z * scale[2]]));
    }
    Ok(records)
}

/// Fields of a line. A comma separates unless semicolons or tabs do, in which case it is the decimal sign.
fn split_fields(line: &str) -> Vec<String> {
    let fields: Vec<&str> = if line.contains(';') {
        line.split(';').collect()
    } else if line.contains('\t') {
        line.split('\t').collect()
    } else if line.contains(',') {
        return line.split(',').map(|field| field.trim().to_owned()).collect();
    } else {
        line.split_whitespace().collect()
    };
    fields.into_iter().map(|field| field.trim().replace(',', ".")).collect()
}

fn number(field: &str) -> Option<f64> {
    // "nan" and "inf" parse as numbers and are refused later, with their value
    field.parse().ok()
}

fn heading_columns(fields: &[String]) -> Option<ColumnIndices> {
    let names: Vec<String> = fields
        .iter()
        .map(|field| {
            let name = field.split(['[', '(']).next().unwrap_or("");
            name.chars().filter(|c| c.is_alphanumeric()).collect::<String>().to_ascii_lowercase()
        })
        .collect();
    let find = |known: &[&str]| known.iter().find_map(|&name| names.iter().position(|n| n == name));
    Some([
        find(&["gpstime", "time", "t", "gpstimes", "times", "timestamp", "gpsseconds"])?,
        find(&["x", "easting", "east", "e"])?,
        find(&["y", "northing", "north", "n"])?,
        find(&["z", "alt", "altitude", "height", "h", "elevation"])?,
    ])
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn written(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        (folder, path)
    }

    fn sbet(records: &[[f64; 4]]) -> Vec<u8> {
        let record = |r: &[f64; 4]| r.iter().copied().chain([0.5; 13]).flat_map(f64::to_le_bytes).collect::<Vec<u8>>();
        records.iter().flat_map(record).collect()
    }

    fn read(name: &str, text: &str) -> Result<(Trajectory, TrajectoryReport)> {
        let (_folder, path) = written(name, text.as_bytes());
        read_trajectory(&path, &Crs::default())
    }

    #[test]
    fn sbet_lands_on_the_map() {
        let place = [52.155_174_40_f64.to_radians(), 5.387_206_21_f64.to_radians()];
        let (_folder, path) =
            written("a.sbet", &sbet(&[[2.0, place[0], place[1], 500.0], [1.0, place[0], place[1] + 1e-6, 501.0]]));
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        let (trajectory, report) = read_trajectory(&path, &rd).unwrap();
        assert_eq!(trajectory.times, [1.0, 2.0]);
        assert_eq!(report, TrajectoryReport { record_count: 2, duplicate_count: 0 });
        let [x, y, z] = trajectory.positions[1];
        assert!((x - 155_000.0).abs() < 1.0 && (y - 463_000.0).abs() < 1.0 && (z - 500.0).abs() < 1e-9);
        // a millionth of a radian along the parallel: 6378137 m + the local surplus, times cos(52.155 deg)
        assert!((trajectory.positions[0][0] - x - 3.92).abs() < 0.02);
        let error = read_trajectory(&path, &Crs::default()).unwrap_err().to_string();
        assert!(error.contains("EPSG"), "{error}");
    }

    #[test]
    fn broken_sbet_is_refused() {
        let rd = Crs { epsg: Some(28_992), ..Crs::default() };
        let good = sbet(&[[1.0, 0.91, 0.09, 1.0], [2.0, 0.91, 0.09, 1.0]]);
        for bytes in
            [&good[..200], &[][..], &good[..136], &sbet(&[[1.0, f64::NAN, 0.1, 0.0], [2.0, 0.9, 0.1, 0.0]])[..]]
        {
            let (_folder, path) = written("a.out", bytes);
            assert!(matches!(read_trajectory(&path, &rd), Err(Error::Malformed { .. })));
        }
    }

    #[test]
    fn tables_of_any_shape_give_the_same_path() {
        let tables = [
            "1.5 10 20 30\n0.5 1 2 3\n0.5 9 9 9\n",
            "Height;GPSTime [s];Easting (m);Northing\n3,0;0,5;1;2\n30;1,5;10;20\n",
            "# made by hand\n# t, x, y, z\n0.5,1,2,3\n1.5,10,20,30\n",
            "\u{feff}gps_time\tx\ty\talt\tpitch\n0.5\t1\t2\t3\t0\n1.5\t10\t20\t30\t0\n",
        ];
        for table in tables {
            let (trajectory, _) = read("t.csv", table).unwrap();
            assert_eq!(trajectory.times, [0.5, 1.5], "{table}");
            assert_eq!(trajectory.positions, [[1.0, 2.0, 3.0], [10.0, 20.0, 30.0]], "{table}");
        }
        assert_eq!(read("t.txt", tables[0]).unwrap().1, TrajectoryReport { record_count: 3, duplicate_count: 1 });
    }

    #[test]
    fn nonsense_tables_are_refused() {
        for table in ["", "1 2 3\n", "1 2 3 4\n", "time,lat,lon\n1,2,3\n", "1 2 3 nan\n2 2 3 4\n", "t x y z\n1 2 x 4\n"]
        {
            assert!(matches!(read("t.txt", table), Err(Error::Malformed { .. })), "{table}");
        }
        assert!(matches!(read("t.las", ""), Err(Error::UnknownFormat { .. })));
    }

    #[test]
    fn feet_become_metres() {
        let (_folder, path) = written("t.txt", b"0 1000 2000 300\n1 1000 2000 300\n");
        let feet = Crs { metres_per_unit: 0.3048, vertical_metres_per_unit: 0.3048, ..Crs::default() };
        let p = read_trajectory(&path, &feet).unwrap().0.positions[0];
        assert!((p[0] - 304.8).abs() < 1e-9 && (p[1] - 609.6).abs() < 1e-9 && (p[2] - 91.44).abs() < 1e-9);
    }
}
