//! The command lines that give the same answers as the page.

use crate::reading::ReadingChoice;
use belvedere::apps::ask::{HowSure, ThroughTrees};
use belvedere::crs::Crs;

/// The scene as it is typed on the command line.
#[derive(Clone, Debug, Default)]
pub struct SceneText {
    /// Its files and flags.
    pub input: String,
    /// The cloud beside a ball file, which shows the ground and the points.
    pub cloud_beside: Option<String>,
}

impl SceneText {
    /// This where somebody chose how the cloud is read.
    pub(crate) fn read_as(&self, choice: &ReadingChoice) -> Self {
        Self { input: format!("{}{}", self.input, choice.flags()), ..self.clone() }
    }

    /// A command with this scene.
    pub(crate) fn command(&self, name: &str, flags: &str) -> String {
        format!("belvedere {name} {} {flags}", self.input)
    }

    /// The same for commands that need the ground, which a ball file does not have.
    pub(crate) fn command_on_ground(&self, name: &str, flags: &str) -> String {
        match &self.cloud_beside {
            Some(cloud) => self.command(name, &format!("--ground cloud={cloud} {flags}")),
            None => self.command(name, flags),
        }
    }

    /// The shadow on the points of the cloud, which a ball file has beside it.
    pub(crate) fn shadow(&self, time: &str, zone: &str, trees: ThroughTrees, how_sure: HowSure) -> String {
        let (trees, sure) = (in_words(trees), sure_in_words(how_sure));
        let points = self.cloud_beside.as_ref().map_or("--self".to_owned(), |cloud| format!("--targets {cloud}"));
        self.command("shadow", &format!("--time {time} --zone {zone} {points}{trees}{sure} -o shadow.laz"))
    }

    /// Returns the command for the view of an eye over the points of the cloud.
    pub(crate) fn seen_points(&self, eye: &[f64], how_sure: HowSure) -> String {
        let sure = sure_in_words(how_sure);
        self.command_on_ground("viewshed", &format!("--observer {}{sure} -o seen.laz", typed(eye)))
    }
}

/// Returns the name of a reference system in GeoJSON of 2008, as GDAL and QGIS read it: the code, else the well-known
/// text. Without a name they would take coordinates for longitude and latitude.
pub(crate) fn named_for_maps(crs: &Crs) -> String {
    match crs.epsg {
        Some(code) => format!("urn:ogc:def:crs:EPSG::{code}"),
        None => crs.definition().unwrap_or_else(|| "LOCAL_CS[\"site\",UNIT[\"metre\",1]]".to_owned()),
    }
}

/// Light through trees as it is typed.
pub(crate) fn in_words(trees: ThroughTrees) -> String {
    match trees {
        ThroughTrees::Opaque => String::new(),
        ThroughTrees::Measured(_) => " --through-trees measured".to_owned(),
        ThroughTrees::Seasons(_) => " --through-trees seasons".to_owned(),
        ThroughTrees::Share(share) => format!(" --through-trees {share}"),
        ThroughTrees::Pulses(_) => " --through-trees pulses".to_owned(),
    }
}

/// Returns the flags for the wanted certainty of answers.
fn sure_in_words(how_sure: HowSure) -> String {
    let probability = if how_sure.probability { " --probability" } else { "" };
    let certain = how_sure.certain.map_or_else(String::new, |certain| format!(" --certain {certain}"));
    format!("{probability}{certain}")
}

/// Coordinates as they are typed.
pub(crate) fn typed(place: &[f64]) -> String {
    place.iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}
