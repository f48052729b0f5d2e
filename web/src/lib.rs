//! The core in a page: simulates a champion again, also with another friction, and evolves it further.
//!
//! The module imports nothing. The page writes a command as JSON into the [`input`] buffer, calls [`command`], and reads the answer
//! as JSON from [`output`].

mod commands;
mod evolution;
mod replay;

use std::cell::RefCell;

use commands::Page;

/// State of the module. Browsers run the module on a single thread.
struct Buffers {
    input: Vec<u8>,
    output: Vec<u8>,
    page: Page,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = const {
        RefCell::new(Buffers { input: Vec::new(), output: Vec::new(), page: Page::new() })
    };
}

/// Makes the input buffer `length` bytes long, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| {
        buffers.input.resize(length, 0);
        buffers.input.as_mut_ptr()
    })
}

/// Carries out the command in the input buffer, and returns the length of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn command() -> usize {
    BUFFERS.with_borrow_mut(|buffers| {
        let Buffers { input, output, page } = buffers;
        *output = page.answer(input).into_bytes();
        output.len()
    })
}

/// Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.output.as_ptr())
}
