//! A sorted sequence of interval endpoints on one axis.

use super::Proxy;
use crate::bounds::Aabb;

/// Which end of its interval an endpoint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Lower,
    Upper,
}

/// One end of the interval of one box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Endpoint {
    pub value: f64,
    /// Twice the proxy, plus one for an upper endpoint.
    key: u32,
}

impl Endpoint {
    fn new(proxy: Proxy, side: Side, value: f64) -> Self {
        Endpoint { value, key: 2 * proxy + side as u32 }
    }

    pub fn proxy(&self) -> Proxy {
        self.key / 2
    }

    pub fn side(&self) -> Side {
        if self.key & 1 == 0 { Side::Lower } else { Side::Upper }
    }

    /// Whether `self` may stand before `other`: minima come before maxima at equal values, so touching counts.
    pub fn precedes(&self, other: &Endpoint) -> bool {
        self.value < other.value
            || self.value == other.value && (self.side() == Side::Lower || other.side() == Side::Upper)
    }
}

/// The endpoints on one axis.
#[derive(Clone, Debug, Default)]
pub(super) struct Sequence {
    /// Each [`precedes`](Endpoint::precedes) the next.
    endpoints: Vec<Endpoint>,
    /// Where in `endpoints` the endpoint of a key stands.
    position: Vec<u32>,
    /// Scratch of `merge`.
    arrivals: Vec<Endpoint>,
}

impl Sequence {
    pub fn endpoints(&self) -> &[Endpoint] {
        &self.endpoints
    }

    /// Gives an endpoint a smaller value and swaps it down to its place; gives the number of swaps.
    ///
    /// `crossed` hears the proxies whose endpoint of the opposite side was passed. The loop ends at the head of the
    /// sequence at the latest.
    pub fn move_down(
        &mut self,
        proxy: Proxy,
        side: Side,
        value: f64,
        crossed: &mut impl FnMut(Proxy),
    ) -> u64 {
        let moved = Endpoint::new(proxy, side, value);
        let start = self.position[moved.key as usize] as usize;
        let mut at = start;
        while at > 0 {
            let below = self.endpoints[at - 1];
            if below.precedes(&moved) {
                break;
            }
            self.put(at, below);
            if below.side() != side {
                crossed(below.proxy());
            }
            at -= 1;
        }
        self.put(at, moved);
        (start - at) as u64
    }

    /// As [`move_down`](Self::move_down), for a greater value.
    pub fn move_up(&mut self, proxy: Proxy, side: Side, value: f64, crossed: &mut impl FnMut(Proxy)) -> u64 {
        let moved = Endpoint::new(proxy, side, value);
        let start = self.position[moved.key as usize] as usize;
        let mut at = start;
        while at + 1 < self.endpoints.len() {
            let above = self.endpoints[at + 1];
            if moved.precedes(&above) {
                break;
            }
            self.put(at, above);
            if above.side() != side {
                crossed(above.proxy());
            }
            at += 1;
        }
        self.put(at, moved);
        (at - start) as u64
    }

    fn put(&mut self, at: usize, endpoint: Endpoint) {
        self.endpoints[at] = endpoint;
        self.position[endpoint.key as usize] = at as u32;
    }

    /// Takes out the endpoints of the proxies that do not stay.
    pub fn retain(&mut self, stays: impl Fn(Proxy) -> bool) {
        self.endpoints.retain(|e| stays(e.proxy()));
        self.renumber();
    }

    /// Sorts the endpoints of new boxes in; `proxies` is the number of proxies ever used.
    pub fn merge<'a>(&mut self, proxies: usize, new: impl Iterator<Item = (Proxy, &'a Aabb)>, axis: usize) {
        self.arrivals.clear();
        for (proxy, bounds) in new {
            self.arrivals.push(Endpoint::new(proxy, Side::Lower, bounds.min[axis]));
            self.arrivals.push(Endpoint::new(proxy, Side::Upper, bounds.max[axis]));
        }
        // A total order that refines `precedes`: by value (-0 equals 0), lower first, then by proxy.
        self.arrivals.sort_unstable_by(|a, b| {
            (a.value + 0.0).total_cmp(&(b.value + 0.0)).then((a.key & 1, a.key).cmp(&(b.key & 1, b.key)))
        });
        // Merge from the back, in place.
        let mut old = self.endpoints.len();
        self.endpoints.extend_from_slice(&self.arrivals);
        let mut to = self.endpoints.len();
        for arrival in self.arrivals.iter().rev() {
            while old > 0 && !self.endpoints[old - 1].precedes(arrival) {
                to -= 1;
                old -= 1;
                self.endpoints[to] = self.endpoints[old];
            }
            to -= 1;
            self.endpoints[to] = *arrival;
        }
        self.position.resize(2 * proxies, 0);
        self.renumber();
    }

    fn renumber(&mut self) {
        for (at, endpoint) in self.endpoints.iter().enumerate() {
            self.position[endpoint.key as usize] = at as u32;
        }
    }

    pub fn validate(&self) {
        assert!(self.endpoints.is_sorted_by(Endpoint::precedes), "a sequence is not sorted");
        for (at, endpoint) in self.endpoints.iter().enumerate() {
            assert_eq!(self.position[endpoint.key as usize] as usize, at, "back reference");
        }
    }
}
