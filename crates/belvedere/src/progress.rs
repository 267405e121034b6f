//! How long work reports how far it is.

/// Receives the number of items finished since the last call, from any thread.
#[derive(Clone, Copy, Default)]
pub struct Progress<'a>(Option<&'a (dyn Fn(usize) + Sync)>);

impl<'a> Progress<'a> {
    /// Reports to `receive`.
    #[must_use]
    pub fn to(receive: &'a (dyn Fn(usize) + Sync)) -> Self {
        Self(Some(receive))
    }

    /// Reports to nobody.
    #[must_use]
    pub fn none() -> Self {
        Self(None)
    }

    /// Says that `count` more items are finished.
    pub fn advance(self, count: usize) {
        if let Some(receive) = self.0 {
            receive(count);
        }
    }
}
