//! Cost of a frame: CPU time of the main thread and wall time, over a given number of frames.

use std::io;
use std::io::Write;
use std::time::{Duration, Instant};

use bevy::ecs::system::NonSendMarker;
use bevy::prelude::*;

/// Measured costs of consecutive frames.
#[derive(Resource, Debug)]
struct FrameTimes {
    frames: u32,
    last: Option<(Duration, Instant)>,
    cpu: Vec<Duration>,
    wall: Vec<Duration>,
}

/// Number of frames that are not measured. The first ones compile pipelines and upload textures, so they are not typical.
const WARM_UP_FRAMES: usize = 20;

/// Measures `frames` frames, prints the cost of a frame, and closes the window.
pub(crate) fn plugin(app: &mut App, frames: u32) {
    let times = FrameTimes { frames, last: None, cpu: Vec::new(), wall: Vec::new() };
    app.insert_resource(times).add_systems(First, measure);
}

/// Measures a frame. `NonSendMarker` keeps the system on the main thread, whose CPU time it reads.
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
        // A failure to write to standard error cannot be reported anywhere else.
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

/// Returns the CPU time of the calling thread so far.
#[cfg(unix)]
fn main_thread_cpu() -> Duration {
    use nix::time::{ClockId, clock_gettime};
    clock_gettime(ClockId::CLOCK_THREAD_CPUTIME_ID).map_or(Duration::ZERO, Duration::from)
}

/// Returns zero, because other systems have no portable CPU time of a thread.
#[cfg(not(unix))]
fn main_thread_cpu() -> Duration {
    Duration::ZERO
}
