use solid3d::glam::{DMat3, DVec3};

/// Jacobi's method converges quadratically: six sweeps reach rounding for any 3x3 matrix, these are plenty.
const SWEEPS_MAX: usize = 24;

/// Off-diagonal entries this small beside the diagonal are zero.
const OFF_DIAGONAL: f64 = 1e-15;

/// Three orthonormal eigenvectors of a symmetric matrix, as the columns of a rotation.
pub fn eigenvectors(matrix: &DMat3) -> DMat3 {
    let mut m = matrix.to_cols_array_2d();
    let mut vectors = DMat3::IDENTITY;
    let size = m.as_flattened().iter().fold(0.0, |size: f64, x| size.max(x.abs()));
    for _ in 0..SWEEPS_MAX {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q].abs() <= OFF_DIAGONAL * size {
                continue;
            }
            rotated = true;
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut turn = DMat3::IDENTITY.to_cols_array_2d();
            turn[p][p] = c;
            turn[q][q] = c;
            turn[q][p] = s;
            turn[p][q] = -s;
            let turn = DMat3::from_cols_array_2d(&turn);
            m = (turn.transpose() * DMat3::from_cols_array_2d(&m) * turn).to_cols_array_2d();
            vectors *= turn;
        }
        if !rotated {
            break;
        }
    }
    let [x, y] = [vectors.x_axis.normalize(), vectors.y_axis.normalize()];
    let z = x.cross(y).normalize();
    DMat3::from_cols(x, z.cross(x), z)
}

/// The mean of points spread evenly over triangles; of their corners where they have no area. Says also which.
pub fn surface_mean(triangles: impl Iterator<Item = [DVec3; 3]>) -> (DVec3, bool) {
    let (mut area_sum, mut weighted, mut plain, mut count) = (0.0, DVec3::ZERO, DVec3::ZERO, 0.0);
    for [p, q, r] in triangles {
        let area = (q - p).cross(r - p).length();
        let center = (p + q + r) / 3.0;
        area_sum += area;
        weighted += area * center;
        plain += center;
        count += 1.0;
    }
    if area_sum > 0.0 { (weighted / area_sum, true) } else { (plain / count, false) }
}

/// The eigenvectors of the covariance of triangles as surfaces: of points spread evenly over them.
///
/// Source: Gottschalk, Lin and Manocha, *OBBTree*, 1996, section 4.
pub fn surface_axes(triangles: impl Iterator<Item = [DVec3; 3]> + Clone) -> DMat3 {
    let (mean, has_area) = surface_mean(triangles.clone());
    let mut covariance = DMat3::ZERO;
    for [p, q, r] in triangles {
        let [p, q, r] = [p, q, r].map(|x| x - mean);
        let area = if has_area { (q - p).cross(r - p).length() } else { 1.0 };
        let center = (p + q + r) / 3.0;
        covariance += (outer(center) * 9.0 + outer(p) + outer(q) + outer(r)) * area;
    }
    eigenvectors(&covariance)
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
