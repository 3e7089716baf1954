//! Calls one function at every state, in the modes of `native/harness.c`.

use std::hint::black_box;
use std::time::Instant;

/// Prints one torque a state, or calls once for each state, or, for each line of standard input, a number of rounds,
/// prints the nanoseconds of a call.
pub fn drive<S, const N: usize>(states: &[S], mut measured: impl FnMut(&S) -> [f64; N], mode: &str) {
    let mut pass = || {
        for state in states {
            black_box(measured(black_box(state)));
        }
    };
    match mode {
        "count" => pass(),
        "time" => {
            for line in std::io::stdin().lines() {
                let rounds: usize = line.expect("a line").trim().parse().expect("a number of rounds");
                let start = Instant::now();
                (0..rounds).for_each(|_| pass());
                println!("{}", start.elapsed().as_nanos() as f64 / (rounds * states.len()) as f64);
            }
        }
        _ => {
            for state in states {
                println!("{}", measured(state).map(|x| format!("{x:e}")).join(" "));
            }
        }
    }
}

/// Reads name, states and mode from the command line.
pub fn main(run: fn(&str, &[f64], &str)) {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, name, path, mode] = &arguments[..] else { panic!("NAME STATES MODE") };
    let text = std::fs::read_to_string(path).expect("the states");
    let numbers: Vec<f64> = text.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    run(name, &numbers, mode);
}
