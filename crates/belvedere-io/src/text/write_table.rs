//! Point clouds as text tables with a header row.

use std::io::Write;

use rayon::prelude::*;

use crate::files::output::Output;
use crate::points::columns::WriteReport;
use crate::points::columns::{Column, attribute_columns};
use belvedere_data::{Error, PointCloud, Result};

/// Points printed by one task.
const POINTS_PER_TASK: usize = 1 << 14;
/// Tasks whose text is held in memory at a time.
const TASKS_PER_BLOCK: usize = 32;

/// Writes `cloud` with its attributes and `extra` columns, one row per point, cells parted by `separator`. Coordinates
/// have decimals down to a tenth of a millimetre.
pub(crate) fn write(
    output: Output<'_>,
    cloud: &PointCloud,
    extra: &[Column<'_>],
    separator: char,
) -> Result<WriteReport> {
    let mut columns = attribute_columns(cloud);
    columns.extend(extra.iter().cloned());
    let decimals = cloud.frame.crs.metres_per_unit_xyz().map(decimals_for);
    let separator = separator.to_string();
    output.write(|path, output| {
        let names: Vec<&str> = ["x", "y", "z"].into_iter().chain(columns.iter().map(|c| &*c.name)).collect();
        writeln!(output, "{}", names.join(&separator)).map_err(Error::io(path))?;
        let tasks: Vec<usize> = (0..cloud.len()).step_by(POINTS_PER_TASK).collect();
        for block in tasks.chunks(TASKS_PER_BLOCK) {
            let texts: Vec<std::io::Result<Vec<u8>>> = block
                .par_iter()
                .map(|&start| {
                    let mut text = Vec::new();
                    for index in start..cloud.len().min(start + POINTS_PER_TASK) {
                        print_row(&mut text, cloud, &columns, index, decimals, &separator)?;
                    }
                    Ok(text)
                })
                .collect();
            for text in texts {
                output.write_all(&text.map_err(Error::io(path))?).map_err(Error::io(path))?;
            }
        }
        Ok(WriteReport { point_count: cloud.len(), ..WriteReport::default() })
    })
}

fn print_row(
    text: &mut Vec<u8>,
    cloud: &PointCloud,
    columns: &[Column<'_>],
    index: usize,
    decimals: [usize; 3],
    separator: &str,
) -> std::io::Result<()> {
    let [x, y, z] = cloud.frame.to_file_coordinates(cloud.positions[index]);
    let [dx, dy, dz] = decimals;
    write!(text, "{x:.dx$}{separator}{y:.dy$}{separator}{z:.dz$}")?;
    for column in columns {
        text.extend_from_slice(separator.as_bytes());
        column.values.print(index, text)?;
    }
    text.push(b'\n');
    Ok(())
}

/// Decimals that resolve a tenth of a millimetre in units of `metres_per_unit`.
fn decimals_for(metres_per_unit: f64) -> usize {
    (0..15)
        .find(|&d| metres_per_unit * 0.1_f64.powi(d) <= 1.000_001e-4)
        .map_or(15, |d| usize::try_from(d).unwrap_or(15))
}
