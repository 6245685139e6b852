//! Animated scenes for [`solid3d`]: files in, objects with shapes out, and their placements and vertex positions at any
//! time.
//!
//! VRML97, glTF 2.0 (`.gltf`, `.glb`), OBJ, STL and PLY. Several files make one scene.
//!
//! ```
//! use solid_scene::{LoadOptions, Pose, Scene};
//! use solid3d::World;
//!
//! let scene = Scene::load(&["../../scenes/cloth.wrl"], &LoadOptions::default())?;
//! let names: Vec<_> = scene.objects().iter().map(|object| object.name()).collect();
//! assert_eq!(names, ["table", "ball", "cloth"]);
//!
//! let (mut world, mut pose) = (World::new(), Pose::default());
//! scene.sample(0.0, &mut pose);
//! let mut ids = Vec::new();
//! for (object, at) in scene.objects().iter().zip(&pose.objects) {
//!     ids.push(world.add(object.shape(), at.placement)?);
//! }
//! assert!(world.test().is_empty());
//!
//! scene.sample(2.0, &mut pose);
//! for (&id, at) in ids.iter().zip(&pose.objects) {
//!     world.set_placement(id, at.placement)?; // refused while it is scaled to nothing
//!     if !at.positions.is_empty() {
//!         world.deform(id, &at.positions)?; // the cloth has fallen over the ball
//!     }
//! }
//! assert!(world.test().iter().any(|collision| (collision.a, collision.b) == (ids[1], ids[2])));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
mod warnings;
mod weld;

pub use error::SceneError;
pub use load::{Format, LoadOptions};
pub use pose::{ObjectPose, Pose};
pub use scene::{Scene, SceneObject};
