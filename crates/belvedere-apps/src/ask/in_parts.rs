//! Results of cells in parts, such as tile by tile, in the words and figures of one answer.

use super::context::Context;
use super::how_sure::{EXPECTED, PROBABILITY, UNCERTAIN};
use super::irradiance;
use super::question::Question;
use super::scene::Whereabouts;
use super::sections::{MeasuresSection, PlacesReport};
use super::shadow;
use super::sky_view;
use super::sun::MAX_LISTED_SUNS;
use super::sun_hours;
use crate::targets::Measure;
use crate::viewshed::title_of_cells;
use belvedere_data::{Error, Parameter, Result};

/// Reports in `context` the answer of the measures of cells of a side, metres, to a question; returns the title of a
/// map. The words are those of [`ask`](super::ask) for a scene.
///
/// # Errors
/// [`Error::InvalidParameter`] for a question that has no answers of cells in parts, and for a site that is not known.
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
        _ => {
            let (value, expected) =
                ("another".to_owned(), "about shadow, sun hours, sky view, irradiance or viewsheds");
            return Err(Error::invalid(Parameter::Questions, value, expected));
        }
    };
    context.report.measures = Some(MeasuresSection::of_count(count, listed));
    Ok(title)
}

/// Returns true if a measure gives the certainty of others; it comes after these.
fn says_how_sure(measure: &Measure) -> bool {
    [PROBABILITY, UNCERTAIN, EXPECTED].iter().any(|name| measure.name.starts_with(name))
}
