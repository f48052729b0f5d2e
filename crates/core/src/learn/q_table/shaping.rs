//! Potential-based shaping: a reward for approaching the goal that leaves the best behaviour as it is.

/// Returns a reward plus `discount` · `next_potential` - `potential` (Ng, Harada & Russell, "Policy invariance under reward
/// transformations", ICML 1999).
///
/// `discount` is that of the whole action ([`QRule::discount`](super::QRule::discount) of its ticks). The best policy stays the same only
/// if the potential depends on the state alone, and if the potential of every terminal state is 0. An episode whose time is up has not
/// ended in this sense: its last state keeps its potential.
pub fn shaped(reward: f32, potential: f32, next_potential: f32, discount: f32) -> f32 {
    reward + discount * next_potential - potential
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    use crate::rng::{Purpose, stream};

    const STATES: usize = 30;
    const ACTIONS: usize = 4;
    /// Number of successors of each pair of state and action.
    const BRANCHES: usize = 3;
    const DISCOUNT_PER_TICK: f32 = 0.97;
    /// Number of sweeps of value iteration: 0.97 to this power is below 1e-9.
    const SWEEPS: u32 = 700;

    /// An outcome of a pair of state and action: probability, next state or `None` for the end, ticks, and reward.
    type Outcome = (f64, Option<usize>, u16, f32);

    /// A function that adds a bonus to a reward, given the potentials, the state before, the state after (`None` for the end) and the
    /// discount.
    type Bonus = fn(f32, &[f32], usize, Option<usize>, f32) -> f32;

    fn uniform(random: &mut impl Rng) -> f32 {
        random.next_u32() as f32 / u32::MAX as f32
    }

    /// Returns the outcomes of every pair, state by state.
    fn random_process(random: &mut impl Rng) -> Vec<Vec<Outcome>> {
        let outcome = |random: &mut _| {
            let next = (uniform(random) * 1.1 * STATES as f32) as usize;
            let ticks = 1 + (uniform(random) * 7.0) as u16;
            let weight = 0.1 + f64::from(uniform(random));
            (weight, (next < STATES).then_some(next), ticks, 2.0 * uniform(random) - 1.0)
        };
        let mut process: Vec<Vec<Outcome>> = (0..STATES * ACTIONS)
            .map(|_| (0..BRANCHES).map(|_| outcome(random)).collect())
            .collect();
        for outcomes in &mut process {
            let sum: f64 = outcomes.iter().map(|outcome| outcome.0).sum();
            outcomes.iter_mut().for_each(|outcome| outcome.0 /= sum);
        }
        process
    }

    /// Computes the best action of every state by value iteration, with a bonus added to each reward.
    fn best_policy(process: &[Vec<Outcome>], potential: &[f32], bonus: Bonus) -> Vec<usize> {
        let mut values = vec![0.0; STATES];
        let mut policy = vec![0; STATES];
        for _ in 0..SWEEPS {
            let worth = |state: usize, outcomes: &[Outcome]| -> f64 {
                let one = |&(probability, next, ticks, reward): &Outcome| {
                    let discount = libm::powf(DISCOUNT_PER_TICK, f32::from(ticks));
                    let reward = f64::from(bonus(reward, potential, state, next, discount));
                    probability * (reward + f64::from(discount) * next.map_or(0.0, |n| values[n]))
                };
                outcomes.iter().map(one).sum()
            };
            let best: Vec<(usize, f64)> = process
                .chunks(ACTIONS)
                .enumerate()
                .map(|(state, pairs)| {
                    let worths = pairs.iter().map(|outcomes| worth(state, outcomes)).enumerate();
                    worths.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
                })
                .collect();
            (policy, values) = best.into_iter().unzip();
        }
        policy
    }

    #[test]
    fn shaping_leaves_the_best_policy_as_it_is_and_other_bonuses_do_not() {
        let none: Bonus = |reward, _, _, _, _| reward;
        let by_potential: Bonus = |reward, potential, state, next, discount| {
            shaped(reward, potential[state], next.map_or(0.0, |next| potential[next]), discount)
        };
        // A bonus for the potential of the next state alone, from which nothing is subtracted, can be collected again and again.
        let unpaid: Bonus = |reward, potential, _, next, discount| {
            shaped(reward, 0.0, next.map_or(0.0, |next| potential[next]), discount)
        };
        let (mut kept, mut changed) = (0, 0);
        for seed in 0..20 {
            let mut random = stream(seed, 0, 0, Purpose::Birth);
            let process = random_process(&mut random);
            let potential: Vec<f32> = (0..STATES).map(|_| 10.0 * uniform(&mut random)).collect();
            let plain = best_policy(&process, &potential, none);
            kept += usize::from(plain == best_policy(&process, &potential, by_potential));
            changed += usize::from(plain != best_policy(&process, &potential, unpaid));
        }
        println!("same best policy: shaped {kept}/20, with an unpaid bonus {}/20", 20 - changed);
        assert_eq!((kept, changed), (20, 20));
    }

    #[test]
    fn a_shaped_reward_is_the_gain_in_potential() {
        assert_eq!(shaped(-0.5, 2.0, 6.0, 0.5), 0.5);
        assert_eq!(shaped(10.0, 2.0, 0.0, 0.5), 8.0);
    }
}
