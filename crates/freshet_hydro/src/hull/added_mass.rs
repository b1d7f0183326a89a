//! The water that has to be moved with a hull.
//!
//! In an ideal fluid a body that is accelerated along an axis moves some water with it, as if it were heavier by k ρ V, and by k′ ρ V
//! when it is turned. For ellipsoids both are known exactly (Lamb, *Hydrodynamics*, 6th ed. 1932, §§ 114–115), and a hull counts as the
//! ellipsoid of its second moments. Bodies with edges move more than that, squarely cut prisms by about 0.18 ρ V (k of a cube is 0.68
//! and not 0.5: DNV-RP-C205, *Environmental conditions and environmental loads*, table D-2): how much of it a hull gets is told by
//! its volume, which for equal second moments is 0.888 of the ellipsoid's.
use glam::{Mat3, Vec3};

/// What squarely cut edges add to the coefficient along each axis.
const EDGES: f32 = 0.18;
/// Volume of a box over that of the ellipsoid of its second moments.
const BOX_SHARE: f32 = 0.887_622;

/// Added mass of a wholly submerged hull, in its own frame about its centroid, for water of density 1 kg/m³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AddedMass {
    /// Along the axes, m³.
    pub linear: Mat3,
    /// About the axes, m⁵.
    pub angular: Mat3,
}

impl AddedMass {
    /// Of the ellipsoid of these second moments (m²), and what the edges of a hull of this volume (m³) add.
    pub(super) fn of(volume: f32, covariance: Mat3) -> Self {
        let (moments, axes) = eigen(covariance);
        // A homogeneous ellipsoid has C = a²/5 along a semi-axis a.
        let semi = (moments * 5.0).max(Vec3::splat(1e-12)).map(f32::sqrt);
        let ellipsoid = 4.0 / 3.0 * std::f32::consts::PI * semi.element_product();
        let edges = EDGES * ((1.0 - volume / ellipsoid) / (1.0 - BOX_SHARE)).clamp(0.0, 1.0);
        let lamb = lamb(semi);
        let squares = semi * semi;
        let sums = Vec3::new(squares.y + squares.z, squares.z + squares.x, squares.x + squares.y) / 5.0;
        let turned = |diagonal: Vec3| axes * Mat3::from_diagonal(diagonal * volume) * axes.transpose();
        Self { linear: turned(lamb.linear + edges), angular: turned(lamb.angular + edges * sums) }
    }
}

/// Coefficients of an ellipsoid: linear k, without unit, and angular k′ in m².
struct Lamb {
    linear: Vec3,
    angular: Vec3,
}

/// With α_i = a b c ∫₀^∞ dλ/((a_i² + λ) Δ), Δ² = (a² + λ)(b² + λ)(c² + λ): k = α/(2 − α), and about the first axis
/// k′ = (b² − c²)² (γ − β)/(5 (2 (b² − c²) + (b² + c²)(β − γ))).
fn lamb(semi: Vec3) -> Lamb {
    let squares = (semi * semi).to_array().map(f64::from);
    let product = semi.to_array().map(f64::from).iter().product::<f64>();
    // ∫ dλ/((z + λ) √(…)) = ⅔ R_D(x, y, z)
    let alpha =
        [0, 1, 2].map(|i| product * 2.0 / 3.0 * carlson_rd(squares[(i + 1) % 3], squares[(i + 2) % 3], squares[i]));
    let about = |i: usize| {
        let (b, c, beta, gamma) = (squares[(i + 1) % 3], squares[(i + 2) % 3], alpha[(i + 1) % 3], alpha[(i + 2) % 3]);
        let difference = b - c;
        if difference.abs() < 1e-4 * (b + c) {
            return 0.0;
        }
        difference * difference * (gamma - beta) / (5.0 * (2.0 * difference + (b + c) * (beta - gamma)))
    };
    Lamb {
        linear: Vec3::from_array(alpha.map(|alpha| (alpha / (2.0 - alpha)) as f32)),
        angular: Vec3::from_array([0, 1, 2].map(|i| about(i).max(0.0) as f32)),
    }
}

/// Carlson's integral R_D(x, y, z) by duplication (Carlson, *Computing elliptic integrals by duplication*, Numer. Math. 33, 1979).
fn carlson_rd(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let (mut sum, mut power) = (0.0, 1.0);
    for _ in 0..24 {
        let root = (x * y).sqrt() + (x * z).sqrt() + (y * z).sqrt();
        sum += power / (z.sqrt() * (z + root));
        power *= 0.25;
        (x, y, z) = (0.25 * (x + root), 0.25 * (y + root), 0.25 * (z + root));
    }
    let mean = 0.2 * (x + y + 3.0 * z);
    3.0 * sum + power / (mean * mean.sqrt())
}

/// Eigenvalues and orthonormal eigenvectors (as columns) of a symmetric matrix, by Jacobi's rotations.
fn eigen(matrix: Mat3) -> (Vec3, Mat3) {
    let mut a = matrix.to_cols_array_2d().map(|column| column.map(f64::from));
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0_f64]];
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() < 1e-30 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (first, second) = (a[p], a[q]);
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * first[k] - s * second[k], s * first[k] + c * second[k]);
            }
            for row in &mut vectors {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
        }
    }
    let column = |k: usize| Vec3::new(vectors[0][k] as f32, vectors[1][k] as f32, vectors[2][k] as f32);
    (Vec3::new(a[0][0] as f32, a[1][1] as f32, a[2][2] as f32), Mat3::from_cols(column(0), column(1), column(2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere ½; a prolate spheroid of 2 : 1 0.2100 along and 0.7042 across (closed form, Lamb § 114); a disc 8/3 a³ ρ across.
    #[test]
    fn ellipsoids_have_the_coefficients_of_lamb() {
        let sphere = lamb(Vec3::splat(0.7));
        assert!((sphere.linear - 0.5).abs().max_element() < 1e-6 && sphere.angular == Vec3::ZERO);
        let long = lamb(Vec3::new(2.0, 1.0, 1.0));
        assert!((long.linear - Vec3::new(0.21002, 0.7042, 0.7042)).abs().max_element() < 1e-4, "{}", long.linear);
        assert!(long.angular.x == 0.0 && (long.angular.y - 0.24).abs() < 0.01, "{}", long.angular);
        let thin = 1e-3;
        let disc = lamb(Vec3::new(1.0, thin, 1.0));
        let mass = disc.linear.y * 4.0 / 3.0 * std::f32::consts::PI * thin;
        assert!((mass - 8.0 / 3.0).abs() < 5e-3, "{mass}");
    }

    #[test]
    fn eigenvectors_turn_a_matrix_into_its_eigenvalues() {
        let turn = Mat3::from_rotation_y(0.4) * Mat3::from_rotation_x(1.1);
        let matrix = turn * Mat3::from_diagonal(Vec3::new(3.0, 1.0, 2.0)) * turn.transpose();
        let (values, vectors) = eigen(matrix);
        let again = vectors * Mat3::from_diagonal(values) * vectors.transpose();
        assert!(again.abs_diff_eq(matrix, 1e-5), "{values}");
    }
}
