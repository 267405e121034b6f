//! The rows of a table as they were given, so that results stand behind the very numbers and names that they belong to.

/// Cells of a table as text, with the names of their columns.
#[derive(Clone, Debug, Default)]
pub struct TextRows {
    names: Vec<String>,
    /// All cells, row after row.
    text: String,
    /// End of each cell.
    ends: Vec<usize>,
}

impl TextRows {
    /// Rows of columns with these names, none yet.
    #[must_use]
    pub fn new(names: Vec<String>) -> Self {
        Self { names, ..Self::default() }
    }

    /// Appends a row. Cells that it lacks are empty; those beyond the last name are left out.
    pub fn push<T: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = T>) {
        let mut cells = cells.into_iter();
        for _ in 0..self.names.len() {
            self.text.push_str(cells.next().as_ref().map_or("", T::as_ref));
            self.ends.push(self.text.len());
        }
    }

    /// Names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.ends.len().checked_div(self.names.len()).unwrap_or(0)
    }

    pub(crate) fn cell(&self, row: usize, column: usize) -> &str {
        let index = row * self.names.len() + column;
        let start = index.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.ends.get(index).and_then(|&end| self.text.get(start..end)).unwrap_or_default()
    }

    /// Name and cells of each column, of these rows only.
    #[must_use]
    pub fn columns(&self, rows: impl IntoIterator<Item = usize> + Clone) -> Vec<(&str, Vec<&str>)> {
        let cells = |column: usize| rows.clone().into_iter().map(|row| self.cell(row, column)).collect();
        self.names.iter().enumerate().map(|(column, name)| (name.as_str(), cells(column))).collect()
    }
}
