//! Every reader of the library as a function of bytes, with its limit of memory. Shared with `fuzz/`, which searches
//! for files that break it.

use std::hint::black_box;
use std::path::Path;

use belvedere::Result;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{
    ReadOptions, RowsAre, Source, SystemBeside, Within, cloud_files, has_point_results, is_ball_file, read_balls,
    read_cloud, read_features, read_horizon, read_las_head, read_mesh, read_observers, read_point_results,
    read_stations, read_table, read_text_rows, read_tif, read_trajectory, read_weather,
};
use belvedere::model::SceneModel;
use belvedere_tiles::{Plan, status};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Memory that a file may take: a multiple of its size, and an amount for tables and decoders for a file of any size,
/// bytes.
const TIMES_FILE: usize = 20;
const BESIDE_FILE: usize = 64 << 20;
/// Multiple for rasters: LZW packs up to 1400 times, and the result is kept as bytes and then as f32.
const TIMES_RASTER: usize = 1400 * 5;

/// Reader, and the name of the files that it is tried on.
pub(crate) struct TriedReader {
    /// Name of the file, whose extension selects the format.
    pub(crate) file: &'static str,
    /// Function that returns true if the bytes are read, and false if they are refused.
    pub(crate) read: fn(&'static str, &[u8]) -> bool,
}

/// All readers.
pub(crate) const READERS: &[TriedReader] = &[
    TriedReader { file: "cloud.las", read: cloud },
    TriedReader { file: "cloud.laz", read: cloud },
    TriedReader { file: "window.laz", read: window },
    TriedReader { file: "head.laz", read: head },
    TriedReader { file: "cloud.e57", read: cloud },
    TriedReader { file: "cloud.ptx", read: cloud },
    TriedReader { file: "cloud.ply", read: cloud },
    TriedReader { file: "cloud.pcd", read: cloud },
    TriedReader { file: "cloud.npy", read: cloud },
    TriedReader { file: "cloud.xyz", read: cloud },
    TriedReader { file: "balls.npz", read: balls },
    TriedReader { file: "balls.ply", read: balls },
    TriedReader { file: "balls.laz", read: balls },
    TriedReader { file: "mesh.obj", read: |file, bytes| settle(read_mesh(Source::bytes(file, bytes))) },
    TriedReader { file: "mesh.ply", read: |file, bytes| settle(read_mesh(Source::bytes(file, bytes))) },
    TriedReader { file: "mesh.json", read: |file, bytes| settle(read_mesh(Source::bytes(file, bytes))) },
    TriedReader {
        file: "shapes.geojson",
        read: |file, bytes| settle(read_features(Source::bytes(file, bytes), &dutch())),
    },
    TriedReader {
        file: "observers.csv",
        read: |file, bytes| settle(read_observers(Source::bytes(file, bytes), &dutch(), RowsAre::Places)),
    },
    TriedReader {
        file: "observers.geojson",
        read: |file, bytes| settle(read_observers(Source::bytes(file, bytes), &dutch(), RowsAre::Places)),
    },
    TriedReader {
        file: "stations.csv",
        read: |file, bytes| settle(read_stations(Source::bytes(file, bytes), &dutch())),
    },
    TriedReader { file: "table.csv", read: |file, bytes| settle(read_table(Source::bytes(file, bytes))) },
    TriedReader { file: "rows.csv", read: |file, bytes| settle(read_text_rows(Source::bytes(file, bytes))) },
    TriedReader { file: "path.csv", read: |file, bytes| settle(read_trajectory(Source::bytes(file, bytes), &dutch())) },
    TriedReader {
        file: "path.sbet",
        read: |file, bytes| settle(read_trajectory(Source::bytes(file, bytes), &dutch())),
    },
    TriedReader { file: "horizon.csv", read: |file, bytes| settle(read_horizon(Source::bytes(file, bytes))) },
    TriedReader { file: "horizon.json", read: |file, bytes| settle(read_horizon(Source::bytes(file, bytes))) },
    TriedReader { file: "weather.csv", read: |file, bytes| settle(read_weather(Source::bytes(file, bytes))) },
    TriedReader { file: "raster.tif", read: |file, bytes| settle(read_tif(Source::bytes(file, bytes))) },
    TriedReader { file: "tiles.vpc", read: |file, bytes| in_folder(file, bytes, catalogue) },
    TriedReader {
        file: "ept.json",
        read: |file, bytes| in_folder(file, bytes, |folder| point_tiles(folder, "ept.json", PAGE)),
    },
    TriedReader {
        file: "ept-page.json",
        read: |file, bytes| in_folder(file, bytes, |folder| point_tiles(folder, "ept-page.json", "")),
    },
    TriedReader { file: "cloud.prj", read: |file, bytes| in_folder(file, bytes, beside) },
    TriedReader { file: "plan.json", read: |file, bytes| in_folder(file, &with_checksum(bytes), plan) },
    TriedReader { file: "record.json", read: |file, bytes| in_folder(file, &with_checksum(bytes), record) },
    TriedReader { file: "system.wkt", read: system },
];

/// Reads `bytes` as the file that `reader` reads; returns `false` if it refuses them.
///
/// # Panics
/// If the reader panics, or if it takes more memory than a file of this size may.
pub(crate) fn check(reader: &TriedReader, bytes: &[u8]) -> bool {
    let whole = if reader.file.ends_with("e57") { with_checksums(bytes) } else { bytes.to_vec() };
    let before = ALLOCATOR.current_usage();
    ALLOCATOR.reset_peak_usage();
    let is_read = (reader.read)(reader.file, &whole);
    let taken = ALLOCATOR.peak_usage().saturating_sub(before);
    let times = if reader.file.ends_with("tif") { TIMES_RASTER } else { TIMES_FILE };
    let max = times * bytes.len() + BESIDE_FILE;
    assert!(taken <= max, "{} of {} bytes took {taken} bytes of memory, more than {max}", reader.file, bytes.len());
    is_read
}

/// Drops a result, or checks that a refusal has a reason.
fn settle<T>(found: Result<T>) -> bool {
    match found {
        Ok(found) => {
            black_box(found);
            true
        }
        Err(error) => {
            assert!(error.to_string().len() > 10, "{error}");
            false
        }
    }
}

fn dutch() -> Crs {
    Crs::from_epsg(28_992).unwrap_or_default()
}

fn cloud(file: &'static str, bytes: &[u8]) -> bool {
    let found = read_cloud([Source::bytes(file, bytes)], &ReadOptions::default().with_row_numbers(), &Control::none());
    settle(found.and_then(|(cloud, _)| cloud.validate()))
}

/// Reads the points of a box, by the hierarchy or the chunks of the file.
fn window(file: &'static str, bytes: &[u8]) -> bool {
    let within = Within::File { low: [0.0, 0.0, -1000.0], high: [500.0, 447_005.0, 1000.0] };
    let options = ReadOptions::default().with_points_within(within);
    settle(read_cloud([Source::bytes(file, bytes)], &options, &Control::none()).and_then(|(cloud, _)| cloud.validate()))
}

/// Reads the parts of a file before the points.
fn head(file: &'static str, bytes: &[u8]) -> bool {
    let source = || Source::bytes(file, bytes);
    settle(read_point_results(source()));
    settle(is_ball_file(source())) & settle(has_point_results(source())) & settle(read_las_head(source()))
}

/// Reads balls and makes a scene of them.
fn balls(file: &'static str, bytes: &[u8]) -> bool {
    settle(read_balls(Source::bytes(file, bytes)).and_then(SceneModel::from_parts))
}

fn system(_file: &'static str, bytes: &[u8]) -> bool {
    str::from_utf8(bytes).is_ok_and(|text| settle(Crs::parse(text).map(|crs| crs.metres_per_unit_xyz())))
}

fn in_folder(file: &'static str, bytes: &[u8], read: fn(&Path) -> bool) -> bool {
    let Ok(folder) = tempfile::tempdir() else { return false };
    std::fs::write(folder.path().join(file), bytes).is_ok() && read(folder.path())
}

fn catalogue(folder: &Path) -> bool {
    settle(cloud_files(&[folder.join("tiles.vpc")]))
}

/// Description of entwine point tiles, and the first page of their hierarchy.
const DESCRIPTION: &str = include_str!("inputs/ept.json/valid");
const PAGE: &str = include_str!("inputs/ept-page.json/valid");

/// Writes the files of entwine point tiles with `file` in the folder: a description beside `page`, or a page beside a
/// description.
fn point_tiles(folder: &Path, file: &str, page: &str) -> bool {
    let (pages, description) = (folder.join("ept-hierarchy"), folder.join("ept.json"));
    let first = pages.join("0-0-0-0.json");
    let is_there = std::fs::create_dir(&pages).and_then(|()| match page {
        "" => std::fs::rename(folder.join(file), first).and_then(|()| std::fs::write(&description, DESCRIPTION)),
        page => std::fs::write(first, page),
    });
    let window = Within::File { low: [0.0, 0.0, -1000.0], high: [500.0, 447_005.0, 1000.0] };
    let options = ReadOptions::default().with_points_within(window);
    // The nodes are missing; the error is about the first one that a window meets.
    let _ = black_box(read_cloud([&description], &options, &Control::none()));
    is_there.is_ok() && settle(cloud_files(&[description]))
}

/// Reads the reference system of a cloud from a file beside it. A file that names none is refused without a reason of
/// its own.
fn beside(folder: &Path) -> bool {
    let found = Source::path(folder.join("cloud.copc.laz")).system_beside();
    let is_known = matches!(found, Some(SystemBeside::Known { .. }));
    black_box(found);
    is_known
}

fn plan(folder: &Path) -> bool {
    let found = Plan::read(folder);
    if let Ok(plan) = &found {
        black_box((plan.estimate(), plan.bounds(), plan.frame().is_ok(), status(plan, folder).is_complete()));
    }
    settle(found)
}

/// Reads a record of the balls of a tile, with its plan beside it among the inputs.
fn record(folder: &Path) -> bool {
    let plan = with_checksum(include_bytes!("inputs/plan.json/valid"));
    let place = folder.join("balls");
    let is_there = std::fs::write(folder.join("plan.json"), plan)
        .and_then(|()| std::fs::create_dir(&place))
        .and_then(|()| std::fs::write(place.join("e2422_n7233.npz"), []))
        .and_then(|()| std::fs::rename(folder.join("record.json"), place.join("e2422_n7233.json")));
    let (Ok(()), Ok(plan)) = (is_there, Plan::read(folder)) else { return false };
    status(&plan, folder).stages.iter().any(|stage| stage.done > 0)
}

/// Returns JSON with a correct checksum at the start, as in plans and records. Few changed files have one.
fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let rest = bytes.strip_prefix(b"{").unwrap_or(bytes);
    let start = format!("{{\"checksum\":\"{:08x}\",", crc32fast::hash(rest));
    [start.as_bytes(), rest].concat()
}

/// Returns the bytes with a correct checksum at the end of each page of an E57 file. Few changed files have one.
fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for page in bytes.as_chunks_mut::<1024>().0 {
        let crc = crc32c(&page[..1020]).to_be_bytes();
        page[1020..].copy_from_slice(&crc);
    }
    bytes
}

fn crc32c(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0x82f6_3b78 } else { 0 })
    })
}
