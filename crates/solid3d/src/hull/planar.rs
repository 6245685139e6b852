//! The convex polygon around coplanar points.

use super::exact::{Site, Sites};

/// The corners of the hull of sites in one plane, in order; counter-clockwise when `dropped_axis`, along which the
/// plane must not lie, is left out. At least three. Points inside edges are no corners.
///
/// Andrew's monotone chain: after sorting each site is pushed once and popped at most once in either pass.
pub(super) fn convex_polygon(sites: &Sites, dropped_axis: usize) -> Vec<Site> {
    let mut order: Vec<Site> = (0..sites.len()).collect();
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (sites.projected(dropped_axis, a), sites.projected(dropped_axis, b));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    let mut chain: Vec<Site> = Vec::new();
    let mut extend = |chain_start: usize, site: Site| {
        while let [.., before, last] = chain[chain_start..] {
            if sites.turn(dropped_axis, [before, last, site]) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(site);
        chain.len() - 1
    };
    let mut end_of_lower = 0;
    for &site in &order {
        end_of_lower = extend(0, site);
    }
    for &site in order.iter().rev().skip(1) {
        extend(end_of_lower, site);
    }
    // The first site came again at the end.
    chain.pop();
    chain
}
