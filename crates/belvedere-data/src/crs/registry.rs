//! The database of coordinate reference systems, and projecting by it. Everything that names the crates for it is here.

use super::{Crs, CrsKind};
use proj_core::{AreaOfInterest, AxisOrder, Bounds, Coord, CrsDef, ProjectedCrsDef, SelectionOptions, Transform};
use std::sync::OnceLock;

/// The system that a code such as `EPSG:28992` or a PROJ string names.
pub(super) fn system(text: &str) -> Option<Crs> {
    let definition = proj_wkt::parse_crs(text).ok()?;
    let crs = from_definition(&definition);
    // a string of PROJ has no code: its parameters are kept as text
    let wkt = if crs.epsg.is_none() { proj_wkt::to_wkt(&definition).ok() } else { None };
    Some(Crs { wkt, ..crs })
}

/// The system with an EPSG code.
pub(super) fn system_of_code(code: u32) -> Option<Crs> {
    proj_core::lookup_epsg(code).map(|definition| from_definition(&definition))
}

/// Name of the system with an EPSG code.
pub(super) fn name_of_code(code: u32) -> Option<String> {
    Some(proj_core::lookup_epsg(code)?.name().to_owned())
}

/// Code of the horizontal part of the system with an EPSG code.
pub(super) fn horizontal_code_of(code: u32) -> Option<u32> {
    proj_core::lookup_epsg(code).and_then(|definition| horizontal_code(&definition))
}

/// Metres per unit of the vertical system with an EPSG code.
pub(super) fn vertical_metres_of_code(code: u32) -> Option<f64> {
    Some(proj_core::lookup_vertical_epsg(code)?.linear_unit_to_meter())
}

/// Name of the vertical system with an EPSG code, where it counts downwards.
pub(super) fn depth_of_code(code: u32) -> Option<String> {
    depth(&proj_core::lookup_vertical_epsg(code)?)
}

/// EPSG names systems that count downwards depths.
fn depth(vertical: &proj_core::VerticalCrsDef) -> Option<String> {
    Some(vertical.name()).filter(|name| name.to_ascii_lowercase().contains("depth")).map(str::to_owned)
}

/// Well-known text of the system that a code names.
pub(super) fn wkt(text: &str) -> Option<String> {
    proj_wkt::to_wkt(&proj_wkt::parse_crs(text).ok()?).ok()
}

/// Conversion between longitude and latitude of WGS 84 in degrees and the coordinates of a system.
pub(super) struct CrsProjection {
    definition: String,
    /// Conversion with the step between datums that is best for the area of the system.
    of_area: Projecting,
    /// Conversion with the step that is best at the first place; on failure the reason.
    near: OnceLock<Result<Projecting, String>>,
}

impl CrsProjection {
    /// The projection into the system that a code or well-known text names; on failure the reason.
    pub(super) fn new(definition: &str) -> Result<Self, String> {
        let system = parsed(definition)?;
        if system.horizontal_crs().is_some_and(|horizontal| TOO_COARSE.contains(&horizontal.epsg())) {
            return Err("the steps between datums that are known for it are too coarse".to_owned());
        }
        let area = system.horizontal_crs().and_then(|horizontal| area_of_use(horizontal.epsg()));
        let [west, south, east, north] = area.unwrap_or([-180.0, -90.0, 180.0, 90.0]);
        let bounds = Bounds::new(west, south, east, north);
        let interest = if west < east {
            AreaOfInterest::geographic_bounds(bounds)
        } else {
            AreaOfInterest::geographic_wrapped_bounds(bounds)
        };
        let options = SelectionOptions::new();
        let options = if area.is_some() { options.with_area_of_interest(interest) } else { options };
        let of_area = Projecting::new(&system, definition, options)?;
        Ok(Self { definition: definition.to_owned(), of_area, near: OnceLock::new() })
    }

    /// The projection alone, from longitude and latitude of a datum that nothing ties to WGS 84: true to directions,
    /// not to places.
    pub(super) fn untied(definition: &str) -> Result<Self, String> {
        let of_area = Projecting::untied(&parsed(definition)?)?;
        let near = OnceLock::from(Ok(of_area.clone()));
        Ok(Self { definition: definition.to_owned(), of_area, near })
    }

    /// Coordinates of a longitude and latitude in degrees; on failure the reason.
    pub(super) fn forward(&self, longitude: f64, latitude: f64) -> Result<(f64, f64), String> {
        self.projecting_near(longitude, latitude)?.forward(longitude, latitude)
    }

    /// Longitude and latitude in degrees of coordinates; on failure the reason.
    pub(super) fn back(&self, x: f64, y: f64) -> Result<(f64, f64), String> {
        if let Some(near) = self.near.get() {
            return near.as_ref().map_err(Clone::clone)?.back(x, y);
        }
        let (longitude, latitude) = self.of_area.back(x, y)?;
        self.projecting_near(longitude, latitude)?.back(x, y)
    }

    fn projecting_near(&self, longitude: f64, latitude: f64) -> Result<&Projecting, String> {
        let choose = || {
            if self.of_area.is_without_step() {
                return Ok(self.of_area.clone());
            }
            let place = Coord::new(longitude, latitude);
            let options = SelectionOptions::new().with_area_of_interest(AreaOfInterest::geographic_point(place));
            let near = Projecting::new(&parsed(&self.definition)?, &self.definition, options)?;
            match &near.forward.selected_operation().area_of_use {
                Some(area) if !area.contains_point(place) => {
                    Err(format!("no step between its datum and WGS 84 is known at {latitude:.2}, {longitude:.2}"))
                }
                _ => Ok(near),
            }
        };
        self.near.get_or_init(choose).as_ref().map_err(Clone::clone)
    }
}

/// A projection with one step between datums.
#[derive(Clone)]
struct Projecting {
    forward: Transform,
    inverse: Option<Transform>,
    /// Well-known text may name its axes north first; coordinates of files are east first.
    is_north_first: bool,
}

impl Projecting {
    fn new(system: &CrsDef, definition: &str, options: SelectionOptions) -> Result<Self, String> {
        let transform = |options| {
            proj_wkt::transform_from_crs_strings_horizontal_with_selection_options("EPSG:4326", definition, options)
                .map_err(|error| error.to_string())
        };
        let found = match transform(options.clone()) {
            Ok(found) => found,
            Err(_) if is_geocentric(system) => return Self::untied(system),
            Err(reason) => return Err(reason),
        };
        let is_withdrawn = found.selected_operation().deprecated;
        let others = || {
            let wgs_84 = proj_core::lookup_epsg(4326)?;
            proj_core::operation_candidates_between_with_selection_options(&wgs_84, system, &options).ok()
        };
        let valid = is_withdrawn.then(others).flatten().into_iter().flatten().filter(|other| !other.deprecated);
        let valid = valid.filter_map(|other| transform(options.clone().with_operation(other.id?)).ok()).next();
        Ok(Self::of(valid.unwrap_or(found)))
    }

    /// Creates the conversion without a step between datums.
    fn untied(system: &CrsDef) -> Result<Self, String> {
        let wgs_84 = proj_core::lookup_epsg(4326).ok_or("WGS 84 is not in the database")?;
        let horizontal = system.horizontal_crs().ok_or("it has no horizontal part")?;
        let plain = match horizontal.as_projected() {
            Some(own) => {
                let datum = wgs_84.datum().clone();
                CrsDef::Projected(ProjectedCrsDef::new(0, datum, own.method(), own.linear_unit(), ""))
            }
            None if horizontal.is_geographic() => wgs_84.clone(),
            None => return Err("it is not projected".to_owned()),
        };
        Transform::from_crs_defs(&wgs_84, &plain).map(Self::of).map_err(|error| error.to_string())
    }

    fn of(forward: Transform) -> Self {
        let is_north_first = forward.target_crs().axis_order() == Some(AxisOrder::NorthEast);
        Self { inverse: forward.inverse().ok(), forward, is_north_first }
    }

    /// Returns true if both datums are treated as one.
    fn is_without_step(&self) -> bool {
        self.forward.selected_operation().id.is_none()
    }

    fn forward(&self, longitude: f64, latitude: f64) -> Result<(f64, f64), String> {
        let (x, y) = self.forward.convert((longitude, latitude)).map_err(|e| e.to_string())?;
        Ok(if self.is_north_first { (y, x) } else { (x, y) })
    }

    fn back(&self, x: f64, y: f64) -> Result<(f64, f64), String> {
        let inverse = self.inverse.as_ref().ok_or_else(|| "the system has no inverse".to_owned())?;
        let place = if self.is_north_first { (y, x) } else { (x, y) };
        inverse.convert(place).map_err(|e| e.to_string())
    }
}

fn parsed(definition: &str) -> Result<CrsDef, String> {
    proj_wkt::parse_crs(definition).map_err(|error| error.to_string())
}

/// Returns true if a datum is a frame of the whole earth, as all are of the ellipsoids of GRS 80, WGS 84 and CGCS2000:
/// these agree with WGS 84 to 2 m. Exceptions have such an ellipsoid and other axes.
fn is_geocentric(system: &CrsDef) -> bool {
    let ellipsoid = system.datum().ellipsoid();
    let base = system.base_geographic_crs_epsg().and_then(name_of_code).unwrap_or_default();
    (ellipsoid.b() - 6_356_752.314).abs() < 1e-3
        && (ellipsoid.inverse_flattening() - 298.257_222).abs() < 1e-5
        && !["IRF", "Intermediate", "Israel"].iter().any(|word| base.contains(word))
        && !system.name().contains("Israel")
}

/// Systems of NAD27 whose places are more than 20 m off those of PROJ, as `tests/reference_systems` found.
const TOO_COARSE: [u32; 9] = [3797, 26_709, 26_719, 26_720, 26_731, 32_084, 32_085, 32_086, 32_098];

/// Areas of use: west, south, east, north in degrees, then the codes of projected systems.
const AREAS: &str = include_str!("areas.txt");

/// West, south, east and north of the area of use of a projected system, degrees; west is greater across 180°.
pub(super) fn area_of_use(code: u32) -> Option<[f64; 4]> {
    let wanted = code.to_string();
    let line = AREAS.lines().find(|line| line.split(' ').skip(4).any(|code| code == wanted))?;
    let mut numbers = line.split(' ').map_while(|number| number.parse().ok());
    Some([numbers.next()?, numbers.next()?, numbers.next()?, numbers.next()?])
}

fn from_definition(definition: &CrsDef) -> Crs {
    let horizontal = definition.as_projected().map_or(1.0, ProjectedCrsDef::linear_unit_to_meter);
    let vertical = definition.vertical_crs();
    Crs {
        wkt: None,
        epsg: Some(definition.epsg()).filter(|&code| code != 0).or_else(|| horizontal_code(definition)),
        vertical_epsg: vertical.map(proj_core::VerticalCrsDef::epsg).filter(|&code| code != 0),
        metres_per_unit: horizontal,
        vertical_metres_per_unit: vertical.map_or(horizontal, proj_core::VerticalCrsDef::linear_unit_to_meter),
        kind: if definition.is_geocentric() {
            CrsKind::Geocentric
        } else if definition.is_geographic() {
            CrsKind::Geographic
        } else {
            CrsKind::Projected
        },
        doubt: vertical.and_then(depth).map(|name| super::counts_down(&name)),
    }
}

fn horizontal_code(definition: &CrsDef) -> Option<u32> {
    definition.horizontal_crs().map(|horizontal| horizontal.epsg()).filter(|&code| code != 0)
}
