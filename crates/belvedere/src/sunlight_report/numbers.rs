//! Numbers of a report as its reader wants them.

use crate::cast::to_index;

/// Hours as hours and minutes: 3:12.
pub(super) fn hm(hours: f64) -> String {
    if !hours.is_finite() {
        return "–".to_owned();
    }
    let minutes = (hours.abs() * 60.0).round();
    let sign = if hours < 0.0 && minutes > 0.0 { "−" } else { "" };
    format!("{sign}{}:{:02}", to_index(minutes) / 60, to_index(minutes) % 60)
}

/// A change of hours in minutes, with its sign.
pub(super) fn change(before: f64, after: f64) -> String {
    let minutes = ((after - before) * 60.0).round();
    match minutes {
        _ if !minutes.is_finite() => "–".to_owned(),
        minutes if minutes < 0.0 => format!("−{:.0}", -minutes),
        minutes if minutes > 0.0 => format!("+{minutes:.0}"),
        _ => "0".to_owned(),
    }
}

/// Hours in a sentence: 3 h 12 min.
pub(super) fn hours_in_words(hours: f64) -> String {
    let minutes = to_index((hours * 60.0).round());
    match (minutes / 60, minutes % 60) {
        (0, minutes) => format!("{minutes} min"),
        (hours, 0) => format!("{hours} h"),
        (hours, minutes) => format!("{hours} h {minutes} min"),
    }
}

/// A share in percent.
pub(super) fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.0}", 100.0 * share) } else { "–".to_owned() }
}

/// Returns true if hours before and after a plan are the same to the minute.
pub(super) fn is_unchanged(before: f64, after: f64) -> bool {
    ((after - before) * 60.0).round() == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hours_are_hours_and_minutes() {
        assert_eq!([3.2, 0.999, -0.5, 0.0, f64::NAN].map(hm), ["3:12", "1:00", "−0:30", "0:00", "–"]);
        assert_eq!(change(2.0, 1.5), "−30");
        assert_eq!(change(1.5, 2.0), "+30");
        assert_eq!(change(1.5, 1.5001), "0");
    }

    #[test]
    fn hours_are_words() {
        assert_eq!([3.2, 2.0, 0.25].map(hours_in_words), ["3 h 12 min", "2 h", "15 min"]);
        assert!(is_unchanged(1.5, 1.5001) && !is_unchanged(1.5, 1.52));
    }
}
