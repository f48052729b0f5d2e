//! The snake's body and joints, as far as they are given and do not evolve.

use super::entry::Parts::{Joints, Limbs};
use super::entry::{Section, number};

/// The limbs.
pub const BODY: Section = Section {
    title: "Body",
    about: "How many blocks the snake has, how large and how heavy they are.",
    prefix: "trial.agent.",
    entries: &[
        number(
            "limbs",
            "Limbs",
            "",
            "Number of blocks, each joined to the next. What has evolved for other numbers does not fit",
            [2.0, 12.0],
        )
        .slider(2.0, 12.0)
        .whole(),
        number(
            "limb_width_m",
            "Limb width",
            "m",
            "Size of a block across the stairs. Wide blocks do not roll over",
            [0.1, 10.0],
        )
        .slider(0.2, 3.0)
        .for_each(Limbs),
        number(
            "limb_length_m",
            "Limb length",
            "m",
            "Size of a block along the snake. Long blocks reach further and bend less",
            [0.1, 10.0],
        )
        .slider(0.2, 5.0)
        .for_each(Limbs),
        number(
            "limb_height_m",
            "Limb height",
            "m",
            "Size of a block upwards. High blocks reach the next step more easily",
            [0.1, 10.0],
        )
        .slider(0.2, 3.0)
        .for_each(Limbs),
        number(
            "density_kg_m3",
            "Density",
            "kg/m³",
            "Mass per volume of the blocks. Heavy snakes press harder and need more torque. \
             Unticked, each snake has its own, and it evolves",
            [0.1, 20_000.0],
        )
        .slider(0.1, 50.0)
        .by_ratio_from(0.1)
        .for_each(Limbs)
        .unless_given("2.2"),
        number(
            "angular_damping_per_s",
            "Angular damping",
            "1/s",
            "Share of its spin that a block loses per second, as in thick air",
            [0.0, 1000.0],
        )
        .slider(0.0, 500.0)
        .by_ratio_from(0.1),
    ],
};

/// What joins the limbs.
pub const JOINTS: Section = Section {
    title: "Joints",
    about: "How far the joints turn, how strong they are, how much they resist.",
    prefix: "trial.agent.",
    entries: &[
        number(
            "bend_limit_rad",
            "Bend limit",
            "rad",
            "Largest bend to either side, like snapping a stick. Unticked, each snake has its own, \
             drawn from a list",
            [0.0, 3.0],
        )
        .slider(0.0, 3.0)
        .for_each(Joints)
        .unless_given("1"),
        number(
            "twist_limit_rad",
            "Twist limit",
            "rad",
            "Largest twist to either side, like wringing a sponge. Unticked, each snake has its own, \
             drawn from a list",
            [0.0, 3.0],
        )
        .slider(0.0, 3.0)
        .for_each(Joints)
        .unless_given("1"),
        number(
            "max_bend_torque_nm",
            "Largest bend torque",
            "N·m",
            "How strongly a joint can bend. Whatever is asked of it beyond is cut off",
            [0.0, 1.0e6],
        )
        .slider(0.0, 2000.0)
        .for_each(Joints),
        number(
            "max_twist_torque_nm",
            "Largest twist torque",
            "N·m",
            "How strongly a joint can twist. Whatever is asked of it beyond is cut off",
            [0.0, 1.0e6],
        )
        .slider(0.0, 2000.0)
        .for_each(Joints),
        number(
            "joint_damping_nms_per_rad",
            "Joint damping",
            "N·m·s/rad",
            "Torque that resists a turning joint. Without it the motion is chaotic, and children are \
             nothing like their parents",
            [0.0, 1.0e5],
        )
        .slider(0.0, 500.0)
        .by_ratio_from(1.0)
        .for_each(Joints),
        number(
            "joint_cfm_m_s_per_n",
            "Joint CFM",
            "m/s per N",
            "0 is rigid; the larger, the more the joints give way under load",
            [0.0, 0.1],
        )
        .slider(0.0, 0.1)
        .by_ratio_from(1.0e-6)
        .for_each(Joints),
    ],
};
