//! Sums over all planes of roofs.

use super::roofs::RoofIrradiation;
use super::yields::{PlaneYield, performance_ratio};
use crate::roof_planes::RoofPlane;
use belvedere_data::report::rounded;
use serde::Serialize;

/// Energy of all planes together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RoofsReport {
    /// Energy over the period, MWh.
    pub energy_mwh: f64,
    /// Share lost by shading where each panel works for itself, percent.
    pub min_loss_percent: f64,
    /// Share lost by shading where rows of panels are strings, percent.
    pub max_loss_percent: f64,
    /// Area of the cells that this is about, m².
    pub panel_area_m2: f64,
    /// Peak power of their panels, kW.
    pub peak_power_kwp: f64,
    /// Direct current over the period where each panel works for itself, MWh.
    pub dc_mwh: f64,
    /// Alternating current over the period where each panel works for itself, MWh.
    pub ac_mwh: f64,
    /// Alternating current over the period where rows of panels are strings, MWh.
    pub string_ac_mwh: f64,
    /// Alternating current relative to a system that keeps its peak efficiency; `None` without radiation.
    pub performance_ratio: Option<f64>,
}

impl RoofsReport {
    /// Sums over `planes`, each with its energy, by the area of their cells, and its electricity.
    #[must_use]
    pub fn new(planes: &[RoofPlane], energies: &[RoofIrradiation], yields: &[PlaneYield]) -> Self {
        let weighted = |value: &dyn Fn(&RoofIrradiation) -> f64| -> f64 {
            planes.iter().zip(energies).map(|(plane, energy)| energy.panel_area(plane) * value(energy)).sum()
        };
        let unshaded = weighted(&|energy| energy.mean.unshaded).max(f64::MIN_POSITIVE);
        let energy = weighted(&|energy| energy.mean.total());
        let limited = weighted(&|energy| energy.string_limited.total());
        let mut electricity = PlaneYield::default();
        yields.iter().for_each(|own| electricity.add(own));
        let [alone, strings] = [electricity.mean, electricity.string_limited].map(|energy| energy.total());
        let mean_radiation = energy / weighted(&|_| 1.0);
        let ratio = performance_ratio(&electricity.mean, electricity.peak_power, mean_radiation);
        Self {
            energy_mwh: rounded(energy / 1000.0, 2),
            min_loss_percent: rounded(100.0 * (1.0 - energy / unshaded), 2),
            max_loss_percent: rounded(100.0 * (1.0 - limited / unshaded), 2),
            panel_area_m2: rounded(weighted(&|_| 1.0), 1),
            peak_power_kwp: rounded(electricity.peak_power, 2),
            dc_mwh: rounded(alone.dc / 1000.0, 2),
            ac_mwh: rounded(alone.ac / 1000.0, 2),
            string_ac_mwh: rounded(strings.ac / 1000.0, 2),
            performance_ratio: Some(rounded(ratio, 3)).filter(|ratio| ratio.is_finite()),
        }
    }
}
