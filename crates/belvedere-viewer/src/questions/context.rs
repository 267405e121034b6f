//! Context of every question.

use crate::plans::Plans;
use crate::scene::PageScene;
use crate::scene_text::SceneText;
use belvedere::control::Control;

/// Scene, plans and progress that a question is answered with.
pub(crate) struct RequestContext<'a> {
    pub(crate) scene: &'a PageScene,
    /// The scene on command lines.
    pub(crate) text: &'a SceneText,
    /// Plans of all tabs.
    pub(crate) plans: &'a Plans,
    pub(crate) control: &'a Control<'a>,
}
