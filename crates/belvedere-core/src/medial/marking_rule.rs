//! What a rule of carving is: something that reads a survey and marks it.

use super::marks::Marks;
use super::survey::Survey;
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::Control;

/// When a rule marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Before there are balls: its caps shorten the search of the pulses.
    Points,
    /// After the pulses have carved the balls of the points.
    Balls,
}

/// A rule that marks a survey. Its parameters are the rule.
pub(super) trait MarkingRule: Sync {
    /// When it marks, and what progress calls that; `None` for what the survey and the model do by these parameters.
    fn stage(&self) -> Option<(Phase, &'static str)> {
        None
    }

    /// What it marks. Row i of `balls` is the ball of point i; there is none in [`Phase::Points`].
    ///
    /// # Errors
    /// [`Error::Cancelled`](belvedere_data::Error::Cancelled).
    fn marks(&self, survey: &Survey<'_>, balls: &MedialBalls, control: &Control<'_>) -> Result<Marks> {
        let _ = (survey, balls, control);
        Ok(Marks::default())
    }

    /// Name of its fills in the report.
    fn fills_name(&self) -> &'static str {
        ""
    }
}
