//! Heavy data beside the choices of a question.

use std::ops::Deref;
use std::sync::Arc;

/// Something large that a question shares with its copies; two are equal if they are the same object.
#[derive(Debug)]
pub struct SharedObject<T>(Arc<T>);

impl<T> SharedObject<T> {
    /// Shares `value`.
    pub fn new(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T> Clone for SharedObject<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for SharedObject<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Deref for SharedObject<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}
