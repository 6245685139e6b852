//! The experiments of the thesis, each under its name.
