//! The JSON of a run: read strictly, with the file, line, column and path of what is wrong.

mod json;
mod set;
pub mod text;
