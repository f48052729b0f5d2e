//! Numbers, vectors and rotations of several snakes side by side, one snake per lane.
//!
//! Each operation is a loop over plain arrays, which the compiler turns into the vector instructions of a processor, if it has any. The
//! operations only add, multiply, divide and take square roots. Each is rounded on its own as IEEE 754 says, and no two are fused. So a
//! lane has the same bits on every processor, for every number of lanes, and whatever the other lanes hold. The only exception is the sign
//! of zero, which [`Wide::without_signed_zeros`] removes: a lane that takes part in an operation only because another lane needs it adds a
//! product with zero, which may turn -0 into 0.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::world::{Rotation, Vector};

/// One number per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide<const N: usize>(pub [f32; N]);

/// One vector per lane.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WideVector<const N: usize> {
    pub x: Wide<N>,
    pub y: Wide<N>,
    pub z: Wide<N>,
}

/// One rotation per lane, as a unit quaternion.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WideRotation<const N: usize> {
    pub x: Wide<N>,
    pub y: Wide<N>,
    pub z: Wide<N>,
    pub w: Wide<N>,
}

/// One symmetric matrix per lane: an inverse inertia in the world.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WideSymmetric<const N: usize> {
    xx: Wide<N>,
    xy: Wide<N>,
    xz: Wide<N>,
    yy: Wide<N>,
    yz: Wide<N>,
    zz: Wide<N>,
}

impl<const N: usize> Default for Wide<N> {
    #[inline(always)]
    fn default() -> Self {
        Self::ZERO
    }
}

macro_rules! lane_by_lane {
    ($operation:ident, $function:ident, $sign:tt) => {
        impl<const N: usize> $operation for Wide<N> {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                let mut result = [0.0; N];
                for lane in 0..N {
                    result[lane] = self.0[lane] $sign other.0[lane];
                }
                Self(result)
            }
        }
    };
}

/// Implements addition or subtraction in place.
macro_rules! in_place {
    ($of:ident, $operation:ident, $function:ident, $sign:tt) => {
        impl<const N: usize> $operation for $of<N> {
            #[inline(always)]
            fn $function(&mut self, other: Self) {
                *self = *self $sign other;
            }
        }
    };
}

in_place!(Wide, AddAssign, add_assign, +);
in_place!(Wide, SubAssign, sub_assign, -);
in_place!(WideVector, AddAssign, add_assign, +);
in_place!(WideVector, SubAssign, sub_assign, -);

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

impl<const N: usize> Neg for Wide<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.each(|value| -value)
    }
}

impl<const N: usize> Wide<N> {
    pub const ZERO: Self = Self([0.0; N]);
    pub const ONE: Self = Self([1.0; N]);

    /// Sets all lanes to one number.
    #[inline(always)]
    pub fn all(value: f32) -> Self {
        Self([value; N])
    }

    #[expect(clippy::needless_range_loop, reason = "such a loop becomes vector instructions")]
    #[inline(always)]
    fn each(self, of: impl Fn(f32) -> f32) -> Self {
        let mut result = [0.0; N];
        for lane in 0..N {
            result[lane] = of(self.0[lane]);
        }
        Self(result)
    }

    /// Returns the smaller number in each lane. If they compare equal or one is NaN, it is the number of `other`.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self::where_less(self, other, self, other)
    }

    /// Returns the greater number in each lane. If they compare equal or one is NaN, it is the number of `other`.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::where_less(other, self, self, other)
    }

    /// Returns the square root in each lane.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.each(f32::sqrt)
    }

    /// Returns `then` in the lanes where `a` is less than `b`, and `otherwise` in the others.
    #[expect(clippy::needless_range_loop, reason = "such a loop becomes vector instructions")]
    #[inline(always)]
    pub fn where_less(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        let mut result = [0.0; N];
        for lane in 0..N {
            result[lane] = if a.0[lane] < b.0[lane] { then.0[lane] } else { otherwise.0[lane] };
        }
        Self(result)
    }

    /// Returns 1 / x in lanes with a positive number, and 0 in the others: a part that is held, or has no mass, takes no impulse.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self::where_less(Self::ZERO, self, Self::ONE / self, Self::ZERO)
    }

    /// Returns whether any lane has a number greater than that of `other`.
    #[inline(always)]
    pub fn any_greater(self, other: Self) -> bool {
        let mut any = false;
        for lane in 0..N {
            any |= self.0[lane] > other.0[lane];
        }
        any
    }

    /// Replaces -0 by 0 in each lane. After it, two computations that differ only in signs of zeros agree, because sums, products,
    /// quotients by numbers other than zero, roots and comparisons turn such a difference into no other one.
    #[inline(always)]
    pub fn without_signed_zeros(self) -> Self {
        self + Self::ZERO
    }
}

impl<const N: usize> Add for WideVector<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<const N: usize> Sub for WideVector<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<const N: usize> Mul<Wide<N>> for WideVector<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Wide<N>) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<const N: usize> WideVector<N> {
    pub const ZERO: Self = Self { x: Wide::ZERO, y: Wide::ZERO, z: Wide::ZERO };

    #[inline(always)]
    pub fn dot(self, other: Self) -> Wide<N> {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Multiplies the vectors component by component.
    #[inline(always)]
    pub fn times(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }

    /// Converts a vector of the world to a frame with these axes.
    #[inline(always)]
    pub fn into_frame(self, axes: &[Self; 3]) -> Self {
        Self { x: axes[0].dot(self), y: axes[1].dot(self), z: axes[2].dot(self) }
    }

    /// Converts a vector of a frame with these axes to the world.
    #[inline(always)]
    pub fn out_of_frame(self, axes: &[Self; 3]) -> Self {
        axes[0] * self.x + axes[1] * self.y + axes[2] * self.z
    }

    /// Sets the vector of one lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, to: Vector) {
        self.x.0[lane] = to.x;
        self.y.0[lane] = to.y;
        self.z.0[lane] = to.z;
    }

    /// Returns the vector of one lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vector {
        Vector::new(self.x.0[lane], self.y.0[lane], self.z.0[lane])
    }

    /// Replaces -0 by 0 in each component: see [`Wide::without_signed_zeros`].
    #[inline(always)]
    pub fn without_signed_zeros(self) -> Self {
        Self {
            x: self.x.without_signed_zeros(),
            y: self.y.without_signed_zeros(),
            z: self.z.without_signed_zeros(),
        }
    }
}

impl<const N: usize> WideRotation<N> {
    /// Returns the axes x, y and z after the rotation.
    #[inline(always)]
    pub fn axes(self) -> [WideVector<N>; 3] {
        let Self { x, y, z, w } = self;
        let (one, two) = (Wide::ONE, Wide::all(2.0));
        [
            WideVector {
                x: one - two * (y * y + z * z),
                y: two * (x * y + w * z),
                z: two * (x * z - w * y),
            },
            WideVector {
                x: two * (x * y - w * z),
                y: one - two * (x * x + z * z),
                z: two * (y * z + w * x),
            },
            WideVector {
                x: two * (x * z + w * y),
                y: two * (y * z - w * x),
                z: one - two * (x * x + y * y),
            },
        ]
    }

    /// Sets the rotation of one lane to a quaternion: x, y, z and w.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, [x, y, z, w]: [f32; 4]) {
        self.x.0[lane] = x;
        self.y.0[lane] = y;
        self.z.0[lane] = z;
        self.w.0[lane] = w;
    }

    /// Returns the rotation of one lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Rotation {
        Rotation::from_xyzw(self.x.0[lane], self.y.0[lane], self.z.0[lane], self.w.0[lane])
    }

    /// Returns the product of two rotations: `second` acts first, and this one after it.
    #[inline(always)]
    pub fn product(self, second: Self) -> Self {
        let (a, b) = (self, second);
        Self {
            x: a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            y: a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            z: a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
            w: a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        }
    }

    /// Applies a small rotation at this angular velocity for `step_s` after the present rotation. The result is linearised and normalised.
    #[inline(always)]
    pub fn turned(self, angular: WideVector<N>, step_s: Wide<N>) -> Self {
        let by = angular * (step_s * Wide::all(0.5));
        let Self { x, y, z, w } = self;
        let turned = Self {
            x: x + (by.x * w + by.y * z - by.z * y),
            y: y + (by.y * w + by.z * x - by.x * z),
            z: z + (by.z * w + by.x * y - by.y * x),
            w: w - (by.x * x + by.y * y + by.z * z),
        };
        let length =
            (turned.x * turned.x + turned.y * turned.y + turned.z * turned.z + turned.w * turned.w)
                .sqrt();
        let scale = Wide::ONE / length;
        Self { x: turned.x * scale, y: turned.y * scale, z: turned.z * scale, w: turned.w * scale }
    }

    /// Replaces -0 by 0 in each component: see [`Wide::without_signed_zeros`].
    #[inline(always)]
    pub fn without_signed_zeros(self) -> Self {
        Self {
            x: self.x.without_signed_zeros(),
            y: self.y.without_signed_zeros(),
            z: self.z.without_signed_zeros(),
            w: self.w.without_signed_zeros(),
        }
    }
}

impl<const N: usize> WideSymmetric<N> {
    /// Builds the matrix with these values along these axes.
    #[inline(always)]
    pub fn along(axes: &[WideVector<N>; 3], values: WideVector<N>) -> Self {
        let [a, b, c] = *axes;
        let scaled = [a * values.x, b * values.y, c * values.z];
        Self {
            xx: scaled[0].x * a.x + scaled[1].x * b.x + scaled[2].x * c.x,
            xy: scaled[0].x * a.y + scaled[1].x * b.y + scaled[2].x * c.y,
            xz: scaled[0].x * a.z + scaled[1].x * b.z + scaled[2].x * c.z,
            yy: scaled[0].y * a.y + scaled[1].y * b.y + scaled[2].y * c.y,
            yz: scaled[0].y * a.z + scaled[1].y * b.z + scaled[2].y * c.z,
            zz: scaled[0].z * a.z + scaled[1].z * b.z + scaled[2].z * c.z,
        }
    }

    /// Returns the product of the matrix with a vector.
    #[inline(always)]
    pub fn of(&self, vector: WideVector<N>) -> WideVector<N> {
        WideVector {
            x: self.xx * vector.x + self.xy * vector.y + self.xz * vector.z,
            y: self.xy * vector.x + self.yy * vector.y + self.yz * vector.z,
            z: self.xz * vector.x + self.yz * vector.y + self.zz * vector.z,
        }
    }
}
