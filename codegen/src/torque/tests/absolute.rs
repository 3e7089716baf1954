//! Models in absolute angles: the same torque, with shorter coefficients where axes are parallel.

use std::sync::Arc;

use super::{arm, error, random_arm};
use crate::arm::Arm;
use crate::lagrangian::{Absolute, Coordinates, Lagrangian, expand};
use crate::reduction::{CandidateFunction, Group, Sparse, plus};
use crate::torque::sparse;

/// The exact model, written coefficient by coefficient.
fn written(lagrangian: &Lagrangian, absolute: Absolute) -> Sparse {
    let functions = (0..lagrangian.functions.len()).map(CandidateFunction::harmonic).collect();
    let own = absolute.lagrangian.coefficients.iter().enumerate();
    let groups = own.map(|(m, c)| Group { members: vec![(m, 1.0)], terms: c.terms.clone() }).collect();
    Sparse { functions, groups, absolute: Some(Arc::new(absolute)) }
}

fn checked(arm: &Arm, coordinates: Coordinates, name: &str) {
    let lagrangian = expand(arm);
    let absolute = Absolute::new(&lagrangian, coordinates).expect(name);
    let largest =
        |l: &Lagrangian| l.coefficients.iter().flat_map(|c| &c.terms).fold(0.0_f64, |m, t| m.max(t.1.abs()));
    let size = largest(&lagrangian) + largest(&absolute.lagrangian);
    for (coefficient, parts) in lagrangian.coefficients.iter().zip(&absolute.parts) {
        let own = &absolute.lagrangian.coefficients;
        let left =
            parts.iter().fold(coefficient.terms.clone(), |left, &(s, k)| plus(&left, -k, &own[s].terms));
        assert!(left.iter().all(|term| term.1.abs() < 1e-11 * size), "{name}: {left:?}");
    }
    let model = written(&lagrangian, absolute);
    let apart = error(arm, &sparse(&lagrangian, &model), 100);
    assert!(apart < 1e-11, "{name}: {apart:e}");
    let reduced = model.reduced(&lagrangian);
    assert!(!reduced.simplified.contains(&true), "{name}");
    assert!(reduced.combinations.iter().zip(&lagrangian.coefficients).all(|(a, c)| *a == c.terms), "{name}");
}

#[test]
fn models_in_absolute_angles_give_the_same_torque() {
    for file in ["puma3.json", "ur5.json"] {
        let arm = arm(file);
        let coordinates = Coordinates::of(&arm).expect("parallel axes");
        checked(&arm, coordinates, file);
    }
    let mut seen = [0; 3];
    for seed in 0..100 {
        let arm = random_arm(seed);
        if arm.dof() > 4 {
            continue;
        }
        let Some(coordinates) = Coordinates::of(&arm) else { continue };
        coordinates
            .onto
            .iter()
            .for_each(|&sign| seen[usize::from(sign.unsigned_abs()) + usize::from(sign < 0)] += 1);
        checked(&arm, coordinates, &format!("seed {seed}"));
    }
    assert!(seen.iter().all(|&count| count > 3), "parallel and opposed axes: {seen:?}");
}

/// Entries that are equal or zero in joint angles must stay so whatever a reduction does to the coefficients; where they are
/// different sums in other coordinates, it cannot be had there.
#[test]
fn coordinates_that_tear_equal_entries_apart_are_refused() {
    let arm = arm("stanford.json");
    assert_eq!(Coordinates::of(&arm), None);
    let lagrangian = expand(&arm);
    assert_eq!(Absolute::new(&lagrangian, Coordinates { onto: vec![0, 1, 0, -1, 1, 0] }), None);
    let joints =
        Absolute::new(&lagrangian, Coordinates { onto: vec![0; 6] }).expect("the joints' own angles");
    assert_eq!(joints.lagrangian.coefficients.len(), lagrangian.coefficients.len());
}

/// A planar arm with two links: D' has constants on its diagonal and one cosine beside it, and h' one entry up to sign.
#[test]
fn two_parallel_links_have_one_entry_that_moves() {
    let planar = Arm { joints: arm("puma3.json").joints[1..].to_vec(), ..arm("puma3.json") };
    let coordinates = Coordinates::of(&planar).expect("parallel axes");
    assert_eq!(coordinates.onto, [0, 1]);
    let lagrangian = expand(&planar);
    let absolute = Absolute::new(&lagrangian, coordinates).expect("a model").lagrangian;
    let moving = |l: &Lagrangian| {
        let gravity = |c: &&crate::lagrangian::Coefficient| {
            c.name().starts_with('g') || c.name().starts_with("minus_g")
        };
        l.coefficients.iter().filter(|c| !gravity(c) && c.terms.iter().any(|term| term.0 > 0)).count()
    };
    // d12 and h122; in joint angles d11, d12 and h112.
    assert_eq!((moving(&absolute), moving(&lagrangian)), (2, 3));
}
