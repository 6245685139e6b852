//! Collisions of the last test whose pairs are no longer candidates.

use std::collections::BTreeMap;

use super::ObjectId;
use super::findings::{FindingId, Findings};

/// Findings that the next test takes out; those of an object that is removed go with it.
///
/// Where they are of each object is written down when an object is removed, once for each finding. So removing many objects costs what there
/// is of them, and a test pays nothing for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Lapsed {
    /// `None` for those that went with an object.
    findings: Vec<Option<FindingId>>,
    /// Of the first so many `findings`, where those of an object are.
    of_object: BTreeMap<ObjectId, Vec<usize>>,
    listed: usize,
}

impl Lapsed {
    pub fn add(&mut self, finding: FindingId) {
        self.findings.push(Some(finding));
    }

    /// Takes all out of the findings.
    pub fn take_all(&mut self, findings: &mut Findings) {
        self.findings.drain(..).flatten().for_each(|finding| findings.remove(finding));
        self.of_object.clear();
        self.listed = 0;
    }

    /// Takes those of an object out of the findings; gives how many were looked at.
    pub fn take_of(&mut self, object: ObjectId, findings: &mut Findings) -> usize {
        let new = self.findings.iter().enumerate().skip(self.listed);
        let mut looked_at = new.len();
        for (place, finding) in new {
            let collision = findings.collision(finding.expect("what was not listed was not taken"));
            for of in [collision.a, collision.b] {
                self.of_object.entry(of).or_default().push(place);
            }
        }
        self.listed = self.findings.len();
        for place in self.of_object.remove(&object).unwrap_or_default() {
            looked_at += 1;
            if let Some(finding) = self.findings[place].take() {
                findings.remove(finding);
            }
        }
        looked_at
    }
}

#[cfg(test)]
mod tests {
    use slotmap::SlotMap;

    use super::*;
    use crate::world::{Collision, Contact, When};

    /// However many objects are removed, and whenever: each collision is looked at once, and once more for each of its two objects.
    #[test]
    fn removing_costs_what_is_removed() {
        let mut ids = SlotMap::<ObjectId, ()>::with_key();
        let objects: Vec<ObjectId> = (0..201).map(|_| ids.insert(())).collect();
        let (mut lapsed, mut findings) = (Lapsed::default(), Findings::default());
        let mut looked_at = 0;
        for (i, pair) in (0..).zip(objects.windows(2)) {
            let collision = Collision { a: pair[0], b: pair[1], when: When::Now, contact: Contact::Simple };
            lapsed.add(findings.add((i, i + 1), collision));
            // An object whose collision before this one is still there, and one that has none left.
            if i % 10 == 9 {
                looked_at += lapsed.take_of(pair[0], &mut findings) + lapsed.take_of(pair[0], &mut findings);
            }
        }
        assert_eq!(findings.len(), 160);
        for &object in &objects {
            looked_at += lapsed.take_of(object, &mut findings);
        }
        assert_eq!(findings.len(), 0);
        assert!(looked_at <= 3 * 200, "{looked_at}");
        lapsed.take_all(&mut findings);
        // What lapses after all were taken is taken with its object as before.
        let collision = Collision { a: objects[0], b: objects[1], when: When::Now, contact: Contact::Simple };
        lapsed.add(findings.add((0, 1), collision));
        lapsed.take_of(objects[1], &mut findings);
        assert_eq!(findings.len(), 0);
    }
}
