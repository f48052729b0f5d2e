//! Soft limbs: elastic beams as chains of parts with springs between them.
//!
//! A limb of length l is cut into n parts of length d = l / n. A spring between two parts acts about each axis. It is as stiff as a piece
//! of the beam of length d: `E I / d` for bending, with Young's modulus E and the second moment of area I of the cross-section, and
//! `G J / d` for torsion, with the shear modulus G and the torsion constant J. The deflection of a clamped beam then differs from that of
//! Euler and Bernoulli by the factor `1 + 1 / (2 n²)` under a load at its tip, if half a piece of beam clamps its root.

use super::WorldPlan;
use super::body::{BodyPlan, PartPlan, SpringPlan};
use crate::check::Invalid;

/// Elastic properties of a limb.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// Young's modulus of the limb's material, in Pa.
    pub youngs_modulus_pa: f32,
    /// Number of parts into which the limb is cut; a limb of one part is rigid.
    pub parts: u32,
    /// Damping of the limb's slowest vibration, as a share of the critical damping.
    pub damping_ratio: f32,
}

/// Least bending stiffness per mass per length, in m⁴/s². Softer limbs fold up under their own weight. At this stiffness, a clamped limb
/// of 2 m sags by 0.49 m.
pub const SOFTEST_M4_S2: f32 = 40.0;
/// Greatest bending stiffness per mass per length, in m⁴/s². Beyond it, the solver, with four iterations, makes a chain softer than its
/// springs. A limb that is stiffer about its softer axis is made rigid. At this stiffness, a clamped limb of 2 m sags by 0.025 m.
pub const STIFFEST_M4_S2: f32 = 800.0;

/// Ratio of the shear modulus to Young's modulus, for a material that keeps its volume (Poisson's ratio 1/2).
const SHEAR_SHARE: f64 = 1.0 / 3.0;
/// Square of the first eigenvalue of a free beam: its slowest vibration has the angular frequency `22.4 √(E I / (ρ' l⁴))`,
/// with the mass per length ρ'.
const FREE_BEAM: f64 = 22.4;

/// Returns the bending stiffness of a beam about its softer axis, per mass per length, in m⁴/s²: `E t² / (12 ρ)` for the smaller side t of
/// the cross-section and the density ρ.
pub fn bending_m4_s2(youngs_modulus_pa: f32, sides_m: [f32; 2], density_kg_m3: f32) -> f32 {
    let side_m = sides_m[0].min(sides_m[1]);
    youngs_modulus_pa * side_m * side_m / (12.0 * density_kg_m3)
}

/// Returns Young's modulus, in Pa, at which a beam has this bending stiffness per mass per length: the inverse of [`bending_m4_s2`].
pub fn modulus_at_pa(bending_m4_s2: f32, sides_m: [f32; 2], density_kg_m3: f32) -> f32 {
    let side_m = sides_m[0].min(sides_m[1]);
    bending_m4_s2 * 12.0 * density_kg_m3 / (side_m * side_m)
}

/// Returns the torsion constant J of a rectangular cross-section, in m⁴ (Roark's formula): 0.141 a⁴ for a square of side a.
fn torsion_m4(width_m: f64, height_m: f64) -> f64 {
    let (long, short) = (width_m.max(height_m), width_m.min(height_m));
    let ratio = short / long;
    let fourth = ratio * ratio * ratio * ratio;
    long * short * short * short * (1.0 / 3.0 - 0.21 * ratio * (1.0 - fourth / 12.0))
}

impl Elasticity {
    /// Returns whether a limb of this size and density bends. Limbs stiffer than `STIFFEST_M4_S2` are rigid.
    fn bends(&self, limb: &PartPlan) -> bool {
        let sides_m = [limb.width_m, limb.height_m];
        self.parts > 1
            && bending_m4_s2(self.youngs_modulus_pa, sides_m, limb.density_kg_m3) <= STIFFEST_M4_S2
    }

    /// Returns the stiffness, in N·m/rad, and the damping, in N·m·s/rad, of the springs in a limb about its x, y and z axes.
    fn springs(&self, limb: &PartPlan) -> [[f32; 3]; 2] {
        let [width, length, height] = limb.size_m().map(f64::from);
        let modulus = f64::from(self.youngs_modulus_pa);
        let piece = length / f64::from(self.parts);
        let bending = modulus * width * height * height * height / 12.0;
        let sideways = modulus * height * width * width * width / 12.0;
        let stiffness = [
            bending / piece,
            SHEAR_SHARE * modulus * torsion_m4(width, height) / piece,
            sideways / piece,
        ];
        let kg_m = f64::from(limb.density_kg_m3) * width * height;
        let slowest = |stiffness: f64| FREE_BEAM * (stiffness / kg_m).sqrt() / (length * length);
        // Torsion is damped with the rate of bending about x.
        let rates = [slowest(bending), slowest(bending), slowest(sideways)];
        let damping = std::array::from_fn(|axis| {
            (2.0 * f64::from(self.damping_ratio) * stiffness[axis] / rates[axis]) as f32
        });
        [stiffness.map(|of_axis| of_axis as f32), damping]
    }
}

impl BodyPlan {
    /// Replaces rigid limbs by chains of parts with springs where their material bends. All limbs must be rigid before. `elastic` returns
    /// the elasticity of a limb, or `None` where the limb stays rigid.
    pub fn with_soft_limbs(mut self, elastic: impl Fn(usize) -> Option<Elasticity>) -> Self {
        let rigid = std::mem::take(&mut self.parts);
        let (mut first_of, mut last_of) = (Vec::new(), Vec::new());
        for limb in &rigid {
            first_of.push(self.parts.len());
            let elastic = elastic(limb.limb).filter(|elastic| elastic.bends(limb));
            let Some(elastic) = elastic else {
                last_of.push(self.parts.len());
                self.parts.push(limb.clone());
                continue;
            };
            let part = PartPlan { length_m: limb.length_m / elastic.parts as f32, ..limb.clone() };
            let [stiffness_nm_per_rad, damping_nms_per_rad] = elastic.springs(limb);
            let smallest_side_m = part.smallest_side_m();
            for index in 0..elastic.parts as usize {
                if index > 0 {
                    let parent = self.parts.len() - 1;
                    self.springs.push(SpringPlan {
                        parent,
                        child: parent + 1,
                        stiffness_nm_per_rad,
                        damping_nms_per_rad,
                        gap_scale: smallest_side_m.min(1.0),
                    });
                }
                self.parts.push(part.clone());
            }
            last_of.push(self.parts.len() - 1);
        }
        let is_soft = |limb: usize| first_of[limb] != last_of[limb];
        for joint in &self.joints {
            // The engine excludes contacts between the two parts that a joint connects, but not between the limbs' other parts, which
            // would touch in a sharp bend.
            if is_soft(joint.parent) || is_soft(joint.child) {
                self.contact_free_pairs.push([joint.parent, joint.child]);
            }
        }
        for joint in &mut self.joints {
            (joint.parent, joint.child) = (last_of[joint.parent], first_of[joint.child]);
        }
        let middle = first_of.get(self.middle_part).zip(last_of.get(self.middle_part));
        self.middle_part = middle.map_or(0, |(first, last)| (first + last).div_ceil(2));
        self
    }
}

impl WorldPlan {
    /// Returns the number of steps into which an engine that integrates springs explicitly has to divide each physics step: the number of
    /// substeps, or a multiple of it if the fastest spring of a soft limb needs shorter steps. A part between two springs swings with an
    /// angular frequency of at most `2 √(k / I)`, for the stiffness k and the part's moment of inertia I about its centre, and a step
    /// lasts at most half of its inverse.
    pub fn explicit_steps(&self) -> u32 {
        let parts = &self.body.parts;
        let fastest = self.body.springs.iter().flat_map(|spring| {
            let part = &parts[spring.child];
            let [x2, y2, z2] = part.size_m().map(|size_m| size_m * size_m);
            let inertia = [y2 + z2, x2 + z2, x2 + y2].map(|sum| part.mass_kg() * sum / 12.0);
            let stiffness = spring.stiffness_nm_per_rad.into_iter();
            stiffness.zip(inertia).map(|(stiffness, inertia)| 2.0 * (stiffness / inertia).sqrt())
        });
        let most_per_s = 2.0 * fastest.fold(0.0_f32, f32::max);
        let substeps = self.physics.substeps.max(1);
        let per_s = (self.physics.steps_per_s * substeps) as f32;
        substeps * (most_per_s / per_s).ceil().max(1.0) as u32
    }
}

/// Checks that a limb of this material and size does not fold up under its own weight. `field` is the name of the modulus in the error.
///
/// # Errors
/// Returns an error if the limb is too soft.
pub fn check_softness(
    field: &str,
    youngs_modulus_pa: f32,
    sides_m: [f32; 2],
    density_kg_m3: f32,
) -> Result<(), Invalid> {
    let least_pa = modulus_at_pa(SOFTEST_M4_S2, sides_m, density_kg_m3);
    // Moduli at the limit are rounded to 32 bits.
    if youngs_modulus_pa >= least_pa * 0.999_99 {
        return Ok(());
    }
    let [width_m, height_m] = sides_m;
    let allowed = format!(
        "{} Pa or more, because softer limbs of {width_m} m by {height_m} m and {density_kg_m3} kg/m³ would fold up under \
         their own weight",
        least_pa.ceil()
    );
    Err(Invalid::new(field, youngs_modulus_pa, allowed))
}
