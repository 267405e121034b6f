//! Electricity of solar panels from the radiation on them, by the formulas of PVWatts.

use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Radiation at which panels have their peak power, W/m².
pub(super) const REFERENCE_RADIATION: f64 = 1000.0;
/// Temperature of the cells at which panels have their peak power, °C.
const REFERENCE_TEMPERATURE: f64 = 25.0;
/// Efficiency of the inverter whose curve PVWatts scales: Dobos 2014, equation 11.
const REFERENCE_INVERTER: f64 = 0.9637;
/// Glass and glass on a roof close below: exponents of still air and of wind, and how much warmer than their back cells
/// are at 1000 W/m², °C. King et al. 2004, table 1.
const CLOSE_MOUNT: [f64; 3] = [-2.98, -0.0471, 1.0];
/// Refractive index of the cover of a panel, its extinction, per metre, and its thickness, metres: De Soto et al. 2006.
const COVER: [f64; 3] = [1.526, 4.0, 0.002];

/// A photovoltaic system.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[non_exhaustive]
pub struct PvSystem {
    /// Peak power of a square metre of panels, kW/m², above 0 to 0.5. Default 0.2: common panels of 20 % efficiency.
    pub module_efficiency: f64,
    /// Change of the power with the temperature of the cells, share per °C, -0.01 to 0. Default -0.0037: PVWatts 8.
    pub temperature_coefficient: f64,
    /// Share of the direct current lost by dirt, wires, mismatch and the like, 0 to below 1. Default 0.1142: PVWatts'
    /// 14.08 % without its 3 % of shading, which is computed.
    pub system_losses: f64,
    /// Nominal efficiency of the inverter, above 0 to 1. Default 0.96: PVWatts.
    pub inverter_efficiency: f64,
    /// Peak power of the panels for each power of the inverter, 0.5 to 3. Default 1.2: PVWatts 8.
    pub dc_ac_ratio: f64,
}

belvedere_data::setters!(PvSystem {
    with_module_efficiency(module_efficiency: f64),
    with_temperature_coefficient(temperature_coefficient: f64),
    with_system_losses(system_losses: f64),
    with_inverter_efficiency(inverter_efficiency: f64),
    with_dc_ac_ratio(dc_ac_ratio: f64),
});

impl Default for PvSystem {
    fn default() -> Self {
        Self {
            module_efficiency: 0.2,
            temperature_coefficient: -0.0037,
            system_losses: 0.1142,
            inverter_efficiency: 0.96,
            dc_ac_ratio: 1.2,
        }
    }
}

/// Power of a system, as a share of its peak power.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PvPower {
    /// Direct current, after the losses of the system.
    pub dc: f64,
    /// Alternating current.
    pub ac: f64,
}

impl PvSystem {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`Error::InvalidParameter`] for one outside its range.
    pub fn validate(&self) -> Result<()> {
        let Self { module_efficiency, temperature_coefficient, system_losses, inverter_efficiency, dc_ac_ratio } =
            *self;
        for (is_usable, parameter, value, expected) in [
            (
                module_efficiency > 0.0 && module_efficiency <= 0.5,
                Parameter::ModuleEfficiency,
                module_efficiency,
                "a share above 0 to 0.5",
            ),
            (
                (-0.01..=0.0).contains(&temperature_coefficient),
                Parameter::TemperatureCoefficient,
                temperature_coefficient,
                "-0.01 to 0 per °C; -0.37 % per °C of a data sheet is -0.0037",
            ),
            (
                (0.0..1.0).contains(&system_losses),
                Parameter::SystemLosses,
                system_losses,
                "a share, 0 to below 1; 14 % is 0.14",
            ),
            (
                inverter_efficiency > 0.0 && inverter_efficiency <= 1.0,
                Parameter::InverterEfficiency,
                inverter_efficiency,
                "a share above 0 to 1",
            ),
            ((0.5..=3.0).contains(&dc_ac_ratio), Parameter::DcAcRatio, dc_ac_ratio, "0.5 to 3"),
        ] {
            if !is_usable {
                return Err(Error::invalid(parameter, value, expected));
            }
        }
        Ok(())
    }

    /// Returns the power under `radiation` that reaches the cells, W/m², at a temperature of the cells, °C.
    ///
    /// # Source
    /// Dobos 2014, PVWatts Version 5 Manual, equations 8 to 13.
    #[must_use]
    pub fn power(&self, radiation: f64, cell_temperature: f64) -> PvPower {
        let dc = dc_power(radiation, cell_temperature, 1.0, self.temperature_coefficient) * (1.0 - self.system_losses);
        PvPower { dc, ac: ac_power(dc, 1.0 / self.dc_ac_ratio, self.inverter_efficiency) }
    }
}

/// Power of panels with a `peak` power under `radiation`, W/m², in the unit of the peak; `gamma` is its change per °C.
fn dc_power(radiation: f64, cell_temperature: f64, peak: f64, gamma: f64) -> f64 {
    (radiation / REFERENCE_RADIATION * peak * (1.0 + gamma * (cell_temperature - REFERENCE_TEMPERATURE))).max(0.0)
}

/// Power that an inverter of so much `rated` power makes of `dc`, all in one unit.
fn ac_power(dc: f64, rated: f64, nominal_efficiency: f64) -> f64 {
    let load = dc * nominal_efficiency / rated;
    if load <= 0.0 {
        return 0.0;
    }
    let efficiency = nominal_efficiency / REFERENCE_INVERTER * (-0.0162 * load - 0.0059 / load + 0.9858);
    (efficiency * dc).clamp(0.0, rated)
}

/// Temperature of the cells of panels close to a roof, °C, under `radiation`, W/m², in air of a `temperature`, °C, and
/// `wind` 10 m above the ground, m/s.
///
/// # Source
/// King, Boyson & Kratochvil 2004, Photovoltaic array performance model, equations 11 and 12.
#[must_use]
pub fn cell_temperature(radiation: f64, temperature: f64, wind: f64) -> f64 {
    let [still, of_wind, in_front] = CLOSE_MOUNT;
    let back = radiation * (still + of_wind * wind).exp() + temperature;
    back + radiation / REFERENCE_RADIATION * in_front
}

/// Share of direct radiation that passes the cover of a panel, relative to the same from straight ahead. `cosine` is
/// that of the angle between sun and normal; 0 from behind.
///
/// # Source
/// De Soto, Klein & Beckman 2006, Improvement and validation of a model for photovoltaic array performance, equations
/// 12 to 14.
#[must_use]
pub fn cover_transmission(cosine: f64) -> f64 {
    if cosine <= 0.0 {
        return 0.0;
    }
    let [index, extinction, thickness] = COVER;
    let passed = |cosine: f64| {
        let (reflected, refracted_cosine) = reflected_share(cosine, index);
        (-extinction * thickness / refracted_cosine).exp() * (1.0 - reflected)
    };
    passed(cosine.min(1.0)) / passed(1.0)
}

/// Share of sunlight that the surface of a panel or a window reflects, 0 to 1. `cosine` is that of the angle between
/// sun and normal, above 0.
///
/// # Source
/// Fresnel's formulas for unpolarised light on glass with a refractive index of 1.526 (De Soto, Klein & Beckman 2006).
#[must_use]
pub fn glass_reflectance(cosine: f64) -> f64 {
    reflected_share(cosine.clamp(0.0, 1.0), COVER[0]).0
}

/// Share of unpolarised light that a surface reflects, and the cosine of the angle of the rest to the normal.
fn reflected_share(cosine: f64, index: f64) -> (f64, f64) {
    let refracted_cosine = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    // light that swings across and along the plane of incidence
    let across = (cosine - index * refracted_cosine) / (cosine + index * refracted_cosine);
    let along = (index * cosine - refracted_cosine) / (index * cosine + refracted_cosine);
    (0.5 * (across * across + along * along), refracted_cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_give_the_values_of_pvlib() {
        // pvlib 0.16.1: pvwatts_dc, inverter.pvwatts, sapm_cell and iam.physical
        assert!((dc_power(800.0, 45.0, 5.0, -0.0037) - 3.7040).abs() < 5e-5);
        assert!((ac_power(4.0, 5.0, 0.96) - 3.84787).abs() < 5e-6);
        assert!((cell_temperature(800.0, 25.0, 2.0) - 62.781).abs() < 5e-4);
        let at = |angle_deg: f64| cover_transmission(angle_deg.to_radians().cos());
        assert!((at(60.0) - 0.94600).abs() < 5e-6, "{}", at(60.0));
        // of glass in air (index 1.526): (0.526 / 2.526)² straight ahead, all of it at a glance
        assert!((glass_reflectance(1.0) - 0.043_362).abs() < 1e-6 && (glass_reflectance(0.0) - 1.0).abs() < 1e-12);
        assert!((at(0.0) - 1.0).abs() < 1e-12 && at(90.0) < 1e-9 && at(120.0) == 0.0);
    }

    #[test]
    fn an_inverter_gives_its_own_power_at_most_and_nothing_at_night() {
        let system = PvSystem::default();
        assert_eq!(system.power(1400.0, 0.0).ac, 1.0 / 1.2);
        assert_eq!(system.power(0.0, 10.0), PvPower::default());
        // below six thousandths of its power an inverter takes more than it gets
        assert_eq!(system.power(2.0, 10.0).ac, 0.0);
        let power = system.power(600.0, 40.0);
        assert!(power.ac < power.dc && power.ac > 0.94 * power.dc);
    }

    #[test]
    fn systems_outside_their_range_are_refused_by_name() {
        let usual = PvSystem::default();
        assert!(usual.validate().is_ok());
        for (system, parameter) in [
            (usual.with_module_efficiency(20.0), Parameter::ModuleEfficiency),
            (usual.with_temperature_coefficient(0.37), Parameter::TemperatureCoefficient),
            (usual.with_system_losses(14.0), Parameter::SystemLosses),
            (usual.with_inverter_efficiency(f64::NAN), Parameter::InverterEfficiency),
            (usual.with_dc_ac_ratio(0.0), Parameter::DcAcRatio),
        ] {
            let Err(Error::InvalidParameter { parameter: found, .. }) = system.validate() else {
                panic!("{system:?} is accepted");
            };
            assert_eq!(found, parameter);
        }
    }
}
