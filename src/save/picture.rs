//! Writes pictures as PNG, tables as CSV, and plain text.

use std::path::Path;

use super::SaveError;
use super::files::write_whole;

/// A picture of red, green and blue bytes, row by row from the top left pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Three bytes for each pixel.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// A black picture.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, rgb: vec![0; width as usize * height as usize * 3] }
    }
}

/// Writes a picture as PNG, atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_picture(path: &Path, picture: &Picture) -> Result<(), SaveError> {
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&picture.rgb)?;
        Ok(bytes)
    };
    let bytes = encode().map_err(std::io::Error::other).map_err(SaveError::unwritable(path))?;
    write_whole(path, &bytes)
}

/// Writes a text atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_text(path: &Path, text: &str) -> Result<(), SaveError> {
    write_whole(path, text.as_bytes())
}

/// Writes records as CSV (RFC 4180), atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_csv(path: &Path, records: &[Vec<String>]) -> Result<(), SaveError> {
    let encode = || -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        records.iter().try_for_each(|record| writer.write_record(record))?;
        writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()).into())
    };
    let bytes = encode().map_err(std::io::Error::other).map_err(SaveError::unwritable(path))?;
    write_whole(path, &bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_picture_is_read_back_from_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let mut picture = Picture::new(3, 2);
        picture.rgb.iter_mut().zip(0..).for_each(|(byte, value)| *byte = value);
        store_picture(&path, &picture).expect("written");
        let file = std::io::BufReader::new(fs::File::open(&path).expect("there"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("small")];
        let info = reader.next_frame(&mut rgb).expect("a frame");
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(rgb, picture.rgb);
    }

    #[test]
    fn fields_with_commas_or_quotes_are_quoted() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.csv");
        let record = |words: [&str; 2]| words.map(str::to_owned).to_vec();
        store_csv(&path, &[record(["a", "b"]), record(["1", "x, \"y\""])]).expect("written");
        assert_eq!(fs::read_to_string(&path).expect("read"), "a,b\n1,\"x, \"\"y\"\"\"\n");
    }
}
