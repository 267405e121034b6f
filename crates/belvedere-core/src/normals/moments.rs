//! Moments of points.

/// Sums over points from which their mean and covariance follow; those of two sets add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    pub(crate) count: f64,
    sum: [f64; 3],
    /// xx, yy, zz, xy, yz, zx
    products: [f64; 6],
}

impl Moments {
    pub(crate) fn add(&mut self, p: [f64; 3]) {
        let [x, y, z] = p;
        self.count += 1.0;
        for (sum, v) in self.sum.iter_mut().zip(p) {
            *sum += v;
        }
        for (sum, v) in self.products.iter_mut().zip([x * x, y * y, z * z, x * y, y * z, z * x]) {
            *sum += v;
        }
    }

    pub(crate) fn mean(&self) -> [f64; 3] {
        self.sum.map(|s| s / self.count)
    }

    pub(crate) fn covariance(&self) -> [f64; 6] {
        let mean = self.mean();
        let product = |i: usize, a: usize, b: usize| self.products[i] / self.count - mean[a] * mean[b];
        [product(0, 0, 0), product(1, 1, 1), product(2, 2, 2), product(3, 0, 1), product(4, 1, 2), product(5, 2, 0)]
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: std::array::from_fn(|i| self.sum[i] + other.sum[i]),
            products: std::array::from_fn(|i| self.products[i] + other.products[i]),
        }
    }
}
