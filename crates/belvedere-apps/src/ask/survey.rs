//! Remarks on the survey itself: lines that do not fit, surveys years apart, ground points only.

use super::remark::Remark;
use belvedere_core::model::{DatedSurvey, SurveyFindings};
use belvedere_core::strips::StripReport;
use belvedere_data::Frame;
use belvedere_data::report::rounded;

/// Names that a remark lists at most.
const MAX_NAMED: usize = 8;

/// Returns remarks on a survey, with places in the coordinates of a frame.
#[must_use]
pub fn remarks_on_survey(findings: &SurveyFindings, frame: &Frame) -> Vec<Remark> {
    let strips = findings.strips.as_ref().and_then(remark_on_strips);
    let surveys = (findings.surveys.len() > 1).then(|| remark_on_dates(findings, frame));
    let ground = findings.is_ground_only.then(|| {
        let text = "all points are ground (classes 2, 8 and 9): buildings and trees are missing, so that they throw no \
                    shadow and hide nothing; use the file with all classes";
        Remark::warning("ground-points-only", text)
    });
    let level = findings.is_level.then(|| {
        let text = "all points have one height: nothing throws a shadow or hides anything; heights were lost in an \
                    export, look for a file with them";
        Remark::warning("heights-are-equal", text)
    });
    let swapped = findings.ground_on_top.map(|share| {
        let percent = rounded(100.0 * share, 0);
        let text = format!(
            "in {percent} % of the cells with ground and buildings or plants the ground (class 2) lies above these: \
             classes are swapped; give the classes of the file their meaning first, or leave them out"
        );
        Remark::warning("ground-above-buildings", text).with("percent", percent)
    });
    let trajectory = findings.trajectory_miss_deg.map(|angle| {
        let text = format!(
            "pulses with several returns point {angle}\u{b0} past the trajectory: it is of another flight, or its \
             times are of another clock, such as UTC instead of GPS (18 s); leave it out, and the scanner is found \
             from the pulses"
        );
        Remark::warning("trajectory-contradicted", text).with("angle_deg", angle)
    });
    strips.into_iter().chain(surveys).chain(ground).chain(level).chain(swapped).chain(trajectory).collect()
}

fn remark_on_strips(strips: &StripReport) -> Option<Remark> {
    let most = strips.pairs.iter().max_by(|a, b| a.rise_m.abs().total_cmp(&b.rise_m.abs()))?;
    let (rise, [a, b]) = (rounded(most.rise_m.abs(), 2), most.lines);
    let differ = format!("flight lines differ in height by up to {rise} m (point sources {a} and {b})");
    let remark = match strips.moved.is_empty() {
        true => {
            let text = format!(
                "{differ} and were left so: what one line sees the other may block; fit them to each other, or read \
                 one survey with --lines"
            );
            Remark::warning("strips-differ", text)
        }
        false => {
            let moved: Vec<String> =
                strips.moved.iter().take(MAX_NAMED).map(|strip| format!("{} {:+.3}", strip.line, strip.up_m)).collect();
            let more = if strips.moved.len() > MAX_NAMED { ", \u{2026}" } else { "" };
            let text = format!(
                "{differ} and were fitted to each other, moved up by metres: {}{more}; keep them as they are with \
                 --keep-strips",
                moved.join(", ")
            );
            Remark::warning("strips-fitted", text)
        }
    };
    Some(remark.with("rise_m", rise))
}

fn remark_on_dates(findings: &SurveyFindings, frame: &Frame) -> Remark {
    let named = |survey: &DatedSurvey| {
        let [first, last] = &survey.days;
        let days = if first == last { first.clone() } else { format!("{first} to {last}") };
        let lines: Vec<String> = survey.lines.iter().take(MAX_NAMED).map(u16::to_string).collect();
        let more = if survey.lines.len() > MAX_NAMED { ", \u{2026}" } else { "" };
        format!("{days} (lines {}{more}; {} points)", lines.join(", "), survey.points)
    };
    let all: Vec<String> = findings.surveys.iter().take(MAX_NAMED).map(named).collect();
    let changed = findings.change.map_or(String::new(), |change| {
        let [x, y, _] = frame.file_from_local([change.at[0], change.at[1], 0.0]);
        format!(
            "; on {} m\u{b2} one of them has something that another has not, up to {:.1} m high, as at {:.0}, {:.0}",
            change.area_m2, change.max_m, x, y
        )
    });
    let text = format!(
        "the points are of {} surveys months apart: {}{changed}; read one with --dates or --lines",
        findings.surveys.len(),
        all.join("; ")
    );
    let remark = Remark::warning("surveys-apart", text).with("surveys", findings.surveys.len() as f64);
    match findings.change {
        Some(change) => remark.with("changed_m2", change.area_m2),
        None => remark,
    }
}
