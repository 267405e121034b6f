//! Results of cells in parts, such as tile by tile, in the words and figures of one answer.

use super::answers::Answers;
use super::context::Context;
use super::how_sure::{EXPECTED, PROBABILITY, UNCERTAIN};
use super::irradiance;
use super::places::Places;
use super::question::Question;
use super::scene::{Scene, Whereabouts};
use super::sections::{MeasuresSection, PlacesReport};
use super::shadow;
use super::sky_view;
use super::sun::MAX_LISTED_SUNS;
use super::sun_hours;
use super::survey_parts::needs_whole;
use super::viewshed::ViewshedTargets;
use crate::targets::Measure;
use crate::viewshed::title_of_cells;
use belvedere_data::Result;
use belvedere_data::control::Control;

/// Puts a question to a scene of which only parts are in memory, about cells that were made before. Results are
/// measures.
///
/// # Errors
/// Those of [`Question::ask`]. [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for a question without
/// measures of cells.
pub fn ask_in_parts(question: &Question, scene: &Scene, places: &Places, control: &Control<'_>) -> Result<Answers<()>> {
    if question.needs_whole().is_some() {
        return Err(needs_whole());
    }
    Ok(question.ask(scene, places, control)?.map(|_| ()))
}

impl Question {
    /// Returns the first part of a question that needs all of a survey in memory; `None` for one that is answered part
    /// by part ([`ask_in_parts`]).
    #[must_use]
    pub fn needs_whole(&self) -> Option<&'static str> {
        let parts: &[(&str, bool)] = match self {
            Self::Shadow(shadow) => &[("what casts shadows", shadow.casters)],
            Self::Irradiance(energy) => &[("roof planes", energy.roofs.is_some())],
            Self::Viewshed(view) => &[
                ("targets other than cells", view.targets != [ViewshedTargets::Cells]),
                ("masks of observers", view.masks),
                ("heights that are seen", view.max_height.is_some()),
            ],
            Self::SunHours(_) | Self::SkyView(_) => &[],
            _ => return Some("a question without values of cells"),
        };
        parts.iter().find(|(_, is_wanted)| *is_wanted).map(|(what, _)| *what)
    }
}

/// Reports in `context` the answer of the measures of cells of a side, metres, to a question; returns the title of a
/// map. The words are those of [`ask`](super::ask) for a scene.
///
/// # Errors
/// [`InvalidParameter`](belvedere_data::Error::InvalidParameter) for a question that has no answers of cells in parts,
/// and for a site that is not known.
pub fn summarise_parts(
    question: &Question,
    (measures, cell): (&[Measure], f64),
    whereabouts: &Whereabouts<'_>,
    context: &mut Context,
) -> Result<String> {
    let count = measures.first().map_or(0, |first| first.values.iter().filter(|value| value.is_finite()).count());
    let places = PlacesReport::cells_in_words(count, cell);
    // the figures of the place are there already
    let mut aside = Context::default();
    let mut listed = measures;
    let answers = &measures[..measures.iter().position(says_how_sure).unwrap_or(measures.len())];
    let title = match question {
        Question::Shadow(about) => {
            let suns = about.suns.resolve(&about.place, whereabouts, &mut aside)?;
            shadow::summarise(&suns, answers, &places, context);
            about.how_sure.summarise_measures(measures, ["lit", "in shadow"], context);
            listed = &answers[..answers.len().min(MAX_LISTED_SUNS)];
            suns.first().map(|sun| sun.title.clone()).unwrap_or_default()
        }
        Question::SunHours(about) => {
            let site = about.place.site_at(whereabouts, &mut aside, None)?;
            let (plan, zone) = about.plan(&site)?;
            let title = about.title(&plan, &zone, whereabouts);
            sun_hours::summarise(&plan, &title, measures, &places, context);
            title
        }
        Question::SkyView(_) => {
            sky_view::summarise(measures, &places, context);
            sky_view::title(whereabouts)
        }
        Question::Irradiance(energy) => {
            irradiance::summarise(measures, &energy.radiation, &places, context);
            irradiance::title(whereabouts)
        }
        Question::Viewshed(about) => {
            about.summarise_parts(answers, (measures, cell), context);
            return Ok(title_of_cells(about.observers.len() == 1, about.reverse).to_owned());
        }
        _ => return Err(needs_whole()),
    };
    context.report.measures = Some(MeasuresSection::of_count(count, listed));
    Ok(title)
}

/// Returns true if a measure gives the certainty of others; it comes after these.
fn says_how_sure(measure: &Measure) -> bool {
    [PROBABILITY, UNCERTAIN, EXPECTED].iter().any(|name| measure.name.starts_with(name))
}
