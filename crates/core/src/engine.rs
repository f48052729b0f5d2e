//! The engine that computes the bits of a run: its version, and the processors on which it computes the same ones.

use std::fmt;

use crate::check::Invalid;
use crate::schema::choices;

/// Version of everything that determines the bits of a run: physics, controllers, random streams,
/// strategies. Raised by hand whenever a change alters the bits on purpose; saves record it.
pub const ENGINE_VERSION: u32 = 3;

choices! {
    /// Processors on which an engine computes the same bits. The vector mathematics below the physics engine adds the
    /// four products of a quaternion in another order on each of them.
    #[derive(Default)]
    pub enum Processors {
        /// WebAssembly belongs to them if it has SIMD, which it then uses in the same order.
        #[default]
        X86_64 = "x86-64", "x86-64", "Intel and AMD, and WebAssembly with SIMD.";
        Arm64 = "arm64", "arm64", "64-bit ARM, such as Apple's.";
        Other = "other", "other", "Others, and builds without SIMD.";
    }
}

/// An engine: runs of equal engines have equal bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Engine {
    /// Its version.
    pub version: u32,
    /// The processors.
    pub processors: Processors,
}

impl Engine {
    /// The engine of this program on this machine.
    pub const THIS: Self = Self { version: ENGINE_VERSION, processors: Processors::THIS };

    /// Checks that results of this engine can be continued here.
    ///
    /// # Errors
    /// It is another one than that of this program on this machine.
    pub fn check_this(self) -> Result<(), Invalid> {
        if self == Self::THIS {
            return Ok(());
        }
        Err(Invalid::new("engine", self.to_string(), Self::THIS.to_string()))
    }
}

impl Processors {
    /// The processors of this machine.
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

/// The version, and the processors if they are not the most frequent ones: "3", "3 (arm64)".
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
