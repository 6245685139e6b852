//! Animated scenes for [`solid3d`]: files in, objects with shapes out, and their placements and vertex positions at any
//! time.
//!
//! VRML97, glTF 2.0 (`.gltf`, `.glb`), OBJ, STL and PLY. Several files make one scene.

mod error;
mod fault;
mod file;
mod gltf;
mod load;
mod obj;
mod part;
mod ply;
mod polygon;
mod pose;
mod scene;
mod soup;
mod stl;
mod text;
mod vrml;
mod weld;

pub use error::SceneError;
pub use load::{Format, LoadOptions};
pub use pose::{ObjectPose, Pose};
pub use scene::{Scene, SceneObject};
