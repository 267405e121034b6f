//! One run of a command: its stages, its summary, and the seed of its random numbers.

use crate::arguments::Global;
use crate::progress::CommandStages;
use crate::summary::Summary;
use belvedere::apps::ask::Answers;
use belvedere::cache::SceneCache;
use belvedere::control::{Control, Watcher};

/// Context of every command beside its arguments.
pub(crate) struct CommandContext {
    stages: CommandStages,
    pub(crate) summary: Summary,
    pub(crate) seed: u64,
    /// Cache of scenes.
    pub(crate) cache: Option<SceneCache>,
}

impl CommandContext {
    pub(crate) fn new(global: &Global) -> Self {
        let cache = crate::environment::cache(global);
        Self { stages: CommandStages::new(global), summary: Summary::default(), seed: global.seed, cache }
    }

    /// A run that `watcher` follows too.
    #[cfg(feature = "view")]
    pub(crate) fn watched(global: &Global, watcher: impl Watcher + Send + 'static) -> Self {
        Self { stages: CommandStages::new(global).watched(watcher), ..Self::new(global) }
    }

    /// Returns the control to which functions of the library report their stages.
    pub(crate) fn control(&self) -> Control<'_> {
        self.stages.control()
    }

    /// Runs one stage that can fail over `count` items (0: unknown).
    pub(crate) fn stage<T, E>(
        &self,
        name: &'static str,
        count: usize,
        work: impl FnOnce(&Control<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        self.stages.run(name, count, work, Result::is_ok)
    }

    /// Runs one stage that cannot fail.
    pub(crate) fn compute<T>(&self, name: &'static str, work: impl FnOnce() -> T) -> T {
        self.stages.run(name, 0, |_| work(), |_| true)
    }

    /// Reports on answers: the answer itself, all figures, and what a user must know beside them.
    pub(crate) fn answered<F>(&mut self, answers: &Answers<F>) {
        self.summary.add_report(&answers.report);
        answers.headline.iter().for_each(|line| self.summary.answer(line));
        self.summary.remarks(answers.remarks.iter().cloned());
    }

    /// Works with a summary of its own, which is handed back beside the result.
    pub(crate) fn aside<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> (T, Summary) {
        let before = std::mem::take(&mut self.summary);
        let result = work(self);
        (result, std::mem::replace(&mut self.summary, before))
    }

    /// The summary, with the seconds of each stage.
    pub(crate) fn finish(self) -> Summary {
        let Self { stages, mut summary, .. } = self;
        summary.add_seconds(stages.into_seconds());
        summary
    }
}
