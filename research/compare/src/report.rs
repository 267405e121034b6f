//! Tables of what was found: as text, Markdown and a page with pictures.

use super::case::{STREET, STREET_GROUP};
use super::pictures::LEGEND;
use super::results::{AnswerRow, CalibrationScore, HeldOutResult, MethodResult, MethodScore, PlaceResult, Rated, keep};
use super::scanners::PICTURE as CURVES;
use super::table::TextTable;
use anyhow::{Context, Result, bail};
use belvedere::io::atomic;
use belvedere_baselines::agreement::{Interval, over_places};
use serde_json::Value;
use std::io::Write;
use std::path::Path;

/// Sets and views that the tables show, with their heading.
const COLUMNS: [(&str, &str, &str); 13] = [
    ("AIR", "suns", "AIR sun"),
    ("PED", "suns", "PED sun"),
    ("GRD", "suns", "GRD sun"),
    ("ROOF", "suns", "ROOF sun"),
    ("FACADE", "suns", "FACADE sun"),
    ("VOL", "suns", "VOL sun"),
    ("OWN", "suns", "OWN sun"),
    ("AIR", "observers", "AIR eye"),
    ("PED", "observers", "PED eye"),
    ("FACADE", "observers", "FACADE eye"),
    ("OWN", "observers", "OWN eye"),
    (STREET, STREET_GROUP, "street"),
    ("LOS", "pairs", "LOS"),
];
/// What a terminal shows of them: balanced accuracy, that of the worst tenth of the observers where the heading says
/// `p10`, or both kinds of error where it says `err`.
const ESSENCE: [(&str, &str, &str); 13] = [
    ("AIR", "suns", "AIR sun"),
    ("PED", "suns", "PED sun"),
    ("PED", "suns", "err"),
    ("ROOF", "suns", "ROOF sun"),
    ("FACADE", "suns", "FACADE sun"),
    ("OWN", "suns", "OWN sun"),
    ("PED", "observers", "PED eye"),
    ("PED", "observers", "err"),
    (STREET, STREET_GROUP, "street"),
    (STREET, STREET_GROUP, "p10"),
    (STREET, STREET_GROUP, "err"),
    ("LOS", "pairs", "LOS"),
    ("LOS", "pairs", "err"),
];
/// Lines between which tables are put into a page.
const PAGE_MARKS: [&str; 2] = ["<!-- tables -->", "<!-- end of tables -->"];
/// Key of the method that the others are compared with.
const CARVED: &str = "carved";
/// Seed of the resampling of places.
const SEED: u64 = 1;

/// Everything that a comparison found.
#[derive(Default)]
pub(super) struct ComparisonResults {
    pub(super) places: Vec<PlaceResult>,
    pub(super) methods: Vec<MethodResult>,
    pub(super) held_out: Vec<HeldOutResult>,
}

impl ComparisonResults {
    /// Writes report.json, report.md and report.html into `folder`, and the tables into `page`.
    pub(super) fn write(&self, folder: &Path, page: Option<&Path>) -> Result<()> {
        keep(&folder.join("report.json"), &self.to_json()?)?;
        let has_curves = self.write_curves(&folder.join("pictures"))?;
        let tables = self.tables();
        let markdown: String = tables.iter().map(TextTable::to_markdown).collect();
        write_text(&folder.join("report.md"), &markdown)?;
        write_text(&folder.join("report.html"), &self.to_html(&tables, has_curves))?;
        if let Some(page) = page {
            let text = std::fs::read_to_string(page).with_context(|| page.display().to_string())?;
            let parts = text
                .split_once(PAGE_MARKS[0])
                .and_then(|(before, rest)| rest.split_once(PAGE_MARKS[1]).map(|(_, after)| (before, after)));
            let Some((before, after)) = parts else {
                bail!(
                    "{}: lines {} and {} are missing; the tables go between them",
                    page.display(),
                    PAGE_MARKS[0],
                    PAGE_MARKS[1]
                );
            };
            let [begin, end] = PAGE_MARKS;
            write_text(page, &format!("{before}{begin}\n\n{markdown}{end}{after}"))?;
        }
        Ok(())
    }

    /// Everything as JSON.
    pub(super) fn to_json(&self) -> Result<Value> {
        Ok(serde_json::json!({
            "places": serde_json::to_value(&self.places)?,
            "methods": serde_json::to_value(&self.methods)?,
            "held_out": serde_json::to_value(&self.held_out)?,
        }))
    }

    /// The essence as text for a terminal; the whole is in the reports.
    pub(super) fn essence(&self) -> String {
        let mut table = TextTable::new(
            "Balanced accuracy, %; where two numbers: false-blocked / false-visible, %",
            "",
            [vec!["method"], ESSENCE.map(|(_, _, heading)| heading).to_vec(), vec!["build s", "view s", "Mq/s", "MiB"]]
                .concat(),
        );
        for (key, title) in self.method_names() {
            let mean = |pick: &dyn Fn(&MethodScore) -> Option<Rated>, set: &str, views: &str| {
                self.rate(key, (set, views), pick).map(|i| i.value)
            };
            let rates = ESSENCE.iter().map(|(set, views, heading)| {
                if *heading == "p10" {
                    self.tenth(key).map_or("–".to_owned(), percent)
                } else if heading.ends_with("err") {
                    let blocked = mean(&|s| s.false_blocked, set, views);
                    pair(blocked, mean(&|s| s.false_visible, set, views))
                } else {
                    mean(&|s| s.balanced, set, views).map_or("–".to_owned(), percent)
                }
            });
            table.add(title, rates.chain(self.cost_cells(key)));
        }
        let by_scanner = self.by_scanner().map(|table| table.to_text()).unwrap_or_default();
        let essence = if self.methods.is_empty() { String::new() } else { by_scanner + &table.to_text() };
        essence + &self.held_out_tables().iter().map(TextTable::to_text).collect::<String>()
    }

    fn tables(&self) -> Vec<TextTable> {
        let mut tables = Vec::new();
        if !self.methods.is_empty() {
            tables.extend(self.by_scanner());
            tables.extend([self.balanced(), self.errors(), self.probabilities()]);
            tables.extend(self.differences());
            tables.extend([self.street(), self.worth_of_answers(), self.costs()]);
            tables.extend([self.place_table(), self.base_rates()]);
            tables.extend([self.audit(), self.ablation()]);
        }
        tables.extend(self.held_out_tables());
        let refusals = self.refusals();
        if !refusals.rows.is_empty() {
            tables.push(refusals);
        }
        tables
    }

    /// Keys and titles of all methods, in the order in which they occur first.
    pub(super) fn method_names(&self) -> Vec<(&str, &str)> {
        let mut names: Vec<(&str, &str)> = Vec::new();
        for result in &self.methods {
            if !names.iter().any(|(key, _)| *key == result.method) {
                names.push((&result.method, &result.title));
            }
        }
        names
    }

    fn of(&self, method: &str) -> impl Iterator<Item = &MethodResult> {
        self.methods.iter().filter(move |result| result.method == method)
    }

    /// A rate of a method on one set and group of views, averaged over places.
    fn rate(
        &self,
        method: &str,
        (set, views): (&str, &str),
        pick: &dyn Fn(&MethodScore) -> Option<Rated>,
    ) -> Option<Interval> {
        let scores = self.of(method).flat_map(|r| &r.scores).filter(|s| s.set == set && s.views == views);
        let rated: Vec<Interval> =
            scores.filter_map(pick).map(|[value, low, high]| Interval { value, low, high }).collect();
        over_places(&rated, SEED)
    }

    /// False-blocked and false-visible of a method on one set and group of views, averaged over places.
    pub(super) fn error_shares(&self, method: &str, group: (&str, &str)) -> [Option<f64>; 2] {
        let rate = |pick: &dyn Fn(&MethodScore) -> Option<Rated>| self.rate(method, group, pick).map(|i| i.value);
        [rate(&|score| score.false_blocked), rate(&|score| score.false_visible)]
    }

    /// A row for each of `methods`, and a column for each of `columns`.
    fn by_method(
        (title, note): (&str, &str),
        methods: &[(&str, &str)],
        columns: &[(&'static str, &'static str, &'static str)],
        cell: impl Fn(&str, (&str, &str)) -> String,
    ) -> TextTable {
        let headings = columns.iter().map(|(_, _, heading)| *heading);
        let mut table = TextTable::new(title, note, ["method"].into_iter().chain(headings).collect());
        for (key, title) in methods {
            table.add(title, columns.iter().map(|(set, views, _)| cell(key, (set, views))));
        }
        table
    }

    fn balanced(&self) -> TextTable {
        let texts = (
            "Balanced accuracy and IoU of blocked targets, %",
            "Mean over suns (sun), over two observers (eye) or over people in streets (street), then over places. The second number is the IoU.",
        );
        Self::by_method(texts, &self.method_names(), &COLUMNS, |key, group| {
            let rate = |pick: &dyn Fn(&MethodScore) -> Option<Rated>| self.rate(key, group, pick).map(|i| i.value);
            pair(rate(&|s| s.balanced), rate(&|s| s.blocked_iou))
        })
    }

    fn errors(&self) -> TextTable {
        let texts = (
            "False-blocked / false-visible, %",
            "False-blocked: the share of visible targets that a method calls blocked. False-visible: the share of blocked targets that it calls visible. In brackets the 95 % interval: from resampled tiles for one place, from resampled places for several.",
        );
        Self::by_method(texts, &self.method_names(), &columns_of_errors(), |key, group| {
            let blocked = self.rate(key, group, &|s| s.false_blocked);
            match (blocked, self.rate(key, group, &|s| s.false_visible)) {
                (None, None) => "–".to_owned(),
                (blocked, visible) => format!("{} / {}", with_interval(blocked), with_interval(visible)),
            }
        })
    }

    fn probabilities(&self) -> TextTable {
        let texts = (
            "Probabilities: Brier score / expected calibration error, % / wrong among the most certain nine tenths, %",
            "Brier score: mean square of the difference between the probability of being visible and the truth. Answers of methods that give no probability count as 0 and 1. Mean over places.",
        );
        Self::by_method(texts, &self.method_names(), &columns_of_errors(), |key, (set, views)| {
            let scores = self.of(key).flat_map(|r| &r.scores).filter(|s| s.set == set && s.views == views);
            let found: Vec<CalibrationScore> = scores.filter_map(|score| score.calibration).collect();
            let mean = |of: fn(&CalibrationScore) -> f64| found.iter().map(of).sum::<f64>() / found.len() as f64;
            match found.is_empty() {
                true => "–".to_owned(),
                false => format!(
                    "{:.4} / {:.1} / {:.2}",
                    mean(|s| s.brier),
                    100.0 * mean(|s| s.expected_error),
                    100.0 * mean(|s| s.error_of_most_certain)
                ),
            }
        })
    }

    /// How much better or worse the others are than carved balls at the same places; `None` for a single place.
    fn differences(&self) -> Option<TextTable> {
        let mut names = self.method_names();
        if self.places.len() < 2 || !names.iter().any(|(key, _)| *key == CARVED) {
            return None;
        }
        names.retain(|(key, _)| *key != CARVED);
        let texts = (
            "Balanced accuracy, difference from carved balls, percentage points",
            "Positive: better than carved balls. Means over the places at which both were measured, with the 95 % interval from resampled places: a difference whose interval holds 0 may be chance.",
        );
        let balanced = |result: &MethodResult, group: (&str, &str)| {
            let score = result.scores.iter().find(|s| (s.set.as_str(), s.views.as_str()) == group)?;
            score.balanced.map(|[value, ..]| value)
        };
        Some(Self::by_method(texts, &names, &COLUMNS, |key, group| {
            let of_place = |result: &MethodResult| {
                let carved = self.of(CARVED).find(|carved| carved.place == result.place)?;
                let value = balanced(result, group)? - balanced(carved, group)?;
                Some(Interval { value, low: value, high: value })
            };
            let of_places: Vec<Interval> = self.of(key).filter_map(of_place).collect();
            signed_with_interval(over_places(&of_places, SEED))
        }))
    }

    /// Balanced accuracy that a tenth of the observers in streets stay below, mean over places.
    fn tenth(&self, method: &str) -> Option<f64> {
        let of_street = self.of(method).flat_map(|r| &r.scores).filter(|s| s.views == STREET_GROUP);
        let tenths: Vec<f64> = of_street.filter_map(|s| s.tenth_balanced).collect();
        (!tenths.is_empty()).then(|| tenths.iter().sum::<f64>() / tenths.len() as f64)
    }

    fn street(&self) -> TextTable {
        let mut table = TextTable::new(
            "People in streets, %",
            "Pedestrians seen by people who stand anywhere outdoors, 1.6 m above ground. Mean: balanced accuracy. 10th percentile: a tenth of the people have a lower balanced accuracy (mean over places). Methods that start again for each observer answer for the first few people only.",
            vec!["method", "people a place", "mean", "10th percentile", "false-blocked", "false-visible"],
        );
        for (key, title) in self.method_names() {
            let rate = |pick: &dyn Fn(&MethodScore) -> Option<Rated>| {
                with_interval(self.rate(key, (STREET, STREET_GROUP), pick))
            };
            let group = self.of(key).flat_map(|r| &r.scores).filter(|s| s.views == STREET_GROUP).map(|s| s.observers);
            let cells = [
                group.max().unwrap_or(0).to_string(),
                rate(&|s| s.balanced),
                self.tenth(key).map_or("–".to_owned(), percent),
                rate(&|s| s.false_blocked),
                rate(&|s| s.false_visible),
            ];
            table.add(title, cells);
        }
        table
    }

    /// What each answer of carved balls is worth.
    fn worth_of_answers(&self) -> TextTable {
        let mut table = TextTable::new(
            "Reliability of each answer of carved balls, %",
            "Visible: nothing blocks the line of sight, and pulses came near all of it except at most half a metre. Unproven: nothing blocks it, but pulses came near less of it. Each pair has the share of the targets with this answer, and the share of these that are correct (for unproven: visible by ground truth). All places together. Passing pulses are evidence, not proof: they enter crowns that are opaque in the ground truth, and half a metre may hide a trunk.",
            vec!["targets, view", "visible", "correct", "unproven", "correct", "blocked", "correct"],
        );
        let mut sums: Vec<AnswerRow> = Vec::new();
        for row in self.places.iter().flat_map(|place| &place.answers) {
            match sums.iter_mut().find(|sum| sum.set == row.set && sum.views == row.views) {
                None => sums.push(row.clone()),
                Some(sum) => {
                    let answers = [
                        (&mut sum.visible, row.visible),
                        (&mut sum.unproven, row.unproven),
                        (&mut sum.blocked, row.blocked),
                    ];
                    for (sum, more) in answers {
                        *sum = [sum[0] + more[0], sum[1] + more[1]];
                    }
                }
            }
        }
        for sum in sums {
            let answers = [sum.visible, sum.unproven, sum.blocked];
            let all: u64 = answers.iter().map(|[given, _]| given).sum();
            let share = |part: u64, whole: u64| {
                if whole > 0 { percent(part as f64 / whole as f64) } else { "–".to_owned() }
            };
            let cells = answers.into_iter().flat_map(|[given, right]| [share(given, all), share(right, given)]);
            table.add(&format!("{}, {}", sum.set, sum.views), cells);
        }
        table
    }

    fn costs(&self) -> TextTable {
        let mut table = TextTable::new(
            "Cost",
            "Building once, preparing a view (mean), answering (all threads), and the peak growth of the resident memory; means over places. Memory that the process still held from the previous method is not counted again, so small numbers are lower bounds. No answer: share of AIR targets under the suns.",
            vec!["method", "build s", "view s", "million queries/s", "peak MiB", "no answer %"],
        );
        for (key, title) in self.method_names() {
            let unanswered = self.rate(key, ("AIR", "suns"), &|s| s.unanswered);
            let unanswered = unanswered.map_or("–".to_owned(), |i| percent(i.value));
            table.add(title, self.cost_cells(key).into_iter().chain([unanswered]));
        }
        table
    }

    /// Seconds to build and for a view, million queries a second and MiB, means over places.
    fn cost_cells(&self, method: &str) -> [String; 4] {
        let mean = |pick: &dyn Fn(&MethodResult) -> Option<f64>| {
            let values: Vec<f64> = self.of(method).filter(|r| r.failed.is_none()).filter_map(pick).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let cell = |value: Option<f64>, digits: usize| value.map_or("–".to_owned(), |v| format!("{v:.digits$}"));
        [
            cell(mean(&|r| Some(r.cost.build_seconds)), 2),
            cell(mean(&|r| Some(r.cost.seconds_per_view)), 2),
            cell(mean(&|r| r.cost.queries_per_second.map(|q| q / 1e6)), 2),
            cell(mean(&|r| r.cost.peak_mib), 0),
        ]
    }

    fn place_table(&self) -> TextTable {
        let headings = vec!["place", "points", "points/m²", "triangles of the ground truth"];
        let mut table = TextTable::new("Places", "", headings);
        for place in &self.places {
            let density = place.points as f64 / place.area_m2.max(1e-9);
            table.add(&place.place, [place.points.to_string(), format!("{density:.1}"), place.triangles.to_string()]);
        }
        table
    }

    fn base_rates(&self) -> TextTable {
        let mut table = TextTable::new(
            "Targets that are blocked by ground truth, %",
            "The share of correct answers of a method that calls everything blocked.",
            [vec!["place"], COLUMNS.map(|(_, _, heading)| heading).to_vec()].concat(),
        );
        for place in &self.places {
            let cells = COLUMNS.map(|(set, views, _)| {
                let share = place.blocked_in_truth.iter().find(|(s, v, _)| s == set && v == views);
                share.map_or("–".to_owned(), |(_, _, share)| percent(*share))
            });
            table.add(&place.place, cells);
        }
        table
    }

    fn audit(&self) -> TextTable {
        let mut table = TextTable::new(
            "Wrong balls of the published method, and causes",
            "A ball is wrong if its centre lies in free air. Flipped: its normal points into the solid. Tilted: the error of the normal is 30° to 90°. Bulging: the normal is correct, but the ball grew through a surface without points. Shares of the balls of that surface; all places together.",
            vec!["tangent at", "balls", "wrong %", "flipped %", "tilted %", "bulging %"],
        );
        let mut surfaces: Vec<&str> = Vec::new();
        for row in self.places.iter().flat_map(|place| &place.audit) {
            if !surfaces.contains(&row.surface.as_str()) {
                surfaces.push(&row.surface);
            }
        }
        for surface in surfaces {
            let rows = || self.places.iter().flat_map(|p| &p.audit).filter(|row| row.surface == surface);
            let balls: usize = rows().map(|row| row.balls).sum();
            let share = |count: usize| percent(count as f64 / balls.max(1) as f64);
            table.add(
                surface,
                [
                    balls.to_string(),
                    share(rows().map(|row| row.wrong).sum()),
                    share(rows().map(|row| row.flipped).sum()),
                    share(rows().map(|row| row.tilted).sum()),
                    share(rows().map(|row| row.bulging).sum()),
                ],
            );
        }
        table
    }

    fn ablation(&self) -> TextTable {
        let mut table = TextTable::new(
            "The published balls with some of them removed: pedestrians under the suns, %",
            "As spheres, with exact lines of sight; means over places.",
            vec!["balls", "number", "false-blocked", "false-visible"],
        );
        let Some(first) = self.places.first() else { return table };
        for name in first.ablation.iter().map(|row| row.balls.as_str()) {
            let rows: Vec<_> =
                self.places.iter().flat_map(|place| &place.ablation).filter(|row| row.balls == name).collect();
            let mean = |pick: &dyn Fn(&super::results::AblationRow) -> Option<Rated>| {
                let rated = rows.iter().filter_map(|row| pick(row));
                let intervals: Vec<Interval> = rated.map(|[value, low, high]| Interval { value, low, high }).collect();
                with_interval(over_places(&intervals, SEED))
            };
            let number: usize = rows.iter().map(|row| row.number).sum();
            table.add(name, [number.to_string(), mean(&|r| r.false_blocked), mean(&|r| r.false_visible)]);
        }
        table
    }

    fn held_out_tables(&self) -> Vec<TextTable> {
        let mut clouds: Vec<&str> = Vec::new();
        for result in &self.held_out {
            if !clouds.contains(&result.cloud.as_str()) {
                clouds.push(&result.cloud);
            }
        }
        let of_cloud = |cloud: &&str| {
            let rows: Vec<_> = self.held_out.iter().filter(|result| result.cloud == *cloud).collect();
            let longest = rows.iter().max_by_key(|row| row.shares.len());
            let names = longest.map(|row| row.shares.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>());
            let names = names.unwrap_or_default();
            let (pulses, known) = rows.first().map_or((0, String::new()), |r| (r.pulses, percent(r.scanner_known)));
            let mut table = TextTable::new(
                &format!("Held-out pulses of {cloud}, %"),
                &format!(
                    "Built from nine tenths of the pulses, tested with the others ({pulses}; the scanner is known for {known} % of \
                     all). False-blocked: paths from 30 m to 0.3 m in front of the first return, by its class. False-visible: \
                     points behind the last return of a pulse that are called visible from the scanner. Other: mostly trees, \
                     where a weak part of the beam may pass beside the last return."
                ),
                [vec!["method"], names.clone()].concat(),
            );
            for row in rows.iter().filter(|row| row.failed.is_none()) {
                let share =
                    |name: &str| row.shares.iter().find(|(other, _)| other == name).and_then(|(_, share)| *share);
                table.add(&row.title, names.iter().map(|name| share(name).map_or("–".to_owned(), percent)));
            }
            table
        };
        clouds.iter().map(of_cloud).collect()
    }

    /// What methods could not do, once each.
    fn refusals(&self) -> TextTable {
        let mut table = TextTable::new("Combinations without an answer", "", vec!["method", "query", "reason"]);
        let mut add = |title: &str, group: String, reason: &str| {
            let row = vec![title.to_owned(), group, reason.to_owned()];
            if !table.rows.contains(&row) {
                table.rows.push(row);
            }
        };
        for result in &self.methods {
            if let Some(reason) = &result.failed {
                add(&result.title, "to be built".to_owned(), reason);
            }
            for score in &result.scores {
                if let Some(reason) = &score.refused {
                    add(&result.title, format!("{} {}", score.set, score.views), reason);
                }
            }
        }
        for result in &self.held_out {
            if let Some(reason) = &result.failed {
                add(&result.title, format!("pulses of {}", result.cloud), reason);
            }
        }
        table
    }

    fn to_html(&self, tables: &[TextTable], has_curves: bool) -> String {
        let mut body = String::new();
        if has_curves {
            body.push_str(&format!(
                "<img src=\"pictures/{CURVES}\" alt=\"Errors by density\" style=\"max-width:100%\">\n"
            ));
        }
        body.extend(tables.iter().map(TextTable::to_html));
        for place in &self.places {
            body.push_str(&format!(
                "<h2>Pedestrians of {}, sun in the south-west</h2><p>{LEGEND}</p>\n<div>",
                place.place
            ));
            for result in self.methods.iter().filter(|result| result.place == place.place && result.failed.is_none()) {
                let file = format!("pictures/{}--{}.png", result.place, result.method);
                body.push_str(&format!("<img src=\"{file}\" alt=\"{}\" loading=\"lazy\">\n", result.title));
            }
            body.push_str("</div>\n");
        }
        format!(
            "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Belvedere: comparison</title>\n<style>{STYLE}</style>\n\
             <h1>Visibility on point clouds: accuracy and cost</h1>\n{body}</html>\n"
        )
    }
}

/// Columns of the tables of errors.
fn columns_of_errors() -> Vec<(&'static str, &'static str, &'static str)> {
    COLUMNS.into_iter().filter(|(set, ..)| !matches!(*set, "VOL" | "GRD")).collect()
}

const STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;margin:2rem;max-width:110rem}\
     table{border-collapse:collapse;margin:.5rem 0 1rem}td,th{padding:.2rem .6rem;border-bottom:1px solid #ddd;text-align:right;white-space:nowrap}\
     td:first-child,th:first-child{text-align:left}tbody tr:hover{background:#f4f2ea}h2{margin-top:2.2rem}\
     p{color:#444;max-width:60rem}img{max-width:32%;min-width:300px}";

fn write_text(path: &Path, text: &str) -> Result<()> {
    atomic::write(path, |file| file.write_all(text.as_bytes()).map_err(belvedere::Error::io(path)))?;
    Ok(())
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

pub(super) fn pair(first: Option<f64>, second: Option<f64>) -> String {
    match (first, second) {
        (None, None) => "–".to_owned(),
        (first, second) => {
            let cell = |value: Option<f64>| value.map_or("–".to_owned(), percent);
            format!("{} / {}", cell(first), cell(second))
        }
    }
}

fn signed_with_interval(difference: Option<Interval>) -> String {
    let signed = |share: f64| format!("{:+.1}", 100.0 * share).replace('-', "−");
    difference.map_or("–".to_owned(), |i| format!("{} [{}, {}]", signed(i.value), signed(i.low), signed(i.high)))
}

fn with_interval(rate: Option<Interval>) -> String {
    rate.map_or("–".to_owned(), |i| format!("{} [{}, {}]", percent(i.value), percent(i.low), percent(i.high)))
}
