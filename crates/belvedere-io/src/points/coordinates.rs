//! Coordinates as a file keeps them.

/// Coordinates as a file keeps them.
#[derive(Debug)]
pub(crate) enum Coordinates {
    /// `values × scale + offset`: half the memory of f64, and nothing is rounded before the origin is known.
    Quantised { values: Vec<[i32; 3]>, scale: [f64; 3], offset: [f64; 3] },
    /// Plain numbers.
    Real(Vec<[f64; 3]>),
}

impl Default for Coordinates {
    fn default() -> Self {
        Self::Real(Vec::new())
    }
}

impl Coordinates {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Quantised { values, .. } => values.len(),
            Self::Real(values) => values.len(),
        }
    }

    /// Position by position, in the unit of the file.
    pub(crate) fn positions(&self) -> impl Iterator<Item = [f64; 3]> {
        let (quantised, scale, offset, real) = match self {
            Self::Quantised { values, scale, offset } => (values.as_slice(), *scale, *offset, [].as_slice()),
            Self::Real(values) => ([].as_slice(), [0.0; 3], [0.0; 3], values.as_slice()),
        };
        quantised.iter().map(move |&q| unquantise(q, scale, offset)).chain(real.iter().copied())
    }

    /// Appends coordinates that are kept in the same way.
    #[cfg(feature = "las")]
    pub(crate) fn append(&mut self, other: Self) {
        match (self, other) {
            (Self::Quantised { values, .. }, Self::Quantised { values: more, .. }) => values.extend(more),
            (Self::Real(values), Self::Real(more)) => values.extend(more),
            (Self::Real(values), other @ Self::Quantised { .. }) => values.extend(other.positions()),
            (mine @ Self::Quantised { .. }, other) => {
                let all = mine.positions().chain(other.positions()).collect();
                *mine = Self::Real(all);
            }
        }
    }

    /// The coordinates at `indices`, in that order.
    pub(crate) fn select(&self, indices: &[u32]) -> Self {
        fn of<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
            indices.iter().filter_map(|&i| values.get(i as usize).copied()).collect()
        }
        match self {
            Self::Quantised { values, scale, offset } => {
                Self::Quantised { values: of(values, indices), scale: *scale, offset: *offset }
            }
            Self::Real(values) => Self::Real(of(values, indices)),
        }
    }
}

/// The coordinate that a LAS file keeps as an integer.
pub(crate) fn unquantise(q: [i32; 3], scale: [f64; 3], offset: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| f64::from(q[i]) * scale[i] + offset[i])
}
