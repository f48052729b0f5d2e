//! Screenshots of the display.

use std::path::Path;

use super::places::Area;

/// A screenshot of the display.
pub struct Picture {
    width: i32,
    pixels: Vec<[u8; 3]>,
    /// Area that shows only the scene, without panels, cards and messages.
    pub scene: Area,
}

impl Picture {
    /// Reads the XWD file in which Xvfb keeps its screen: a header of big-endian words, a colour map, and rows of 32-bit pixels
    /// with blue in the lowest byte.
    pub fn of_xwd(file: &[u8], scene: Area) -> Self {
        let word = |index: usize| {
            let bytes = file[index * 4..index * 4 + 4].try_into().expect("four bytes");
            u32::from_be_bytes(bytes)
        };
        let (header, width, height) = (word(0) as usize, word(4), word(5));
        let (bits, row_bytes, colours) = (word(11), word(12) as usize, word(19) as usize);
        assert_eq!(bits, 32, "Xvfb at depth 24 has pixels of 32 bits");
        let rows = &file[header + colours * 12..];
        let pixels = rows
            .chunks_exact(row_bytes)
            .take(height as usize)
            .flat_map(|row| row.chunks_exact(4).take(width as usize))
            .map(|pixel| [pixel[2], pixel[1], pixel[0]])
            .collect();
        Self { width: width as i32, pixels, scene }
    }

    /// Returns the pixels of the scene.
    pub fn scene_pixels(&self) -> Vec<[u8; 3]> {
        self.region(self.scene)
    }

    /// Counts the pixels of the scene that meet a condition.
    pub fn count(&self, is: fn(&[u8; 3]) -> bool) -> usize {
        self.scene_pixels().iter().filter(|pixel| is(pixel)).count()
    }

    /// Returns the centre of a square of the scene in which all pixels meet a condition; `None` if there is none.
    pub fn find(&self, is: fn(&[u8; 3]) -> bool) -> Option<(i32, i32)> {
        const SIDE: i32 = 9;
        let Area { left, top, right, bottom } = self.scene;
        let corners = (top..bottom - SIDE)
            .step_by(3)
            .flat_map(|y| (left..right - SIDE).step_by(3).map(move |x| (x, y)));
        let square = |x: i32, y: i32| Area { left: x, top: y, right: x + SIDE, bottom: y + SIDE };
        let mut squares = corners.filter(|&(x, y)| self.region(square(x, y)).iter().all(is));
        squares.next().map(|(x, y)| (x + SIDE / 2, y + SIDE / 2))
    }

    /// Returns the mean brightness of a rectangle, from 0 to 255.
    pub fn brightness(&self, area: Area) -> u32 {
        let pixels = self.region(area);
        let sum: u32 = pixels.iter().flatten().map(|part| u32::from(*part)).sum();
        sum / (3 * pixels.len().max(1) as u32)
    }

    /// Writes the picture as PNG.
    pub fn store(&self, path: &Path) {
        let width = self.width as u32;
        let height = self.pixels.len() as u32 / width;
        let rgb = self.pixels.iter().flatten().copied().collect();
        let picture = snakes_core::save::Picture { width, height, rgb };
        snakes_core::save::store_picture(path, &picture).expect("written");
    }

    /// Returns the pixels of a rectangle, row by row, as red, green and blue.
    pub fn region(&self, area: Area) -> Vec<[u8; 3]> {
        let row = |y: i32| {
            let start = (y * self.width + area.left) as usize;
            &self.pixels[start..start + area.width() as usize]
        };
        (area.top..area.bottom).flat_map(row).copied().collect()
    }
}

/// Returns whether a pixel has the red of the snake.
pub fn is_red(&[red, green, blue]: &[u8; 3]) -> bool {
    red > 90 && u32::from(red) > 2 * u32::from(green) && u32::from(red) > 2 * u32::from(blue)
}

/// Returns whether a pixel has the blue of the snake.
pub fn is_blue(&[red, green, blue]: &[u8; 3]) -> bool {
    blue > 90 && u32::from(blue) * 2 > 3 * u32::from(green) && u32::from(blue) > 2 * u32::from(red)
}

/// Counts the pixels of the scene that differ between two pictures.
pub fn difference(before: &Picture, after: &Picture) -> usize {
    let after = after.region(before.scene);
    before.scene_pixels().iter().zip(after).filter(|(a, b)| **a != *b).count()
}
