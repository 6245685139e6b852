//! Which objects are there: animators hide an object by a scale of 0, and of what has no extent there is nothing to test.

/// Whether an object is there in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// As in the frame before.
    There,
    /// But not in the frame before, so that there is no way from there.
    New,
    Absent,
}

/// The presence of all objects, by their place in the scene, frame after frame.
#[derive(Debug)]
pub struct Presences {
    now: Vec<Presence>,
    /// When each was first absent, in seconds.
    first_absent: Vec<Option<f64>>,
}

impl Presences {
    /// So many objects, all of which are there.
    pub fn new(objects: usize) -> Self {
        Presences { now: vec![Presence::There; objects], first_absent: vec![None; objects] }
    }

    /// Whether an object is there.
    pub fn of(&self, object: usize) -> Presence {
        self.now[object]
    }

    /// Notes that an object is there in the next frame.
    pub fn show(&mut self, object: usize) {
        let was_absent = self.now[object] == Presence::Absent;
        self.now[object] = if was_absent { Presence::New } else { Presence::There };
    }

    /// Notes that an object is absent in the next frame, which is at a time.
    pub fn hide(&mut self, object: usize, time: f64) {
        self.now[object] = Presence::Absent;
        self.first_absent[object].get_or_insert(time);
    }

    /// The objects that were absent in some frame, in their order, each with the time of the first.
    pub fn absences(&self) -> impl Iterator<Item = (usize, f64)> {
        self.first_absent.iter().enumerate().filter_map(|(object, time)| time.map(|time| (object, time)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_absent_is_new_for_a_frame() {
        let mut presences = Presences::new(2);
        let seen = [true, false, false, true, true, false].map(|is_there| {
            if is_there {
                presences.show(1)
            } else {
                presences.hide(1, 7.0)
            };
            presences.of(1)
        });
        use Presence::{Absent, New, There};
        assert_eq!(seen, [There, Absent, Absent, New, There, Absent]);
        assert_eq!(presences.of(0), There);
    }

    #[test]
    fn the_first_absence_is_told() {
        let mut presences = Presences::new(3);
        presences.hide(2, 1.5);
        presences.hide(2, 2.5);
        presences.show(2);
        presences.hide(1, 3.0);
        assert_eq!(presences.absences().collect::<Vec<_>>(), [(1, 3.0), (2, 1.5)]);
    }
}
