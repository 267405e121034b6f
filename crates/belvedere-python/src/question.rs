//! Questions as data: nested dictionaries, whose keys are the fields of the library's questions.

use crate::errors::wrong;
use crate::scene::PyScene;
use crate::work::run;
use belvedere::apps::ask::{self, Answers, Ask, Question};
use belvedere::results::question_tags;
use pyo3::exceptions::{PyOverflowError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat};
use pythonize::Depythonizer;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, to_value};
use serde_path_to_error::{Path, Segment};
use std::sync::Arc;

/// A question, or a part of one. Fields that are left out have the library's defaults.
pub(crate) struct Data<T>(pub(crate) T);

impl<T: DeserializeOwned + Serialize> FromPyObject<'_, '_> for Data<T> {
    type Error = PyErr;

    fn extract(given: Borrowed<'_, '_, PyAny>) -> PyResult<Self> {
        let read = serde_path_to_error::deserialize(&mut Depythonizer::from_object(&given));
        let data: T = read.map_err(|error| refused(&given, &error.path().clone(), error.into_inner().into()))?;
        // a key that is not known would be left out in silence
        match to_value(&data).ok().and_then(|known| unknown_key(&given, &known)) {
            Some(key) => {
                Err(PyTypeError::new_err(format!("there is no field {key} of a question; please report this")))
            }
            None => Ok(Self(data)),
        }
    }
}

fn unknown_key(given: &Bound<'_, PyAny>, known: &Value) -> Option<String> {
    let (Ok(given), Value::Object(known)) = (given.cast::<PyDict>(), known) else { return None };
    given.iter().find_map(|(key, value)| match known.get(&key.to_string()) {
        Some(known) => unknown_key(&value, known),
        None => Some(key.to_string()),
    })
}

/// The error of a value of the wrong type, by the keyword that gives it.
fn refused(given: &Bound<'_, PyAny>, path: &Path, problem: PyErr) -> PyErr {
    let (mut value, mut name) = (given.clone(), "question");
    for segment in path {
        let next = match segment {
            Segment::Map { key } | Segment::Enum { variant: key } => {
                name = key;
                value.get_item(key)
            }
            Segment::Seq { index } => value.get_item(index),
            Segment::Unknown => break,
        };
        let Ok(next) = next else { break };
        value = next;
    }
    let advice = match value.cast::<PyFloat>() {
        _ if problem.is_instance_of::<PyOverflowError>(value.py()) => "give a number within its range".to_owned(),
        Ok(_) => "give a whole number".to_owned(),
        Err(_) => problem.value(value.py()).to_string(),
    };
    wrong(keyword(name), &value.repr().map_or_else(|_| String::new(), |text| text.to_string()), &advice)
}

/// The keyword of a field, where it has another name.
fn keyword(field: &str) -> &str {
    match field {
        "between" => "period",
        "class" => "target_class",
        "even" => "directions",
        "hours" => "between",
        "is_turning" => "turning",
        "parts" => "parts_per_row",
        "rules" => "rule",
        "share" => "through_trees",
        other => other,
    }
}

impl PyScene {
    /// Puts a question to the scene. Its measures have the metadata of the question beside their own.
    pub(crate) fn ask<Q>(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        question: Q,
        places: ask::Places,
    ) -> PyResult<Answers<Q::Found>>
    where
        Q: Ask<Found: Send + 'static> + Clone + Into<Question> + Send + 'static,
    {
        let (scene, named, named_places) = (Arc::clone(&self.0), question.clone(), places.clone());
        let mut answers = run(py, progress, move |control| ask::ask(&scene, &question, &places, control))?;
        let tags = question_tags(&named.into(), &named_places, answers.time_zone());
        for measure in &mut answers.measures {
            let is_new = |(name, _): &&(String, String)| measure.tags.iter().all(|(known, _)| known != name);
            let new: Vec<(String, String)> = tags.iter().filter(is_new).cloned().collect();
            measure.tags.extend(new);
        }
        Ok(answers)
    }
}
