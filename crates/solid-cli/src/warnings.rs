//! Warnings, and how many there were.

use std::fmt::Display;

use anyhow::{Result, ensure};

use crate::complain;

/// Tells of what was passed over or guessed.
#[derive(Debug, Default)]
pub struct Warnings {
    told: usize,
}

impl Warnings {
    /// Tells of something, in a line on standard error.
    pub fn tell(&mut self, warning: impl Display) {
        self.told += 1;
        complain("warning", warning);
    }

    /// The same of all of some.
    pub fn tell_all(&mut self, warnings: impl IntoIterator<Item = impl Display>) {
        warnings.into_iter().for_each(|warning| self.tell(warning));
    }

    /// An error if there was one.
    pub fn refuse(&self) -> Result<()> {
        let be = if self.told == 1 { "is 1 warning" } else { &format!("are {} warnings", self.told) };
        ensure!(self.told == 0, "there {be}, which --strict does not allow");
        Ok(())
    }
}
