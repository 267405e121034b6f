//! Texts of reference systems in files: well-known text, EPSG codes and GeoTIFF keys.

use super::{Crs, CrsKind, UNIT_CODES, registry};

/// GeoTIFF's value for "described elsewhere".
const USER_DEFINED: u16 = 32767;

/// GeoTIFF keys as LAS and TIFF files store them.
pub struct GeoKeys {
    /// Header and entries of the key directory (tag or record 34735).
    pub directory: Vec<u16>,
    /// Text that the entries refer to (34737); may be empty.
    pub text: String,
}

/// Content of the raster keys besides the system.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum KeyUse {
    /// Points of a LAS file.
    Points,
    /// Pixels that are areas, not posts.
    PixelAreas,
}

/// Codes as [`Crs::parse`] reads them, the compound first: a registry may lack it.
fn codes(crs: &Crs) -> impl Iterator<Item = String> {
    let compound =
        crs.epsg.zip(crs.vertical_epsg).map(|(horizontal, vertical)| format!("EPSG:{horizontal}+{vertical}"));
    compound.into_iter().chain(crs.epsg.map(|horizontal| format!("EPSG:{horizontal}")))
}

/// Looks up the code or else the text of a system that was made by hand.
fn look_up(crs: &Crs) -> Option<Crs> {
    codes(crs).chain(crs.wkt.clone()).find_map(|text| Crs::parse(&text).ok())
}

/// Well-known text on one line: the file's own, or made from the EPSG code. `None` where neither is known.
pub fn wkt_line(crs: &Crs) -> Option<String> {
    let text = match &crs.wkt {
        Some(wkt) => wkt.clone(),
        None => codes(crs).find_map(|text| registry::wkt(&text))?,
    };
    let line = text.trim_end_matches('\0').lines().map(str::trim).collect::<Vec<_>>().join(" ");
    (!line.is_empty()).then_some(line)
}

/// GeoTIFF keys for the system and its unit, or `None` where nothing is known of it but that it is in metres.
pub fn geo_keys(crs: &Crs, key_use: KeyUse) -> Option<GeoKeys> {
    let known = look_up(crs).unwrap_or_else(|| crs.clone());
    let key = |code: Option<u32>| code.and_then(|code| u16::try_from(code).ok());
    let code = key(known.horizontal_epsg().or(crs.epsg));
    let wkt = wkt_line(crs);
    let mut text = String::new();
    let mut entries: Vec<[u16; 4]> = Vec::new();
    let raster_type = (key_use == KeyUse::PixelAreas).then_some([1025, 0, 1, 1]);
    match (code, wkt) {
        (Some(code), _) => {
            let geographic = known.kind == CrsKind::Geographic;
            entries.push([1024, 0, 1, if geographic { 2 } else { 1 }]);
            entries.extend(raster_type);
            entries.push([if geographic { 2048 } else { 3072 }, 0, 1, code]);
        }
        (None, Some(wkt)) => {
            entries.push([1024, 0, 1, USER_DEFINED]);
            entries.extend(raster_type);
            // the form in which GDAL stores and understands systems without a code
            text = format!("ESRI PE String = {}|", wkt.replace('|', "/"));
            if let Ok(length) = u16::try_from(text.len()) {
                entries.push([3073, 34737, length, 0]);
            }
        }
        (None, None) => {
            let unit_keys = unit_keys(crs)?;
            entries.push([1024, 0, 1, 1]);
            entries.extend(raster_type);
            entries.push([3072, 0, 1, USER_DEFINED]);
            entries.extend(unit_keys);
        }
    }
    if let Some(vertical) = key(crs.vertical_epsg.or(known.vertical_epsg)) {
        entries.push([4096, 0, 1, vertical]);
    }
    // readers search the keys in their order
    entries.sort_unstable();
    let count = u16::try_from(entries.len()).ok()?;
    let mut directory = vec![1, 1, 0, count];
    directory.extend(entries.into_iter().flatten());
    Some(GeoKeys { directory, text })
}

/// Keys for the units of a system of which nothing else is known; `None` for metres and for units without a code.
fn unit_keys(crs: &Crs) -> Option<[[u16; 4]; 2]> {
    let code = |metres: f64| UNIT_CODES.iter().find(|(_, unit)| (metres - unit).abs() < 1e-9 * unit).map(|&(c, _)| c);
    let (horizontal, vertical) = (code(crs.metres_per_unit)?, code(crs.vertical_metres_per_unit)?);
    let metre = code(1.0);
    ((Some(horizontal), Some(vertical)) != (metre, metre)).then_some([[3076, 0, 1, horizontal], [4099, 0, 1, vertical]])
}

/// Lines that describe the system in the comments of a text header.
pub fn comment_lines(crs: &Crs) -> Vec<String> {
    let mut lines: Vec<String> = codes(crs).next().map(|code| format!("crs {code}")).into_iter().collect();
    if let Some(wkt) = wkt_line(crs) {
        lines.extend(pieces("crs_wkt", &wkt));
    }
    lines.push(format!("metres_per_unit {} {}", crs.metres_per_unit, crs.vertical_metres_per_unit));
    lines
}

/// `text` as lines that begin with `key`: programs that read PLY with the rply library refuse lines of 1024 bytes.
/// [`joined`] puts them together again.
pub fn pieces(key: &str, text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut piece = String::new();
    for (c, next) in text.chars().zip(text.chars().skip(1).map(Some).chain([None])) {
        piece.push(c);
        // readers trim lines, so that no piece may begin or end with a blank
        let blank_beside = c.is_whitespace() || next.is_some_and(char::is_whitespace);
        if next.is_none() || (piece.len() >= 400 && !blank_beside) {
            lines.push(format!("{key} {piece}"));
            piece.clear();
        }
    }
    lines
}

/// Joins the lines that begin with `key`, in order; empty if there is none.
pub fn joined<'a>(key: &str, lines: impl Iterator<Item = &'a str>) -> String {
    lines
        .filter_map(|line| line.trim().split_once(' ').filter(|&(k, _)| k == key))
        .map(|(_, piece)| piece.trim())
        .collect()
}

/// The system that [`comment_lines`] describe, or `None` where no line says anything of it.
pub fn crs_from_comments<'a>(lines: impl Iterator<Item = &'a str> + Clone) -> Option<Crs> {
    let about = |key| Some(joined(key, lines.clone())).filter(|text| !text.is_empty());
    let (code, wkt, units) = (about("crs"), about("crs_wkt"), about("metres_per_unit"));
    let by_code = code.and_then(|code| Crs::parse(&code).ok());
    let by_text = wkt.and_then(|wkt| Crs::parse(&wkt).ok());
    let units: Option<Vec<f64>> = units.and_then(|text| text.split_whitespace().map(|v| v.parse().ok()).collect());
    let units = units.filter(|units| units.iter().all(|v| v.is_finite() && *v > 0.0));
    if by_code.is_none() && by_text.is_none() && units.is_none() {
        return None;
    }
    let mut crs = by_text.or_else(|| by_code.clone()).unwrap_or_default();
    if let Some(code) = by_code {
        (crs.epsg, crs.vertical_epsg) = (code.epsg, code.vertical_epsg.or(crs.vertical_epsg));
    }
    // The unit in use may differ from that of the system: files in feet are known to name systems in metres.
    if let Some([horizontal, vertical]) = units.as_deref() {
        (crs.metres_per_unit, crs.vertical_metres_per_unit) = (*horizontal, *vertical);
    }
    Some(crs)
}
