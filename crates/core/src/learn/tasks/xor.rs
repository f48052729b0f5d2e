//! Exclusive or: the smallest task that a network without hidden nodes cannot solve.

/// Inputs and wanted output of each pattern.
pub const PATTERNS: [([f64; 2], f64); 4] =
    [([0.0, 0.0], 0.0), ([0.0, 1.0], 1.0), ([1.0, 0.0], 1.0), ([1.0, 1.0], 0.0)];

/// The score of a function that should compute exclusive or.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct XorScore {
    /// (4 - e)², where e is the sum of the absolute errors of the four outputs; 16 is the best (Stanley & Miikkulainen 2002).
    pub fitness: f64,
    /// Whether every output is on the right side of 0.5.
    pub is_solved: bool,
}

/// Scores a function from two inputs to an output from 0 to 1.
pub fn score(mut function: impl FnMut([f64; 2]) -> f64) -> XorScore {
    let (mut errors, mut is_solved) = (0.0, true);
    for (inputs, wanted) in PATTERNS {
        let error = (function(inputs) - wanted).abs();
        errors += error;
        is_solved &= error < 0.5;
    }
    XorScore { fitness: (4.0 - errors) * (4.0 - errors), is_solved }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_right_function_has_the_full_score() {
        assert_eq!(score(|[a, b]| (a - b).abs()), XorScore { fitness: 16.0, is_solved: true });
        assert_eq!(score(|_| 0.5), XorScore { fitness: 4.0, is_solved: false });
        assert_eq!(score(|[a, b]| a.max(b)), XorScore { fitness: 9.0, is_solved: false });
    }
}
