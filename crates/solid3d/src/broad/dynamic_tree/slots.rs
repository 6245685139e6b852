//! The boxes by proxy: what a move or an insertion does to what is kept of them, one by one or many at a time.
//!
//! Boxes that are told in ascending order of their proxies are cut into parts, each of which owns the slots of its proxies; so several
//! threads may work on them. What concerns all of them is noted by each part and joined in their order. So everything is as if
//! the boxes had been told one by one.

use super::fat_box::FatBox;
use super::status::Status;
use crate::bounds::Aabb;
use crate::broad::{Proxy, is_ordered, is_valid};
#[cfg(feature = "rayon")]
use crate::threads::{first_part_where, for_each_part};

/// What is kept of the boxes of some proxies that follow one another.
pub(super) struct Slots<'a> {
    /// The first proxy.
    pub first: usize,
    pub tight: &'a mut [Aabb],
    pub fat: &'a mut [FatBox],
    pub status: &'a mut [Status],
}

/// What became of a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fate {
    /// It is not what it was.
    pub changed: bool,
    /// It moved for the first time since the last flush.
    pub moved: bool,
    /// It is to be placed in the tree, and was not to be before.
    pub queued: bool,
}

impl Slots<'_> {
    /// The slot of a proxy, if it is one of these.
    #[inline(always)]
    fn slot(&mut self, proxy: Proxy) -> Option<(&mut Aabb, &mut FatBox, &mut Status)> {
        let slot = (proxy as usize).wrapping_sub(self.first);
        Some((self.tight.get_mut(slot)?, self.fat.get_mut(slot)?, self.status.get_mut(slot)?))
    }

    /// Moves a box. `None` if the proxy is not in use, or the box not valid.
    #[inline(always)]
    pub fn update(&mut self, proxy: Proxy, bounds: &Aabb) -> Option<Fate> {
        if let Some((tight, fat, status)) = self.slot(proxy)
            // Nearly all stay inside. A fat box is finite: so is what lies in it.
            && fat.contains(bounds) & is_ordered(bounds) & status.is(Status::ALIVE)
        {
            let changed = *tight != *bounds;
            if changed {
                *tight = *bounds;
            }
            let moved = changed && status.put(Status::MOVED);
            return Some(Fate { changed, moved, queued: false });
        }
        self.leave(proxy, bounds)
    }

    /// Gives a box another fat box, since it left the one that it had.
    #[inline(never)]
    fn leave(&mut self, proxy: Proxy, bounds: &Aabb) -> Option<Fate> {
        let (tight, fat, status) = self.slot(proxy)?;
        if !status.is(Status::ALIVE) || !is_valid(bounds) {
            return None;
        }
        let was = std::mem::replace(tight, *bounds);
        *fat = FatBox::with_room(proxy, &was, bounds);
        Some(Fate { changed: true, moved: status.put(Status::MOVED), queued: status.put(Status::QUEUED) })
    }

    /// Adds a box. `None` if the proxy is in use, or the box not valid.
    pub fn insert(&mut self, proxy: Proxy, bounds: &Aabb) -> Option<Fate> {
        let (tight, fat, status) = self.slot(proxy)?;
        if !is_valid(bounds) || !status.put(Status::ALIVE) {
            return None;
        }
        *tight = *bounds;
        *fat = FatBox::with_room(proxy, bounds, bounds);
        Some(Fate { changed: true, moved: false, queued: status.put(Status::QUEUED) })
    }
}

/// What became of many boxes.
#[cfg(feature = "rayon")]
#[derive(Debug, Default)]
pub(super) struct News {
    /// Whether any is not what it was.
    pub changed: bool,
    /// How many were taken.
    pub taken: usize,
    /// Those that moved for the first time since the last flush.
    pub moved: Vec<Proxy>,
    /// Those to be placed in the tree that were not before.
    pub queued: Vec<Proxy>,
    /// The first that was refused; those after it were not looked at.
    pub refused: Option<usize>,
}

/// Boxes in one part.
#[cfg(feature = "rayon")]
pub(super) const PART: usize = 1 << 10;

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
            tight: front(&mut self.tight, count),
            fat: front(&mut self.fat, count),
            status: front(&mut self.status, count),
        }
    }

    /// Does something with each of many boxes, whose proxies must ascend. What became of them, part by part.
    pub fn for_each(
        mut self,
        boxes: &[(Proxy, Aabb)],
        note_moved: bool,
        work: impl Fn(&mut Slots, Proxy, &Aabb) -> Option<Fate> + Sync + Send,
    ) -> Vec<News> {
        struct Part<'a, 'b> {
            boxes: &'b [(Proxy, Aabb)],
            slots: Slots<'a>,
            news: News,
        }
        let mut parts: Vec<Part> = (boxes.chunks(PART))
            .map(|boxes| {
                let end = boxes.last().map_or(0, |(proxy, _)| *proxy as usize + 1);
                Part { boxes, slots: self.split_off(end), news: News::default() }
            })
            .collect();
        for_each_part(&mut parts, 1, 1, |_, parts| {
            for Part { boxes, slots, news } in parts {
                for (i, (proxy, bounds)) in boxes.iter().enumerate() {
                    let Some(fate) = work(slots, *proxy, bounds) else {
                        news.refused = Some(i);
                        break;
                    };
                    news.changed |= fate.changed;
                    news.taken += 1;
                    if fate.moved && note_moved {
                        news.moved.push(*proxy);
                    }
                    if fate.queued {
                        news.queued.push(*proxy);
                    }
                }
            }
        });
        parts.into_iter().map(|part| part.news).collect()
    }
}

/// Whether proxies ascend.
#[cfg(feature = "rayon")]
pub(super) fn ascend(boxes: &[(Proxy, Aabb)]) -> bool {
    let is_before = |(a, _): &(Proxy, Aabb), (b, _): &(Proxy, Aabb)| a < b;
    first_part_where(boxes, PART, 1, |part| !part.is_sorted_by(is_before)).is_none()
        && (PART..boxes.len()).step_by(PART).all(|next| is_before(&boxes[next - 1], &boxes[next]))
}
