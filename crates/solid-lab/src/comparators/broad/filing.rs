use solid3d::Aabb;

/// What files boxes by where they lie.
pub(super) trait Filing {
    /// The boxes by number.
    fn boxes(&mut self) -> &mut [Aabb];
    /// Files a box.
    fn enter(&mut self, index: u32);
    /// Takes a box out, while it is still where it was when it was filed.
    fn leave(&mut self, index: u32);

    /// Files each anew, where it is now.
    fn refile(&mut self, moved: &[(u32, Aabb)]) {
        for &(index, bounds) in moved {
            self.leave(index);
            self.boxes()[index as usize] = bounds;
            self.enter(index);
        }
    }
}

/// All pairs, by a query for each box that gives its partners of smaller number.
pub(super) fn pairs_by_query(count: usize, partners: impl Fn(u32) -> Vec<u32>) -> Vec<(u32, u32)> {
    let partners = &partners;
    let mut pairs: Vec<(u32, u32)> =
        (0..count as u32).flat_map(|j| partners(j).into_iter().map(move |i| (i, j))).collect();
    pairs.sort_unstable();
    pairs
}
