//! The response table: which pairs matter, and what is wanted of them, by the names of the objects.
//!
//! ```toml
//! default = "witness"        # ignore, simple, witness, smart, curve, depth or contacts
//! solid = ["ship*"]          # closed meshes that are to be solid
//! decompose = ["crane"]      # meshes that are to be unions of convex pieces
//! clearance = 0.05           # pairs that come nearer are reported
//!
//! [[object]]                 # all pairs with the object
//! name = "mine*"
//! response = "ignore"
//!
//! [[pair]]                   # the pair, in whichever order
//! a = "ship*"
//! b = "sweeper"
//! response = "smart"
//! clearance = 0.2            # of this pair alone
//!
//! [[ray]]                    # cast in every frame
//! name = "barrier"
//! origin = [0, 0.5, 2]
//! to = [0, 0.5, -2]          # of a segment; or `direction`
//! ```
//!
//! `*` stands for any characters, `?` for one. As in the thesis (section 6.2), a rule for the pair overrides one for an
//! object, which overrides the default; of two objects with rules the first in the scene decides. Of the rules of one level
//! the last that matches holds. Pairs on one root path are ignored unless a rule for the pair says otherwise.

mod file;
mod names;
mod pattern;
mod table;

pub use file::Rules;
pub use table::{Bodies, Objects, apply, bodies, set_clearances};
