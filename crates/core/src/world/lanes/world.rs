//! The engine *lanes* with one snake, and lock steps of several such worlds.

use std::any::Any;

use super::{Chain, LaneSolver, LanesCommon, VectorLevel};
use crate::world::WorldPlan;
use crate::world::engine::{PartContact, PartState, WorldEngine};

/// A snake in the engine *lanes*, with a solver of its own for steps that it takes alone.
#[derive(Clone)]
pub(crate) struct LanesWorld {
    chain: Chain,
    solver: LaneSolver<1>,
}

impl LanesWorld {
    /// Builds the world of a plan.
    pub fn new(plan: &WorldPlan) -> Self {
        Self { chain: Chain::new(plan), solver: LaneSolver::at(VectorLevel::in_use()) }
    }

    /// Returns the snake of a world of this engine; `None` for other engines.
    pub fn chain_of(engine: &mut dyn WorldEngine) -> Option<&mut Chain> {
        let engine: &mut dyn Any = engine;
        engine.downcast_mut::<Self>().map(|world| &mut world.chain)
    }

    /// Returns the settings and sizes that worlds must have in common to be stepped side by side; `None` for other engines.
    pub fn common_of(engine: &dyn WorldEngine) -> Option<LanesCommon> {
        let engine: &dyn Any = engine;
        engine.downcast_ref::<Self>().map(|world| world.chain.common())
    }
}

impl WorldEngine for LanesWorld {
    fn parts(&self) -> &[PartState] {
        &self.chain.state
    }

    fn parts_mut(&mut self) -> &mut [PartState] {
        &mut self.chain.state
    }

    fn step(&mut self) {
        self.solver.advance(&mut [Some(&mut self.chain)]);
    }

    fn bounce(&mut self, _earlier: &[PartState]) {
        self.chain.bounce();
    }

    fn contacts(&self) -> Vec<PartContact> {
        self.chain.contacts.iter().map(|contact| contact.seen()).collect()
    }

    fn continue_from(&mut self, earlier: &dyn WorldEngine) {
        let any: &dyn Any = earlier;
        if let Some(earlier) = any.downcast_ref::<Self>() {
            self.chain.continue_from(&earlier.chain);
        }
    }

    fn cloned(&self) -> Box<dyn WorldEngine> {
        Box::new(self.clone())
    }
}
