//! Observers of a total viewshed.

use super::limits::{StandingObserver, ViewLimits};
use super::question::ViewshedQuestion;
use crate::ask::cells::GridCells;
use crate::ask::context::Context;
use crate::ask::places::Places;
use crate::ask::scene::Scene;
use crate::ask::standing::Standing;
use crate::eyes::fault_of;
use belvedere_data::control::Control;
use belvedere_data::{Error, Parameter, Result};

/// Real root of x³ = x + 1.
const PLASTIC_NUMBER: f64 = 1.324_717_957_244_746;
/// Places on cells that are targets, tried for each observer.
const TRIES: usize = 20;
/// Maximum number of places that are tried: seconds.
const MAX_TRIES: usize = 50_000_000;

impl ViewshedQuestion {
    /// `count` observers spread evenly over the map, where somebody can stand: on cells that are targets, and outside
    /// obstacles.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] where fewer can stand, and those of computing the ground.
    ///
    /// # Source
    /// Roberts 2018, The unreasonable effectiveness of quasirandom sequences: R2.
    pub fn spread_observers(
        &self,
        scene: &Scene,
        count: usize,
        control: &Control<'_>,
    ) -> Result<Vec<StandingObserver>> {
        let [height, _] = self.heights();
        let cells = GridCells { cell: self.cell, ground: self.ground, ..GridCells::default() };
        let known = scene.ground(cells.grid(scene)?, self.ground, control)?;
        // the question itself remarks on its cells
        let targets = Places::Cells(cells).targets(scene, &mut Context::default(), control)?;
        let grid = known.ground.grid;
        let is_target = |[column, row]: [usize; 2]| targets.is_target(row * grid.width + column);
        let cells_of_target = grid.width * grid.height / targets.target_count().max(1) + 1;
        let tries = count.saturating_mul(TRIES).saturating_mul(cells_of_target).min(MAX_TRIES);
        let blockers = scene.blockers(self.unproven(), control)?;
        let (low, high) = scene.model().bounds().on_map();
        let place = |number: usize| {
            let share = |power: i32| (0.5 + number as f64 / PLASTIC_NUMBER.powi(power)).fract();
            let along = |axis: usize, share: f64| low[axis] + share * (high[axis] - low[axis]);
            let [x, y] = [along(0, share(1)), along(1, share(2))];
            grid.cell_of([x, y]).filter(|&cell| is_target(cell))?;
            let place = [x, y, known.ground.height_at([x, y])? + height];
            fault_of(&blockers, Some(&known.ground), place).is_none().then_some(place)
        };
        let standing =
            |place| StandingObserver { standing: Standing { place, height: None }, limits: ViewLimits::default() };
        let found: Vec<StandingObserver> = (1..=tries).filter_map(place).take(count).map(standing).collect();
        if found.len() < count {
            return Err(Error::invalid(
                Parameter::ObserverCount,
                format!("{count}, of which {} found open ground", found.len()),
                "fewer, or of a cloud with more open ground",
            ));
        }
        Ok(found)
    }
}
