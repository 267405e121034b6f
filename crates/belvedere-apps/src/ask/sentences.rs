//! Sentences on what was found at single places.

use super::casters::{CASTER, caster_name};
use super::sections::{HeightFrom, PlaceSection};
use crate::shadow::{LIT, UNPROVEN};
use crate::sum_errors::INTERVAL_MEASURES;
use crate::targets::Measure;
use belvedere_data::cast::to_u8;
use belvedere_data::report::clock_time;

/// Places that have a sentence of their own.
const MAX_SENTENCES: usize = 5;
/// Figures of a sentence.
const MAX_FIGURES: usize = 5;

/// A sentence for each of few places.
pub(super) fn sentences(places: &[PlaceSection], measures: &[Measure]) -> Vec<String> {
    if places.len() > MAX_SENTENCES {
        return Vec::new();
    }
    places.iter().enumerate().map(|(row, place)| sentence(place, measures, row)).collect()
}

fn sentence(place: &PlaceSection, measures: &[Measure], row: usize) -> String {
    let [x, y, z] = place.position;
    let on = match place.height_from {
        HeightFrom::Given => "",
        HeightFrom::Ground => ", on the ground",
        HeightFrom::Cover => ", on what stands there",
    };
    let value = |measure: &Measure| measure.values.get(row).copied().map(f64::from).filter(|value| value.is_finite());
    let named = |name: &str| measures.iter().find(|measure| measure.name == name).and_then(value);
    if let (Some(metres), Some(share)) = (named("metres"), named("share")) {
        let mut text = format!("{metres:.0} visible metres of towers ({:.1} %)", 100.0 * share);
        if metres > 0.0 {
            for (name, what) in [("towers", "towers with a visible part"), ("tips", "tips"), ("hubs", "hubs")] {
                text += &named(name).map_or(String::new(), |count| format!(", {what}: {count:.0}"));
            }
            if let (Some(angle), Some(nearest)) = (named("angle_deg"), named("nearest_m")) {
                text += &format!(", up to {angle:.2}° high, the nearest {nearest:.0} m away");
            }
        }
        let unproven =
            if named(UNPROVEN) == Some(1.0) { "; no pulse proves that the largest part is visible" } else { "" };
        return format!("at {x:.1}, {y:.1} (height {z:.1}{on}): {text}{unproven}");
    }
    let found = match (named("sun_hours"), named("hours_low"), named("hours_high")) {
        (Some(hours), low, high) => {
            let mut text = format!("{hours:.1} h of sun a day");
            if let (Some(low), Some(high)) = (low, high) {
                text += &format!(", with 90 % {low:.1} to {high:.1} h");
            }
            for (name, what) in [("first_light", "first"), ("last_light", "last")] {
                if let Some(hour) = named(name) {
                    text += &format!(", {what} {}", clock_time(hour));
                }
            }
            for measure in measures.iter().filter(|measure| measure.description == crate::sun_hours::RULE_IS_MET) {
                let is_met = value(measure).is_some_and(|met| met > 0.5);
                text += &format!(", {}: {}", measure.name, if is_met { "met" } else { "not met" });
            }
            text
        }
        _ => {
            let of_suns: Vec<(&Measure, f64)> = measures
                .iter()
                .filter(|measure| measure.description == LIT)
                .filter_map(|measure| Some((measure, value(measure)?)))
                .collect();
            let has_several_suns = of_suns.len() > 1;
            let is_end =
                |measure: &Measure| INTERVAL_MEASURES[1..].iter().any(|(_, text)| *text == measure.description);
            let ends: Vec<String> = measures
                .iter()
                .filter(|measure| is_end(measure))
                .filter_map(|end| Some(format!("{:.*}", end.decimals.min(3), value(end)?)))
                .collect();
            let others =
                measures.iter().filter(|measure| !(is_end(measure) || has_several_suns && measure.description == LIT));
            let words = others.filter_map(|measure| Some(figure(measure, value(measure)?)));
            let light = has_several_suns.then(|| light_of_suns(&of_suns));
            let figures = light.into_iter().chain(words).filter(|text| !text.is_empty());
            let interval = <[String; 2]>::try_from(ends).ok().map(|[low, high]| format!("with 90 % {low} to {high}"));
            let figures: Vec<String> = figures.take(MAX_FIGURES).chain(interval).collect();
            if figures.is_empty() { "no answer".to_owned() } else { figures.join(", ") }
        }
    };
    format!("at {x:.1}, {y:.1} (height {z:.1}{on}): {found}")
}

/// Light of several suns in their order: equal ones together, from the first to the last time.
fn light_of_suns(suns: &[(&Measure, f64)]) -> String {
    let mut stretches: Vec<(String, [String; 2])> = Vec::new();
    let mut date = String::new();
    for (measure, value) in suns {
        let time =
            measure.tags.iter().find(|(name, _)| name == "TIME").and_then(|(_, time)| time.get(..16)?.split_once('T'));
        let label = match time {
            Some((day, clock)) if day == date => clock.to_owned(),
            Some((day, clock)) => {
                day.clone_into(&mut date);
                format!("{day} {clock}")
            }
            None => measure.name.clone(),
        };
        let words = light_in_words(*value);
        match stretches.last_mut() {
            Some((same, [_, last])) if *same == words => *last = label,
            _ => stretches.push((words, [label.clone(), label])),
        }
    }
    let in_words = |(words, [first, last]): &(String, [String; 2])| match first == last {
        true => format!("{first} {words}"),
        false => format!("{first} to {last} {words}"),
    };
    stretches.iter().map(in_words).collect::<Vec<_>>().join(", ")
}

fn light_in_words(share: f64) -> String {
    match share {
        0.0 => "in shadow".to_owned(),
        1.0 => "lit".to_owned(),
        share => format!("{:.0} % of the sun", 100.0 * share),
    }
}

/// A measure in words; empty where it adds nothing.
fn figure(measure: &Measure, value: f64) -> String {
    if measure.name == UNPROVEN {
        return if value > 0.0 { "unproven".to_owned() } else { String::new() };
    }
    if measure.name.starts_with(CASTER) {
        let number = to_u8(value);
        return if number == 0 { String::new() } else { format!("shaded by: {}", caster_name(number, &[])) };
    }
    if measure.description == LIT {
        return light_in_words(value);
    }
    let name = if measure.description.is_empty() { &measure.name } else { measure.description };
    format!("{name} {value:.*}", measure.decimals.min(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_says_hours_with_their_interval_and_clocks() {
        let place = PlaceSection { position: [1.0, 2.0, 3.25], height_from: HeightFrom::Ground };
        let measures: Vec<Measure> = [
            ("sun_hours", 4.91),
            ("hours_low", 4.3),
            ("hours_high", 5.4),
            ("first_light", 9.669),
            ("last_light", 15.16),
        ]
        .map(|(name, value)| Measure::new(name, vec![value]))
        .into();
        assert_eq!(
            sentences(&[place], &measures),
            [
                "at 1.0, 2.0 (height 3.2, on the ground): 4.9 h of sun a day, with 90 % 4.3 to 5.4 h, first 09:40, last 15:10"
            ]
        );
        let sun = |clock: &str, lit: f32| {
            let tags = [("TIME".to_owned(), format!("2026-03-21T{clock}:00+01:00"))];
            Measure::new("lit", vec![lit]).with_description(LIT).with_tags(&tags)
        };
        let day = [sun("07:00", 0.0), sun("08:00", 1.0), sun("09:00", 1.0), sun("10:00", 0.25), sun("11:00", 0.0)];
        assert!(
            sentences(&[place], &day)[0]
                .ends_with(": 2026-03-21 07:00 in shadow, 08:00 to 09:00 lit, 10:00 25 % of the sun, 11:00 in shadow")
        );
        let sky = |name, description, value| Measure::new(name, vec![value]).with_description(description);
        let view = [
            sky("sky_view", "sky view factor", 0.5),
            sky("sky_low", INTERVAL_MEASURES[1].1, 0.25),
            sky("sky_high", INTERVAL_MEASURES[2].1, 0.75),
        ];
        let sentence = &sentences(&[place], &view)[0];
        assert!(sentence.contains("sky view factor 0.5") && sentence.contains(", with 90 % 0.25"), "{sentence}");
        let nothing = [Measure::new("sky", vec![f32::NAN])];
        assert!(sentences(&[place], &nothing)[0].ends_with("no answer"));
    }
}
