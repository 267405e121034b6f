//! Lists of tiles, as services send them.
//!
//! # Source
//! RFC 7946 (GeoJSON, Butler et al. 2016), as WFS services answer; STAC API 1.0, item search; The National Map Access
//! API 1 (U.S. Geological Survey), products.

use serde::Serialize;
use serde_json::Value;
use std::path::Path;

use super::table::without_key;
use crate::files::source::web_address;
use belvedere_data::shown::without_secrets;

/// Ends of addresses of point clouds, the best first: windows of COPC are read without the rest, archives not at all.
const ENDS: [&str; 5] = [".copc.laz", ".laz", ".las", ".laz.zip", ".las.zip"];

/// A file of a survey.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyTile {
    /// Its address; without a key where it is written down.
    #[serde(serialize_with = "without_key")]
    pub address: String,
    /// Its size, where the service or its server says it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Date by the service, such as "2020-03-01T00:00:00Z".
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
}

impl SurveyTile {
    /// Name for its file: the last part of the address, without letters that file systems do not have.
    #[must_use]
    pub fn file_name(&self) -> String {
        let plain = self.address.split(['?', '#']).next().unwrap_or_default();
        let last = plain.rsplit('/').next().unwrap_or_default();
        let is_usual = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
        let name: String = last.chars().map(|letter| if is_usual(letter) { letter } else { '_' }).collect();
        name.trim_start_matches('.').to_owned()
    }

    /// True for archives, which must be unpacked before their points can be read.
    #[must_use]
    pub fn is_archive(&self) -> bool {
        Path::new(&self.file_name()).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("zip"))
    }
}

/// A page of a list.
#[derive(Debug, PartialEq)]
pub(super) struct ListPage {
    /// Tiles with their box in the coordinates of the list; `None` where it has none.
    pub(super) tiles: Vec<(SurveyTile, Option<[f64; 4]>)>,
    /// Number of rows, with those of other products.
    pub(super) row_count: u64,
    /// Number of rows of all pages, where the service says it.
    pub(super) total: Option<u64>,
    /// Address of the next page.
    pub(super) next: Option<String>,
}

impl ListPage {
    /// Reads a page: GeoJSON, STAC items, or products of The National Map.
    ///
    /// # Errors
    /// Description of an answer that holds no list.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let page: Value = serde_json::from_str(text).map_err(|_| no_list(text))?;
        let rows = ["features", "items"].into_iter().find_map(|name| page.get(name)?.as_array());
        let rows = rows.ok_or_else(|| no_list(text))?;
        let tiles = rows.iter().filter_map(tile_of).collect();
        let links = page.get("links").and_then(Value::as_array);
        let next = links.into_iter().flatten().find(|link| link.get("rel").and_then(Value::as_str) == Some("next"));
        let next = next.and_then(|link| link.get("href")?.as_str());
        if let Some(odd) = next.filter(|href| !is_address(href)) {
            return Err(format!("names a next page that is no address: {}", without_secrets(odd)));
        }
        let total = ["total", "numberMatched"].into_iter().find_map(|name| page.get(name)?.as_u64());
        Ok(Self { tiles, row_count: rows.len() as u64, total, next: next.map(str::to_owned) })
    }
}

fn no_list(text: &str) -> String {
    let start: String = text.chars().take(80).collect();
    let start = without_secrets(&start);
    format!("the service sends no list of tiles, but {start:?}; its address may have changed: look at its page")
}

fn is_address(text: &str) -> bool {
    web_address(Path::new(text)).is_some()
}

/// The point cloud that a row of a list names; `None` for other products.
fn tile_of(row: &Value) -> Option<(SurveyTile, Option<[f64; 4]>)> {
    let ranked = texts_in(row).into_iter().filter_map(|text| Some((rank_of(text)?, text)));
    let (_, address) = ranked.min_by_key(|&(rank, _)| rank)?;
    let property = |name: &str| row.get(name).or_else(|| row.get("properties")?.get(name));
    let date = ["datetime", "end_datetime", "publicationDate"].into_iter().find_map(|name| property(name)?.as_str());
    let bytes = property("sizeInBytes").and_then(Value::as_u64);
    Some((SurveyTile { address: address.to_owned(), bytes, date: date.map(str::to_owned) }, box_of(row)))
}

/// The rank among [`ENDS`] of an address; `None` for other texts.
fn rank_of(text: &str) -> Option<usize> {
    if !is_address(text) {
        return None;
    }
    let plain = text.split(['?', '#']).next()?.to_ascii_lowercase();
    ENDS.iter().position(|end| plain.ends_with(end))
}

/// All texts in `value`. Its depth is bounded by that of the parser.
fn texts_in(value: &Value) -> Vec<&str> {
    match value {
        Value::String(text) => vec![text],
        Value::Array(values) => values.iter().flat_map(texts_in).collect(),
        Value::Object(members) => members.values().flat_map(texts_in).collect(),
        _ => Vec::new(),
    }
}

/// West, south, east and north of a row: of its `bbox`, its `boundingBox`, or its geometry.
fn box_of(row: &Value) -> Option<[f64; 4]> {
    let numbers = |value: &Value| value.as_array()?.iter().map(Value::as_f64).collect::<Option<Vec<_>>>();
    let found = match row.get("bbox").and_then(numbers).as_deref() {
        Some(&[west, south, east, north] | &[west, south, _, east, north, _]) => Some([west, south, east, north]),
        _ => None,
    };
    let found = found.or_else(|| {
        let sides = row.get("boundingBox")?;
        let side = |name| sides.get(name).and_then(Value::as_f64);
        Some([side("minX")?, side("minY")?, side("maxX")?, side("maxY")?])
    });
    let found = found.or_else(|| bounds_of(row.get("geometry")?.get("coordinates")?));
    found.filter(|[west, south, east, north]| west < east && south < north)
}

/// The box around all positions in nested lists of coordinates.
fn bounds_of(coordinates: &Value) -> Option<[f64; 4]> {
    let values = coordinates.as_array()?;
    if let [Some(x), Some(y)] = [0, 1].map(|axis| values.get(axis).and_then(Value::as_f64)) {
        return Some([x, y, x, y]);
    }
    let boxes = values.iter().filter_map(bounds_of);
    boxes.reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(text: &str) -> (SurveyTile, Option<[f64; 4]>) {
        let mut page = ListPage::parse(text).unwrap();
        assert_eq!(page.tiles.len(), 1);
        page.tiles.remove(0)
    }

    #[test]
    fn rows_of_a_feature_service_have_address_and_box() {
        let (tile, bounds) = only(
            r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "id": "dalle.1",
            "geometry": {"type": "Polygon", "coordinates": [[[448000, 6251000], [449000, 6251000], [449000, 6252000],
            [448000, 6252000], [448000, 6251000]]]},
            "properties": {"name": "LHD_FXX_0448_6252", "projection": "EPSG:2154",
            "url": "https://a.example/LHD_FXX_0448_6252_PTS_LAMB93_IGN69.copc.laz"}}], "totalFeatures": 1}"#,
        );
        assert_eq!(tile.address, "https://a.example/LHD_FXX_0448_6252_PTS_LAMB93_IGN69.copc.laz");
        assert_eq!((tile.bytes, tile.date), (None, None));
        assert_eq!(bounds, Some([448e3, 6251e3, 449e3, 6252e3]));
    }

    #[test]
    fn items_of_stac_give_their_best_asset_and_the_next_page() {
        let page = ListPage::parse(
            r#"{"type": "FeatureCollection", "features": [{"id": "s_2020_1", "bbox": [8.5, 47.3, 8.6, 47.4],
            "properties": {"datetime": "2020-03-01T00:00:00Z"},
            "assets": {"s_2020_1.las.zip": {"href": "https://a.example/s_2020_1.las.zip"},
            "s_2020_1.copc.laz": {"href": "https://a.example/s_2020_1.copc.laz"},
            "thumbnail": {"href": "https://a.example/s.png"}}}, {"id": "no point cloud", "assets": {}}],
            "links": [{"rel": "self", "href": "https://a.example/1"}, {"rel": "next", "href": "https://a.example/2"}]}"#,
        )
        .unwrap();
        assert_eq!(page.next.as_deref(), Some("https://a.example/2"));
        let [(tile, bounds)] = &page.tiles[..] else { panic!("{page:?}") };
        assert_eq!(tile.address, "https://a.example/s_2020_1.copc.laz");
        assert_eq!(tile.date.as_deref(), Some("2020-03-01T00:00:00Z"));
        assert_eq!(*bounds, Some([8.5, 47.3, 8.6, 47.4]));
    }

    #[test]
    fn products_of_the_national_map_have_size_date_and_box() {
        let (tile, bounds) = only(
            r#"{"total": 1, "items": [{"title": "USGS Lidar Point Cloud", "publicationDate": "2020-01-14",
            "sizeInBytes": 74837022, "downloadURL": "https://a.example/x.zip", "vendorMetaUrl": "https://a.example/x.xml",
            "downloadLazURL": "https://a.example/LAZ/x.laz?v=1",
            "boundingBox": {"minX": -122.1, "maxX": -122.0, "minY": 37.1, "maxY": 37.2}}]}"#,
        );
        assert_eq!((tile.address.as_str(), tile.bytes), ("https://a.example/LAZ/x.laz?v=1", Some(74_837_022)));
        assert_eq!(tile.date.as_deref(), Some("2020-01-14"));
        assert_eq!(bounds, Some([-122.1, 37.1, -122.0, 37.2]));
    }

    #[test]
    fn other_answers_are_described_and_other_addresses_passed_over() {
        for text in ["", "<html>maintenance</html>", "[]", "{}", r#"{"features": 3}"#] {
            assert!(ListPage::parse(text).unwrap_err().contains("no list of tiles"), "{text}");
        }
        for address in ["file:///etc/a.laz", "ftp://a/b.laz", "../b.laz", "https://a.example/b.tif"] {
            let page = ListPage::parse(&format!(r#"{{"features": [{{"properties": {{"url": "{address}"}}}}]}}"#));
            assert_eq!(page.unwrap().tiles, [], "{address}");
        }
        let odd = r#"{"features": [{"bbox": [5, 5, 4, 6], "geometry": {"coordinates": [[[]], {}, "a"]},
            "properties": {"url": "https://a.example/b.laz", "sizeInBytes": -3}}], "total": 7}"#;
        let page = ListPage::parse(odd).unwrap();
        assert_eq!((page.next, page.tiles[0].1, page.tiles[0].0.bytes), (None, None, None));
        assert_eq!((page.row_count, page.total), (1, Some(7)));
        let relative = r#"{"features": [], "links": [{"rel": "next", "href": "?page=2"}]}"#;
        assert!(ListPage::parse(relative).unwrap_err().contains("no address"));
    }

    #[test]
    fn names_of_files_stay_in_their_folder() {
        let tile = |address: &str| SurveyTile { address: address.to_owned(), bytes: None, date: None };
        for (address, name) in [
            ("https://a/b/c.copc.laz?key=/x", "c.copc.laz"),
            ("https://a/..", ""),
            ("https://a/b/%2e%2e%2fc d.laz", "_2e_2e_2fc_d.laz"),
            ("https://a/.hidden.laz", "hidden.laz"),
        ] {
            assert_eq!(tile(address).file_name(), name);
        }
        assert!(tile("https://a/b.las.ZIP").is_archive() && !tile("https://a/b.laz").is_archive());
    }
}
