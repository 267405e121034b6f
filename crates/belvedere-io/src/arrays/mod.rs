//! Arrays of NumPy: NPY, archives of them, and the folders of masbcpp.

pub(crate) mod header;
pub(crate) mod masbcpp;
pub(crate) mod npy;
pub(crate) mod npz;
pub(crate) mod write_npy;
