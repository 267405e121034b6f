//! The page of a report: HTML that needs no other file and prints on A4.

use super::area_tables::area_table;
use super::charts::{LEGEND, color, name_of, sky, strips};
use super::numbers::{change, hm, hours_in_words};
use super::sentences::{rule_in_words, sentences, verdict_words};
use super::verdict::RuleFinding;
use super::words::{Words, escaped};
use super::{State, SunlightReport};
use crate::Result;
use crate::apps::sun::Date;
use crate::apps::sun_calendar::{CalendarDay, SunObstacle};
use crate::apps::sun_hours::NeededDays;
use crate::apps::targets::Window;
use crate::cast::to_index;
use crate::figures::{MapLegend, MapMark, MapPicture, map_image, png_bytes};
use crate::report::clock_time;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use std::fmt::Write as _;

const STYLE: &str = include_str!("report.css");
/// Maximum number of windows that are drawn one by one: more make files that browsers open slowly.
const MAX_DRAWN: usize = 100;
/// Side of a map, pixels.
const PICTURE_SIDE: f64 = 640.0;
/// Colours of maps: sun, shade, shade of the plan, freed sun, the plan.
const MAP_COLORS: [[u8; 3]; 5] = [[250, 240, 205], [118, 128, 150], [203, 62, 50], [104, 176, 120], [146, 98, 160]];

/// Text of HTML as code; nothing for nothing.
fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("<code>{}</code>", escaped(text)) }
}

/// The whole page.
pub(super) fn html(report: &SunlightReport) -> Result<String> {
    let words = Words::of(report.params.language);
    let usual = words.get(if report.after.is_some() { "title-plan" } else { "title" });
    let title = if report.params.title.is_empty() { usual } else { &report.params.title };
    let mut body = format!("<h1>{}</h1>", escaped(title));
    if !report.params.title.is_empty() {
        let _ = write!(body, "<p class='subtitle'>{usual}</p>");
    }
    for note in &report.params.notes {
        let _ = write!(body, "<p class='note'>{}</p>", escaped(note));
    }
    let answers: String = sentences(report, &words).iter().map(|line| format!("<li>{}</li>", escaped(line))).collect();
    let _ = write!(body, "<h2>{}</h2><ul class='answer'>{answers}</ul>", words.get("answer"));
    if let Some(rule) = report.rule.as_ref().filter(|_| !report.params.windows.is_empty()) {
        let critical = words.get(match rule.needed {
            NeededDays::All => "critical-least",
            NeededDays::Any => "critical-most",
        });
        let rule = escaped(&rule_in_words(rule, report, &words));
        let _ = write!(body, "<p>{}: {rule}. {critical}</p>", words.get("rule"));
    }
    if !report.params.windows.is_empty() {
        body += &window_table(report, &words);
    }
    if !report.params.areas.is_empty() {
        body += &area_table(report, &words);
    }
    body += &maps(report, &words)?;
    if !report.params.windows.is_empty() {
        body += &each_window(report, &words);
    }
    body += &details(report, &words);
    body += &limits(report, &words);
    if !report.params.windows.is_empty() {
        body += &all_rows(report, &words);
    }
    let (language, title) = (report.params.language.code(), escaped(title));
    Ok(format!(
        "<!DOCTYPE html>\n<html lang='{language}'><head><meta charset='utf-8'>\
         <meta name='viewport' content='width=device-width, initial-scale=1'>\
         <title>{title}</title><style>{STYLE}</style></head><body><main>{body}</main></body></html>\n"
    ))
}

fn window_table(report: &SunlightReport, words: &Words) -> String {
    let days = &report.before.calendar.schedule.days;
    let is_planned = report.after.is_some();
    let mut head = format!("<th></th><th>{}</th><th>{}</th>", words.get("faces"), words.get("height"));
    for day in days {
        let _ = write!(head, "<th colspan='{}'>{}</th>", if is_planned { 3 } else { 1 }, words.date(day.date));
    }
    let of_day = match is_planned {
        true => {
            format!("<th>{}</th><th>{}</th><th>{}</th>", words.get("before"), words.get("after"), words.get("change"))
        }
        false => format!("<th>{}</th>", words.get("sun")),
    };
    let second = format!("<th></th><th></th><th></th>{}", of_day.repeat(days.len()));
    let mut rows = String::new();
    for number in 0..report.params.windows.len() {
        let calendar = &report.before.calendar;
        let window = &calendar.windows[number];
        let azimuth = (window.azimuth + calendar.grid_north).to_degrees().rem_euclid(360.0);
        let height = calendar.targets.frame.file_from_local(window.center)[2];
        let name = escaped(&report.params.window_name(number, words));
        let _ = write!(
            rows,
            "<tr><th>{}. {name}</th><td>{}</td><td>{}</td>",
            number + 1,
            compass(azimuth, words),
            words.number(height, 1)
        );
        for day in 0..days.len() {
            let hours = |state: &State| state.calendar.days[number][day].sun_hours();
            let cell = |state: &State| {
                if !state.calendar.targets.is_target(number) {
                    return "<td>–</td>".to_owned();
                }
                let hours = hours(state);
                let ends = state.windows[number].intervals.get(day);
                let interval = ends.map(|[low, high]| {
                    let possible = state.calendar.schedule.days[day].possible_hours;
                    format!("<br><small>{}–{}</small>", hm((hours + low).max(0.0)), hm((hours + high).min(possible)))
                });
                format!("<td>{}{}</td>", hm(hours), interval.unwrap_or_default())
            };
            rows += &cell(&report.before);
            if let Some(after) = &report.after {
                let is_known = after.calendar.targets.is_target(number);
                let difference = if is_known { change(hours(&report.before), hours(after)) } else { "–".to_owned() };
                let _ = write!(rows, "{}<td class='change'>{difference}</td>", cell(after));
            }
        }
        rows += "</tr>";
    }
    let title = words.get("windows");
    let mut text = format!(
        "<h2>{title}</h2><p class='note'>{}</p><table><thead><tr>{head}</tr><tr>{second}</tr></thead><tbody>{rows}</tbody></table>",
        words.get("hours-of")
    );
    if report.rule.is_some() {
        text += &rule_table(report, words);
    }
    text
}

/// Name of a direction and its azimuth, degrees.
fn compass(azimuth: f64, words: &Words) -> String {
    if !azimuth.is_finite() {
        return "–".to_owned();
    }
    let eighth = to_index((azimuth / 45.0).round()) % 8;
    format!("{} ({azimuth:.0}°)", words.get("compass").split('|').nth(eighth).unwrap_or_default())
}

/// Rule of windows, and of rooms whose windows add up.
fn rule_table(report: &SunlightReport, words: &Words) -> String {
    let params = &report.params;
    let of_window = |number: usize| {
        let rules = report.states().map(|(name, state)| (name, state.windows[number].rule)).collect();
        (format!("{}. {}", number + 1, params.window_name(number, words)), rules)
    };
    let of_room = |(number, (room, windows)): (usize, &(&str, Vec<usize>))| {
        let rules = report.states().map(|(name, state)| (name, state.rooms[number])).collect();
        let numbers: Vec<String> = windows.iter().map(|window| (window + 1).to_string()).collect();
        (format!("{room} ({})", numbers.join(", ")), rules)
    };
    let mut text = rule_rows(words.get("rule"), (0..params.windows.len()).map(of_window), words);
    let rooms = params.rooms();
    if !rooms.is_empty() {
        text += &rule_rows(words.get("rooms"), rooms.iter().enumerate().map(of_room), words);
    }
    text
}

/// A table of names with a rule in each state.
fn rule_rows(
    title: &str,
    named: impl Iterator<Item = (String, Vec<(&'static str, Option<RuleFinding>)>)>,
    words: &Words,
) -> String {
    let mut rows = String::new();
    for (name, states) in named {
        let (name, count) = (escaped(&name), states.len());
        for (row, (state_name, rule)) in states.into_iter().enumerate() {
            let Some(rule) = rule else { continue };
            let start = if row == 0 { format!("<th rowspan='{count}'>{name}</th>") } else { String::new() };
            let RuleFinding { date, without_trees, interval, days: [enough, all], .. } = rule;
            let verdict = rule.verdict();
            let class_of = |is_met: bool| if is_met { "met" } else { "not-met" };
            let class = class_of(verdict.is_met());
            let class_without = rule.is_met_without_trees().map_or("", class_of);
            let interval = interval.map_or("–".to_owned(), |[low, high]| format!("{}–{}", hm(low), hm(high)));
            let _ = write!(
                rows,
                "<tr>{start}<td>{}</td><td class='{class}'>{}</td><td class='day'>{}</td><td>{}</td><td>{interval}</td><td class='{class_without}'>{}</td><td>{enough} / {all}</td></tr>",
                words.get(state_name),
                verdict_words(verdict, words),
                words.short_date(date),
                hm(rule.printed_hours()),
                without_trees.map_or("–".to_owned(), hm),
            );
        }
    }
    let keys = ["verdict", "deciding-day", "sun", "interval", "without-trees", "rule-days"];
    let head: String = keys.map(|key| format!("<th>{}</th>", words.get(key))).concat();
    format!("<h3>{title}</h3><table><thead><tr><th></th><th></th>{head}</tr></thead><tbody>{rows}</tbody></table>")
}

/// Colours of the cells of a map: what the plan adds and frees where there is one.
fn map_colors(before: &[Option<bool>], after: Option<(&[Option<bool>], &[bool])>) -> Vec<Option<[u8; 3]>> {
    let [sun, shade, added, freed, plan] = MAP_COLORS;
    let of_cell = |(cell, &was): (usize, &Option<bool>)| {
        let Some((after, is_plan)) = after else { return was.map(|lit| if lit { sun } else { shade }) };
        if is_plan.get(cell) == Some(&true) {
            return Some(plan);
        }
        Some(match (was, after[cell]?) {
            (Some(true), false) => added,
            (Some(false), true) => freed,
            (_, true) => sun,
            (_, false) => shade,
        })
    };
    before.iter().enumerate().map(of_cell).collect()
}

fn maps(report: &SunlightReport, words: &Words) -> Result<String> {
    let (Some(before), Some(last)) = (&report.before.maps, &report.last().maps) else { return Ok(String::new()) };
    let (grid, relief) = (&last.grid, &last.relief);
    let mark = |(number, window): (usize, &Window)| {
        let place = [window.center[0] - grid.corner[0], grid.corner[1] - window.center[1]].map(|v| v / grid.cell);
        MapMark { place, view: None, label: (number + 1).to_string() }
    };
    let marks: Vec<MapMark> = report.before.calendar.windows.iter().enumerate().map(mark).collect();
    let factor = to_index(PICTURE_SIDE / relief.width().max(relief.height()).max(1) as f64).clamp(1, 8);
    let mut pictures = String::new();
    for (was, will) in before.lit.iter().zip(&last.lit) {
        let after = report.after.as_ref().map(|_| (&will.cells[..], &last.is_plan[..]));
        let colors = map_colors(&was.cells, after);
        let map = MapPicture {
            marks: &marks,
            ..MapPicture::of_colors(relief, grid.cell, None, &colors, "", MapLegend::Colors(&[]))
        };
        let picture = map_image(&map, factor)?;
        let data = BASE64_STANDARD.encode(png_bytes(&picture)?);
        let caption = format!("{}, {}", words.short_date(was.date), clock_time(was.hour));
        let _ = write!(
            pictures,
            "<figure><img alt='{caption}' src='data:image/png;base64,{data}'>{}<figcaption>{caption}</figcaption></figure>",
            scale_bar(relief.width() as f64 * grid.cell)
        );
    }
    let keys = ["map-sun", "map-shade", "map-added", "map-freed", "map-plan"];
    let count = if report.after.is_some() { 5 } else { 2 };
    let swatch = |(color, key): (&[u8; 3], &&'static str)| {
        let [r, g, b] = color;
        format!("<span><i style='background:rgb({r},{g},{b})'></i>{}</span>", words.get(key))
    };
    let legend: String = MAP_COLORS.iter().zip(&keys).take(count).map(swatch).collect();
    Ok(format!(
        "<section class='maps'><h2>{}</h2><p>{}</p><p class='legend'>{legend}</p><div class='grid'>{pictures}</div></section>",
        words.get("maps"),
        words.get("maps-text")
    ))
}

/// A bar of a round length below a map of `width` metres.
fn scale_bar(width: f64) -> String {
    let exponent = 10f64.powf((width / 4.0).log10().floor());
    let length = [5.0, 2.0, 1.0].map(|digit| digit * exponent).into_iter().find(|length| *length <= width / 4.0);
    let length = length.unwrap_or(exponent);
    format!("<span class='bar'><b style='width:{:.2}%'></b>{length:.0} m</span>", 100.0 * length / width)
}

fn each_window(report: &SunlightReport, words: &Words) -> String {
    let legend = LEGEND.iter().filter(|(_, key)| *key != "plan" || report.after.is_some());
    let legend: String = legend
        .map(|(obstacle, key)| {
            format!("<span><i style='background:{}'></i>{}</span>", color(*obstacle), words.get(key))
        })
        .collect();
    let mut text = format!(
        "<h2>{}</h2><p>{} {}</p><p class='legend'>{legend}</p>",
        words.get("each-window"),
        words.get("strips-text"),
        words.get("sky-text")
    );
    let answered = (0..report.params.windows.len()).filter(|&number| report.last().calendar.targets.is_target(number));
    let answered: Vec<usize> = answered.collect();
    if answered.len() > MAX_DRAWN {
        let of =
            words.with("first-windows", &[("count", &MAX_DRAWN.to_string()), ("all", &answered.len().to_string())]);
        let _ = write!(text, "<p>{of}</p>");
    }
    for number in answered.into_iter().take(MAX_DRAWN) {
        let name = escaped(&report.params.window_name(number, words));
        let _ = write!(
            text,
            "<section class='window'><h3>{}. {name}</h3>{}{}{}{}</section>",
            number + 1,
            strips(report, number, words),
            sky(report, number, words),
            day_table(report, number, words),
            lost_table(report, number, words)
        );
    }
    text
}

/// First and last sun, longest piece and unproven hours of each day.
fn day_table(report: &SunlightReport, window: usize, words: &Words) -> String {
    let mut rows = String::new();
    for (number, day) in report.before.calendar.schedule.days.iter().enumerate() {
        for (name, state) in report.states() {
            let found: &CalendarDay = &state.calendar.days[window][number];
            let [first, last] = match found.first_and_last() {
                Some(ends) => ends.map(|hour| clock_time(hour.into())),
                None => ["–", "–"].map(str::to_owned),
            };
            let without = state.calendar.without_trees.as_ref().map(|days| days[window][number].sun_hours());
            let unproven: f64 = found.sun().map(|stretch| f64::from(stretch.unproven)).sum();
            let _ = write!(
                rows,
                "<tr><th>{}</th><td>{}</td><td>{}</td><td>{first}</td><td>{last}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                words.date(day.date),
                words.get(name),
                hm(found.sun_hours()),
                hm(found.longest()),
                without.map_or("–".to_owned(), hm),
                hm(unproven),
            );
        }
    }
    let keys = ["date", "sun", "first", "last", "longest", "without-trees", "unproven"].map(|key| words.get(key));
    let rest: String = keys[1..].iter().map(|name| format!("<th>{name}</th>")).collect();
    format!("<table><thead><tr><th>{}</th><th></th>{rest}</tr></thead><tbody>{rows}</tbody></table>", keys[0])
}

/// Shortest loss that is listed, hours: half a minute. Shorter ones are the rounding of stretches.
const SHORTEST_LOSS: f32 = 0.5 / 60.0;

/// Stretches of sun that a plan takes away: date, start and end on the clock, and the obstacle.
fn lost_sun(report: &SunlightReport, window: usize) -> Vec<(Date, f32, f32, SunObstacle)> {
    let Some(after) = &report.after else { return Vec::new() };
    let (before, planned) = (&report.before.calendar, &after.calendar);
    let days = before.schedule.days.iter().zip(before.days[window].iter().zip(&planned.days[window]));
    let mut lost = Vec::new();
    for (day, (was, will)) in days {
        for sun in was.sun() {
            for shade in will.0.iter().filter(|stretch| stretch.obstacle != SunObstacle::None) {
                let (start, end) = (sun.start.max(shade.start), sun.end.min(shade.end));
                if end - start > SHORTEST_LOSS {
                    lost.push((day.date, start, end, shade.obstacle));
                }
            }
        }
    }
    lost
}

/// Stretches of sun that the plan takes.
fn lost_table(report: &SunlightReport, window: usize, words: &Words) -> String {
    let Some(after) = &report.after else { return String::new() };
    let lost = lost_sun(report, window);
    if lost.is_empty() {
        return format!("<p>{}</p>", words.get("nothing-lost"));
    }
    let row = |(date, start, end, obstacle): &(Date, f32, f32, _)| {
        let [from, to] = [start, end].map(|&hour| clock_time(hour.into()));
        let object = file_of(after, *obstacle).unwrap_or_else(|| name_of(*obstacle, words).to_owned());
        let minutes = (f64::from(end - start) * 60.0).round();
        format!(
            "<tr><th>{}</th><td>{from}</td><td>{to}</td><td>{minutes:.0}</td><td>{}</td></tr>",
            words.date(*date),
            escaped(&object)
        )
    };
    let rows: String = lost.iter().map(row).collect();
    let head: String = ["date", "from", "to", "minutes"].map(|key| format!("<th>{}</th>", words.get(key))).concat();
    format!("<h4>{}</h4><table><thead><tr>{head}<th></th></tr></thead><tbody>{rows}</tbody></table>", words.get("lost"))
}

fn details(report: &SunlightReport, words: &Words) -> String {
    let params = &report.params;
    let site = report.before.calendar.site;
    let [latitude, longitude] = [site.latitude, site.longitude].map(f64::to_degrees);
    let [count, density] = report.points;
    let flown = report.flown.map(|[from, to]| match from == to {
        true => format!("{}, ", words.date(from)),
        false => format!("{}, ", words.with("flown", &[("from", &words.date(from)), ("to", &words.date(to))])),
    });
    let points = flown.unwrap_or_default()
        + &words.with("points", &[("count", &words.number(count, 0)), ("density", &words.number(density, 1))]);
    let file = |source: &super::ReportSource| {
        let hash = match source.sha256.is_empty() {
            true => String::new(),
            false => format!("<br>{}", code(&format!("SHA-256 {}", source.sha256))),
        };
        let role = match source.role {
            "plan" => words.get("plan"),
            "windows" => words.get("windows"),
            "areas" => words.get("areas"),
            "terrain" => words.get("terrain"),
            _ => words.get("cloud"),
        };
        format!("{} ({role}){hash}<br>", escaped(&source.name))
    };
    let files: String = params.sources.iter().map(file).collect();
    let rows = [
        (
            words.get("made-on"),
            Date::parse(&params.date).map_or_else(|_| escaped(&params.date), |date| words.date(date)),
        ),
        (words.get("place"), format!("{latitude:.5}, {longitude:.5}")),
        (words.get("system"), escaped(&report.reference_system)),
        (words.get("clock"), escaped(report.before.calendar.zone.name())),
        (words.get("survey"), points),
        (words.get("files"), files),
        (words.get("program"), format!("Belvedere {}", env!("CARGO_PKG_VERSION"))),
        (words.get("command"), code(&params.command)),
    ];
    let row = |(name, value): &(&str, String)| format!("<tr><th>{name}</th><td class='text'>{value}</td></tr>");
    let rows: String = rows.iter().filter(|(_, value)| !value.is_empty()).map(row).collect();
    format!("<h2>{}</h2><table class='details'><tbody>{rows}</tbody></table>", words.get("details"))
}

fn limits(report: &SunlightReport, words: &Words) -> String {
    let steps = || report.before.calendar.schedule.days.iter().flat_map(|day| &day.steps);
    let step = steps().map(|step| f64::from(step.hours) * 60.0).fold(0.0, f64::max).round();
    let half = hours_in_words(step / 120.0);
    let step = format!("{step:.0}");
    let method = words.with("method-3", &[("step", &step), ("half", &half)]);
    let texts = [words.get("method-1"), words.get("method-2"), &method, words.get("method-4"), words.get("method-5")];
    let texts: String = texts.iter().map(|text| format!("<li>{text}</li>")).collect();
    let mut page = format!("<h2>{}</h2><ul>{texts}</ul>", words.get("limits"));
    if !report.remarks.is_empty() {
        let remarks: String =
            report.remarks.iter().map(|remark| format!("<li>{}</li>", escaped(&remark.text))).collect();
        let _ = write!(page, "<h3>{}</h3><ul lang='en'>{remarks}</ul>", words.get("remarks"));
    }
    page
}

/// File of the mesh that is an obstacle, without its folder; `None` for other obstacles.
fn file_of(state: &State, obstacle: SunObstacle) -> Option<String> {
    state.calendar.mesh_name(obstacle).map(crate::results::file_name)
}

/// All stretches as a table inside the page that can be saved: those of the days in detail and of critical days.
fn all_rows(report: &SunlightReport, words: &Words) -> String {
    let mut csv = "state,window,name,date,from,to,hours,obstacle,object,unproven_hours,day\n".to_owned();
    for (state_name, state) in report.states() {
        for (window, days) in state.calendar.days.iter().enumerate() {
            let name = report.params.window_name(window, words).replace(['"', '\n'], " ");
            let detailed = state.calendar.schedule.days.iter().zip(days).map(|(of, day)| ("detail", of.date, day));
            let rule = state.windows.get(window).and_then(|window| window.rule);
            let critical = rule.and_then(|rule| {
                Some(("critical", rule.date, state.of_rule.as_ref()?.days.get(window)?.get(rule.row)?))
            });
            for (kind, date, found) in detailed.chain(critical) {
                for stretch in &found.0 {
                    let [from, to] = [stretch.start, stretch.end].map(|hour| clock_time(hour.into()));
                    let _ = writeln!(
                        csv,
                        "{state_name},{},\"{name}\",{date},{from},{to},{:.3},{},\"{}\",{:.3},{kind}",
                        window + 1,
                        stretch.hours(),
                        stretch.obstacle.name(),
                        file_of(state, stretch.obstacle).unwrap_or_default().replace('"', " "),
                        stretch.unproven,
                    );
                }
            }
        }
    }
    let data = BASE64_STANDARD.encode(&csv);
    format!(
        "<h2>{}</h2><p>{} <a download='sunlight.csv' href='data:text/csv;base64,{data}'>sunlight.csv</a></p><details><summary>sunlight.csv</summary><pre>{}</pre></details>",
        words.get("rows"),
        words.get("rows-text"),
        escaped(&csv)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        assert!(
            scale_bar(330.0).contains("50 m") && scale_bar(90.0).contains("20 m") && scale_bar(5.0).contains("1 m")
        );
    }
}
