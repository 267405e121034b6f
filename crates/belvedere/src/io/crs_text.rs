//! How a reference system is written into files: well-known text, EPSG codes and GeoTIFF keys.

use proj_core::CrsDef;

use crate::crs::Crs;

/// GeoTIFF's value for "described elsewhere".
const USER_DEFINED: u16 = 32767;

/// GeoTIFF keys as LAS and TIFF files store them.
pub(crate) struct GeoKeys {
    /// Header and entries of the key directory (tag or record 34735).
    pub(crate) directory: Vec<u16>,
    /// Text that the entries refer to (34737); may be empty.
    pub(crate) text: String,
}

/// What the raster keys should say besides the system.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum KeyUse {
    /// Points of a LAS file.
    Points,
    /// Pixels that are areas, not posts.
    PixelAreas,
}

fn definition(crs: &Crs) -> Option<CrsDef> {
    let from_code = crs.epsg.and_then(|horizontal| {
        let compound = crs.vertical_epsg.and_then(|v| proj_wkt::parse_crs(&format!("EPSG:{horizontal}+{v}")).ok());
        compound.or_else(|| proj_wkt::parse_crs(&format!("EPSG:{horizontal}")).ok())
    });
    from_code.or_else(|| crs.wkt.as_deref().and_then(|wkt| proj_wkt::parse_crs(wkt).ok()))
}

/// Well-known text on one line: the file's own, or made from the EPSG code. `None` where neither is known.
pub(crate) fn wkt_line(crs: &Crs) -> Option<String> {
    let text = match &crs.wkt {
        Some(wkt) => wkt.clone(),
        None => proj_wkt::to_wkt(&definition(crs)?).ok()?,
    };
    let line = text.trim_end_matches('\0').lines().map(str::trim).collect::<Vec<_>>().join(" ");
    (!line.is_empty()).then_some(line)
}

/// GeoTIFF keys for the system, or `None` where nothing is known of it.
pub(crate) fn geo_keys(crs: &Crs, key_use: KeyUse) -> Option<GeoKeys> {
    let definition = definition(crs);
    let horizontal = definition.as_ref().and_then(CrsDef::horizontal_crs);
    let code = horizontal.as_ref().map(CrsDef::epsg).filter(|&c| c != 0).or(crs.epsg);
    let code = code.and_then(|c| u16::try_from(c).ok());
    let vertical = crs.vertical_epsg.or_else(|| {
        definition.as_ref().and_then(CrsDef::vertical_crs).map(proj_core::VerticalCrsDef::epsg).filter(|&c| c != 0)
    });
    let geographic = horizontal.as_ref().is_some_and(|h| matches!(h, CrsDef::Geographic(_)));
    let wkt = wkt_line(crs);
    if code.is_none() && wkt.is_none() {
        return None;
    }
    let mut text = String::new();
    let mut entries: Vec<[u16; 4]> = Vec::new();
    let raster_type = (key_use == KeyUse::PixelAreas).then_some([1025, 0, 1, 1]);
    match (code, wkt) {
        (Some(code), _) => {
            entries.push([1024, 0, 1, if geographic { 2 } else { 1 }]);
            entries.extend(raster_type);
            entries.push([if geographic { 2048 } else { 3072 }, 0, 1, code]);
        }
        (None, wkt) => {
            entries.push([1024, 0, 1, USER_DEFINED]);
            entries.extend(raster_type);
            // the form in which GDAL stores and understands systems without a code
            text = format!("ESRI PE String = {}|", wkt.unwrap_or_default().replace('|', "/"));
            if let Ok(length) = u16::try_from(text.len()) {
                entries.push([3073, 34737, length, 0]);
            }
        }
    }
    if let Some(vertical) = vertical.and_then(|v| u16::try_from(v).ok()) {
        entries.push([4096, 0, 1, vertical]);
    }
    let count = u16::try_from(entries.len()).ok()?;
    let mut directory = vec![1, 1, 0, count];
    directory.extend(entries.into_iter().flatten());
    Some(GeoKeys { directory, text })
}

/// Lines that describe the system in the comments of a text header.
pub(crate) fn comment_lines(crs: &Crs) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(code) = crs.epsg {
        lines.push(match crs.vertical_epsg {
            Some(vertical) => format!("crs EPSG:{code}+{vertical}"),
            None => format!("crs EPSG:{code}"),
        });
    }
    if let Some(wkt) = wkt_line(crs) {
        lines.extend(pieces("crs_wkt", &wkt));
    }
    lines.push(format!("metres_per_unit {} {}", crs.metres_per_unit, crs.vertical_metres_per_unit));
    lines
}

/// `text` as lines that begin with `key`: programs that read PLY with the rply library refuse lines of 1024 bytes. Put
/// together again in order, the lines give the text.
pub(crate) fn pieces(key: &str, text: &str) -> Vec<String> {
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

/// The system that [`comment_lines`] describe; lines that say nothing of it are passed over.
pub(crate) fn crs_from_comments<'a>(lines: impl Iterator<Item = &'a str>) -> Crs {
    let mut crs = Crs::default();
    for line in lines {
        let Some((key, value)) = line.trim().split_once(' ') else { continue };
        match key {
            "crs" => {
                let codes = value.trim().trim_start_matches("EPSG:");
                let (horizontal, vertical) = codes.split_once('+').unwrap_or((codes, ""));
                crs.epsg = horizontal.parse().ok();
                crs.vertical_epsg = vertical.parse().ok();
            }
            "crs_wkt" => crs.wkt.get_or_insert_default().push_str(value.trim()),
            "metres_per_unit" => {
                let mut numbers =
                    value.split_whitespace().map(|v| v.parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0));
                if let (Some(Some(horizontal)), Some(Some(vertical))) = (numbers.next(), numbers.next()) {
                    crs.metres_per_unit = horizontal;
                    crs.vertical_metres_per_unit = vertical;
                }
            }
            _ => {}
        }
    }
    crs
}
