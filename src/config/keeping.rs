//! Where a computation is recorded while it goes on, so that it can go on after an interruption.

use super::{Loaded, VERSION};
use crate::error::Result;
use crate::record::Checkpoint;
use std::path::Path;
use std::time::Duration;

/// What is done with the checkpoint in the folder of a result.
#[derive(Clone, Copy, Debug)]
pub struct Keeping {
    /// How often it is written; nothing writes none.
    pub every: Option<Duration>,
    /// Go on from what is there.
    pub resume: bool,
    /// Start anew where that cannot be.
    pub force: bool,
}

impl Default for Keeping {
    /// What the command line does if nothing is said.
    fn default() -> Keeping {
        Keeping { every: Some(Duration::from_secs(30)), resume: false, force: false }
    }
}

/// Says a line to the user.
pub type Say = Box<dyn FnMut(&str) + Send>;

impl Loaded {
    /// Where a computation is recorded, if that is asked for, with what it goes on from. Whether it is or not, the checkpoint of another
    /// config gives way only by force. `speaker` makes what tells the user of it.
    pub fn checkpoint(
        &self,
        directory: &Path,
        keeping: &Keeping,
        speaker: impl Fn() -> Say,
    ) -> Result<Option<Checkpoint>> {
        let every = keeping.every;
        let new = || Checkpoint::new(directory, VERSION, &self.sha256, every.unwrap_or_default(), speaker());
        let mut say = speaker();
        let found = if keeping.resume && every.is_some() { new().resume() } else { new().anew() };
        let checkpoint = match found {
            Err(e) if keeping.force => {
                say(&format!("starting anew: {e}"));
                new()
            }
            found => found?,
        };
        if !checkpoint.is_empty() {
            say(&format!("going on from the checkpoint, with {} finished steps", checkpoint.len()));
        }
        Ok(every.map(|_| checkpoint))
    }
}
