//! The types of `SOLID/types.h`.

use std::ffi::{c_uint, c_void};

use solid3d::glam::DVec3;

use crate::engine::Points;

/// A number.
pub type DtScalar = f64;
/// A place in a vertex array.
pub type DtIndex = c_uint;
/// A number of things.
pub type DtCount = c_uint;
/// An object: a pointer of the client's, never followed.
pub type DtObjectRef = *mut c_void;
/// A shape: a number in the form of a pointer.
pub type DtShapeRef = *mut c_void;
/// A `DtPolyType` as C may pass it: any number.
pub type DtPolyType = c_uint;
/// A `DtResponseType` as C may pass it: any number.
pub type DtResponseType = c_uint;
/// A client's function; `C-unwind` lets its C++ exceptions pass.
pub type ResponseFunction =
    unsafe extern "C-unwind" fn(*mut c_void, DtObjectRef, DtObjectRef, *const DtCollData);
/// A client's function, or NULL.
pub type DtResponse = Option<ResponseFunction>;

/// A point of each of two colliding objects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct DtCollData {
    /// Of object1. Space: local.
    pub point1: [DtScalar; 3],
    /// Of object2. Space: local.
    pub point2: [DtScalar; 3],
    /// From point2 to point1, for smart response. Space: world.
    pub normal: [DtScalar; 3],
}

impl From<Points> for DtCollData {
    fn from(points: Points) -> Self {
        let [point1, point2, normal] =
            [points.point1, points.point2, points.normal].map(|v: DVec3| v.to_array());
        DtCollData { point1, point2, normal }
    }
}
