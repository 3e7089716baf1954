//! What is promised of all arms with all laws, models, motions and periods; and what runs do where nothing is.

use std::time::Instant;

use gramforge::Generation;
use gramforge::internals::guarantee::Kind;
use serde_json::json;

use super::arms::{Case, FAST, PLAIN};
use super::attack::{at_rest, attacked, attacks};
use super::frozen::Frozen;
use super::looped::Loop;

/// The part of the longest period of a stable frozen loop up to which periods count.
const OF_LIMIT: f64 = 0.9;
/// Part of the laws and models beside the exact law with rotors that must have a promise.
const MOST: f64 = 0.8;

/// All of them, from an error of 0.01.
fn cases() -> Vec<Case> {
    let mut out = Vec::new();
    for arm in ["threedof", "puma560", "ur5", "stanford", "panda"] {
        for (tolerance, law) in
            [0.0, 0.01].into_iter().flat_map(|t| ["exact", "report", "tight"].map(|l| (t, l)))
        {
            for motion in [PLAIN, FAST] {
                let case = Case { name: arm, arm, tolerance, law, ..motion };
                out.extend([1e-3, 2e-3, 4e-3, 8e-3].map(|period| Case { period, ..case }));
                if matches!((arm, law), ("ur5" | "panda", _) | ("puma560", "exact")) {
                    out.push(Case { armature: false, ..case });
                }
            }
        }
    }
    out
}

/// Whether the case counts: at 1 ms, or where the frozen loop is stable with a period `1 / OF_LIMIT` times as long.
fn counts(own: &Loop, case: &Case) -> bool {
    case.period <= 1e-3 || Frozen::new(own).stable(case.period / OF_LIMIT)
}

/// What some runs do where nothing is promised.
fn simulated(own: &Loop, case: &Case) -> String {
    let found = attacked(own, &attacks(own, &at_rest(case.initial), 24));
    let most =
        found.reach[..own.n].iter().fold(0.0_f64, |most, x| if x.is_nan() { *x } else { most.max(*x) });
    format!("runs reach {most:.3e} in a tube of {}", case.tube)
}

/// A row of the table, and whether the loop counts and has a promise.
fn judged(case: &Case) -> (String, Option<bool>) {
    let start = Instant::now();
    let row = |kind: &str, rest: &str| {
        let Case { arm, tolerance, law, period, duration, armature, .. } = case;
        let seconds = start.elapsed().as_secs_f64();
        format!(
            "| {arm} | {armature} | {tolerance} | {law} | {period} | {duration} | {kind} | {seconds:.1} | {rest} |"
        )
    };
    let made: Result<Generation, String> =
        case.made(|spec| spec["control"]["allow_long_period"] = json!(true));
    let generation = match made {
        Ok(generation) => generation,
        Err(message) => return (row("refused", &message.replace('\n', " ")), Some(false)),
    };
    let statement = generation.statement().expect("a statement");
    if statement.kind == Kind::Sampled {
        return (row("sampled", ""), Some(true));
    }
    let own = Loop::without_promise(&generation, &case.chain(), &case.family(), case.settle);
    let reason = statement.reasons.first().map_or("", String::as_str);
    if !counts(&own, case) {
        return (row(statement.kind.name(), "beyond the limit of the frozen loop"), None);
    }
    (row(statement.kind.name(), &format!("{reason}; {}", simulated(&own, case))), Some(false))
}

/// `SURVEYED` chooses arms by name.
#[test]
#[ignore = "takes half an hour"]
fn nearly_all_loops_have_a_promise() {
    let only = std::env::var("SURVEYED").unwrap_or_default();
    println!("| arm | rotors | tolerance | law | period | motion | kind | s | why |");
    let (mut faults, mut held, mut all) = (Vec::new(), 0, 0);
    for case in cases().iter().filter(|case| case.arm.contains(&only)) {
        let (row, promised) = judged(case);
        println!("{row}");
        let Some(promised) = promised else { continue };
        if case.armature && case.law == "exact" {
            if !promised {
                faults.push(row);
            }
        } else {
            all += 1;
            held += usize::from(promised);
        }
    }
    println!("{held} of {all} with other laws, or without rotors");
    assert!(faults.is_empty(), "{faults:#?}");
    assert!(held as f64 >= MOST * f64::from(all), "{held} of {all}");
}
