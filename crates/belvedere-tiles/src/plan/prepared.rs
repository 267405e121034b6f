//! Questions before any tile is read: remarks, measures and lines of sight, from the answer for one unknown
//! cell.

use crate::plan::Plan;
use crate::plan::question::TileQuestion;
use belvedere::apps::ask::survey_parts::{Looks, SurveyParts};
use belvedere::apps::ask::{Answers, Places, Question, Scene, ask_in_parts};
use belvedere::apps::rows::ObstacleParts;
use belvedere::apps::targets::{Measure, TargetLayout, Targets};
use belvedere::apps::tree_light::{CrownLight, Season};
use belvedere::apps::viewshed::{Observer, SeenProbabilities, Viewshed, ViewshedParams};
use belvedere::control::Control;
use belvedere::ground::{Ground, GroundPoints, MapGrid};
use belvedere::medium::Medium;
use belvedere::model::{ModelParts, SceneModel};
use belvedere::query::{Answer, Certainty, EarthParams, FarTerrain, UnprovenAs, VisibilityMatrix};
use belvedere::raster::Raster;
use belvedere::results::{ADDED_BAND, ResultRaster};
use belvedere::{PointCloud, Result};
use std::sync::{Arc, Mutex, PoisonError};

/// Question with what follows from it and the plan alone.
pub(crate) struct PreparedQuestion {
    /// The question with its observers and its weather.
    pub(crate) question: Question,
    /// Remarks, report and measures without values.
    pub(crate) answers: Answers<()>,
    /// Lines of sight from cells.
    pub(crate) lines: SightLines,
}

/// Lines of sight from cells.
#[derive(Clone, Debug)]
pub(crate) enum SightLines {
    /// To light from above: unit vectors.
    Directions(Vec<[f64; 3]>),
    /// To observers, over the curved earth.
    Observers(Vec<Observer>, EarthParams),
}

impl SightLines {
    /// Returns the directions of light; none for observers.
    pub(crate) fn directions(&self) -> &[[f64; 3]] {
        match self {
            Self::Directions(directions) => directions,
            Self::Observers(..) => &[],
        }
    }
}

impl PreparedQuestion {
    /// Returns the raster of no cell: its bands, kind and description.
    pub(crate) fn bands(&self) -> Result<ResultRaster> {
        ResultRaster::of_measures(&self.answers.measures, [0, 0])
    }
}

impl Plan {
    /// Returns a survey as a scene of questions about its cells, before the terrain beyond it.
    pub(crate) fn scene(&self, parts: Arc<dyn SurveyParts>, far: FarTerrain) -> Result<Scene> {
        let parts_of_model = ModelParts { frame: self.frame()?, bounds: self.bounds(), ..ModelParts::default() };
        Ok(Scene::in_parts(SceneModel::from_parts(parts_of_model)?.with_far_terrain(far), parts))
    }

    /// Returns the measure that says which cells stand on a planned object, beside `measures`; `None` without planned
    /// objects. `on_added` flags the cells; it may be empty.
    pub(crate) fn added_band(&self, measures: &[Measure], on_added: &[bool]) -> Option<Measure> {
        let first = measures.first().filter(|_| !self.meshes.is_empty())?;
        let value = |(row, value): (usize, &f32)| match value.is_nan() {
            true => f32::NAN,
            false => f32::from(u8::from(on_added.get(row) == Some(&true))),
        };
        let values = first.values.iter().enumerate().map(value).collect();
        Some(Measure::new(ADDED_BAND, values).with_kind(first.kind))
    }

    /// Asks a question about one cell of which nothing is known.
    ///
    /// # Errors
    /// Those of the question, and of reading weather.
    pub(crate) fn prepared(
        &self,
        question: &TileQuestion,
        far: FarTerrain,
        control: &Control<'_>,
    ) -> Result<PreparedQuestion> {
        let kept = question;
        let question = kept.whole()?;
        question.check()?;
        let unknown = Arc::new(UnknownCell {
            crowns: self.trees,
            proves: self.can_prove(),
            lines: Mutex::new(SightLines::Directions(Vec::new())),
        });
        let scene = self.scene(Arc::clone(&unknown) as Arc<dyn SurveyParts>, far)?;
        let grid = MapGrid { corner: [0.0; 2], cell: 1.0, width: 1, height: 1 };
        let nothing = || Raster::filled(1, 1, f32::NAN);
        let layout = TargetLayout::Cells(Box::new(Ground { grid, heights: nothing(), gaps: nothing() }));
        let targets = Targets::at(self.frame()?, vec![[f32::NAN; 3]], None, layout);
        let mut answers = ask_in_parts(&question, &scene, &Places::Targets(Arc::new(targets)), control)?;
        answers.headline.clear();
        kept.keep(&mut answers.measures);
        answers.measures.extend(self.added_band(&answers.measures, &[]));
        answers.measures = answers.measures.iter().map(|measure| measure.without_values()).collect();
        let lines = unknown.lines.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Ok(PreparedQuestion { question, answers, lines })
    }
}

/// Survey of which no obstacle is known yet; it keeps the lines of sight of its question.
struct UnknownCell {
    crowns: Option<CrownLight>,
    proves: bool,
    lines: Mutex<SightLines>,
}

impl UnknownCell {
    fn keep(&self, lines: SightLines) {
        *self.lines.lock().unwrap_or_else(PoisonError::into_inner) = lines;
    }
}

impl SurveyParts for UnknownCell {
    fn crowns(&self) -> Option<CrownLight> {
        self.crowns
    }

    fn proves(&self) -> bool {
        self.proves
    }

    fn ground_points(&self) -> GroundPoints {
        GroundPoints::Auto
    }

    fn points_over(&self, _: &MapGrid, _: &Control<'_>) -> Result<Arc<PointCloud>> {
        Ok(Arc::default())
    }

    fn light(&self, _: &[[f32; 3]], directions: &[[f64; 3]], _: &Control<'_>) -> Result<Box<dyn ObstacleParts>> {
        self.keep(SightLines::Directions(directions.to_vec()));
        Ok(Box::new(UnknownLight { crowns: self.crowns, proves: self.proves }))
    }

    fn viewshed(
        &self,
        looks: &Looks<'_>,
        targets: &[[f32; 3]],
        params: &ViewshedParams,
        _: &Control<'_>,
    ) -> Result<Viewshed> {
        self.keep(SightLines::Observers(looks.observers.to_vec(), params.earth));
        let is_tested = self.proves && params.unproven == UnprovenAs::Reported;
        Ok(Viewshed {
            answers: vec![Answer::OutsideView; targets.len()],
            counts: vec![0; targets.len()],
            unproven_counts: if is_tested { vec![0; targets.len()] } else { Vec::new() },
            masks: Vec::new(),
            seen_counts: vec![0; looks.observers.len()],
        })
    }

    fn seen_probabilities(
        &self,
        _: &Looks<'_>,
        targets: &[[f32; 3]],
        certainty: Option<Certainty>,
        _: &Control<'_>,
    ) -> Result<SeenProbabilities> {
        let unknown = vec![f32::NAN; targets.len()];
        Ok(SeenProbabilities { uncertain: certainty.map(|_| unknown.clone()), expected: unknown })
    }
}

/// Light to targets without a position.
struct UnknownLight {
    crowns: Option<CrownLight>,
    proves: bool,
}

impl ObstacleParts for UnknownLight {
    fn crowns(&self) -> Option<CrownLight> {
        self.crowns
    }

    fn medium(&self) -> Option<&Medium> {
        None
    }

    fn look(
        &self,
        targets: &[[f32; 3]],
        directions: &[[f64; 3]],
        _: &Control<'_>,
    ) -> Result<(VisibilityMatrix, Option<VisibilityMatrix>)> {
        let words = vec![0; targets.len() * directions.len().div_ceil(64)];
        let nothing = VisibilityMatrix::from_words(targets.len(), directions.len(), words)?;
        let without = matches!(self.crowns, Some(CrownLight::Share { .. })).then(|| nothing.clone());
        Ok((nothing, without))
    }

    fn are_inside_obstacles(&self, targets: &[[f32; 3]], _: &Control<'_>) -> Result<Vec<bool>> {
        Ok(vec![false; targets.len()])
    }

    fn unproven_light(
        &self,
        targets: &[[f32; 3]],
        _: [f64; 3],
        _: &[f32],
        _: &Control<'_>,
    ) -> Result<Option<Vec<f32>>> {
        Ok(self.proves.then(|| vec![0.0; targets.len()]))
    }

    fn lit_probabilities(
        &self,
        targets: &[[f32; 3]],
        _: [f64; 3],
        _: Option<Season>,
        _: &Control<'_>,
    ) -> Result<Vec<f32>> {
        Ok(vec![f32::NAN; targets.len()])
    }
}
