//! Heights of single places without one.

use super::cells::cells_of;
use super::context::Context;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{HeightFrom, PlaceSection};
use super::standing::Standing;
use crate::targets::{CellLevel, CellParams, Targets, grid_around, set_on_terrain};
use belvedere_core::ground::{Ground, GroundPoints};
use belvedere_data::Result;
use belvedere_data::cast::to_f32s;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;

/// Local metres of `places`. One without a height lies above the ground, or above what covers the ground there.
pub(super) fn positions(
    places: &[Standing],
    points: GroundPoints,
    scene: &Scene,
    context: &mut Context,
    control: &Control<'_>,
) -> Result<Vec<[f32; 3]>> {
    let mut positions: Vec<[f64; 3]> = places.iter().map(|place| place.place).collect();
    let mut sources = vec![HeightFrom::Given; places.len()];
    let coverage = scene.model().coverage();
    // ground is made where there are points: one place far away would make its cells large for all
    let is_over = |place: &[f64; 3]| coverage.is_none_or(|coverage| coverage.holds_on_map(*place));
    if let Some(grid) = grid_around(positions.iter().copied().filter(is_over), scene.frame().origin)? {
        let known = scene.ground(grid, points, control)?;
        context.ground(scene.frame(), &known);
        let usual = CellParams::default().with_height(0.0);
        // what cells leave out is no matter of single places
        let cells = |level| {
            let params = usual.with_level(level);
            cells_of(scene, known.ground.clone(), &params, &mut Context::default(), control)
        };
        let open = cells(CellLevel::Ground)?;
        let mut covers: Option<Targets> = None;
        for ((position, source), place) in positions.iter_mut().zip(&mut sources).zip(places) {
            if !position[2].is_nan() || !is_over(position) {
                continue;
            }
            let above = place.height.unwrap_or(CellParams::default().height);
            let on_map = [position[0], position[1]];
            if height_of_cell(&open, &known.ground, on_map).is_some() {
                *source = HeightFrom::Ground;
                position[2] = known.ground.height_at(on_map).unwrap_or(f64::NAN) + above;
                continue;
            }
            *source = HeightFrom::Cover;
            let covers = match &mut covers {
                Some(covers) => covers,
                none => none.insert(cells(CellLevel::Surface)?),
            };
            position[2] = height_of_cell(covers, &known.ground, on_map).map_or(f64::NAN, |height| height + above);
        }
    }
    let usual = CellParams::default().height;
    for ((position, source), place) in positions.iter_mut().zip(&mut sources).zip(places) {
        if position[2].is_nan() && !is_over(position) {
            *source = HeightFrom::Ground;
            set_on_terrain([(position, place.height.unwrap_or(usual))], scene.model());
        }
    }
    let unknown = positions.iter().filter(|position| position[2].is_nan()).count();
    context.add(Remark::of_share(
        "places-without-ground",
        unknown,
        positions.len(),
        "places",
        "have neither ground nor a roof below that is known: give their height as a third coordinate",
    ));
    let in_file = |position: &[f64; 3]| scene.frame().file_from_local(*position).map(|v| rounded(v, 3));
    context.report.at = positions
        .iter()
        .zip(sources)
        .map(|(position, height_from)| PlaceSection { position: in_file(position), height_from })
        .collect();
    Ok(positions.iter().map(|position| to_f32s(*position)).collect())
}

/// Height of the cell at a position on the map; `None` for one that is no target.
fn height_of_cell(cells: &Targets, ground: &Ground, on_map: [f64; 2]) -> Option<f64> {
    let [column, row] = ground.grid.cell_of(on_map)?;
    let height = f64::from(cells.positions.get(row * ground.grid.width + column)?[2]);
    height.is_finite().then_some(height)
}
