//! Reading and writing through pointers that come from C: all of the unsafe code but the exported names.
#![expect(unsafe_code, reason = "C passes pointers, whose validity only the caller can know: the header states it")]

use std::ffi::{CStr, CString, c_char};

/// A text of the caller.
///
/// # Errors
///
/// It is null, or not UTF-8.
pub fn text(pointer: *const c_char) -> Result<String, String> {
    if pointer.is_null() {
        return Err("a text: found null".to_owned());
    }
    // SAFETY: not null; the header requires a text that ends with a zero byte.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map(str::to_owned).map_err(|_| "a text: found bytes that are not UTF-8".to_owned())
}

/// Writes as much of `text` as there is room for, and a zero byte.
pub fn write_text(pointer: *mut c_char, size: usize, text: &str) {
    if pointer.is_null() || size == 0 {
        return;
    }
    let length = text.floor_char_boundary(size - 1);
    // SAFETY: the header requires room for `size` bytes, of which `length + 1` are written.
    unsafe {
        std::ptr::copy_nonoverlapping(text.as_ptr().cast(), pointer, length);
        pointer.add(length).write(0);
    }
}

/// The value behind a pointer; `None` for null.
pub fn exclusive<'a, T>(pointer: *mut T) -> Option<&'a mut T> {
    // SAFETY: the header requires a valid pointer, to which nothing else has access during the call.
    unsafe { pointer.as_mut() }
}

/// The values behind a pointer; none for null.
pub fn list<'a, T>(pointer: *const T, count: usize) -> &'a [T] {
    if pointer.is_null() || count == 0 {
        return &[];
    }
    // SAFETY: not null; the header requires `count` values.
    unsafe { std::slice::from_raw_parts(pointer, count) }
}

/// Frees what a `Box` holds; null is nothing.
pub fn free<T>(pointer: *mut T) {
    if !pointer.is_null() {
        // SAFETY: the header requires a pointer that this library returned and that is not used afterwards.
        drop(unsafe { Box::from_raw(pointer) });
    }
}

/// Frees a text that this library returned; null is nothing.
pub fn free_text(pointer: *mut c_char) {
    if !pointer.is_null() {
        // SAFETY: as for `free`.
        drop(unsafe { CString::from_raw(pointer) });
    }
}
