//! The catalogue of senses: their names, units and scales, and the organs that they belong to.

use crate::schema::{listed_values, setting_group, switch};

listed_values! {
    /// A sense of a joint, of a limb, or of the snake as a whole, in this order.
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
        /// Force of the contacts upwards.
        Load;
        /// Force of the contacts against the direction in which the limb points.
        Blocked;
        /// Sine of a limb's pitch.
        Pitch;
        /// Sine of a limb's roll.
        Roll;
        /// Way from a limb's front face to the next riser.
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
        /// Distance of the middle limb from the middle of the stairs, over half their width.
        Aside;
    }
}

/// A group of senses. A person can take each away: see [`ActiveSenses`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SenseOrgan {
    /// The snake's own joints; always there.
    Joints,
    /// The stairs ahead.
    Sight,
    /// Contacts with ground and stairs.
    Touch,
    /// Attitude and motion in space.
    Balance,
}

/// The part of the snake that a sense belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensePlace {
    /// Each joint has one.
    Joint,
    /// Each limb has one.
    Limb,
    /// The snake has one.
    Snake,
}

/// The facts about a sense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SenseInfo {
    /// Its name, in lower case.
    pub name: &'static str,
    /// Its unit in read-outs; empty for a pure number.
    pub unit: &'static str,
    /// The value 1 that controllers receive, in that unit; none where the scale is not linear.
    pub scale: Option<f32>,
    /// The least and the greatest value that controllers receive.
    pub range: [f32; 2],
    /// The organ to which it belongs.
    pub organ: SenseOrgan,
    /// The part that it belongs to.
    pub place: SensePlace,
}

/// The angle in radians that controllers receive as 1: a fixed scale, because a genome's own limit may be 0.
pub const ANGLE_SCALE_RAD: f32 = 1.8;
/// The rate in rad/s that controllers receive as 1.
pub const RATE_SCALE_RAD_S: f32 = 10.0;
/// The gap in metres that controllers receive as 1.
pub const GAP_SCALE_M: f32 = 2.0;
/// The speed in m/s that controllers receive as 1.
pub const SPEED_SCALE_M_S: f32 = 5.0;

impl SenseKind {
    /// Its facts.
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

    /// A value within the range that controllers receive; a number that is not finite becomes 0.
    pub(super) fn clamped(self, value: f32) -> f32 {
        let [least, most] = self.info().range;
        if value.is_finite() { value.clamp(least, most) } else { 0.0 }
    }
}

setting_group! {
    /// The senses that work. One that does not keeps the value that it had when it stopped: at the start, that of the
    /// snake at rest.
    #[derive(Copy)]
    pub struct ActiveSenses in "Senses": "Senses that work; one that does not keeps its last value." {
        /// Gap, step up and clearance.
        sight: bool = true,
            switch("Sight")
                .hint("Whether the snake sees the stairs ahead: gap to the next riser, its height, clearance");

        /// Touch, load and blocked.
        touch: bool = true,
            switch("Touch")
                .hint("Whether the snake feels contacts: touch, load, and resistance ahead");

        /// Pitch, roll, yaw, speed and distance from the middle.
        balance: bool = true,
            switch("Balance")
                .hint("Whether the snake feels its attitude and motion: pitch, roll, yaw, speed, distance aside");
    }
}

impl ActiveSenses {
    /// No senses but the joints' own.
    pub const NONE: Self = Self { sight: false, touch: false, balance: false };

    /// Whether an organ works.
    pub fn has(&self, organ: SenseOrgan) -> bool {
        match organ {
            SenseOrgan::Joints => true,
            SenseOrgan::Sight => self.sight,
            SenseOrgan::Touch => self.touch,
            SenseOrgan::Balance => self.balance,
        }
    }
}
