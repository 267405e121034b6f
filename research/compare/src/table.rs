//! A table that can be printed, put into a Markdown page or into HTML.

/// Rows under headings, the first column being names.
pub(super) struct TextTable {
    title: String,
    note: String,
    header: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

impl TextTable {
    pub(super) fn new(title: &str, note: &str, header: Vec<&str>) -> Self {
        let header = header.into_iter().map(str::to_owned).collect();
        Self { title: title.to_owned(), note: note.to_owned(), header, rows: Vec::new() }
    }

    pub(super) fn add(&mut self, name: &str, cells: impl IntoIterator<Item = String>) {
        self.rows.push([name.to_owned()].into_iter().chain(cells).collect());
    }

    /// Columns aligned with blanks.
    pub(super) fn to_text(&self) -> String {
        let width = |column: usize| {
            let cells = self.rows.iter().chain([&self.header]).filter_map(|row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.header.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:width$}") } else { format!("{cell:>width$}") }
            });
            let line: Vec<String> = cells.collect();
            format!("{}\n", line.join("  ").trim_end())
        };
        let rows: String = self.rows.iter().map(line).collect();
        format!("{}\n{}{rows}\n", self.title, line(&self.header))
    }

    /// A third-level heading, the note and a table.
    pub(super) fn to_markdown(&self) -> String {
        let line = |row: &Vec<String>| format!("| {} |\n", row.join(" | "));
        let rule = format!("|---|{}\n", "---:|".repeat(self.header.len().saturating_sub(1)));
        let rows: String = self.rows.iter().map(line).collect();
        let note = if self.note.is_empty() { String::new() } else { format!("{}\n\n", self.note) };
        format!("### {}\n\n{note}{}{rule}{rows}\n", self.title, line(&self.header))
    }

    /// A second-level heading, the note and a table.
    pub(super) fn to_html(&self) -> String {
        let cells = |row: &Vec<String>, tag: &str| -> String {
            row.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
        };
        let rows: String = self.rows.iter().map(|row| format!("<tr>{}</tr>\n", cells(row, "td"))).collect();
        let head = cells(&self.header, "th");
        let (title, note) = (escaped(&self.title), escaped(&self.note));
        format!("<h2>{title}</h2><p>{note}</p>\n<table><thead><tr>{head}</tr></thead><tbody>\n{rows}</tbody></table>\n")
    }
}

/// Text as HTML shows it.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
