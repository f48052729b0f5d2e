//! Quality of rendering, which is lower for software rendering.
//!
//! Without a graphics card, the CPU cores that run evolution also compute every sample of every pixel. Anti-aliasing
//! and sharp shadows are then too expensive.

use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;
use wgpu_types::DeviceType;

/// Quality settings of the renderer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quality {
    /// Number of anti-aliasing samples per pixel.
    pub msaa: Msaa,
    /// Side length of the shadow map, in pixels.
    pub shadow_map_pixels: usize,
}

impl Quality {
    /// Returns the quality settings for a type of device.
    pub fn of(device: DeviceType) -> Self {
        match device {
            DeviceType::Cpu => Self { msaa: Msaa::Off, shadow_map_pixels: 1024 },
            _ => Self { msaa: Msaa::Sample4, shadow_map_pixels: 2048 },
        }
    }

    /// Returns the quality settings for the renderer's adapter.
    pub fn for_adapter(adapter: &RenderAdapterInfo) -> Self {
        Self::of(adapter.0.device_type)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_software_rendering_lowers_the_quality() {
        assert_eq!(Quality::of(DeviceType::Cpu).msaa, Msaa::Off);
        for device in [DeviceType::DiscreteGpu, DeviceType::IntegratedGpu, DeviceType::Other] {
            assert_eq!(Quality::of(device).msaa, Msaa::Sample4);
        }
    }
}
