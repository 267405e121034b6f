//! `belvedere normals`.

use super::extension;
use crate::arguments::{Cleaning, Global, Normals};
use crate::pipeline;
use crate::progress::Stages;
use crate::summary::Summary;
use anyhow::Result;
use belvedere::io::{ExtraColumn, ExtraValues, MasbcppFolder, write_cloud, write_masbcpp};

pub(crate) fn run(arguments: &Normals, global: &Global) -> Result<Summary> {
    let mut stages = Stages::new(global);
    let mut summary = Summary::default();
    let cloud = pipeline::read(&arguments.input, &mut stages, &mut summary)?;
    let output = &arguments.output;
    let is_folder = extension(output).is_empty();
    let nothing = Cleaning::nothing();
    // the rows of a folder belong to the rows of its coords.npy
    let cleaning = if is_folder { &nothing } else { &arguments.cleaning };
    let prepared = pipeline::prepare(&cloud, cleaning, &arguments.orienting, &mut stages, &mut summary)?;
    let oriented = &prepared.oriented;
    stages.run("writing", 0, |_| -> Result<()> {
        if is_folder {
            let coords = pipeline::file_coordinates(&cloud, &cloud.positions);
            let folder =
                MasbcppFolder { coords: Some(&coords), normals: Some(oriented.normals()), ..MasbcppFolder::default() };
            return Ok(write_masbcpp(output, &folder)?);
        }
        let mut kept = if prepared.kept.len() == cloud.len() { cloud.clone() } else { cloud.select(&prepared.kept) };
        kept.attributes.normals = None;
        let component = |axis: usize| oriented.normals().iter().map(|n| n[axis]).collect::<Vec<f32>>();
        let [x, y, z] = [0, 1, 2].map(component);
        let names = if extension(output) == "las" || extension(output) == "laz" {
            ["NormalX", "NormalY", "NormalZ"]
        } else {
            ["nx", "ny", "nz"]
        };
        let column = |name, description, values| ExtraColumn { name, description, values: ExtraValues::F32(values) };
        let columns = [
            column(names[0], "outward unit normal, east", &x[..]),
            column(names[1], "outward unit normal, north", &y[..]),
            column(names[2], "outward unit normal, up", &z[..]),
            column("quality", "how well the line is known", oriented.quality()),
            column("confidence", "how sure the sign is", oriented.confidence()),
        ];
        write_cloud(output, &kept, &columns)?;
        Ok(())
    })?;
    summary.add("written", output.display().to_string());
    summary.add_seconds(stages.into_seconds());
    Ok(summary)
}
