//! Scene of a page, and answers to all its requests. The page is answered by the server of this crate, or by the same
//! code inside the browser (`belvedere-web`).

use crate::loading::Loading;
use crate::plans::Plans;
use crate::questions;
use crate::questions::context::RequestContext;
use crate::reading::ReadingChoice;
use crate::replies::{QuestionReply, Refusal};
use crate::scene_text::SceneText;
use belvedere::control::Control;
use belvedere::crs::Crs;
use belvedere::io::{Output, write_kept_model};
use belvedere::model::DerivedParts;
use serde_json::json;
use std::io::Cursor;
use std::sync::Arc;

/// One scene, its plans, and the words for it.
#[derive(Clone, Default)]
pub struct Session {
    loading: Loading,
    text: SceneText,
    title: String,
    plans: Arc<Plans>,
}

impl Session {
    /// A session without a scene.
    #[must_use]
    pub fn new(title: String, text: SceneText) -> Self {
        Self { loading: Loading::default(), text, title, plans: Arc::default() }
    }

    /// Returns the handle that takes the scene.
    #[must_use]
    pub fn loading(&self) -> Loading {
        self.loading.clone()
    }

    /// Returns true if the answer at this path takes long: one at a time has all threads, and [`Session::ask`] answers
    /// it.
    #[must_use]
    pub fn is_question(path: &str) -> bool {
        ["ask/", "plans/", "plan-meshes/", "results/"].iter().any(|first| path.starts_with(first))
    }

    /// Returns the progress of preparing the scene, as JSON.
    #[must_use]
    pub fn state(&self) -> Vec<u8> {
        let now = self.loading.read();
        let stage = now.stages.current();
        let state = json!({
            "title": self.title,
            "stage": stage.map_or("", |stage| stage.name),
            "total": stage.map_or(0, |stage| stage.total),
            "done": stage.map_or(0, |stage| stage.done),
            "failure": now.failure,
            "remarks": now.remarks,
            "reading": now.reading,
            "mesh_count": now.meshes.len(),
            "results": now.results.iter().map(|file| file.describe()).collect::<Vec<_>>(),
            "shown": now.shown.map(|shown| shown.description.clone()),
            "scene": now.scene.map(|scene| scene.describe()),
        });
        state.to_string().into_bytes()
    }

    /// A part of the drawing: `points/N` and `colors/N` of a chunk, `meshes/N`, `balls`.
    ///
    /// # Errors
    /// [`Refusal::Missing`] for a part that is not there, or not yet.
    pub fn part(&self, path: &str) -> Result<Vec<u8>, Refusal> {
        let now = self.loading.now();
        let (kind, number) = path.split_once('/').unwrap_or((path, ""));
        let number = number.parse::<usize>().ok();
        let shown = now.shown.as_ref();
        let part = match (kind, number) {
            ("balls", None) => now.scene.map(|scene| questions::balls(&scene)),
            ("points", Some(chunk)) => shown.and_then(|shown| shown.chunks.points(chunk, &shown.cloud)),
            ("colors", Some(chunk)) => shown.and_then(|shown| shown.chunks.colors(chunk, &shown.cloud)),
            ("meshes", Some(mesh)) => now.meshes.get(mesh).map(|mesh| mesh.to_vec()),
            _ => None,
        };
        part.ok_or(Refusal::Missing("there is no such part of the cloud"))
    }

    /// Answers a question. `ask/NAME` is about the scene as it is, `plans/N/ask/NAME` about that with a plan, both with
    /// the question as JSON. `results/N` is a file of results; `plan-meshes/NAME` takes a mesh file for plans.
    ///
    /// The reply has three parts: the length of the head in 4 bytes, little endian; the head as JSON, padded with
    /// blanks to a multiple of 4 bytes; and a value for each of many places.
    ///
    /// `reading` has the cloud read in another way: a [`ReadingChoice`] as JSON.
    ///
    /// # Errors
    /// [`Refusal`], in words for people.
    pub fn ask(&self, path: &str, body: &[u8], control: &Control<'_>) -> Result<Vec<u8>, Refusal> {
        let now = self.loading.now();
        let scene = now.scene.ok_or(Refusal::NotReady)?;
        let text = self.text.read_as(&now.reading.unwrap_or_default());
        let (kind, rest) = path.split_once('/').unwrap_or((path, ""));
        let reply = match kind {
            "ask" => {
                let context = RequestContext { scene: &scene, text: &text, plans: &self.plans, control };
                questions::answer(rest, body, &context)?
            }
            "plans" => {
                let (number, name) = rest.split_once("/ask/").ok_or(NO_SUCH_QUESTION)?;
                let planned = self.plans.get(number.parse().map_err(|_| NO_SUCH_QUESTION)?)?;
                let context =
                    RequestContext { scene: &planned.scene, text: &planned.text, plans: &self.plans, control };
                questions::answer(name, body, &context)?
            }
            "results" => {
                let file = rest.parse::<usize>().ok().and_then(|number| now.results.get(number));
                file.ok_or(Refusal::Missing("there is no such file of results"))?.drawn(&scene, control)?
            }
            "plan-meshes" => {
                let number = self.plans.load(rest, body, scene.model().frame(), control)?;
                QuestionReply::of(json!({ "mesh": number, "name": rest }))
            }
            "reading" => {
                let refused = |error: serde_json::Error| Refusal::Unanswerable(error.to_string());
                let choice: ReadingChoice = serde_json::from_slice(body).map_err(refused)?;
                // one that cannot be used would end in a cloud that is not shown
                choice.crs().map(|crs| Crs::parse(&crs)).transpose()?;
                if !self.loading.read_again(choice) {
                    return Err(NO_SUCH_QUESTION);
                }
                self.plans.forget();
                QuestionReply::of(json!({}))
            }
            _ => return Err(NO_SUCH_QUESTION),
        };
        Ok(reply.into_bytes())
    }

    /// The scene with its derived data, to be kept for the next time (`read_kept_model`).
    ///
    /// # Errors
    /// [`Refusal::NotReady`], and those of [`write_kept_model`].
    pub fn scene_file(&self) -> Result<Vec<u8>, Refusal> {
        let scene = self.loading.now().scene.ok_or(Refusal::NotReady)?;
        let mut bytes = Cursor::new(Vec::new());
        let model = scene.model();
        // no question of a page needs normals
        let derived = DerivedParts { normals: None, ..model.derived() };
        write_kept_model(Output::writer("scene.npz", &mut bytes), model.parts(), &derived, "")?;
        Ok(bytes.into_inner())
    }

    /// Indexes the pulses that prove lines of sight free. Threads of the computing pool must find the index made if
    /// they cannot start threads of their own, as in a browser. Must not run on a thread of that pool.
    pub fn index_proof(&self) {
        if let Some(scene) = self.loading.now().scene {
            scene.index_proof();
        }
    }

    /// Makes the data that most questions need, so that the first one does not wait for them; not on a thread of the
    /// pool either.
    pub fn prepare(&self) {
        if let Some(scene) = self.loading.now().scene {
            scene.prepare();
        }
    }
}

impl std::fmt::Debug for Session {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Session").field("title", &self.title).finish_non_exhaustive()
    }
}

const NO_SUCH_QUESTION: Refusal = Refusal::Missing("there is nothing at this address");
