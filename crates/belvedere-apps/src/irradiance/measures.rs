//! Energies of targets as measures.

use super::irradiation::Irradiation;
use crate::targets::Measure;
use belvedere_data::vector::to_f32;

/// Columns of the months, January first.
pub const MONTH_COLUMNS: [&str; 12] = [
    "kwh_m2_01",
    "kwh_m2_02",
    "kwh_m2_03",
    "kwh_m2_04",
    "kwh_m2_05",
    "kwh_m2_06",
    "kwh_m2_07",
    "kwh_m2_08",
    "kwh_m2_09",
    "kwh_m2_10",
    "kwh_m2_11",
    "kwh_m2_12",
];
/// Description of a raster of energies.
pub const ENERGY: &str = "energy of the period, kWh/m2";
/// Name of its column and its band.
pub const ENERGY_NAME: &str = "kwh_m2";
/// Digits of energies, kWh/m², and of shares.
const ENERGY_DECIMALS: usize = 2;
const SHARE_DECIMALS: usize = 4;

/// Returns the energies of targets as measures: the whole, the share lost, the parts, the energy of an open plane, and
/// the months if groups are months. `sums` has rows of `group_count` sums.
#[must_use]
pub fn irradiation_measures(sums: &[Irradiation], group_count: usize) -> Vec<Measure> {
    let group_count = group_count.max(1);
    let whole: Vec<Irradiation> = sums.chunks(group_count).map(Irradiation::sum).collect();
    let column =
        |value: &dyn Fn(&Irradiation) -> f64| -> Vec<f32> { whole.iter().map(|sum| to_f32(value(sum))).collect() };
    let energy = |name: &str, description, values| {
        Measure::new(name, values).with_description(description).with_unit("kWh/m2").with_decimals(ENERGY_DECIMALS)
    };
    let loss = Measure::new("loss", column(&Irradiation::loss)).with_description("share lost by shading");
    let mut measures = vec![
        energy(ENERGY_NAME, ENERGY, column(&Irradiation::total)),
        loss.with_decimals(SHARE_DECIMALS).with_range(Some([0.0, 1.0])),
        energy("beam_kwh_m2", "direct, from the sun, kWh/m2", column(&|sum| sum.beam)),
        energy("sky_kwh_m2", "diffuse, from the sky, kWh/m2", column(&|sum| sum.diffuse)),
        energy("ground_kwh_m2", "reflected, kWh/m2", column(&|sum| sum.reflected)),
        energy("free_kwh_m2", "without obstacles, kWh/m2", column(&|sum| sum.unshaded)),
    ];
    if group_count == MONTH_COLUMNS.len() {
        for (month, name) in MONTH_COLUMNS.into_iter().enumerate() {
            let values = sums.iter().skip(month).step_by(group_count).map(|sum| to_f32(sum.total())).collect();
            measures.push(energy(name, "energy of a month, kWh/m2", values));
        }
    }
    measures
}
