//! Conjugate gradients for a network of conductances.
//!
//! The matrix is that of Kirchhoff's law at every node: Σ conductance · (x_i − x_j) over its edges, plus an anchor
//! conductance to a known value. It is symmetric, positive definite if every connected part is anchored, and an
//! M-matrix, so that the incomplete Cholesky factorisation exists (Meijerink & van der Vorst 1977, *Mathematics of
//! Computation* 31, 148–162) and makes a good preconditioner.

/// The residual, relative to the right-hand side, below which rounding leaves nothing to gain.
const SMALLEST_RESIDUAL: f64 = 1e-12;

/// Conductances along the edges of a network and to known values outside it.
pub(super) struct Conductances<'a> {
    /// The two nodes of every edge, the smaller first; sorted by the larger, which the factorisation relies on.
    pub edges: &'a [[u32; 2]],
    /// Conductance of every edge, above zero.
    pub along: Vec<f64>,
    /// Sum of the conductances to known values of every node, zero or above.
    pub anchors: Vec<f64>,
}

impl Conductances<'_> {
    /// Every edge's nodes and conductance.
    fn iter(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let edges = self.edges.iter().zip(&self.along);
        edges.map(|(&[a, b], &conductance)| (a as usize, b as usize, conductance))
    }

    /// Kirchhoff's sums at all nodes.
    fn times(&self, x: &[f64], product: &mut [f64]) {
        for ((product, anchor), x) in product.iter_mut().zip(&self.anchors).zip(x) {
            *product = anchor * x;
        }
        for (a, b, conductance) in self.iter() {
            let flow = conductance * (x[a] - x[b]);
            product[a] += flow;
            product[b] -= flow;
        }
    }

    /// The incomplete factors (1 + L) D (1 + Lᵀ), L being as empty as the matrix below its diagonal.
    fn factorise(&self) -> Factors {
        let mut diagonal = self.anchors.clone();
        for (a, b, conductance) in self.iter() {
            diagonal[a] += conductance;
            diagonal[b] += conductance;
        }
        let lower = self.iter().map(|(a, b, conductance)| {
            let share = conductance / diagonal[a];
            diagonal[b] -= conductance * share;
            share
        });
        Factors { lower: lower.collect(), diagonal }
    }

    /// Solves the factorised system for `residual`.
    fn precondition(&self, factors: &Factors, residual: &[f64], z: &mut [f64]) {
        z.copy_from_slice(residual);
        for (&[a, b], share) in self.edges.iter().zip(&factors.lower) {
            z[b as usize] += share * z[a as usize];
        }
        for (z, diagonal) in z.iter_mut().zip(&factors.diagonal) {
            *z /= diagonal;
        }
        for (&[a, b], share) in self.edges.iter().zip(&factors.lower).rev() {
            z[a as usize] += share * z[b as usize];
        }
    }

    /// Solves for the values `x` at which Kirchhoff's sums equal `right`, starting from the `x` given.
    ///
    /// Stops when the residual has shrunk to the share `reduction` of what it was, or to [`SMALLEST_RESIDUAL`]. Returns
    /// whether it got there within 10 iterations per node.
    pub fn solve(&self, right: &[f64], reduction: f64, x: &mut [f64]) -> bool {
        let factors = self.factorise();
        let mut image = vec![0.0; x.len()];
        self.times(x, &mut image);
        let mut residual: Vec<f64> = right.iter().zip(&image).map(|(b, ax)| b - ax).collect();
        let smallest = SMALLEST_RESIDUAL * SMALLEST_RESIDUAL * dot(right, right);
        let enough = smallest.max(reduction * reduction * dot(&residual, &residual));

        let mut z = vec![0.0; x.len()];
        self.precondition(&factors, &residual, &mut z);
        let mut direction = z.clone();
        let mut rz = dot(&residual, &z);
        for _ in 0..10 * x.len() {
            if dot(&residual, &residual) <= enough {
                return true;
            }
            self.times(&direction, &mut image);
            let step = rz / dot(&direction, &image);
            add_scaled(x, step, &direction);
            add_scaled(&mut residual, -step, &image);
            self.precondition(&factors, &residual, &mut z);
            let next = dot(&residual, &z);
            for (direction, z) in direction.iter_mut().zip(&z) {
                *direction = z + next / rz * *direction;
            }
            rz = next;
        }
        false
    }
}

/// An incomplete Cholesky factorisation.
struct Factors {
    /// −L of every edge.
    lower: Vec<f64>,
    /// D.
    diagonal: Vec<f64>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn add_scaled(x: &mut [f64], factor: f64, direction: &[f64]) {
    for (x, direction) in x.iter_mut().zip(direction) {
        *x += factor * direction;
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    #[test]
    fn resistors_in_series_and_parallel() {
        // 1 V — 2 S — node 0 — (1 S + 3 S by way of node 1: ¾ S) — node 2 — 4 S — 0 V, with node 3 a dead end on 1.
        let network = Conductances {
            edges: &[[0, 1], [0, 2], [1, 2], [1, 3]],
            along: vec![1.0, 1.0, 3.0, 5.0],
            anchors: vec![2.0, 0.0, 4.0, 0.0],
        };
        let mut volts = [0.0; 4];
        assert!(network.solve(&[2.0, 0.0, 0.0, 0.0], 0.0, &mut volts));
        let current = 1.0 / (1.0 / 2.0 + 1.0 / 1.75 + 1.0 / 4.0);
        let [first, last] = [1.0 - current / 2.0, current / 4.0];
        let middle = first - (first - last) * 0.75;
        for (volts, expected) in volts.iter().zip([first, middle, last, middle]) {
            assert_abs_diff_eq!(*volts, expected, epsilon = 1e-11);
        }
    }

    #[test]
    fn a_long_chain_is_solved_at_once() {
        // Without loops the factorisation is complete: one step suffices however long the chain.
        let nodes = 10_000;
        let edges: Vec<[u32; 2]> = (1..nodes).map(|node| [node - 1, node]).collect();
        let mut anchors = vec![0.0; nodes as usize];
        anchors[0] = 1.0;
        let along = vec![1e3; edges.len()];
        let chain = Conductances { edges: &edges, along, anchors };
        let right: Vec<f64> = chain.anchors.iter().map(|anchor| anchor * 7.0).collect();
        let mut x = vec![0.0; nodes as usize];
        assert!(chain.solve(&right, 0.0, &mut x));
        for x in x {
            assert_abs_diff_eq!(x, 7.0, epsilon = 1e-9);
        }
    }
}
