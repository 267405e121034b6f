//! PLY: the vertices of ascii and binary files; faces and other elements are passed over.

use std::io::{BufRead, Read};
use std::path::Path;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType};

use super::part::{Part, guarded, open};
use super::rows::{Role, Row, Rows, role_of};
use crate::{Error, Result};

/// A header longer than this is no header.
const MAX_HEADER: u64 = 1 << 20;

/// One vertex: the numbers whose names have a role.
#[derive(Default)]
struct Vertex(Row);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let value = match property {
            Property::Char(v) => f64::from(v),
            Property::UChar(v) => f64::from(v),
            Property::Short(v) => f64::from(v),
            Property::UShort(v) => f64::from(v),
            Property::Int(v) => f64::from(v),
            Property::UInt(v) => f64::from(v),
            Property::Float(v) => f64::from(v),
            Property::Double(v) => v,
            _ => return PropertyAccessResult::Ignored,
        };
        match role_of(name) {
            Some(role) => {
                self.0.set(role, value);
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::Ignored,
        }
    }
}

/// The vertices of the file at `path`.
pub(super) fn read(path: &Path) -> Result<Part> {
    let (mut file, size) = open(path)?;
    guarded(path, || {
        let damaged = |e: &dyn std::fmt::Display| Error::malformed(path, format!("is not a readable PLY file: {e}"));
        let parser = Parser::<Vertex>::new();
        let header_bytes = header_bytes(path, &mut file)?;
        let header = parser.read_header(&mut Reader::new(header_bytes.as_slice())).map_err(|e| damaged(&e))?;
        let mut part = Part::new(path, format!("PLY, {}", header.encoding));
        let body = size.saturating_sub(header_bytes.len() as u64);
        let mut found = false;
        for (name, element) in &header.elements {
            check_count(path, element, header.encoding, body)?;
            if name != "vertex" {
                if !found {
                    for_each(&Parser::<Vertex>::new(), path, &mut file, element, header.encoding, |_| {})?;
                }
                continue;
            }
            found = true;
            let mut rows = Rows::new(element.properties.keys().filter_map(|property| role_of(property)));
            if !rows.has_position() {
                return Err(Error::malformed(path, "has vertices without x, y and z"));
            }
            note_unknown(&mut part, element);
            for_each(&parser, path, &mut file, element, header.encoding, |vertex| rows.push(&vertex.0))?;
            part.single_precision = element.properties.iter().any(|(property, definition)| {
                role_of(property) == Some(Role::X) && definition.data_type == PropertyType::Scalar(ScalarType::Float)
            });
            rows.finish(&mut part);
        }
        if !found {
            return Err(Error::malformed(path, "has no vertices"));
        }
        Ok(part)
    })
}

/// Reads up to the line `end_header`.
fn header_bytes(path: &Path, file: &mut impl BufRead) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut limited = file.take(MAX_HEADER);
    loop {
        let start = bytes.len();
        let length = limited.read_until(b'\n', &mut bytes).map_err(Error::io(path))?;
        if start == 0 && !bytes.starts_with(b"ply") {
            return Err(Error::malformed(path, "is not a PLY file: it does not begin with ply"));
        }
        if length == 0 {
            return Err(Error::malformed(path, "has a PLY header without end_header"));
        }
        if bytes.get(start..).is_some_and(|line| line.trim_ascii() == b"end_header") {
            return Ok(bytes);
        }
    }
}

/// Holds the number of an element against the bytes there are: in ascii every value takes two.
fn check_count(path: &Path, element: &ElementDef, encoding: Encoding, body: u64) -> Result<()> {
    let least: u64 = if encoding == Encoding::Ascii {
        2 * element.properties.len() as u64
    } else {
        element.properties.values().map(|property| least_bytes(&property.data_type)).sum()
    };
    // The last line of a text may lack its line break.
    if (element.count as u64).saturating_mul(least) > body + 1 || (least == 0 && element.count > 0) {
        let what = format!(
            "announces {} elements {}, more than its {body} bytes can hold; it is cut off or damaged",
            element.count, element.name
        );
        return Err(Error::malformed(path, what));
    }
    Ok(())
}

fn least_bytes(kind: &PropertyType) -> u64 {
    let scalar = match kind {
        PropertyType::Scalar(scalar) | PropertyType::List(scalar, _) => scalar,
    };
    match scalar {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    }
}

fn note_unknown(part: &mut Part, element: &ElementDef) {
    let unknown: Vec<&str> =
        element.properties.keys().filter(|name| role_of(name).is_none()).map(String::as_str).collect();
    if !unknown.is_empty() {
        part.note(format!("properties dropped: {}", unknown.join(", ")));
    }
}

fn for_each(
    parser: &Parser<Vertex>,
    path: &Path,
    file: &mut impl BufRead,
    element: &ElementDef,
    encoding: Encoding,
    mut take: impl FnMut(Vertex),
) -> Result<()> {
    let mut line = Vec::new();
    for index in 0..element.count {
        let vertex = match encoding {
            Encoding::Ascii => {
                line.clear();
                file.read_until(b'\n', &mut line).map_err(Error::io(path))?;
                parser.read_ascii_element(&String::from_utf8_lossy(&line), element)
            }
            Encoding::BinaryBigEndian => parser.read_big_endian_element(file, element),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(file, element),
        };
        take(vertex.map_err(|e| {
            Error::malformed(path, format!("{} {} of {} is unreadable: {e}", element.name, index + 1, element.count))
        })?);
    }
    Ok(())
}
