//! The engine that computes the bits of a run: its version, and the classes of processors on which it computes equal bits.

use std::fmt;

use crate::check::Invalid;
use crate::schema::choices;

/// Version of everything that determines the bits of a run: physics, controllers, random streams, strategies. It is raised by hand whenever
/// a change alters the bits on purpose. Saves record it.
pub const ENGINE_VERSION: u32 = 3;

choices! {
    /// Classes of processors within which an engine computes the same bits. The classes differ because the vector mathematics below the
    /// physics engine adds the four products of a quaternion in a different order on each.
    #[derive(Default)]
    pub enum Processors {
        /// WebAssembly with SIMD belongs to this class, because it adds in the same order as x86-64.
        #[default]
        X86_64 = "x86-64", "x86-64", "Intel and AMD, and WebAssembly with SIMD.";
        Arm64 = "arm64", "arm64", "64-bit ARM, such as Apple's.";
        Other = "other", "other", "Others, and builds without SIMD.";
    }
}

/// Version and processors of an engine. Two runs with equal settings, seed and engine have equal bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Engine {
    /// Version of the engine: an `ENGINE_VERSION`.
    pub version: u32,
    /// Class of the processors on which the engine runs.
    pub processors: Processors,
}

impl Engine {
    /// Engine of this build of the program.
    pub const THIS: Self = Self { version: ENGINE_VERSION, processors: Processors::THIS };

    /// Checks that this build of the program can continue results of the engine.
    ///
    /// # Errors
    /// Fails if the engine differs from `Engine::THIS`.
    pub fn check_this(self) -> Result<(), Invalid> {
        if self == Self::THIS {
            return Ok(());
        }
        Err(Invalid::new("engine", self.to_string(), Self::THIS.to_string()))
    }
}

impl Processors {
    /// Class of the processors for which the program is built.
    pub const THIS: Self = if cfg!(any(
        all(target_arch = "x86_64", target_feature = "sse2"),
        all(target_arch = "wasm32", target_feature = "simd128")
    )) {
        Self::X86_64
    } else if cfg!(all(target_arch = "aarch64", target_feature = "neon")) {
        Self::Arm64
    } else {
        Self::Other
    };
}

/// Writes the version, and the processors if they are not x86-64: "3", "3 (arm64)".
impl fmt::Display for Engine {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        use crate::schema::Choices;
        write!(formatter, "{}", self.version)?;
        match self.processors {
            Processors::X86_64 => Ok(()),
            other => write!(formatter, " ({})", other.choice().name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_engine_names_its_processors_unless_they_are_the_most_frequent() {
        let engine = |processors| Engine { version: 3, processors }.to_string();
        assert_eq!(engine(Processors::X86_64), "3");
        assert_eq!(engine(Processors::Arm64), "3 (arm64)");
        #[cfg(target_arch = "x86_64")]
        assert_eq!(Engine::THIS.to_string(), ENGINE_VERSION.to_string());
    }
}
