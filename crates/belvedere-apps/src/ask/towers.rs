//! Towers: how much of wind turbines, masts and other tall things is seen.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::north::{AzimuthNorth, North};
use super::observers::{check_height, stand};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, MeasuresSection, PlacesReport, TowerSection, TowersSection};
use super::standing::{Reach, Standing};
use super::sun_and_sky::OnTargets;
use crate::targets::Measure;
use crate::towers::{MAX_SCHEMES, Tower, TowersParams, TowersSeen, TowersView, towers_seen};
use crate::viewshed::{OBSERVER_HEIGHT, Observer, SightLimits, far_targets, terrain_within_reach};
use crate::wireline::{Wireline, wireline};
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{EarthParams, MedialScene, UnprovenAs, VerticalLine};
use belvedere_data::cast::to_index;
use belvedere_data::control::Control;
use belvedere_data::report::{percent, rounded};
use belvedere_data::vector::to_f32;
use belvedere_data::{ElevationGrid, Error, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Maximum height of a tower, metres: greater ones are mistakes of unit, or heights above the sea.
const MAX_HEIGHT: f64 = 1000.0;
/// Maximum distance of a tower from the middle of the cloud, metres: farther ones are in other coordinates.
const MAX_AWAY: f64 = 150_000.0;
/// Maximum number of places with a wireline.
pub const MAX_WIRELINES: usize = 100;

/// Visible metres of towers from places.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct TowersQuestion {
    /// The towers.
    #[serde(skip)]
    pub towers: Vec<GivenTower>,
    /// Height of the eyes above the ground, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Horizontal distance up to which a tower counts, metres, above 0; `None` for no limit.
    pub max_distance: Option<f64>,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Source of the ground that towers without a base stand on.
    pub ground: GroundPoints,
    /// True to add the cells of the terrain beyond the cloud. Default: false.
    pub far: bool,
    /// True to add the wireline of each place, of at most 100. Default: false.
    pub wirelines: bool,
}

/// A tower, as given.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenTower {
    /// Its foot, local metres; the height is NaN where it follows from the ground or the terrain.
    pub foot: [f64; 3],
    /// Height of the hub above the foot, metres; `None` where it has none.
    pub hub: Option<f64>,
    /// Height of the tip above the foot, metres, above 0.
    pub tip: f64,
    /// Name; empty for its number.
    pub name: String,
    /// Scheme that it belongs to; empty for none.
    pub scheme: String,
}

/// Views of towers.
pub struct TowersResults {
    /// The places.
    pub on_targets: OnTargets,
    /// The towers that stand where they were given.
    pub towers: Vec<Tower>,
    /// Results for far terrain, if wanted.
    pub far: Option<FarTowers>,
    /// Views from the places, if wanted.
    pub wirelines: Option<TowerWirelines>,
}

/// Wirelines of towers from places.
pub struct TowerWirelines {
    /// The wireline of each place; `None` where the place has no answer.
    pub views: Vec<Option<Wireline>>,
    /// Names of the towers, by their numbers.
    pub names: Vec<String>,
    /// North of the azimuths that people read.
    pub north: AzimuthNorth,
}

/// Views of towers from the cells of far terrain.
pub struct FarTowers {
    /// The terrain within reach.
    pub terrain: ElevationGrid,
    /// A value for each node of it.
    pub measures: Vec<Measure>,
}

impl GivenTower {
    /// Its name; its number, from 1, where it has none.
    fn name(&self, number: usize) -> String {
        if self.name.is_empty() { format!("number {number}") } else { self.name.clone() }
    }

    fn check(&self, number: usize) -> Result<()> {
        let refused = |value: String, expected| {
            Err(Error::invalid(Parameter::Tower, format!("{} with {value}", self.name(number)), expected))
        };
        if !(self.tip > 0.0 && self.tip <= MAX_HEIGHT) {
            return refused(format!("a tip of {} m", self.tip), "a tip above its base, at most 1000 metres");
        }
        match self.hub {
            Some(hub) if !(0.0..=self.tip).contains(&hub) => {
                refused(format!("a hub of {hub} m"), "a hub above its base, not above its tip")
            }
            _ => Ok(()),
        }
    }
}

impl TowersQuestion {
    /// Names of the schemes, in the order of their first towers.
    fn schemes(&self) -> Vec<&str> {
        let mut schemes: Vec<&str> = Vec::new();
        for tower in &self.towers {
            if !schemes.contains(&tower.scheme.as_str()) {
                schemes.push(&tower.scheme);
            }
        }
        schemes
    }

    /// The towers with their feet on the ground or the terrain.
    fn stand(&self, scene: &Scene, context: &mut Context, control: &Control<'_>) -> Result<Vec<Tower>> {
        let feet: Vec<Standing> =
            self.towers.iter().map(|tower| Standing { place: tower.foot, height: None }).collect();
        let feet = stand(&feet, (0.0, self.ground), scene, context, control)?;
        let schemes = self.schemes();
        let (low, high) = scene.model().bounds().on_map();
        let middle = [0, 1].map(|i| f64::midpoint(low[i], high[i]));
        let one = |(number, (given, foot)): (usize, (&GivenTower, [f64; 3]))| {
            let refused = |value: &str, expected| {
                Err(Error::invalid(Parameter::Tower, format!("{}, {value}", given.name(number)), expected))
            };
            if !((foot[0] - middle[0]).hypot(foot[1] - middle[1]) <= MAX_AWAY) {
                return refused("more than 150 km from the cloud", "in the coordinates of the cloud, or in degrees");
            }
            if !foot[2].is_finite() {
                let expected = "given with its base, or on the ground of the cloud or on terrain that is known";
                return refused("below which no ground is known", expected);
            }
            let scheme = schemes.iter().position(|scheme| *scheme == given.scheme).unwrap_or(0);
            Ok(Tower { line: VerticalLine { foot, height: given.tip }, hub: given.hub, scheme })
        };
        (1..).zip(self.towers.iter().zip(feet)).map(one).collect()
    }

    fn params(&self) -> TowersParams {
        let params = TowersParams::default().with_earth(self.earth);
        self.max_distance.map_or(params, |distance| params.with_max_distance(distance))
    }

    /// The cells of the terrain beyond the cloud that see a part of a tower.
    fn far(
        &self,
        (blockers, towers): (&MedialScene, &[Tower]),
        control: &Control<'_>,
    ) -> Result<(FarTowers, TowersSeen)> {
        let invalid = |value: &str, expected| Err(Error::invalid(Parameter::Terrain, value, expected));
        let Some(terrain) = blockers.far_terrain().grid() else {
            return invalid("missing", "given, where cells of it are wanted");
        };
        let distance = [0.0, self.max_distance.unwrap_or(f64::INFINITY)];
        let limits = SightLimits { distance, ..SightLimits::default() };
        let around: Vec<Observer> = towers.iter().map(|tower| Observer { eye: tower.line.foot, limits }).collect();
        let terrain = terrain_within_reach(terrain, &around)?;
        let size = [terrain.heights().width(), terrain.heights().height()];
        let height = self.observer_height.unwrap_or(OBSERVER_HEIGHT);
        let mut eyes = vec![[f32::NAN; 3]; size[0] * size[1]];
        let ([west, north], cell) = (terrain.north_west(), terrain.cell());
        for [x, y, z] in far_targets(blockers, &terrain) {
            let [column, row] = [(x - west) / cell[0], (north - y) / cell[1]].map(|v| to_index(v.round()));
            eyes[row * size[0] + column] = [x, y, z + height].map(to_f32);
        }
        // no pulse tells of terrain
        let params = self.params().with_tests_proof(false);
        let seen =
            control.stage("testing terrain", eyes.len(), || towers_seen(blockers, towers, &eyes, &params, control))?;
        let measures = seen.measures(towers, false);
        Ok((FarTowers { terrain, measures }, seen))
    }

    /// The wirelines from `eyes`, local metres, of which some may not be finite.
    fn wirelines(
        &self,
        (blockers, scene): (&MedialScene, &Scene),
        towers: &[Tower],
        eyes: &[[f32; 3]],
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<TowerWirelines> {
        let params = self.params();
        let view = |eye: &[f32; 3]| {
            let eye = eye.map(f64::from);
            let is_known = eye.iter().all(|v| v.is_finite());
            let view = is_known.then(|| wireline(blockers, towers, eye, (&params.earth, params.max_distance), control));
            control.advance(1);
            view.transpose()
        };
        let views: Result<Vec<Option<Wireline>>> =
            control.stage("drawing wirelines", eyes.len(), || eyes.iter().map(view).collect());
        let north = North::default().of_scene(scene);
        context.north(&north);
        let names = (1..).zip(&self.towers).map(|(number, tower)| tower.name(number)).collect();
        Ok(TowerWirelines { views: views?, names, north })
    }

    fn section(&self, towers: &[Tower], scene: &Scene, seen: [Option<&TowersSeen>; 2]) -> TowersSection {
        let places = seen.map(|seen| seen.map_or(0, |seen| seen.views.iter().flatten().count()));
        let of_tower = |(number, (tower, given)): (usize, (&Tower, &GivenTower))| {
            let share = |which: usize, what: usize| {
                seen[which].map(|seen| percent(seen.place_counts[number][what], places[which]))
            };
            TowerSection {
                name: given.name(number + 1),
                base: rounded(scene.frame().file_from_local(tower.line.foot)[2], 2),
                visible_percent: share(0, 0).unwrap_or(0.0),
                tip_percent: share(0, 1).unwrap_or(0.0),
                hub_percent: share(0, 2).filter(|_| tower.hub.is_some()),
                far_visible_percent: share(1, 0),
            }
        };
        let schemes = self.schemes();
        let schemes = if schemes.len() > 1 { schemes.into_iter().map(str::to_owned).collect() } else { Vec::new() };
        TowersSection {
            towers: towers.len(),
            height_m: rounded(towers.iter().map(|tower| tower.line.height).sum(), 1),
            schemes,
            each: towers.iter().zip(&self.towers).enumerate().map(of_tower).collect(),
        }
    }
}

impl Ask for TowersQuestion {
    type Found = TowersResults;

    fn check(&self) -> Result<()> {
        self.earth.validate()?;
        check_height(self.observer_height)?;
        if let Some(distance) = self.max_distance.filter(|distance| !(*distance > 0.0)) {
            let (parameter, value) = (Parameter::MaxDistance, distance.to_string());
            return Err(Error::invalid(parameter, value, "above zero metres"));
        }
        let refused = |value: String, expected| Err(Error::invalid(Parameter::Tower, value, expected));
        if self.towers.is_empty() {
            return refused("missing".to_owned(), "given");
        }
        match self.schemes().len() {
            count if count > MAX_SCHEMES => refused(format!("of {count} schemes"), "of at most 24 schemes"),
            _ => (1..).zip(&self.towers).try_for_each(|(number, tower)| tower.check(number)),
        }
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let towers = self.stand(scene, context, control)?;
        let height = self.observer_height.unwrap_or(OBSERVER_HEIGHT);
        if self.wirelines && matches!(places, Places::Cells(_) | Places::Own(_) | Places::Mesh(..)) {
            let (parameter, value) = (Parameter::Targets, "cells, a whole cloud or a mesh".to_owned());
            return Err(Error::invalid(parameter, value, "single places, where wirelines are wanted"));
        }
        let mut targets = places.at_height(height).targets_within(Reach::FarTerrain, scene, context, control)?;
        if self.wirelines && targets.len() > MAX_WIRELINES {
            let (parameter, value) = (Parameter::ObserverCount, targets.len().to_string());
            return Err(Error::invalid(parameter, value, "at most 100, for wirelines"));
        }
        let blockers = scene.blockers(UnprovenAs::Reported, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        Arc::make_mut(&mut targets).leave_out_inside(&blockers, context, control)?;
        let beyond = towers.iter().filter(|tower| blockers.is_outside(tower.line.foot)).count();
        let so = "stand beyond the cloud and the terrain: what lies between is not known, and hides nothing";
        context.add(Remark::of_share("towers-beyond-survey", beyond, towers.len(), "towers", so));
        let seen = control.stage("testing towers", targets.len(), || {
            towers_seen(&blockers, &towers, &targets.positions, &self.params(), control)
        })?;
        let measures = seen.measures(&towers, blockers.proof().is_some());
        let far = match self.far {
            true => Some(self.far((&blockers, &towers), control)?),
            false => None,
        };
        let wirelines = match self.wirelines {
            true => Some(self.wirelines((&blockers, scene), &towers, &targets.positions, context, control)?),
            false => None,
        };
        let of_far = far.as_ref().map(|(_, seen)| seen);
        summarise(&towers, &seen, &PlacesReport::in_words(&targets), context);
        if let Some(of_far) = of_far {
            let count = of_far.views.iter().flatten().count();
            summarise(&towers, of_far, &format!("{count} cells beyond the cloud"), context);
        }
        context.report.measures = Some(MeasuresSection::of(&targets, &measures));
        context.report.towers = Some(self.section(&towers, scene, [Some(&seen), of_far]));
        let title = format!("Visible metres of {}", in_words(towers.len()));
        let on_targets = OnTargets { near_edge: vec![None; targets.len()], targets, title };
        let far = far.map(|(far, _)| far);
        Ok(Answers::new(TowersResults { on_targets, towers, far, wirelines }, measures))
    }
}

fn in_words(towers: usize) -> String {
    if towers == 1 { "a tower".to_owned() } else { format!("{towers} towers") }
}

/// Reports in words how many places see the towers.
fn summarise(towers: &[Tower], seen: &TowersSeen, places: &str, context: &mut Context) {
    let views = || seen.views.iter().flatten();
    let count = views().count();
    let share = |what: &dyn Fn(&TowersView) -> bool| percent(views().filter(|view| what(view)).count(), count);
    let name = in_words(towers.len());
    if count == 0 {
        context.headline(format!("{name} from {places}: no place has an answer"));
        return;
    }
    let of = |i: usize| share(&|view| view.counts[i] > 0);
    let mut line = format!("{name} from {places}: a part visible from {} %, a tip from {} %", of(0), of(1));
    if towers.iter().any(|tower| tower.hub.is_some()) {
        line.push_str(&format!(", a hub from {} %", of(2)));
    }
    context.headline(line);
    let all = share(&|view| view.counts[1] as usize == towers.len());
    let most = views().map(|view| view.counts[0]).max().unwrap_or(0);
    let metres: f64 = views().map(|view| view.metres).sum::<f64>() / count as f64;
    let height: f64 = towers.iter().map(|tower| tower.line.height).sum();
    let mut line = format!("mean of {} visible metres of {}", rounded(metres, 1), rounded(height, 1));
    if towers.len() > 1 {
        line.push_str(&format!("; up to {most} towers at once, all tips from {all} %"));
    }
    context.headline(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn towers_that_cannot_be_are_refused_before_a_scene_is_known() {
        let tower = GivenTower {
            foot: [0.0, 0.0, f64::NAN],
            hub: Some(120.0),
            tip: 200.0,
            name: "t1".to_owned(),
            scheme: String::new(),
        };
        let usual = TowersQuestion { towers: vec![tower.clone()], ..TowersQuestion::default() };
        assert!(usual.check().is_ok());
        let with = |tower: GivenTower| TowersQuestion { towers: vec![tower], ..TowersQuestion::default() };
        let many = (0..25).map(|i| GivenTower { scheme: i.to_string(), ..tower.clone() }).collect();
        for wrong in [
            TowersQuestion::default(),
            TowersQuestion { towers: many, ..TowersQuestion::default() },
            with(GivenTower { tip: f64::NAN, ..tower.clone() }),
            with(GivenTower { tip: 0.0, ..tower.clone() }),
            with(GivenTower { tip: 1200.0, ..tower.clone() }),
            with(GivenTower { hub: Some(201.0), ..tower.clone() }),
            with(GivenTower { hub: Some(-1.0), ..tower }),
            TowersQuestion { max_distance: Some(0.0), ..usual.clone() },
            TowersQuestion { observer_height: Some(-1.0), ..usual },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
