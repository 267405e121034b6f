//! PLY: the vertices of ascii and binary files; faces and other elements are passed over.

use std::io::{BufRead, Read};
use std::path::{Path, PathBuf};

use ply_rs_bw::parser::{Parser, Reader as HeaderReader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType, ScalarType,
};

use crate::files::source::{Input, SourceReader};
use crate::points::file_part::FilePart;
use crate::points::read_options::Reading;
use crate::points::rows::{Role, Row, Rows, is_plain_name, role_of};
use belvedere_data::crs::text::crs_from_comments;
use belvedere_data::{Error, Result};

/// A header longer than this is no header.
const MAX_HEADER: u64 = 1 << 20;

/// A line of a text file longer than this describes no vertex or face.
const MAX_LINE: u64 = 1 << 24;

/// The element that holds the points.
const VERTEX: &str = "vertex";

/// One vertex: the numbers whose names have a role.
#[derive(Default)]
struct Vertex {
    row: Row,
    /// A bit for each role that a property gave, and for each that one with a plain name gave.
    given: [u32; 2],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(value) = scalar(&property) else { return PropertyAccessResult::Ignored };
        match role_of(name) {
            Some(role) => {
                // of several names of one meaning the plain one counts, as in `roles_of`
                let (bit, is_plain) = (1 << role as u32, is_plain_name(name));
                let [any, plain] = &mut self.given;
                if *any & bit == 0 || is_plain && *plain & bit == 0 {
                    self.row.set(role, value);
                }
                *any |= bit;
                *plain |= if is_plain { bit } else { 0 };
                PropertyAccessResult::Set
            }
            None => PropertyAccessResult::Ignored,
        }
    }
}

/// A PLY file whose header has been checked against its size.
pub(crate) struct PlyFile<'a> {
    name: PathBuf,
    reader: SourceReader<'a>,
    header: Header,
    /// Elements that were read.
    read_count: usize,
}

impl<'a> PlyFile<'a> {
    pub(crate) fn open(input: Input<'a>) -> Result<Self> {
        let Input { name, mut reader, size } = input;
        let bytes = header_bytes(&name, &mut reader)?;
        refuse_twice(&name, &bytes)?;
        let header = Parser::<Vertex>::new()
            .read_header(&mut HeaderReader::new(bytes.as_slice()))
            .map_err(|e| Error::malformed(&name, format!("is not a readable PLY file: {e}")))?;
        let body = size.saturating_sub(bytes.len() as u64);
        for element in header.elements.values() {
            check_count(&name, element, header.encoding, body)?;
        }
        Ok(Self { name, reader, header, read_count: 0 })
    }

    pub(crate) fn name(&self) -> &Path {
        &self.name
    }

    pub(crate) fn vertex(&self) -> Option<&ElementDef> {
        self.header.elements.get(VERTEX)
    }

    pub(crate) fn comments(&self) -> impl Iterator<Item = &str> + Clone {
        self.header.comments.iter().map(String::as_str)
    }

    /// Hands every vertex to `take`; data behind the vertices are not read.
    pub(crate) fn for_each_vertex<V: PropertyAccess>(&mut self, take: impl FnMut(V) -> Result<()>) -> Result<()> {
        match self.for_each_row(VERTEX, take)? {
            true => Ok(()),
            false => Err(Error::malformed(&self.name, "has no vertices")),
        }
    }

    /// Hands every row of an element to `take`, and passes over the elements before it; false where no element of this
    /// name follows those that were read.
    pub(crate) fn for_each_row<V: PropertyAccess>(
        &mut self,
        wanted: &str,
        take: impl FnMut(V) -> Result<()>,
    ) -> Result<bool> {
        let Self { name, reader, header, read_count } = self;
        let mut elements = header.elements.iter().skip(*read_count);
        let Some(place) = elements.position(|(element_name, _)| element_name == wanted) else { return Ok(false) };
        for (_, element) in header.elements.iter().skip(*read_count).take(place) {
            for_each(&Parser::<Vertex>::new(), name, reader, element, header.encoding, |_| Ok(()))?;
        }
        *read_count += place + 1;
        let Some(element) = header.elements.get(wanted) else { return Ok(false) };
        for_each(&Parser::<V>::new(), name, reader, element, header.encoding, take)?;
        Ok(true)
    }
}

/// The vertices of the source.
pub(crate) fn read(input: Input<'_>, reading: &Reading<'_>) -> Result<FilePart> {
    let mut file = PlyFile::open(input)?;
    let mut part = FilePart::new(file.name(), format!("PLY, {}", file.header.encoding));
    if let Some(crs) = crs_from_comments(file.comments()) {
        part.set_crs(crs, "comments in the header");
    }
    let vertex = file.vertex().ok_or_else(|| Error::malformed(file.name(), "has no vertices"))?;
    let mut rows = Rows::new(vertex.properties.keys().filter_map(|property| role_of(property)));
    if !rows.has_position() {
        return Err(Error::malformed(file.name(), "has vertices without x, y and z"));
    }
    note_unknown(&mut part, vertex);
    part.single_precision = vertex.properties.iter().any(|(property, definition)| {
        role_of(property) == Some(Role::X) && definition.data_type == PropertyType::Scalar(ScalarType::Float)
    });
    file.for_each_vertex(|vertex: Vertex| {
        reading.check(rows.count())?;
        rows.push(&vertex.row);
        Ok(())
    })?;
    rows.finish(&mut part);
    Ok(part)
}

/// A property as a number, `None` where it is a list.
pub(crate) fn scalar(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => return None,
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

/// Refuses an element with two properties of one name: the parser keeps one of them, so that all numbers behind it
/// would be read in a wrong place.
fn refuse_twice(path: &Path, header: &[u8]) -> Result<()> {
    let mut names: Vec<&[u8]> = Vec::new();
    for line in header.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii) {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            Some(b"element") => names.clear(),
            Some(b"property") => {
                let Some(name) = words.next_back() else { continue };
                if names.contains(&name) {
                    let name = String::from_utf8_lossy(name);
                    return Err(Error::malformed(
                        path,
                        format!("has two properties {name} of one element; rename one"),
                    ));
                }
                names.push(name);
            }
            _ => {}
        }
    }
    Ok(())
}

/// Holds the number of an element against the bytes there are: in ascii every value takes two.
fn check_count(path: &Path, element: &ElementDef, encoding: Encoding, body: u64) -> Result<()> {
    let min: u64 = if encoding == Encoding::Ascii {
        2 * element.properties.len() as u64
    } else {
        element.properties.values().map(|property| min_bytes(&property.data_type)).sum()
    };
    // The last line of a text may lack its line break.
    if (element.count as u64).saturating_mul(min) > body + 1 || (min == 0 && element.count > 0) {
        let what = format!(
            "announces {} elements {}, more than its {body} bytes can hold; it is cut off or damaged",
            element.count, element.name
        );
        return Err(Error::malformed(path, what));
    }
    Ok(())
}

fn min_bytes(kind: &PropertyType) -> u64 {
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

fn note_unknown(part: &mut FilePart, element: &ElementDef) {
    let unknown: Vec<&str> =
        element.properties.keys().filter(|name| role_of(name).is_none()).map(String::as_str).collect();
    if !unknown.is_empty() {
        part.note(format!("properties dropped: {}", unknown.join(", ")));
        part.other_attributes.extend(unknown.into_iter().map(str::to_owned));
    }
}

fn for_each<V: PropertyAccess>(
    parser: &Parser<V>,
    path: &Path,
    file: &mut impl BufRead,
    element: &ElementDef,
    encoding: Encoding,
    mut take: impl FnMut(V) -> Result<()>,
) -> Result<()> {
    let mut line = Vec::new();
    for index in 0..element.count {
        let vertex = match encoding {
            Encoding::Ascii => {
                line.clear();
                file.take(MAX_LINE).read_until(b'\n', &mut line).map_err(Error::io(path))?;
                parser.read_ascii_element(&String::from_utf8_lossy(&line), element)
            }
            Encoding::BinaryBigEndian => parser.read_big_endian_element(file, element),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(file, element),
        };
        take(vertex.map_err(|e| {
            Error::malformed(path, format!("{} {} of {} is unreadable: {e}", element.name, index + 1, element.count))
        })?)?;
    }
    Ok(())
}
