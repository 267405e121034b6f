//! Light through trees.

use crate::scene::Inner;
use belvedere::apps::tree_light::{Leaves, Transmissivity, TreeLight};
use belvedere::control::Control;
use belvedere::{Error, Parameter};
use pyo3::prelude::*;

/// The share of light that passes through crowns, and whether they have leaves.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Through {
    share: Option<Share>,
    leaves: Option<String>,
}

#[derive(FromPyObject)]
enum Share {
    Number(f64),
    Name(String),
}

impl Through {
    /// The trees of a scene; `None` where they are opaque.
    pub(crate) fn of(&self, inner: &Inner, control: &Control<'_>) -> belvedere::Result<Option<TreeLight>> {
        let invalid = |parameter, value: &str, expected| {
            Err(Error::InvalidParameter { parameter, value: format!("'{value}'"), expected })
        };
        let by_season = matches!(&self.share, Some(Share::Name(name)) if name == "seasons");
        let leaves = match self.leaves.as_deref() {
            None => Leaves::ByDate,
            Some(leaves) if !by_season => {
                return invalid(Parameter::Leaves, leaves, "given with through_trees='seasons' only");
            }
            Some("auto") => Leaves::ByDate,
            Some("on") => Leaves::On,
            Some("off") => Leaves::Off,
            Some(leaves) => return invalid(Parameter::Leaves, leaves, "'auto', 'on' or 'off'"),
        };
        let model = &inner.model;
        let transmissivity = match &self.share {
            None => return Ok(None),
            Some(Share::Number(share)) => Transmissivity::constant(*share)?,
            Some(Share::Name(name)) => match name.as_str() {
                "none" => return Ok(None),
                "seasons" => Transmissivity::default(),
                "pulses" => {
                    Transmissivity::measured(model.balls(), model.transmission()).ok_or(Error::MissingAttribute {
                        attribute: "pulses in vegetation",
                        needed_for: "through_trees='pulses'",
                        advice: "use a cloud with return numbers, GPS times and preferably classes",
                    })?
                }
                _ => {
                    return invalid(
                        Parameter::Transmissivity,
                        name,
                        "'none', 'seasons', 'pulses', or a number from 0 to 1",
                    );
                }
            },
        };
        if !model.vegetation().contains(&true) {
            return Err(Error::MissingAttribute {
                attribute: "vegetation",
                needed_for: "through_trees",
                advice: "use a cloud with classes 3 to 5, or with return numbers and GPS times",
            });
        }
        TreeLight::new(model, &model.rule(), transmissivity, leaves, control).map(Some)
    }
}
