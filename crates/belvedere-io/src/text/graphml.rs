//! Networks as GraphML, which Gephi, yEd, igraph and NetworkX read.

use std::path::Path;

use serde_json::Value;

use crate::files::output::{Output, WriteSeek};
use crate::text::table::row_properties;
use belvedere_data::result_columns::{ResultColumn, ResultValues};
use belvedere_data::{Error, Result};

/// Writes an undirected graph: a node for each of `node_count` rows of `nodes`, and an edge for each row of `ends` that
/// is not `None`, with its row of `edges` as properties. Empty cells are left out.
///
/// # Errors
/// [`Error::Io`].
///
/// # Source
/// Brandes, Eiglsperger, Lerner & Pich 2013, Graph markup language (GraphML).
pub fn write_graphml<'a>(
    output: impl Into<Output<'a>>,
    node_count: usize,
    nodes: &[ResultColumn],
    ends: &[Option<[usize; 2]>],
    edges: &[ResultColumn],
) -> Result<()> {
    output.into().write(|path, output| {
        let mut writer = Writer { path, output };
        writer.line(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">",
        )?;
        for (of, columns) in [("node", nodes), ("edge", edges)] {
            for (number, ResultColumn { name, values }) in columns.iter().enumerate() {
                let kind = match values {
                    ResultValues::Real(..) => "double",
                    ResultValues::Whole(_) => "long",
                    ResultValues::Clock(_) | ResultValues::Words(_) => "string",
                };
                let name = escaped(name);
                writer.line(&format!(
                    "<key id=\"{of}{number}\" for=\"{of}\" attr.name=\"{name}\" attr.type=\"{kind}\"/>"
                ))?;
            }
        }
        writer.line("<graph edgedefault=\"undirected\">")?;
        for row in 0..node_count {
            writer.element(&format!("node id=\"{row}\""), "node", nodes, row)?;
        }
        for (row, ends) in ends.iter().enumerate() {
            if let Some([a, b]) = ends {
                writer.element(&format!("edge source=\"{a}\" target=\"{b}\""), "edge", edges, row)?;
            }
        }
        writer.line("</graph>\n</graphml>")
    })
}

struct Writer<'a> {
    path: &'a Path,
    output: &'a mut dyn WriteSeek,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) -> Result<()> {
        writeln!(self.output, "{line}").map_err(Error::io(self.path))
    }

    /// An element with the cells of a row as its data.
    fn element(&mut self, opening: &str, name: &str, columns: &[ResultColumn], row: usize) -> Result<()> {
        let properties = row_properties(columns, row);
        let data = columns.iter().enumerate().filter_map(|(number, column)| {
            let text = match properties.get(&column.name)? {
                Value::Null => return None,
                Value::String(text) => escaped(text),
                other => other.to_string(),
            };
            Some(format!("<data key=\"{name}{number}\">{text}</data>"))
        });
        let data: String = data.collect();
        self.line(&format!("<{opening}>{data}</{name}>"))
    }
}

/// Text with the characters that XML reserves escaped. Characters that it forbids are left out.
fn escaped(text: &str) -> String {
    let plain = text
        .chars()
        .filter(|c| !(c.is_control() || "\u{fffe}\u{ffff}".contains(*c)) || "\t\n".contains(*c))
        .collect::<String>();
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped_and_empty_cells_left_out() {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let names = ["a & \"b\"", "<c>\u{1}", ""];
        let nodes = [ResultColumn::words("name", names), ResultColumn::real("z", [1.5, f64::NAN, 3.0], 2)];
        let edges = [ResultColumn::real("length_m", [10.0, 20.0], 1)];
        let ends = [None, Some([0, 2])];
        write_graphml(Output::writer("net.graphml", &mut bytes), 3, &nodes, &ends, &edges).unwrap();
        let text = String::from_utf8(bytes.into_inner()).unwrap();
        assert!(text.contains(
            "<node id=\"0\"><data key=\"node0\">a &amp; &quot;b&quot;</data><data key=\"node1\">1.5</data></node>"
        ));
        assert!(text.contains("<node id=\"1\"><data key=\"node0\">&lt;c&gt;</data></node>"), "{text}");
        assert!(text.contains("<edge source=\"0\" target=\"2\"><data key=\"edge0\">20.0</data></edge>"), "{text}");
        assert_eq!(text.matches("<edge ").count(), 1);
    }
}
