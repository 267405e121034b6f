//! Horizon: above which elevation the sky is free around observers.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::how_sure::check_interval_scene;
use super::north::North;
use super::observers::{Eyes, Observers, check_height};
use super::places::{EDGE_WARNING_PERCENT, Places};
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{HorizonsSection, LinesSection};
use crate::edge::horizon_share_near_edge;
use crate::horizon::{HorizonParams, azimuth_count, horizon_intervals, horizons};
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::{EarthParams, SkylinePoint, UnprovenAs};
use belvedere_data::Result;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use serde::{Deserialize, Serialize};

/// Minimum elevation at which the zenith itself counts as covered, degrees: 90 less rounding.
const OVERHEAD_DEG: f64 = 89.999;

/// Above which elevation the sky is free around observers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct HorizonQuestion {
    /// Height above the ground of eyes without one, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// Angle between azimuths, degrees, a divisor of 360; `None` for 1.
    pub angle_step_deg: Option<f64>,
    /// Curvature of the earth on lines of sight.
    pub earth: EarthParams,
    /// North of azimuths, at the first observer.
    pub north: North,
    /// Treatment of elevations below the horizontal plane through the observer.
    pub below: BelowLevel,
    /// True to give the interval of elevations that holds the horizon in 90 % of cases; needs pulses. Default: false.
    pub interval: bool,
}

/// Treatment of elevations below the horizontal plane through the observer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum BelowLevel {
    /// 0, as tools of photovoltaics expect. Default.
    #[default]
    Zero,
    /// They are kept; -90 degrees where nothing blocks.
    Keep,
}

/// Horizons.
#[derive(Clone, Debug)]
pub struct HorizonResults {
    /// Observers.
    pub eyes: Eyes,
    /// Azimuths of each, equally far apart, clockwise from north.
    pub azimuth_count: usize,
    /// Elevation at each azimuth, degrees; none for an eye that cannot look.
    pub elevations_deg: Vec<Vec<f64>>,
    /// Between which elevations the sky begins nine times in ten, degrees; `None` where that was not wanted.
    pub intervals_deg: Option<Vec<Vec<[f64; 2]>>>,
}

impl HorizonQuestion {
    fn azimuth_count(&self) -> Result<usize> {
        match self.angle_step_deg {
            Some(step) => azimuth_count(step.to_radians()),
            None => Ok(HorizonParams::default().azimuth_count),
        }
    }
}

impl Ask for HorizonQuestion {
    type Found = HorizonResults;

    fn check(&self) -> Result<()> {
        check_height(self.observer_height)?;
        self.earth.validate()?;
        self.azimuth_count().map(|_| ())
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        check_interval_scene(self.interval, scene, control)?;
        let azimuth_count = self.azimuth_count()?;
        let Observers { eyes, blockers } =
            Observers::of(places, (self.observer_height, self.ground), scene, context, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let north = match eyes.places.first() {
            Some(&[x, y, _]) => self.north.at(scene, [x, y]),
            None => self.north.of_scene(scene),
        };
        context.north(&north);
        let params =
            HorizonParams::default().with_azimuth_count(azimuth_count).with_turn(north.of_grid).with_earth(self.earth);
        let skylines = control
            .stage("computing horizons", eyes.eyes.len(), || horizons(&blockers, &eyes.eyes, &params, control))?;
        let min = if self.below == BelowLevel::Zero { 0.0 } else { -90.0 };
        let elevations_deg: Vec<Vec<f64>> = skylines
            .iter()
            .map(|skyline| skyline.iter().map(|point| point.elevation.to_degrees().max(min)).collect())
            .collect();
        let within = self.interval.then(|| {
            control.stage("computing probabilities", eyes.eyes.len(), || {
                let blockers = scene.blockers(UnprovenAs::Reported, control)?;
                horizon_intervals(&blockers, &eyes.eyes, &skylines, &params, control)
            })
        });
        let in_degrees = |ends: &[f64; 2]| ends.map(|v| v.to_degrees().max(min));
        let intervals_deg: Option<Vec<Vec<[f64; 2]>>> =
            within.transpose()?.map(|all| all.iter().map(|of_eye| of_eye.iter().map(in_degrees).collect()).collect());
        let near_edge = near_edge_percent(scene, &eyes, &skylines, -north.of_grid);
        let section = HorizonsSection::of(&elevations_deg, intervals_deg.as_deref(), near_edge);
        context.report.horizons = Some(section);
        context.add(remark_on_overhead(&elevations_deg));
        section.summarise(eyes.eyes.len(), context);
        Ok(Answers::new(HorizonResults { eyes, azimuth_count, elevations_deg, intervals_deg }, Vec::new()))
    }
}

/// A warning of observers who have something straight above them: their horizon is the zenith, all around.
fn remark_on_overhead(elevations_deg: &[Vec<f64>]) -> Option<Remark> {
    let is_covered = |elevations: &&Vec<f64>| !elevations.is_empty() && elevations.iter().all(|v| *v >= OVERHEAD_DEG);
    let count = elevations_deg.iter().filter(is_covered).count();
    let who = if elevations_deg.len() == 1 { "the observer".to_owned() } else { format!("{count} observers") };
    let text = format!(
        "something stands straight above {who}, such as a tree or eaves: the horizon there is 90 degrees all around; \
         move a step aside, or give a height above it"
    );
    (count > 0).then(|| Remark::warning("covered-overhead", text).with("count", count as f64))
}

/// The mean share of azimuths at which something beyond the edge of the cloud could be the horizon; `None` where the
/// edge is not known. The first azimuth from grid north is `first`, radians.
fn near_edge_percent(scene: &Scene, eyes: &Eyes, skylines: &[Vec<SkylinePoint>], first: f64) -> Option<f64> {
    let coverage = scene.model().coverage()?;
    let known = || eyes.eyes.iter().zip(skylines).filter(|(eye, _)| eye[0].is_finite());
    let shares = known().map(|(eye, skyline)| horizon_share_near_edge(&coverage, *eye, skyline, first));
    Some(rounded(100.0 * (shares.sum::<f64>() / known().count().max(1) as f64), 2))
}

impl HorizonsSection {
    fn of(
        elevations: &[Vec<f64>],
        intervals: Option<&[Vec<[f64; 2]>]>,
        azimuths_near_edge_percent: Option<f64>,
    ) -> Self {
        let widths = |all: &[Vec<[f64; 2]>]| all.iter().flatten().map(|[low, high]| high - low).sum::<f64>();
        let all = || elevations.iter().flatten().copied();
        let count = elevations.iter().map(Vec::len).sum::<usize>().max(1);
        Self {
            azimuths: elevations.iter().map(Vec::len).max().unwrap_or(0),
            mean_elevation_deg: rounded(all().sum::<f64>() / count as f64, 3),
            max_elevation_deg: rounded(all().fold(-90.0, f64::max), 3),
            mean_interval_deg: intervals.map(|all| rounded(widths(all) / count as f64, 3)),
            azimuths_near_edge_percent,
        }
    }

    fn summarise(&self, observers: usize, context: &mut Context) {
        let Self { azimuths, mean_elevation_deg, max_elevation_deg, .. } = self;
        let who = if observers == 1 { "1 observer".to_owned() } else { format!("{observers} observers") };
        context.headline(format!("horizon of {who} at {azimuths} azimuths"));
        context.headline(format!("elevation: mean {mean_elevation_deg} degrees, at most {max_elevation_deg}"));
        if let Some(width) = self.mean_interval_deg {
            context.headline(format!("nine times in ten within an interval: {width} degrees wide on average"));
        }
        if let Some(share) = self.azimuths_near_edge_percent.filter(|share| *share >= EDGE_WARNING_PERCENT) {
            let text = format!(
                "{share} % of the azimuths are near the edge of the cloud: objects beyond it, as high as its highest point, could stand above the horizon"
            );
            context.add(Some(Remark::warning("horizon-near-edge", text).with("percent", share)));
        }
    }
}
