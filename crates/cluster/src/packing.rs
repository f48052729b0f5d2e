//! The bytes of a message: text, which is compressed if it is long.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::wire::WireError;

/// Size from which text is compressed, in bytes. Learned tables and rules become several times smaller. Compressing
/// shorter text would cost more time than it saves.
const COMPRESSED_FROM: usize = 64 * 1024;
/// Maximum size of a message's text, in bytes.
pub const LARGEST_TEXT: usize = 32 * 1024 * 1024;
/// First byte of compressed text. Plain text begins with a brace instead.
const COMPRESSED: u8 = 0x78;

/// Encodes a text as the bytes of a message.
pub fn pack(text: String) -> Vec<u8> {
    if text.len() < COMPRESSED_FROM {
        return text.into_bytes();
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    // Writing into memory cannot fail.
    match encoder.write_all(text.as_bytes()).and_then(|()| encoder.finish()) {
        Ok(bytes) => bytes,
        Err(_) => text.into_bytes(),
    }
}

/// Decodes the bytes of a message into text.
///
/// # Errors
/// The bytes are no text, or more than `LARGEST_TEXT`.
pub fn unpack(bytes: &[u8]) -> Result<String, WireError> {
    let bytes = if bytes.first() == Some(&COMPRESSED) {
        let mut text = Vec::new();
        let mut limited = ZlibDecoder::new(bytes).take(LARGEST_TEXT as u64 + 1);
        limited.read_to_end(&mut text).map_err(|error| WireError::Damaged(error.to_string()))?;
        text
    } else {
        bytes.to_vec()
    };
    if bytes.len() > LARGEST_TEXT {
        return Err(WireError::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| WireError::Damaged(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_text_is_compressed_and_read_again_and_a_bomb_is_refused() {
        for length in [1, COMPRESSED_FROM, 10 * COMPRESSED_FROM] {
            let text = "{".repeat(length);
            let bytes = pack(text.clone());
            assert_eq!(bytes.len() < text.len(), length >= COMPRESSED_FROM);
            assert_eq!(unpack(&bytes).expect("read"), text);
        }
        let bomb = pack("{".repeat(LARGEST_TEXT + 1));
        assert!(bomb.len() < 1_000_000);
        assert!(matches!(unpack(&bomb), Err(WireError::TooLarge)));
        assert!(matches!(unpack(&[COMPRESSED, 1, 2, 3]), Err(WireError::Damaged(_))));
        assert!(matches!(unpack(&[0xff, 0xfe]), Err(WireError::Damaged(_))));
    }
}
