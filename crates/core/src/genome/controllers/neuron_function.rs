//! The functions of a creature's neurons: the 23 functions of Sims (1994).

use serde::{Deserialize, Serialize};

use crate::schema::listed_values;

/// Time constant of a neuron that smooths, in s.
const SMOOTH_S: f64 = 0.25;
/// Largest absolute value of a neuron's output, and of its state.
const LARGEST_OUTPUT: f64 = 10.0;
/// Largest absolute value of the exponent in `Expt`, so that the output does not overflow.
const LARGEST_EXPONENT: f64 = 5.0;

listed_values! {
    /// The function of a neuron. Its inputs are a, b and c; a function that needs fewer inputs has only a, or a and b.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum NeuronFunction {
        /// Output: a + b + c.
        Sum;
        /// Output: a b.
        Product;
        /// Output: a / b; 0 for b = 0.
        Divide;
        /// Output: 1 if a + b + c > 0, otherwise 0.
        SumThreshold;
        /// Output: 1 if a > b, otherwise -1.
        GreaterThan;
        /// Output: the sign of a, as -1, 0 or 1.
        SignOf;
        /// Output: the least of a, b and c.
        Min;
        /// Output: the greatest of a, b and c.
        Max;
        /// Output: |a|.
        Abs;
        /// Output: b if a > 0, otherwise c.
        If;
        /// Output: from b at a = 0 linearly to c at a = 1.
        Interpolate;
        /// Output: sin a.
        Sin;
        /// Output: cos a.
        Cos;
        /// Output: the arc tangent of a.
        Atan;
        /// Output: ln(|a| + 10⁻⁶).
        Log;
        /// Output: exp a, with an exponent from -5 to 5.
        Expt;
        /// Output: tanh(a + b + c), the neuron of McCulloch and Pitts with a smooth step.
        Sigmoid;
        /// Output: the integral of a over time.
        Integrate;
        /// Output: the rate of change of a.
        Differentiate;
        /// Output: a, smoothed over time.
        Smooth;
        /// Output: a as long as b > 0, afterwards the last value of a with b > 0.
        Memory;
        /// Output: a sine wave, whose phase a shifts.
        OscillateWave;
        /// Output: a saw tooth from -1 to 1, whose phase a shifts.
        OscillateSaw;
    }
}

/// The memory of a neuron between two updates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NeuronState(f64);

/// The time at which a neuron is updated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeuronMoment {
    /// Number of periods of the neuron's oscillation since the start.
    pub periods: f64,
    /// Time since the last update, in s.
    pub step_s: f64,
}

impl NeuronFunction {
    /// The functions of neurons of Miconi and Channon (2005): a smooth step, and an oscillator.
    pub const STANDARD: [Self; 2] = [Self::Sigmoid, Self::OscillateWave];

    /// Returns the number of inputs of the function.
    pub fn inputs(self) -> usize {
        match self {
            Self::Sum
            | Self::SumThreshold
            | Self::Min
            | Self::Max
            | Self::If
            | Self::Interpolate
            | Self::Sigmoid => 3,
            Self::Product | Self::Divide | Self::GreaterThan | Self::Memory => 2,
            Self::SignOf
            | Self::Abs
            | Self::Sin
            | Self::Cos
            | Self::Atan
            | Self::Log
            | Self::Expt
            | Self::Integrate
            | Self::Differentiate
            | Self::Smooth
            | Self::OscillateWave
            | Self::OscillateSaw => 1,
        }
    }

    /// Returns whether the function is an oscillator, which has a frequency.
    pub fn oscillates(self) -> bool {
        matches!(self, Self::OscillateWave | Self::OscillateSaw)
    }

    /// Returns the output for these inputs, within ±10. NaN becomes 0.
    pub fn respond(
        self,
        [a, b, c]: [f64; 3],
        moment: NeuronMoment,
        NeuronState(state): &mut NeuronState,
    ) -> f64 {
        let bounded = |value: f64| {
            if value.is_nan() { 0.0 } else { value.clamp(-LARGEST_OUTPUT, LARGEST_OUTPUT) }
        };
        let NeuronMoment { periods, step_s } = moment;
        let fraction = |value: f64| value - libm::floor(value);
        let choice = |is_met: bool, one: f64, other: f64| if is_met { one } else { other };
        let response = match self {
            Self::Sum => a + b + c,
            Self::Product => a * b,
            Self::Divide => choice(b == 0.0, 0.0, a / b),
            Self::SumThreshold => f64::from(u8::from(a + b + c > 0.0)),
            Self::GreaterThan => choice(a > b, 1.0, -1.0),
            Self::SignOf => choice(a == 0.0, 0.0, a.signum()),
            Self::Min => a.min(b).min(c),
            Self::Max => a.max(b).max(c),
            Self::Abs => a.abs(),
            Self::If => choice(a > 0.0, b, c),
            Self::Interpolate => b + (c - b) * a.clamp(0.0, 1.0),
            Self::Sin => libm::sin(a),
            Self::Cos => libm::cos(a),
            Self::Atan => libm::atan(a),
            Self::Log => libm::log(a.abs() + 1.0e-6),
            Self::Expt => libm::exp(a.clamp(-LARGEST_EXPONENT, LARGEST_EXPONENT)),
            Self::Sigmoid => libm::tanh(a + b + c),
            Self::Integrate => {
                *state = bounded(*state + a * step_s);
                *state
            }
            Self::Differentiate => {
                let rate = (a - *state) / step_s;
                *state = bounded(a);
                rate
            }
            Self::Smooth => {
                *state = bounded(*state + (a - *state) * (1.0 - libm::exp(-step_s / SMOOTH_S)));
                *state
            }
            Self::Memory => {
                if b > 0.0 {
                    *state = bounded(a);
                }
                *state
            }
            Self::OscillateWave => libm::sin(std::f64::consts::TAU * fraction(periods) + a),
            Self::OscillateSaw => {
                2.0 * fraction(fraction(periods) + a / std::f64::consts::TAU) - 1.0
            }
        };
        bounded(response)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOMENT: NeuronMoment = NeuronMoment { periods: 7.25, step_s: 0.5 };

    #[test]
    fn each_function_computes_what_its_name_says() {
        use NeuronFunction as F;
        for (function, inputs, expected) in [
            (F::Sum, [1.0, 2.0, 3.0], 6.0),
            (F::Product, [2.0, 3.0, 0.0], 6.0),
            (F::Divide, [6.0, 3.0, 0.0], 2.0),
            (F::Divide, [6.0, 0.0, 0.0], 0.0),
            (F::SumThreshold, [1.0, -0.5, 0.0], 1.0),
            (F::SumThreshold, [0.0; 3], 0.0),
            (F::GreaterThan, [1.0, 2.0, 0.0], -1.0),
            (F::SignOf, [-3.0, 0.0, 0.0], -1.0),
            (F::Min, [3.0, 1.0, 2.0], 1.0),
            (F::Max, [3.0, 1.0, 2.0], 3.0),
            (F::Abs, [-3.0, 0.0, 0.0], 3.0),
            (F::If, [1.0, 2.0, 3.0], 2.0),
            (F::If, [-1.0, 2.0, 3.0], 3.0),
            (F::Interpolate, [0.5, 2.0, 3.0], 2.5),
            (F::Sin, [0.5, 0.0, 0.0], libm::sin(0.5)),
            (F::Cos, [0.5, 0.0, 0.0], libm::cos(0.5)),
            (F::Atan, [0.5, 0.0, 0.0], libm::atan(0.5)),
            (F::Log, [1.0 - 1.0e-6, 0.0, 0.0], 0.0),
            (F::Expt, [100.0, 0.0, 0.0], 10.0),
            (F::Expt, [1.0, 0.0, 0.0], libm::exp(1.0)),
            (F::Sigmoid, [1.0, 2.0, -2.5], libm::tanh(0.5)),
            (F::OscillateWave, [0.0; 3], 1.0),
            (F::OscillateSaw, [0.0; 3], -0.5),
        ] {
            let found = function.respond(inputs, MOMENT, &mut NeuronState::default());
            assert!((found - expected).abs() < 1e-12, "{function:?} of {inputs:?} is {found}");
        }
    }

    #[test]
    fn functions_with_a_memory_follow_time() {
        use NeuronFunction as F;
        let course = |function: F, values: &[[f64; 2]]| -> Vec<f64> {
            let mut state = NeuronState::default();
            let respond = |[a, b]: &[f64; 2]| function.respond([*a, *b, 0.0], MOMENT, &mut state);
            values.iter().map(respond).collect()
        };
        assert_eq!(course(F::Integrate, &[[1.0, 0.0], [1.0, 0.0], [-4.0, 0.0]]), [0.5, 1.0, -1.0]);
        assert_eq!(
            course(F::Differentiate, &[[1.0, 0.0], [1.0, 0.0], [2.0, 0.0]]),
            [2.0, 0.0, 2.0]
        );
        assert_eq!(course(F::Memory, &[[3.0, 1.0], [5.0, -1.0], [5.0, 1.0]]), [3.0, 3.0, 5.0]);
        let smooth = course(F::Smooth, &[[1.0, 0.0]; 20]);
        assert!(smooth[..5].windows(2).all(|pair| pair[0] < pair[1]) && smooth[19] > 0.999);
    }

    #[test]
    fn no_input_makes_an_output_that_is_not_bounded() {
        let values = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0e300, -1.0e300, 0.0, -0.0];
        for function in NeuronFunction::ALL {
            let mut state = NeuronState::default();
            for a in values {
                for b in values {
                    let output = function.respond([a, b, 1.0], MOMENT, &mut state);
                    assert!(output.abs() <= LARGEST_OUTPUT, "{function:?} of {a}, {b}: {output}");
                }
            }
        }
    }
}
