use crate::bounds::Aabb;
use crate::tree::*;
use glam::DVec3;
pub(super) struct PairMetric {
    pub facet_a: DVec3,
    pub facet_b: DVec3,
    pub sigma_min_a: f64,
    pub sigma_min_b: f64,
}
pub(super) trait Nearest {
    fn nearest(
        &self,
        bound: impl Fn(&Aabb) -> f64,
        best: &mut f64,
        t: &mut Traversal,
        visit: impl FnMut(&[u32], &mut f64),
    );
}
impl Nearest for Tree {
    fn nearest(
        &self,
        _bound: impl Fn(&Aabb) -> f64,
        best: &mut f64,
        _t: &mut Traversal,
        mut visit: impl FnMut(&[u32], &mut f64),
    ) {
        visit(self.order(), best)
    }
}
pub(super) fn nearest_pairs(
    a: &Tree,
    b: &Tree,
    _r: &Relative,
    _m: &PairMetric,
    best: &mut f64,
    _t: &mut Traversal,
    mut visit: impl FnMut(&[u32], &[u32], &mut f64),
) {
    visit(a.order(), b.order(), best)
}
