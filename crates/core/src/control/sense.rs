//! The catalogue of senses: their names, units and scales, and the organs to which they belong.

use crate::schema::{listed_values, setting_group, switch};

listed_values! {
    /// A sense. Senses of a joint come first, then those of a limb, then those of the whole snake.
    #[derive(PartialOrd, Ord)]
    pub enum SenseKind {
        /// Angle of a joint's bend.
        Bend;
        /// Angle of a joint's twist.
        Twist;
        /// Rate of a joint's bend.
        BendRate;
        /// Rate of a joint's twist.
        TwistRate;
        /// Whether a limb touches ground or stairs.
        Touch;
        /// Upward force of the contacts on a limb.
        Load;
        /// Force of the contacts on a limb against its forward direction.
        Blocked;
        /// Sine of a limb's pitch.
        Pitch;
        /// Sine of a limb's roll.
        Roll;
        /// Distance from a limb's front face to the next riser.
        Gap;
        /// Height of the next tread over a limb's lowest corner.
        StepUp;
        /// Height of a limb's lowest corner over the surface below it.
        Clearance;
        /// Sine of the head's yaw.
        Yaw;
        /// Velocity of the middle limb towards the stairs.
        SpeedAhead;
        /// Velocity of the middle limb upwards.
        SpeedUp;
        /// Offset of the middle limb from the middle of the stairs, divided by half their width.
        Aside;
    }
}

/// A group of senses, which can be switched off together: see [`ActiveSenses`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SenseOrgan {
    /// The senses of the snake's own joints, which always work.
    Joints,
    /// The senses of the stairs ahead.
    Sight,
    /// The senses of contacts with ground and stairs.
    Touch,
    /// The senses of tilt and motion in space.
    Balance,
}

/// The part of the snake to which a sense belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensePlace {
    /// The sense exists once per joint.
    Joint,
    /// The sense exists once per limb.
    Limb,
    /// The sense exists once per snake.
    Snake,
}

/// Properties of a sense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SenseInfo {
    /// Name of the sense, in lower case.
    pub name: &'static str,
    /// Unit of the sense in displays; empty for a pure number.
    pub unit: &'static str,
    /// Quantity that controllers receive as 1, in `unit`; `None` where the scale is not linear.
    pub scale: Option<f32>,
    /// Least and greatest value that controllers receive.
    pub range: [f32; 2],
    /// Organ to which the sense belongs.
    pub organ: SenseOrgan,
    /// Part to which the sense belongs.
    pub place: SensePlace,
}

/// Angle in radians that controllers receive as 1. The scale is fixed, because a genome's own limit may be 0.
pub const ANGLE_SCALE_RAD: f32 = 1.8;
/// Rate in rad/s that controllers receive as 1.
pub const RATE_SCALE_RAD_S: f32 = 10.0;
/// Gap in metres that controllers receive as 1.
pub const GAP_SCALE_M: f32 = 2.0;
/// Speed in m/s that controllers receive as 1.
pub const SPEED_SCALE_M_S: f32 = 5.0;

impl SenseKind {
    /// Returns the properties of the sense.
    pub fn info(self) -> SenseInfo {
        use SenseOrgan::{Balance, Joints, Sight, Touch};
        let of = |name, unit, scale, range, organ, place| SenseInfo {
            name,
            unit,
            scale,
            range,
            organ,
            place,
        };
        let joint = |name, unit, scale, most: f32| {
            of(name, unit, Some(scale), [-most, most], Joints, SensePlace::Joint)
        };
        let limb =
            |name, unit, scale, range, organ| of(name, unit, scale, range, organ, SensePlace::Limb);
        let snake = |name, unit, scale, most: f32| {
            of(name, unit, scale, [-most, most], Balance, SensePlace::Snake)
        };
        match self {
            Self::Bend => joint("bend", "rad", ANGLE_SCALE_RAD, 1.7),
            Self::Twist => joint("twist", "rad", ANGLE_SCALE_RAD, 1.7),
            Self::BendRate => joint("bend rate", "rad/s", RATE_SCALE_RAD_S, 1.0),
            Self::TwistRate => joint("twist rate", "rad/s", RATE_SCALE_RAD_S, 1.0),
            Self::Touch => limb("touch", "", Some(1.0), [0.0, 1.0], Touch),
            Self::Load => limb("load", "N", None, [0.0, 1.0], Touch),
            Self::Blocked => limb("blocked", "N", None, [0.0, 1.0], Touch),
            Self::Pitch => limb("pitch", "", Some(1.0), [-1.0, 1.0], Balance),
            Self::Roll => limb("roll", "", Some(1.0), [-1.0, 1.0], Balance),
            Self::Gap => limb("gap", "m", Some(GAP_SCALE_M), [0.0, 1.0], Sight),
            Self::StepUp => limb("step up", "m", Some(1.0), [-2.0, 2.0], Sight),
            Self::Clearance => limb("clearance", "m", Some(1.0), [0.0, 2.0], Sight),
            Self::Yaw => snake("yaw", "", Some(1.0), 1.0),
            Self::SpeedAhead => snake("speed ahead", "m/s", Some(SPEED_SCALE_M_S), 1.0),
            Self::SpeedUp => snake("speed up", "m/s", Some(SPEED_SCALE_M_S), 1.0),
            Self::Aside => snake("aside", "", Some(1.0), 2.0),
        }
    }

    /// Clamps a value to the range that controllers receive. A number that is not finite becomes 0.
    pub(super) fn clamped(self, value: f32) -> f32 {
        let [least, most] = self.info().range;
        if value.is_finite() { value.clamp(least, most) } else { 0.0 }
    }
}

setting_group! {
    /// The senses that work. A sense that does not work keeps its last value; if it never worked, that of the snake at rest at the start.
    #[derive(Copy)]
    pub struct ActiveSenses in "Senses": "Senses that work; one that does not keeps its last value." {
        /// Whether the senses of the stairs work: gap, step up and clearance.
        sight: bool = true,
            switch("Sight")
                .hint("Whether the snake sees the stairs ahead: gap to the next riser, its height, clearance");

        /// Whether the senses of contacts work: touch, load and blocked.
        touch: bool = true,
            switch("Touch")
                .hint("Whether the snake feels contacts: touch, load, and resistance ahead");

        /// Whether the senses of tilt and motion work: pitch, roll, yaw, speed and distance from the middle.
        balance: bool = true,
            switch("Balance")
                .hint("Whether the snake feels its tilt and motion: pitch, roll, yaw, speed, distance aside");
    }
}

impl ActiveSenses {
    /// No senses except those of the joints.
    pub const NONE: Self = Self { sight: false, touch: false, balance: false };

    /// Returns whether an organ works.
    pub fn has(&self, organ: SenseOrgan) -> bool {
        match organ {
            SenseOrgan::Joints => true,
            SenseOrgan::Sight => self.sight,
            SenseOrgan::Touch => self.touch,
            SenseOrgan::Balance => self.balance,
        }
    }
}
