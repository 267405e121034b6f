//! CityJSON city models, versions 1.0 to 2.0, whole or as a sequence of features (CityJSONSeq).

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use serde_json::Value;

use crate::files::source::Source;
use crate::mesh::polygons::{MeshBuilder, MeshReport};
use belvedere_data::crs::{Crs, CrsKind};
use belvedere_data::{Error, Mesh, Parameter, Result};

/// Choice of the levels of detail to read of each city object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum LevelOfDetail {
    /// The highest that has surfaces, object by object: the best one to orient normals with.
    #[default]
    Highest,
    /// This one, such as `"1"`, `"1.3"` or `"2"`; objects without it are left out.
    Only(String),
}

/// The surfaces of a CityJSON file, or of a sequence of features, as triangles, one object per city object (in the
/// order of their identifiers), and counts of those left out.
///
/// Solids, multi- and composite surfaces and solids, and instances of geometry templates are read; rings with holes are
/// triangulated in their plane. The turning sense of the file is kept: counter-clockwise seen from outside. Coordinates
/// are taken as they are; the system that `metadata.referenceSystem` names by an EPSG code is that of the mesh.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read. [`Error::Malformed`] for anything that is not CityJSON, indices without a
/// vertex or template, nesting that does not fit the type of geometry, and files without a triangle.
///
/// # Source
/// CityJSON 2.0.1 specification, sections 2 to 5 and "Geometry templates".
pub fn read_cityjson<'a>(source: impl Into<Source<'a>>, level_of_detail: &LevelOfDetail) -> Result<(Mesh, MeshReport)> {
    let (name, bytes) = source.into().read_text()?;
    let path = name.as_path();
    let mut values = serde_json::Deserializer::from_slice(&bytes).into_iter::<Value>();
    let mut next = || values.next().transpose().map_err(|e| Error::malformed(path, format!("not readable JSON: {e}")));
    let root = next()?.unwrap_or_default();
    if root.get("type").and_then(Value::as_str) != Some("CityJSON") {
        return Err(Error::malformed(path, "not CityJSON: its \"type\" is not \"CityJSON\""));
    }
    let version = root.get("version").and_then(Value::as_str).unwrap_or("");
    if !["1.", "2."].iter().any(|major| version.starts_with(major)) {
        let what = format!("CityJSON version \"{version}\"; convert it to 1.0, 1.1 or 2.0 with cjio");
        return Err(Error::malformed(path, what));
    }
    let mut builder = MeshBuilder::new(path);
    if let Some(code) = root.pointer("/metadata/referenceSystem").and_then(Value::as_str).and_then(epsg_code) {
        // city models are in planes; a code that is not known is kept, and differs from all others
        let unknown = || Crs { epsg: Some(code), kind: CrsKind::Projected, ..Crs::default() };
        builder.mesh.crs = Crs::from_epsg(code).unwrap_or_else(unknown);
    }
    let mut file = CityFile { path, vertices: 0..0, builder, templates: None, transform: None };
    if let Some(transform) = root.get("transform") {
        file.transform = Some((
            triple(path, transform.get("scale"), "transform.scale")?,
            triple(path, transform.get("translate"), "transform.translate")?,
        ));
    }
    if let Some(templates) = root.get("geometry-templates") {
        file.templates = Some((
            array(path, templates.get("templates"), "geometry-templates.templates")?,
            array(path, templates.get("vertices-templates"), "geometry-templates.vertices-templates")?,
        ));
    }
    file.push_objects(&root, level_of_detail)?;
    for number in 2.. {
        let Some(feature) = next()? else { break };
        if feature.get("type").and_then(Value::as_str) != Some("CityJSONFeature") {
            let what = format!("object {number} of the sequence is no CityJSONFeature; after the first, all must be");
            return Err(Error::malformed(path, what));
        }
        file.push_objects(&feature, level_of_detail)?;
    }
    file.builder.finish()
}

/// A file being read, and the targets of references in its geometries.
struct CityFile<'a> {
    path: &'a Path,
    builder: MeshBuilder<'a>,
    /// Vertices that boundaries may refer to, numbered from the first: those of the file, or of a feature of a
    /// sequence. Those appended for instances of templates come after.
    vertices: Range<usize>,
    templates: Option<(&'a [Value], &'a [Value])>,
    /// Scale and translation of vertices.
    transform: Option<([f64; 3], [f64; 3])>,
}

impl<'a> CityFile<'a> {
    /// Appends the city objects of a file, or of a feature, with their vertices.
    fn push_objects(&mut self, owner: &Value, level_of_detail: &LevelOfDetail) -> Result<()> {
        let (scale, translate) = self.transform.unwrap_or(([1.0; 3], [0.0; 3]));
        let start = self.builder.mesh.vertices.len();
        for (row, vertex) in array(self.path, owner.get("vertices"), "vertices")?.iter().enumerate() {
            let v = triple(self.path, Some(vertex), &format!("vertex {row}"))?;
            self.builder.push_vertex(std::array::from_fn(|i| v[i] * scale[i] + translate[i]))?;
        }
        self.vertices = start..self.builder.mesh.vertices.len();
        let objects = owner
            .get("CityObjects")
            .and_then(Value::as_object)
            .ok_or_else(|| Error::malformed(self.path, "no CityObjects; a CityJSON file needs them"))?;
        objects.iter().try_for_each(|(name, object)| self.push_city_object(name, object, level_of_detail))
    }

    /// Index in the mesh of the vertex that a boundary refers to.
    fn vertex(&self, number: usize) -> Option<usize> {
        self.vertices.start.checked_add(number).filter(|index| *index < self.vertices.end)
    }

    fn push_city_object(&mut self, name: &str, object: &Value, wanted: &LevelOfDetail) -> Result<()> {
        let Some(geometries) = object.get("geometry").and_then(Value::as_array) else { return Ok(()) };
        let mut levels = Vec::with_capacity(geometries.len());
        for geometry in geometries {
            let body = self.template_of(name, geometry)?.unwrap_or(geometry);
            if surface_depth(body).is_none() {
                self.builder.report.skipped_geometry_count += 1;
                continue;
            }
            levels.push((level_of(body), geometry));
        }
        let chosen = match wanted {
            LevelOfDetail::Highest => levels.iter().map(|level| level.0).fold(f64::NEG_INFINITY, f64::max),
            LevelOfDetail::Only(level) => level.trim().parse().map_err(|_| {
                Error::invalid(Parameter::LevelOfDetail, level.clone(), "a number such as 1, 1.3 or 2.2")
            })?,
        };
        let mut index = None;
        for (level, geometry) in levels {
            if level.total_cmp(&chosen).is_ne() {
                self.builder.report.other_level_of_detail_count += 1;
                continue;
            }
            let index = *index.get_or_insert_with(|| self.builder.push_object(name));
            self.push_geometry(name, geometry, index)?;
        }
        Ok(())
    }

    /// The template that a `GeometryInstance` refers to, or `None` for other geometries.
    fn template_of(&self, name: &str, geometry: &Value) -> Result<Option<&'a Value>> {
        if type_of(geometry) != "GeometryInstance" {
            return Ok(None);
        }
        let index = geometry.get("template").and_then(Value::as_u64).and_then(|i| usize::try_from(i).ok());
        let template = self.templates.and_then(|(templates, _)| templates.get(index?));
        template.map(Some).ok_or_else(|| self.bad(name, "refers to a missing geometry template"))
    }

    fn push_geometry(&mut self, name: &str, geometry: &Value, object: u32) -> Result<()> {
        let Some(template) = self.template_of(name, geometry)? else {
            let mut surfaces = Vec::new();
            self.collect_surfaces(name, geometry, &mut surfaces, &mut |i| self.vertex(i))?;
            return surfaces.iter().try_for_each(|rings| self.builder.push_polygon(rings, Some(object)));
        };
        let anchor = geometry.pointer("/boundaries/0").and_then(Value::as_u64).and_then(|i| usize::try_from(i).ok());
        let anchor = anchor
            .and_then(|i| self.builder.mesh.vertices.get(self.vertex(i)?).copied())
            .ok_or_else(|| self.bad(name, "has a geometry instance without an anchor vertex"))?;
        let matrix = self.matrix(name, geometry)?;
        let template_vertices = self.templates.map_or(&[][..], |(_, vertices)| vertices);
        let mut used: BTreeMap<usize, usize> = BTreeMap::new();
        let mut surfaces = Vec::new();
        let base = self.builder.mesh.vertices.len();
        self.collect_surfaces(name, template, &mut surfaces, &mut |i| {
            let next = base + used.len();
            (i < template_vertices.len()).then(|| *used.entry(i).or_insert(next))
        })?;
        let mut by_position: Vec<(usize, usize)> = used.into_iter().map(|(i, position)| (position, i)).collect();
        by_position.sort_unstable();
        for (_, i) in by_position {
            let v = triple(self.path, template_vertices.get(i), "template vertex")?;
            let row = |r: usize| matrix[r][0] * v[0] + matrix[r][1] * v[1] + matrix[r][2] * v[2] + matrix[r][3];
            self.builder.push_vertex(std::array::from_fn(|r| row(r) + anchor[r]))?;
        }
        // a mirroring matrix would turn every face inside out
        let mirrored = determinant(matrix) < 0.0;
        for mut rings in surfaces {
            if mirrored {
                rings.iter_mut().for_each(|ring| ring.reverse());
            }
            self.builder.push_polygon(&rings, Some(object))?;
        }
        Ok(())
    }

    fn matrix(&self, name: &str, geometry: &Value) -> Result<[[f64; 4]; 3]> {
        let Some(values) = geometry.get("transformationMatrix") else {
            return Ok([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
        };
        let values: Option<Vec<f64>> = values
            .as_array()
            .and_then(|values| values.iter().map(Value::as_f64).collect())
            .filter(|v: &Vec<_>| v.len() == 16);
        let values = values.ok_or_else(|| self.bad(name, "has a transformationMatrix that is not 16 numbers"))?;
        Ok(std::array::from_fn(|r| std::array::from_fn(|c| values[4 * r + c])))
    }

    /// Appends the surfaces (rings of vertex indices) of a geometry, its indices translated by `vertex`.
    fn collect_surfaces(
        &self,
        name: &str,
        geometry: &Value,
        surfaces: &mut Vec<Vec<Vec<u32>>>,
        vertex: &mut impl FnMut(usize) -> Option<usize>,
    ) -> Result<()> {
        let Some(depth) = surface_depth(geometry) else { return Ok(()) };
        let mut level: Vec<&Value> = array(self.path, geometry.get("boundaries"), "boundaries")?.iter().collect();
        for _ in 1..depth {
            let mut next = Vec::new();
            for value in level {
                next.extend(value.as_array().ok_or_else(|| self.bad(name, "has boundaries with too few levels"))?);
            }
            level = next;
        }
        for surface in level {
            let rings =
                surface.as_array().ok_or_else(|| self.bad(name, "has a surface that is not a list of rings"))?;
            let rings = rings.iter().map(|ring| self.ring(name, ring, vertex)).collect::<Result<Vec<_>>>()?;
            if !rings.is_empty() {
                surfaces.push(rings);
            }
        }
        Ok(())
    }

    fn ring(&self, name: &str, ring: &Value, vertex: &mut impl FnMut(usize) -> Option<usize>) -> Result<Vec<u32>> {
        let ring = ring.as_array().ok_or_else(|| self.bad(name, "has a ring that is not a list of vertices"))?;
        ring.iter()
            .map(|index| {
                let place = index.as_u64().and_then(|i| usize::try_from(i).ok()).and_then(&mut *vertex);
                place
                    .and_then(|i| u32::try_from(i).ok())
                    .ok_or_else(|| self.bad(name, &format!("refers to the missing vertex {index}")))
            })
            .collect()
    }

    fn bad(&self, name: &str, what: &str) -> Error {
        Error::malformed(self.path, format!("city object {name} {what}"))
    }
}

fn type_of(geometry: &Value) -> &str {
    geometry.get("type").and_then(Value::as_str).unwrap_or("")
}

/// Returns the depth of nested lists at which the surfaces of a geometry are, or `None` for geometries without
/// surfaces.
fn surface_depth(geometry: &Value) -> Option<usize> {
    match type_of(geometry) {
        "MultiSurface" | "CompositeSurface" => Some(1),
        "Solid" => Some(2),
        "MultiSolid" | "CompositeSolid" => Some(3),
        _ => None,
    }
}

/// Level of detail as a number: 1.0 writes numbers, later versions text such as "2.2". Unknown is below all.
fn level_of(geometry: &Value) -> f64 {
    let lod = geometry.get("lod");
    lod.and_then(|lod| lod.as_f64().or_else(|| lod.as_str()?.trim().parse().ok())).unwrap_or(-1.0)
}

/// The code at the end of `urn:ogc:def:crs:EPSG::7415` or `https://www.opengis.net/def/crs/EPSG/0/7415`.
fn epsg_code(reference_system: &str) -> Option<u32> {
    let tail = reference_system.to_ascii_uppercase();
    tail.contains("EPSG").then(|| tail.rsplit([':', '/']).next()?.parse().ok())?
}

fn array<'v>(path: &Path, value: Option<&'v Value>, name: &str) -> Result<&'v [Value]> {
    let list = value.and_then(Value::as_array).map(Vec::as_slice);
    list.ok_or_else(|| Error::malformed(path, format!("{name} is missing or not a list")))
}

fn triple(path: &Path, value: Option<&Value>, name: &str) -> Result<[f64; 3]> {
    let numbers: Option<Vec<f64>> =
        value.and_then(Value::as_array).and_then(|list| list.iter().map(Value::as_f64).collect());
    let three = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    three.ok_or_else(|| Error::malformed(path, format!("{name} is missing or not three numbers")))
}

fn determinant(m: [[f64; 4]; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}
