//! Just enough of well-known text, versions 1 and 2, to learn kind, unit and codes even where a file strays from the
//! standard (a vertical system inside the projected one, feet with the factor 1).

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
    let root = parse(text)?;
    let horizontal = horizontal(&root)?;
    let kind = kind(horizontal)?;
    let metres_per_unit = if kind == CrsKind::Geographic { 1.0 } else { unit(horizontal).unwrap_or(1.0) };
    let vertical = root.find(VERTICAL);
    let crs = Crs {
        wkt: Some(text.to_owned()),
        epsg: root.epsg().or_else(|| horizontal.epsg()),
        vertical_epsg: vertical.and_then(WktNode::epsg),
        metres_per_unit,
        vertical_metres_per_unit: vertical.and_then(unit).unwrap_or(metres_per_unit),
        kind,
        doubt: None,
    };
    Some(match doubt(text, &crs) {
        Some(what) => crs.doubted(what),
        None => crs,
    })
}

/// Whether the text has a vertical system.
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

/// What in the text speaks against itself: its zone of UTM against its central meridian, its unit against that of its
/// code.
fn doubt(text: &str, crs: &Crs) -> Option<String> {
    let root = parse(text)?;
    let horizontal = horizontal(&root)?;
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
    let own = |node: &WktNode| {
        node.children.iter().find(|child| child.keyword == "UNIT" || child.keyword == "LENGTHUNIT").and_then(metres)
    };
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
    (1e-6..1e6).contains(&factor).then_some(factor)
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
    let mut open: Vec<WktNode> = Vec::new();
    let mut word = String::new();
    let mut quoted = false;
    let mut characters = text.chars().peekable();
    // Values are kept when the next separator shows that they were no keyword.
    let keep = |open: &mut Vec<WktNode>, word: &mut String| {
        if let (Some(node), false) = (open.last_mut(), word.is_empty()) {
            node.values.push(std::mem::take(word));
        }
    };
    while let Some(c) = characters.next() {
        match c {
            '"' if quoted && characters.peek() == Some(&'"') => {
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
                    None => return Some(done),
                }
            }
            ',' => keep(&mut open, &mut word),
            _ if c.is_whitespace() || c == '\0' => {}
            _ => word.push(c),
        }
    }
    None
}
