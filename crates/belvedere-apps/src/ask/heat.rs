//! Heat: radiant temperature and thermal stress of people at places, over the hours of days of weather.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{HeatSection, MeasuresSection, PlacesReport};
use super::seen_kinds::kinds_of_balls;
use super::sun::{Days, missing_days, moment};
use super::sun_and_sky::{Light, OnTargets};
use super::sun_place::{SunPlace, remark_on_solar_hours};
use super::trees::{ThroughTrees, remark_on_leaves};
use super::weather::{remark_on_place_of, remark_on_wind};
use crate::exposure::WALKER_HEIGHT;
use crate::heat::{
    Body, HeatDays, HeatHour, HeatRows, Person, Receiver, SceneSurfaces, Stress, SurfaceParams, body_directions,
    days_of_heat, fold_absorbed, pet, utci,
};
use crate::irradiance::PARTS;
use crate::rows::Obstacles;
use crate::sun::{Site, Zone};
use crate::targets::Measure;
use crate::window_views::{ClassMeanings, are_made_from};
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::vector::to_f32;
use belvedere_data::weather::Weather;
use belvedere_data::{Error, Parameter, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Index from which on heat is strong, and very strong, °C, with the measures that count their hours.
const HOURS_ABOVE: [(f64, &str, &str); 2] =
    [(32.0, "hours_32", "hours of UTCI above 32 °C"), (38.0, "hours_38", "hours of UTCI above 38 °C")];
/// Year of days without one: a typical year has each day in whatever year.
const ANY_YEAR: i16 = 2026;
/// Hours that are given one by one at most.
const MAX_LISTED_HOURS: usize = 48;

/// Heat at places.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct HeatQuestion {
    /// Name of the file of weather.
    pub file: String,
    /// Its rows; whoever reads a question from text reads them from the file.
    #[serde(skip)]
    pub weather: Option<Arc<Weather>>,
    /// The days. A typical year has each day once, in whatever year.
    pub days: Days,
    /// First and last hour of the clock that count, 0 to 24; `None` for all hours.
    pub hours: Option<[f64; 2]>,
    /// Location on earth, and clock.
    pub place: SunPlace,
    /// Shape of the body, whose middle is 1.1 m above the ground where nothing else is said.
    pub body: Body,
    /// Ground, and warming of surfaces.
    pub surfaces: SurfaceParams,
    /// Light through trees.
    pub trees: ThroughTrees,
    /// Suns of each row of weather, 1 to 60. Default 4.
    pub parts: usize,
    /// Factor of the wind of the weather, 0 to 2: shelter of buildings is not computed. Default 1.
    pub wind_factor: f64,
    /// True to give each hour, up to 48 of them. Default: false.
    pub by_hour: bool,
    /// True to compute the Physiological Equivalent Temperature (PET) too, which takes long. Default: false.
    pub pet: bool,
}

impl Default for HeatQuestion {
    fn default() -> Self {
        Self {
            file: String::new(),
            weather: None,
            days: Days::default(),
            hours: None,
            place: SunPlace::default(),
            body: Body::default(),
            surfaces: SurfaceParams::default(),
            trees: ThroughTrees::default(),
            parts: PARTS,
            wind_factor: 1.0,
            by_hour: false,
            pet: false,
        }
    }
}

/// Sums of each target over the hours that count.
struct Sums {
    /// Hours that count.
    hours: f64,
    radiant: Vec<f64>,
    max_radiant: Vec<f64>,
    index: Vec<f64>,
    max_index: Vec<f64>,
    /// Mean and greatest PET, where they are wanted.
    equivalent: Option<[Vec<f64>; 2]>,
    above: [Vec<f64>; HOURS_ABOVE.len()],
    /// Values of single hours: radiant temperature and index.
    single: Vec<[Vec<f32>; 2]>,
    /// Places and hours without an index.
    unknown: usize,
}

impl Sums {
    fn new(targets: usize, single: usize, has_pet: bool) -> Self {
        let all = |value: f64| vec![value; targets];
        Self {
            hours: 0.0,
            radiant: all(0.0),
            max_radiant: all(f64::NEG_INFINITY),
            index: all(0.0),
            max_index: all(f64::NEG_INFINITY),
            equivalent: has_pet.then(|| [all(0.0), all(f64::NEG_INFINITY)]),
            above: HOURS_ABOVE.map(|_| all(0.0)),
            single: vec![std::array::from_fn(|_| vec![f32::NAN; targets]); single],
            unknown: 0,
        }
    }

    /// Adds an hour of a target with its radiant temperature and its PET. `single` is the number of the hour where
    /// single ones are kept.
    fn add(&mut self, row: usize, hour: &HeatHour, [radiant, equivalent]: [f64; 2], single: Option<usize>) {
        let index = utci(&hour.air, radiant).unwrap_or(f64::NAN);
        self.unknown += usize::from(index.is_nan() && radiant.is_finite());
        self.radiant[row] += radiant * hour.hours;
        self.index[row] += index * hour.hours;
        // a sum that is not known makes the greatest value unknown too
        self.max_radiant[row] = if radiant > self.max_radiant[row] { radiant } else { self.max_radiant[row] };
        self.max_index[row] = if index > self.max_index[row] { index } else { self.max_index[row] };
        if let Some([sums, most]) = &mut self.equivalent {
            sums[row] += equivalent * hour.hours;
            most[row] = if equivalent > most[row] { equivalent } else { most[row] };
        }
        for ((least, ..), above) in HOURS_ABOVE.iter().zip(&mut self.above) {
            above[row] += if index > *least { hour.hours } else { 0.0 };
        }
        if let Some(values) = single.and_then(|number| self.single.get_mut(number)) {
            values.iter_mut().zip([radiant, index]).for_each(|(values, value)| values[row] = to_f32(value));
        }
    }

    /// The measures; places without a known mean have no value.
    fn into_measures(self, (days, moments): (usize, &[HourName])) -> Vec<Measure> {
        let hours = self.hours;
        let known = |values: Vec<f64>, means: &[f64], factor: f64| -> Vec<f32> {
            let value = |(value, mean): (f64, &f64)| if mean.is_finite() { to_f32(value * factor) } else { f32::NAN };
            values.into_iter().zip(means).map(value).collect()
        };
        let degrees = |name: &str, values, description| {
            Measure::new(name, values).with_description(description).with_unit("°C").with_decimals(1)
        };
        let (radiant, index) = (self.radiant, self.index);
        let mut measures = vec![
            degrees("utci_max", known(self.max_index, &index, 1.0), "greatest UTCI, °C"),
            degrees("utci_mean", known(index.clone(), &index, 1.0 / hours), "mean UTCI, °C"),
            degrees("tmrt_max", known(self.max_radiant, &radiant, 1.0), "greatest radiant temperature"),
            degrees("tmrt_mean", known(radiant.clone(), &radiant, 1.0 / hours), "mean radiant temperature"),
        ];
        for ((_, name, description), values) in HOURS_ABOVE.into_iter().zip(self.above) {
            let values = known(values, &index, 1.0 / days as f64);
            measures.push(Measure::new(name, values).with_description(description).with_unit("h").with_decimals(2));
        }
        if let Some([mean, most]) = self.equivalent {
            measures.push(degrees("pet_max", known(most, &mean, 1.0), "greatest PET, °C"));
            measures.push(degrees("pet_mean", known(mean.clone(), &mean, 1.0 / hours), "mean PET, °C"));
        }
        for ([radiant, index], name) in self.single.into_iter().zip(moments) {
            for (kind, values, description) in
                [("utci", index, "UTCI, °C"), ("tmrt", radiant, "radiant temperature, °C")]
            {
                let measure = degrees(&format!("{kind}_{}", name.label), values, description);
                measures.push(measure.with_subject(&name.time).with_tags(&name.tags));
            }
        }
        measures
    }
}

/// Names of an hour.
struct HourName {
    label: String,
    time: String,
    tags: Vec<(String, String)>,
}

impl HourName {
    fn of(hour: &HeatHour, zone: &Zone) -> Self {
        let time = zone.display(hour.instant);
        let tags = [("TIME", time.clone()), ("TIME_ZONE", zone.name().to_owned())];
        let tags = tags.map(|(name, text)| (name.to_owned(), text)).to_vec();
        Self { label: moment(zone, hour.instant), time, tags }
    }
}

impl HeatQuestion {
    /// The days, with a year.
    fn dated(&self) -> Days {
        Days { year: self.days.year.or(Some(ANY_YEAR)), ..self.days.clone() }
    }

    fn weather(&self) -> Result<&Weather> {
        match &self.weather {
            Some(weather) => Ok(weather),
            None => Err(Error::invalid(Parameter::Weather, self.file.clone(), "read before the question is put")),
        }
    }

    /// The rows of the days with their suns and surfaces, and the clock.
    fn days(&self, site: &Site, context: &mut Context) -> Result<(HeatDays, Zone)> {
        let weather = self.weather()?;
        let zone = self.place.clock(site, self.days.times(), context)?;
        let Some(period) = self.dated().period(&self.place, site, &zone)? else { return missing_days() };
        context.add(remark_on_solar_hours("heat is computed", self.hours, &zone));
        let rows = HeatRows { period: &period, hours: self.hours.unwrap_or([0.0, 24.0]), zone: &zone };
        let mut found = days_of_heat(weather, &rows, site, (&self.surfaces, self.parts))?;
        for hour in found.days.iter_mut().flat_map(|(hours, _)| hours) {
            hour.air.wind *= self.wind_factor;
        }
        Ok((found, zone))
    }

    /// Remarks on what the weather does not have.
    fn remark(&self, found: &HeatDays, context: &mut Context) {
        let rows = found.days.iter().map(|(hours, _)| hours.len()).sum::<usize>();
        let so = "of the weather have no temperature or humidity, and are left out";
        context.add(Remark::of_share("rows-without-air", found.without_air, rows + found.without_air, "rows", so));
        context.add(remark_on_wind(found.without_wind, rows));
        let so = "of the weather have no longwave radiation of the sky: it follows from air and clouds";
        context.add(
            Remark::of_share("longwave-modelled", found.modelled_longwave, rows, "rows", so).map(Remark::into_note),
        );
    }

    fn section(&self, found: &HeatDays, zone: &Zone) -> Result<HeatSection> {
        let wanted = || found.wanted();
        let hours: f64 = wanted().map(|hour| hour.hours).sum();
        let sum: f64 = wanted().map(|hour| hour.hours * hour.air.temperature).sum();
        let most = |value: fn(&HeatHour) -> f64| rounded(wanted().map(value).fold(f64::NEG_INFINITY, f64::max), 1);
        Ok(HeatSection {
            weather: self.weather()?.format,
            time_zone: zone.name().to_owned(),
            days: found.days.len(),
            hours: rounded(hours, 2),
            mean_air_temperature_c: rounded(sum / hours, 1),
            max_air_temperature_c: most(|hour| hour.air.temperature),
            max_global_w_m2: most(|hour| hour.global),
            body: self.body,
            surfaces: self.surfaces,
            not_modelled: "wind among buildings, heat stored in walls, evaporation",
        })
    }
}

impl Ask for HeatQuestion {
    type Found = OnTargets;

    fn check(&self) -> Result<()> {
        if self.days.is_empty() {
            return missing_days();
        }
        if let Some([from, to]) = self.hours.filter(|[from, to]| !(0.0 <= *from && from <= to && *to <= 24.0)) {
            let expected = "0 to 24, the last not before the first";
            return Err(Error::invalid(Parameter::HoursOfDay, format!("{from} to {to}"), expected));
        }
        if !(1..=60).contains(&self.parts) {
            return Err(Error::invalid(Parameter::WeatherParts, self.parts, "1 to 60"));
        }
        if !(0.0..=2.0).contains(&self.wind_factor) {
            return Err(Error::invalid(Parameter::WindFactor, self.wind_factor, "0 to 2"));
        }
        self.surfaces.validate()?;
        self.dated().check(&self.place)
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let weather = self.weather()?;
        let (balls, points) = (scene.model().balls(), &scene.cloud().positions);
        if !are_made_from(balls, points) {
            let expected = "the points that the balls were made from, whose surfaces are warm: give that cloud";
            return Err(Error::invalid(Parameter::Surfaces, "unknown", expected));
        }
        let site = self.place.site(scene, context, Some([weather.latitude, weather.longitude]))?;
        remark_on_place_of(weather, &site, context);
        let (found, zone) = self.days(&site, context)?;
        self.remark(&found, context);
        let suns = found.wanted().flat_map(|hour| hour.suns.iter().map(|sun| sun.to_sun));
        let sky = body_directions()?.into_iter().map(|(direction, _)| direction).filter(|d| d[2] >= 0.0);
        let directions: Vec<[f64; 3]> = suns.chain(sky).collect();
        let trees = (&self.trees, Some(site.latitude), UnprovenAs::Visible);
        let places = places.at_height(WALKER_HEIGHT);
        let mut light = Light::resolve(&places, &directions, trees, scene, context, control)?;
        let seasons = found.wanted().flat_map(|hour| hour.suns.iter().map(|sun| Some(sun.season)));
        context.add(light.crowns().and_then(|crowns| remark_on_leaves(crowns, crowns.known_factors(seasons))));
        let blockers = Arc::clone(light.whole()?.0);
        Arc::make_mut(&mut light.targets).leave_out_inside(&blockers, context, control)?;
        let kinds = kinds_of_balls(scene, &ClassMeanings::default(), context)?;
        let cover = self.surfaces.ground;
        let surfaces = SceneSurfaces { scene: &blockers, balls, points, kinds: &kinds, cover };
        let named: Vec<HourName> = match self.by_hour {
            true => found.wanted().map(|hour| HourName::of(hour, &zone)).collect(),
            false => Vec::new(),
        };
        if named.len() > MAX_LISTED_HOURS {
            let value = format!("{} hours", named.len());
            let expected = "48 at most where each is given; name fewer days or hours";
            return Err(Error::invalid(Parameter::HoursOfDay, value, expected));
        }
        let sums = control.stage("testing surfaces", light.targets.len() + light.steps(), || {
            self.sums(&light, &surfaces, &found, named.len(), control)
        })?;
        let (unknown, count) = (sums.unknown, light.targets.target_count() * found.wanted().count());
        let so = "have no UTCI: air, wind or radiation are outside the range that it is known for";
        context.add(Remark::of_share("utci-unknown", unknown, count, "hours of places", so));
        let mut measures = sums.into_measures((found.days.len(), &named));
        measures.iter_mut().for_each(|measure| light.targets.clear_unasked(&mut measure.values));
        let section = self.section(&found, &zone)?;
        let title = format!("Heat, greatest UTCI in °C{}", scene.whereabouts().far_in_words());
        summarise(&measures, &section, &PlacesReport::in_words(&light.targets), context);
        context.report.heat = Some(section);
        context.report.measures = Some(MeasuresSection::of(&light.targets, &measures[..4 + HOURS_ABOVE.len()]));
        Ok(Answers::new(light.titled(title), measures))
    }
}

impl HeatQuestion {
    /// Mean radiant temperature, and PET where it is wanted, °C.
    fn temperatures(&self, hour: &HeatHour, absorbed: f64) -> [f64; 2] {
        let radiant = Body::mean_radiant_temperature(absorbed);
        let is_wanted = self.pet && radiant.is_finite();
        [radiant, if is_wanted { pet(&hour.air, radiant, &Person::default()) } else { f64::NAN }]
    }

    fn sums(
        &self,
        light: &Light,
        surfaces: &SceneSurfaces<'_>,
        found: &HeatDays,
        single: usize,
        control: &Control<'_>,
    ) -> Result<Sums> {
        let mut sums = Sums::new(light.targets.len(), single, self.pet);
        sums.hours = found.wanted().map(|hour| hour.hours).sum();
        let days: Vec<&Vec<HeatHour>> = found.days.iter().map(|(hours, _)| hours).collect();
        let before = |day: usize| found.days[..day].iter().flat_map(|(_, wanted)| wanted).filter(|w| **w).count();
        let receiver = Receiver::Body(self.body);
        let (scene, trees) = light.whole()?;
        fold_absorbed(
            (Obstacles { scene, trees }, surfaces),
            &light.targets.positions,
            receiver,
            &days,
            control,
            |block| {
                let (hours, wanted) = &found.days[block.day];
                let first = before(block.day);
                let of_target = |absorbed: &Vec<f64>| -> Vec<[f64; 2]> {
                    let wanted = hours.iter().zip(wanted).zip(absorbed).filter(|((_, wanted), _)| **wanted);
                    wanted.map(|((hour, _), absorbed)| self.temperatures(hour, *absorbed)).collect()
                };
                let temperatures: Vec<Vec<[f64; 2]>> = block.absorbed.par_iter().map(of_target).collect();
                let hours: Vec<&HeatHour> =
                    hours.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(h, _)| h).collect();
                for (row, temperatures) in block.rows.zip(temperatures) {
                    for (number, (hour, temperatures)) in hours.iter().zip(temperatures).enumerate() {
                        sums.add(row, hour, temperatures, (single > 0).then_some(first + number));
                    }
                }
                Ok(())
            },
        )?;
        Ok(sums)
    }
}

/// Reports heat in words: the hottest values, and the class of stress that they are.
fn summarise(measures: &[Measure], section: &HeatSection, places: &str, context: &mut Context) {
    let days = if section.days == 1 { "1 day".to_owned() } else { format!("{} days", section.days) };
    context.headline(format!(
        "heat on {places}: {} {} of {days}, air up to {} °C",
        section.hours,
        if section.hours == 1.0 { "hour" } else { "hours" },
        section.max_air_temperature_c
    ));
    let [index, _, radiant, ..] = measures else { return };
    let class = index.statistics().and_then(|found| Stress::of(found.mean)).map_or("unknown", Stress::name);
    context.headline(format!("greatest UTCI: {}; on the mean {class}", spread(&index.values, 0, "°C")));
    context.headline(format!("greatest mean radiant temperature: {}", spread(&radiant.values, 0, "°C")));
    for ((least, ..), measure) in HOURS_ABOVE.iter().zip(&measures[4..]) {
        if measure.statistics().is_some_and(|found| found.max > 0.0) {
            context.headline(format!("UTCI above {least} °C: {} a day", spread(&measure.values, 1, "h")));
        }
    }
}
