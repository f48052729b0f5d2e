//! The vector instructions with which the engine *lanes* computes. They are chosen when the program runs, and change no bit.

use std::sync::OnceLock;

use fearless_simd::Level;

use crate::check::Invalid;

/// The level that every processor has for which the program was built.
pub(super) const BASELINE: Level = Level::baseline();

/// The level that the solvers of this process use.
static IN_USE: OnceLock<VectorLevel> = OnceLock::new();

/// A set of vector instructions that this machine has.
#[derive(Debug, Clone, Copy)]
pub struct VectorLevel(pub(super) Level);

impl VectorLevel {
    /// Returns the levels of this machine, the weakest first.
    pub fn all() -> Vec<Self> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let stronger = {
            let best = Level::new();
            [
                best.as_sse4_2().map(fearless_simd::Simd::level),
                best.as_avx2().map(fearless_simd::Simd::level),
            ]
        };
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        let stronger = [Some(Level::new())];
        let levels = [Some(BASELINE)].into_iter().chain(stronger);
        let mut levels: Vec<_> = levels.flatten().map(Self).collect();
        levels.dedup_by_key(|level| level.name());
        levels
    }

    /// Returns the level that new solvers use: the strongest of this machine, unless [`Self::choose`] has chosen another.
    pub fn in_use() -> Self {
        *IN_USE.get_or_init(|| Self(Level::new()))
    }

    /// Chooses a level by its name, for measurements and tests. It holds for this process, and is chosen before the first solver.
    ///
    /// # Errors
    /// This machine has no level with this name, or the process already uses another one.
    pub fn choose(name: &str) -> Result<(), Invalid> {
        let levels = Self::all();
        let allowed = match levels.iter().find(|level| level.name() == name) {
            Some(level) => IN_USE.get_or_init(|| *level).name().to_owned(),
            None => levels.iter().map(|level| level.name()).collect::<Vec<_>>().join(", "),
        };
        if allowed == name {
            return Ok(());
        }
        Err(Invalid::new("vector instructions", name, allowed))
    }

    /// Returns the name of the level, as [`Self::choose`] takes it.
    pub fn name(self) -> &'static str {
        match self.0 {
            #[cfg(target_arch = "aarch64")]
            Level::Neon(_) => "neon",
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Level::WasmSimd128(_) => "simd128",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Level::Avx2(_) => "avx2",
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            level if level.as_sse4_2().is_some() => "sse4.2",
            _ if cfg!(target_feature = "sse2") => "sse2",
            _ => "none",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_names_its_levels_and_refuses_others() {
        let names: Vec<_> = VectorLevel::all().iter().map(|level| level.name()).collect();
        assert_eq!(names.last(), Some(&VectorLevel::in_use().name()), "{names:?}");
        #[cfg(target_arch = "x86_64")]
        assert!(names.contains(&"sse2") || names == ["avx2"], "{names:?}");
        let refused = VectorLevel::choose("mmx").expect_err("no such level");
        assert_eq!(refused.allowed, names.join(", "));
        // A solver of this process may already compute, so that its level stays.
        for name in names {
            let is_in_use = name == VectorLevel::in_use().name();
            assert_eq!(VectorLevel::choose(name).is_ok(), is_in_use, "{name}");
        }
    }
}
