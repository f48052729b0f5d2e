//! Contact of two boxes, and of a box with the ground. The search takes the separating axis along which the boxes overlap least, then the
//! two faces that meet along it, and then the points where these faces overlap.
//!
//! The test of the 15 axes is that of Gottschalk, Lin and Manocha, "OBBTree: a hierarchical structure for rapid interference detection",
//! SIGGRAPH 1996. The choice of the axis, and of the points that belong to a contact, follows parry's function for two cuboids, so that
//! both engines see the same contacts.

use super::shared_points::{Plane, SharedPoint, SharedPoints, sign};
use super::wide::{Wide, WideRotation};
use crate::world::{Pose, Vector};

/// A box with its pose in the world.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    /// Centre of the box, in metres.
    pub centre: Vector,
    /// Axes of the box, as unit vectors.
    pub axes: [Vector; 3],
    /// Half the sizes of the box along its axes, in metres.
    pub half_m: Vector,
}

/// Converts a vector from the world to the frame of a box with these axes.
fn into(axes: &[Vector; 3], vector: Vector) -> Vector {
    Vector::new(axes[0].dot(vector), axes[1].dot(vector), axes[2].dot(vector))
}

/// Converts a vector from the frame of a box with these axes to the world.
pub(super) fn out_of(axes: &[Vector; 3], vector: Vector) -> Vector {
    axes[0] * vector.x + axes[1] * vector.y + axes[2] * vector.z
}

impl Block {
    /// Returns a box of half these sizes in a pose.
    pub fn at(pose: Pose, half_m: Vector) -> Self {
        let [x, y, z, w] = pose.rotation.to_array().map(|part| Wide([part]));
        let axes = WideRotation { x, y, z, w }.axes().map(|axis| axis.get(0));
        Self { centre: pose.translation, axes, half_m }
    }

    /// Converts a direction from the block's own frame to the world.
    pub fn turned(&self, direction: Vector) -> Vector {
        out_of(&self.axes, direction)
    }

    /// Converts a point from the block's own frame to the world.
    pub fn in_world(&self, point: Vector) -> Vector {
        self.centre + out_of(&self.axes, point)
    }

    /// Converts a point from the world to the block's own frame.
    pub fn in_own_frame(&self, point: Vector) -> Vector {
        into(&self.axes, point - self.centre)
    }

    /// Returns half the sizes of the axis-aligned box around the block, in metres.
    pub fn reach_m(&self) -> Vector {
        self.axes[0].abs() * self.half_m.x
            + self.axes[1].abs() * self.half_m.y
            + self.axes[2].abs() * self.half_m.z
    }
}

/// A face of a box: its corners in order around it, the numbers of these corners, and the number of the face. The eight corners have
/// numbers 0 to 7, the six faces 8 to 13.
struct Face {
    corners: [Vector; 4],
    numbers: [u8; 4],
    number: u8,
}

/// Returns the face of a box whose outward normal is closest to a direction, in the box's frame.
fn face_along(half_m: Vector, direction: Vector) -> Face {
    let size = direction.abs();
    // If several components are equal, the first counts.
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    match axis {
        0 => face_across::<0>(half_m, sign(direction.x)),
        1 => face_across::<1>(half_m, sign(direction.y)),
        _ => face_across::<2>(half_m, sign(direction.z)),
    }
}

/// Returns the face of a box on one side of an axis: 1 for its positive half, else -1.
fn face_across<const AXIS: usize>(half_m: Vector, side: f32) -> Face {
    let (next, last) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let mut corners = [Vector::ZERO; 4];
    let mut numbers = [0; 4];
    for (index, signs) in
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].into_iter().enumerate()
    {
        let mut of_axis = Vector::ZERO;
        of_axis[AXIS] = side;
        of_axis[next] = signs[0];
        of_axis[last] = signs[1];
        corners[index] = of_axis * half_m;
        let bit = |value: f32, bit: u8| if value < 0.0 { bit } else { 0 };
        numbers[index] = bit(of_axis.x, 1) | bit(of_axis.y, 2) | bit(of_axis.z, 4);
    }
    Face { corners, numbers, number: 8 + 2 * AXIS as u8 + u8::from(side < 0.0) }
}

/// Number of the only face of the ground.
const GROUND: u8 = 8;

/// Returns the number of the edge between two corners.
fn edge(a: u8, b: u8) -> u8 {
    16 + a.min(b) * 8 + a.max(b)
}

fn features(first: u8, second: u8) -> u16 {
    u16::from(first) << 8 | u16::from(second)
}

/// Finds the contact of the ground, z = 0, with a box. Points up to `within_m` above the ground count. Points are given in the frame of
/// the world. Returns whether there is a contact.
pub(super) fn on_ground(block: &Block, within_m: f32, found: &mut SharedPoints) -> bool {
    let down = into(&block.axes, Vector::new(0.0, 0.0, -1.0));
    let Face { corners, numbers, .. } = face_along(block.half_m, down);
    found.begin(Vector::Z);
    for (corner, number) in corners.into_iter().zip(numbers) {
        let at = block.in_world(corner);
        if at.z <= within_m {
            found.push(SharedPoint {
                features: features(GROUND, number),
                on_first: Vector::new(at.x, at.y, 0.0),
                on_second: at,
                distance_m: at.z,
            });
        }
    }
    !found.points().is_empty()
}

/// Distance of two boxes along an axis, negative if they overlap, and the axis.
#[derive(Debug, Clone, Copy)]
struct Separation {
    distance_m: f32,
    /// Unit vector from the first box to the second, in the frame of the first.
    normal: Vector,
}

/// Sine of the angle to a face's plane below which a distance along the normal is too inexact to use.
const FLAT: f32 = 1.0e-6;

/// Two boxes, given in the frame of the first.
struct BlockPair {
    /// Half the sizes of the first box, in metres.
    first_half_m: Vector,
    /// Half the sizes of the second box, in metres.
    second_half_m: Vector,
    /// Centre of the second box, in metres.
    place: Vector,
    /// Axes of the second box, as unit vectors.
    axes: [Vector; 3],
}

impl BlockPair {
    fn of(first: &Block, second: &Block) -> Self {
        Self {
            first_half_m: first.half_m,
            second_half_m: second.half_m,
            place: first.in_own_frame(second.centre),
            axes: second.axes.map(|axis| into(&first.axes, axis)),
        }
    }

    /// Returns the pair in the frame of the second box, with the two boxes swapped.
    fn seen_from_second(&self) -> Self {
        let axes = &self.axes;
        Self {
            first_half_m: self.second_half_m,
            second_half_m: self.first_half_m,
            place: into(axes, -self.place),
            axes: [0, 1, 2].map(|row| Vector::new(axes[0][row], axes[1][row], axes[2][row])),
        }
    }

    /// Finds the normal of a face of the first box along which the boxes are furthest apart. Where several normals separate the boxes, a
    /// corner or an edge is nearest, and the axis lies between these normals.
    fn along_faces(&self) -> Separation {
        let Self { first_half_m, second_half_m, place, axes } = self;
        let mut best = Separation { distance_m: f32::MIN, normal: Vector::ZERO };
        let (mut between, mut separating) = (Vector::ZERO, 0);
        for axis in 0..3 {
            let side = sign(place[axis]);
            let reach_m = axes[0][axis].abs() * second_half_m.x
                + axes[1][axis].abs() * second_half_m.y
                + axes[2][axis].abs() * second_half_m.z;
            let distance_m = place[axis].abs() - reach_m - first_half_m[axis];
            if distance_m > best.distance_m {
                let mut normal = Vector::ZERO;
                normal[axis] = side;
                best = Separation { distance_m, normal };
            }
            if distance_m >= 0.0 {
                between[axis] = side * distance_m.max(f32::EPSILON);
                separating += 1;
            }
        }
        if separating < 2 {
            return best;
        }
        self.along(between / between.dot(between).sqrt())
    }

    /// Computes the separation along an axis that points from the first box to the second.
    fn along(&self, normal: Vector) -> Separation {
        let reach_m = normal.abs().dot(self.first_half_m)
            + into(&self.axes, normal).abs().dot(self.second_half_m);
        Separation { distance_m: self.place.dot(normal) - reach_m, normal }
    }

    /// Finds the axis along which the boxes are furthest apart among the cross products of an edge of each box.
    fn along_edges(&self) -> Separation {
        let mut best = Separation { distance_m: f32::MIN, normal: Vector::ZERO };
        for of in &self.axes {
            let products = [
                Vector::new(0.0, -of.z, of.y),
                Vector::new(of.z, 0.0, -of.x),
                Vector::new(-of.y, of.x, 0.0),
            ];
            for product in products {
                let length = product.dot(product).sqrt();
                if length > f32::EPSILON {
                    let normal = product / length;
                    let normal = normal * sign(self.place.dot(normal));
                    let found = self.along(normal);
                    if found.distance_m > best.distance_m {
                        best = found;
                    }
                }
            }
        }
        best
    }

    /// Finds the points in which the two faces along a normal overlap, in the frame of the first box.
    fn shared_points(&self, normal: Vector, found: &mut SharedPoints) {
        let Self { first_half_m, second_half_m, place, axes } = self;
        let Face { corners: first, numbers: first_numbers, number: first_face } =
            face_along(*first_half_m, normal);
        let Face { corners: own, numbers: second_numbers, number: second_face } =
            face_along(*second_half_m, into(axes, -normal));
        let second = own.map(|corner| *place + out_of(axes, corner));
        let plane = Plane::across(normal);
        let (first_seen, second_seen) =
            (first.map(|corner| plane.seen(corner)), second.map(|corner| plane.seen(corner)));
        found.begin(normal);
        let mut within = [0; 2];

        // Corners of the first face within the second face, with their distance to the plane of the second, and vice versa.
        let upright = (second[2] - second[1]).cross(second[0] - second[1]);
        let along = upright.dot(normal);
        if along.abs() > FLAT * upright.length() {
            for (index, corner) in first.into_iter().enumerate() {
                if is_within(&second_seen, first_seen[index]) {
                    within[0] += 1;
                    let distance_m = (second[0] - corner).dot(upright) / along;
                    found.push(SharedPoint {
                        features: features(first_numbers[index], second_face),
                        on_first: corner,
                        on_second: corner + normal * distance_m,
                        distance_m,
                    });
                }
            }
        }
        let upright = (first[2] - first[1]).cross(first[0] - first[1]);
        let along = upright.dot(normal);
        if along.abs() > FLAT * upright.length() {
            for (index, corner) in second.into_iter().enumerate() {
                if is_within(&first_seen, second_seen[index]) {
                    within[1] += 1;
                    let distance_m = (corner - first[0]).dot(upright) / along;
                    found.push(SharedPoint {
                        features: features(first_face, second_numbers[index]),
                        on_first: corner - normal * distance_m,
                        on_second: corner,
                        distance_m,
                    });
                }
            }
        }
        if within.contains(&4) {
            // No edges cross if one face lies within the other.
            return;
        }
        for j in 0..4 {
            let second_edge = [second_seen[j], second_seen[(j + 1) % 4]];
            for i in 0..4 {
                let first_edge = [first_seen[i], first_seen[(i + 1) % 4]];
                if let Some([share, of_second]) = crossing(first_edge, second_edge) {
                    let on_first = first[i] * (1.0 - share) + first[(i + 1) % 4] * share;
                    let on_second = second[j] * (1.0 - of_second) + second[(j + 1) % 4] * of_second;
                    found.push(SharedPoint {
                        features: features(
                            edge(first_numbers[i], first_numbers[(i + 1) % 4]),
                            edge(second_numbers[j], second_numbers[(j + 1) % 4]),
                        ),
                        on_first,
                        on_second,
                        distance_m: (on_second - on_first).dot(normal),
                    });
                }
            }
        }
    }
}

/// Finds the contact of two boxes, in the frame of the first, if they are no further apart than `within_m`. Returns whether there is a
/// contact.
pub(super) fn of_blocks(
    first: &Block,
    second: &Block,
    within_m: f32,
    found: &mut SharedPoints,
) -> bool {
    let pair = BlockPair::of(first, second);
    let mut best = pair.along_faces();
    if best.distance_m > within_m {
        return false;
    }
    let back = pair.seen_from_second().along_faces();
    if back.distance_m > within_m {
        return false;
    }
    let edges = pair.along_edges();
    if edges.distance_m > within_m {
        return false;
    }
    if back.distance_m > best.distance_m && back.distance_m > edges.distance_m {
        best = Separation { normal: out_of(&pair.axes, -back.normal), ..back };
    } else if edges.distance_m > best.distance_m {
        best = edges;
    }
    pair.shared_points(best.normal, found);
    !found.points().is_empty()
}

/// Returns twice the signed area of the triangle between an edge and a point.
fn beside([a, b]: [[f32; 2]; 2], point: [f32; 2]) -> f32 {
    (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
}

/// Returns whether a point lies within a convex face, in coordinates of the plane.
fn is_within(face: &[[f32; 2]; 4], point: [f32; 2]) -> bool {
    let mut side = 0.0;
    for index in 0..4 {
        let found = beside([face[index], face[(index + 1) % 4]], point);
        if side == 0.0 {
            side = found;
        } else if side * found < 0.0 {
            return false;
        }
    }
    true
}

/// Finds where two edges cross, as shares of the lengths of both; `None` if they do not cross, or are nearly parallel.
fn crossing(first: [[f32; 2]; 2], second: [[f32; 2]; 2]) -> Option<[f32; 2]> {
    let along = |[a, b]: [[f32; 2]; 2]| [b[0] - a[0], b[1] - a[1]];
    let product = |a: [f32; 2], b: [f32; 2]| a[0] * b[1] - a[1] * b[0];
    let (u, v) = (along(first), along(second));
    let between = [second[0][0] - first[0][0], second[0][1] - first[0][1]];
    let area = product(u, v);
    // The edges count as parallel if the sine of the angle between them is below a thousandth.
    let lengths = (u[0] * u[0] + u[1] * u[1]) * (v[0] * v[0] + v[1] * v[1]);
    if area * area <= 1.0e-6 * lengths {
        return None;
    }
    let shares = [product(between, v) / area, product(between, u) / area];
    shares.iter().all(|share| *share > 0.0 && *share < 1.0).then_some(shares)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::parry::query::details::contact_manifold_cuboid_cuboid;
    use rapier3d::parry::query::{ContactManifold, TrackedContact};
    use rapier3d::parry::shape::Cuboid;

    use crate::rng::{Purpose, stream};
    use crate::world::Rotation;
    use rand::RngExt;

    /// Random boxes have the contacts that rapier finds: as many points in the same places, along the same normal.
    #[test]
    fn random_boxes_touch_as_in_parry() {
        let mut rng = stream(1, 1, 1, Purpose::Birth);
        let (mut touching, mut agreeing, mut found) = (0, 0, SharedPoints::default());
        for _ in 0..20_000 {
            let mut number = |most: f32| rng.random_range(-most..most);
            let half_m = [0, 1]
                .map(|_| Vector::new(0.6 + number(0.4), 0.8 + number(0.5), 0.5 + number(0.3)));
            let poses = [0, 1].map(|_| {
                let turn = Rotation::from_xyzw(number(1.0), number(1.0), number(1.0), number(1.0));
                let at = Vector::new(number(1.0), number(1.0), number(1.0));
                Pose::from_parts(at, turn.normalize())
            });
            let between = poses[0].inverse() * poses[1];
            let shapes = half_m.map(Cuboid::new);
            let mut manifold: ContactManifold<(), ()> = ContactManifold::new();
            contact_manifold_cuboid_cuboid(&between, &shapes[0], &shapes[1], 0.02, &mut manifold);
            let blocks = [0, 1].map(|index| Block::at(poses[index], half_m[index]));
            let touches = of_blocks(&blocks[0], &blocks[1], 0.02, &mut found);
            if !touches && manifold.points.is_empty() {
                continue;
            }
            touching += 1;
            let is_there = |point: &TrackedContact<()>| {
                let nearest = found.points().iter().map(|of| {
                    (of.on_first - point.local_p1).length() + (of.distance_m - point.dist).abs()
                });
                nearest.fold(f32::MAX, f32::min) < 2.0e-3
            };
            let agrees = touches
                && (found.normal - manifold.local_n1).length() < 1.0e-3
                && found.points().len() == manifold.points.len()
                && manifold.points.iter().all(is_there);
            agreeing += i32::from(agrees);
        }
        // If edges are nearly parallel, the two engines may disagree on which of them cross.
        assert!(
            touching > 5_000 && touching - agreeing < touching / 200,
            "{agreeing} of {touching}"
        );
    }

    /// A corner that moved from a riser to the tread above must not keep its impulse, which would then push along the new normal.
    #[test]
    fn a_corner_on_another_face_is_another_point() {
        let step = Block::at(Pose::IDENTITY, Vector::new(2.0, 1.0, 0.5));
        let at = |place| Block::at(Pose::from_translation(place), Vector::splat(0.5));
        let features = |place| {
            let mut found = SharedPoints::default();
            assert!(of_blocks(&step, &at(place), 0.02, &mut found));
            found.points().iter().map(|point| point.features).collect::<Vec<_>>()
        };
        let on_riser = features(Vector::new(0.0, -1.49, 0.3));
        let on_tread = features(Vector::new(0.0, -0.8, 0.99));
        assert!(on_riser.iter().all(|of| !on_tread.contains(of)), "{on_riser:?} {on_tread:?}");
    }
}
