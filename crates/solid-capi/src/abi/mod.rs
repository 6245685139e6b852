//! What C sees, function by function; the headers say what each does. C's types are checked here and nowhere else.

mod error;
mod frames;
mod objects;
mod responses;
mod shapes;
mod types;

pub use error::*;
pub use frames::*;
pub use objects::*;
pub use responses::*;
pub use shapes::*;
pub use types::*;
