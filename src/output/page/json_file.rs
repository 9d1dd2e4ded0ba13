//! JSON files in a result folder.

use std::fs;
use std::path::Path;

use serde::de::DeserializeOwned;

use crate::error::Error;

/// The content of a JSON file; `None` if there is none.
///
/// # Errors
///
/// [`Error::Results`] if the file cannot be read, or holds something else.
pub fn read_if_there<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, Error> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(reason) => return Err(Error::results(path, reason.to_string())),
    };
    serde_json::from_str(&text)
        .map(Some)
        .map_err(|reason| Error::results(path, format!("not a result of this version: {reason}")))
}
