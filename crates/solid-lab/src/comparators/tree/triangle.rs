use solid3d::glam::DVec3;

/// Three corners.
pub type Triangle = [DVec3; 3];

/// Whether two triangles share a point, by the separating-axes test that RAPID uses: the two normals, nine products of edges,
/// and for coplanar ones the six normals of edges within the planes. Rounded: right beyond some 1e-15 of the size.
pub fn triangles_intersect(x: &Triangle, y: &Triangle) -> bool {
    let origin = x[0];
    let (x, y) = (x.map(|p| p - origin), y.map(|p| p - origin));
    let (e, f) = (edges(&x), edges(&y));
    let (n, m) = (e[0].cross(e[1]), f[0].cross(f[1]));
    let separates = |axis: DVec3| {
        let (p, q) = (x.map(|v| v.dot(axis)), y.map(|v| v.dot(axis)));
        greatest(p) < least(q) || greatest(q) < least(p)
    };
    let crossed = || e.iter().flat_map(|e| f.iter().map(move |f| e.cross(*f)));
    let sides = || e.map(|e| e.cross(n)).into_iter().chain(f.map(|f| f.cross(m)));
    !(separates(n) || separates(m) || crossed().any(separates) || sides().any(separates))
}

fn edges(t: &Triangle) -> [DVec3; 3] {
    [t[1] - t[0], t[2] - t[1], t[0] - t[2]]
}

fn least([x, y, z]: [f64; 3]) -> f64 {
    x.min(y).min(z)
}

fn greatest([x, y, z]: [f64; 3]) -> f64 {
    x.max(y).max(z)
}

/// The distance of two triangles, zero when they intersect: the least over pairs of edges, and corners over faces.
pub fn triangle_distance(x: &Triangle, y: &Triangle) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..3 {
        for j in 0..3 {
            least = least.min(segments_distance_squared(x[i], x[(i + 1) % 3], y[j], y[(j + 1) % 3]));
        }
    }
    for (corners, face) in [(x, y), (y, x)] {
        for &corner in corners {
            least = least.min(face_distance_squared(corner, face));
        }
    }
    if least > 0.0 && triangles_intersect(x, y) { 0.0 } else { least.sqrt() }
}

/// Of the segments pq and rs, by clamping the closest points of their lines.
fn segments_distance_squared(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> f64 {
    let (d, e, between) = (q - p, s - r, p - r);
    let (dd, ee, de) = (d.length_squared(), e.length_squared(), d.dot(e));
    let (db, eb) = (d.dot(between), e.dot(between));
    let share = |x: f64, of: f64| if of > 0.0 { (x / of).clamp(0.0, 1.0) } else { 0.0 };
    let mut along_d = share(de * eb - db * ee, dd * ee - de * de);
    let along_e = share(de * along_d + eb, ee);
    along_d = share(de * along_e - db, dd);
    // The clamped point on e may be better placed once more for the new point on d.
    let along_e = share(de * along_d + eb, ee);
    (p + d * along_d - r - e * along_e).length_squared()
}

/// Of a point to the inside of a triangle; infinite where its foot is outside, since then an edge is closer.
fn face_distance_squared(p: DVec3, face: &Triangle) -> f64 {
    let e = edges(face);
    let n = e[0].cross(e[1]);
    let inside = (0..3).all(|i| e[i].cross(p - face[i]).dot(n) >= 0.0);
    if !inside || n == DVec3::ZERO {
        return f64::INFINITY;
    }
    let height = (p - face[0]).dot(n);
    height * height / n.length_squared()
}
