//! Lines of sight: whether the observers of pairs see their targets, and the first obstacle of each.

use super::answers::{Answered, Answers, Ask};
use super::cells::GridCells;
use super::context::Context;
use super::how_sure::HowSure;
use super::observers::{check_height, note_beside, note_enclosed, stand};
use super::places::{NetworkPlaces, Places};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LineSection, LinesSection, NetworkSection, PairsSection};
use super::sight_network::SightNetwork;
use super::standing::Standing;
use super::viewer::remark_on_inside;
use crate::profile::{SightProfile, sight_profile};
use crate::radio_link::RadioWave;
use crate::targets::{Measure, TARGET_LIFT};
use crate::viewshed::OBSERVER_HEIGHT;
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{Answer, Blocker, EarthParams, LineOfSight, MedialScene, Obstruction, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::{Error, Parameter, PatchKind, Result};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

const OUTSIDE_CLOUD: &str = "have an end outside the cloud, where nothing is known, and no answer";
const OUTSIDE_CLOUD_AND_TERRAIN: &str =
    "have an end outside the cloud and the terrain, or below the cloud, where nothing is known, and no answer";

/// Visibility of the targets of pairs from their observers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct LinesOfSightQuestion {
    /// Height above the ground of observers without one, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Height above the ground of targets without one, metres, 0 or more; `None` for 0.1.
    pub target_height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// Frequency of a radio link, GHz, 0.001 to 1000, to test its first Fresnel zone too; `None` for the line alone.
    pub frequency_ghz: Option<f64>,
    /// Treatment of unproven answers; `None` to report them if pulses are known.
    pub unproven: Option<UnprovenAs>,
    /// Request for the certainty of answers.
    pub how_sure: HowSure,
    /// Also the profile, of a single line.
    pub profile: Option<ProfileRows>,
}

/// The rows of a profile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct ProfileRows {
    /// Distance between rows, metres, above 0; `None` for a thousandth of the line, at least 0.1.
    pub step: Option<f64>,
}

/// Results for the line of sight of each pair.
#[derive(Clone, Debug)]
pub struct SightsResults {
    /// Observer and target of each, local metres; a height is NaN where it is not known.
    pub pairs: Vec<[[f64; 3]; 2]>,
    /// The answers, with unproven ones counted as requested.
    pub answers: Vec<Answer>,
    /// Result of each line; `None` if the ends make no line.
    pub sights: Vec<Option<LineOfSight>>,
    /// The free share of the first Fresnel zone of each, 0 to 1, for a radio link.
    pub fresnel: Option<Vec<f64>>,
    /// True if pulses were tested.
    pub is_proof_tested: bool,
    /// Certainty of answers, if wanted: measures of the pairs.
    pub sure: Vec<Measure>,
    /// The profile that was wanted.
    pub profile: Option<SightProfile>,
    /// The places that the pairs are of, if they are those of a network.
    pub network: Option<SightNetwork>,
}

/// Results of lines of sight in columns, for tables.
#[derive(Clone, Debug)]
pub struct SightColumns<'a> {
    /// Distance from the observer to the first obstacle, metres; NaN without one.
    pub ranges: Vec<f64>,
    /// Length of a free line that no pulse came near to, metres, if pulses were tested.
    pub unproven: Option<Vec<f64>>,
    /// Free percentage of the first Fresnel zone, for radio links.
    pub fresnel_free_percent: Option<Vec<f64>>,
    /// First blocked place of each line, in the coordinates of the file.
    pub places: Vec<[f64; 3]>,
    /// The row of the ball that blocks first.
    pub balls: Vec<Option<usize>>,
    /// The row of the point that this ball touches.
    pub sources: Vec<Option<u32>>,
    /// The name of the mesh that blocks first, empty where none does, where meshes were added.
    pub meshes: Option<Vec<&'a str>>,
    /// Surface of the survey that blocks first (roof, wall, parapet, inside), empty if none does; `None` if no surfaces
    /// are known.
    pub surfaces: Option<Vec<&'static str>>,
    /// True if far terrain blocks first, if there is any; `None` if nothing blocks.
    pub is_terrain: Option<Vec<Option<bool>>>,
}

impl LinesOfSightQuestion {
    fn wave(&self) -> Result<Option<RadioWave>> {
        self.frequency_ghz.map(RadioWave::of_frequency).transpose()
    }

    /// The ends of lines; those without a height stand on the ground or the terrain.
    pub(super) fn ends(
        &self,
        places: &Places,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<[[f64; 3]; 2]>> {
        let given = places.pairs()?;
        let pairs: Vec<[[f64; 3]; 2]> = given.iter().map(|ends| ends.map(|end| end.place)).collect();
        if pairs.iter().flatten().all(|end| !end[2].is_nan()) {
            return Ok(pairs);
        }
        let usual = [self.observer_height.unwrap_or(OBSERVER_HEIGHT), self.target_height.unwrap_or(TARGET_LIFT)];
        let standing = |(end, usual): (&Standing, f64)| Standing { height: end.height.or(Some(usual)), ..*end };
        let standing: Vec<Standing> = given.iter().flat_map(|ends| ends.iter().zip(usual)).map(standing).collect();
        let ends = stand(&standing, (OBSERVER_HEIGHT, self.ground), scene, context, control)?;
        let unknown = ends.iter().filter(|end| end[2].is_nan()).count();
        let so = "have no height and no known ground below";
        context.add(Remark::of_share("ends-without-ground", unknown, ends.len(), "ends of lines", so));
        Ok(ends.as_chunks::<2>().0.to_vec())
    }

    /// The places of a network, and each pair of them within the maximum distance, the first place before the second.
    fn network(
        &self,
        given: &NetworkPlaces,
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<SightNetwork> {
        given.check()?;
        let height = self.observer_height.unwrap_or(OBSERVER_HEIGHT);
        let standing: Vec<Standing> =
            given.places.iter().map(|place| Standing { height: place.height.or(Some(height)), ..*place }).collect();
        let places = stand(&standing, (OBSERVER_HEIGHT, self.ground), scene, context, control)?;
        let unknown = places.iter().filter(|place| place[2].is_nan()).count();
        let so = "have no height and no known ground below";
        context.add(Remark::of_share("ends-without-ground", unknown, places.len(), "places", so));
        SightNetwork::new(places, given, control)
    }

    /// The profile, where it is wanted. A ball file without a cloud shows no ground.
    fn profile(
        &self,
        pairs: &[[[f64; 3]; 2]],
        (scene, blockers): (&Scene, &MedialScene),
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Option<SightProfile>> {
        let (Some(rows), &[pair]) = (self.profile, pairs) else { return Ok(None) };
        let known = match scene.ground_cloud() {
            Ok(_) => Some(scene.ground(GridCells::default().grid(scene)?, self.ground, control)?),
            Err(_) => None,
        };
        if let Some(known) = &known {
            context.ground(scene.frame(), known);
        }
        let ground = known.as_ref().map(|known| &known.ground);
        let made = control
            .stage("computing profile", 0, || sight_profile(blockers, ground, pair, &self.earth, rows.step, control))?;
        Ok(Some(made))
    }

    /// Computes the certainty of `answers`, if wanted.
    fn sure_of(
        &self,
        pairs: &[[[f64; 3]; 2]],
        answers: &[Answer],
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Vec<Measure>> {
        let Some(blockers) = self.how_sure.blockers(scene, context, control)? else { return Ok(Vec::new()) };
        let probabilities =
            control.stage("computing probabilities", pairs.len(), || blockers.pair_probabilities(pairs, control))?;
        let is_unproven = |row: usize| answers.get(row) == Some(&Answer::Unproven);
        let uncertain = self.how_sure.uncertain(&probabilities, is_unproven)?;
        match &probabilities[..] {
            [one] if one.is_finite() => {
                let doubt = if uncertain.as_deref() == Some(&[1.0]) { ": uncertain" } else { "" };
                context.headline(format!("visible with a probability of {one:.2}{doubt}"));
            }
            [] | [_] => {}
            many => self.how_sure.summarise(many, uncertain.as_deref(), ["visible", "blocked"], context),
        }
        Ok(self.how_sure.measures(probabilities, uncertain, ""))
    }

    /// Refuses a profile of several lines.
    fn check_count(&self, count: usize) -> Result<()> {
        if self.profile.is_none() || count == 1 {
            return Ok(());
        }
        Err(Error::invalid(Parameter::ProfileLine, format!("{count} lines"), "a single line"))
    }
}

impl Ask for LinesOfSightQuestion {
    type Found = SightsResults;

    fn check(&self) -> Result<()> {
        self.how_sure.check()?;
        check_height(self.observer_height)?;
        check_height(self.target_height)?;
        self.earth.validate()?;
        if let Some(step) = self.profile.and_then(|rows| rows.step).filter(|step| !(step.is_finite() && *step > 0.0)) {
            return Err(Error::invalid(Parameter::ProfileStep, step, "finite and above zero metres"));
        }
        self.wave().map(|_| ())
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        if self.unproven.is_some() {
            scene.check_proof()?;
        }
        self.how_sure.check_scene(scene)?;
        let (pairs, mut network) = match places {
            Places::Network(given) => {
                let network = self.network(given, scene, context, control)?;
                (network.lines(), Some(network))
            }
            _ => (self.ends(places, scene, context, control)?, None),
        };
        self.check_count(pairs.len())?;
        let unproven = self.unproven.unwrap_or(UnprovenAs::Reported);
        let blockers = scene.blockers(unproven, control)?;
        let sights = control
            .stage("testing lines of sight", pairs.len(), || blockers.lines_of_sight(&pairs, &self.earth, control))?;
        let fresnel = match self.wave()? {
            Some(wave) => Some(control.stage("testing Fresnel zones", pairs.len(), || {
                wave.zone_clearances(&blockers, &pairs, &sights, &self.earth, control)
            })?),
            None => None,
        };
        let settled =
            |sight: &Option<LineOfSight>| sight.map_or(Answer::OutsideView, |sight| unproven.settle(sight.answer));
        let answers: Vec<Answer> = sights.iter().map(settled).collect();
        let inside =
            control.stage("testing ends", pairs.len(), || ends_inside(&blockers, &pairs, &answers, control))?;
        let section = PairsSection::of(&answers, unproven, inside);
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None).with_pairs(section));
        let is_outside = match scene.model().far_terrain().grid() {
            Some(_) => OUTSIDE_CLOUD_AND_TERRAIN,
            None => OUTSIDE_CLOUD,
        };
        let outside = section.outside_cloud;
        context.add(Remark::of_share("lines-outside-cloud", outside, answers.len(), "lines of sight", is_outside));
        let ends: Vec<[f64; 3]> = pairs.iter().flatten().copied().collect();
        note_beside(&blockers, &ends, "end", context);
        if let Some(network) = &network {
            context.add(network.remark_on_inside(&blockers));
        } else if pairs.len() > 1 {
            let so = "have an end inside an obstacle: they are neither visible nor blocked";
            let count = section.inside_obstacle;
            context.add(Remark::of_share("lines-inside-obstacle", count, answers.len(), "lines of sight", so));
        }
        let profile = self.profile(&pairs, (scene, &blockers), context, control)?;
        let is_proof_tested = blockers.proof().is_some();
        let sure = self.sure_of(&pairs, &answers, scene, context, control)?;
        if let Some(network) = &mut network {
            network.count_links(&answers);
            context.report.network = Some(NetworkSection::of(network, &answers));
        }
        let found = SightsResults { pairs, answers, sights, fresnel, is_proof_tested, sure, profile, network };
        match &found.pairs[..] {
            [[observer, target]] if found.network.is_none() => {
                for (end, what) in [(*observer, "observer"), (*target, "target")] {
                    context.add(remark_on_inside(&blockers, end, what));
                    note_enclosed(&blockers, &[end], what, context);
                }
                let line = LineSection::of(&found, scene);
                line.summarise(context);
                context.report.line = Some(line);
            }
            _ => section.headlines().into_iter().for_each(|line| context.headline(line)),
        }
        if let Some(network) = context.report.network.as_ref().map(NetworkSection::headline) {
            context.headline(network);
        }
        Ok(Answers::new(found, Vec::new()))
    }
}

impl SightsResults {
    /// Returns the first obstacle on the line of that row.
    #[must_use]
    pub fn block(&self, row: usize) -> Option<Obstruction> {
        self.sights.get(row).copied().flatten()?.first_block
    }

    /// All that is known of each line.
    #[must_use]
    pub fn columns<'a>(&self, scene: &'a Scene) -> SightColumns<'a> {
        let (model, frame) = (scene.model(), scene.frame());
        let blocks = || (0..self.sights.len()).map(|row| self.block(row));
        let ball = |block: Option<Obstruction>| block.and_then(|block| block.blocker.ball());
        let unproven = |sight: &Option<LineOfSight>| {
            sight.filter(|sight| sight.first_block.is_none()).map_or(f64::NAN, |sight| sight.unproven_length)
        };
        let is_terrain = |block: Obstruction| block.blocker == Blocker::Terrain;
        SightColumns {
            ranges: blocks().map(|block| block.map_or(f64::NAN, |block| block.range)).collect(),
            unproven: self.is_proof_tested.then(|| self.sights.iter().map(unproven).collect()),
            fresnel_free_percent: self.fresnel.as_ref().map(|all| all.iter().map(|free| 100.0 * free).collect()),
            places: blocks()
                .map(|block| block.map_or([f64::NAN; 3], |block| frame.file_from_local(block.place)))
                .collect(),
            balls: blocks().map(ball).collect(),
            sources: blocks().map(|block| model.balls().source.get(ball(block)?).copied()).collect(),
            meshes: model.added().map(|_| {
                blocks().map(|block| mesh_name(scene, block?.blocker)).map(Option::unwrap_or_default).collect()
            }),
            surfaces: (!model.patches().is_empty())
                .then(|| blocks().map(|block| surface_name(block?.blocker)).map(Option::unwrap_or_default).collect()),
            is_terrain: model.far_terrain().grid().map(|_| blocks().map(|block| block.map(is_terrain)).collect()),
        }
    }
}

/// The name of an added mesh that blocks.
fn mesh_name(scene: &Scene, blocker: Blocker) -> Option<&str> {
    scene.model().added()?.names().get(blocker.mesh()?).map(String::as_str)
}

/// Returns the kind of the surface that blocks; `None` if the obstacle is no surface of the survey.
fn surface_name(blocker: Blocker) -> Option<&'static str> {
    blocker.patch().map(PatchKind::name)
}

/// Counts the observers and the targets inside an obstacle, on lines with that answer.
fn ends_inside(
    blockers: &MedialScene,
    pairs: &[[[f64; 3]; 2]],
    answers: &[Answer],
    control: &Control<'_>,
) -> Result<[usize; 2]> {
    let inside = pairs.par_iter().zip(answers).filter(|(_, answer)| **answer == Answer::InsideObstacle);
    let counted = inside.map(|(ends, _)| {
        control.check()?;
        Ok(ends.map(|end| usize::from(blockers.is_inside_obstacle(end))))
    });
    counted.try_reduce(|| [0; 2], |a, b| Ok([a[0] + b[0], a[1] + b[1]]))
}

fn name_of(answer: Answer) -> &'static str {
    match answer {
        Answer::Visible => "visible",
        Answer::Blocked => "blocked",
        Answer::Unproven => "unproven",
        Answer::OutsideCloud => "outside the cloud",
        Answer::InsideObstacle => "inside an obstacle",
        _ => "no line",
    }
}

impl LineSection {
    /// The only line.
    fn of(found: &SightsResults, scene: &Scene) -> Self {
        let free = found.fresnel.as_ref().and_then(|all| all.first()).filter(|free| free.is_finite());
        let fresnel_free_percent = free.map(|free| rounded(100.0 * free, 1));
        let (Some(&answer), Some(&Some(sight))) = (found.answers.first(), found.sights.first()) else {
            return Self { fresnel_free_percent, ..Self::default() };
        };
        let block = sight.first_block;
        let ball = block.and_then(|block| block.blocker.ball());
        let source = |ball: usize| scene.model().balls().source.get(ball).copied().unwrap_or_default();
        let place = |block: Obstruction| scene.frame().file_from_local(block.place).map(|v| rounded(v, 3));
        let has_unproven = found.is_proof_tested && sight.answer != Answer::OutsideCloud;
        Self {
            answer: Some(name_of(answer)),
            first_block_range_m: block.map(|block| rounded(block.range, 3)),
            block_position: block.map(place),
            block_ball: ball,
            block_source: ball.map(source),
            block_mesh: block.and_then(|block| mesh_name(scene, block.blocker)).map(str::to_owned),
            block_surface: block.and_then(|block| surface_name(block.blocker)),
            block_terrain: block.filter(|block| block.blocker == Blocker::Terrain).map(|_| true),
            unproven_m: has_unproven.then(|| rounded(sight.unproven_length, 3)),
            fresnel_free_percent,
        }
    }

    fn summarise(&self, context: &mut Context) {
        let answer = self.answer.unwrap_or("no line: the ends are one point, or a height is not known");
        let by = match (&self.block_mesh, self.block_surface, self.block_terrain) {
            (Some(mesh), _, _) => format!(" by {mesh}"),
            (_, Some(kind), _) => format!(" by a surface of the survey ({kind})"),
            (_, _, Some(true)) => " by the terrain".to_owned(),
            _ => String::new(),
        };
        let after = self.first_block_range_m.map_or_else(String::new, |range| format!(", {range} m from the observer"));
        context.headline(format!("line of sight: {answer}{by}{after}"));
        if let Some([x, y, z]) = self.block_position {
            context.headline(format!("first obstacle at {x}, {y}, {z}"));
        }
        if let Some(length) = self.unproven_m.filter(|_| self.first_block_range_m.is_none()) {
            context.headline(match length {
                0.0 => "pulses came near to all of it".to_owned(),
                length => format!("no pulse came near to {length} m of it"),
            });
        }
        if let Some(free) = self.fresnel_free_percent {
            context.headline(format!("first Fresnel zone: {free} % free"));
        }
    }
}
