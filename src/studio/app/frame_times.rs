//! Cost of a frame: CPU time of the main thread and wall time, over a given number of frames.

use std::io;
use std::io::Write;
use std::time::{Duration, Instant};

use bevy::ecs::system::NonSendMarker;
use bevy::prelude::*;

/// Measurements of consecutive frames.
#[derive(Resource, Debug)]
struct FrameTimes {
    frames: u32,
    last: Option<(Duration, Instant)>,
    cpu: Vec<Duration>,
    wall: Vec<Duration>,
}

/// Skipped frames. The first ones compile pipelines and upload textures, so they are not typical.
const WARM_UP_FRAMES: usize = 20;

/// Closes the window after `frames` frames and prints the cost of a frame.
pub(crate) fn plugin(app: &mut App, frames: u32) {
    let times = FrameTimes { frames, last: None, cpu: Vec::new(), wall: Vec::new() };
    app.insert_resource(times).add_systems(First, measure);
}

/// The `NonSendMarker` keeps this system on the main thread, whose clock it reads.
fn measure(_: NonSendMarker, mut times: ResMut<FrameTimes>, mut exit: MessageWriter<AppExit>) {
    let now = (main_thread_cpu(), Instant::now());
    if let Some((cpu, wall)) = times.last.replace(now) {
        times.cpu.push(now.0.saturating_sub(cpu));
        times.wall.push(now.1 - wall);
    }
    if times.cpu.len() as u32 == times.frames {
        let skipped = WARM_UP_FRAMES.min(times.cpu.len() / 2);
        let cpu = summary(&mut times.cpu[skipped..]);
        let wall = summary(&mut times.wall[skipped..]);
        // Writing to standard error may fail. There is no other place to report that.
        let _ =
            writeln!(io::stderr(), "main thread CPU per frame: {cpu}\nwall time per frame: {wall}");
        exit.write(AppExit::Success);
    }
}

fn summary(times: &mut [Duration]) -> String {
    times.sort();
    let at = |share: f64| {
        let index = ((times.len() - 1) as f64 * share) as usize;
        times[index].as_secs_f64() * 1000.0
    };
    let (median, p95, most) = (at(0.5), at(0.95), at(1.0));
    format!(
        "median {median:.2} ms, 95th percentile {p95:.2} ms, maximum {most:.2} ms over {} frames",
        times.len()
    )
}

/// CPU time of the calling thread so far.
#[cfg(unix)]
fn main_thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

/// Other systems have no portable thread clock; the figure is zero.
#[cfg(not(unix))]
fn main_thread_cpu() -> Duration {
    Duration::ZERO
}
