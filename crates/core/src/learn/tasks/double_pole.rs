//! Two poles on one cart, the benchmark of Wieland (1991): a force on the cart has to keep both poles upright.
//!
//! Equations and numbers are those of Wieland's model as most published comparisons use it, from Gruau, Whitley &
//! Pyeatt (1996) to Gomez, Schmidhuber & Miikkulainen (2008).

/// Number of actions after which the task counts as solved; an action lasts 0.02 s.
pub const SOLVED_ACTIONS: usize = 100_000;

const GRAVITY_M_S2: f64 = 9.8;
const CART_KG: f64 = 1.0;
/// Half-length in m and mass in kg of the long and of the short pole.
const POLES: [(f64, f64); 2] = [(0.5, 0.1), (0.05, 0.01)];
/// Friction of a pole's hinge, in N m s.
const HINGE_FRICTION: f64 = 2e-6;
const FORCE_N: f64 = 10.0;
const STEP_S: f64 = 0.01;
const STEPS_PER_ACTION: u32 = 2;
const TRACK_M: f64 = 2.4;
const LARGEST_ANGLE_RAD: f64 = 36.0 * std::f64::consts::PI / 180.0;
/// Usual scale of each number of the state for a controller.
const SCALES: [f64; 6] = [4.8, 2.0, 0.52, 2.0, 0.52, 2.0];

/// The state of the cart and its two poles.
#[derive(Debug, Clone, PartialEq)]
pub struct DoublePole {
    /// Position of the cart in m and its speed in m/s, then for the long and for the short pole the angle from upright in rad and its rate
    /// in rad/s.
    pub state: [f64; 6],
}

impl DoublePole {
    /// Returns the usual start: at rest in the middle of the track, with the long pole leaning by 0.07 rad.
    pub fn usual() -> Self {
        Self { state: [0.0, 0.0, 0.07, 0.0, 0.0, 0.0] }
    }

    /// Returns the observation of a controller: the state, scaled to about -1 to 1.
    pub fn observation(&self) -> [f64; 6] {
        let mut observation = self.state;
        observation.iter_mut().zip(SCALES).for_each(|(x, scale)| *x /= scale);
        observation
    }

    /// Returns whether the cart is on its track and no pole has fallen.
    pub fn is_balanced(&self) -> bool {
        let [place, _, long, _, short, _] = self.state;
        place.abs() <= TRACK_M
            && long.abs() <= LARGEST_ANGLE_RAD
            && short.abs() <= LARGEST_ANGLE_RAD
    }

    /// Pushes the cart for 0.02 s with `action` times 10 N. The action is clamped to -1 to 1.
    pub fn push(&mut self, action: f64) {
        let force = FORCE_N * action.clamp(-1.0, 1.0);
        for _ in 0..STEPS_PER_ACTION {
            self.state = runge_kutta(&self.state, force);
        }
    }
}

/// Counts the actions, up to `max_actions`, during which a controller balances the poles from a start. The controller gets the scaled
/// state and returns an action from -1 to 1.
pub fn balance(
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

/// Returns the derivative of the state under a force on the cart, in N.
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

/// Computes the state 0.01 s later, by the classical Runge-Kutta method of fourth order.
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
        let usual = balance(DoublePole::usual(), |_| 0.0, 1000);
        assert!((10..100).contains(&usual), "{usual}");
        assert_eq!(balance(DoublePole { state: [0.0; 6] }, |_| 0.0, 1000), 1000);
    }
}
