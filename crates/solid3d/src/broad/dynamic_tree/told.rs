//! Many boxes that are told together.
//!
//! Those that are told in ascending order of their proxies are cut into parts, each of which owns the slots of its proxies; so several
//! threads may work on them. What concerns all of them is noted by each part and joined in their order. So everything is as if
//! the boxes had been told one by one. Boxes that a function says are found by the thread that takes them, some at a time, and stand nowhere
//! between.

use solid_convex::simd::dispatch;

use super::notes::Notes;
use super::slots::Slots;
use crate::bounds::Aabb;
use crate::broad::boxes::row;
use crate::broad::room::room;
use crate::broad::{ASKED_MANY, BoundsOf, Proxy};
#[cfg(feature = "rayon")]
use crate::threads::{first_part_where, share};

/// Boxes that are told together, and what is done with them.
#[derive(Clone, Copy)]
pub(super) enum Told<'a> {
    /// They are added.
    New(&'a [(Proxy, Aabb)]),
    /// They are moved.
    Moved(&'a [(Proxy, Aabb)]),
    /// They are moved to where a function says.
    MovedTo(&'a [Proxy], &'a BoundsOf<'a>),
}

impl Told<'_> {
    fn len(self) -> usize {
        match self {
            Told::New(boxes) | Told::Moved(boxes) => boxes.len(),
            Told::MovedTo(proxies, _) => proxies.len(),
        }
    }

    /// How many boxes are worth another thread. One that is known and moves takes some 3 ns, and what a thread wrote of it the pass over pairs
    /// then reads on another: 16,000 to 30,000 that all move took 1.1 to 1.2 times as long on two threads, 60,000 take 0.8. To be asked where
    /// it is takes some 20 ns: frames of worlds of 1,400 to 2,800 objects took up to 1.08 times as long on two.
    fn many(self) -> usize {
        match self {
            Told::New(_) => 1 << 12,
            Told::Moved(_) => 1 << 15,
            Told::MovedTo(..) => ASKED_MANY,
        }
    }

    /// Whether they are worth entering the pool of threads.
    pub fn is_worth_entering(self) -> bool {
        self.len() >= 2 * self.many()
    }
}

impl Slots<'_> {
    /// Takes boxes one after the other, until one is refused. How many were taken, and which was refused, if one was.
    fn each(&mut self, told: Told, notes: &mut Notes, moved_max: usize) -> (usize, Option<usize>) {
        let refused = match told {
            Told::New(boxes) => {
                let queued = notes.queue.len() + boxes.len();
                room(&mut notes.queue, queued);
                boxes.iter().position(|(proxy, bounds)| !self.insert(*proxy, bounds, notes))
            }
            Told::Moved(boxes) => {
                dispatch!(simd => self.update_each(simd, boxes, notes, moved_max))
            }
            Told::MovedTo(proxies, bounds) => self.update_to(proxies, bounds, notes, moved_max),
        };
        (refused.unwrap_or(told.len()), refused)
    }

    /// Moves boxes to where a function says, some at a time, until one is refused: which one it is, if one is.
    #[inline(never)]
    fn update_to(
        &mut self,
        proxies: &[Proxy],
        bounds: &BoundsOf,
        notes: &mut Notes,
        moved_max: usize,
    ) -> Option<usize> {
        const AT_A_TIME: usize = 16;
        let mut boxes = [(0, Aabb::EMPTY); AT_A_TIME];
        for (first, some) in (0..).step_by(AT_A_TIME).zip(proxies.chunks(AT_A_TIME)) {
            let boxes = &mut boxes[..some.len()];
            for (to, &proxy) in boxes.iter_mut().zip(some) {
                to.0 = proxy;
            }
            bounds(boxes);
            let refused = dispatch!(simd => self.update_each(simd, boxes, notes, moved_max));
            if let Some(refused) = refused {
                return Some(first + refused);
            }
        }
        None
    }

    /// Whether the first boxes are all others than they were: then most of them are taken to be, and none is noted. To note a quarter of
    /// 10,000 boxes, until it was known that so many moved, took a tenth of a frame.
    fn first_move(&self, boxes: &[(Proxy, Aabb)]) -> bool {
        const FIRST: usize = 64;
        let moves = |(proxy, bounds): &(Proxy, Aabb)| {
            let was = self.tight.get((*proxy as usize).wrapping_sub(self.first));
            was.is_some_and(|was| *was != row(bounds))
        };
        boxes.iter().take(FIRST).all(moves)
    }

    /// The same with many boxes: with the feature `rayon`, and if their proxies ascend, on the threads of the current pool. If one is
    /// refused, some after it may have been taken all the same.
    pub fn many(mut self, told: Told, notes: &mut Notes, moved_max: usize) -> (usize, Option<usize>) {
        if let Told::Moved(boxes) = told
            && boxes.len() > moved_max
            && self.first_move(boxes)
        {
            (notes.changed, notes.all_moved) = (true, true);
        }
        #[cfg(feature = "rayon")]
        if share(told.len(), told.many()) && told.ascends() {
            return self.on_threads(told, notes, moved_max);
        }
        self.each(told, notes, moved_max)
    }
}

#[cfg(feature = "rayon")]
impl Told<'_> {
    /// Boxes in one part.
    fn part(self) -> usize {
        match self {
            Told::New(_) | Told::Moved(_) => 1 << 10,
            Told::MovedTo(..) => 1 << 8,
        }
    }

    /// Whether proxies ascend.
    fn ascends(self) -> bool {
        match self {
            Told::New(boxes) | Told::Moved(boxes) => {
                let part = self.part();
                let is_before = |(a, _): &(Proxy, Aabb), (b, _): &(Proxy, Aabb)| a < b;
                first_part_where(boxes, part, 1, |part| !part.is_sorted_by(is_before)).is_none()
                    && (part..boxes.len()).step_by(part).all(|next| is_before(&boxes[next - 1], &boxes[next]))
            }
            Told::MovedTo(proxies, _) => proxies.is_sorted_by(|a, b| a < b),
        }
    }

    fn first(self) -> Proxy {
        match self {
            Told::New(boxes) | Told::Moved(boxes) => boxes[0].0,
            Told::MovedTo(proxies, _) => proxies[0],
        }
    }

    fn split_at(self, at: usize) -> (Self, Self) {
        match self {
            Told::New(boxes) => {
                let (boxes, later) = boxes.split_at(at);
                (Told::New(boxes), Told::New(later))
            }
            Told::Moved(boxes) => {
                let (boxes, later) = boxes.split_at(at);
                (Told::Moved(boxes), Told::Moved(later))
            }
            Told::MovedTo(proxies, bounds) => {
                let (proxies, later) = proxies.split_at(at);
                (Told::MovedTo(proxies, bounds), Told::MovedTo(later, bounds))
            }
        }
    }
}

#[cfg(feature = "rayon")]
impl<'a> Slots<'a> {
    /// Takes the slots below a proxy off the front.
    fn split_off(&mut self, end: usize) -> Slots<'a> {
        let count = end - self.first;
        fn front<'a, T>(slots: &mut &'a mut [T], count: usize) -> &'a mut [T] {
            slots.split_off_mut(..count.min(slots.len())).unwrap_or_default()
        }
        let first = std::mem::replace(&mut self.first, end);
        Slots {
            first,
            origin: self.origin,
            tight: front(&mut self.tight, count),
            fat: front(&mut self.fat, count),
            status: front(&mut self.status, count),
        }
    }

    /// See [`many`](Self::many); the proxies ascend.
    fn on_threads(self, told: Told, notes: &mut Notes, moved_max: usize) -> (usize, Option<usize>) {
        notes.shared = true;
        let mut parts = std::mem::take(&mut notes.parts);
        parts.resize_with(told.len().div_ceil(told.part()), Notes::default);
        parts.iter_mut().for_each(|part| part.all_moved = notes.all_moved);
        let done = self.in_parts(told, &mut parts, moved_max);
        parts.iter_mut().for_each(|part| notes.append(part, moved_max));
        notes.parts = parts;
        done
    }

    /// Takes boxes that are noted in one part, or both halves of them at the same time.
    fn in_parts(mut self, told: Told, parts: &mut [Notes], moved_max: usize) -> (usize, Option<usize>) {
        if let [part] = parts {
            return self.each(told, part, moved_max);
        }
        let half = parts.len() / 2;
        let boxes = half * told.part();
        let (told, later_told) = told.split_at(boxes);
        let (parts, later_parts) = parts.split_at_mut(half);
        let slots = self.split_off(later_told.first() as usize);
        let ((taken, refused), (later_taken, later_refused)) = rayon::join(
            || slots.in_parts(told, parts, moved_max),
            || self.in_parts(later_told, later_parts, moved_max),
        );
        (taken + later_taken, refused.or(later_refused.map(|refused| boxes + refused)))
    }
}
