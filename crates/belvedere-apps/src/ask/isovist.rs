//! Isovist: the space that observers see, in numbers.

use super::answers::{Answered, Answers, Ask};
use super::context::{Context, spread};
use super::how_sure::check_interval_scene;
use super::north::North;
use super::observers::{Eyes, Observers, check_height};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, NamedValues};
use crate::isovist::{Isovist, IsovistFigure, IsovistParams, isovist, isovist_intervals};
use crate::result_columns::ResultColumn;
use belvedere_core::ground::GroundPoints;
use belvedere_core::query::UnprovenAs;
use belvedere_data::Result;
use belvedere_data::contradiction::SIGHT_LEAVES_ROOM;
use belvedere_data::control::Control;
use belvedere_data::report::rounded;
use belvedere_data::vector::to_f32;
use serde::{Deserialize, Serialize};

/// The space that observers see, in numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct IsovistsQuestion {
    /// Height above the ground of eyes without one, metres, 0 or more; `None` for 1.7.
    pub observer_height: Option<f64>,
    /// Source of ground points.
    pub ground: GroundPoints,
    /// North of azimuths, in the middle of the scene.
    pub north: North,
    /// Range at which sight ends where nothing blocks, metres, above 0; `None` for 100.
    pub max_distance: Option<f64>,
    /// Angle between rays, degrees, 0.036 to 90; `None` for 1.
    pub angle_step_deg: Option<f64>,
    /// Smallest jump in range that is an edge of the plan, metres, above 0; `None` for 0.25.
    pub min_jump: Option<f64>,
    /// True to give the intervals of areas and volumes that hold the truth in 90 % of cases; needs pulses. Default:
    /// false.
    pub interval: bool,
}

/// Isovists.
#[derive(Clone, Debug)]
pub struct IsovistsResults {
    /// Observers.
    pub eyes: Eyes,
    /// Isovist of each; `None` for an eye that cannot look.
    pub isovists: Vec<Option<Isovist>>,
    /// Azimuth of grid north from the north that azimuths count from, radians.
    pub grid_north: f64,
}

impl IsovistsQuestion {
    fn params(&self) -> IsovistParams {
        let usual = IsovistParams::default();
        usual
            .with_step(self.angle_step_deg.map_or(usual.step, f64::to_radians))
            .with_max_range(self.max_distance.unwrap_or(usual.max_range))
            .with_jump(self.min_jump.unwrap_or(usual.jump))
    }
}

impl Ask for IsovistsQuestion {
    type Found = IsovistsResults;

    fn check(&self) -> Result<()> {
        check_height(self.observer_height)?;
        self.params().validate()
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        check_interval_scene(self.interval, scene, control)?;
        let params = self.params();
        let Observers { eyes, blockers } =
            Observers::of(places, (self.observer_height, self.ground), scene, context, control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let north = self.north.of_scene(scene);
        context.north(&north);
        let isovists = control.stage("computing ranges", eyes.eyes.len(), || {
            let look = |&eye: &[f64; 3]| {
                let seen = eye[0].is_finite().then(|| isovist(&blockers, eye, &params, control)).transpose();
                control.advance(1);
                seen
            };
            eyes.eyes.iter().map(look).collect::<Result<Vec<_>>>()
        })?;
        let mut found = IsovistsResults { eyes, isovists, grid_north: north.of_grid };
        if self.interval {
            let blockers = scene.blockers(UnprovenAs::Reported, control)?;
            control.stage("computing probabilities", found.eyes.eyes.len(), || {
                for (isovist, &eye) in found.isovists.iter_mut().zip(&found.eyes.eyes) {
                    if let Some(isovist) = isovist {
                        isovist.intervals = isovist_intervals(&blockers, eye, isovist, &params, control)?;
                    }
                    control.advance(1);
                }
                Ok(())
            })?;
        }
        found.summarise(scene, context);
        Ok(Answers::new(found, Vec::new()))
    }
}

impl IsovistsResults {
    /// The numbers that describe each; none where nobody looks.
    #[must_use]
    pub fn columns(&self) -> Vec<ResultColumn> {
        let figures = |isovist: &Isovist| isovist.figures(self.grid_north).collect::<Vec<IsovistFigure>>();
        let rows: Vec<Option<Vec<IsovistFigure>>> =
            self.isovists.iter().map(|isovist| isovist.as_ref().map(figures)).collect();
        let Some(first) = rows.iter().flatten().next() else { return Vec::new() };
        let value = |row: &Option<Vec<IsovistFigure>>, at: usize| {
            row.as_ref().and_then(|row| row.get(at)).map_or(f64::NAN, |figure| figure.value)
        };
        let column = |(at, figure): (usize, &IsovistFigure)| {
            ResultColumn::real(figure.name, rows.iter().map(|row| value(row, at)), figure.decimals)
        };
        first.iter().enumerate().map(column).collect()
    }

    fn summarise(&self, scene: &Scene, context: &mut Context) {
        let columns = self.columns();
        if let ([place], [isovist]) = (&self.eyes.places[..], &self.isovists[..]) {
            let place = scene.frame().file_from_local(*place);
            let place = ["x", "y", "z"].into_iter().zip(place).map(|(name, v)| (name.to_owned(), rounded(v, 3)));
            let figures = isovist.iter().flat_map(|isovist| isovist.figures(self.grid_north));
            let figure = |figure: IsovistFigure| {
                (figure.name.to_owned(), rounded(figure.value, i32::try_from(figure.decimals).unwrap_or(4)))
            };
            context.report.isovist = Some(NamedValues(place.chain(figures.map(figure)).collect()));
        }
        let values = |name: &str| -> Vec<f32> {
            let column = columns.iter().find(|column| column.name == name);
            column.map_or_else(Vec::new, |column| column.numbers().iter().map(|&v| to_f32(v)).collect())
        };
        let count = self.isovists.len();
        let who = if count == 1 { "1 observer".to_owned() } else { format!("{count} observers") };
        context.headline(format!("space seen by {who}: volume {}", spread(&values("volume_m3"), 0, "m³")));
        let blocked = spread(&values("blocked_volume_m3"), 0, "m³");
        context.headline(format!("volume in the directions that hit something: {blocked}"));
        context.headline(format!("openness: {}", spread(&values("openness"), 3, "")));
        let [area, low, high] = ["plan_area_m2", "plan_area_low_m2", "plan_area_high_m2"].map(values);
        if let ([area], [low], [high]) = (&area[..], &low[..], &high[..]) {
            let ends = format!("nine times in ten {low:.0} to {high:.0}");
            context.headline(format!("area seen in the level plane: {area:.0} m²; {ends}"));
        }
        context.add(remark_on_gaps(&self.isovists));
        context.add(remark_on_doubtful_sight(&self.isovists));
    }
}

/// A note on rays that leave closed rooms; `None` where none does.
fn remark_on_gaps(isovists: &[Option<Isovist>]) -> Option<Remark> {
    let shares = || isovists.iter().flatten().map(|isovist| isovist.unbounded).filter(|&share| share > 0.0);
    let (count, most) = (shares().count(), rounded(100.0 * shares().fold(0.0, f64::max), 3));
    let text = format!(
        "{count} of {} observers are in a closed room, of which up to {most} % of the directions leave between its points: these are unbounded, and count up to the surface around",
        isovists.len()
    );
    let found = || SIGHT_LEAVES_ROOM.found(text).with("count", count as f64).with("percent", most);
    (count > 0).then(found).and_then(Remark::of_contradiction)
}

/// A note on isovists larger than their intervals say; `None` where there are none.
fn remark_on_doubtful_sight(isovists: &[Option<Isovist>]) -> Option<Remark> {
    let is_doubtful = |isovist: &&Isovist| {
        isovist.intervals.is_some_and(|ends| isovist.plan.area > ends.plan_area[1] || isovist.volume > ends.volume[1])
    };
    let count = isovists.iter().flatten().filter(is_doubtful).count();
    let text = format!(
        "for {count} of {} observers the area or the volume seen is larger than its interval: sight runs on where no \
         pulse was, such as over water or beyond the cloud; the answer takes that space for free, the interval does not",
        isovists.len()
    );
    (count > 0).then(|| Remark::note("isovist-above-interval", text).with("count", count as f64))
}
