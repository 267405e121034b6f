//! Remarks on weather.

use super::context::Context;
use super::remark::Remark;
use crate::irradiance::clock_contradiction;
use crate::sun::Site;
use belvedere_data::report::rounded;
use belvedere_data::weather::{USUAL_WIND, Weather};

/// Distance of a weather station beyond which its file counts as that of another place, metres.
const FAR: f64 = 50_000.0;

/// Adds remarks on the place and the clock of weather.
pub(super) fn remark_on_place_of(weather: &Weather, site: &Site, context: &mut Context) {
    let distance = site.distance_to([weather.latitude, weather.longitude]);
    if distance > FAR {
        let text = format!("the weather is for a location {:.0} km away", distance / 1000.0);
        context.add(Some(Remark::warning("weather-far-away", text).with("distance_km", rounded(distance / 1000.0, 1))));
    }
    // a place where the sun has no times has no remark on them
    context.add(clock_contradiction(weather).ok().flatten().and_then(Remark::of_contradiction));
    for note in &weather.notes {
        context.add(Some(Remark::note("weather-note", note.clone())));
    }
}

/// A warning of rows of weather without wind.
pub(super) fn remark_on_wind(missing: usize, rows: usize) -> Option<Remark> {
    let so = format!("of the weather have no wind: {USUAL_WIND} m/s is assumed");
    Remark::of_share("rows-without-wind", missing, rows, "rows", &so)
}
