//! Light through trees.

use crate::errors::wrong;
use belvedere::apps::ask::ThroughTrees;
use belvedere::apps::tree_light::Leaves;
use pyo3::prelude::*;

/// The share of light that passes through crowns, and whether they have leaves.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Through {
    share: Option<LightShare>,
    leaves: Option<String>,
}

#[derive(FromPyObject)]
enum LightShare {
    Number(f64),
    Name(String),
}

impl Through {
    /// Converts the keywords for the layer of questions.
    pub(crate) fn chosen(&self) -> PyResult<ThroughTrees> {
        let refused = |what: &str, value: &str, advice: &str| Err(wrong(what, &format!("'{value}'"), advice));
        let follows_leaves = matches!(&self.share, Some(LightShare::Name(name)) if name != "none");
        let leaves = match self.leaves.as_deref() {
            None => Leaves::ByDate,
            Some(leaves) if !follows_leaves => {
                let advice = "give it with through_trees='measured', 'seasons' or 'pulses' only";
                return refused("leaves", leaves, advice);
            }
            Some("auto") => Leaves::ByDate,
            Some("on") => Leaves::On,
            Some("off") => Leaves::Off,
            Some(leaves) => return refused("leaves", leaves, "use 'auto', 'on' or 'off'"),
        };
        match &self.share {
            None => Ok(ThroughTrees::default()),
            Some(LightShare::Number(share)) => Ok(ThroughTrees::Share(*share)),
            Some(LightShare::Name(name)) => match name.as_str() {
                "measured" => Ok(ThroughTrees::Measured(leaves)),
                "none" => Ok(ThroughTrees::Opaque),
                "seasons" => Ok(ThroughTrees::Seasons(leaves)),
                "pulses" => Ok(ThroughTrees::Pulses(leaves)),
                _ => refused(
                    "through_trees",
                    name,
                    "use 'measured', 'none', 'seasons', 'pulses', or a number from 0 to 1",
                ),
            },
        }
    }
}
