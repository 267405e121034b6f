//! Partial parser of well-known text, versions 1 and 2, for kind, unit and codes. It also accepts files that deviate
//! from the standard, such as a vertical system inside the projected one, or feet with the factor 1.

use super::{Crs, CrsKind, INTERNATIONAL_FOOT, US_SURVEY_FOOT};

/// Nesting beyond this is no reference system but an attack.
const MAX_DEPTH: usize = 40;

const VERTICAL: &[&str] = &["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"];

/// One `KEYWORD[value, value, KEYWORD[…]]`.
#[derive(Default)]
struct WktNode {
    keyword: String,
    values: Vec<String>,
    children: Vec<WktNode>,
}

/// The system that well-known text describes, or `None` where it cannot be understood.
pub(super) fn read(text: &str) -> Option<Crs> {
    let compound = compound_of_two(text);
    let text = compound.as_deref().unwrap_or(text);
    let root = parse(text)?;
    let horizontal = horizontal(&root)?;
    let kind = kind(horizontal)?;
    let metres_per_unit = if kind == CrsKind::Geographic { 1.0 } else { unit(horizontal).unwrap_or(1.0) };
    let vertical = root.find(VERTICAL);
    let heights = vertical.and_then(unit).or_else(|| unit_of_third_axis(horizontal));
    let crs = Crs {
        wkt: Some(text.to_owned()),
        epsg: root.epsg().or_else(|| horizontal.epsg()),
        vertical_epsg: vertical.and_then(WktNode::epsg),
        metres_per_unit,
        vertical_metres_per_unit: heights.unwrap_or(metres_per_unit),
        kind,
        doubt: None,
    };
    let of_axes = doubt_of_axes(horizontal, vertical);
    let doubts = [doubt(&root, &crs), of_axes, doubt_of_units(kind, horizontal, vertical)];
    Some(doubts.into_iter().flatten().fold(crs, Crs::doubted))
}

/// The compound of two systems that follow each other, as programs of Esri write a system with heights:
/// `PROJCS[…],VERTCS[…]`. `None` for other text.
fn compound_of_two(text: &str) -> Option<String> {
    let (first, end) = parse_first(text)?;
    let rest = text.get(end..)?.trim_start_matches(|c: char| c == ',' || c.is_whitespace());
    let (second, length) = parse_first(rest)?;
    let is_pair = kind(&first).is_some() && VERTICAL.contains(&second.keyword.as_str());
    let name = |node: &WktNode| node.values.first().cloned().unwrap_or_default().replace('"', "");
    // version 2 says a compound by another word
    let word =
        if ["PROJCS", "GEOGCS", "LOCAL_CS"].contains(&first.keyword.as_str()) { "COMPD_CS" } else { "COMPOUNDCRS" };
    let parts = || {
        let (first_text, second_text) = (text.get(..end)?.trim(), rest.get(..length)?);
        Some(format!("{word}[\"{} + {}\",{first_text},{second_text}]", name(&first), name(&second)))
    };
    is_pair.then(parts)?
}

/// Metres per unit of the third axis of a system with three, or of its unit of lengths beside that of its plane.
fn unit_of_third_axis(horizontal: &WktNode) -> Option<f64> {
    let of_lengths = horizontal.children.iter().find(|child| child.keyword == "LINUNIT").and_then(metres);
    let third = horizontal.children.iter().filter(|child| child.keyword == "AXIS").nth(2);
    third.and_then(unit).or(of_lengths)
}

/// Describes the evidence against axes: heights that count downwards, and places that count to the west, are read as
/// heights and eastings.
fn doubt_of_axes(horizontal: &WktNode, vertical: Option<&WktNode>) -> Option<String> {
    let directions = |node: &WktNode| -> Vec<String> {
        let of_axis = |child: &WktNode| child.values.get(1).map(|direction| direction.to_ascii_lowercase());
        node.children.iter().filter(|child| child.keyword == "AXIS").filter_map(of_axis).collect()
    };
    let third = directions(horizontal).into_iter().nth(2);
    let of_heights = vertical.map(directions).unwrap_or_default().into_iter().next().or(third);
    let is_turned = vertical.and_then(|node| node.parameter(&["direction"])).is_some_and(|way| way < 0.0);
    if of_heights.as_deref() == Some("down") || is_turned {
        return Some("its heights count downwards (depths), and were read as if they counted upwards; turn their sign before, or give the system of upward heights".to_owned());
    }
    let is_west = directions(horizontal).iter().take(2).any(|direction| direction == "west");
    is_west.then(|| "an axis counts to the west, and was read as if it counted to the east".to_owned())
}

/// Describes the evidence against an impossible unit: zero, negative, or no number.
fn doubt_of_units(kind: CrsKind, horizontal: &WktNode, vertical: Option<&WktNode>) -> Option<String> {
    let of_plane = Some(horizontal).filter(|_| kind != CrsKind::Geographic);
    of_plane.into_iter().chain(vertical).find_map(|node| {
        let own = |node: &WktNode| node.children.iter().find(|child| is_unit(child)).map(|unit| unit.values.clone());
        let values =
            own(node).or_else(|| node.children.iter().filter(|child| child.keyword == "AXIS").find_map(own))?;
        let is_sound =
            values.get(1).and_then(|factor| factor.parse().ok()).is_some_and(|factor| UNITS.contains(&factor));
        let [name, factor] = [0, 1].map(|i| values.get(i).map_or("", String::as_str));
        (!is_sound)
            .then(|| format!("its unit \"{name}\" has the factor {factor}, which no unit has; metres were taken"))
    })
}

fn is_unit(node: &WktNode) -> bool {
    node.keyword == "UNIT" || node.keyword == "LENGTHUNIT"
}

/// Metres in a unit that is believed.
const UNITS: std::ops::Range<f64> = 1e-6..1e6;

/// A box around where a projection is of use by its parameters, for systems without a code: west, south, east and
/// north, degrees. `None` for projections and base systems of which that is not known.
///
/// Zones and conics are used up to about these distances from their meridian and parallels. The box is wide: it is to
/// find another continent.
pub(super) fn area_by_parameters(text: &str) -> Option<[f64; 4]> {
    let root = parse(text)?;
    let system = horizontal(&root)?;
    let method = system.find(&["PROJECTION", "METHOD"])?.values.first()?.to_ascii_lowercase().replace('_', " ");
    let is_greenwich =
        system.find(&["PRIMEM"]).is_none_or(|node| node.values.get(1).is_some_and(|v| v.parse() == Ok(0.0)));
    let base = system.find(&["GEOGCS", "BASEGEOGCRS", "BASEGEODCRS"])?;
    let is_in_degrees = base.find(&["UNIT", "ANGLEUNIT"]).is_none_or(|unit| {
        unit.values.get(1).and_then(|v| v.parse::<f64>().ok()).is_some_and(|v| (v - 1_f64.to_radians()).abs() < 1e-6)
    });
    let meridian =
        system.parameter(&["central_meridian", "longitude of natural origin", "longitude of false origin"])?;
    let origin = system.parameter(&["latitude_of_origin", "latitude of natural origin", "latitude of false origin"]);
    let parallels = [
        system.parameter(&["standard_parallel_1", "latitude of 1st standard parallel"]),
        system.parameter(&["standard_parallel_2", "latitude of 2nd standard parallel"]),
    ];
    let around = |low: f64, high: f64, width: f64, height: f64| {
        [meridian - width, (low - height).max(-90.0), meridian + width, (high + height).min(90.0)]
    };
    let area = if method.contains("transverse mercator") || method.contains("gauss kruger") {
        around(-84.0, 84.0, 9.0, 0.0)
    } else if method.contains("conformal conic") || method.contains("albers") {
        let own: Vec<f64> = parallels.into_iter().flatten().collect();
        let own = if own.is_empty() { vec![origin?] } else { own };
        let [low, high] = [own.iter().copied().fold(f64::MAX, f64::min), own.iter().copied().fold(f64::MIN, f64::max)];
        around(low, high, 40.0, 20.0)
    } else if method.contains("stereographic") && origin.is_some_and(|latitude| latitude.abs() < 80.0) {
        let latitude = origin?;
        around(latitude, latitude, 12.0, 8.0)
    } else {
        return None;
    };
    (is_greenwich && is_in_degrees).then_some(area)
}

/// Returns true if the text has a vertical system.
pub(super) fn has_vertical_part(text: &str) -> bool {
    parse(text).is_some_and(|root| root.find(VERTICAL).is_some())
}

/// A compound of a horizontal system and heights in a unit of so many metres.
pub(super) fn with_heights(horizontal: &str, metres: f64) -> String {
    let (horizontal, unit) = (horizontal.trim(), format!("\"{}\",{metres}", super::unit_name(metres)));
    if horizontal.to_ascii_uppercase().starts_with("PROJCS") {
        let vertical = format!("VERT_CS[\"heights\",VERT_DATUM[\"unknown\",2005],UNIT[{unit}],AXIS[\"Up\",UP]]");
        return format!("COMPD_CS[\"with heights\",{horizontal},{vertical}]");
    }
    let axis = "CS[vertical,1],AXIS[\"gravity-related height (H)\",up]";
    format!(
        "COMPOUNDCRS[\"with heights\",{horizontal},VERTCRS[\"heights\",VDATUM[\"unknown\"],{axis},LENGTHUNIT[{unit}]]]"
    )
}

/// Describes a contradiction inside the text: between its zone of UTM and its central meridian, or its unit and that of
/// its code.
fn doubt(root: &WktNode, crs: &Crs) -> Option<String> {
    let horizontal = horizontal(root)?;
    let zone = crs.epsg.and_then(zone_of_code).or_else(|| zone_of_name(horizontal.values.first()?));
    let meridian = horizontal.parameter(&["central_meridian", "longitude of natural origin", "longitude_of_center"]);
    if let (Some(zone), Some(meridian)) = (zone, meridian)
        && (meridian - (6.0 * f64::from(zone) - 183.0)).abs() > 1e-6
    {
        return Some(format!(
            "its central meridian is {meridian}°, but that of UTM zone {zone} is {}°",
            6 * i64::from(zone) - 183
        ));
    }
    let by_code = super::registry::system_of_code(crs.epsg?)?;
    let [own, of_code] = [crs, &by_code].map(|crs| crs.metres_per_unit);
    if crs.kind == CrsKind::Projected && (own - of_code).abs() > 1e-7 * of_code {
        let [own, of_code] = [own, of_code].map(super::unit_name);
        return Some(format!("its unit is {own}, but that of EPSG:{} is {of_code}", crs.epsg?));
    }
    None
}

/// Zone of UTM of a code: WGS 84, WGS 72, NAD83, NAD27 and ETRS89.
fn zone_of_code(code: u32) -> Option<u32> {
    const FIRST: [(u32, u32, u32); 7] = [
        (32_601, 32_660, 32_600),
        (32_701, 32_760, 32_700),
        (32_201, 32_260, 32_200),
        (32_301, 32_360, 32_300),
        (26_901, 26_923, 26_900),
        (26_701, 26_722, 26_700),
        (25_828, 25_838, 25_800),
    ];
    FIRST.iter().find(|(first, last, _)| (first..=last).contains(&&code)).map(|(_, _, before)| code - before)
}

/// Zone of UTM that a name says, such as "NAD83 / UTM zone 10N" or `NAD_1983_UTM_Zone_10N`.
fn zone_of_name(name: &str) -> Option<u32> {
    let name = name.to_ascii_lowercase().replace('_', " ");
    let (_, after) = name.split_once("utm zone ")?;
    let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
    digits.parse().ok().filter(|zone| (1..=60).contains(zone))
}

/// Name of the system.
pub(super) fn name(text: &str) -> Option<String> {
    parse(text)?.values.into_iter().next()
}

/// Name of the horizontal part of the system.
pub(super) fn horizontal_name(text: &str) -> Option<String> {
    horizontal(&parse(text)?)?.values.first().cloned()
}

/// The text of the projected system within that of a compound; `None` for other text.
pub(super) fn horizontal_text(text: &str) -> Option<&str> {
    let root = parse(text)?;
    if !["COMPD_CS", "COMPOUNDCRS"].contains(&root.keyword.as_str()) {
        return None;
    }
    let start = ["PROJCS", "PROJCRS", "PROJECTEDCRS"].into_iter().filter_map(|keyword| text.find(keyword)).min()?;
    let part = text.get(start..)?;
    part.get(..parse_first(part)?.1)
}

fn horizontal(root: &WktNode) -> Option<&WktNode> {
    match root.keyword.as_str() {
        "COMPD_CS" | "COMPOUNDCRS" => {
            root.children.iter().find(|child| kind(child).is_some() || child.keyword == "BOUNDCRS").and_then(horizontal)
        }
        "BOUNDCRS" | "SOURCECRS" => root
            .children
            .iter()
            .find(|child| child.keyword == "SOURCECRS" || child.keyword == "COMPOUNDCRS" || kind(child).is_some())
            .and_then(horizontal),
        _ => Some(root),
    }
}

fn kind(node: &WktNode) -> Option<CrsKind> {
    match node.keyword.as_str() {
        "PROJCS" | "PROJCRS" | "PROJECTEDCRS" => Some(CrsKind::Projected),
        "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS" => Some(CrsKind::Geographic),
        "GEOCCS" => Some(CrsKind::Geocentric),
        "GEODCRS" | "GEODETICCRS" => {
            let cartesian = node.children.iter().any(|child| {
                child.keyword == "CS" && child.values.first().is_some_and(|v| v.eq_ignore_ascii_case("cartesian"))
            });
            Some(if cartesian { CrsKind::Geocentric } else { CrsKind::Geographic })
        }
        "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" => Some(CrsKind::Local),
        _ => None,
    }
}

/// Metres per length unit of a system: its own unit, or that of its first axis.
fn unit(node: &WktNode) -> Option<f64> {
    let own = |node: &WktNode| node.children.iter().find(|child| is_unit(child)).and_then(metres);
    own(node).or_else(|| node.children.iter().filter(|child| child.keyword == "AXIS").find_map(own))
}

fn metres(unit: &WktNode) -> Option<f64> {
    let name = unit.values.first()?.to_ascii_lowercase();
    let factor: f64 = unit.values.get(1)?.parse().ok()?;
    if name.contains("foot") || name.contains("feet") || name.starts_with("ft") {
        let survey = name.contains("us") || name.contains("u.s.") || name.contains("survey");
        if survey && (factor == 1.0 || (factor - US_SURVEY_FOOT).abs() < 1e-8) {
            return Some(US_SURVEY_FOOT);
        }
        if factor == 1.0 {
            return Some(INTERNATIONAL_FOOT);
        }
    }
    UNITS.contains(&factor).then_some(factor)
}

impl WktNode {
    fn epsg(&self) -> Option<u32> {
        self.children.iter().find(|child| child.keyword == "AUTHORITY" || child.keyword == "ID").and_then(|id| match id
            .values
            .as_slice()
        {
            [authority, code, ..] if authority.eq_ignore_ascii_case("EPSG") => code.parse().ok(),
            _ => None,
        })
    }

    /// A parameter of a projection by one of its names.
    fn parameter(&self, names: &[&str]) -> Option<f64> {
        let is_it = |node: &&Self| {
            let name = node.values.first().map(|name| name.to_ascii_lowercase()).unwrap_or_default();
            node.keyword == "PARAMETER" && names.contains(&name.as_str())
        };
        let own = self.children.iter().find(is_it).and_then(|node| node.values.get(1)?.parse().ok());
        own.or_else(|| self.children.iter().find_map(|child| child.parameter(names)))
    }

    fn find(&self, keywords: &[&str]) -> Option<&Self> {
        if keywords.contains(&self.keyword.as_str()) {
            return Some(self);
        }
        self.children.iter().find_map(|child| child.find(keywords))
    }
}

fn parse(text: &str) -> Option<WktNode> {
    Some(parse_first(text)?.0)
}

/// The first node of a text, and the byte behind it.
fn parse_first(text: &str) -> Option<(WktNode, usize)> {
    let mut open: Vec<WktNode> = Vec::new();
    let mut word = String::new();
    let mut quoted = false;
    let mut characters = text.char_indices().peekable();
    // Values are kept when the next separator shows that they were no keyword.
    let keep = |open: &mut Vec<WktNode>, word: &mut String| {
        if let (Some(node), false) = (open.last_mut(), word.is_empty()) {
            node.values.push(std::mem::take(word));
        }
    };
    while let Some((at, c)) = characters.next() {
        match c {
            '"' if quoted && characters.peek().is_some_and(|&(_, next)| next == '"') => {
                characters.next();
                word.push('"');
            }
            '"' => quoted = !quoted,
            _ if quoted => word.push(c),
            '[' | '(' => {
                if open.len() >= MAX_DEPTH {
                    return None;
                }
                open.push(WktNode { keyword: std::mem::take(&mut word).to_ascii_uppercase(), ..WktNode::default() });
            }
            ']' | ')' => {
                keep(&mut open, &mut word);
                let done = open.pop()?;
                match open.last_mut() {
                    Some(parent) => parent.children.push(done),
                    None => return Some((done, at + c.len_utf8())),
                }
            }
            ',' => keep(&mut open, &mut word),
            _ if c.is_whitespace() || c == '\0' => {}
            _ => word.push(c),
        }
    }
    None
}

#[cfg(all(test, feature = "crs"))]
mod tests {
    use crate::crs::Crs;
    use crate::crs::US_SURVEY_FOOT;

    /// UTM on WGS 84 as programs of Esri write it, without a code, with this unit.
    fn utm(zone: i32, unit: &str) -> String {
        let meridian = 6 * zone - 183;
        format!(
            "PROJCS[\"WGS_1984_UTM_Zone_{zone}N\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"False_Easting\",500000.0],PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",{meridian}.0],PARAMETER[\"Scale_Factor\",0.9996],PARAMETER[\"Latitude_Of_Origin\",0.0],{unit}]"
        )
    }

    const METRE: &str = "UNIT[\"Meter\",1.0]";
    const FOOT: &str = "UNIT[\"Foot_US\",0.3048006096012192]";

    fn heights(unit: &str, direction: f64) -> String {
        format!(
            "VERTCS[\"NAVD88\",VDATUM[\"North_American_Vertical_Datum_1988\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",{direction:?}],{unit}]"
        )
    }

    #[test]
    fn heights_behind_the_plane_have_their_own_unit() {
        for between in [",", " , ", ",\r\n", " "] {
            for (plane, vertical, [across, up]) in
                [(METRE, FOOT, [1.0, US_SURVEY_FOOT]), (FOOT, METRE, [US_SURVEY_FOOT, 1.0]), (METRE, METRE, [1.0, 1.0])]
            {
                let text = format!("{}{between}{}", utm(31, plane), heights(vertical, 1.0));
                let crs = Crs::parse(&text).unwrap();
                assert!((crs.metres_per_unit - across).abs() < 1e-9, "{crs:?}");
                assert!((crs.vertical_metres_per_unit - up).abs() < 1e-9, "{crs:?}");
                assert_eq!(crs.doubt, None);
                // what is written of it says the same, and places are known as before
                let again = Crs::parse(crs.wkt.as_deref().unwrap()).unwrap();
                assert_eq!(again.metres_per_unit_xyz(), crs.metres_per_unit_xyz());
                let [plain, own] = [&Crs::parse(&utm(31, plane)).unwrap(), &crs]
                    .map(|crs| crs.place_of([500_000.0, 5_750_000.0 / across]).unwrap().map(f64::to_degrees));
                assert_eq!(plain, own);
                assert!((own[0] - 51.9).abs() < 0.1 && (own[1] - 3.0).abs() < 1e-6, "{own:?}");
            }
        }
    }

    #[test]
    fn the_third_axis_of_a_system_has_its_own_unit() {
        let metre = "LENGTHUNIT[\"metre\",1]";
        for (unit, expected) in [(metre, 1.0), ("LENGTHUNIT[\"US survey foot\",0.304800609601219]", US_SURVEY_FOOT)] {
            let text = format!(
                "PROJCRS[\"x\",BASEGEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS 84\",6378137,298.257223563]]],CONVERSION[\"UTM zone 31N\",METHOD[\"Transverse Mercator\"],PARAMETER[\"Longitude of natural origin\",3]],CS[Cartesian,3],AXIS[\"(E)\",east,ORDER[1],{metre}],AXIS[\"(N)\",north,ORDER[2],{metre}],AXIS[\"ellipsoidal height (h)\",up,ORDER[3],{unit}]]"
            );
            let crs = Crs::parse(&text).unwrap();
            assert_eq!(crs.metres_per_unit, 1.0);
            assert!((crs.vertical_metres_per_unit - expected).abs() < 1e-9, "{crs:?}");
        }
    }

    #[test]
    fn units_and_axes_that_cannot_be_are_doubted() {
        let compound = |vertical: &str| format!("COMPD_CS[\"c\",{},{vertical}]", utm(31, METRE));
        let depth = |axis: &str| {
            compound(&format!("VERT_CS[\"d\",VERT_DATUM[\"d\",2005],UNIT[\"metre\",1],AXIS[\"{axis}\"]]"))
                .replace("AXIS[\"", "AXIS[\"z\",")
                .replace("\"]]]", "]]]")
        };
        for (text, words) in [
            (utm(31, "UNIT[\"Meter\",0]"), "factor 0"),
            (utm(31, "UNIT[\"Meter\",-1]"), "factor -1"),
            (utm(31, "UNIT[\"Meter\",NaN]"), "factor NaN"),
            (utm(31, "UNIT[\"Meter\",inf]"), "factor inf"),
            (compound("VERT_CS[\"h\",VERT_DATUM[\"h\",2005],UNIT[\"metre\",0]]"), "factor 0"),
            (depth("DOWN"), "downwards"),
            (format!("{},{}", utm(31, METRE), heights(METRE, -1.0)), "downwards"),
            (utm(31, &format!("{METRE},AXIS[\"Y\",WEST],AXIS[\"X\",SOUTH]")), "west"),
        ] {
            let crs = Crs::parse(&text).unwrap();
            assert!(crs.doubt.as_deref().is_some_and(|doubt| doubt.contains(words)), "{words}: {crs:?}");
        }
        // EPSG:5715 counts depths below the sea
        assert!(Crs::parse("EPSG:32631+5715").unwrap().doubt.is_some_and(|doubt| doubt.contains("downwards")));
        for text in [utm(31, METRE), depth("UP"), utm(31, &format!("{METRE},AXIS[\"X\",EAST],AXIS[\"Y\",NORTH]"))] {
            assert_eq!(Crs::parse(&text).unwrap().doubt, None, "{text}");
        }
        assert_eq!(Crs::parse("EPSG:32631+5703").unwrap().doubt, None);
    }

    #[test]
    fn places_far_from_a_projection_are_found_without_a_code() {
        let conic = "PROJCS[\"Vicgrid94\",GEOGCS[\"GCS\",DATUM[\"D\",SPHEROID[\"GRS_1980\",6378137.0,298.257222101]],PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Lambert_Conformal_Conic\"],PARAMETER[\"False_Easting\",2500000.0],PARAMETER[\"False_Northing\",2500000.0],PARAMETER[\"Central_Meridian\",145.0],PARAMETER[\"Standard_Parallel_1\",-36.0],PARAMETER[\"Standard_Parallel_2\",-38.0],PARAMETER[\"Latitude_Of_Origin\",-37.0],UNIT[\"Meter\",1.0]]";
        let is_far = |text: &str, place: [f64; 2]| {
            let distance = Crs::parse(text).unwrap().distance_to_area_of_use(place);
            distance.is_some_and(|distance| distance > 300e3)
        };
        // Delft in the zones of Europe, Melbourne
        assert!(!is_far(&utm(31, METRE), [593_940.0, 5_762_946.0]));
        assert!(!is_far(&utm(32, METRE), [183_000.0, 5_766_000.0]));
        assert!(!is_far(conic, [2_497_000.0, 2_408_000.0]));
        // a strip of Gauss and Krüger, and a Dutch place, in what is beside them
        assert!(is_far(&utm(32, METRE), [3_513_000.0, 5_402_000.0]));
        assert!(is_far(conic, [593_940.0, 5_762_946.0]));
    }
}
