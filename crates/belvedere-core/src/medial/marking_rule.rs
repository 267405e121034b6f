//! Interface of a carving rule: it reads a survey and returns marks.

use super::marks::Marks;
use super::survey::Survey;
use belvedere_data::Result;
use belvedere_data::balls::MedialBalls;
use belvedere_data::control::Control;

/// Phase in which a rule marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// Before there are balls: its caps shorten the search of the pulses.
    Points,
    /// After the pulses have carved the balls of the points.
    Balls,
}

/// A rule that marks a survey. Its parameters are the rule.
pub(super) trait MarkingRule: Sync {
    /// Returns the phase in which it marks, and the name of the step for progress. `None` for parameters that the
    /// survey and the model apply themselves.
    fn stage(&self) -> Option<(Phase, &'static str)> {
        None
    }

    /// Returns the marks. Row i of `balls` is the ball of point i; there is none in [`Phase::Points`].
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
