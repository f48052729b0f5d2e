//! How much the renderer is asked for: less where the processor has to draw.
//!
//! A machine without a graphics card draws every sample of every pixel on the cores that evolution
//! needs too. There, smooth edges and sharp shadows cost more than they show.

use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;
use wgpu_types::DeviceType;

/// What is asked of the renderer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quality {
    /// Samples per pixel, for smooth edges.
    pub msaa: Msaa,
    /// Pixels along a side of the shadow map.
    pub shadow_map_pixels: usize,
}

impl Quality {
    /// What suits the device that draws.
    pub fn of(device: DeviceType) -> Self {
        match device {
            DeviceType::Cpu => Self { msaa: Msaa::Off, shadow_map_pixels: 1024 },
            _ => Self { msaa: Msaa::Sample4, shadow_map_pixels: 2048 },
        }
    }

    /// What suits the adapter that the renderer chose.
    pub fn suiting(adapter: &RenderAdapterInfo) -> Self {
        Self::of(adapter.0.device_type)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_processor_is_asked_for_less() {
        assert_eq!(Quality::of(DeviceType::Cpu).msaa, Msaa::Off);
        for device in [DeviceType::DiscreteGpu, DeviceType::IntegratedGpu, DeviceType::Other] {
            assert_eq!(Quality::of(device).msaa, Msaa::Sample4);
        }
    }
}
