//! Shapes on the map: from flags and files to local metres.

use crate::arguments::CornersArgument;
use crate::outputs::formats::extension;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::io::{FEATURE_EXTENSIONS, FeatureShape, RowsAre, read_features, read_observers};
use std::path::Path;

/// A shape and what to call it.
pub(crate) struct NamedShape {
    pub(crate) shape: FeatureShape,
    pub(crate) name: String,
}

/// Meaning of the corners typed after `flag`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum TypedAre {
    Line,
    Polygon,
}

/// The shapes that were typed or are in the file named, local metres; heights that are not given are NaN. `typed_are`
/// tells what corners of tables are too.
pub(crate) fn shapes(
    flag: &str,
    corners: &CornersArgument,
    typed_are: TypedAre,
    frame: &Frame,
) -> Result<Vec<NamedShape>> {
    let shape = |corners: Vec<[f64; 3]>| match typed_are {
        TypedAre::Line => FeatureShape::Line(corners),
        TypedAre::Polygon => FeatureShape::Polygon(vec![corners]),
    };
    let path = match corners {
        CornersArgument::Typed(corners) => {
            let corners = corners.iter().map(|&corner| frame.local_from_file(corner)).collect();
            return Ok(vec![NamedShape { shape: shape(corners), name: flag.to_owned() }]);
        }
        CornersArgument::File(path) => path,
    };
    let from_origin = |corner: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|i| corner[i] - frame.origin[i]) };
    let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let found: Vec<NamedShape> = match extension(path).as_str() {
        extension if FEATURE_EXTENSIONS.contains(&extension) => read_features(path, &frame.crs)?
            .into_iter()
            .enumerate()
            .map(|(i, feature)| {
                let line = |corners: &[[f64; 3]]| corners.iter().map(from_origin).collect::<Vec<_>>();
                let shape = match &feature.shape {
                    FeatureShape::Point(place) => FeatureShape::Point(from_origin(place)),
                    FeatureShape::Line(corners) => FeatureShape::Line(line(corners)),
                    FeatureShape::Polygon(rings) => {
                        FeatureShape::Polygon(rings.iter().map(|ring| line(ring)).collect())
                    }
                };
                let own = ["name", "id"].iter().find_map(|key| feature.properties.get(*key));
                let own = own.map(|value| value.as_str().map_or_else(|| value.to_string(), str::to_owned));
                NamedShape { shape, name: own.unwrap_or_else(|| format!("{file} feature {}", i + 1)) }
            })
            .collect(),
        _ => read_observers(path, &frame.crs, RowsAre::Corners)?
            .rows
            .iter()
            .map(|row| NamedShape { shape: shape(row.corners.iter().map(from_origin).collect()), name: file.clone() })
            .collect(),
    };
    if found.is_empty() {
        bail!("{}: the file has no geometry", path.display());
    }
    Ok(found)
}

/// Refuses a shape that does not fit.
pub(crate) fn wrong_shape<T>(flag: &str, corners: &CornersArgument, expected: &str) -> Result<T> {
    let what = match corners {
        CornersArgument::Typed(_) => flag.to_owned(),
        CornersArgument::File(path) => Path::display(path).to_string(),
    };
    bail!("{what}: {expected}")
}
