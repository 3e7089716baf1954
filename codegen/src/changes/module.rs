//! A module as text, with what it says of itself.

use std::path::Path;

use super::numbers::{Numbers, numbers};
use crate::emit::Facts;
use crate::error::Error;
use crate::load::read_text;

/// A module that was read or generated.
#[derive(Clone, Debug)]
pub struct ModuleText {
    /// What it is called.
    pub name: String,
    /// Its text.
    pub text: String,
    /// What it says of itself.
    pub facts: Facts,
    /// The numbers in its constants and in its model.
    pub numbers: Numbers,
}

impl ModuleText {
    /// The module `text`, made from or read from `path`.
    ///
    /// # Errors
    /// [`Error::Input`] where it is no module of this generator.
    pub fn new(name: String, text: String, path: &Path) -> Result<Self, Error> {
        let help =
            "give a module that `gramforge generate` of this version has written, or its specification";
        let Some(facts) = Facts::of_module(&text) else {
            let problem = "has no line `// gramforge: …` that says what the module is";
            return Err(Error::input(path, "", problem, help));
        };
        let numbers = numbers(&text)
            .map_err(|error| Error::input(path, "", format!("is no Rust module ({error})"), help))?;
        Ok(Self { name, text, facts, numbers })
    }

    /// The module in the file at `path`.
    ///
    /// # Errors
    /// As [`ModuleText::new`], and where the file cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = read_text(path).map_err(|error| {
            Error::input(path, "", format!("cannot be read ({error})"), "give the path of a generated module")
        })?;
        Self::new(path.display().to_string(), text, path)
    }
}
