//! What a module says of itself in one line that programs read.

use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::graph::Operations;

/// How the line begins.
const MARK: &str = "// gramforge: ";

/// What a module does not hold as constants; vectors are by joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// How the code computes the torque.
    pub form: String,
    /// The kept functions with their shares, see [`crate::reduction::shares`]; empty for the exact model.
    pub psi: Vec<(String, f64)>,
    /// Of a control step, or of one passivity torque without a controller.
    pub operations: Operations,
    /// The same with the exact model; `None` for a law that learns.
    pub exact_operations: Option<Operations>,
    /// Certified bound on the torque error, N·m or N.
    pub torque_error: Option<Vec<f64>>,
    /// The switching gain, N·m or N: the constant one, or a bound on the law's own.
    pub switching_gain: Option<Vec<f64>>,
    /// `sampled`, `continuous` or `none`; `None` without a controller.
    pub guarantee: Option<String>,
}

impl Facts {
    /// The line, without a line feed.
    ///
    /// # Errors
    /// [`Error::Internal`] for defects.
    pub(super) fn line(&self) -> Result<String, Error> {
        let json = serde_json::to_string(self).map_err(|error| Error::Internal(error.to_string()))?;
        Ok(format!("{MARK}{json}"))
    }

    /// What the text of a module says of itself; `None` where it says nothing.
    #[cfg(feature = "cli")]
    pub fn of_module(text: &str) -> Option<Self> {
        let line =
            text.lines().take_while(|line| line.starts_with("//")).find_map(|l| l.strip_prefix(MARK))?;
        serde_json::from_str(line).ok()
    }
}
