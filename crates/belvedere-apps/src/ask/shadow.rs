//! Shadow: light of one or more suns at places.

use super::answers::{Answered, Answers, Ask};
use super::casters::{casters, check_casters};
use super::context::{Context, spread};
use super::how_sure::HowSure;
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{MeasuresSection, PlacesReport};
use super::sun::{MAX_LISTED_SUNS, NamedSun, Suns};
use super::sun_and_sky::{Light, OnTargets};
use super::sun_place::SunPlace;
use super::trees::{ThroughTrees, remark_on_leaves};
use crate::shadow::{Edges, LIT, ShadowSun, UNPROVEN, half_or_more, scene_shadow, sun_directions};
use crate::targets::{Measure, ResultKind};
use crate::tree_light::CrownLight;
use belvedere_core::query::UnprovenAs;
use belvedere_data::control::Control;
use belvedere_data::report::percent;
use belvedere_data::vector::to_f32;
use belvedere_data::{Error, Parameter, Result};
use serde::{Deserialize, Serialize};

/// Places in the sun.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ShadowQuestion {
    /// The suns.
    pub suns: Suns,
    /// Location on earth, and clock.
    #[serde(default)]
    pub place: SunPlace,
    /// Shape of the sun: a point, or a disc of which places see a share.
    #[serde(default)]
    pub edges: Edges,
    /// Light through trees.
    #[serde(default)]
    pub trees: ThroughTrees,
    /// Treatment of unproven light; `None` to report it if one sun with hard edges allows that.
    #[serde(default)]
    pub unproven: Option<UnprovenAs>,
    /// Request for the certainty of answers; for suns with hard edges among opaque trees.
    #[serde(default)]
    pub how_sure: HowSure,
    /// True to say what casts each shadow: building, trees, an added mesh and so on. Default: false.
    #[serde(default)]
    pub casters: bool,
}

/// The suns of an answer.
#[derive(Clone, Debug)]
pub struct ShadowResults {
    /// The targets.
    pub on: OnTargets,
    /// The suns; the first measures are theirs, one each.
    pub suns: Vec<NamedSun>,
}

impl ShadowQuestion {
    /// Returns whether pulses are tested: for one sun that is a point. For many suns it would take long.
    fn proof(&self, suns: usize) -> Result<UnprovenAs> {
        let is_possible = suns == 1 && self.edges == Edges::Hard;
        match self.unproven {
            Some(UnprovenAs::Visible) => Ok(UnprovenAs::Visible),
            Some(_) if !is_possible => Err(Error::invalid(
                Parameter::UnprovenAs,
                "given",
                "left out: pulses are tested only for one sun with hard edges",
            )),
            Some(unproven) => Ok(unproven),
            None if is_possible => Ok(UnprovenAs::Reported),
            None => Ok(UnprovenAs::Visible),
        }
    }
}

/// Probability that each target is lit, and flags of the uncertain ones.
type Sureness = (Vec<f32>, Option<Vec<f32>>);

impl ShadowQuestion {
    /// Creates the question about the sun at these times, with hard edges and opaque trees.
    #[must_use]
    pub fn of_times(times: Vec<String>) -> Self {
        Self {
            suns: Suns::Times(times),
            place: SunPlace::default(),
            edges: Edges::Hard,
            trees: ThroughTrees::Opaque,
            unproven: None,
            how_sure: HowSure::default(),
            casters: false,
        }
    }

    /// Computes the certainty of the answers of each sun; empty if not wanted. `doubts` are of a single sun.
    fn sureness(
        &self,
        suns: &[ShadowSun],
        light: &Light,
        doubts: Option<&[f32]>,
        (scene, context): (&Scene, &mut Context),
        control: &Control<'_>,
    ) -> Result<Vec<Sureness>> {
        if !self.how_sure.is_wanted() {
            return Ok(Vec::new());
        }
        let proving = match scene.parts() {
            Some(_) => None,
            None => self.how_sure.blockers(scene, context, control)?,
        };
        let is_unproven = |row: usize| doubts.and_then(|doubts| doubts.get(row)).is_some_and(|&doubt| doubt > 0.0);
        control.stage("computing probabilities", suns.len() * light.targets.len(), || {
            let of_sun = |sun: &ShadowSun| {
                let probabilities = light.lit_probabilities(proving.as_deref(), *sun, control)?;
                let uncertain = self.how_sure.uncertain(&probabilities, is_unproven)?;
                Ok((probabilities, uncertain))
            };
            suns.iter().map(of_sun).collect()
        })
    }
}

impl Ask for ShadowQuestion {
    type Found = ShadowResults;

    fn check(&self) -> Result<()> {
        self.how_sure.check()?;
        if self.edges == Edges::Soft {
            let expected = "left out with soft edges: they are shares of light";
            self.how_sure.check_without("given with soft edges", expected)?;
        }
        if self.trees.is_light() {
            let expected = "left out where light gets through trees: it is a share";
            self.how_sure.check_without("given with light through trees", expected)?;
        }
        self.suns.check(&self.place)
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        self.how_sure.check_scene(scene)?;
        if self.casters {
            scene.check_whole()?;
            check_casters(places, scene)?;
        }
        let suns = self.suns.resolve(&self.place, &scene.whereabouts(), context)?;
        let kinds: Vec<ShadowSun> = suns.iter().map(|sun| sun.sun).collect();
        let directions: Vec<[f64; 3]> = kinds.iter().flat_map(|sun| sun_directions(sun.to_sun, self.edges)).collect();
        let unproven = self.proof(suns.len())?;
        if self.unproven.is_some_and(|unproven| unproven != UnprovenAs::Visible) {
            scene.check_proof()?;
        }
        let seasons = kinds.iter().map(|sun| sun.season);
        let trees = (&self.trees, seasons.clone().flatten().next().map(|season| season.latitude), unproven);
        let light = Light::resolve(places, &directions, trees, scene, context, control)?;
        context.add(light.crowns().and_then(|crowns| remark_on_leaves(crowns, crowns.known_factors(seasons))));
        let mut lit = control.stage("testing sun", light.steps(), || {
            scene_shadow(light.obstacles(), &light.targets, &kinds, self.edges, control)
        })?;
        let is_answer = self.edges == Edges::Hard && !light.crowns().is_some_and(|crowns| crowns.gives_shares());
        if is_answer && matches!(light.crowns(), Some(CrownLight::Measured { .. })) {
            lit.iter_mut().flatten().for_each(|share| *share = half_or_more(*share));
        }
        let doubts = match (&kinds[..], &mut lit[..]) {
            ([sun], [lit]) if unproven != UnprovenAs::Visible => {
                let tested = light.unproven(*sun, lit, control)?;
                settled(lit, tested, unproven)
            }
            _ => None,
        };
        let sure = self.sureness(&kinds, &light, doubts.as_deref(), (scene, context), control)?;
        let decimals = if self.edges == Edges::Soft { 4 } else { 2 };
        let kind = if is_answer { ResultKind::Answer } else { ResultKind::Number };
        let as_band = |measure: Measure| measure.with_range(Some([0.0, 1.0])).with_kind(kind);
        let of_sun = |(sun, values): (&NamedSun, Vec<f32>)| {
            as_band(Measure::new(&sun.column, values).with_description(LIT).with_decimals(decimals))
                .with_subject(&sun.title)
                .with_tags(&sun.tags)
        };
        let mut measures: Vec<Measure> = suns.iter().zip(lit).map(of_sun).collect();
        measures.extend(doubts.map(|doubts| {
            as_band(Measure::new(UNPROVEN, doubts).with_description("1: lit, but unproven").with_decimals(0))
        }));
        let targets = &light.targets;
        let listed = &measures[..measures.len().min(MAX_LISTED_SUNS)];
        context.report.measures = Some(MeasuresSection::of(targets, listed));
        summarise(&suns, &measures, &PlacesReport::in_words(targets), context);
        if let [(probabilities, uncertain)] = &sure[..] {
            self.how_sure.summarise(probabilities, uncertain.as_deref(), ["lit", "in shadow"], context);
        }
        let suffix = |sun: &NamedSun| if suns.len() == 1 { String::new() } else { format!("_{}", sun.column) };
        for (sun, (probabilities, uncertain)) in suns.iter().zip(sure) {
            let suffix = suffix(sun);
            measures.extend(self.how_sure.measures(probabilities, uncertain, &suffix));
        }
        if self.casters {
            let of_suns = (&suns[..], &measures[..suns.len()]);
            measures.extend(casters(of_suns, &light, suffix, (scene, context), control)?);
        }
        let title = suns.first().map(|sun| sun.title.clone()).unwrap_or_default();
        Ok(Answers::new(ShadowResults { on: light.titled(title), suns }, measures))
    }
}

/// Counts unproven light as requested, and returns it where it is to be reported.
fn settled(lit: &mut [f32], doubts: Option<Vec<f32>>, unproven: UnprovenAs) -> Option<Vec<f32>> {
    let mut doubts = doubts?;
    match unproven {
        UnprovenAs::Visible => None,
        UnprovenAs::Reported => {
            // what has no light that is known has no doubt either
            let unknown = doubts.iter_mut().zip(&*lit).filter(|(_, lit)| lit.is_nan());
            unknown.for_each(|(doubt, _)| *doubt = f32::NAN);
            Some(doubts)
        }
        UnprovenAs::Blocked => {
            let lit = lit.iter_mut().zip(&doubts).filter(|(_, doubt)| **doubt > 0.0);
            lit.for_each(|(lit, _)| *lit = 0.0);
            None
        }
    }
}

/// Reports the light of suns. With a single sun, its unproven light may follow its measure.
pub(super) fn summarise(suns: &[NamedSun], measures: &[Measure], places: &str, context: &mut Context) {
    // a mean of nothing but zeros may be minus zero
    let share = |measure: &Measure| measure.statistics().map_or(f64::NAN, |found| 100.0 * found.mean + 0.0);
    match (suns, measures) {
        ([sun], [lit, rest @ ..]) => {
            context.headline(match lit.statistics() {
                Some(_) => format!("{}: {:.1} % lit of {places}", sun.title, share(lit)),
                None => format!("{}: no answer for {places}", sun.title),
            });
            if let [doubts] = rest {
                let count = |measure: &Measure| measure.values.iter().filter(|&&value| value > 0.0).count();
                let (unproven, lit) = (count(doubts), count(lit));
                context.headline(format!("unproven: {} % of what is lit", percent(unproven, lit)));
                let so = "are lit as far as the points show, but no pulse proves their way to the sun free";
                context
                    .add(Remark::of_share("light-unproven", unproven, lit, "lit targets", so).map(Remark::into_note));
            }
        }
        _ => {
            let shares: Vec<f32> = measures.iter().map(|measure| to_f32(share(measure))).collect();
            context.headline(format!("{} suns on {places}: lit {}", suns.len(), spread(&shares, 1, "%")));
        }
    }
}
