//! Descriptors: numbers that distinguish kinds of behaviour.

use super::axis::ArchiveAxis;
use super::axis::AxisScale::{self, Linear, Logarithmic};
use crate::schema::choices;
use crate::score::Evaluation;

choices! {
    /// A number that describes how an agent moves.
    pub enum Descriptor {
        BodyHeight = "body_height", "Height over the treads (m)", "Mean height of the snake over the treads.";
        Sideways = "sideways", "Distance from the middle (m)", "Mean distance from the middle of the stairs.";
        EnergyPerMetre = "energy_per_metre", "Energy per metre (J/m)", "Energy used per metre forward.";
        CostOfTransport = "cost_of_transport", "Cost of transport",
            "Energy used per weight and way along the stairs. A walking person has 0.2, a climbing snake more.";
        ClimbingEfficiency = "climbing_efficiency", "Climbing efficiency",
            "Share of the energy used that lifted the snake.";
        ContactDuty = "contact_duty", "Share of blocks in contact", "Mean share of blocks that touch something.";
        Frequency = "frequency", "Gait frequency (Hz)", "How often the motion repeats per second.";
    }
}

impl Descriptor {
    /// Returns how the descriptor's axis is divided, and the values at its two ends. Values beyond the ends belong to the outermost cells.
    pub(super) fn scale(self) -> (AxisScale, [f64; 2]) {
        match self {
            Self::BodyHeight => (Linear, [0.3, 2.3]),
            Self::Sideways => (Linear, [0.0, 2.5]),
            Self::EnergyPerMetre => (Logarithmic, [10.0, 10_000.0]),
            Self::CostOfTransport => (Logarithmic, [0.1, 100.0]),
            Self::ClimbingEfficiency => (Linear, [0.0, 0.3]),
            Self::ContactDuty => (Linear, [0.0, 1.0]),
            Self::Frequency => (Linear, [0.0, 4.0]),
        }
    }

    /// Returns the descriptor of an agent that started at `start_y_m`, in the unit of its title. None if the agent was not observed.
    /// Without progress, the energy per metre and the cost of transport are infinite.
    pub fn value(self, evaluation: &Evaluation, start_y_m: f32) -> Option<f64> {
        let behaviour = evaluation.behaviour?;
        Some(match self {
            Self::BodyHeight => f64::from(behaviour.mean_height_m),
            Self::Sideways => f64::from(behaviour.mean_sideways_m),
            Self::EnergyPerMetre => {
                let progress_m = f64::from(evaluation.centre_y_m) - f64::from(start_y_m);
                let energy_j = f64::from(evaluation.effort?.energy_j);
                if progress_m > 0.0 { energy_j / progress_m } else { f64::INFINITY }
            }
            Self::CostOfTransport => {
                evaluation.effort?;
                behaviour.cost_of_transport.map_or(f64::INFINITY, f64::from)
            }
            Self::ClimbingEfficiency => f64::from(behaviour.climbing_efficiency.unwrap_or(0.0)),
            Self::ContactDuty => f64::from(behaviour.contact_duty),
            Self::Frequency => f64::from(behaviour.frequency_hz),
        })
    }

    /// Returns the position of a value along the descriptor's axis: 0 at the beginning, 1 at the end.
    pub fn share(self, value: f64) -> f64 {
        ArchiveAxis::of(self, 1).share(value)
    }
}
