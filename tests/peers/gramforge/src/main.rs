//! Runs one generated module over all states, as `native/harness.c` does for the peers:
//!
//! ```text
//! gramforge-peers ARM STATES torques      prints one torque a line
//! gramforge-peers ARM STATES count        calls once for each state, for callgrind
//! gramforge-peers ARM STATES time         for each line of standard input, a number of rounds: ns a call
//! ```

use std::hint::black_box;

mod drive;

/// q, q̇, v_r, a_r.
type State<const N: usize> = [[f64; N]; 4];

/// Includes each module, with the call that is measured.
macro_rules! arms {
    ($($name:ident $model:ident $joints:literal)*) => {
        $(
            #[allow(dead_code)]
            mod $name {
                include!(concat!(env!("GRAMFORGE_MODULES"), "/", stringify!($name), ".rs"));

                /// Not inlined, as calls across object files are not; its name is what callgrind counts by.
                #[inline(never)]
                pub fn measured([q, qd, v_r, a_r]: &crate::State<$joints>) -> [f64; $joints] {
                    gramforge_runtime::Model::passivity_torque(&$model, q, qd, v_r, a_r)
                }
            }
        )*

        fn run(name: &str, numbers: &[f64], mode: &str) {
            match name {
                // By a pointer, so that the caller cannot change how it is called.
                $(stringify!($name) => drive::drive(&states(numbers), black_box($name::measured as fn(&_) -> _), mode),)*
                _ => panic!("no arm {name}"),
            }
        }
    };
}

// `arms! { MODULE TYPE JOINTS … }` for every module that compare.py has generated.
include!(concat!(env!("GRAMFORGE_MODULES"), "/arms.rs"));

fn states<const N: usize>(numbers: &[f64]) -> Vec<State<N>> {
    let state = |line: &[f64]| std::array::from_fn(|i| std::array::from_fn(|j| line[i * N + j]));
    numbers.chunks_exact(4 * N).map(state).collect()
}

fn main() {
    drive::main(run);
}
