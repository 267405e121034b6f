//! Well-known binary: geometries as GeoPackage holds them.
//!
//! # Source
//! OGC 06-103r4, Simple Features, section 8.2; ISO 13249-3 for heights and measures.

use geojson::{Geometry, GeometryValue, Position};

/// Maximum depth of collections within collections.
const MAX_DEPTH: u32 = 8;
/// Codes of types.
const POINT: u32 = 1;
const LINE: u32 = 2;
const POLYGON: u32 = 3;
const MULTI_POINT: u32 = 4;
const MULTI_LINE: u32 = 5;
const MULTI_POLYGON: u32 = 6;
const COLLECTION: u32 = 7;
/// Flags of heights and measures in the older codes of PostGIS, and the same in those of ISO.
const OLD_FLAGS: u32 = 0xe000_0000;
const ISO_STEP: u32 = 1000;

/// Bytes of a geometry that are still to be read.
struct Reader<'a> {
    bytes: &'a [u8],
    is_little_endian: bool,
    /// Numbers of a position, and whether the third is a height.
    width: usize,
    has_height: bool,
}

/// Reads a geometry; `None` for bytes that are none. A point without coordinates is an empty collection.
pub(crate) fn read(bytes: &[u8]) -> Option<Geometry> {
    let mut reader = Reader { bytes, is_little_endian: true, width: 2, has_height: false };
    reader.geometry(MAX_DEPTH)
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (taken, rest) = self.bytes.split_first_chunk::<N>()?;
        self.bytes = rest;
        Some(*taken)
    }

    fn whole(&mut self) -> Option<u32> {
        let bytes = self.take()?;
        Some(if self.is_little_endian { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn real(&mut self) -> Option<f64> {
        let bytes = self.take()?;
        Some(if self.is_little_endian { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    /// Reads a number of parts of at least `size` bytes each, which must be there.
    fn count(&mut self, size: usize) -> Option<usize> {
        let count = usize::try_from(self.whole()?).ok()?;
        (count <= self.bytes.len() / size).then_some(count)
    }

    /// Reads the head of a geometry: its byte order, type and dimensions.
    fn head(&mut self) -> Option<u32> {
        self.is_little_endian = match self.take::<1>()? {
            [0] => false,
            [1] => true,
            _ => return None,
        };
        let code = self.whole()?;
        let (flags, code) = (code & OLD_FLAGS, code & !OLD_FLAGS);
        // a number of a system follows
        if flags & 0x2000_0000 != 0 {
            self.whole()?;
        }
        let iso = code / ISO_STEP;
        if iso > 3 {
            return None;
        }
        self.has_height = flags & 0x8000_0000 != 0 || iso == 1 || iso == 3;
        let has_measure = flags & 0x4000_0000 != 0 || iso >= 2;
        self.width = 2 + usize::from(self.has_height) + usize::from(has_measure);
        Some(code % ISO_STEP)
    }

    fn position(&mut self) -> Option<Position> {
        let numbers: Vec<f64> = (0..self.width).map(|_| self.real()).collect::<Option<_>>()?;
        Some(Position::from(numbers[..2 + usize::from(self.has_height)].to_vec()))
    }

    fn positions(&mut self) -> Option<Vec<Position>> {
        (0..self.count(8 * self.width)?).map(|_| self.position()).collect()
    }

    fn rings(&mut self) -> Option<Vec<Vec<Position>>> {
        (0..self.count(4)?).map(|_| self.positions()).collect()
    }

    fn geometry(&mut self, depth: u32) -> Option<Geometry> {
        let depth = depth.checked_sub(1)?;
        Some(Geometry::new(match self.head()? {
            POINT => match self.position()? {
                empty if empty[0].is_nan() => GeometryValue::GeometryCollection { geometries: Vec::new() },
                coordinates => GeometryValue::Point { coordinates },
            },
            LINE => GeometryValue::LineString { coordinates: self.positions()? },
            POLYGON => GeometryValue::Polygon { coordinates: self.rings()? },
            MULTI_POINT | MULTI_LINE | MULTI_POLYGON | COLLECTION => {
                let geometries = (0..self.count(5)?).map(|_| self.geometry(depth)).collect::<Option<_>>()?;
                GeometryValue::GeometryCollection { geometries }
            }
            _ => return None,
        }))
    }
}

/// Bytes of a geometry, little-endian, with heights by ISO where all positions have them; `None` for one without
/// positions and for collections, which we do not write.
pub(crate) fn written(geometry: &Geometry) -> Option<Vec<u8>> {
    all_positions(geometry).next()?;
    let mut bytes = Vec::new();
    write(&geometry.value, has_heights(geometry), &mut bytes)?;
    Some(bytes)
}

/// West, east, south and north of a geometry; `None` for one without positions.
pub(crate) fn bounds(geometry: &Geometry) -> Option<[f64; 4]> {
    all_positions(geometry).map(|p| [p[0], p[0], p[1], p[1]]).reduce(joined)
}

/// The box around two boxes.
pub(crate) fn joined([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> [f64; 4] {
    [a.min(e), b.max(f), c.min(g), d.max(h)]
}

/// Returns true if a geometry has positions, and all of them have heights.
pub(crate) fn has_heights(geometry: &Geometry) -> bool {
    all_positions(geometry).next().is_some() && all_positions(geometry).all(|position| position.as_slice().len() > 2)
}

fn all_positions(geometry: &Geometry) -> Box<dyn Iterator<Item = &Position> + '_> {
    match &geometry.value {
        GeometryValue::Point { coordinates } => Box::new(std::iter::once(coordinates)),
        GeometryValue::LineString { coordinates } | GeometryValue::MultiPoint { coordinates } => {
            Box::new(coordinates.iter())
        }
        GeometryValue::Polygon { coordinates } | GeometryValue::MultiLineString { coordinates } => {
            Box::new(coordinates.iter().flatten())
        }
        GeometryValue::MultiPolygon { coordinates } => Box::new(coordinates.iter().flatten().flatten()),
        GeometryValue::GeometryCollection { geometries } => Box::new(geometries.iter().flat_map(all_positions)),
    }
}

fn write(value: &GeometryValue, has_heights: bool, bytes: &mut Vec<u8>) -> Option<()> {
    let head = |code: u32, bytes: &mut Vec<u8>| {
        bytes.push(1);
        bytes.extend((code + if has_heights { ISO_STEP } else { 0 }).to_le_bytes());
    };
    let count = |count: usize, bytes: &mut Vec<u8>| -> Option<()> {
        bytes.extend(u32::try_from(count).ok()?.to_le_bytes());
        Some(())
    };
    let position = |position: &Position, bytes: &mut Vec<u8>| {
        position.as_slice().iter().take(2 + usize::from(has_heights)).for_each(|v| bytes.extend(v.to_le_bytes()));
    };
    let line = |line: &[Position], bytes: &mut Vec<u8>| -> Option<()> {
        count(line.len(), bytes)?;
        line.iter().for_each(|one| position(one, bytes));
        Some(())
    };
    let rings = |rings: &[Vec<Position>], bytes: &mut Vec<u8>| -> Option<()> {
        count(rings.len(), bytes)?;
        rings.iter().try_for_each(|ring| line(ring, bytes))
    };
    match value {
        GeometryValue::Point { coordinates } => {
            head(POINT, bytes);
            position(coordinates, bytes);
        }
        GeometryValue::LineString { coordinates } => {
            head(LINE, bytes);
            line(coordinates, bytes)?;
        }
        GeometryValue::Polygon { coordinates } => {
            head(POLYGON, bytes);
            rings(coordinates, bytes)?;
        }
        GeometryValue::MultiPolygon { coordinates } => {
            head(MULTI_POLYGON, bytes);
            count(coordinates.len(), bytes)?;
            for polygon in coordinates {
                head(POLYGON, bytes);
                rings(polygon, bytes)?;
            }
        }
        _ => return None,
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(list: &[[f64; 3]]) -> Vec<Position> {
        list.iter().map(|p| Position::from(p.to_vec())).collect()
    }

    #[test]
    fn what_is_written_is_read_and_cut_bytes_are_nothing() {
        let ring = positions(&[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [4.0, 3.0, 2.0], [0.0, 0.0, 1.0]]);
        for value in [
            GeometryValue::Point { coordinates: Position::from(vec![1.5, -2.0]) },
            GeometryValue::LineString { coordinates: ring.clone() },
            GeometryValue::Polygon { coordinates: vec![ring.clone(), ring.clone()] },
        ] {
            let geometry = Geometry::new(value);
            let bytes = written(&geometry).unwrap();
            assert_eq!(read(&bytes).unwrap(), geometry);
            for end in 0..bytes.len() {
                assert!(read(&bytes[..end]).is_none(), "{end} of {}", bytes.len());
            }
        }
        let several = Geometry::new(GeometryValue::MultiPolygon { coordinates: vec![vec![ring.clone()], vec![ring]] });
        let bytes = written(&several).unwrap();
        let GeometryValue::GeometryCollection { geometries } = read(&bytes).unwrap().value else { panic!("polygons") };
        assert_eq!(geometries.len(), 2);
        assert_eq!(bounds(&several), Some([0.0, 4.0, 0.0, 3.0]));
        // four billion points, and collections in collections without end
        assert!(read(&[1, 2, 0, 0, 0, 255, 255, 255, 255]).is_none());
        let nested: Vec<u8> = (0..50).flat_map(|_| [1, 7, 0, 0, 0, 1, 0, 0, 0]).collect();
        assert!(read(&nested).is_none());
        // big-endian, a measure, an empty point
        let mut big = vec![0, 0, 0, 7, 209];
        [1.0_f64, 2.0, 9.0].iter().for_each(|v| big.extend(v.to_be_bytes()));
        assert_eq!(read(&big).unwrap().value, GeometryValue::Point { coordinates: Position::from([1.0, 2.0]) });
        let mut empty = vec![1, 1, 0, 0, 0];
        [f64::NAN; 2].iter().for_each(|v| empty.extend(v.to_le_bytes()));
        assert!(matches!(read(&empty).unwrap().value, GeometryValue::GeometryCollection { .. }));
    }
}
