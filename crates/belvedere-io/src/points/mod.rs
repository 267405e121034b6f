//! Parts that readers and writers of clouds share: options, reports, columns, rows of points, clouds of many files.

pub(crate) mod assemble;
pub(crate) mod columns;
pub(crate) mod coordinates;
pub(crate) mod file_part;
pub(crate) mod read_options;
pub(crate) mod read_report;
pub(crate) mod rows;
pub(crate) mod sky;
