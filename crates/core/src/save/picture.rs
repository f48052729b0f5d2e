//! Writing of pictures as PNG, of tables as CSV, and of plain text.

use std::io::{Cursor, Write};
use std::path::Path;

use super::SaveError;
use super::files::read_bytes;
use super::whole_file::UnfinishedFile;
use crate::check::no_formula;

/// Maximum size of a picture that is read, in MiB: more than that of the largest window.
const LARGEST_PICTURE_MIB: u64 = 256;

/// A picture of red, green and blue bytes, row by row from the top left pixel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Three bytes for each pixel: red, green, blue.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Makes a black picture.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, rgb: vec![0; width as usize * height as usize * 3] }
    }
}

/// Writes a picture as PNG, atomically, and removes what a kill left in its folder.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_picture(path: &Path, picture: &Picture) -> Result<(), SaveError> {
    store_bytes(path, &encoded_picture(picture).map_err(SaveError::unwritable(path))?)
}

/// Encodes a picture as a PNG file.
///
/// # Errors
/// Fails if the picture's size does not fit its pixels.
pub fn encoded_picture(picture: &Picture) -> std::io::Result<Vec<u8>> {
    let encode = || -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(&picture.rgb)?;
        Ok(bytes)
    };
    encode().map_err(std::io::Error::other)
}

/// Reads a picture that [`store_picture`] wrote.
///
/// # Errors
/// Fails if the file cannot be read, or is not a picture of this form.
pub fn load_picture(path: &Path) -> Result<Picture, SaveError> {
    let bytes = read_bytes(path, LARGEST_PICTURE_MIB)?;
    let decode = || -> Result<Picture, png::DecodingError> {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info()?;
        let other = || std::io::Error::other("it is no picture of this program");
        let mut rgb = vec![0; reader.output_buffer_size().ok_or_else(other)?];
        let png::OutputInfo { width, height, color_type, bit_depth, .. } =
            reader.next_frame(&mut rgb)?;
        let is_own = (color_type, bit_depth) == (png::ColorType::Rgb, png::BitDepth::Eight);
        if is_own { Ok(Picture { width, height, rgb }) } else { Err(other().into()) }
    };
    decode().map_err(std::io::Error::other).map_err(SaveError::unreadable(path))
}

/// Writes a text atomically, and removes what a kill left in its folder.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_text(path: &Path, text: &str) -> Result<(), SaveError> {
    store_bytes(path, text.as_bytes())
}

fn store_bytes(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    let mut file = UnfinishedFile::create(path)?;
    file.write_all(bytes).map_err(SaveError::unwritable(path))?;
    file.finish()
}

/// Writes records as CSV (RFC 4180), atomically, and removes what a kill left in the folder. No cell is a formula: see [`no_formula`].
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_csv(path: &Path, records: &[Vec<String>]) -> Result<(), SaveError> {
    store_bytes(path, &encoded_csv(records).map_err(SaveError::unwritable(path))?)
}

/// Encodes records as a CSV file (RFC 4180). No cell is a formula: see [`no_formula`].
///
/// # Errors
/// Fails if the records have different lengths.
pub fn encoded_csv(records: &[Vec<String>]) -> std::io::Result<Vec<u8>> {
    let encode = || -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for record in records {
            writer.write_record(record.iter().map(|cell| no_formula(cell).into_owned()))?;
        }
        writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()).into())
    };
    encode().map_err(std::io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::files::names_in;
    use std::fs;

    #[test]
    fn f12_texts_tables_and_pictures_remove_what_a_kill_left() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a");
        let store: [&dyn Fn() -> Result<(), SaveError>; 3] =
            [&|| store_text(&path, "text"), &|| store_csv(&path, &[]), &|| {
                store_picture(&path, &Picture::new(1, 1))
            }];
        for store in store {
            fs::write(folder.path().join(".unfinished-snakes-Ab12Cd"), "half").expect("written");
            store().expect("written");
            assert_eq!(names_in(folder.path()), ["a"]);
        }
    }

    #[test]
    fn a_picture_is_read_back_from_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        let mut picture = Picture::new(3, 2);
        picture.rgb.iter_mut().zip(0..).for_each(|(byte, value)| *byte = value);
        store_picture(&path, &picture).expect("written");
        assert_eq!(load_picture(&path).expect("a PNG"), picture);
        fs::write(&path, "no picture").expect("written");
        let refusal = load_picture(&path).expect_err("refused").to_string();
        assert!(refusal.contains("a.png: cannot be read"), "{refusal}");
    }

    #[test]
    fn f13_fields_with_commas_or_quotes_are_quoted_and_none_is_a_formula() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.csv");
        let record = |words: [&str; 2]| words.map(str::to_owned).to_vec();
        let records = [["a", "b"], ["-1", "x, \"y\""], ["=1+1", "NA"]].map(record);
        store_csv(&path, &records).expect("written");
        let text = fs::read_to_string(&path).expect("read");
        assert_eq!(text, "a,b\n-1,\"x, \"\"y\"\"\"\n'=1+1,NA\n");
    }
}
