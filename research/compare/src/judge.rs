//! One method on one place: built, queried, scored, timed.

use super::case::{ComparisonCase, STREET, STREET_GROUP, Set};
use super::results::{AblationRow, AnswerRow, AuditRow, CalibrationScore, Cost, MethodResult, MethodScore, Rated};
use super::scanners::ComparisonScanner;
use crate::memory::{reset_peak, resident_and_peak_mib};
use belvedere::apps::calibration::Calibration;
use belvedere::control::Control;
use belvedere::medial::{MedialBalls, NO_TOUCH};
use belvedere::query::{Answer, UnprovenAs, Visibility};
use belvedere_baselines::agreement::{Interval, Rate, TruthCounts, count_by_tile, interval, quantile};
use belvedere_baselines::audit::{BallVerdict, audit};
use belvedere_baselines::medial::{MedialBaseline, MedialParams, Outward, scene_model};
use belvedere_baselines::methods::{Method, PerEye};
use belvedere_scenes::Material;
use std::time::Instant;

/// Groups of views that rates are averaged over.
const GROUPS: [&str; 4] = ["suns", "observers", STREET_GROUP, "pairs"];
/// Observers in streets that are queried with methods that begin anew for each eye: with all forty they would take most
/// of the time.
const COSTLY_EYES: usize = 4;
/// Share of the observers that see worse than the figure given for the worst of them.
const WORST_SHARE: f64 = 0.1;
/// The set and the view that pictures show.
pub(super) const SHOWN_SET: &str = "PED";
pub(super) const SHOWN_VIEW: usize = 2;

/// What a method answered, for the picture.
pub(super) struct PictureAnswers {
    pub(super) answers: Vec<Answer>,
}

/// Builds `method` on `case` and runs all queries with it.
pub(super) fn judge(
    case: &ComparisonCase,
    method: &Method<'_>,
    (place, made_from, scanner): (&str, String, Option<ComparisonScanner>),
    seed: u64,
) -> (MethodResult, Option<PictureAnswers>) {
    let mut result = MethodResult {
        made_from,
        place: place.to_owned(),
        scanner,
        method: method.key.clone(),
        title: method.title.clone(),
        page: method.page.to_owned(),
        failed: None,
        cost: Cost::default(),
        scores: Vec::new(),
    };
    reset_peak();
    let before = resident_and_peak_mib();
    let start = Instant::now();
    let built = match method.build() {
        Ok(built) => built,
        Err(error) => {
            result.failed = Some(error.to_string());
            return (result, None);
        }
    };
    result.cost.build_seconds = start.elapsed().as_secs_f64();

    let replies = ask(case, built.as_ref(), method.per_eye);
    let views = replies.view_seconds.len().max(1);
    result.cost.seconds_per_view = replies.view_seconds.iter().sum::<f64>() / views as f64;
    result.cost.queries_per_second =
        (replies.query_count > 0).then(|| replies.query_count as f64 / replies.query_seconds.max(1e-9));
    result.cost.peak_mib = before.zip(resident_and_peak_mib()).map(|([now, _], [_, peak])| (peak - now).max(0.0));
    drop(built);
    for set in &case.sets {
        for group in GROUPS {
            let answered = replies.answers.iter().filter(|a| a.set == set.name && case.views[a.view].group == group);
            let (mut views, mut refused) = (Vec::new(), None);
            for one in answered {
                match &one.answers {
                    Ok(answers) => views.push(counts(set, one.view, answers)),
                    Err(reason) => refused = Some(reason.clone()),
                }
            }
            if views.is_empty() && refused.is_none() {
                continue;
            }
            let rate = |rate| rated(interval(&views, rate, seed));
            let of_group = replies
                .calibrations
                .iter()
                .filter(|(name, view, _)| *name == set.name && case.views[*view].group == group);
            let mut calibration = Calibration::default();
            of_group.for_each(|(.., of_view)| calibration.extend(of_view));
            result.scores.push(MethodScore {
                set: set.name.to_owned(),
                views: group.to_owned(),
                targets: set.targets.len(),
                false_blocked: rate(Rate::FalseBlocked),
                false_visible: rate(Rate::FalseVisible),
                balanced: rate(Rate::Balanced),
                blocked_iou: rate(Rate::BlockedIou),
                unanswered: rate(Rate::Unanswered),
                observers: views.len(),
                tenth_balanced: quantile(&views, Rate::Balanced, WORST_SHARE),
                calibration: (calibration.count() > 0).then(|| CalibrationScore {
                    brier: calibration.brier(),
                    expected_error: calibration.expected_error(),
                    error_of_most_certain: calibration.error_of_most_certain(),
                }),
                refused,
            });
        }
    }
    let shown = replies.answers.into_iter().find(|a| a.set == SHOWN_SET && a.view == SHOWN_VIEW);
    let shown = shown.and_then(|one| one.answers.ok()).map(|answers| PictureAnswers { answers });
    (result, shown)
}

/// The answers to one set in one view.
struct AnswerSet {
    set: &'static str,
    view: usize,
    answers: Result<Vec<Answer>, String>,
}

struct MethodAnswers {
    answers: Vec<AnswerSet>,
    view_seconds: Vec<f64>,
    query_count: usize,
    query_seconds: f64,
    /// By set and view.
    calibrations: Vec<(&'static str, usize, Calibration)>,
}

fn ask(case: &ComparisonCase, method: &dyn Visibility, per_eye: PerEye) -> MethodAnswers {
    let mut street_eyes = 0;
    let mut replies = MethodAnswers {
        answers: Vec::new(),
        view_seconds: Vec::new(),
        query_count: 0,
        query_seconds: 0.0,
        calibrations: Vec::new(),
    };
    for view in 0..case.views.len() {
        let sets = || case.sets.iter().filter(|set| set.truth.iter().any(|(number, _)| *number == view));
        let Some(first) = sets().next() else { continue };
        if case.views[view].group == STREET_GROUP {
            street_eyes += 1;
            if per_eye == PerEye::Costly && street_eyes > COSTLY_EYES {
                continue;
            }
        }
        let start = Instant::now();
        let sight = method.seen_from(case.viewer(view, first));
        let seconds = start.elapsed().as_secs_f64();
        let sight = match sight {
            Ok(sight) => {
                replies.view_seconds.push(seconds);
                sight
            }
            Err(error) => {
                let refused = |set: &Set| AnswerSet { set: set.name, view, answers: Err(error.to_string()) };
                replies.answers.extend(sets().map(refused));
                continue;
            }
        };
        for set in sets() {
            let start = Instant::now();
            let answers = sight(&set.targets);
            if answers.is_ok() {
                replies.query_seconds += start.elapsed().as_secs_f64();
                replies.query_count += set.targets.len();
            }
            if let Ok(answers) = &answers {
                let likely = method.probabilities(case.viewer(view, set), &set.targets).ok().flatten();
                replies.calibrations.push((set.name, view, calibrated(set, view, answers, likely.as_deref())));
            }
            let answers = answers.map_err(|error| error.to_string());
            replies.answers.push(AnswerSet { set: set.name, view, answers });
        }
    }
    replies
}

/// Probabilities with the truth; answers count as 0 and 1 where `likely` is not known.
fn calibrated(set: &Set, view: usize, answers: &[Answer], likely: Option<&[f32]>) -> Calibration {
    let mut calibration = Calibration::default();
    let Some((_, truth)) = set.truth.iter().find(|(number, _)| *number == view) else { return calibration };
    for (row, (truth, answer)) in truth.iter().zip(answers).enumerate() {
        let hard = match answer {
            Answer::Visible | Answer::Unproven => 1.0,
            Answer::Blocked | Answer::InsideObstacle => 0.0,
            _ => f32::NAN,
        };
        if let Some(is_visible) = truth {
            calibration.add(likely.and_then(|likely| likely.get(row)).copied().unwrap_or(hard), *is_visible);
        }
    }
    calibration
}

fn counts(set: &Set, view: usize, answers: &[Answer]) -> Vec<TruthCounts> {
    let truth = set.truth.iter().find(|(number, _)| *number == view);
    truth.map(|(_, truth)| count_by_tile(&set.tiles, truth, answers)).unwrap_or_default()
}

fn rated(interval: Option<Interval>) -> Option<Rated> {
    interval.map(|i| [i.value, i.low, i.high])
}

/// Share of the targets that are blocked in truth, for each set and group of views.
pub(super) fn blocked_in_truth(case: &ComparisonCase) -> Vec<(String, String, f64)> {
    let mut shares = Vec::new();
    for set in &case.sets {
        for group in GROUPS {
            let truths = set.truth.iter().filter(|(view, _)| case.views[*view].group == group);
            let known: Vec<bool> = truths.flat_map(|(_, truth)| truth.iter().flatten().copied()).collect();
            if !known.is_empty() {
                let blocked = known.iter().filter(|visible| !**visible).count();
                shares.push((set.name.to_owned(), group.to_owned(), blocked as f64 / known.len() as f64));
            }
        }
    }
    shares
}

/// What each of the three answers of carved balls is worth, by set and view; empty where the scanner is not known.
pub(super) fn worth_of_answers(case: &ComparisonCase) -> belvedere::Result<Vec<AnswerRow>> {
    let survey = case.survey();
    if survey.scanner.is_empty() {
        return Ok(Vec::new());
    }
    let params = MedialParams::carved();
    let model = scene_model(&survey, Outward::Survey, &params)?;
    let scene = model.scene(&params.blocking, UnprovenAs::Reported, &Control::none())?;
    let mut rows: Vec<AnswerRow> = Vec::new();
    for set in case.sets.iter().filter(|set| ["PED", "AIR", STREET].contains(&set.name)) {
        for (view, _) in &set.truth {
            let answers = scene.visible(case.viewer(*view, set), &set.targets)?;
            let counts =
                counts(set, *view, &answers).iter().fold(TruthCounts::default(), |sum, tile| sum.plus(tile, 1));
            let views = case.views[*view].title();
            let at = rows.iter().position(|row| row.set == set.name && row.views == views).unwrap_or_else(|| {
                rows.push(AnswerRow { set: set.name.to_owned(), views, ..AnswerRow::default() });
                rows.len() - 1
            });
            rows[at].add(&counts);
        }
    }
    Ok(rows)
}

/// Which of the published balls are wrong, by the surface they are tangent at, and the answers for people under the
/// suns if some of them were left out.
pub(super) fn audit_published(
    case: &ComparisonCase,
    seed: u64,
) -> belvedere::Result<(Vec<AuditRow>, Vec<AblationRow>)> {
    let survey = case.survey();
    let params = MedialParams::published_with_spheres();
    let balls = scene_model(&survey, Outward::Survey, &params)?.into_parts().balls;
    let (verdicts, audits) = audit(&balls, &case.place.cloud.positions, &case.sources, |p| case.is_inside(p));
    let rows = audits
        .iter()
        .map(|(surface, audit)| AuditRow {
            surface: surface.name().replace('_', " "),
            balls: audit.count,
            wrong: audit.wrong,
            flipped: audit.flipped,
            tilted: audit.tilted,
            bulging: audit.bulging(),
        })
        .collect();

    let of = |row: usize| case.sources.get(balls.source[row] as usize).copied().flatten().map(|source| source.kind);
    let mut unions: Vec<(String, Vec<bool>)> = vec![("all".to_owned(), vec![true; balls.len()])];
    let groups: [(&str, &[Material]); 4] = [
        ("without wrong balls of facades", &[Material::Facade]),
        ("without wrong balls of trees", &[Material::TreeCrown, Material::Trunk, Material::Leaf]),
        ("without wrong balls of slabs and bridges", &[Material::Slab, Material::Bridge]),
        ("without wrong balls of the ground", &[Material::Terrain]),
    ];
    for (name, materials) in groups {
        let kept = (0..balls.len()).map(|row| of(row).is_none_or(|kind| !materials.contains(&kind))).collect();
        unions.push((name.to_owned(), kept));
    }
    let right = verdicts.iter().map(|v| *v == BallVerdict::Right).collect();
    unions.push(("only balls whose centre lies in a solid (ground truth)".to_owned(), right));

    let mut ablation = Vec::new();
    for (name, kept) in unions {
        let mut some: MedialBalls = balls.clone();
        for (touch, kept) in some.touch.iter_mut().zip(&kept) {
            if !kept {
                *touch = NO_TOUCH;
            }
        }
        let some = some.shrunk();
        let number = some.len();
        let union = MedialBaseline::of_balls(&survey, some, &params)?;
        let mut views = Vec::new();
        for set in case.sets.iter().filter(|set| set.name == SHOWN_SET) {
            for (view, _) in set.truth.iter().filter(|(view, _)| case.views[*view].group == GROUPS[0]) {
                views.push(counts(set, *view, &union.visible(case.viewer(*view, set), &set.targets)?));
            }
        }
        let rate = |rate| rated(interval(&views, rate, seed));
        ablation.push(AblationRow {
            balls: name,
            number,
            false_blocked: rate(Rate::FalseBlocked),
            false_visible: rate(Rate::FalseVisible),
        });
    }
    Ok((rows, ablation))
}
