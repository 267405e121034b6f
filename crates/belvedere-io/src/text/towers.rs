//! Towers from tables and GeoJSON.

use crate::files::source::{Source, refuse_other_shapes};
use crate::map_features::{FeatureShape, read_features};
use crate::text::observers::{number_of, words_of};
use crate::text::table::read_table;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};
use std::path::Path;

/// A tower of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct TowerRow {
    /// Position on the map, in the coordinates of the cloud's file or as latitude and longitude.
    pub place: [f64; 2],
    /// Height of the foot in the unit of the file; `None` where it follows from the ground.
    pub base: Option<f64>,
    /// Height of the hub above the foot, metres; `None` where it has none.
    pub hub: Option<f64>,
    /// Height of the tip above the foot, metres.
    pub tip: f64,
    /// Name; empty for none.
    pub name: String,
    /// Scheme that it belongs to; empty for none.
    pub scheme: String,
}

/// Reads towers from a table (.csv .txt) or points (.geojson .json), in the system `crs` of the cloud. A table has the
/// columns x, y and tip; it may have base, hub, name and scheme. Points have these as properties. Heights of hub and
/// tip are metres above the base.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Malformed`] for missing columns, empty cells and text in place of numbers, and
/// for files without towers; the errors of [`read_table`] and [`read_features`].
pub fn read_towers<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<Vec<TowerRow>> {
    let source = source.into();
    let name = source.name().to_owned();
    let path = name.as_path();
    refuse_other_shapes(path)?;
    let rows = match source.extension().as_str() {
        "csv" | "txt" => of_table(source, path)?,
        "geojson" | "json" | "gpkg" | "shp" => of_points(source, path, crs)?,
        _ => {
            let supported = ".csv .txt .geojson .json .gpkg .shp";
            return Err(Error::UnknownFormat { path: path.to_owned(), kind: "towers", supported });
        }
    };
    match rows.is_empty() {
        true => Err(Error::malformed(path, "has no towers; give a row or a point with x, y and tip for each")),
        false => Ok(rows),
    }
}

fn of_points(source: Source<'_>, path: &Path, crs: &Crs) -> Result<Vec<TowerRow>> {
    let mut rows = Vec::new();
    for feature in read_features(source, crs)? {
        let FeatureShape::Point([x, y, z]) = feature.shape else {
            return Err(Error::malformed(path, "has lines or polygons; towers are points"));
        };
        let number = |name: &str| number_of(&feature.properties, name, path);
        let Some(tip) = number("tip")? else {
            let what = format!("point {} has no property tip, its height in metres", rows.len() + 1);
            return Err(Error::malformed(path, what));
        };
        let [metres, _, metres_per_height] = crs.metres_per_unit_xyz();
        rows.push(TowerRow {
            place: [x / metres, y / metres],
            base: number("base")?.or(Some(z / metres_per_height).filter(|z| z.is_finite())),
            hub: number("hub")?,
            tip,
            name: words_of(&feature.properties, "name"),
            scheme: words_of(&feature.properties, "scheme"),
        });
    }
    Ok(rows)
}

fn of_table(source: Source<'_>, path: &Path) -> Result<Vec<TowerRow>> {
    let table = read_table(source)?;
    let [x, y, tip] = table.full_columns(path, ["x", "y", "tip"])?;
    let (base, hub) = (table.column(path, "base")?, table.column(path, "hub")?);
    let (names, schemes) = (table.words("name"), table.words("scheme"));
    let words = |column: &Option<Vec<&str>>, row: usize| {
        column.as_ref().and_then(|words| words.get(row)).copied().unwrap_or_default().to_owned()
    };
    let of = |column: Option<&[f64]>, row: usize| column.map(|values| values[row]).filter(|v| v.is_finite());
    let rows = (0..x.len())
        .map(|row| TowerRow {
            place: [x[row], y[row]],
            base: of(base, row),
            hub: of(hub, row),
            tip: tip[row],
            name: words(&names, row),
            scheme: words(&schemes, row),
        })
        .collect();
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::source::Source;

    fn read(text: &str) -> Result<Vec<TowerRow>> {
        read_towers(Source::bytes("towers.csv", text.as_bytes()), &Crs::default())
    }

    #[test]
    fn points_are_towers_with_their_properties() {
        let point = |properties: &str| {
            let text = format!(
                r#"{{"type": "Feature", "geometry": {{"type": "Point", "coordinates": [1, 2]}}, "properties": {properties}}}"#
            );
            read_towers(Source::bytes("towers.geojson", text.as_bytes()), &Crs::default())
        };
        let rows = point(r#"{"Tip": 150, "hub": "100", "name": 7, "scheme": "north"}"#).unwrap();
        let expected = TowerRow {
            place: [1.0, 2.0],
            base: None,
            hub: Some(100.0),
            tip: 150.0,
            name: "7".to_owned(),
            scheme: "north".to_owned(),
        };
        assert_eq!(rows, [expected]);
        assert!(point("{}").unwrap_err().to_string().contains("no property tip"));
        assert!(point(r#"{"tip": "high"}"#).unwrap_err().to_string().contains("not a number"));
    }

    #[test]
    fn columns_that_are_missing_or_empty_are_not_given() {
        let rows = read("name,x,y,base,hub,tip,scheme\nA,1,2,30,100,150,north\n,3,4,,,80,\n").unwrap();
        let first = TowerRow {
            place: [1.0, 2.0],
            base: Some(30.0),
            hub: Some(100.0),
            tip: 150.0,
            name: "A".to_owned(),
            scheme: "north".to_owned(),
        };
        let second = TowerRow {
            place: [3.0, 4.0],
            base: None,
            hub: None,
            tip: 80.0,
            name: String::new(),
            scheme: String::new(),
        };
        assert_eq!(rows, [first, second]);
        assert_eq!(read("x;y;tip\n1;2;3\n").unwrap()[0].tip, 3.0);
        for (wrong, words) in [
            ("x,y,tip\n", "no towers"),
            ("x,y\n1,2\n", "no column tip"),
            ("x,y,tip\n1,2,\n", "tip is empty"),
            ("x,y,tip,hub\n1,2,3,high\n", "not a number"),
        ] {
            let error = read(wrong).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
    }
}
