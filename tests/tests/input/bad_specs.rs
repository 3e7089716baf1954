//! One input for each class of mistake: one line that names file, field and help, exit code 2, no file touched.

mod arm;
mod c_api;
mod case;
mod control;
mod design;
mod files;
mod input;
mod model;
mod motion;
mod several;
mod shape;
mod single;
mod snapshots;
mod uncertainty;
mod urdf;
