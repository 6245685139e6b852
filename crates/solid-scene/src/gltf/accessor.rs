//! Numbers out of buffers.

use gltf::json::Accessor;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::Checked;

use super::document::Document;
use crate::fault::Result;
use crate::text::counted;

/// The numbers of an accessor, element by element.
#[derive(Debug, PartialEq)]
pub(super) struct Numbers {
    /// How many numbers each element has.
    pub width: usize,
    pub values: Vec<f64>,
}

impl Numbers {
    pub fn len(&self) -> usize {
        self.values.len() / self.width
    }

    pub fn elements(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.width)
    }
}

/// A run of equally spaced elements in a buffer. Invariant: all of them lie in `bytes`.
struct Run<'a> {
    bytes: &'a [u8],
    stride: usize,
    count: usize,
    component: ComponentType,
    width: usize,
}

impl Document {
    /// Reads an accessor of floating-point numbers, or of integers that are taken as they are or normalized as the
    /// accessor says. `what` names the accessor in errors.
    pub fn numbers(&self, index: usize, expected: Type, what: &str) -> Result<Numbers> {
        let accessor = self.accessor(index).map_err(|fault| fault.of(what))?;
        let (component, width) =
            layout(accessor, expected).map_err(|fault| format!("{what}: accessor {index} {fault}"))?;
        self.read(accessor, component, width).map_err(|fault| fault.of(&format!("{what}: accessor {index}")))
    }

    /// Reads an accessor of unsigned integers that are no greater than `u32::MAX`.
    pub fn integers(&self, index: usize, expected: Type, what: &str) -> Result<Vec<u32>> {
        use ComponentType::{U8, U16, U32};
        let accessor = self.accessor(index).map_err(|fault| fault.of(what))?;
        match accessor.component_type {
            Checked::Valid(component) if matches!(component.0, U8 | U16 | U32) && !accessor.normalized => {}
            _ => return Err(format!("{what}: accessor {index} has no unsigned integers").into()),
        }
        Ok(self.numbers(index, expected, what)?.values.into_iter().map(|value| value as u32).collect())
    }

    fn read(&self, accessor: &Accessor, component: ComponentType, width: usize) -> Result<Numbers> {
        self.spend(accessor.count.0.saturating_mul(width as u64), "elements")?;
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        let mut values = match accessor.buffer_view {
            None => vec![0.0; count * width],
            Some(view) => {
                let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
                let mut values = Vec::new();
                self.run(view.value(), offset, count, component, width)?.read(&mut values);
                values
            }
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(indices) = sparse.indices.component_type else {
                return Err("has sparse indices of an unknown type".into());
            };
            self.spend(sparse.count.0.saturating_mul(width as u64 + 1), "sparse elements")?;
            let sparse_count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
            let view = sparse.indices.buffer_view.value();
            let mut places = Vec::new();
            self.run(view, sparse.indices.byte_offset.0, sparse_count, indices.0, 1)?.read(&mut places);
            let view = sparse.values.buffer_view.value();
            let mut changes = Vec::new();
            self.run(view, sparse.values.byte_offset.0, sparse_count, component, width)?.read(&mut changes);
            scatter(&places, &changes, width, &mut values)?;
        }
        if accessor.normalized {
            values.iter_mut().for_each(|value| *value = normalized(*value, component));
        }
        Ok(Numbers { width, values })
    }

    /// Elements in a buffer view, checked to lie in it and in its buffer.
    fn run(
        &self,
        view: usize,
        offset: u64,
        count: usize,
        component: ComponentType,
        width: usize,
    ) -> Result<Run<'_>> {
        let bytes = self.view_bytes(view)?;
        let size = component.size() * width;
        let stride = self.view(view)?.byte_stride.map_or(size, |stride| stride.0);
        if stride < size {
            let size = counted(size, "byte");
            return Err(
                format!("has elements of {size}, but bufferView {view} a byteStride of {stride}").into()
            );
        }
        let start = usize::try_from(offset).unwrap_or(usize::MAX);
        let length = count.checked_sub(1).map_or(0, |last| stride.saturating_mul(last).saturating_add(size));
        let end = start.saturating_add(length);
        let Some(bytes) = bytes.get(start..end) else {
            let has = bytes.len();
            return Err(format!("goes to byte {end} of bufferView {view}, which has {has}").into());
        };
        Ok(Run { bytes, stride, count, component, width })
    }

    fn view_bytes(&self, index: usize) -> Result<&[u8]> {
        let view = self.view(index)?;
        let buffer = self.buffer(view.buffer.value())?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let end = start.saturating_add(view.byte_length.0);
        let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        range.and_then(|(start, end)| buffer.get(start..end)).ok_or_else(|| {
            let (index_of, has) = (view.buffer.value(), buffer.len());
            format!("bufferView {index} goes to byte {end} of buffer {index_of}, which has {has}").into()
        })
    }
}

/// The type of the components and how many make an element.
fn layout(accessor: &Accessor, expected: Type) -> std::result::Result<(ComponentType, usize), String> {
    let Checked::Valid(component) = accessor.component_type else {
        return Err("has an unknown componentType".into());
    };
    match accessor.type_ {
        Checked::Valid(found) if found == expected => Ok((component.0, expected.multiplicity())),
        Checked::Valid(found) => Err(format!("is of type {found:?}; expected {expected:?}")),
        Checked::Invalid => Err(format!("is of an unknown type; expected {expected:?}")),
    }
}

impl Run<'_> {
    fn read(&self, values: &mut Vec<f64>) {
        let size = self.component.size();
        values.reserve(self.count * self.width);
        for element in 0..self.count {
            let start = element * self.stride;
            let element = &self.bytes[start..start + size * self.width];
            values.extend(element.chunks_exact(size).map(|bytes| value(bytes, self.component)));
        }
    }
}

/// Puts sparse values over dense ones.
fn scatter(places: &[f64], changes: &[f64], width: usize, values: &mut [f64]) -> Result<()> {
    let count = values.len() / width;
    for (&place, change) in places.iter().zip(changes.chunks_exact(width)) {
        let start = place as usize * width;
        match values.get_mut(start..start + width) {
            Some(element) => element.copy_from_slice(change),
            None => {
                return Err(format!("has the sparse index {place}, but {}", counted(count, "element")).into());
            }
        }
    }
    Ok(())
}

/// A little-endian number; `bytes` has as many bytes as its type.
fn value(bytes: &[u8], component: ComponentType) -> f64 {
    let mut b = [0; 4];
    b[..bytes.len()].copy_from_slice(bytes);
    match component {
        ComponentType::I8 => f64::from(b[0].cast_signed()),
        ComponentType::U8 => f64::from(b[0]),
        ComponentType::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
        ComponentType::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
        ComponentType::U32 => f64::from(u32::from_le_bytes(b)),
        ComponentType::F32 => f64::from(f32::from_le_bytes(b)),
    }
}

/// An integer as a fraction of the greatest of its type (glTF 2.0, section 3.6.2.2).
fn normalized(value: f64, component: ComponentType) -> f64 {
    match component {
        ComponentType::I8 => (value / f64::from(i8::MAX)).max(-1.0),
        ComponentType::U8 => value / f64::from(u8::MAX),
        ComponentType::I16 => (value / f64::from(i16::MAX)).max(-1.0),
        ComponentType::U16 => value / f64::from(u16::MAX),
        ComponentType::U32 | ComponentType::F32 => value,
    }
}
