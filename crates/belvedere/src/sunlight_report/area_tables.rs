//! Tables of areas: the share that meets a rule, the shade that a plan adds, and the sun of a year.

use super::SunlightReport;
use super::numbers::{hm, percent};
use super::sentences::{BRE, rule_in_words};
use super::words::{Words, escaped};
use crate::report::clock_time;
use std::fmt::Write as _;

/// The section of areas.
pub(super) fn area_table(report: &SunlightReport, words: &Words) -> String {
    let mut rows = String::new();
    for number in 0..report.params.areas.len() {
        let name = escaped(&report.params.area_name(number, words));
        let count = report.states().count();
        for (row, (state_name, state)) in report.states().enumerate() {
            let found = &state.areas[number];
            let start = if row == 0 { format!("<th rowspan='{count}'>{name}</th>") } else { String::new() };
            let kept = match state_name {
                "after" => format!("{} %", percent(found.share / report.before.areas[number].share)),
                _ => String::new(),
            };
            let _ = write!(
                rows,
                "<tr>{start}<td>{}</td><td>{} %</td><td>{kept}</td><td>{}</td><td>{}</td></tr>",
                words.get(state_name),
                percent(found.share),
                hm(found.hours),
                found.cells
            );
        }
    }
    let half = match report.area_rule.name.starts_with(BRE) {
        true => format!(" {}", words.get("bre-half")),
        false => String::new(),
    };
    let names = ["areas", "share", "kept", "mean-hours", "cells"].map(|key| words.get(key));
    let head: String = names[1..].iter().map(|name| format!("<th>{name}</th>")).collect();
    format!(
        "<section class='areas'><h2>{}</h2><p>{}: {}.{half}</p><table><thead><tr><th>{}</th><th></th>{head}</tr></thead><tbody>{rows}</tbody></table>{}</section>",
        names[0],
        words.get("rule"),
        escaped(&rule_in_words(&report.area_rule, report, words)),
        words.get("area"),
        added_table(report, words)
    )
}

/// Shade that a plan adds to each area and day: its first and last time, duration, and greatest share.
fn added_table(report: &SunlightReport, words: &Words) -> String {
    let Some(after) = &report.after else { return String::new() };
    let mut rows = String::new();
    for (number, area) in after.areas.iter().enumerate() {
        for found in &area.added {
            let [from, to, at] = [found.ends[0], found.ends[1], found.most.1].map(|hour| clock_time(hour.into()));
            let _ = write!(
                rows,
                "<tr><th>{}</th><td>{}</td><td>{from}</td><td>{to}</td><td>{}</td><td>{} % ({at})</td><td>{:.0}</td></tr>",
                escaped(&report.params.area_name(number, words)),
                words.short_date(found.date),
                hm(found.hours.into()),
                percent(found.most.0),
                found.area_hours,
            );
        }
    }
    let counted = match report.params.study {
        Some(study) => format!("<p>{}: {}.</p>", words.get("study"), escaped(study.title())),
        None => String::new(),
    };
    let of_year = year_table(report, words);
    if rows.is_empty() {
        return format!("{counted}<p>{}</p>{of_year}", words.get("no-added"));
    }
    let names = ["area", "date", "from", "to", "duration", "at-most", "area-hours"].map(|key| words.get(key));
    let head: String = names.iter().map(|name| format!("<th>{name}</th>")).collect();
    format!(
        "<h3>{}</h3>{counted}<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>{of_year}",
        words.get("added")
    )
}

/// The sun of a year over each area, and what the plan takes of it, where a study counts it.
fn year_table(report: &SunlightReport, words: &Words) -> String {
    let Some(after) = &report.after else { return String::new() };
    let mut rows = String::new();
    for (number, area) in after.areas.iter().enumerate() {
        let Some(year) = area.year else { continue };
        let square_metres = report.before.areas[number].square_metres();
        let possible = square_metres * year.hours;
        let percent = |share: f64| words.number(100.0 * share, 2);
        let worst = year
            .worst
            .map_or_else(String::new, |(date, most)| format!("{} ({})", words.short_date(date), words.number(most, 0)));
        let _ = write!(
            rows,
            "<tr><th>{}</th><td>{}</td><td>{}</td><td>{} %</td><td>{}</td><td>{} %</td><td>{worst}</td></tr>",
            escaped(&report.params.area_name(number, words)),
            words.number(square_metres, 0),
            words.number(possible, 0),
            percent(1.0 - year.lit),
            words.number(possible * year.lost, 0),
            percent(year.lost),
        );
    }
    if rows.is_empty() {
        return String::new();
    }
    let names = ["area", "square-metres", "year-possible", "year-shaded", "year-added", "year-share", "year-worst"];
    let head: String = names.iter().map(|name| format!("<th>{}</th>", words.get(name))).collect();
    format!("<h3>{}</h3><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>", words.get("year"))
}
