//! Nothing but benches lives here: their dependencies take long to compile, and tests do not need them.
