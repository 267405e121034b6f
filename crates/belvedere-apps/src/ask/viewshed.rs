//! Viewshed: cells, points and far terrain that observers see, or the places from where a target is seen.

mod in_parts;
mod limits;
mod question;
mod seen_targets;
mod spread;

pub use limits::{StandingObserver, ViewLimits};
pub use question::{ViewshedQuestion, ViewshedTargets};
pub use seen_targets::FarSeen;

use super::answers::{Answered, Answers, Ask};
use super::cells::GridCells;
use super::context::Context;
use super::known_ground::KnownGround;
use super::observers::{Eyes, check_height, note_enclosed, remark_on_footing, skip_unfit};
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{LinesSection, ObserversSection, SeenSection};
use super::standing::Reach;
use crate::eyes::{EyesReport, fault_of_target};
use crate::targets::{Measure, Targets, set_on_ground, set_on_terrain};
use crate::viewshed::{
    Observer, SightLimits, Viewshed as Seen, ViewshedParams, answers_of_bands, box_within_reach, cell_for, far_targets,
    terrain_within_reach, tested_height,
};
use belvedere_core::ground::{Ground, MapGrid};
use belvedere_core::query::{Answer, MedialScene, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::raster::Raster;
use belvedere_data::report::rounded;
use belvedere_data::{ElevationGrid, Error, Frame, Parameter, Result};
use seen_targets::{Sights, Things, remark_on_inside};
use std::sync::Arc;

/// Maximum number of eyes below the ground that are named one by one.
const MAX_NAMED: usize = 5;

/// Results of a viewshed.
pub struct ViewshedResults {
    /// The eyes of observers, or the target of a reverse viewshed, local metres; NaN for those that are skipped.
    pub eyes: Vec<[f64; 3]>,
    /// True for a reverse viewshed.
    pub reverse: bool,
    /// The ground of the cells.
    pub ground: Arc<KnownGround>,
    /// Results for the cells on the ground, if wanted.
    pub cells: Option<Seen>,
    /// Certainty of these answers, if wanted: measures of the cells.
    pub cells_sure: Vec<Measure>,
    /// Results for the points, if wanted.
    pub points: Option<Seen>,
    /// Certainty of these answers, if wanted: measures of the points.
    pub points_sure: Vec<Measure>,
    /// Results for far terrain, if wanted.
    pub far: Option<FarSeen>,
    /// Lowest visible heights above the ground, metres, where they were wanted
    /// ([`crate::viewshed::min_visible_heights`]).
    pub heights: Option<Raster<f32>>,
}

impl ViewshedQuestion {
    /// The cells that it looks at, on the ground.
    #[must_use]
    pub fn grid_cells(&self) -> GridCells {
        let [_, height] = self.heights();
        GridCells { cell: self.cell, height: Some(tested_height(height)), ground: self.ground, ..GridCells::default() }
    }

    /// Returns the eyes of its observers, and their height above the ground, metres, if the ground gives their heights.
    pub fn standing(&self) -> impl Iterator<Item = ([f64; 3], f64)> {
        let [usual, _] = self.heights();
        self.observers.iter().map(move |one| (one.standing.place, one.standing.height.unwrap_or(usual)))
    }

    /// Says in `context` where the eyes of a survey in parts are, local metres, and how high above the ground the only
    /// one is, if that is known.
    pub fn report_eyes_of_parts(
        &self,
        eyes: &[[f64; 3]],
        above_ground: Option<f64>,
        frame: &Frame,
        context: &mut Context,
    ) {
        let mut section =
            ObserversSection { eyes: EyesReport::none_skipped(eyes.len()), ..ObserversSection::default() };
        if let [eye] = eyes {
            section.eye = Some(frame.file_from_local(*eye).map(|v| rounded(v, 3)));
            section.above_ground_m = above_ground.map(|height| rounded(height, 3));
        }
        match self.reverse {
            true => context.report.target = Some(section),
            false => context.report.observers = Some(section),
        }
    }

    /// Reports in `context` the visibility of cells of a side, metres, from the measure of free cells and that of the
    /// unproven ones among them. `all` may contain the certainty of the answers.
    pub(super) fn summarise_parts(&self, measures: &[Measure], (all, cell): (&[Measure], f64), context: &mut Context) {
        let answers = answers_of_bands(measures);
        let is_tested = measures.len() > 1;
        let inside_obstacle = context.report.places.targets_inside_obstacle.take();
        let counts = SeenSection::of(&answers, is_tested, &Things::cells(cell), context);
        context.add(inside_obstacle.and_then(|count| remark_on_inside(count, counts.targets, "cells")));
        let section = SeenSection { inside_obstacle, ..counts };
        let is_seen = |answer: &Answer| matches!(answer, Answer::Visible | Answer::Unproven);
        if self.observers.len() == 1 && !answers.iter().any(is_seen) {
            let text = format!("{}; {}", self.who_is_blind(), self.way_to_see());
            context.add(Some(Remark::warning("nothing-seen", text)));
        }
        context.report.cells = Some(section);
        self.how_sure.summarise_measures(all, ["visible", "blocked"], context);
        let report = context.report.observers.as_ref().map(|section| section.eyes.clone());
        self.headline_of_eyes(&report.unwrap_or_default(), context);
    }

    fn check_observers(&self) -> Result<()> {
        let invalid = |value: String, expected| Err(Error::invalid(Parameter::Observer, value, expected));
        match self.observers.len() {
            0 => invalid("missing".to_owned(), "given: who looks, or a target"),
            count @ 2.. if self.reverse => invalid(format!("one of {count} targets"), "the only one"),
            _ => Ok(()),
        }
    }

    /// Returns the limits of each observer, counted from grid north.
    fn sight_limits(&self, scene: &Scene, context: &mut Context) -> Result<Vec<SightLimits>> {
        let north = self.north.of_scene(scene);
        let of_one = |one: &StandingObserver| one.limits.or(&self.limits).sight_limits(north.of_grid);
        let limits = self.observers.iter().map(of_one).collect::<Result<Vec<_>>>()?;
        if limits.iter().any(|limits| limits.azimuth.is_some()) {
            context.north(&north);
        }
        Ok(limits)
    }

    /// The cells of the scene that are near enough to any observer.
    fn grid(&self, scene: &Scene, limits: &[SightLimits]) -> Result<MapGrid> {
        let reach = |(one, limits): (&StandingObserver, &SightLimits)| {
            let [x, y, _] = one.standing.place;
            ([x, y], limits.distance[1])
        };
        let reaches = self.observers.iter().zip(limits).map(reach);
        let (low, high) = box_within_reach(scene.model().bounds().on_map(), reaches);
        let [x, y, _] = scene.frame().origin;
        MapGrid::covering(low, high, self.cell.unwrap_or_else(|| cell_for(low, high)), [x, y])
    }

    /// The given places as eyes. A target often lies inside an obstacle: only the limits of the cloud count for it.
    fn eyes(
        &self,
        (blockers, ground): (&Arc<MedialScene>, &Ground),
        scene: &Scene,
        context: &mut Context,
        control: &Control<'_>,
    ) -> Result<Eyes> {
        let [usual, _] = self.heights();
        let mut places: Vec<[f64; 3]> = self.observers.iter().map(|one| one.standing.place).collect();
        let heights = || self.observers.iter().map(|one| one.standing.height.unwrap_or(usual));
        set_on_terrain(places.iter_mut().zip(heights()), scene.model());
        let is_on_ground: Vec<bool> = places.iter().map(|place| place[2].is_nan()).collect();
        set_on_ground(places.iter_mut().zip(heights()), ground);
        let feet =
            places.iter().zip(heights()).zip(is_on_ground).map(|((&[x, y, z], height), is_on_ground)| {
                if is_on_ground { [x, y, z - height] } else { [f64::NAN; 3] }
            });
        remark_on_footing(feet, ground, self.who(), scene, context);
        if let [place] = places[..]
            && self.reverse
            && fault_of_target(blockers, place).is_none()
        {
            return Ok(Eyes { eyes: places.clone(), places, report: EyesReport::none_skipped(1) });
        }
        let ground = Some(ground);
        skip_unfit(places, (self.who(), Reach::FarTerrain), (blockers, ground), (scene, context), control)
    }

    /// Refuses eyes that are not possible with far terrain, and notes where the terrain changes nothing.
    fn check_far_eyes(&self, eyes: &[[f64; 3]], blockers: &MedialScene, context: &mut Context) -> Result<()> {
        if blockers.far_terrain().grid().is_none() {
            return Ok(());
        }
        let who = self.who();
        let far = eyes.iter().position(|&eye| blockers.is_on_far_terrain(eye));
        if let (Some(row), Some(_)) = (far, self.max_height) {
            return Err(Error::invalid(
                Parameter::VisibleHeights,
                format!("wanted from {who} {}, on the terrain beyond the cloud", row + 1),
                "wanted from places in the cloud",
            ));
        }
        if far.is_none() && !self.wants(ViewshedTargets::FarTerrain) {
            let text =
                format!("the far terrain changes nothing: no {who} is on it, and nothing of it is among the targets");
            context.add(Some(Remark::note("terrain-changes-nothing", text)));
        }
        Ok(())
    }

    /// Reports on eyes, and notes those that are below the ground or inside the surface of an obstacle.
    fn report_eyes(&self, eyes: &Eyes, ground: &Ground, blockers: &MedialScene, scene: &Scene, context: &mut Context) {
        let who = self.who();
        let level_below = |&eye: &[f64; 3]| {
            let place = [eye[0], eye[1]];
            let terrain = blockers.far_terrain().grid().filter(|_| blockers.is_on_far_terrain(eye));
            terrain.map_or_else(|| ground.height_at(place), |terrain| terrain.height_at(place))
        };
        let mut section = ObserversSection { eyes: eyes.report.clone(), ..ObserversSection::default() };
        if let [eye] = &eyes.eyes[..] {
            section.eye = Some(scene.frame().file_from_local(*eye).map(|v| rounded(v, 3)));
            section.above_ground_m = level_below(eye).map(|level| rounded(eye[2] - level, 3));
        }
        let below = (1_usize..).zip(&eyes.eyes).filter_map(|(number, eye)| {
            let depth = level_below(eye)? - eye[2];
            (depth > 0.0).then_some((number, depth))
        });
        for (number, depth) in below.take(MAX_NAMED) {
            let text = format!("{who} {number} is {depth:.2} m below the ground");
            context.add(Some(Remark::note("eye-below-ground", text).with("depth_m", depth)));
        }
        note_enclosed(blockers, &eyes.eyes, who, context);
        match self.reverse {
            true => context.report.target = Some(section),
            false => context.report.observers = Some(section),
        }
    }

    /// Adds the observers as the last line of the answer.
    fn headline_of_eyes(&self, eyes: &EyesReport, context: &mut Context) {
        let (report, name) = match self.reverse {
            true => (&context.report.target, "target"),
            false => (&context.report.observers, "eye"),
        };
        let height = report.as_ref().and_then(|section| section.above_ground_m);
        match (height, eyes.count) {
            (Some(height), _) => context.headline(format!("{name} {height} m above the ground")),
            (None, 2..) => {
                let (count, skipped) = (eyes.count, eyes.skipped);
                context.headline(format!("observers: {count}, of which {skipped} cannot stand where they are"));
            }
            _ => {}
        }
    }

    /// The terrain beyond the cloud that observers may see.
    fn far_cells(&self, blockers: &MedialScene, observers: &[Observer]) -> Result<ElevationGrid> {
        let invalid = |value: &str, expected| Err(Error::invalid(Parameter::Terrain, value, expected));
        let Some(terrain) = blockers.far_terrain().grid() else {
            return invalid("missing", "given, where cells of it are among the targets");
        };
        let cells = terrain_within_reach(terrain, observers)?;
        if far_targets(blockers, &cells).next().is_none() {
            return invalid("without heights beyond the cloud within the maximum distance", "of a larger area");
        }
        Ok(cells)
    }
}

impl Ask for ViewshedQuestion {
    type Found = ViewshedResults;

    fn check(&self) -> Result<()> {
        self.earth.validate()?;
        self.limits.check()?;
        for one in &self.observers {
            one.limits.or(&self.limits).check()?;
        }
        let of_view = [
            (Parameter::Azimuth, self.limits.azimuth_range_deg),
            (Parameter::Elevation, self.limits.elevation_range_deg),
        ];
        if let Some((parameter, _)) = of_view.into_iter().find(|(_, range)| self.reverse && range.is_some()) {
            let expected = "left out with a target: it limits the view of one observer, and here there are many";
            return Err(Error::invalid(parameter, "given", expected));
        }
        self.how_sure.check()?;
        if self.wants(ViewshedTargets::FarTerrain) {
            let expected = "left out for terrain beyond the cloud: no pulse tells how likely it is seen";
            self.how_sure.check_without("given with far terrain", expected)?;
        }
        check_height(self.observer_height)?;
        check_height(self.target_height)?;
        match self.max_height {
            Some(height) if !(height >= 0.0) => Err(Error::invalid(Parameter::MaxHeight, height, "0 metres or more")),
            _ => Ok(()),
        }
    }

    fn answer(&self, scene: &Scene, places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        self.check_observers()?;
        self.how_sure.check_scene(scene)?;
        if self.unproven.is_some_and(|unproven| unproven != UnprovenAs::Visible) {
            scene.check_proof()?;
        }
        let limits = self.sight_limits(scene, context)?;
        if let Some(parts) = scene.parts() {
            return self.answer_in_parts(&**parts, limits, places, scene, context, control);
        }
        let known = scene.ground(self.grid(scene, &limits)?, self.ground, control)?;
        context.ground(scene.frame(), &known);
        let blockers = scene.blockers(self.unproven(), control)?;
        context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
        let ground = &known.ground;
        let eyes = self.eyes((&blockers, ground), scene, context, control)?;
        self.check_far_eyes(&eyes.eyes, &blockers, context)?;
        self.report_eyes(&eyes, ground, &blockers, scene, context);
        let observers: Vec<Observer> =
            eyes.eyes.iter().zip(limits).map(|(&eye, limits)| Observer { eye, limits }).collect();
        let terrain = match self.wants(ViewshedTargets::FarTerrain) {
            true => Some(self.far_cells(&blockers, &observers)?),
            false => None,
        };
        let params = ViewshedParams::default().with_earth(self.earth).with_unproven(self.unproven());
        let sights = Sights { question: self, scene, blockers: &blockers, observers: &observers, params };
        let is_of_cells = self.masks || self.wants(ViewshedTargets::Cells);
        let targets = match is_of_cells || self.max_height.is_some() {
            true => Some(sights.cells(ground, context, control)?),
            false => None,
        };
        let cells = match targets.as_ref().filter(|_| is_of_cells) {
            Some(targets) => Some(sights.of_cells((targets, ground.grid.cell), context, control)?),
            None => None,
        };
        let cells_sure = match (&targets, &cells) {
            (Some(targets), Some(seen)) => sights.sure_of(seen, &targets.positions, context, control)?,
            _ => Vec::new(),
        };
        let points = match self.wants(ViewshedTargets::Points) {
            true => Some(sights.of_points(context, control)?),
            false => None,
        };
        let points_sure = match &points {
            Some(seen) => sights.sure_of(seen, &scene.ground_cloud()?.positions, context, control)?,
            None => Vec::new(),
        };
        let far = terrain.map(|terrain| sights.of_terrain(terrain, context, control)).transpose()?;
        let open_ground = targets.as_ref().and_then(Targets::open_ground);
        let heights = match (self.max_height, &open_ground) {
            (Some(height), Some(ground)) => Some(sights.heights(height, ground, control)?),
            _ => None,
        };
        self.headline_of_eyes(&eyes.report, context);
        let (eyes, reverse) = (eyes.eyes, self.reverse);
        let (ground, found) = (known, Vec::new());
        let results = ViewshedResults { eyes, reverse, ground, cells, cells_sure, points, points_sure, far, heights };
        Ok(Answers::new(results, found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ask::how_sure::HowSure;
    use belvedere_core::query::EarthParams;

    #[test]
    fn what_no_viewshed_can_have_is_refused_before_a_scene_is_known() {
        let range = ViewLimits { azimuth_range_deg: Some([0.0, 90.0]), ..ViewLimits::default() };
        let far = ViewLimits { min_distance: Some(9.0), max_distance: Some(5.0), ..ViewLimits::default() };
        let usual = ViewshedQuestion::default();
        assert!(usual.check().is_ok());
        assert!(ViewshedQuestion { limits: range, ..usual.clone() }.check().is_ok());
        for wrong in [
            ViewshedQuestion { limits: range, reverse: true, ..usual.clone() },
            ViewshedQuestion { limits: far, ..usual.clone() },
            ViewshedQuestion { observer_height: Some(-1.0), ..usual.clone() },
            ViewshedQuestion { target_height: Some(f64::NAN), ..usual.clone() },
            ViewshedQuestion { max_height: Some(-1.0), ..usual.clone() },
            ViewshedQuestion { how_sure: HowSure { probability: false, certain: Some(0.5) }, ..usual.clone() },
            ViewshedQuestion {
                how_sure: HowSure { probability: true, certain: None },
                targets: vec![ViewshedTargets::FarTerrain],
                ..usual.clone()
            },
            ViewshedQuestion { earth: EarthParams { refraction: 1.0, ..EarthParams::default() }, ..usual },
        ] {
            assert!(wrong.check().is_err(), "{wrong:?}");
        }
    }
}
