//! Time zone of a place on earth.
//!
//! # Source
//! tz_world (Eric Muller, 2013, public domain), as cells of a quarter of a degree.

use super::{Site, Zone};
use belvedere_data::cast::to_index;

const CELLS: &str = include_str!("zones.txt");
/// Cells a degree.
const CELLS_PER_DEGREE: f64 = 4.0;

/// Time zone of a place.
#[derive(Clone, Debug, PartialEq)]
pub struct ZoneOfPlace {
    /// The zone of most of the land around the place.
    pub zone: Zone,
    /// Zones nearby whose clocks differ from it: the place may lie in one of them.
    pub others: Vec<Zone>,
}

impl ZoneOfPlace {
    /// Returns the time zone of a site; `None` at sea.
    #[must_use]
    pub fn of(site: &Site) -> Option<Self> {
        let mut lines = CELLS.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<&str> = lines.next()?.split(' ').collect();
        let runs =
            lines.nth(cell(site.latitude, 90.0)?)?.split(' ').map(|run| run.split_once(':').unwrap_or((run, "")));
        let column = cell(site.longitude, 180.0)?;
        let mut end = 0;
        let ends = runs.map_while(|(count, zones)| {
            end += count.parse::<usize>().ok()?;
            Some((end, zones))
        });
        let (_, zones) = ends.into_iter().find(|&(end, _)| column < end)?;
        let mut zones =
            zones.split('/').filter_map(|number| Zone::parse(names.get(number.parse::<usize>().ok()?)?).ok());
        Some(Self { zone: zones.next()?, others: zones.collect() })
    }
}

/// Returns the number of the row or column of cells that holds an angle, radians; `None` where it is not from −`limit`
/// to `limit`, degrees.
fn cell(angle: f64, limit: f64) -> Option<usize> {
    let degrees = angle.to_degrees();
    let last = 2.0 * limit * CELLS_PER_DEGREE - 1.0;
    let index = ((degrees + limit) * CELLS_PER_DEGREE).floor().min(last);
    (degrees.abs() <= limit).then_some(to_index(index))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(latitude: f64, longitude: f64) -> Option<ZoneOfPlace> {
        let [latitude, longitude] = [latitude, longitude].map(f64::to_radians);
        ZoneOfPlace::of(&Site { latitude, longitude, height: 0.0, convergence: 0.0 })
    }

    #[test]
    fn cities_have_their_zones() {
        let cities = [
            (52.01, 4.36, "Europe/Amsterdam"),
            (48.86, 2.35, "Europe/Paris"),
            (38.72, -9.14, "Europe/Lisbon"),
            (51.51, -0.13, "Europe/London"),
            (60.17, 24.94, "Europe/Helsinki"),
            (40.71, -74.0, "America/New_York"),
            (39.74, -104.99, "America/Denver"),
            (37.77, -122.42, "America/Los_Angeles"),
            (-23.55, -46.63, "America/Sao_Paulo"),
            (28.61, 77.21, "Asia/Kolkata"),
            (35.68, 139.69, "Asia/Tokyo"),
            (1.35, 103.82, "Asia/Singapore"),
            (-33.87, 151.21, "Australia/Sydney"),
            (-36.85, 174.76, "Pacific/Auckland"),
            (-33.92, 18.42, "Africa/Johannesburg"),
            (64.15, -21.94, "Atlantic/Reykjavik"),
        ];
        for (latitude, longitude, name) in cities {
            let found = at(latitude, longitude).unwrap();
            assert_eq!((found.zone.name(), found.others.len()), (name, 0));
        }
    }

    #[test]
    fn places_at_borders_have_the_zones_of_both_sides() {
        let names = |latitude, longitude| {
            let found = at(latitude, longitude).unwrap();
            let mut names = vec![found.zone.name().to_owned()];
            names.extend(found.others.iter().map(|zone| zone.name().to_owned()));
            names
        };
        let mut elvas = names(38.88, -7.1);
        elvas.sort();
        assert_eq!(elvas, ["Europe/Lisbon", "Europe/Madrid"]);
        // clocks of both sides agree
        assert_eq!(names(50.77, 6.05).len(), 1);
    }

    #[test]
    fn the_open_sea_has_no_zone() {
        assert_eq!([at(0.0, -30.0), at(90.0, 180.0), at(f64::NAN, 0.0), at(91.0, 0.0)], [const { None }; 4]);
    }

    #[test]
    fn each_row_holds_all_cells_of_known_zones() {
        let mut lines = CELLS.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<&str> = lines.next().unwrap().split(' ').collect();
        assert!(names.iter().all(|name| Zone::parse(name).is_ok()));
        let rows: Vec<&str> = lines.collect();
        assert_eq!(rows.len(), 720);
        for row in rows {
            let runs = row.split(' ').map(|run| run.split_once(':').unwrap_or((run, "")));
            let mut cells = 0;
            for (count, zones) in runs {
                cells += count.parse::<usize>().unwrap();
                let numbers = zones.split('/').filter(|number| !number.is_empty());
                assert!(numbers.map(|number| number.parse::<usize>().unwrap()).all(|number| number < names.len()));
            }
            assert_eq!(cells, 1440);
        }
    }
}
