//! The answer of a report in sentences.

use super::numbers::{hours_in_words, is_unchanged, percent};
use super::verdict::{RuleFinding, Verdict};
use super::words::Words;
use super::{State, SunlightReport};
use crate::apps::sun_hours::{Counted, NeededDays, RuleDays, SunRule, WindowClock};
use crate::report::clock_time;

/// Beginning of the names of rules of BRE 209.
pub(super) const BRE: &str = "bre-";
/// Share of an open space that must have the sun of the rule, or else of the share before (BRE 209:2022, section 3.3).
const BRE_SHARE: f64 = 0.5;
const BRE_KEPT: f64 = 0.8;

/// A verdict in the language of the words.
pub(super) fn verdict_words(verdict: Verdict, words: &Words) -> &'static str {
    match verdict {
        Verdict::Met => words.get("met"),
        Verdict::NotMet => words.get("not-met"),
        Verdict::MetUncertain => words.get("met-uncertain"),
        Verdict::NotMetUncertain => words.get("not-met-uncertain"),
    }
}

/// A rule in the language of the words, with its name.
pub(super) fn rule_in_words(rule: &SunRule, report: &SunlightReport, words: &Words) -> String {
    let calendar = &report.before.calendar;
    let year = report.params.detailed_days().year.unwrap_or_default();
    let dates = rule.days.dates(year, &calendar.site, &calendar.zone).unwrap_or_default();
    let [Some(first), Some(last)] = [dates.first(), dates.last()] else { return rule.description.clone() };
    let hours = hours_in_words(rule.hours);
    let ends = [("hours", hours.as_str()), ("from", &words.short_date(*first)), ("to", &words.short_date(*last))];
    let mut text = match (rule.days, rule.needed) {
        _ if dates.len() == 1 => words.with("rule-on", &[("hours", &hours), ("day", &words.short_date(*first))]),
        (RuleDays::Equinoxes, _) => words.with("rule-two", &ends),
        (_, NeededDays::All) => words.with("rule-each", &ends),
        (_, NeededDays::Any) => words.with("rule-any", &ends),
    };
    if rule.counted == Counted::LongestPiece {
        text += &format!(" {}", words.get("rule-piece"));
    }
    if let Some(window) = rule.window {
        let [from, to] = window.hours.map(clock_time);
        text += &format!(" {}", words.with("rule-hours", &[("from", &from), ("to", &to)]));
        if window.clock == WindowClock::Sun {
            text += &format!(" {}", words.get("rule-solar"));
        }
    }
    if rule.min_elevation > 0.0 {
        let degrees = format!("{:.0}", rule.min_elevation.to_degrees());
        text += &format!(" {}", words.with("rule-above", &[("degrees", &degrees)]));
    }
    match SunRule::columns().any(|(name, _)| name == rule.name) {
        // the source of a named rule stands in the brackets of its description
        true => match rule.description.rsplit_once('(') {
            Some((_, source)) => format!("{text} ({}: {source}", rule.name),
            None => format!("{text} ({})", rule.name),
        },
        false => text,
    }
}

/// Returns true if an area meets BRE 209: half of it has the sun of the rule, or 0.8 of what had it before.
pub(super) fn bre_verdict(share: f64, before: f64) -> bool {
    share >= BRE_SHARE || share >= BRE_KEPT * before
}

/// The answer: a sentence for all windows, and one for each window and area.
pub(super) fn sentences(report: &SunlightReport, words: &Words) -> Vec<String> {
    let last = report.last();
    let mut all = Vec::new();
    if report.rule.is_some() && last.windows.len() > 1 {
        all.push(of_all_windows(report, words));
    }
    all.extend((0..last.windows.len()).filter_map(|number| of_window(report, number, words)));
    // a room with one window has the sun of that window
    let rooms = report.params.rooms().into_iter().enumerate().filter(|(_, (_, windows))| windows.len() > 1);
    for (number, (room, windows)) in rooms {
        let rules = report.before.rooms[number].zip(last.rooms[number]);
        let is_planned = report.after.is_some();
        let is_whole = windows.iter().all(|&window| last.calendar.targets.is_target(window));
        let partly = if is_whole { String::new() } else { format!(" ({})", words.get("room-partly")) };
        let name = format!("{}: {room}{partly}", words.get("room"));
        all.extend(rules.map(|rules| of_rule(name, rules, is_planned, words)));
    }
    all.extend((0..last.areas.len()).map(|number| of_area(report, number, words)));
    let near = last.calendar.near_edge.iter().filter(|near| **near == Some(true)).count();
    if near > 0 {
        let (count, of) = (near.to_string(), last.windows.len().to_string());
        all.push(words.with("near-edge", &[("count", &count), ("all", &of)]));
    }
    if report.is_without_system {
        all.push(words.get("no-system").to_owned());
    }
    all
}

fn of_all_windows(report: &SunlightReport, words: &Words) -> String {
    let last = report.last();
    let verdict = |state: &State, number: usize| Some(state.windows[number].rule?.verdict());
    let count = |counts: &dyn Fn(usize) -> bool| (0..last.windows.len()).filter(|&number| counts(number)).count();
    let met = |state: &State| count(&|number| verdict(state, number).is_some_and(Verdict::is_met)).to_string();
    let is_uncertain =
        |number: usize| report.states().any(|(_, state)| verdict(state, number).is_some_and(Verdict::is_uncertain));
    let uncertain = match count(&is_uncertain) {
        0 => String::new(),
        count => format!(" ({})", words.with("uncertain-count", &[("count", &count.to_string())])),
    };
    let answered = count(&|number| verdict(last, number).is_some());
    let key = if report.after.is_some() { "all-met-change" } else { "all-met" };
    let values = [
        ("met", met(last)),
        ("before", met(&report.before)),
        ("count", answered.to_string()),
        ("uncertain", uncertain),
    ];
    words.with(key, &values.each_ref().map(|(name, value)| (*name, value.as_str())))
}

/// The verdict on a rule, with that before a plan where it was another, and that without trees where it is met.
fn verdict_in_words(was: &RuleFinding, will: &RuleFinding, words: &Words) -> String {
    let text = verdict_words(will.verdict(), words);
    let text = match was.verdict().is_met() == will.verdict().is_met() {
        true => text.to_owned(),
        false => format!("{text}; {}: {}", words.get("before"), verdict_words(was.verdict(), words)),
    };
    match !will.verdict().is_met() && will.is_met_without_trees() == Some(true) {
        true => format!("{text}; {}: {}", words.get("without-trees"), words.get("met")),
        false => text,
    }
}

fn of_window(report: &SunlightReport, number: usize, words: &Words) -> Option<String> {
    let (before, last) = (&report.before, report.last());
    let name = report.params.window_name(number, words);
    if !last.calendar.targets.is_target(number) {
        return Some(words.with("no-position", &[("name", &name)]));
    }
    let inside = match [before, last].map(|state| state.windows[number].is_inside) {
        [true, _] => format!(" {}", words.get("inside")),
        [false, true] => format!(" {}", words.get("inside-plan")),
        [false, false] => String::new(),
    };
    if let Some(rules) = before.windows[number].rule.zip(last.windows[number].rule) {
        return Some(of_rule(name, rules, report.after.is_some(), words) + &inside);
    }
    let hours = |day: usize| [before, last].map(|state| state.calendar.days[number][day].sun_hours());
    let change = |day: usize| hours(day)[0] - hours(day)[1];
    // the day on which the plan takes or gives most, else the first
    let days = &last.calendar.schedule.days;
    let row = (0..days.len()).rev().max_by(|&a, &b| change(a).abs().total_cmp(&change(b).abs()))?;
    let day = days[row].date;
    let [was, will] = hours(row);
    let key = match report.after {
        Some(_) if is_unchanged(was, will) => "window-day-same",
        Some(_) => "window-day-change",
        None => "window-day",
    };
    let values =
        [("name", name), ("hours", hours_in_words(will)), ("before", hours_in_words(was)), ("day", words.date(day))];
    Some(words.with(key, &values.each_ref().map(|(name, value)| (*name, value.as_str()))) + &inside)
}

/// A rule at a window or in a room before and after a plan; the same twice where nothing is planned.
fn of_rule(name: String, (was, will): (RuleFinding, RuleFinding), is_planned: bool, words: &Words) -> String {
    let key = match is_planned {
        true if is_unchanged(was.hours, will.hours) && was.date == will.date => "window-rule-same",
        true => "window-rule-change",
        false => "window-rule",
    };
    let values = [
        ("name", name),
        ("hours", hours_in_words(will.printed_hours())),
        ("before", hours_in_words(was.printed_hours())),
        ("day", words.date(will.date)),
        ("before-day", words.date(was.date)),
        ("required", hours_in_words(will.required)),
        ("verdict", verdict_in_words(&was, &will, words)),
    ];
    words.with(key, &values.each_ref().map(|(name, value)| (*name, value.as_str())))
}

fn of_area(report: &SunlightReport, number: usize, words: &Words) -> String {
    let (was, will) = (&report.before.areas[number], &report.last().areas[number]);
    let mut verdict = String::new();
    if report.area_rule.name.starts_with(BRE) {
        let is_met = match report.after {
            Some(_) => bre_verdict(will.share, was.share),
            None => will.share >= BRE_SHARE,
        };
        verdict = format!(". {}", if is_met { words.get("bre-met") } else { words.get("bre-not-met") });
    }
    if was.outside > 0.005 {
        verdict += &format!(" ({})", words.with("area-outside", &[("share", &percent(was.outside))]));
    }
    let covered = 1.0 - will.cells as f64 / was.cells as f64;
    if covered > 0.005 {
        verdict += &format!(" ({})", words.with("covered", &[("share", &percent(covered))]));
    }
    let key = if report.after.is_some() { "area-rule-change" } else { "area-rule" };
    let values = [
        ("name", report.params.area_name(number, words)),
        ("share", percent(will.share)),
        ("before", percent(was.share)),
        ("verdict", verdict),
    ];
    words.with(key, &values.each_ref().map(|(name, value)| (*name, value.as_str())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bre_209_is_met_by_half_or_by_four_fifths_of_before() {
        assert!(bre_verdict(0.5, 1.0) && bre_verdict(0.24, 0.3));
        assert!(!bre_verdict(0.49, 0.9) && !bre_verdict(0.1, 0.2));
    }
}
