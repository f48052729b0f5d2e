//! The points in which two bodies touch, and the choice of the points that are solved.

use crate::world::Vector;

/// A point in which two bodies touch, or nearly touch.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SharedPoint {
    /// Numbers of the corners, edges or faces that meet at the point. Equal numbers in two steps mean the same point of the same bodies.
    pub features: u16,
    /// Point on the first body, in the frame of the search, in metres.
    pub on_first: Vector,
    /// Point on the second body, in the frame of the search, in metres.
    pub on_second: Vector,
    /// Distance of the two surfaces along the normal, in metres; negative where they overlap.
    pub distance_m: f32,
}

/// Upper bound of the points that two faces with four corners each can share: the corners of both faces, and the crossings of their edges.
const MOST_SHARED: usize = 16;

/// All points in which two bodies touch, in the frame of the first box, or in the world if the first body is the ground. The memory is
/// reused for each pair of bodies.
#[derive(Debug, Clone, Default)]
pub(super) struct SharedPoints {
    /// Unit vector from the first body to the second.
    pub normal: Vector,
    points: [SharedPoint; MOST_SHARED],
    count: usize,
}

impl SharedPoints {
    /// Clears the list, to find the points along a normal.
    pub fn begin(&mut self, normal: Vector) {
        (self.normal, self.count) = (normal, 0);
    }

    /// Adds a point, unless the list is full.
    pub fn push(&mut self, point: SharedPoint) {
        if let Some(slot) = self.points.get_mut(self.count) {
            *slot = point;
            self.count += 1;
        }
    }

    /// Returns the points found.
    pub fn points(&self) -> &[SharedPoint] {
        &self.points[..self.count]
    }
}

/// Returns -1 for a negative number, else 1.
pub(super) fn sign(value: f32) -> f32 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

/// A plane at right angles to the contact's normal, on which both faces are projected.
pub(super) struct Plane([Vector; 2]);

impl Plane {
    /// Builds the basis of Duff and others, "Building an orthonormal basis, revisited", JCGT 6, 2017.
    pub fn across(normal: Vector) -> Self {
        Self(basis(normal))
    }

    /// Projects a point onto the plane.
    pub fn seen(&self, point: Vector) -> [f32; 2] {
        [point.dot(self.0[0]), point.dot(self.0[1])]
    }
}

/// Returns two unit vectors at right angles to a unit vector and to each other.
pub(super) fn basis(normal: Vector) -> [Vector; 2] {
    let side = sign(normal.z);
    let a = -1.0 / (side + normal.z);
    let b = normal.x * normal.y * a;
    [
        Vector::new(1.0 + side * normal.x * normal.x * a, side * b, -side * normal.x),
        Vector::new(b, side + normal.y * normal.y * a, -normal.y),
    ]
}

/// Greatest number of points of a contact that are solved.
pub(super) const MOST_POINTS: usize = 4;

impl SharedPoints {
    /// Chooses up to four points that span the contact, ordered by place: the deepest point, the point furthest from it, and the outermost
    /// point on each side of the line through these two. Returns their indices and their number.
    pub fn chosen(&self, within_m: f32) -> ([usize; MOST_POINTS], usize) {
        let (mut chosen, count) = self.spanning(within_m);
        // The points are sorted by their place on the plane of the contact, so that their order does not depend on the order in which they
        // were found.
        let plane = Plane::across(self.normal);
        let before = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|index| plane.seen(self.points[index].on_first));
            a[0] < b[0] || (a[0] == b[0] && a[1] < b[1])
        };
        for index in 1..count {
            let moved = chosen[index];
            let mut to = index;
            while to > 0 && before(moved, chosen[to - 1]) {
                chosen[to] = chosen[to - 1];
                to -= 1;
            }
            chosen[to] = moved;
        }
        (chosen, count)
    }

    fn spanning(&self, within_m: f32) -> ([usize; MOST_POINTS], usize) {
        let points = self.points();
        let mut chosen = [0, 1, 2, 3];
        if points.len() <= MOST_POINTS {
            return (chosen, points.len());
        }
        for (index, point) in points.iter().enumerate() {
            if point.distance_m < points[chosen[0]].distance_m {
                chosen[0] = index;
            }
        }
        let deepest = points[chosen[0]].on_first;
        let near = |index: &usize| *index != chosen[0] && points[*index].distance_m <= within_m;
        let (mut furthest, mut most) = (None, -1.0);
        for index in (0..points.len()).filter(near) {
            let away = points[index].on_first - deepest;
            if away.dot(away) > most {
                (furthest, most) = (Some(index), away.dot(away));
            }
        }
        let Some(furthest) = furthest.filter(|_| most > 0.0) else { return (chosen, 1) };
        chosen[1] = furthest;
        let across = (points[furthest].on_first - deepest).cross(self.normal);
        let (mut least, mut greatest) = (None, None);
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        let others = (0..points.len()).filter(|index| {
            *index != chosen[0] && *index != furthest && points[*index].distance_m <= within_m
        });
        for index in others {
            let aside = (points[index].on_first - deepest).dot(across);
            if aside < low {
                (least, low) = (Some(index), aside);
            }
            if aside > high {
                (greatest, high) = (Some(index), aside);
            }
        }
        match (least, greatest) {
            (Some(least), Some(greatest)) if least != greatest => {
                (chosen[2], chosen[3]) = (least, greatest);
                (chosen, 4)
            }
            (Some(least), _) => {
                chosen[2] = least;
                (chosen, 3)
            }
            _ => (chosen, 2),
        }
    }
}
