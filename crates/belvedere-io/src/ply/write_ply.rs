//! Binary little-endian PLY point clouds.

use rayon::prelude::*;

use crate::files::output::Output;
use crate::points::columns::WriteReport;
use crate::points::columns::{Column, ColumnValues, attribute_columns};
use belvedere_data::crs::text::comment_lines;
use belvedere_data::{Error, PointCloud, Result};

/// Points encoded at a time; bounds the memory beside the cloud.
const POINTS_PER_BLOCK: usize = 1 << 18;

/// An element that follows the points; the default is none.
#[derive(Default)]
pub(crate) struct PlyElement {
    /// Its lines in the header.
    pub(crate) header: String,
    /// Its rows.
    pub(crate) bytes: Vec<u8>,
}

/// Writes `cloud` with its attributes and `extra` columns. Each of `comments` becomes a comment of the header, beside
/// those about the reference system; `element` follows the points. Coordinates are f64 in the unit of the cloud's file.
pub(crate) fn write(
    output: Output<'_>,
    cloud: &PointCloud,
    extra: &[Column<'_>],
    comments: &[String],
    element: &PlyElement,
) -> Result<WriteReport> {
    let mut columns = attribute_columns(cloud);
    columns.extend(extra.iter().cloned());
    let row_bytes = 24 + columns.iter().map(|c| c.values.width()).sum::<usize>();
    output.write(|path, output| {
        output.write_all(header(cloud, &columns, comments, element).as_bytes()).map_err(Error::io(path))?;
        let mut block = Vec::new();
        for start in (0..cloud.len()).step_by(POINTS_PER_BLOCK) {
            let count = POINTS_PER_BLOCK.min(cloud.len() - start);
            block.resize(count * row_bytes, 0);
            block.par_chunks_mut(row_bytes).enumerate().for_each(|(i, row)| encode(row, cloud, &columns, start + i));
            output.write_all(&block).map_err(Error::io(path))?;
        }
        output.write_all(&element.bytes).map_err(Error::io(path))?;
        Ok(WriteReport { point_count: cloud.len(), ..WriteReport::default() })
    })
}

/// Returns the start of a header: `comments`, and a number of vertices with coordinates.
pub(crate) fn header_start<'a>(comments: impl IntoIterator<Item = &'a String>, vertex_count: usize) -> String {
    let comments: String = comments.into_iter().map(|line| format!("comment {}\n", plain(line))).collect();
    format!(
        "ply\nformat binary_little_endian 1.0\ncomment written by belvedere\n{comments}element vertex {vertex_count}\n\
         property double x\nproperty double y\nproperty double z\n"
    )
}

/// Returns a comment in ASCII, as many readers refuse other headers.
pub(crate) fn plain(line: &str) -> String {
    line.chars().map(|c| if c.is_ascii() && !c.is_ascii_control() { c } else { '?' }).collect()
}

fn header(cloud: &PointCloud, columns: &[Column<'_>], comments: &[String], element: &PlyElement) -> String {
    let mut text = header_start(comment_lines(&cloud.frame.crs).iter().chain(comments), cloud.len());
    for column in columns {
        let kind = match column.values {
            ColumnValues::U8(_) => "uchar",
            ColumnValues::U16(_) => "ushort",
            ColumnValues::U32(_) => "uint",
            ColumnValues::I32(_) => "int",
            ColumnValues::F32(_) | ColumnValues::Clock(_) => "float",
            ColumnValues::F64(_) => "double",
        };
        text.push_str(&format!("property {kind} {}\n", column.name));
    }
    text.push_str(&element.header);
    text.push_str("end_header\n");
    text
}

fn encode(row: &mut [u8], cloud: &PointCloud, columns: &[Column<'_>], index: usize) {
    for (axis, value) in cloud.frame.to_file_coordinates(cloud.positions[index]).into_iter().enumerate() {
        row[axis * 8..axis * 8 + 8].copy_from_slice(&value.to_le_bytes());
    }
    let mut at = 24;
    for column in columns {
        column.values.put(index, &mut row[at..]);
        at += column.values.width();
    }
}
