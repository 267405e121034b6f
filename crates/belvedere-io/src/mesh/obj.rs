//! Wavefront OBJ meshes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::Path;

use crate::files::source::Source;
use crate::mesh::polygons::{MeshBuilder, MeshReport};
use belvedere_data::{Error, Mesh, Result};

/// Name of the object of faces that come before any `o` or `g` line, where other faces have one.
const UNNAMED: &str = "unnamed_object";

/// Contents of a file before faces find their vertices: faces may stand first.
#[derive(Default)]
struct ObjFile<'a> {
    /// Position of each vertex, and its line from 1.
    vertices: Vec<([f64; 3], usize)>,
    faces: Vec<ObjFace>,
    /// Names of the `o` and `g` lines.
    names: Vec<&'a str>,
}

/// A face as the file has it.
struct ObjFace {
    line: usize,
    /// Index into the names; `None` before the first.
    name: Option<usize>,
    /// Number of the vertex at each corner, from 0.
    corners: Vec<usize>,
}

/// The triangles of an OBJ file, one object per `o` or `g` line, and counts of those left out.
///
/// Polygons may be concave. Points, lines, materials and textures are passed over; a material library need not be
/// there. A backslash at the end of a line continues it. Coordinates are taken as metres.
///
/// # Errors
/// [`Error::Io`] if the file cannot be opened. [`Error::Malformed`], which names the line, for syntax errors, decimal
/// commas, indices without a vertex, and coordinates that are not finite; also for files without a triangle.
pub(crate) fn read(source: Source<'_>) -> Result<(Mesh, MeshReport)> {
    let (name, bytes) = source.read_text()?;
    let path = name.as_path();
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.lines().enumerate();
    let mut logical: Vec<(usize, Cow<'_, str>)> = Vec::new();
    while let Some((row, line)) = lines.next() {
        let mut whole = Cow::Borrowed(line);
        while whole.trim_end().ends_with('\\') {
            let mut start = whole.into_owned();
            start.truncate(start.trim_end().len() - 1);
            start.push(' ');
            start.push_str(lines.next().map_or("", |(_, next)| next));
            whole = Cow::Owned(start);
        }
        logical.push((row + 1, whole));
    }
    let mut file = ObjFile::default();
    for (line, text) in &logical {
        file.take(text).map_err(|what| Error::malformed(path, format!("line {line}: {what}")))?;
        file.number_last(*line);
    }
    file.into_mesh(path)
}

impl<'a> ObjFile<'a> {
    /// Takes one line; an error is why it cannot be read.
    fn take(&mut self, line: &'a str) -> std::result::Result<(), String> {
        let line = line.split_once('#').map_or(line, |(before, _)| before).trim();
        let (keyword, rest) = line.split_once(|c: char| c.is_ascii_whitespace()).unwrap_or((line, ""));
        match keyword {
            "v" => self.vertices.push((position(rest)?, 0)),
            "f" => {
                let count = self.vertices.len();
                let corners = rest.split_ascii_whitespace().map(|word| corner(word, count));
                let corners = corners.collect::<std::result::Result<Vec<_>, String>>()?;
                self.faces.push(ObjFace { line: 0, name: self.names.len().checked_sub(1), corners });
            }
            "o" | "g" => self.names.push(rest.trim()),
            _ => {}
        }
        Ok(())
    }

    /// Gives its number to the vertex or face of the last line.
    fn number_last(&mut self, line: usize) {
        if let Some((_, own)) = self.vertices.last_mut().filter(|(_, own)| *own == 0) {
            *own = line;
        }
        if let Some(face) = self.faces.last_mut().filter(|face| face.line == 0) {
            face.line = line;
        }
    }

    fn into_mesh(self, path: &Path) -> Result<(Mesh, MeshReport)> {
        let mut builder = MeshBuilder::new(path);
        let names_objects = self.faces.iter().any(|face| face.name.is_some());
        // vertices that no face has are no part of the mesh
        let mut indices: HashMap<usize, u32> = HashMap::new();
        for face in &self.faces {
            let mut ring = Vec::with_capacity(face.corners.len());
            for &corner in &face.corners {
                let index = match (indices.get(&corner), self.vertices.get(corner)) {
                    (Some(&index), _) => index,
                    (None, Some(&(place, line))) => {
                        builder.line = line;
                        let index = builder.push_vertex(place)?;
                        indices.insert(corner, index);
                        index
                    }
                    (None, None) => {
                        let (line, number, count) = (face.line, corner.saturating_add(1), self.vertices.len());
                        let what = format!("line {line}: a face refers to vertex {number}, but there are only {count}");
                        return Err(Error::malformed(path, what));
                    }
                };
                ring.push(index);
            }
            builder.line = face.line;
            let name = face.name.and_then(|name| self.names.get(name)).copied().unwrap_or(UNNAMED);
            let object = names_objects.then(|| builder.push_object(name));
            builder.push_polygon(&[ring], object)?;
        }
        builder.line = 0;
        builder.finish()
    }
}

fn position(text: &str) -> std::result::Result<[f64; 3], String> {
    let mut words = text.split_ascii_whitespace();
    let mut next = || {
        let word = words.next().ok_or_else(|| format!("a vertex needs x, y and z, but has \"{}\"", shortened(text)))?;
        word.parse::<f64>().map_err(|_| {
            if word.replacen(',', ".", 1).parse::<f64>().is_ok() {
                format!("decimal commas ({}); replace them by points, for example with: tr ',' '.'", shortened(text))
            } else {
                format!("\"{}\" is not a number", shortened(word))
            }
        })
    };
    Ok([next()?, next()?, next()?])
}

/// Number of a vertex, from 0, where `count` vertices stand before the face: `7`, `7/1`, `7//3`, `7/1/3` and -1 for the
/// last one before it.
fn corner(word: &str, count: usize) -> std::result::Result<usize, String> {
    let index = word.split('/').next().and_then(|index| index.parse::<i64>().ok());
    let index = index.ok_or_else(|| format!("\"{}\" is not a corner of a face", shortened(word)))?;
    let back = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
    match index {
        1.. => Ok(back - 1),
        0 => Err("a face refers to vertex 0, but vertices are counted from 1".to_owned()),
        _ => count
            .checked_sub(back)
            .ok_or_else(|| format!("a face refers to vertex {index}, but only {count} vertices stand before it")),
    }
}

fn shortened(text: &str) -> String {
    text.trim().chars().take(40).collect()
}
