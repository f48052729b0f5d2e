//! Positions for labels beside reference lines, where they hide little of the data.

/// Rectangle in pixels, y downwards: left, top, right, bottom.
pub type Box2 = [f32; 4];

/// Distance between a label and its reference line, in pixels.
const GAP: f32 = 2.0;
/// Positions of a label as shares of the free width, in order of preference.
const PLACES: [f32; 5] = [0.0, 1.0, 0.25, 0.75, 0.5];

/// Returns a rectangle for a label of this `size` (width, height), above or below the horizontal line at `y`, within `area`. It
/// meets as few segments of `lines` as possible, and if possible none of the rectangles `taken`.
pub fn beside_line(
    area: Box2,
    size: [f32; 2],
    y: f32,
    lines: &[Vec<[f32; 2]>],
    taken: &[Box2],
) -> Box2 {
    let [left, top, right, bottom] = area;
    let [width, height] = size;
    let room = (right - left - width).max(0.0);
    let candidate = |share: f32, upper: f32| {
        let x = left + room * share;
        [x, upper, x + width, upper + height]
    };
    let (above, below) = (y - GAP - height, y + GAP);
    let is_inside = |upper: &f32| *upper >= top && upper + height <= bottom;
    let candidates = PLACES
        .into_iter()
        .flat_map(|share| {
            [above, below].into_iter().filter(is_inside).map(move |upper| (share, upper))
        })
        .map(|(share, upper)| candidate(share, upper));
    let covered = |of: &Box2| {
        let segments = lines.iter().flat_map(|line| line.windows(2));
        let crossed = segments.filter(|ends| crosses(of, ends[0], ends[1])).count();
        let lone = lines.iter().filter(|line| line.len() == 1 && crosses(of, line[0], line[0]));
        let hidden = taken.iter().filter(|other| overlap(of, other)).count();
        // Covering another label is worse than crossing any number of lines.
        hidden * 1_000_000 + crossed + lone.count()
    };
    candidates.min_by_key(covered).unwrap_or_else(|| candidate(0.0, above.max(top)))
}

fn overlap(a: &Box2, b: &Box2) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Returns whether the segment from `from` to `to` meets a rectangle (clipping by Liang and Barsky).
fn crosses(of: &Box2, from: [f32; 2], to: [f32; 2]) -> bool {
    let [left, top, right, bottom] = *of;
    let (mut enters, mut leaves) = (0.0_f32, 1.0_f32);
    for (low, high, start, along) in
        [(left, right, from[0], to[0] - from[0]), (top, bottom, from[1], to[1] - from[1])]
    {
        if along == 0.0 {
            if start < low || start > high {
                return false;
            }
            continue;
        }
        let (a, b) = ((low - start) / along, (high - start) / along);
        enters = enters.max(a.min(b));
        leaves = leaves.min(a.max(b));
    }
    enters <= leaves
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Box2 = [0.0, 0.0, 300.0, 100.0];

    #[test]
    fn a_label_stands_where_no_line_runs() {
        // The line runs along the upper left, then falls to the lower right.
        let lines = [vec![[0.0, 40.0], [150.0, 40.0], [300.0, 90.0]]];
        let label = beside_line(AREA, [60.0, 12.0], 45.0, &lines, &[]);
        assert_eq!(label, [0.0, 47.0, 60.0, 59.0], "at the left, below its line");
        let free = beside_line(AREA, [60.0, 12.0], 45.0, &[], &[]);
        assert_eq!(free, [0.0, 31.0, 60.0, 43.0], "at the left, above its line");
    }

    #[test]
    fn a_label_stays_inside_and_off_other_labels() {
        let label = beside_line(AREA, [60.0, 12.0], 5.0, &[], &[]);
        assert!(label[1] >= 0.0, "below a line at the top: {label:?}");
        let other = beside_line(AREA, [60.0, 12.0], 10.0, &[], &[label]);
        assert!(!overlap(&label, &other), "{label:?} and {other:?}");
    }

    #[test]
    fn segments_meet_a_rectangle_only_if_they_touch_it() {
        let of = [10.0, 10.0, 20.0, 20.0];
        assert!(crosses(&of, [0.0, 15.0], [30.0, 15.0]));
        assert!(crosses(&of, [15.0, 15.0], [15.0, 15.0]));
        assert!(!crosses(&of, [0.0, 0.0], [30.0, 5.0]));
        assert!(!crosses(&of, [0.0, 25.0], [25.0, 50.0]));
    }
}
