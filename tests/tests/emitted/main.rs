//! The generated modules, compiled: bits, signs, counts.

/// Includes a module that the build script has made, as a user's crate does; a warning in it is an error.
macro_rules! included {
    ($($name:ident)*) => {
        $(
            #[deny(warnings)]
            #[allow(dead_code, reason = "a test does not use the whole module")]
            #[rustfmt::skip]
            mod $name {
                include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
            }
        )*
    };
}

mod adaptive;
mod checked;
mod counts;
mod double;
mod fused;
mod generated_code;
mod single;
mod single_loop;
mod steps;
mod trig;
