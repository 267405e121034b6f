//! The solar envelope: how high one may build on a parcel without taking protected sun from others.

use super::answers::{Answered, Answers, Ask};
use super::context::Context;
use super::known_ground::KnownGround;
use super::places::Places;
use super::remark::Remark;
use super::scene::Scene;
use super::sections::{EnvelopeSection, LinesSection, PeriodSection};
use super::shared::SharedObject;
use super::sun::{Days, SunRange, check_min_elevation, check_sun, remark_on_sun};
use super::sun_place::{SunPlace, remark_on_solar_hours};
use crate::solar_envelope::{
    EnvelopeParams, Parcel, ProtectedPiece, SolarEnvelope, check_fence, check_hours, envelope_suns, existing_shade,
    protected_faces, protected_line, solar_envelope,
};
use crate::sun::{Date, Period, Site, Zone};
use crate::targets::Measure;
use crate::viewshed::{CELL, cell_for};
use belvedere_core::ground::{Ground, GroundPoints, MapGrid};
use belvedere_core::query::{MeshTargetParams, SurfacePieces, UnprovenAs};
use belvedere_data::control::Control;
use belvedere_data::report::{percent, rounded};
use belvedere_data::view::to_sun;
use belvedere_data::{Error, Mesh, Parameter, Result};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Margin of the ground made around the parcel and the protected pieces, metres.
const MARGIN: f64 = 5.0;
/// Maximum number of suns and places that are named as those that limit the envelope.
const MAX_LIMITING: usize = 3;
const SUN_EXPECTED: &str = "azimuth and elevation in degrees, the elevation above 0 and at most 90";

/// Maximum building height on a parcel that keeps the protected sun of others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct EnvelopeQuestion {
    /// The suns that are protected.
    pub suns: ProtectedSuns,
    /// Location on earth, clock, and the north of azimuths.
    pub place: SunPlace,
    /// Height of a fence on protected lines and points, up to which they may be in shade, metres, 0 or more. Default 0.
    pub fence_height: f64,
    /// Longest part of protected lines and faces, metres, above 0; `None` for 0.5.
    pub spacing: Option<f64>,
    /// Side of a column, metres, above 0; `None` for 0.5.
    pub cell: Option<f64>,
    /// Bounds of the envelope besides the sun.
    pub params: EnvelopeParams,
    /// True if sun that the scene already takes needs no protection. Default: false.
    pub credit_shade: bool,
    /// Source of ground points.
    #[serde(skip)]
    pub ground: GroundPoints,
    /// Seed of the places on protected meshes.
    #[serde(skip)]
    pub seed: u64,
    /// Rings of the parcel, local metres on the map.
    #[serde(skip)]
    pub parcel: Vec<Vec<[f64; 2]>>,
    /// Objects that keep their sun.
    #[serde(skip)]
    pub protect: Vec<Protected>,
}

/// Suns that are protected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum ProtectedSuns {
    /// Azimuths, clockwise from north, and elevations above 0 up to 90, degrees.
    Directions(Vec<[f64; 2]>),
    /// Suns of days.
    Days {
        /// The days.
        #[serde(default)]
        days: Days,
        /// Hours of each day on the clocks of the place, 0 to 24, both included; `None` from sunrise to sunset.
        #[serde(default)]
        hours: Option<[f64; 2]>,
    },
}

impl Default for ProtectedSuns {
    fn default() -> Self {
        Self::Days { days: Days::default(), hours: None }
    }
}

/// Something that keeps its sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Protected {
    /// Name in reports.
    pub name: String,
    /// Shape and position.
    pub shape: ProtectedShape,
}

/// Shape of an object that keeps its sun; a height of NaN follows from the ground.
#[derive(Clone, Debug, PartialEq)]
pub enum ProtectedShape {
    /// A point, local metres.
    Point([f64; 3]),
    /// Lines through corners, local metres.
    Lines(Vec<Vec<[f64; 3]>>),
    /// The faces of a mesh, metres.
    Faces(SharedObject<Mesh>),
}

/// The envelope, and the ground that its heights count from.
pub struct EnvelopeResults {
    /// The envelope.
    pub envelope: SolarEnvelope,
    /// The ground over the parcel.
    pub ground: Arc<KnownGround>,
}

/// Directions to suns, and the name of each.
struct NamedSuns {
    directions: Vec<[f64; 3]>,
    names: Vec<String>,
}

/// Objects that keep their sun, in pieces.
#[derive(Default)]
struct Land {
    pieces: Vec<ProtectedPiece>,
    /// Name of each source of pieces.
    names: Vec<String>,
    /// Parts without known ground.
    unknown: usize,
}

impl EnvelopeQuestion {
    fn dates(&self, days: &Days, site: &Site, zone: &Zone) -> Result<Vec<Date>> {
        match days.period(&self.place, site, zone)? {
            Some(Period::Days(dates)) => Ok(dates),
            Some(_) => {
                Err(Error::invalid(Parameter::Period, "two times", "days; their hours are limited apart from them"))
            }
            None => Err(Error::invalid(Parameter::Period, "missing", "given as days")),
        }
    }

    fn suns(&self, scene: &Scene, context: &mut Context) -> Result<NamedSuns> {
        match &self.suns {
            ProtectedSuns::Directions(directions) => {
                let north = self.place.north.of_scene(scene);
                context.north(&north);
                let site = self.place.site_of(scene.frame(), &scene.model().bounds(), None).ok();
                directions.iter().for_each(|&sun| context.add(remark_on_sun(site.map(|(site, _)| site), sun)));
                let to_one = |&[azimuth, elevation]: &[f64; 2]| {
                    to_sun(azimuth.to_radians() - north.of_grid, elevation.to_radians())
                };
                let name = |[azimuth, elevation]: &[f64; 2]| format!("azimuth {azimuth}, elevation {elevation}");
                Ok(NamedSuns {
                    directions: directions.iter().map(to_one).collect(),
                    names: directions.iter().map(name).collect(),
                })
            }
            ProtectedSuns::Days { days, hours } => {
                let site = self.place.site(scene, context, None)?;
                let zone = self.place.clock(&site, days.times(), context)?;
                context.add(remark_on_solar_hours("the sun is protected", *hours, &zone));
                let dates = self.dates(days, &site, &zone)?;
                let params = days.params(&self.place);
                let (suns, low) = envelope_suns(&site, &zone, &dates, hours.unwrap_or(ALL_DAY), &params)?;
                check_min_elevation(suns.is_empty() && low > 0 && params.min_elevation > 0.0, &params)?;
                context.report.period = Some(PeriodSection::of_dates(&dates, &zone, &params, [suns.len(), low]));
                Ok(NamedSuns {
                    directions: suns.iter().map(|sun| sun.direction).collect(),
                    names: suns.iter().map(|sun| zone.display(sun.unix_s)).collect(),
                })
            }
        }
    }

    /// A grid around everything that needs the ground, and one over the parcel.
    fn grids(&self, parcel: &Parcel, scene: &Scene) -> Result<[MapGrid; 2]> {
        let [x, y, _] = scene.frame().origin;
        let cell = self.cell.unwrap_or(CELL);
        let [mut low, mut high] = parcel.bounds();
        let narrow = MapGrid::covering(low, high, cell, [x, y])?;
        for corner in self.protect.iter().flat_map(Protected::corners) {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let (low, high) = (low.map(|v| v - MARGIN), high.map(|v| v + MARGIN));
        let wide = MapGrid::covering(low, high, cell_for(low, high).max(cell), [x, y])?;
        Ok([wide, narrow])
    }

    /// Returns the objects that keep their sun: the pieces of faces first, then points and lines on the ground.
    fn land(&self, ground: &Ground, scene: &Scene, control: &Control<'_>) -> Result<Land> {
        let mut land = Land::default();
        let mut on_ground = Vec::new();
        for protected in &self.protect {
            let source = land.source(&protected.name);
            match &protected.shape {
                ProtectedShape::Faces(mesh) => {
                    let spacing = self.spacing.unwrap_or(CELL);
                    let surface = control.stage("sampling mesh", 0, || {
                        SurfacePieces::of_mesh(mesh, scene.frame().origin, spacing, self.seed)
                    })?;
                    land.add_faces(mesh, &surface, source);
                }
                shape => on_ground.push((shape, source)),
            }
        }
        for (shape, source) in on_ground {
            self.add_on_ground(shape, source, ground, &mut land)?;
        }
        if land.pieces.is_empty() {
            let expected = "where the ground is known; is what is protected in the coordinates of the cloud?";
            return Err(Error::invalid(Parameter::ProtectedPlace, "without known ground", expected));
        }
        Ok(land)
    }

    fn add_on_ground(&self, shape: &ProtectedShape, source: u32, ground: &Ground, land: &mut Land) -> Result<()> {
        let lines: &[Vec<[f64; 3]>] = match shape {
            ProtectedShape::Faces(_) => &[],
            ProtectedShape::Lines(lines) => lines,
            &ProtectedShape::Point([x, y, z]) => {
                let height = if z.is_nan() { ground.height_at([x, y]) } else { Some(z) };
                match height {
                    Some(z) => land.pieces.push(ProtectedPiece::point([x, y, z + self.fence_height], source)),
                    None => land.unknown += 1,
                }
                return Ok(());
            }
        };
        for line in lines {
            let spacing = self.spacing.unwrap_or(CELL);
            let (pieces, without) = protected_line(line, self.fence_height, spacing, ground, source)?;
            land.pieces.extend(pieces);
            land.unknown += without;
        }
        Ok(())
    }
}

/// Hours from which the sun decides alone.
const ALL_DAY: [f64; 2] = [0.0, 24.0];

impl Protected {
    /// Corners that may need the ground.
    fn corners(&self) -> impl Iterator<Item = &[f64; 3]> {
        let (point, lines) = match &self.shape {
            ProtectedShape::Point(place) => (Some(place), &[][..]),
            ProtectedShape::Lines(lines) => (None, &lines[..]),
            ProtectedShape::Faces(_) => (None, &[][..]),
        };
        point.into_iter().chain(lines.iter().flatten())
    }
}

impl Land {
    fn source(&mut self, name: &str) -> u32 {
        self.names.push(name.to_owned());
        u32::try_from(self.names.len() - 1).unwrap_or(u32::MAX)
    }

    /// The pieces of a mesh, each object of which is a source after that of the mesh.
    fn add_faces(&mut self, mesh: &Mesh, surface: &SurfacePieces, first: u32) {
        let objects = u32::try_from(mesh.object_names.len()).unwrap_or(0);
        self.names.extend(mesh.object_names.iter().cloned());
        for mut piece in protected_faces(surface, MeshTargetParams::default().lift) {
            let object = mesh.objects.get(piece.source as usize).filter(|object| **object < objects);
            piece.source = object.map_or(first, |object| first + 1 + object);
            self.pieces.push(piece);
        }
    }
}

impl Ask for EnvelopeQuestion {
    type Found = EnvelopeResults;

    fn check(&self) -> Result<()> {
        let anywhere = self.place.check()?;
        match &self.suns {
            ProtectedSuns::Directions(directions) => {
                directions.iter().try_for_each(|&sun| check_sun(sun, SunRange::AboveHorizon))?;
                if directions.is_empty() {
                    return Err(Error::invalid(Parameter::SunDirection, "missing", SUN_EXPECTED));
                }
            }
            ProtectedSuns::Days { days, hours } => {
                days.check(&self.place)?;
                self.dates(days, &anywhere, &self.place.any_zone(&anywhere, days.times())?)?;
                check_hours(hours.unwrap_or(ALL_DAY))?;
            }
        }
        check_fence(self.fence_height, self.spacing.unwrap_or(CELL))?;
        self.params.validate()
    }

    fn answer(&self, scene: &Scene, _places: &Places, context: &mut Context, control: &Control<'_>) -> Answered<Self> {
        let suns = self.suns(scene, context)?;
        let parcel = Parcel::new(&self.parcel)?;
        let [wide, narrow] = self.grids(&parcel, scene)?;
        let around = scene.ground(wide, self.ground, control)?;
        let below = scene.ground(narrow, self.ground, control)?;
        context.ground(scene.frame(), &below);
        let land = self.land(&around.ground, scene, control)?;
        let parts = land.unknown + land.pieces.len();
        let so = "have no known ground, and are not protected";
        context.add(Remark::of_share("protected-without-ground", land.unknown, parts, "protected parts", so));
        let free = match self.credit_shade {
            false => None,
            true => {
                let blockers = scene.blockers(UnprovenAs::Visible, control)?;
                context.report.lines_of_sight = Some(LinesSection::of(&blockers, None));
                Some(control.stage("testing existing shadow", land.pieces.len(), || {
                    existing_shade(&blockers, &land.pieces, &suns.directions, control)
                })?)
            }
        };
        let envelope = control.stage("computing envelope", suns.directions.len(), || {
            let (ground, pieces) = (&below.ground, &land.pieces);
            solar_envelope(&parcel, ground, pieces, &suns.directions, free.as_ref(), &self.params, control)
        })?;
        self.summarise(&envelope, &land, &suns, context);
        let height = Measure::new("height", envelope.heights().values().to_vec())
            .with_description("height of the solar envelope above the ground, metres")
            .with_unit("m");
        Ok(Answers::new(EnvelopeResults { envelope, ground: below }, vec![height]))
    }
}

impl EnvelopeQuestion {
    fn summarise(&self, found: &SolarEnvelope, land: &Land, suns: &NamedSuns, context: &mut Context) {
        let section = self.section(found, land, suns);
        let (count, unlimited) = (section.columns, section.columns_unlimited.unwrap_or(0));
        let (area, no_room, suns) = (section.area_m2, section.columns_of_zero_height, suns.names.len());
        let heights = section.volume_m3.zip(section.mean_height_m).zip(section.max_height_m);
        if let Some(((volume, mean), max)) = heights {
            context.headline(format!("solar envelope for {suns} suns: {volume} m3 on {area} m2"));
            context.headline(format!("height above the ground: mean {mean} m, highest {max} m"));
        } else {
            context.headline(format!("solar envelope for {suns} suns: {unlimited} of {count} columns without limit"));
        }
        context.headline(format!("no room: {no_room} of {count} columns"));
        if let (Some(place), Some(sun)) = (section.limiting_places.first(), section.limiting_suns.first()) {
            context.headline(format!("largest areas are limited by {place}, and by the sun of {sun}"));
        }
        let so = "have no limit: volume and solids need a maximum height";
        context.add(
            Remark::of_share("envelope-unlimited", unlimited, count, "columns of the envelope", so)
                .map(Remark::into_note),
        );
        context.report.envelope = Some(section);
    }

    fn section(&self, found: &SolarEnvelope, land: &Land, suns: &NamedSuns) -> EnvelopeSection {
        let report = found.report;
        let unlimited = found.unbounded_count();
        let limited = |value: f64, digits| (unlimited == 0).then(|| rounded(value, digits));
        let count = |is_one: &dyn Fn(f64, bool) -> bool| {
            found.columns.iter().filter(|column| is_one(column.height(), column.binding.is_some())).count()
        };
        let source = |piece: usize| land.pieces.get(piece).map_or(usize::MAX, |piece| piece.source as usize);
        let by_sun = found.bound_areas(suns.names.len(), |binding| binding.sun);
        let by_source = found.bound_areas(land.names.len(), |binding| source(binding.piece));
        let turned_away = report.turned_away_count;
        EnvelopeSection {
            columns: found.columns.len(),
            cell_m: rounded(found.grid.cell, 4),
            area_m2: rounded(found.area(), 2),
            volume_m3: limited(found.volume(), 1),
            mean_height_m: limited(found.volume() / found.area(), 2),
            max_height_m: limited(found.greatest_height(), 2),
            columns_unlimited: (unlimited > 0).then_some(unlimited),
            columns_of_zero_height: count(&|height, _| height <= 0.0),
            columns_at_max_height: self.params.ceiling.map(|_| count(&|_, is_bound| !is_bound)),
            cells_without_ground: report.without_ground_count,
            protected_pieces: land.pieces.len(),
            facing_away_percent: (turned_away > 0).then(|| percent(turned_away, report.pair_count)),
            existing_shadow_percent: self.credit_shade.then(|| percent(report.shaded_already_count, report.pair_count)),
            limiting_suns: ranked(&by_sun, &suns.names),
            limiting_places: ranked(&by_source, &land.names),
        }
    }
}

/// Lists the sources that limit the largest areas.
fn ranked(areas: &[f64], names: &[String]) -> Vec<String> {
    let mut order: Vec<(&f64, &String)> = areas.iter().zip(names).filter(|(area, _)| **area > 0.0).collect();
    order.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    order.iter().take(MAX_LIMITING).map(|(area, name)| format!("{name}: {area:.1} m2")).collect()
}
