//! What a wrong call gives: a code and a message.

use solid3d::Error;

use crate::reference::Reference;

/// The codes of `SOLID/error.h`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Code {
    Null = 1,
    Value,
    Enum,
    Shape,
    Object,
    Order,
    Empty,
    Limit,
    Internal,
}

/// Why a call was refused. Nothing was changed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    pub code: Code,
    pub message: String,
}

pub(crate) type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Fault { code, message: message.into() }
    }

    pub fn null(argument: &str) -> Self {
        Fault::new(Code::Null, format!("{argument} is NULL"))
    }

    pub fn unknown_shape(shape: Reference) -> Self {
        let message =
            format!("shape is {shape}, which is unknown: never created, not ended yet, or deleted since");
        Fault::new(Code::Shape, message)
    }

    pub fn unknown_object(argument: &str, object: Reference) -> Self {
        let message = format!("{argument} is {object}, which is unknown: never created, or deleted since");
        Fault::new(Code::Object, message)
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        let code = match error {
            Error::NoVertices { .. } | Error::NoPrimitives { .. } | Error::PrimitiveSize { .. } => {
                Code::Empty
            }
            Error::TooMany { .. } => Code::Limit,
            Error::NotDeformable { .. } => Code::Shape,
            Error::UnknownObject { .. } | Error::SameObject { .. } => Code::Object,
            // Indices and counts were checked, or come from us.
            Error::VertexIndex { .. } | Error::PositionCount { .. } => Code::Internal,
            _ => Code::Value,
        };
        Fault::new(code, error.to_string())
    }
}

/// `value` when it is finite.
pub(crate) fn finite(argument: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::new(Code::Value, format!("{argument} is {value}; it must be finite")))
    }
}
