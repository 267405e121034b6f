//! Shapes on the map: from flags and files to local metres.

use crate::arguments::Corners;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::io::{RowsAre, Shape, read_geojson, read_observers};
use std::path::Path;

/// A shape and what to call it.
pub(super) struct Named {
    pub(super) shape: Shape,
    pub(super) name: String,
}

/// What the corners typed after `flag` are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum TypedAre {
    Line,
    Polygon,
}

/// The shapes that were typed or are in the file named, local metres; heights that are not given are NaN. `typed_are` tells what corners
/// of tables are too.
pub(super) fn shapes(flag: &str, corners: &Corners, typed_are: TypedAre, frame: &Frame) -> Result<Vec<Named>> {
    let shape = |corners: Vec<[f64; 3]>| match typed_are {
        TypedAre::Line => Shape::Line(corners),
        TypedAre::Polygon => Shape::Polygon(vec![corners]),
    };
    let path = match corners {
        Corners::Typed(corners) => {
            let corners = corners.iter().map(|&corner| frame.local_from_file(corner)).collect();
            return Ok(vec![Named { shape: shape(corners), name: flag.to_owned() }]);
        }
        Corners::File(path) => path,
    };
    let from_origin = |corner: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| corner[i] - frame.origin[i]) };
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let found: Vec<Named> = match super::extension(path).as_str() {
        "geojson" | "json" => read_geojson(path, &frame.crs)?
            .into_iter()
            .enumerate()
            .map(|(i, feature)| {
                let line = |corners: &[[f64; 3]]| corners.iter().map(from_origin).collect::<Vec<_>>();
                let shape = match &feature.shape {
                    Shape::Point(place) => Shape::Point(from_origin(place)),
                    Shape::Line(corners) => Shape::Line(line(corners)),
                    Shape::Polygon(rings) => Shape::Polygon(rings.iter().map(|ring| line(ring)).collect()),
                };
                let own = ["name", "id"].iter().find_map(|key| feature.properties.get(*key));
                let own = own.map(|value| value.as_str().map_or_else(|| value.to_string(), str::to_owned));
                Named { shape, name: own.unwrap_or_else(|| format!("{file} feature {}", i + 1)) }
            })
            .collect(),
        _ => read_observers(path, &frame.crs, RowsAre::Corners)?
            .iter()
            .map(|row| Named { shape: shape(row.corners.iter().map(from_origin).collect()), name: file.clone() })
            .collect(),
    };
    if found.is_empty() {
        bail!("{}: the file has no geometry", path.display());
    }
    Ok(found)
}

/// Refuses a shape that does not fit.
pub(super) fn wrong_shape<T>(flag: &str, corners: &Corners, expected: &str) -> Result<T> {
    let what = match corners {
        Corners::Typed(_) => flag.to_owned(),
        Corners::File(path) => Path::display(path).to_string(),
    };
    bail!("{what}: {expected}")
}
