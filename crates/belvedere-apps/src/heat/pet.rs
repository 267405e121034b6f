//! The Physiological Equivalent Temperature: the temperature of a room in which a body is as warm as outdoors.

use super::body::black_body;
use super::humidity::saturation_pressure;
use super::utci::Air;
use std::f64::consts::TAU;

/// Pressure of the air, hPa: heights change the result by less than a tenth of a degree.
const PRESSURE: f64 = 1013.25;
/// Activity, W, and clothes, clo, in the room; its wind, m/s, and vapour pressure, hPa.
const ROOM_ACTIVITY: f64 = 80.0;
const ROOM_CLOTHES: f64 = 0.9;
const ROOM_WIND: f64 = 0.1;
const ROOM_VAPOUR: f64 = 12.0;
/// Height of the middle of a person, metres, and the exponent of the wind below 10 m, for gardens and suburbs.
const MIDDLE: f64 = 1.1;
const WIND_EXPONENT: f64 = 0.216;
/// Emissivity of skin and of clothes.
const SKIN: f64 = 0.99;
const CLOTHES: f64 = 0.95;
/// Heat of evaporation, J/kg, and of blood, J/(kg K).
const EVAPORATION: f64 = 2.42e6;
const BLOOD: f64 = 3640.0;
/// Conductance of tissue without blood, W/(m² K).
const TISSUE: f64 = 5.28;
/// Temperatures of core and skin at rest, °C.
const CORE_AT_REST: f64 = 36.6;
const SKIN_AT_REST: f64 = 34.0;
/// Evaporation for each K of convection, K/hPa (Lewis), and permeability of clothes (Woodcock).
const LEWIS: f64 = 1.67;
const PERMEABILITY: f64 = 0.38;
/// Bisections of a range of temperatures: to a millionth of a degree.
const HALVINGS: usize = 28;

/// A man.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Person {
    /// Weight, kg.
    pub weight: f64,
    /// Height, m.
    pub height: f64,
    /// Age, years.
    pub age: f64,
    /// Metabolic rate of activity, W.
    pub activity: f64,
    /// Insulation of clothes, clo; more than 0.3.
    pub clothes: f64,
    /// True for a standing man, false for a sitting one.
    pub is_standing: bool,
}

impl Default for Person {
    /// A standing man of 35 years, 75 kg and 1.75 m, lightly active (80 W) in clothes of 0.9 clo: Höppe 1999.
    fn default() -> Self {
        Self { weight: 75.0, height: 1.75, age: 35.0, activity: 80.0, clothes: 0.9, is_standing: true }
    }
}

/// Returns the temperature, °C, for a mean radiant temperature, °C. The wind of `air` is reduced from 10 m to the
/// middle of a person.
///
/// # Source
/// Höppe 1999, The physiological equivalent temperature – a universal index for the biometeorological assessment of the
/// thermal environment; with the corrections of Walther & Goetschel 2018, The P.E.T. comfort index: questioning the
/// model.
#[must_use]
pub fn pet(air: &Air, mean_radiant: f64, person: &Person) -> f64 {
    let wind = air.wind * (MIDDLE / 10.0).powf(WIND_EXPONENT);
    let around = Surroundings { air: air.temperature, radiant: mean_radiant, wind, vapour: air.vapour_pressure };
    pet_in_wind(&around, person)
}

/// What surrounds a person.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings {
    /// Temperature of the air, °C.
    pub(super) air: f64,
    /// Mean radiant temperature, °C.
    pub(super) radiant: f64,
    /// Wind at the person, m/s.
    pub(super) wind: f64,
    /// Vapour pressure, hPa.
    pub(super) vapour: f64,
}

pub(super) fn pet_in_wind(around: &Surroundings, person: &Person) -> f64 {
    let body = Parts::of(person);
    let outdoors = Balance::new(&body, *around);
    let state = outdoors.state();
    let dressed = Parts::of(&Person { activity: ROOM_ACTIVITY, clothes: ROOM_CLOTHES, ..*person });
    root([-100.0, 150.0], |temperature| {
        let room = Surroundings { air: temperature, radiant: temperature, wind: ROOM_WIND, vapour: ROOM_VAPOUR };
        -Balance::new(&dressed, room).of_whole(&state)
    })
}

/// The place in a range where a function that falls is 0; an end of the range where it is nowhere.
fn root(mut range: [f64; 2], falls: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(range[0], range[1]);
        range = if falls(middle) > 0.0 { [middle, range[1]] } else { [range[0], middle] };
    }
    f64::midpoint(range[0], range[1])
}

/// Surfaces of a person in clothes.
struct Parts {
    is_standing: bool,
    /// Metabolic heat, W/m² of skin.
    heat: f64,
    /// Area of clothes as a share of that of the skin.
    clothed: f64,
    /// Share of the skin that clothes cover.
    covered: f64,
    /// Growth of the surface by clothes.
    growth: f64,
    /// Share of the surface that exchanges radiation with the surroundings.
    radiating: f64,
    /// Resistance of clothes, m² K/W.
    resistance: f64,
    /// Conductance of clothes around the body, W/(m² K).
    conductance: f64,
}

impl Parts {
    fn of(person: &Person) -> Self {
        let Person { weight, height, age, activity, clothes, is_standing } = *person;
        // DuBois
        let skin = 0.202 * weight.powf(0.425) * height.powf(0.725);
        let slender = 100.0 * height / weight.cbrt() - 43.4;
        let basal = 3.45 * weight.powf(0.75) * (1.0 + 0.004 * (30.0 - age) + 0.01 * slender);
        let growth = 1.0 + 0.31 * clothes;
        let covered = (173.51 * clothes - 2.36 - 100.76 * clothes.powi(2) + 19.28 * clothes.powi(3)) / 100.0;
        let clothed = covered + growth - 1.0;
        let covered = covered.min(1.0);
        let resistance = clothes / 6.45;
        // clothes as a cylinder around so much of the height
        let share = match clothes {
            clothes if clothes >= 2.0 => 1.0,
            clothes if clothes > 0.6 => (height - 0.2) / height,
            _ => 0.5,
        };
        let length = TAU * height * share;
        let [inner, outer] = [covered, growth - 1.0 + covered].map(|area| area * skin / length);
        let conductance = length * (outer - inner) / (resistance * (outer / inner).ln() * clothed * skin);
        let radiating = if is_standing { 0.696 } else { 0.725 };
        Self {
            is_standing,
            heat: (activity + basal) / skin,
            clothed,
            covered,
            growth,
            radiating,
            resistance,
            conductance,
        }
    }
}

/// Temperatures of a body, °C.
struct State {
    core: f64,
    skin: f64,
    clothes: f64,
}

/// Heat that a body exchanges with its surroundings, W/m² of skin.
struct Balance<'a> {
    body: &'a Parts,
    around: Surroundings,
    /// Convection, W/(m² K).
    convection: f64,
    /// Heat of breathing; below 0 where it is lost.
    breathing: f64,
    /// Radiation of the surroundings, W/m².
    radiation: f64,
}

impl<'a> Balance<'a> {
    fn new(body: &'a Parts, around: Surroundings) -> Self {
        let [still, moving] = if body.is_standing { [2.26, 7.42] } else { [2.67, 6.5] };
        let convection = (still + moving * around.wind.powf(0.67)).max(3.0);
        let exhaled = 0.47 * around.air + 21.0;
        let volume = body.heat * 1.44e-6;
        let sensible = 1010.0 * (around.air - exhaled) * volume;
        let latent = 0.623 * EVAPORATION / PRESSURE * (around.vapour - saturation_pressure(exhaled)) * volume;
        Self { body, around, convection, breathing: sensible + latent, radiation: black_body(around.radiant) }
    }

    /// Flow of heat from core to skin for each K, W/(m² K).
    fn conductance(core: f64, skin: f64) -> f64 {
        (Self::blood(core, skin) / 3600.0).mul_add(BLOOD, TISSUE)
    }

    /// Flow of blood to the skin, kg/(m² h).
    fn blood(core: f64, skin: f64) -> f64 {
        let (warm, cold) = ((core - CORE_AT_REST).max(0.0), (SKIN_AT_REST - skin).max(0.0));
        ((6.3 + 75.0 * warm) / (1.0 + 0.5 * cold)).min(90.0)
    }

    fn radiated(&self, temperature: f64) -> f64 {
        self.radiation - black_body(temperature)
    }

    /// Heat of clothes, without that from the skin.
    fn of_clothes(&self, clothes: f64) -> f64 {
        let radiated = self.body.radiating * CLOTHES * self.radiated(clothes);
        self.body.clothed * (radiated + self.convection * (self.around.air - clothes))
    }

    /// Heat of bare skin, and of evaporation from all of it.
    fn of_skin(&self, core: f64, skin: f64) -> f64 {
        let body = self.body;
        let bare = (1.0 - body.covered)
            * (body.radiating * SKIN * self.radiated(skin) + self.convection * (self.around.air - skin));
        let of_skin = 0.0417737 + 0.7451833 / (Self::blood(core, skin) + 0.585417);
        let excess = of_skin * skin + (1.0 - of_skin) * core - (0.1 * SKIN_AT_REST + 0.9 * CORE_AT_REST);
        // g/(m² h)
        let sweat = (304.94 * excess.max(0.0)).min(500.0);
        let sweating = EVAPORATION / 1000.0 * sweat / 3600.0;
        let drying = saturation_pressure(skin) - self.around.vapour;
        let through_clothes = 1.0 / (1.0 + 0.92 * self.convection * body.resistance);
        let most = self.convection * LEWIS * through_clothes * drying;
        let wet = if most > 0.0 { (sweating / most).min(1.0) } else { 0.0 };
        let evaporated = if most > 0.0 { sweating.min(most) } else { 0.0 };
        let resistance = (1.0 / (body.growth * self.convection) + body.resistance) / (LEWIS * PERMEABILITY);
        bare - (1.0 - wet) * drying / resistance - evaporated
    }

    fn core_of(&self, skin: f64) -> f64 {
        let gained = self.body.heat + self.breathing;
        root([skin, skin + 60.0], |core| gained - Self::conductance(core, skin) * (core - skin))
    }

    fn clothes_of(&self, skin: f64) -> f64 {
        root([-150.0, 200.0], |clothes| self.of_clothes(clothes) + self.body.conductance * (skin - clothes))
    }

    /// The state in which core, skin and clothes gain and lose alike.
    fn state(&self) -> State {
        let skin = root([-60.0, 60.0], |skin| {
            let inner = self.of_skin(self.core_of(skin), skin) + self.body.heat + self.breathing;
            inner - self.body.conductance * (skin - self.clothes_of(skin))
        });
        State { core: self.core_of(skin), skin, clothes: self.clothes_of(skin) }
    }

    /// Heat that a body of this state gains.
    fn of_whole(&self, state: &State) -> f64 {
        let State { core, skin, clothes } = *state;
        self.body.heat + self.breathing + self.of_clothes(clothes) + self.of_skin(core, skin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values_are_reproduced() {
        // pythermalcomfort's tables of Walther & Goetschel: air, radiant, humidity in %, wind, clothes, PET
        let cases = [
            [20.0, 20.0, 50.0, 0.15, 0.5, 18.85],
            [30.0, 30.0, 50.0, 0.15, 0.5, 30.6],
            [20.0, 20.0, 50.0, 0.5, 0.5, 17.16],
            [21.0, 21.0, 50.0, 0.1, 0.9, 21.08],
            [20.0, 20.0, 50.0, 0.1, 0.9, 19.92],
            [-5.0, 40.0, 2.0, 0.5, 0.9, 7.82],
            [-5.0, -5.0, 50.0, 5.0, 0.9, -13.38],
            [30.0, 60.0, 80.0, 1.0, 0.9, 44.63],
            [30.0, 30.0, 80.0, 1.0, 0.9, 32.21],
        ];
        for [air, radiant, humidity, wind, clothes, expected] in cases {
            let vapour = humidity / 100.0 * saturation_pressure(air);
            let person =
                Person { height: 1.8, age: 23.0, activity: 79.734, clothes, is_standing: false, ..Person::default() };
            let found = pet_in_wind(&Surroundings { air, radiant, wind, vapour }, &person);
            assert!((found - expected).abs() <= 0.2, "{air} {radiant} {humidity} {wind}: {found} {expected}");
        }
    }
}
