//! Complete specifications of known arms.

use clap::ValueEnum;

/// An arm whose numbers come with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Example {
    /// The three-link arm of the 1992 report, with drives.
    Arm3,
    /// A PUMA 560 from its DH table, with motors and friction.
    Puma560,
    /// A Panda of seven joints from a URDF file.
    Panda,
}

/// The files of `example`, each with its name; the first is the specification.
pub fn example(example: Example) -> &'static [(&'static str, &'static str)] {
    match example {
        Example::Arm3 => &[("arm3.jsonc", include_str!("../../specs/arm3.jsonc"))],
        Example::Puma560 => &[("puma560.jsonc", include_str!("../../specs/puma560.jsonc"))],
        Example::Panda => &[
            ("panda.jsonc", include_str!("../../specs/panda.jsonc")),
            ("panda.urdf", include_str!("../../specs/panda.urdf")),
        ],
    }
}
