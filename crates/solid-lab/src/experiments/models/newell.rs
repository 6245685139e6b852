//! The control points of the teapot: Newell, *The Utilization of Procedure Models in Digital Image Synthesis*, 1975.

/// A curve that is turned around the z axis: distance from the axis, and height.
pub type Profile = [[f64; 2]; 4];

/// The rim, the two halves of the body, the two halves of the lid, and the bottom.
pub const PROFILES: [Profile; 6] = [
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[0.0, 3.15], [KNOB_RADIUS, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
    [[0.0, 0.0], [1.425, 0.0], [1.5, 0.075], [1.5, 0.15]],
];

/// A quarter of a circle of radius r is a cubic whose inner control points are this times r off its ends' tangent points.
pub const ROUND: f64 = 0.56;

/// The circle of this radius, in the knob of the lid, has been given another factor.
pub const KNOB_RADIUS: f64 = 0.8;

/// See [`KNOB_RADIUS`].
pub const KNOB_ROUND: f64 = 0.5625;

/// One half of the handle or of the spout, on the side of negative y: for each row of control points the (x, z) of four, and the y
/// of the inner two; the outer two are in the plane of symmetry.
pub type HalfTube = [([[f64; 2]; 4], f64); 4];

/// The two lengths of the handle.
pub const HANDLE: [HalfTube; 2] = [
    [
        ([[-1.6, 2.025], [-1.6, 2.025], [-1.5, 2.25], [-1.5, 2.25]], -0.3),
        ([[-2.3, 2.025], [-2.3, 2.025], [-2.5, 2.25], [-2.5, 2.25]], -0.3),
        ([[-2.7, 2.025], [-2.7, 2.025], [-3.0, 2.25], [-3.0, 2.25]], -0.3),
        ([[-2.7, 1.8], [-2.7, 1.8], [-3.0, 1.8], [-3.0, 1.8]], -0.3),
    ],
    [
        ([[-2.7, 1.8], [-2.7, 1.8], [-3.0, 1.8], [-3.0, 1.8]], -0.3),
        ([[-2.7, 1.575], [-2.7, 1.575], [-3.0, 1.35], [-3.0, 1.35]], -0.3),
        ([[-2.5, 1.125], [-2.5, 1.125], [-2.65, 0.9375], [-2.65, 0.9375]], -0.3),
        ([[-2.0, 0.9], [-2.0, 0.9], [-1.9, 0.6], [-1.9, 0.6]], -0.3),
    ],
];

/// The two lengths of the spout.
pub const SPOUT: [HalfTube; 2] = [
    [
        ([[1.7, 1.425], [1.7, 1.425], [1.7, 0.6], [1.7, 0.6]], -0.66),
        ([[2.6, 1.425], [2.6, 1.425], [3.1, 0.825], [3.1, 0.825]], -0.66),
        ([[2.3, 2.1], [2.3, 2.1], [2.4, 2.025], [2.4, 2.025]], -0.25),
        ([[2.7, 2.4], [2.7, 2.4], [3.3, 2.4], [3.3, 2.4]], -0.25),
    ],
    [
        ([[2.7, 2.4], [2.7, 2.4], [3.3, 2.4], [3.3, 2.4]], -0.25),
        ([[2.8, 2.475], [2.8, 2.475], [3.525, 2.49375], [3.525, 2.49375]], -0.25),
        ([[2.9, 2.475], [2.9, 2.475], [3.45, 2.5125], [3.45, 2.5125]], -0.15),
        ([[2.8, 2.4], [2.8, 2.4], [3.2, 2.4], [3.2, 2.4]], -0.15),
    ],
];
