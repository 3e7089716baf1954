//! The loop about a step that is written out.
