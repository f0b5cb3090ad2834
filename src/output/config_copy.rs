//! `config.json`: the config as run, with the files of spins that it names.

use super::disk::File;
use super::{Format, INPUTS, RunReport};
use crate::error::Result;

/// The config as run.
#[derive(Clone, Copy, Debug)]
pub struct ConfigCopy;

impl Format for ConfigCopy {
    fn file_name(&self) -> String {
        "config.json".into()
    }

    fn folder(&self) -> Option<&'static str> {
        Some(INPUTS)
    }

    fn companions(&self, run: &RunReport) -> Result<Vec<File>> {
        Ok(run.inputs.to_vec())
    }

    fn render(&self, run: &RunReport) -> Result<Vec<u8>> {
        Ok(run.config_text.as_bytes().to_vec())
    }
}
