//! A drawing of a climb from the side at equal intervals of time, as SVG, which needs no script.

use std::fmt::Write;

use super::data::PageChampion;

/// Number of moments that the drawing shows.
const MOMENTS: usize = 9;
/// Width and height of the drawing, in its own units.
const SIZE: [f32; 2] = [960.0, 540.0];

/// Draws the first champion; empty without champions.
pub fn of(champions: &[PageChampion]) -> String {
    champions.first().map(drawing).unwrap_or_default()
}

fn drawing(champion: &PageChampion) -> String {
    let frames = &champion.drawn;
    let last = frames.len().saturating_sub(1);
    let moments: Vec<&Vec<[f32; 7]>> =
        (0..MOMENTS).filter_map(|moment| frames.get(last * moment / (MOMENTS - 1))).collect();
    let ys = moments.iter().flat_map(|limbs| limbs.iter()).map(|pose| pose[1]);
    let (least, most) =
        ys.fold((f32::MAX, f32::MIN), |(least, most), y| (least.min(y), most.max(y)));
    let (left_m, right_m) = (least - 3.0, most + 3.0);
    let scale = SIZE[0] / (right_m - left_m).max(1.0);
    let ground = SIZE[1] * 0.86;
    let place = |y_m: f32, z_m: f32| ((y_m - left_m) * scale, ground - z_m * scale);
    let mut svg = format!(
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"The climb from the side, at {MOMENTS} moments\" \
         preserveAspectRatio=\"xMidYMid slice\">\n<rect width=\"100%\" height=\"100%\" fill=\"#e3edf5\"/>\n\
         <rect y=\"{ground}\" width=\"100%\" height=\"100%\" fill=\"#bac7c7\"/>\n",
        SIZE[0], SIZE[1]
    );
    let mut add = |text: std::fmt::Arguments| {
        // Writing to a string cannot fail.
        let _ = svg.write_fmt(text);
    };
    if let (Some([first_m, _]), Some([last_m, _])) =
        (champion.outline.first(), champion.outline.last())
    {
        let feet = [[*last_m, 0.0], [*first_m, 0.0]];
        let corners = champion.outline.iter().chain(&feet);
        let corners: Vec<String> = corners
            .map(|[y_m, z_m]| {
                let (x, y) = place(*y_m, *z_m);
                format!("{x:.1},{y:.1}")
            })
            .collect();
        add(format_args!("<polygon points=\"{}\" fill=\"#cfccc7\"/>\n", corners.join(" ")));
    }
    for (moment, limbs) in moments.iter().enumerate() {
        let opacity = 0.25 + 0.75 * moment as f32 / (MOMENTS - 1) as f32;
        for (limb, (pose, size)) in champion.limbs.iter().zip(limbs.iter().zip(&champion.parts)) {
            let [_, y, z, qx, qy, qz, qw] = *pose;
            // Axes of the limb along its length and upwards, seen from the side.
            let along = [1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz + qx * qw)];
            let up = [2.0 * (qy * qz - qx * qw), 1.0 - 2.0 * (qx * qx + qy * qy)];
            let corners = [[0.5, 0.5], [0.5, -0.5], [-0.5, -0.5], [-0.5, 0.5]].map(|[a, b]| {
                let (a, b) = (a * size[1] * 0.97, b * size[2]);
                let (x, y) = place(y + along[0] * a + up[0] * b, z + along[1] * a + up[1] * b);
                format!("{x:.1},{y:.1}")
            });
            let color = if limb % 2 == 0 { "#db211f" } else { "#1a45d6" };
            add(format_args!(
                "<polygon points=\"{}\" fill=\"{color}\" fill-opacity=\"{opacity:.2}\"/>\n",
                corners.join(" ")
            ));
        }
    }
    svg + "</svg>"
}
