//! The hours of the planes of roofs as files.

use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::RoofsResults;
use belvedere::apps::irradiance::sky_loss_percent;
use belvedere::apps::result_columns::ResultColumn;
use belvedere::io::{atomic, write_table};
use std::path::Path;

/// Column of an hour that the time series of SAM hold.
const FOR_SAM: &str = "beam_loss_percent";

/// Writes two tables for each plane: all that is known of each row, and the loss of direct radiation alone under a
/// single line, as SAM reads it.
pub(super) fn write(folder: &Path, roofs: &RoofsResults, run: &CommandContext) -> Result<()> {
    atomic::make_folder(folder)?;
    run.stage("writing hours", roofs.planes.len(), |control| {
        for number in 1..=roofs.planes.len() {
            control.check()?;
            let (hours, columns) = roofs.hours(number - 1)?;
            write_table(folder.join(format!("plane_{number}.csv")).as_path(), &columns)?;
            let losses = columns.into_iter().filter(|column| column.name == FOR_SAM).map(|column| ResultColumn {
                name: format!(
                    "beam shading loss of plane {number} in percent (sky diffuse {:.2} percent)",
                    sky_loss_percent(&hours)
                ),
                ..column
            });
            let losses: Vec<ResultColumn> = losses.collect();
            write_table(folder.join(format!("plane_{number}_beam_loss.csv")).as_path(), &losses)?;
            control.advance(1);
        }
        Ok(())
    })
}
