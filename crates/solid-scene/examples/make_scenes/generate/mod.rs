//! The generated scenes, as text.

mod cloth;
mod cloth_fall;
mod decimal;
mod deform;
mod gltf;
mod mesh;
mod robot_cell;

use std::io;
use std::path::Path;

/// The files, by name.
pub fn all() -> [(&'static str, String); 3] {
    [("cloth.wrl", cloth::text()), ("deform.gltf", deform::text()), ("robot_cell.gltf", robot_cell::text())]
}

/// Writes the files into a folder.
pub fn write_all(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    all().iter().try_for_each(|(name, text)| std::fs::write(folder.join(name), text))
}
