//! The step against the runtime's laws.
