//! The reference system of a LAS file: its records, compared with each other and with the files beside it.

use crate::files::source::SystemBeside;
use crate::las::header::LasHeader;
use crate::points::file_part::{FilePart, Unnamed};
use belvedere_data::crs::evidence::Comparison;
use belvedere_data::crs::{Crs, CrsKind};

/// Scales this fine are used for degrees, not for metres.
const DEGREE_SCALE: f64 = 1.000_001e-6;

/// Takes the system from the records of a file. Of several that agree, well-known text is the most complete; where they
/// do not agree, the bit of the header decides (LAS 1.4 R15, section 2.4), and the system is doubtful. A file without
/// one has that of the file `beside` it.
pub(crate) fn find_crs(part: &mut FilePart, header: &LasHeader, beside: Option<SystemBeside>, somewhere: [f64; 2]) {
    const USER: &str = "LASF_Projection";
    let mut unread = false;
    let mut text_of = |user: &'static str| {
        header.records(user, 2112).find_map(|record| {
            let text = String::from_utf8_lossy(record);
            let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
            let read = Crs::parse(text);
            unread |= read.is_err() && !text.is_empty();
            read.ok()
        })
    };
    let texts = [(text_of(USER), "WKT record"), (text_of("liblas"), "WKT record of libLAS")];
    let keys = header.record(USER, 34735).and_then(Crs::from_geotiff_keys);
    let [own, of_liblas] = texts.map(|(crs, source)| crs.map(|crs| (crs, source)));
    let mut named: Vec<(Crs, &str)> =
        [own, keys.map(|crs| (crs, "GeoTIFF keys")), of_liblas].into_iter().flatten().collect();
    let is_apart = |named: &[(Crs, &str)]| match named {
        [(first, _), (second, _), ..] => says_otherwise(second, first, somewhere).is_some(),
        _ => false,
    };
    if is_apart(&named) && !header.wkt_decides && named[1].1 == "GeoTIFF keys" {
        named.swap(0, 1);
    }
    let mut named = named.into_iter();
    let Some((mut crs, source)) = named.next() else {
        part.take_system(beside, somewhere);
        match (part.crs.kind != CrsKind::Unknown, unread) {
            (true, false) => {}
            (true, true) => {
                part.note(format!("its WKT record is not readable; that of {} is used", part.report.crs_source));
            }
            (false, true) => part.unnamed = Some(Unnamed::Unreadable),
            (false, false) => part.unnamed = Some(Unnamed::Missing),
        }
        return;
    };
    if unread {
        part.note(format!("a WKT record is not readable; the {source} give the reference system"));
    }
    for (other, other_source) in named {
        if let Some(how) = says_otherwise(&other, &crs, somewhere) {
            let what = format!(
                "the {source} of the file name {}, but its {other_source} {} ({how}); the first is used",
                crs.describe(),
                other.describe()
            );
            crs = crs.doubted(what);
        } else if !crs.names_heights() && other.names_heights() {
            let unit = other.vertical_metres_per_unit;
            crs = crs.with_heights_of(&other);
            if unit.to_bits() != crs.metres_per_unit.to_bits() {
                part.note(format!("the {source} name no heights; their unit is that of the {other_source}"));
            }
        }
    }
    part.set_crs(crs, source);
    part.take_system(beside, somewhere);
}

/// Contradiction of a record of a file with another; `None` without one. Keys without a code say too little to
/// contradict.
fn says_otherwise(record: &Crs, other: &Crs, somewhere: [f64; 2]) -> Option<String> {
    let says_nothing = |crs: &Crs| crs.wkt.is_none() && crs.epsg.is_none() && crs.kind == other.kind;
    if says_nothing(record) || (other.wkt.is_none() && other.epsg.is_none() && record.kind == other.kind) {
        return None;
    }
    match record.compare(other, somewhere) {
        Comparison::Apart(how) => Some(how),
        Comparison::Same | Comparison::Unknown => None,
    }
}

/// A file without a system whose scale and offset speak of degrees.
pub(crate) fn unnamed_degrees(crs: &Crs, header: &LasHeader, somewhere: [f64; 3]) -> Option<String> {
    let [x, y, _] = somewhere;
    let fine = header.scale[0].abs() <= DEGREE_SCALE && header.scale[1].abs() <= DEGREE_SCALE;
    // A metric scan that begins at its own origin is small too; degrees of a real place are hardly within 1 of (0, 0).
    let in_range = x.abs() <= 180.0 && y.abs() <= 90.0 && (x.abs() >= 1.0 || y.abs() >= 1.0);
    let coarser_height = header.scale[2].abs() >= 100.0 * header.scale[0].abs();
    if crs.kind != CrsKind::Unknown || !fine || !in_range || !coarser_height {
        return None;
    }
    Crs { kind: CrsKind::Geographic, ..Crs::default() }.refusal(somewhere).map(|what| {
        format!("names no reference system, but its scale of {} and its values say that {what}", header.scale[0])
    })
}
