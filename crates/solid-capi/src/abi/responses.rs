//! Responses.

use std::ffi::c_void;

use solid3d::Response;

use super::error::call;
use super::{DtObjectRef, DtResponse, DtResponseType};
use crate::engine::{Callback, Engine};
use crate::fault::{Code, Fault, Result};

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSetDefaultResponse(
    response: DtResponse,
    response_type: DtResponseType,
    client_data: *mut c_void,
) {
    call("dtSetDefaultResponse", (), || {
        let response = definition(response, response_type, client_data)?;
        Engine::lock().set_default_response(response);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtClearDefaultResponse() {
    call("dtClearDefaultResponse", (), || {
        Engine::lock().set_default_response(None);
        Ok(())
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSetObjectResponse(
    object: DtObjectRef,
    response: DtResponse,
    response_type: DtResponseType,
    client_data: *mut c_void,
) {
    call("dtSetObjectResponse", (), || {
        let response = definition(response, response_type, client_data)?;
        Engine::lock().set_object_response(object.into(), response)
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtClearObjectResponse(object: DtObjectRef) {
    call("dtClearObjectResponse", (), || Engine::lock().set_object_response(object.into(), None));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtResetObjectResponse(object: DtObjectRef) {
    call("dtResetObjectResponse", (), || Engine::lock().reset_object_response(object.into()));
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtSetPairResponse(
    object1: DtObjectRef,
    object2: DtObjectRef,
    response: DtResponse,
    response_type: DtResponseType,
    client_data: *mut c_void,
) {
    call("dtSetPairResponse", (), || {
        let response = definition(response, response_type, client_data)?;
        Engine::lock().set_pair_response(object1.into(), object2.into(), response)
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtClearPairResponse(object1: DtObjectRef, object2: DtObjectRef) {
    call("dtClearPairResponse", (), || {
        Engine::lock().set_pair_response(object1.into(), object2.into(), None)
    });
}

/// See the header.
#[unsafe(no_mangle)]
pub extern "C" fn dtResetPairResponse(object1: DtObjectRef, object2: DtObjectRef) {
    call("dtResetPairResponse", (), || Engine::lock().reset_pair_response(object1.into(), object2.into()));
}

/// What a Set command defines.
fn definition(
    response: DtResponse,
    response_type: DtResponseType,
    client_data: *mut c_void,
) -> Result<Option<Callback>> {
    let kind = match response_type {
        0 => return Ok(None),
        1 => Response::Simple,
        2 => Response::Smart,
        3 => Response::Witness,
        _ => {
            let message = format!("type is {response_type}; it must be a DtResponseType, from 0 to 3");
            return Err(Fault::new(Code::Enum, message));
        }
    };
    let function = response.ok_or_else(|| Fault::null("response"))?;
    Ok(Some(Callback { function, client_data: client_data.into(), kind }))
}
