//! Two poles on one cart, the benchmark of Wieland (1991): a force on the cart keeps both upright.
//!
//! Equations and numbers are those of Wieland's model as most published comparisons use it, from Gruau, Whitley &
//! Pyeatt (1996) to Gomez, Schmidhuber & Miikkulainen (2008).

/// Number of actions after which the task counts as solved; an action lasts 0.02 s.
pub const SOLVED_ACTIONS: usize = 100_000;
/// Number of starts of [`generalisation`].
pub const GENERALISATION_STARTS: usize = 625;

const GRAVITY_M_S2: f64 = 9.8;
const CART_KG: f64 = 1.0;
/// Half-length in m and mass in kg of the long and the short pole.
const POLES: [(f64, f64); 2] = [(0.5, 0.1), (0.05, 0.01)];
/// Friction of a pole's hinge, in N m s.
const HINGE_FRICTION: f64 = 2e-6;
const FORCE_N: f64 = 10.0;
const STEP_S: f64 = 0.01;
const STEPS_PER_ACTION: u32 = 2;
const TRACK_M: f64 = 2.4;
const LARGEST_ANGLE_RAD: f64 = 36.0 * std::f64::consts::PI / 180.0;
/// The usual scale of each number of the state for a controller.
const SCALES: [f64; 6] = [4.8, 2.0, 0.52, 2.0, 0.52, 2.0];

/// The cart and its poles.
#[derive(Debug, Clone, PartialEq)]
pub struct DoublePole {
    /// Place of the cart in m and its speed in m/s; angle from upright in rad and its rate in rad/s, of the long pole,
    /// then of the short one.
    pub state: [f64; 6],
}

impl DoublePole {
    /// At rest in the middle of the track, the long pole leaning by 0.07 rad.
    pub fn usual() -> Self {
        Self { state: [0.0, 0.0, 0.07, 0.0, 0.0, 0.0] }
    }

    /// What a controller is told: the state, scaled to about -1 to 1.
    pub fn observation(&self) -> [f64; 6] {
        let mut observation = self.state;
        observation.iter_mut().zip(SCALES).for_each(|(x, scale)| *x /= scale);
        observation
    }

    /// Whether the cart is on its track and no pole has fallen.
    pub fn is_balanced(&self) -> bool {
        let [place, _, long, _, short, _] = self.state;
        place.abs() <= TRACK_M
            && long.abs() <= LARGEST_ANGLE_RAD
            && short.abs() <= LARGEST_ANGLE_RAD
    }

    /// Pushes the cart for 0.02 s with `action` times 10 N; the action is clamped to -1 to 1.
    pub fn push(&mut self, action: f64) {
        let force = FORCE_N * action.clamp(-1.0, 1.0);
        for _ in 0..STEPS_PER_ACTION {
            self.state = runge_kutta(&self.state, force);
        }
    }
}

/// A controller's view without velocities: the place of the cart, and the angles of the long and the short pole.
pub fn without_velocities(observation: &[f64; 6]) -> [f64; 3] {
    [observation[0], observation[2], observation[4]]
}

/// Number of actions, at most `max_actions`, after which a controller still balanced the poles from the usual start.
/// The controller gets the scaled state and answers with an action in -1 to 1.
pub fn balance(controller: impl FnMut(&[f64; 6]) -> f64, max_actions: usize) -> usize {
    balance_from(DoublePole::usual(), controller, max_actions)
}

/// The same from any start.
pub fn balance_from(
    mut pole: DoublePole,
    mut controller: impl FnMut(&[f64; 6]) -> f64,
    max_actions: usize,
) -> usize {
    for actions in 0..max_actions {
        pole.push(controller(&pole.observation()));
        if !pole.is_balanced() {
            return actions;
        }
    }
    max_actions
}

/// Number of starts, of 625, from which a controller balances for 1000 actions. `fresh` makes the controller for each
/// start, so none remembers the last. (Gruau, Whitley & Pyeatt 1996.)
pub fn generalisation<C: FnMut(&[f64; 6]) -> f64>(mut fresh: impl FnMut() -> C) -> usize {
    let lasts = |start: &DoublePole| balance_from(start.clone(), fresh(), 1000) == 1000;
    generalisation_starts().into_iter().filter(lasts).count()
}

/// Every combination of five places and speeds of the cart and five angles and rates of the long pole.
pub fn generalisation_starts() -> Vec<DoublePole> {
    let values = |half: f64| [0.05, 0.25, 0.5, 0.75, 0.95].map(|share| (2.0 * share - 1.0) * half);
    let mut starts = Vec::with_capacity(GENERALISATION_STARTS);
    for place in values(2.16) {
        for speed in values(1.35) {
            for angle in values(0.062_831_52) {
                for rate in values(0.150_097_52) {
                    starts.push(DoublePole { state: [place, speed, angle, rate, 0.0, 0.0] });
                }
            }
        }
    }
    starts
}

/// A net without hidden nodes: tanh of the weighted sum; 6 weights for all six numbers.
pub fn linear(weights: &[f64], observation: &[f64]) -> f64 {
    libm::tanh(weighted(weights, observation))
}

/// A net of three hidden nodes: for 6 inputs, 18 weights into them and 3 out of them.
pub fn hidden(weights: &[f64], observation: &[f64]) -> f64 {
    let (into, out) = weights.split_at(3 * observation.len());
    let nodes: Vec<f64> =
        into.chunks_exact(observation.len()).map(|weights| linear(weights, observation)).collect();
    linear(out, &nodes)
}

/// A net of three hidden nodes that remember: each sees the inputs and the last values of all three. For 3 inputs,
/// 6 weights into each node, then 3 out of them: 21. `memory` starts at 0.
pub fn recurrent(weights: &[f64], memory: &mut [f64; 3], observation: &[f64; 3]) -> f64 {
    let (into, out) = weights.split_at(18);
    let [a, b, c] = *observation;
    let [x, y, z] = *memory;
    for (node, weights) in memory.iter_mut().zip(into.chunks_exact(6)) {
        *node = linear(weights, &[a, b, c, x, y, z]);
    }
    linear(out, memory)
}

fn weighted(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).fold(0.0, |sum, (weight, value)| sum + weight * value)
}

/// The derivative of the state under a force on the cart, in N.
fn derivative(state: &[f64; 6], force: f64) -> [f64; 6] {
    let (mut forces, mut mass) = (force, CART_KG);
    let mut torques = [(0.0, 0.0); 2];
    for (i, (half_length, pole_mass)) in POLES.into_iter().enumerate() {
        let (angle, rate) = (state[2 + 2 * i], state[3 + 2 * i]);
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        let moment = half_length * pole_mass;
        let pull = HINGE_FRICTION * rate / moment - GRAVITY_M_S2 * sine;
        forces += moment * rate * rate * sine + 0.75 * pole_mass * cosine * pull;
        mass += pole_mass * (1.0 - 0.75 * cosine * cosine);
        torques[i] = (cosine, pull);
    }
    let acceleration = forces / mass;
    let angular = |i: usize| -0.75 * (acceleration * torques[i].0 + torques[i].1) / POLES[i].0;
    [state[1], acceleration, state[3], angular(0), state[5], angular(1)]
}

/// The state 0.01 s later, by the classical method of fourth order.
fn runge_kutta(state: &[f64; 6], force: f64) -> [f64; 6] {
    let moved = |slope: &[f64; 6], time: f64| {
        let mut moved = *state;
        moved.iter_mut().zip(slope).for_each(|(x, slope)| *x += time * slope);
        moved
    };
    let a = derivative(state, force);
    let b = derivative(&moved(&a, STEP_S / 2.0), force);
    let c = derivative(&moved(&b, STEP_S / 2.0), force);
    let d = derivative(&moved(&c, STEP_S), force);
    let mut slope = [0.0; 6];
    for (i, slope) in slope.iter_mut().enumerate() {
        *slope = (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0;
    }
    moved(&slope, STEP_S)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
    use rand::RngExt;

    #[test]
    fn a_push_accelerates_cart_and_a_quarter_of_upright_poles() {
        let [_, acceleration, _, long, _, short] = derivative(&[0.0; 6], 10.0);
        let expected = 10.0 / (1.0 + 0.1 / 4.0 + 0.01 / 4.0);
        assert!((acceleration - expected).abs() < 1e-12);
        assert!((long + 0.75 * expected / 0.5).abs() < 1e-12);
        assert!((short + 0.75 * expected / 0.05).abs() < 1e-12);
    }

    #[test]
    fn falling_poles_keep_their_energy() {
        let energy = |pole: &DoublePole| {
            let [_, speed, ..] = pole.state;
            let of_pole = |i: usize, (length, mass): (f64, f64)| {
                let (angle, rate) = (pole.state[2 + 2 * i], pole.state[3 + 2 * i]);
                let swing = length * rate;
                let square = speed * speed
                    + 2.0 * speed * swing * libm::cos(angle)
                    + 4.0 / 3.0 * swing * swing;
                mass * (square / 2.0 + GRAVITY_M_S2 * length * libm::cos(angle))
            };
            CART_KG * speed * speed / 2.0 + of_pole(0, POLES[0]) + of_pole(1, POLES[1])
        };
        let mut pole = DoublePole { state: [0.0, 0.3, 0.2, 0.1, 0.05, 0.0] };
        let before = energy(&pole);
        for _ in 0..15 {
            pole.push(0.0);
        }
        assert!(pole.state[4].abs() > 0.5, "the short pole falls: {:?}", pole.state);
        assert!((energy(&pole) / before - 1.0).abs() < 1e-4, "{before} {}", energy(&pole));
    }

    #[test]
    fn without_control_the_poles_fall_soon() {
        assert!((10..100).contains(&balance(|_| 0.0, 1000)), "{}", balance(|_| 0.0, 1000));
        assert_eq!(balance_from(DoublePole { state: [0.0; 6] }, |_| 0.0, 1000), 1000);
    }

    #[test]
    fn the_starts_of_the_generalisation_test_are_625_different_ones() {
        let starts = generalisation_starts();
        assert_eq!(starts.len(), GENERALISATION_STARTS);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let [place, speed, angle, rate, ..] = starts[0].state;
        assert!(near(place, 0.05 * 4.32 - 2.16) && near(speed, 0.05 * 2.7 - 1.35));
        assert!(near(angle, 0.05 * 0.125_663_04 - 0.062_831_52) && near(rate, -0.135_087_768));
        assert!(starts.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(starts[312].state.iter().all(|x| near(*x, 0.0)), "the middle one");
    }

    #[test]
    fn climbing_in_random_steps_finds_six_weights_that_balance() {
        let mut rng = stream(1, 0, 0, Purpose::Birth);
        let length = |weights: &[f64; 6]| balance(|seen| linear(weights, seen), 1000);
        let mut best = [0.0; 6];
        for _ in 0..20_000 {
            let weights =
                best.map(|x| x + rng.random_range(-1.0..1.0) * rng.random_range(0.0..5.0));
            if length(&weights) >= length(&best) {
                best = weights;
            }
            if length(&best) == 1000 {
                break;
            }
        }
        assert_eq!(length(&best), 1000);
        let general = generalisation(|| |seen: &[f64; 6]| linear(&best, seen));
        assert!((1..=GENERALISATION_STARTS).contains(&general), "{general}");
    }

    #[test]
    fn the_fixed_nets_have_the_numbers_of_weights_that_they_say() {
        let mut weights = [0.0; 21];
        (weights[0], weights[18]) = (1.0, 1.0);
        let expected = libm::tanh(libm::tanh(0.5));
        assert_eq!(hidden(&weights, &[0.5, 0.1, 0.2, 0.3, 0.4, 0.5]), expected);
        let mut memory = [0.0; 3];
        // The second node sees the last value of the first.
        (weights[6 + 3], weights[18], weights[19]) = (1.0, 0.0, 1.0);
        assert_eq!(recurrent(&weights, &mut memory, &[0.5, 0.0, 0.0]), 0.0);
        assert_eq!(recurrent(&weights, &mut memory, &[0.0; 3]), libm::tanh(expected));
        assert_eq!(without_velocities(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), [1.0, 3.0, 5.0]);
    }
}
