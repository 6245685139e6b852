use solid3d::Aabb;

/// An end of the projection of a box onto an axis: twice the number of the box, plus one for the upper end.
pub type End = u32;

pub fn lower(index: u32) -> End {
    2 * index
}

pub fn upper(index: u32) -> End {
    2 * index + 1
}

pub fn is_upper(end: End) -> bool {
    end & 1 == 1
}

pub fn box_of(end: End) -> u32 {
    end / 2
}

/// The position of an end, and at the same position whether it is an upper one: lower ends come first, since boxes that touch
/// overlap.
pub fn key(boxes: &[Aabb], axis: usize, end: End) -> (f64, bool) {
    let bounds = &boxes[box_of(end) as usize];
    (if is_upper(end) { bounds.max[axis] } else { bounds.min[axis] }, is_upper(end))
}

/// All ends on an axis in order.
pub fn sorted(boxes: &[Aabb], axis: usize) -> Vec<End> {
    let mut ends: Vec<End> = (0..2 * boxes.len() as u32).collect();
    ends.sort_by(|&x, &y| {
        let ((p, p_upper), (q, q_upper)) = (key(boxes, axis, x), key(boxes, axis, y));
        p.total_cmp(&q).then(p_upper.cmp(&q_upper))
    });
    ends
}

/// All pairs, by one sweep along the x axis: where the engines start from.
pub fn all_pairs(boxes: &[Aabb]) -> impl Iterator<Item = (u32, u32)> {
    let mut active: Vec<u32> = Vec::new();
    let mut pairs = Vec::new();
    for end in sorted(boxes, 0) {
        let index = box_of(end);
        if is_upper(end) {
            active.retain(|&i| i != index);
        } else {
            let bounds = &boxes[index as usize];
            pairs.extend(
                active.iter().filter(|&&i| boxes[i as usize].overlaps(bounds)).map(|&i| ordered(i, index)),
            );
            active.push(index);
        }
    }
    pairs.into_iter()
}

pub fn ordered(i: u32, j: u32) -> (u32, u32) {
    (i.min(j), i.max(j))
}
