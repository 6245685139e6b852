//! A cloth that falls over a ball, in VRML97: a CoordinateInterpolator deforms it.

use super::cloth_fall::{BALL_CENTRE, BALL_RADIUS, CELLS, TABLE_RADIUS, TABLE_TOP, fall};
use super::decimal;
use super::mesh::Mesh;

/// When the cloth is recorded, in seconds of its fall. The clock of the scene runs through them there and back.
const TIMES: [f64; 10] = [0.0, 0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.8, 1.0, 1.4];

const HEAD: &str = r#"#VRML V2.0 utf8
#
# A cloth falls over a ball on a table, and is pulled up again: 6 seconds.
#
#     solid check scenes/cloth.wrl
#
# The ball hangs 2 cm above the table, so that the two never touch. The cloth was simulated roughly: where it lies, it
# is a few millimetres inside of the ball and, at its corners, of the table. Units are metres, y is up.
#
# Written by crates/solid-scene/examples/make_scenes; change that, not this.

WorldInfo { title "Cloth" }

Viewpoint {
  position 0 2.3 4.2
  orientation 1 0 0 -0.27
}
"#;

pub fn text() -> String {
    let keys = fall(&TIMES);
    let point = |v: &glam::DVec3| decimal::list(v.to_array(), 3, " ");
    let rows = |vertices: &[glam::DVec3]| {
        let rows = vertices.chunks(usize::from(CELLS) + 1);
        let rows = rows.map(|row| row.iter().map(point).collect::<Vec<_>>().join(","));
        rows.map(|row| format!("\n    {row}")).collect::<Vec<_>>().join(",")
    };
    let faces = Mesh::grid(CELLS).triangles;
    let faces = faces.chunks(2 * usize::from(CELLS)).map(|row| {
        let row: Vec<String> = row.iter().map(|[a, b, c]| format!("{a} {b} {c} -1")).collect();
        format!("\n        {}", row.join(" "))
    });
    let end = TIMES[TIMES.len() - 1];
    format!(
        r#"{HEAD}
DEF table Transform {{
  translation 0 {table} 0
  children Shape {{
    appearance Appearance {{ material Material {{ diffuseColor 0.5 0.35 0.2 }} }}
    geometry Cylinder {{ radius {TABLE_RADIUS} height 0.1 }}
  }}
}}

DEF ball Transform {{
  translation {centre}
  children Shape {{
    appearance Appearance {{ material Material {{ diffuseColor 0.3 0.5 0.8 }} }}
    geometry Sphere {{ radius {BALL_RADIUS} }}
  }}
}}

DEF cloth Shape {{
  appearance Appearance {{ material Material {{ diffuseColor 0.8 0.25 0.25 }} }}
  geometry IndexedFaceSet {{
    solid FALSE
    coord DEF WEAVE Coordinate {{
      point [{start}
      ]
    }}
    coordIndex [{faces}
    ]
  }}
}}

DEF CLOCK TimeSensor {{ cycleInterval 6 loop TRUE }}

# Down, a rest, and up again, more slowly.
DEF THERE_AND_BACK ScalarInterpolator {{
  key      [ 0, 0.3, 0.5, 0.9, 1 ]
  keyValue [ 0, 1,   1,   0,   0 ]
}}

DEF FALL CoordinateInterpolator {{
  key [ {times} ]
  keyValue [{values}
  ]
}}

ROUTE CLOCK.fraction_changed TO THERE_AND_BACK.set_fraction
ROUTE THERE_AND_BACK.value_changed TO FALL.set_fraction
ROUTE FALL.value_changed TO WEAVE.set_point
"#,
        table = decimal::text(TABLE_TOP - 0.05, 3),
        centre = point(&BALL_CENTRE),
        start = rows(&keys[0]),
        faces = faces.collect::<String>(),
        times = decimal::list(TIMES.map(|time| time / end), 4, ", "),
        values = keys.iter().map(|key| rows(key)).collect::<Vec<_>>().join(",\n"),
    )
}
