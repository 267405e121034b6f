//! Every method by name, ready to be built from a survey.

use crate::medial::{MedialBaseline, MedialParams, Outward};
use crate::{Model, Survey};
use belvedere::Result;
use belvedere::query::Visibility;

/// A way of answering visibility, not built yet.
pub struct Method<'a> {
    /// Name on the command line and in file names: lower case, digits and hyphens.
    pub key: String,
    /// Name in tables.
    pub title: String,
    /// Its page below `docs/methods`, without the extension.
    pub page: &'static str,
    build: Box<dyn Fn() -> Result<Box<dyn Visibility + 'a>> + Sync + 'a>,
}

impl<'a> Method<'a> {
    fn new<V: Visibility + 'a>(
        key: impl Into<String>,
        title: impl Into<String>,
        page: &'static str,
        build: impl Fn() -> Result<V> + Sync + 'a,
    ) -> Self {
        let build = Box::new(move || build().map(|built| Box::new(built) as Box<dyn Visibility + 'a>));
        Self { key: key.into(), title: title.into(), page, build }
    }

    /// Builds it.
    ///
    /// # Errors
    /// Those of the method.
    pub fn build(&self) -> Result<Box<dyn Visibility + 'a>> {
        (self.build)()
    }
}

/// The methods that a survey allows, in the order of tables: those that need the cloud alone, then for each model those that
/// trace it.
#[must_use]
pub fn methods<'a>(survey: &'a Survey<'a>) -> Vec<Method<'a>> {
    let medial = |key: &str, title: &str, params: MedialParams| {
        Method::new(key, title, "medial-balls", move || MedialBaseline::new(survey, Outward::Survey, &params))
    };
    let mut methods = vec![
        medial("paper-cone", "paper as published (cone)", MedialParams::published()),
        medial("paper-sphere", "paper, spheres", MedialParams::published_with_spheres()),
        medial("union", "unfiltered union of balls", MedialParams::unfiltered_union()),
        medial("belvedere", "Belvedere, default balls", MedialParams::belvedere()),
    ];
    for Model { name, mesh } in survey.models {
        methods.push(Method::new(
            format!("paper-cone-{name}"),
            format!("paper as published, oriented by {name}"),
            "medial-balls",
            move || MedialBaseline::new(survey, Outward::Model(mesh), &MedialParams::published()),
        ));
    }
    methods
}
