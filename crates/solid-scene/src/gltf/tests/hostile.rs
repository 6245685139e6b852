//! Files that were changed at random: whatever is in them, nothing panics.

use proptest::prelude::*;

use super::*;

/// All numbers of a value, to be changed.
fn numbers<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::Number(_) => found.push(value),
        Value::Array(values) => values.iter_mut().for_each(|value| numbers(value, found)),
        Value::Object(values) => values.values_mut().for_each(|value| numbers(value, found)),
        _ => {}
    }
}

fn sample_all(part: Result<Part, String>) {
    if let Ok(part) = part {
        for time in [-1.0, 0.0, 2.5, 1e300] {
            pose(&part, time);
        }
    }
}

proptest! {
    #[test]
    fn changed_instances_never_panic(at in any::<prop::sample::Index>(), value in 0u32..12) {
        let mut file = instances();
        let mut found = Vec::new();
        numbers(&mut file.0, &mut found);
        let at = at.index(found.len());
        *found[at] = json!(value);
        sample_all(file.parse());
    }

    #[test]
    fn changed_numbers_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), 0usize..10), 1..4)) {
        let values = [json!(0), json!(1), json!(2), json!(3), json!(5), json!(30), json!(-1), json!(u32::MAX),
            json!(u64::MAX), json!(1e38)];
        let mut file = everything();
        let mut found = Vec::new();
        numbers(&mut file.0, &mut found);
        for (index, value) in changes {
            let index = index.index(found.len());
            *found[index] = values[value].clone();
        }
        sample_all(file.parse());
        sample_all(file.parse_animation(Some("1")));
    }

    #[test]
    fn truncated_binary_files_are_refused(cut in any::<prop::sample::Index>()) {
        let bytes = binary(&everything());
        prop_assert!(parse(&bytes[..cut.index(bytes.len())], Path::new(""), None).is_err());
    }

    #[test]
    fn changed_bytes_never_panic(at in any::<prop::sample::Index>(), byte: u8) {
        let mut bytes = binary(&everything());
        let at = at.index(bytes.len());
        bytes[at] = byte;
        sample_all(parse(&bytes, Path::new(""), None).map_err(|fault| fault.message().to_owned()));
    }
}
