//! Files for other people's tools.

pub mod tum;
