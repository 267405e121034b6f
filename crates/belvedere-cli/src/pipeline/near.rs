//! Of a survey that does not fit into memory, the part that a question about a few places can reach.

use crate::arguments::{MapPosition, MemoryArgument, SceneInput};
use crate::memory;
use crate::run::CommandContext;
use anyhow::Result;
use belvedere::apps::ask::Remark;
use belvedere::crs::Crs;
use belvedere::io::{cloud_files, read_las_head};
use belvedere_tiles::memory_of_whole;

/// How far around a question the scene is built, metres: points farther away change no ball that can block.
const AROUND: f64 = 128.0;

/// Places of a question, and how far from them it reaches.
pub(crate) struct QuestionReach<'a> {
    pub(crate) places: &'a [MapPosition],
    /// Metres on the map; `None` for any distance.
    pub(crate) distance: Option<f64>,
}

impl QuestionReach<'_> {
    /// The scene of the question: all of it, or where that takes more memory than may be used, the points around the
    /// places. A remark says so.
    pub(crate) fn of_scene(
        &self,
        scene: &SceneInput,
        memory: &MemoryArgument,
        run: &mut CommandContext,
    ) -> Result<SceneInput> {
        let (Some(distance), [first, rest @ ..]) = (self.distance, self.places) else { return Ok(scene.clone()) };
        let clouds = &scene.input.clouds;
        let (Some(limit), Some(whole)) = (memory::limit(memory.memory), memory_of_whole(clouds)) else {
            return Ok(scene.clone());
        };
        if whole <= limit {
            return Ok(scene.clone());
        }
        let metres_per_unit = match (&scene.input.crs, cloud_files(clouds)?.first()) {
            (Some(crs), _) => Crs::parse(crs)?.metres_per_unit,
            (None, Some(file)) => read_las_head(file.as_path())?.crs.metres_per_unit,
            (None, None) => 1.0,
        };
        let by = (distance + AROUND) / metres_per_unit;
        let mut window = [first.0, first.0];
        for MapPosition(place, _) in rest {
            for axis in 0..2 {
                window[0][axis] = window[0][axis].min(place[axis]);
                window[1][axis] = window[1][axis].max(place[axis]);
            }
        }
        let window = [window[0].map(|v| v - by), window[1].map(|v| v + by)];
        let [whole, limit] = [whole, limit].map(memory::in_gigabytes);
        let text = format!(
            "one model of this survey takes about {whole} GB of memory, and {limit} GB may be used: only points within {:.0} m of the question \
             were read",
            distance + AROUND
        );
        run.summary.remarks([Remark::note("part-of-survey", text).with("around_m", distance + AROUND)]);
        let mut part = scene.clone();
        part.input.window = Some(window);
        Ok(part)
    }
}
