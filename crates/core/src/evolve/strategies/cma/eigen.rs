//! Principal axes of a covariance: C = B D² Bᵀ, with B orthogonal and D diagonal.
//!
//! Jacobi's method needs only the four operations and roots, rotates the pairs of coordinates in a fixed order, and finds even the smallest
//! variances to full relative precision (Demmel & Veselić 1992, "Jacobi's method is more accurate than QR").

/// Maximum number of sweeps over all pairs of coordinates. Jacobi's method needs 6 to 10.
const MOST_SWEEPS: u32 = 60;

/// Principal axes of a covariance and the variances along them, in no particular order.
#[derive(Debug, Clone, PartialEq)]
pub struct PrincipalAxes {
    /// Diagonal of D². An entry is not positive only if the matrix is not a covariance.
    variances: Vec<f64>,
    /// Columns of B, one after the other. None: the coordinate axes.
    directions: Option<Vec<f64>>,
}

impl PrincipalAxes {
    /// Returns the axes of a diagonal covariance with the diagonal `variances`.
    pub fn of_diagonal(variances: &[f64]) -> Self {
        Self { variances: variances.to_vec(), directions: None }
    }

    /// Returns the axes of a symmetric matrix, given the lower triangle with the diagonal, row by row: dimension · (dimension + 1) / 2
    /// entries.
    pub fn of_symmetric(triangle: &[f64], dimension: usize) -> Self {
        let mut matrix = square(triangle, dimension);
        let mut directions = identity(dimension);
        for _ in 0..MOST_SWEEPS {
            if !sweep(&mut matrix, &mut directions, dimension) {
                break;
            }
        }
        let variances = (0..dimension).map(|i| matrix[i * dimension + i]).collect();
        Self { variances, directions: Some(directions) }
    }

    /// Returns B D z, which converts a standard normal vector to a vector with the covariance.
    pub fn stretched(&self, vector: &[f64]) -> Vec<f64> {
        let lengths = self.variances.iter().map(|variance| variance.max(0.0).sqrt());
        let scaled: Vec<f64> = vector.iter().zip(lengths).map(|(x, length)| x * length).collect();
        self.turned(&scaled)
    }

    /// Returns D⁻¹ Bᵀ y, the standard normal vector that `stretched` converts to `vector`. Its length is that of C^-½ y.
    pub fn whitened(&self, vector: &[f64]) -> Vec<f64> {
        let components = match &self.directions {
            None => vector.to_vec(),
            Some(directions) => {
                directions.chunks_exact(vector.len()).map(|axis| dot(axis, vector)).collect()
            }
        };
        let lengths = self.variances.iter().map(|variance| variance.max(0.0).sqrt());
        components.iter().zip(lengths).map(|(x, length)| x / length).collect()
    }

    /// Returns B z, which converts components along the axes to coordinates.
    pub fn turned(&self, components: &[f64]) -> Vec<f64> {
        let Some(directions) = &self.directions else {
            return components.to_vec();
        };
        let mut vector = vec![0.0; components.len()];
        for (component, axis) in components.iter().zip(directions.chunks_exact(components.len())) {
            vector.iter_mut().zip(axis).for_each(|(sum, x)| *sum += component * x);
        }
        vector
    }

    /// Returns the vector along an axis with the length of the standard deviation; `index` is taken modulo the dimension.
    pub fn axis(&self, index: usize) -> Vec<f64> {
        let dimension = self.variances.len();
        let unit = (0..dimension).map(|i| if i == index % dimension { 1.0 } else { 0.0 });
        self.stretched(&unit.collect::<Vec<_>>())
    }

    /// Returns the largest standard deviation along an axis.
    pub fn longest(&self) -> f64 {
        self.variances.iter().fold(0.0, |longest: f64, &variance| longest.max(variance)).sqrt()
    }

    /// Returns the largest variance divided by the smallest; infinite if a variance is not positive.
    pub fn condition(&self) -> f64 {
        let smallest = self.variances.iter().fold(f64::INFINITY, |least, &variance| {
            if variance > 0.0 { least.min(variance) } else { 0.0 }
        });
        let longest = self.longest();
        if smallest > 0.0 { longest * longest / smallest } else { f64::INFINITY }
    }
}

/// Returns the scalar product, summed in the order of the elements.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (x, y)| sum + x * y)
}

/// Returns the whole symmetric matrix, row by row, from its lower triangle.
fn square(triangle: &[f64], dimension: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; dimension * dimension];
    let places = (0..dimension).flat_map(|row| (0..=row).map(move |column| (row, column)));
    for ((row, column), &entry) in places.zip(triangle) {
        matrix[row * dimension + column] = entry;
        matrix[column * dimension + row] = entry;
    }
    matrix
}

fn identity(dimension: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; dimension * dimension];
    matrix.iter_mut().step_by(dimension + 1).for_each(|entry| *entry = 1.0);
    matrix
}

/// Rotates every pair of coordinates once, row by row. Returns false if no pair needed a rotation.
fn sweep(matrix: &mut [f64], directions: &mut [f64], dimension: usize) -> bool {
    let mut turned = false;
    for p in 0..dimension {
        for q in p + 1..dimension {
            if let Some(turn) = Rotation::that_clears(matrix, dimension, p, q) {
                turn.similarity(matrix, dimension, p, q);
                turn.rows(directions, dimension, p, q);
                turned = true;
            }
        }
    }
    turned
}

/// A rotation in the plane of two coordinates, by its angle's functions.
struct Rotation {
    tangent: f64,
    cosine: f64,
    sine: f64,
}

impl Rotation {
    /// Returns the smaller of the two rotations that clear the entry (p, q). None if the entry is already negligible relative to its two
    /// diagonal entries. (Golub & Van Loan, "Matrix Computations", section 8.5.2; the limit is that of Demmel & Veselić.)
    fn that_clears(matrix: &[f64], dimension: usize, p: usize, q: usize) -> Option<Self> {
        let entry = matrix[p * dimension + q];
        let (first, second) = (matrix[p * dimension + p], matrix[q * dimension + q]);
        if entry.abs() <= f64::EPSILON * first.abs().sqrt() * second.abs().sqrt() {
            return None;
        }
        let cotangent = (second - first) / (2.0 * entry);
        let size = 1.0 / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
        let tangent = if cotangent < 0.0 { -size } else { size };
        let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
        Some(Self { tangent, cosine, sine: tangent * cosine })
    }

    fn applied(&self, x: f64, y: f64) -> (f64, f64) {
        (self.cosine * x - self.sine * y, self.sine * x + self.cosine * y)
    }

    /// Rotates rows and columns p and q of the symmetric matrix.
    fn similarity(&self, matrix: &mut [f64], dimension: usize, p: usize, q: usize) {
        let shift = self.tangent * matrix[p * dimension + q];
        matrix[p * dimension + p] -= shift;
        matrix[q * dimension + q] += shift;
        matrix[p * dimension + q] = 0.0;
        matrix[q * dimension + p] = 0.0;
        for other in (0..dimension).filter(|&other| other != p && other != q) {
            let (row_p, row_q) = (p * dimension + other, q * dimension + other);
            let (x, y) = self.applied(matrix[row_p], matrix[row_q]);
            (matrix[row_p], matrix[row_q]) = (x, y);
            (matrix[other * dimension + p], matrix[other * dimension + q]) = (x, y);
        }
    }

    /// Rotates the rows p < q. B is stored column by column, so these rows are its columns.
    fn rows(&self, matrix: &mut [f64], dimension: usize, p: usize, q: usize) {
        let (upper, lower) = matrix.split_at_mut(q * dimension);
        let row_p = &mut upper[p * dimension..(p + 1) * dimension];
        for (x, y) in row_p.iter_mut().zip(&mut lower[..dimension]) {
            (*x, *y) = self.applied(*x, *y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn random_triangle(dimension: usize, seed: u64) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let length = dimension * (dimension + 1) / 2;
        (0..length).map(|_| f64::from(random.next_u32()) / f64::from(u32::MAX) - 0.5).collect()
    }

    #[test]
    fn axes_are_orthonormal_and_rebuild_the_matrix() {
        for dimension in 1..=30 {
            let triangle = random_triangle(dimension, dimension as u64);
            let matrix = square(&triangle, dimension);
            let axes = PrincipalAxes::of_symmetric(&triangle, dimension);
            let directions = axes.directions.clone().unwrap();
            let axis = |i: usize| &directions[i * dimension..(i + 1) * dimension];
            for (i, j) in (0..dimension).flat_map(|i| (0..dimension).map(move |j| (i, j))) {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((dot(axis(i), axis(j)) - expected).abs() < 1e-13, "axes {i} and {j}");
                let rebuilt: f64 =
                    (0..dimension).map(|k| axis(k)[i] * axes.variances[k] * axis(k)[j]).sum();
                assert!((rebuilt - matrix[i * dimension + j]).abs() < 1e-13, "entry {i}, {j}");
            }
        }
    }

    #[test]
    fn a_tiny_variance_beside_a_large_one_is_precise() {
        // To within h⁶, the exact variances of [[1, h], [h, 2 h²]] are 1 + h² and h² - h⁴.
        let h = 1e-9;
        let axes = PrincipalAxes::of_symmetric(&[1.0, h, 2.0 * h * h], 2);
        let small = axes.variances[1];
        assert!((small / (h * h) - 1.0).abs() < 1e-14, "{small}");
        assert!((axes.condition() * h * h - 1.0).abs() < 1e-14);
    }

    #[test]
    fn whitening_undoes_stretching() {
        let diagonal = PrincipalAxes::of_diagonal(&[4.0, 9.0, 0.25]);
        assert_eq!(diagonal.stretched(&[1.0, 1.0, 1.0]), [2.0, 3.0, 0.5]);
        let full = PrincipalAxes::of_symmetric(&[4.0, 1.0, 3.0, 0.5, -0.5, 2.0], 3);
        for axes in [diagonal, full] {
            let vector = [0.3, -0.7, 1.1];
            let back = axes.whitened(&axes.stretched(&vector));
            assert!(back.iter().zip(&vector).all(|(x, y)| (x - y).abs() < 1e-15), "{back:?}");
            assert!(dot(&axes.axis(1), &axes.axis(2)).abs() < 1e-15);
        }
    }

    #[test]
    fn a_matrix_that_is_no_covariance_has_an_infinite_condition() {
        for triangle in [[1.0, 2.0, 1.0], [1.0, f64::MAX, 1.0], [0.0, 0.0, 0.0]] {
            assert_eq!(PrincipalAxes::of_symmetric(&triangle, 2).condition(), f64::INFINITY);
        }
        assert!(PrincipalAxes::of_symmetric(&[f64::NAN; 3], 2).condition().is_infinite());
    }
}
