//! VRML97 (ISO/IEC 14772-1:1997).
//!
//! In the order of reading:
//!
//! 1. [`text`] reads a file, [`scan`] makes it safe to parse, [`document`] parses it (with the crate vrml97), [`wide`] tells
//!    which integer is too large;
//! 2. [`expand`] writes out the instances of PROTOs and Inlines into a [`graph`], with the files of a [`library`];
//! 3. [`route`] collects the ROUTEs, [`signal`] follows them from [`sensor`]s through [`interpolator`]s;
//! 4. [`walk`] goes from the root to every Shape, through [`transform`]s, and makes its [`geometry`] an object;
//! 5. [`animation`] moves and deforms the objects.
//!
//! What bounds a hostile file is in [`limits`].

mod animation;
mod document;
mod expand;
mod geometry;
mod graph;
mod interpolator;
mod library;
mod limits;
mod route;
mod scan;
mod sensor;
mod signal;
mod text;
mod transform;
mod vectors;
mod walk;
mod wide;

use std::collections::BTreeSet;
use std::path::Path;

use self::geometry::Builder;
use self::graph::Graph;
use self::route::Routes;
use self::sensor::Sensor;
use self::signal::SignalBuilder;
use self::walk::Walk;
use crate::error::SceneError;
use crate::part::Part;
use crate::warnings::Warnings;

/// Loads a file, on a thread with a stack of known size: reading recurses.
pub(crate) fn load(file: &Path) -> Result<Part, SceneError> {
    let fail = |message: String| SceneError::new(file, None, message);
    std::thread::scope(|scope| {
        let reader = std::thread::Builder::new().name("vrml97".into()).stack_size(limits::STACK_BYTES);
        let thread = reader.spawn_scoped(scope, || read(file));
        let thread = thread.map_err(|error| fail(format!("no thread to read it on: {error}")))?;
        thread.join().unwrap_or_else(|_| Err(fail("the parser failed on it; please report this file".into())))
    })
}

fn read(file: &Path) -> Result<Part, SceneError> {
    let mut warnings = Warnings::default();
    let (graph, files) = expand::expand(file, &mut warnings)?;
    let routes = Routes::collect(&graph)?;
    warn_of_routes(&graph, &routes, &mut warnings);
    let duration = duration(&graph)?;
    let signals = SignalBuilder::new(&graph, &routes);
    let builder = Builder::new(&graph, signals, &mut warnings);
    let (objects, animation) = Walk::new(&graph, builder).run()?;
    let warnings = warnings.into_vec();
    Ok(Part { objects, motion: Box::new(animation), duration, unit: "metre", warnings, files })
}

/// The end of the last first cycle of those that run.
fn duration(graph: &Graph) -> Result<f64, SceneError> {
    let mut duration = 0.0_f64;
    for &node in &graph.sensors {
        duration = Sensor::read(graph, node)?.first_cycle_end().map_or(duration, |end| duration.max(end));
    }
    Ok(duration)
}

/// Names the ROUTEs that would change what collides, but into fields that are not followed.
fn warn_of_routes(graph: &Graph, routes: &Routes, warnings: &mut Warnings) {
    let followed = |type_name: &str, field: &str| match type_name {
        "Transform" | "Group" | "Anchor" | "Billboard" => {
            !matches!(field, "addChildren" | "removeChildren" | "children")
        }
        "Coordinate" => field == "point",
        "TimeSensor" | "Switch" | "LOD" | "Collision" | "Inline" | "Shape" => false,
        "IndexedFaceSet" | "IndexedLineSet" | "PointSet" => !matches!(field, "set_coordIndex" | "coord"),
        "ElevationGrid" | "Extrusion" => false,
        _ if interpolator::is_interpolator(type_name) => field == "set_fraction",
        _ => true,
    };
    let pairs = routes.destinations().map(|(node, field)| (graph.type_name(*node), field.as_str()));
    let ignored: BTreeSet<_> = pairs.filter(|(type_name, field)| !followed(type_name, field)).collect();
    for (type_name, field) in ignored {
        warnings.add(format!("ROUTEs to {type_name}.{field} are not followed"));
    }
}
