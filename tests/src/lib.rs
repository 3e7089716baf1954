//! Integration tests of Gramforge live in `tests/`.
