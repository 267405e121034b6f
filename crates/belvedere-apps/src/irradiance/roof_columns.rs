//! Columns of the planes of roofs and of buildings: their radiation and their electricity.

use super::measures::MONTH_COLUMNS;
use super::roofs::RoofIrradiation;
use super::yields::{PlaneYield, PvEnergy, performance_ratio};
use crate::result_columns::{ResultColumn, ResultValues};
use crate::roof_planes::{Buildings, RoofPlane};
use crate::sun::Site;
use belvedere_data::Frame;

/// Planes of roofs with all that is known of each.
#[derive(Clone, Copy, Debug)]
pub struct RoofRows<'a> {
    /// The planes.
    pub planes: &'a [RoofPlane],
    /// The building of each.
    pub buildings: &'a Buildings,
    /// The energy of each.
    pub energies: &'a [RoofIrradiation],
    /// The electricity of each.
    pub yields: &'a [PlaneYield],
    /// Source of the radiation.
    pub radiation: &'a str,
}

/// Returns the column of building numbers, and of names where they have some.
fn building_numbers(numbers: Vec<Option<u64>>, names: &[String]) -> Vec<ResultColumn> {
    let name = |number: &Option<u64>| {
        let at = number.and_then(|number| usize::try_from(number).ok()?.checked_sub(1));
        at.and_then(|at| names.get(at)).cloned().unwrap_or_default()
    };
    let named = (!names.is_empty()).then(|| ResultColumn::words("building_name", numbers.iter().map(name)));
    let number = ResultColumn { name: "building".to_owned(), values: ResultValues::Whole(numbers) };
    std::iter::once(number).chain(named).collect()
}

/// Returns the columns of peak power and electricity, `kwh_m2` being the radiation on the panels of each row. Columns
/// that begin with `string_` hold if rows of panels are strings, the others if each panel works for itself.
fn yield_columns(yields: &[PlaneYield], kwh_m2: &[f64]) -> Vec<ResultColumn> {
    let of_yields = |value: &dyn Fn(&PlaneYield) -> f64| -> Vec<f64> { yields.iter().map(value).collect() };
    let ratio = |(own, kwh_m2): (&PlaneYield, &f64)| performance_ratio(&own.mean, own.peak_power, *kwh_m2);
    vec![
        ResultColumn::real("kwp", of_yields(&|own| own.peak_power), 2),
        ResultColumn::real("dc_kwh", of_yields(&|own| own.mean.total().dc), 0),
        ResultColumn::real("ac_kwh", of_yields(&|own| own.mean.total().ac), 0),
        ResultColumn::real("string_dc_kwh", of_yields(&|own| own.string_limited.total().dc), 0),
        ResultColumn::real("string_ac_kwh", of_yields(&|own| own.string_limited.total().ac), 0),
        ResultColumn::real("kwh_per_kwp", of_yields(&|own| own.mean.total().ac / own.peak_power), 1),
        ResultColumn::real("string_kwh_per_kwp", of_yields(&|own| own.string_limited.total().ac / own.peak_power), 1),
        ResultColumn::real("performance_ratio", yields.iter().zip(kwh_m2).map(ratio), 3),
    ]
}

/// Returns the columns of the electricity of each month.
fn yield_months(yields: &[PlaneYield]) -> Vec<ResultColumn> {
    let of_month = |name: &str, month: usize, energy: fn(&PlaneYield) -> &PvEnergy| {
        ResultColumn::real(format!("{name}_{:02}", month + 1), yields.iter().map(|own| energy(own).ac[month]), 1)
    };
    let alone = (0..12).map(|month| of_month("ac_kwh", month, |own| &own.mean));
    alone.chain((0..12).map(|month| of_month("string_ac_kwh", month, |own| &own.string_limited))).collect()
}

/// Returns the columns of `roofs`. They are the building, the middle in the coordinates and unit of the file of
/// `frame`, areas, tilt, azimuth from true north (NaN for level planes), radiation, losses, electricity, and months if
/// the energies have them.
#[must_use]
pub fn roof_columns(roofs: RoofRows<'_>, frame: &Frame, site: &Site) -> Vec<ResultColumn> {
    let RoofRows { planes, buildings, energies: rows, yields, radiation } = roofs;
    let of_planes = |value: &dyn Fn(&RoofPlane) -> f64| -> Vec<f64> { planes.iter().map(value).collect() };
    let of_rows = |value: &dyn Fn(&RoofIrradiation) -> f64| -> Vec<f64> { rows.iter().map(value).collect() };
    let of_both = |value: &dyn Fn(&RoofPlane, &RoofIrradiation) -> f64| -> Vec<f64> {
        planes.iter().zip(rows).map(|(plane, row)| value(plane, row)).collect()
    };
    let scale = frame.crs.metres_per_unit_xyz();
    let middle = |axis: usize| of_planes(&|plane| (plane.middle[axis] + frame.origin[axis]) / scale[axis]);
    let from_north = |azimuth: f64| (azimuth + site.convergence).to_degrees().rem_euclid(360.0);
    let azimuth = |plane: &RoofPlane| plane.azimuth().map_or(f64::NAN, from_north);
    let kwh_m2 = of_rows(&|row| row.mean.total());
    let mut columns = building_numbers(buildings.of_plane.clone(), &buildings.names);
    columns.extend([
        ResultColumn::whole("cells", rows.iter().map(|row| row.cell_count)),
        ResultColumn::real("x", middle(0), 3),
        ResultColumn::real("y", middle(1), 3),
        ResultColumn::real("z", middle(2), 3),
        ResultColumn::real("area_m2", of_planes(&|plane| plane.area), 2),
        ResultColumn::real("panel_area_m2", of_both(&|plane, row| row.panel_area(plane)), 2),
        ResultColumn::real("tilt_deg", of_planes(&|plane| plane.tilt().to_degrees()), 2),
        ResultColumn::real("azimuth_deg", of_planes(&azimuth), 2),
        ResultColumn::real("roughness_m", of_planes(&|plane| plane.roughness), 3),
        ResultColumn::words("radiation", std::iter::repeat_n(radiation, planes.len())),
        ResultColumn::real("kwh_m2", kwh_m2.clone(), 1),
        ResultColumn::real("beam_kwh_m2", of_rows(&|row| row.mean.beam), 1),
        ResultColumn::real("sky_kwh_m2", of_rows(&|row| row.mean.diffuse), 1),
        ResultColumn::real("ground_kwh_m2", of_rows(&|row| row.mean.reflected), 1),
        ResultColumn::real("free_kwh_m2", of_rows(&|row| row.mean.unshaded), 1),
        ResultColumn::real("min_loss", of_rows(&|row| row.mean.loss()), 4),
        ResultColumn::real("max_loss", of_rows(&RoofIrradiation::greatest_loss), 4),
        ResultColumn::real("radiation_kwh", of_both(&|plane, row| row.panel_area(plane) * row.mean.total()), 0),
    ]);
    columns.extend(yield_columns(yields, &kwh_m2));
    if rows.iter().any(|row| row.class.is_some()) {
        let end = |number: usize| of_rows(&|row| row.expected()[number]);
        // much energy is little loss
        let loss =
            |number: usize| of_rows(&|row| 1.0 - row.expected()[number] / row.mean.unshaded.max(f64::MIN_POSITIVE));
        columns.extend([
            ResultColumn::real("kwh_m2_expected", end(0), 1),
            ResultColumn::real("kwh_m2_low", end(1), 1),
            ResultColumn::real("kwh_m2_high", end(2), 1),
            ResultColumn::real("loss_expected", loss(0), 4),
            ResultColumn::real("loss_low", loss(2), 4),
            ResultColumn::real("loss_high", loss(1), 4),
        ]);
    }
    if has_months(rows) {
        columns.extend(MONTH_COLUMNS.into_iter().enumerate().map(|(month, name)| {
            ResultColumn::real(name, of_rows(&|row| row.groups.get(month).copied().unwrap_or(f64::NAN)), 2)
        }));
        columns.extend(yield_months(yields));
    }
    columns
}

/// Returns true if energies are known month by month.
fn has_months(rows: &[RoofIrradiation]) -> bool {
    rows.iter().all(|row| row.groups.len() > 1)
}

/// Returns the sums of `roofs` over each building that has some, by number: planes, areas, radiation, electricity, and
/// months if the energies have them. Planes of no building are left out.
#[must_use]
pub fn building_columns(roofs: RoofRows<'_>) -> Vec<ResultColumn> {
    let RoofRows { planes, buildings, energies, yields, radiation } = roofs;
    let mut numbers: Vec<u64> = buildings.of_plane.iter().copied().flatten().collect();
    numbers.sort_unstable();
    numbers.dedup();
    let row_of = |plane: usize| numbers.binary_search(&buildings.of_plane.get(plane).copied().flatten()?).ok();
    let sum = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let mut sums = vec![0.0; numbers.len()];
        (0..planes.len()).for_each(|plane| row_of(plane).into_iter().for_each(|row| sums[row] += value(plane)));
        sums
    };
    let mut electricity = vec![PlaneYield::default(); numbers.len()];
    for (plane, own) in yields.iter().enumerate() {
        row_of(plane).into_iter().for_each(|row| electricity[row].add(own));
    }
    let panel_area = sum(&|plane| energies[plane].panel_area(&planes[plane]));
    let radiation_kwh = sum(&|plane| energies[plane].panel_area(&planes[plane]) * energies[plane].mean.total());
    let kwh_m2: Vec<f64> = radiation_kwh.iter().zip(&panel_area).map(|(sum, area)| sum / area).collect();
    let mut columns = building_numbers(numbers.iter().copied().map(Some).collect(), &buildings.names);
    columns.extend([
        ResultColumn::real("planes", sum(&|_| 1.0), 0),
        ResultColumn::real("area_m2", sum(&|plane| planes[plane].area), 2),
        ResultColumn::real("panel_area_m2", panel_area, 2),
        ResultColumn::words("radiation", std::iter::repeat_n(radiation, numbers.len())),
        ResultColumn::real("radiation_kwh", radiation_kwh, 0),
    ]);
    columns.extend(yield_columns(&electricity, &kwh_m2));
    if has_months(energies) {
        columns.extend(yield_months(&electricity));
    }
    columns
}
