//! Planes, edges, ridges and walls of buildings as arrays of NumPy's archive format: a row of numbers for each.

use crate::arrays::npz::{array, has, invalid, rows};
use belvedere_data::building_outlines::{BuildingOutlines, Edge, Ridge, RoofPlane, Wall};
use belvedere_data::cast::to_index;
use std::io::{self, Read, Seek, Write};
use zip::{ZipArchive, ZipWriter};

/// Arrays that files with outlines of buildings have.
pub(super) const OUTLINE_ARRAYS: [&str; 4] = ["roof_planes", "roof_edges", "roof_ridges", "walls"];

pub(super) fn write_outlines<W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    outlines: &BuildingOutlines,
) -> io::Result<()> {
    let BuildingOutlines { planes, edges, ridges, walls } = outlines;
    let [of_planes, of_edges, of_ridges, of_walls] = OUTLINE_ARRAYS;
    let planes = planes.iter().map(|plane| {
        let RoofPlane { normal: [a, b, c], center: [x, y, z], bounds: [low, high], count, noise, sd } = *plane;
        [a, b, c, x, y, z, low[0], low[1], low[2], high[0], high[1], high[2], count as f64, noise, sd]
    });
    write_rows(archive, of_planes, planes)?;
    let edges = edges.iter().map(|edge| {
        let Edge { ends: [a, b], plane, sd, count, drop } = *edge;
        [a[0], a[1], a[2], b[0], b[1], b[2], plane as f64, sd, count as f64, drop]
    });
    write_rows(archive, of_edges, edges)?;
    let ridges = ridges.iter().map(|ridge| {
        let Ridge { ends: [a, b], planes: [one, other], is_convex } = *ridge;
        [a[0], a[1], a[2], b[0], b[1], b[2], one as f64, other as f64, f64::from(u8::from(is_convex))]
    });
    write_rows(archive, of_ridges, ridges)?;
    let walls = walls.iter().map(|wall| {
        let Wall { ends: [a, b], heights: [low, high], edge, count, noise, sd, share, eaves } = *wall;
        [a[0], a[1], b[0], b[1], low, high, edge as f64, count as f64, noise, sd, share, eaves]
    });
    write_rows(archive, of_walls, walls)
}

fn write_rows<const N: usize, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    rows: impl ExactSizeIterator<Item = [f64; N]>,
) -> io::Result<()> {
    array(archive, name, &[rows.len() as u64, N as u64], rows.flatten())
}

/// The outlines of an archive, none where it has none of their arrays.
pub(super) fn read_outlines<R: Read + Seek>(archive: &mut ZipArchive<R>) -> io::Result<BuildingOutlines> {
    let [of_planes, of_edges, of_ridges, of_walls] = OUTLINE_ARRAYS;
    if !OUTLINE_ARRAYS.iter().any(|name| has(archive, name)) {
        return Ok(BuildingOutlines::default());
    }
    let planes = rows(archive, of_planes)?.into_iter().map(|row| {
        let [a, b, c, x, y, z, x0, y0, z0, x1, y1, z1, count, noise, sd] = row;
        let bounds = [[x0, y0, z0], [x1, y1, z1]];
        Ok(RoofPlane { normal: [a, b, c], center: [x, y, z], bounds, count: whole(count)?, noise, sd })
    });
    let planes = planes.collect::<io::Result<_>>()?;
    let edges = rows(archive, of_edges)?.into_iter().map(|row| {
        let [x0, y0, z0, x1, y1, z1, plane, sd, count, drop] = row;
        Ok(Edge { ends: [[x0, y0, z0], [x1, y1, z1]], plane: whole(plane)?, sd, count: whole(count)?, drop })
    });
    let edges = edges.collect::<io::Result<_>>()?;
    let ridges = rows(archive, of_ridges)?.into_iter().map(|row| {
        let [x0, y0, z0, x1, y1, z1, one, other, is_convex] = row;
        let planes = [whole(one)?, whole(other)?];
        Ok(Ridge { ends: [[x0, y0, z0], [x1, y1, z1]], planes, is_convex: whole(is_convex)? == 1 })
    });
    let ridges = ridges.collect::<io::Result<_>>()?;
    let walls = rows(archive, of_walls)?.into_iter().map(|row| {
        let [x0, y0, x1, y1, low, high, edge, count, noise, sd, share, eaves] = row;
        let (ends, heights) = ([[x0, y0], [x1, y1]], [low, high]);
        Ok(Wall { ends, heights, edge: whole(edge)?, count: whole(count)?, noise, sd, share, eaves })
    });
    let walls = walls.collect::<io::Result<_>>()?;
    Ok(BuildingOutlines { planes, edges, ridges, walls })
}

/// A row or a count that is kept among measured numbers.
fn whole(v: f64) -> io::Result<usize> {
    if !(0.0..=f64::from(u32::MAX)).contains(&v) || v.fract() != 0.0 {
        return Err(invalid(format!("{v} is neither a row nor a count")));
    }
    Ok(to_index(v))
}
