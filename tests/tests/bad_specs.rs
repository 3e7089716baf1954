//! One input for each class of mistake: one line that names file, field and mend, exit code 2, no file touched.

#[path = "bad_specs/arm.rs"]
mod arm;
#[path = "bad_specs/case.rs"]
mod case;
mod common;
#[path = "bad_specs/control.rs"]
mod control;
#[path = "bad_specs/design.rs"]
mod design;
#[path = "bad_specs/files.rs"]
mod files;
#[path = "bad_specs/input.rs"]
mod input;
#[path = "bad_specs/model.rs"]
mod model;
#[path = "bad_specs/motion.rs"]
mod motion;
#[path = "bad_specs/several.rs"]
mod several;
#[path = "bad_specs/shape.rs"]
mod shape;
#[path = "bad_specs/snapshots.rs"]
mod snapshots;
#[path = "bad_specs/uncertainty.rs"]
mod uncertainty;
#[path = "bad_specs/urdf.rs"]
mod urdf;
