//! Columns of the planes of roofs and their energy.

use super::measures::MONTH_COLUMNS;
use super::roofs::RoofIrradiation;
use crate::roof_planes::RoofPlane;
use crate::sun::Site;
use belvedere_data::Frame;

/// A column of a table of roof planes.
#[derive(Clone, Debug, PartialEq)]
pub struct RoofColumn {
    /// Its name, with the unit.
    pub name: &'static str,
    /// A value for each plane.
    pub values: Vec<f64>,
    /// Decimals that say something.
    pub decimals: usize,
}

/// Returns the columns of `planes` and their energies, `rows`. They are the middle in the coordinates and unit of the
/// file of `frame`, areas, tilt, azimuth from true north (NaN for level planes), energy, losses, and months if the
/// energies have them.
#[must_use]
pub fn roof_columns(planes: &[RoofPlane], rows: &[RoofIrradiation], frame: &Frame, site: &Site) -> Vec<RoofColumn> {
    let of_planes = |value: &dyn Fn(&RoofPlane) -> f64| -> Vec<f64> { planes.iter().map(value).collect() };
    let of_rows = |value: &dyn Fn(&RoofIrradiation) -> f64| -> Vec<f64> { rows.iter().map(value).collect() };
    let of_both = |value: &dyn Fn(&RoofPlane, &RoofIrradiation) -> f64| -> Vec<f64> {
        planes.iter().zip(rows).map(|(plane, row)| value(plane, row)).collect()
    };
    let scale = frame.crs.metres_per_unit_xyz();
    let middle = |axis: usize| of_planes(&|plane| (plane.middle[axis] + frame.origin[axis]) / scale[axis]);
    let from_north = |azimuth: f64| (azimuth + site.convergence).to_degrees().rem_euclid(360.0);
    let azimuth = |plane: &RoofPlane| plane.azimuth().map_or(f64::NAN, from_north);
    let column = |name, values, decimals| RoofColumn { name, values, decimals };
    let mut columns = vec![
        column("x", middle(0), 3),
        column("y", middle(1), 3),
        column("z", middle(2), 3),
        column("area_m2", of_planes(&|plane| plane.area), 2),
        column("panel_area_m2", of_both(&|plane, row| row.panel_area(plane)), 2),
        column("tilt_deg", of_planes(&|plane| plane.tilt().to_degrees()), 2),
        column("azimuth_deg", of_planes(&azimuth), 2),
        column("roughness_m", of_planes(&|plane| plane.roughness), 3),
        column("kwh_m2", of_rows(&|row| row.mean.total()), 1),
        column("beam_kwh_m2", of_rows(&|row| row.mean.beam), 1),
        column("sky_kwh_m2", of_rows(&|row| row.mean.diffuse), 1),
        column("ground_kwh_m2", of_rows(&|row| row.mean.reflected), 1),
        column("free_kwh_m2", of_rows(&|row| row.mean.unshaded), 1),
        column("min_loss", of_rows(&|row| row.mean.loss()), 4),
        column("max_loss", of_rows(&RoofIrradiation::greatest_loss), 4),
        column("kwh", of_both(&|plane, row| row.panel_area(plane) * row.mean.total()), 0),
    ];
    if rows.iter().any(|row| row.class.is_some()) {
        let end = |number: usize| of_rows(&|row| row.expected()[number]);
        // much energy is little loss
        let loss =
            |number: usize| of_rows(&|row| 1.0 - row.expected()[number] / row.mean.unshaded.max(f64::MIN_POSITIVE));
        columns.extend([
            column("kwh_m2_expected", end(0), 1),
            column("kwh_m2_low", end(1), 1),
            column("kwh_m2_high", end(2), 1),
            column("loss_expected", loss(0), 4),
            column("loss_low", loss(2), 4),
            column("loss_high", loss(1), 4),
        ]);
    }
    if rows.iter().all(|row| row.groups.len() > 1) {
        columns.extend(
            MONTH_COLUMNS.into_iter().enumerate().map(|(month, name)| {
                column(name, of_rows(&|row| row.groups.get(month).copied().unwrap_or(f64::NAN)), 2)
            }),
        );
    }
    columns
}
