//! Guarantees and their ingredients.
