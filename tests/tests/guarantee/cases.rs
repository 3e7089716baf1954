//! The cases that are attacked at length.

use super::arms::{Case, FAST, PLAIN};

/// A case and by how many times what is promised may exceed what is found: reach, settled error, torque.
pub type Named = (Case, [f64; 3]);

const TIGHT: [f64; 3] = [1.05, 1.4, 1.15];
const BARE: [f64; 3] = [1.15, 1.4, 1.15];
const LOADED: [f64; 3] = [1.05, 1.6, 1.15];

/// Cases whose claims must be near what runs find.
pub fn named() -> Vec<Named> {
    let of = |name: &'static str, arm: &'static str| Case { name, arm, ..PLAIN };
    let fast = |name: &'static str, arm: &'static str| Case { name, arm, ..FAST };
    let robust = |name, arm, law| Case { law, tolerance: 0.01, ..of(name, arm) };
    let loaded = |name, arm| Case { payload: 0.2, ..of(name, arm) };
    let bare = |name, arm| Case { armature: false, ..of(name, arm) };
    vec![
        (PLAIN, TIGHT),
        (of("puma560 exact", "puma560"), TIGHT),
        (of("ur5 exact", "ur5"), TIGHT),
        (of("stanford exact", "stanford"), TIGHT),
        (of("panda exact", "panda"), TIGHT),
        (fast("threedof fast", "threedof"), TIGHT),
        (fast("puma560 fast", "puma560"), TIGHT),
        (fast("ur5 fast", "ur5"), TIGHT),
        (fast("stanford fast", "stanford"), TIGHT),
        (fast("panda fast", "panda"), TIGHT),
        (robust("threedof report", "threedof", "report"), TIGHT),
        (robust("puma560 report", "puma560", "report"), TIGHT),
        (robust("ur5 report", "ur5", "report"), TIGHT),
        (robust("stanford tight", "stanford", "tight"), TIGHT),
        (robust("threedof tight", "threedof", "tight"), TIGHT),
        (robust("ur5 exact law, 1 %", "ur5", "exact"), TIGHT),
        (loaded("threedof payload", "threedof"), LOADED),
        (loaded("puma560 payload", "puma560"), LOADED),
        (loaded("ur5 payload", "ur5"), LOADED),
        (bare("puma560 bare", "puma560"), BARE),
        (bare("ur5 bare", "ur5"), BARE),
        (bare("panda bare", "panda"), BARE),
        (loaded("stanford payload", "stanford"), LOADED),
        (robust("panda report", "panda", "report"), TIGHT),
    ]
}

/// Other cases.
pub fn others() -> Vec<Case> {
    let of = |name: &'static str, arm: &'static str| Case { name, arm, ..PLAIN };
    vec![
        Case { payload: 0.2, ..of("panda payload", "panda") },
        Case { period: 8e-3, ..of("ur5 8 ms", "ur5") },
        Case { period: 4e-3, law: "tight", tolerance: 0.01, ..of("puma560 tight 4 ms", "puma560") },
        Case { armature: false, initial: 0.03, ..of("ur5 bare 0.03", "ur5") },
    ]
}
