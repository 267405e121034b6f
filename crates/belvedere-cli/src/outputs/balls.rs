//! Ball files.

use crate::arguments::CloudInput;
use belvedere::model::ModelParts;

/// The parts of a model with what made them, and of which clouds.
pub(crate) fn with_program(parts: ModelParts, input: &CloudInput) -> ModelParts {
    let program = concat!("belvedere ", env!("CARGO_PKG_VERSION"));
    parts.with_provenance("program", program).with_provenance("input", input.names().join(" "))
}
