//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use solid3d::Response;
use solid3d::convex::MAGNITUDE_MAX;
use solid3d::glam::DVec3;

use crate::rays::vector;

/// Frames per second when nothing else is asked for.
pub const FPS_DEFAULT: f64 = 30.0;

/// The least and the most frames per second: beyond them times of frames may be no numbers, or all one.
const FPS_MIN: f64 = 1e-100;
const FPS_MAX: f64 = 1e100;

/// Pairs whose boxes overlap when nothing else is asked for: a pair takes some 0.8 KB.
pub const PAIRS_MAX_DEFAULT: u64 = 1_000_000;

/// The same where contacts or curves are asked for: of two meshes a pair takes up to 25 KB for the ones, and 8 KB for the others.
pub const PAIRS_MAX_OF_MANY_POINTS: u64 = 100_000;

const EXIT_STATUS: &str = "\
Exit status:
  0  no collisions
  1  collisions, or objects nearer than --clearance or the clearances of --rules
  2  bad input or usage, or a warning where --strict is given; one message on standard error says what and where";

const CHECK_NOTES: &str = "\
Objects:
  Every node with geometry is an object, and so is every instance of its mesh where a glTF file has several. Nodes on one
  root path (one holds the other) are not tested against each other. Shapes are closed sets, so touching collides; a
  mesh is a surface, so a body wholly inside one does not, unless --solid declares the mesh solid. An object that is scaled to
  nothing in a frame, or flattened, as animators hide one, is not there in that frame; a warning tells when it first is not.

Convex pieces (--decompose PATTERN):
  In the place of the mesh are at most 32 convex pieces, found on a grid of 64 voxels along its longest side: they cover all
  of the mesh, and more by about 1 % of its convex hull for each piece. Notches thinner than two voxels may be closed, and
  those in what is flat, since they have no volume. A mesh that deforms cannot be decomposed. With --solid for the same object the
  mesh must be closed, too.

Rules (--rules FILE.toml): what is wanted of which pair; `*` stands for any characters, `?` for one.
    default = \"witness\"             # ignore, simple, witness, smart, curve, depth or contacts
    solid = [\"tank*\"]               # as --solid
    decompose = [\"crane\"]           # as --decompose
    clearance = 0.05                # as --clearance

    [[object]]                      # all pairs with the object
    name = \"mine*\"
    response = \"ignore\"

    [[pair]]                        # the pair, in whichever order
    a = \"ship*\"
    b = \"sweeper\"
    response = \"smart\"             # one of the two may be missing
    clearance = 0.2                 # of this pair alone

    [[ray]]                         # as --ray, under a name of its own
    name = \"barrier\"
    origin = [0, 0.5, 2]
    to = [0, 0.5, -2]               # the end of a segment; or, without end: direction = [0, 0, -1]
  A rule for the pair overrides one for an object, which overrides the default; of two objects with rules the first
  in the scene decides. Of the rules of one level the last that matches holds. A response for a pair also holds on a
  root path. --response overrides the default, --clearance the clearance that is not of a pair.

Clearance (--clearance DISTANCE):
  Reports every pair that comes nearer than DISTANCE, in units of length of the scene (metres in glTF and VRML97), in each
  frame: the distance, and the closest points. Pairs that collide count, too; their distance is less the depth of the
  one in the other, and the points are the deepest. What is at just the distance is not nearer. Pairs that are ignored
  are not looked at. Clearances are those at the frames: also with --continuous, what is nearer only between two frames is
  not reported. The table tells of each pair where it is nearest, and when. The JSON of a frame then also has \"near\", and
  of CSV the rows with a distance are these; a pair that collides has a row of each.

Rays (--ray ORIGIN DIRECTION, each X,Y,Z):
  What a ray meets in each frame: of every object on its way, whatever its response, the first point, the triangle, the normal on
  the side that the ray comes from, and the distance from the origin. Where a ray starts inside of a solid there is no triangle and no normal.
  The table tells of each ray and object where they meet nearest, and when. The JSON of a frame then also has \"rays\", ray by ray, of
  each the nearest first; of CSV the rows with a ray are these, the object in column a. Rays do not change the exit status.

Depth (--response depth):
  How deep two objects are in each other: the shortest translation that leaves them touching. The normal says where the
  first is to go; the points are those of each that are deepest in the other. The JSON of such a collision has \"depth\",
  \"point_a\" and \"point_b\"; the table tells the greatest. Of surfaces it is that of the deepest pair of triangles; a solid counts as its convex hull.

Contacts (--response contacts):
  Every point where two objects are in contact. The JSON of such a collision has \"contacts\", a list of regions of one
  normal, which points from the second object to the first, each with its points: \"point_a\" and \"point_b\" on the two
  surfaces, \"depth\", \"primitives\" (the triangle of each) and \"features\" (the vertex, edge or face of each), which stay the
  same from frame to frame while the same parts are in contact. The table tells how many points there are at most, and the
  greatest depth; point, normal and depth of CSV are those of the deepest contact.

Curves (--response curve):
  Where the surfaces of two objects meet: meshes, complex shapes, boxes and convex hulls. The JSON of such a collision
  has \"curve\", a list of polylines, each a list of points [x,y,z]; of a closed one the last is the first again. The list
  is empty where a round primitive (sphere, cone, cylinder) takes part. The point of the table and of --csv is the
  first of the curve.

Between frames (--continuous):
  Objects are tested on their way from frame to frame, so that a bullet does not pass a wall. Between two frames every
  point of an object, every vertex of a mesh that deforms, moves straight at constant speed. A pair that touches between
  the previous frame and this one collides in this frame, from the time when it first does: \"first\" in the table,
  \"contact_time\" in JSON, a last column contact_time in CSV; for a pair that touched in the previous frame already,
  the time of that frame. The time is never late, and early by what makes a distance of 1e-8 of the size of the
  objects. Where a pair only touches on the way, the point is that of the first contact.

Placements (--placements FILE.csv): in place of the animation,
    frame,object,tx,ty,tz,qx,qy,qz,qw
    0,ship,0,0,0,0,0,0,1
    12,ship,1.5,0,0,0,0,0.7071,0.7071
  A row places the object from its frame on: a translation and a quaternion (normalised when read), optionally followed
  by a scale sx,sy,sz, none of them 0. Rows come in any order; of two for one frame and object the later holds, with a
  warning. Until placed, objects stay where they are at time 0. Frames run from 0 to the largest in the file.";

/// Finds every collision in an animated scene
#[derive(Debug, Parser)]
#[command(name = "solid", version, after_help = EXIT_STATUS)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Plays the animation frame by frame and reports what collides
    #[command(after_help = EXIT_STATUS, after_long_help = format!("{CHECK_NOTES}\n\n{EXIT_STATUS}"))]
    Check(Box<CheckArgs>),
    /// Says what is in the files: objects, kinds, numbers of primitives, units, animation, defects
    Info(InfoArgs),
}

/// Which files, and how to read them.
#[derive(Args, Debug)]
pub struct SceneArgs {
    /// Scene files, which together make one scene: .wrl, .vrml, .gltf, .glb, .obj, .stl, .ply
    #[arg(value_name = "SCENE", required = true)]
    pub files: Vec<PathBuf>,

    /// Make each object (`o`) and group (`g`) of an OBJ file an object
    #[arg(long)]
    pub split: bool,

    /// The animation of a glTF file to play, by its name or else by its number, from 0 [default: the first]
    #[arg(long, value_name = "NAME|INDEX")]
    pub animation: Option<String>,
}

#[derive(Args, Debug)]
pub struct InfoArgs {
    #[command(flatten)]
    pub scene: SceneArgs,
}

#[derive(Args, Debug)]
pub struct CheckArgs {
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = FPS_DEFAULT, value_parser = fps, allow_negative_numbers = true)]
    pub fps: f64,

    /// Time of the first frame, in seconds [default: 0]
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub from: Option<f64>,

    /// Time of the last frame, in seconds; where it is none of the regular times, the last step is shorter
    /// [default: the end of the animation]
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub to: Option<f64>,

    /// Which pairs to test, and for what, by object name
    #[arg(long, value_name = "FILE.toml")]
    pub rules: Option<PathBuf>,

    /// Placements per frame, in place of the animation
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["from", "to"])]
    pub placements: Option<PathBuf>,

    /// Take the mesh objects of this name (`*`, `?`) for the solids that they bound, so that what is inside collides; may be
    /// repeated. The meshes must be closed
    #[arg(long, value_name = "PATTERN")]
    pub solid: Vec<String>,

    /// Take the mesh objects of this name (`*`, `?`) for unions of convex pieces, so that they have an inside, depths and
    /// contacts also where they are not convex or not closed; may be repeated
    #[arg(long, value_name = "PATTERN")]
    pub decompose: Vec<String>,

    /// Report pairs that are nearer than this in a frame, in units of length of the scene, with their closest points
    #[arg(long, value_name = "DISTANCE", value_parser = clearance, allow_negative_numbers = true)]
    pub clearance: Option<f64>,

    /// Cast a ray from a point in a direction, in every frame, and report what it meets; may be repeated
    #[arg(long, num_args = 2, value_names = ["ORIGIN", "DIRECTION"], value_parser = vector, allow_hyphen_values = true)]
    pub ray: Vec<DVec3>,

    /// What to find out about colliding pairs [default: witness]
    #[arg(long, value_name = "RESPONSE")]
    pub response: Option<ResponseArg>,

    /// Find also what collides between two frames, and when first; see below (--help)
    #[arg(long)]
    pub continuous: bool,

    /// Stop where the boxes of more pairs of objects overlap than this: each pair takes a kilobyte of memory, of two meshes up to 25
    /// for contacts and up to 8 for curves [default: 1000000, or 100000 where --response or a rule asks for contacts or curve]
    #[arg(long, value_name = "N", value_parser = pairs, allow_negative_numbers = true)]
    pub max_pairs: Option<u64>,

    /// Write every frame and collision as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Write every collision as a row of CSV; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,

    /// Let a warning be an error: the report is printed, but the exit status is 2
    #[arg(long)]
    pub strict: bool,

    /// Print how much work it was
    #[arg(long)]
    pub stats: bool,
}

/// A response that finds something.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum ResponseArg {
    /// That they collide
    Simple,
    /// A common point
    Witness,
    /// The normal between the closest points of the previous frame, and the middle of these
    Smart,
    /// The lines in which the surfaces meet (in JSON), and their first point
    Curve,
    /// How deep they are in each other, the shortest way out, and the deepest points
    Depth,
    /// All points of contact, with normals and depths (in JSON), and the deepest
    Contacts,
}

impl From<ResponseArg> for Response {
    fn from(response: ResponseArg) -> Response {
        match response {
            ResponseArg::Simple => Response::Simple,
            ResponseArg::Witness => Response::Witness,
            ResponseArg::Smart => Response::Smart,
            ResponseArg::Curve => Response::Curve,
            ResponseArg::Depth => Response::Depth,
            ResponseArg::Contacts => Response::Contacts,
        }
    }
}

fn fps(text: &str) -> Result<f64, String> {
    number(text, |x| (FPS_MIN..=FPS_MAX).contains(&x), "a number from 1e-100 to 1e100")
}

fn clearance(text: &str) -> Result<f64, String> {
    number(text, |x| (0.0..=MAGNITUDE_MAX).contains(&x), "a length from 0 to 1e100")
}

fn pairs(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

fn seconds(text: &str) -> Result<f64, String> {
    number(text, |x| x >= 0.0, "a finite number of seconds, at least 0")
}

fn number(text: &str, fits: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && fits(x) => Ok(x),
        _ => Err(format!("expected {expected}")),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn numbers_that_are_no_rate_or_time_are_refused() {
        for text in ["0", "-1", "nan", "inf", "1e999", "x", "", "1e-308", "1e-101", "1e101"] {
            assert!(fps(text).is_err(), "{text}");
        }
        assert_eq!([fps("1e-100"), fps("1e100")], [Ok(FPS_MIN), Ok(FPS_MAX)]);
        assert_eq!(fps("29.97"), Ok(29.97));
        for text in ["-0.1", "nan", "inf", "1s"] {
            assert!(seconds(text).is_err(), "{text}");
        }
        assert_eq!(seconds("0"), Ok(0.0));
        for text in ["-1", "1e6", "0.5", "18446744073709551616"] {
            assert!(pairs(text).is_err(), "{text}");
        }
        assert_eq!(pairs("0"), Ok(0));
        for text in ["-0.1", "nan", "inf", "1e101", "5cm"] {
            assert!(clearance(text).is_err(), "{text}");
        }
        assert_eq!(clearance("5e-2"), Ok(0.05));
    }
}
