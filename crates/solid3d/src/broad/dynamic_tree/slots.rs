//! The boxes by proxy: what a move or an insertion does to what is kept of them.
//!
//! A move that stays inside waits for memory, and for as many boxes at a time as the processor has room for the instructions of: many are
//! moved in vectors of four numbers, in a loop that knows whether moves are still noted, which takes some 30 instructions in place of 58 and
//! two thirds of the time. To copy the boxes in `f32` besides, for the pass over pairs, cost more than that pass gained.

use fearless_simd::Simd;

use super::fat_box::FatBox;
use super::notes::Notes;
use super::origin::Origin;
use super::status::Status;
use crate::bounds::Aabb;
use crate::broad::boxes::{Row, of_row, row};
use crate::broad::room::push;
use crate::broad::{Proxy, is_valid};

/// What is kept of the boxes of some proxies that follow one another.
pub(super) struct Slots<'a> {
    /// The first proxy.
    pub first: usize,
    pub origin: &'a Origin,
    pub tight: &'a mut [Row],
    pub fat: &'a mut [FatBox],
    pub status: &'a mut [Status],
}

impl Slots<'_> {
    /// The slot of a proxy, if it is one of these.
    #[inline(always)]
    fn slot(&mut self, proxy: Proxy) -> Option<(&mut Row, &mut FatBox, &mut Status)> {
        let slot = (proxy as usize).wrapping_sub(self.first);
        Some((self.tight.get_mut(slot)?, self.fat.get_mut(slot)?, self.status.get_mut(slot)?))
    }

    /// Moves a box. False if the proxy is not in use, or the box not valid.
    #[inline(always)]
    pub fn update(&mut self, proxy: Proxy, bounds: &Aabb, notes: &mut Notes, moved_max: usize) -> bool {
        let origin = self.origin;
        if let Some((tight, fat, status)) = self.slot(proxy)
            // Nearly all stay inside. What is not in use has an empty fat box.
            && (if origin.is_of_world() { fat.holds(bounds) } else { origin.is_held(fat, bounds) })
        {
            settle(tight, bounds, || notes.note_moved(proxy, status, moved_max));
            return true;
        }
        self.leave(proxy, bounds, notes, moved_max)
    }

    /// Moves boxes, until one is refused: which one it is, if one is.
    #[inline(always)]
    pub fn update_each<S: Simd>(
        &mut self,
        simd: S,
        boxes: &[(Proxy, Aabb)],
        notes: &mut Notes,
        moved_max: usize,
    ) -> Option<usize> {
        let mut done = 0;
        // Ends, because more boxes are done each time, but for the one time when so many moved that no more are noted.
        while done < boxes.len() {
            let was_all = notes.all_moved;
            done += if was_all {
                self.update_inside::<S, true>(simd, &boxes[done..], notes, moved_max)
            } else {
                self.update_inside::<S, false>(simd, &boxes[done..], notes, moved_max)
            };
            if let Some((proxy, bounds)) = boxes.get(done)
                && notes.all_moved == was_all
            {
                if !self.update(*proxy, bounds, notes, moved_max) {
                    return Some(done);
                }
                done += 1;
            }
        }
        None
    }

    /// Moves boxes as long as they stay inside of their fat boxes, and as long as `ALL` says whether so many moved that no more are noted:
    /// how many.
    ///
    /// All there is to a frame in which everything moves a little: it waits for memory, and the fewer instructions a box takes, the more boxes
    /// the processor waits for at a time.
    #[inline(always)]
    fn update_inside<S: Simd, const ALL: bool>(
        &mut self,
        simd: S,
        boxes: &[(Proxy, Aabb)],
        notes: &mut Notes,
        moved_max: usize,
    ) -> usize {
        let Slots { first, origin, tight, fat, status } = self;
        let count = tight.len().min(fat.len()).min(status.len());
        let (tight, fat, status) = (&mut tight[..count], &fat[..count], &mut status[..count]);
        let mut rest = boxes.iter();
        let is_of_world = origin.is_of_world();
        while let Some((proxy, bounds)) = rest.as_slice().first() {
            let slot = (*proxy as usize).wrapping_sub(*first);
            if slot >= count {
                break;
            }
            let stays = if is_of_world {
                fat[slot].holds_with(simd, bounds)
            } else {
                origin.is_held(&fat[slot], bounds)
            };
            if !stays || notes.all_moved != ALL {
                break;
            }
            if ALL {
                tight[slot] = row(bounds);
            } else {
                settle(&mut tight[slot], bounds, || notes.note_moved(*proxy, &mut status[slot], moved_max));
            }
            rest.next();
        }
        boxes.len() - rest.len()
    }

    /// Gives a box another fat box, since it left the one that it had.
    #[inline(never)]
    fn leave(&mut self, proxy: Proxy, bounds: &Aabb, notes: &mut Notes, moved_max: usize) -> bool {
        let origin = self.origin;
        let Some((tight, fat, status)) = self.slot(proxy) else { return false };
        if !status.is(Status::ALIVE) || !is_valid(bounds) {
            return false;
        }
        let was = of_row(std::mem::replace(tight, row(bounds)));
        *fat = FatBox::with_room(proxy, &origin.local(&was), &origin.local(bounds));
        notes.note_moved(proxy, status, moved_max);
        if status.put(Status::QUEUED) {
            push(&mut notes.queue, proxy);
        }
        true
    }

    /// Adds a box. False if the proxy is in use, or the box not valid.
    pub fn insert(&mut self, proxy: Proxy, bounds: &Aabb, notes: &mut Notes) -> bool {
        let local = self.origin.local(bounds);
        let Some((tight, fat, status)) = self.slot(proxy) else { return false };
        if !is_valid(bounds) || !status.put(Status::ALIVE) {
            return false;
        }
        *tight = row(bounds);
        *fat = FatBox::with_room(proxy, &local, &local);
        notes.changed = true;
        if status.put(Status::QUEUED) {
            push(&mut notes.queue, proxy);
        }
        true
    }
}

/// Sets a box; if that is another, `moved` hears of it.
#[inline(always)]
fn settle(tight: &mut Row, bounds: &Aabb, moved: impl FnOnce()) {
    if std::mem::replace(tight, row(bounds)) != row(bounds) {
        moved();
    }
}
