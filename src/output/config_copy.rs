//! `config.json`: the config as run.

use super::{Format, RunReport};
use crate::error::Result;

/// The config as run.
#[derive(Clone, Copy, Debug)]
pub struct ConfigCopy;

impl Format for ConfigCopy {
    fn file_name(&self) -> String {
        "config.json".into()
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        Ok(run.config_text.as_bytes().to_vec())
    }
}
