//! Lines of sight as a table.

use super::line_of_sight::{SightColumns, SightsResults};
use super::scene::Scene;
use crate::targets::Measure;
use belvedere_data::result_columns::ResultColumn;
use belvedere_data::vector::{length, sub};

/// Names of the coordinates of observers and targets.
const ENDS: [&str; 6] = ["ax", "ay", "az", "bx", "by", "bz"];

impl SightsResults {
    /// Returns a row for each line: its ends in the coordinates of the file, its length, the answer, and its first
    /// obstacle.
    #[must_use]
    pub fn table(&self, scene: &Scene) -> Vec<ResultColumn> {
        let frame = scene.frame();
        let end =
            |column: usize| self.pairs.iter().map(move |pair| frame.file_from_local(pair[column / 3])[column % 3]);
        let columns_of_lines = self.columns(scene);
        let SightColumns { ranges, unproven, fresnel_free_percent, places, balls, sources, .. } = columns_of_lines;
        let SightColumns { meshes, surfaces, is_terrain, .. } = columns_of_lines;
        let mut columns = Vec::new();
        if let Some(network) = &self.network {
            let names = |end: usize| network.pairs.iter().map(move |pair| &network.names[pair[end]]);
            columns.extend([ResultColumn::words("a", names(0)), ResultColumn::words("b", names(1))]);
        }
        columns.extend(ENDS.iter().enumerate().map(|(column, name)| ResultColumn::real(*name, end(column), 4)));
        columns.push(ResultColumn::real("length_m", self.pairs.iter().map(|&[a, b]| length(sub(b, a))), 3));
        columns.push(ResultColumn::whole("answer", self.answers.iter().map(|&answer| usize::from(answer as u8))));
        columns.extend(self.sure.iter().map(Measure::to_column));
        columns.push(ResultColumn::real("first_block_range_m", ranges, 3));
        columns.extend(unproven.map(|lengths| ResultColumn::real("unproven_m", lengths, 3)));
        columns.extend(fresnel_free_percent.map(|free| ResultColumn::real("fresnel_free_percent", free, 1)));
        columns.extend(
            ["block_x", "block_y", "block_z"]
                .into_iter()
                .enumerate()
                .map(|(axis, name)| ResultColumn::real(name, places.iter().map(|place| place[axis]), 3)),
        );
        columns.push(ResultColumn::whole("block_ball", balls));
        let rows = sources.into_iter().map(|source| source.map(|row| row as usize));
        columns.push(ResultColumn::whole("block_source", rows));
        columns.extend(meshes.map(|names| ResultColumn::words("block_mesh", names)));
        columns.extend(surfaces.map(|names| ResultColumn::words("block_surface", names)));
        columns.extend(is_terrain.map(|all| {
            ResultColumn::whole("block_terrain", all.into_iter().map(|is_terrain| is_terrain.map(usize::from)))
        }));
        columns
    }
}
