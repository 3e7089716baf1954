//! Sizes of the exact models: p functions, r distinct coefficients, terms, operations.

use gramforge::internals::lagrangian::expand;
use gramforge::internals::torque::recursive;
use gramforge_tests::arm;

#[test]
fn the_models_have_their_known_sizes() {
    // Panda's counts are those of a Lagrangian without armature; armature only adds to the constants of d_ii.
    let known = [
        ("arm3_exact", 11, Some((9, 20))),
        ("puma3", 13, None),
        ("puma560_exact", 141, Some((57, 725))),
        ("ur5", 91, Some((43, 321))),
        ("panda", 13_257, Some((146, 150_442))),
    ];
    for (name, functions, rest) in known {
        let mut arm = arm(name);
        let with = expand(&arm);
        arm.joints.iter_mut().for_each(|joint| joint.armature = 0.0);
        let without = expand(&arm);
        let size = |l: &gramforge::internals::lagrangian::Lagrangian| {
            (l.functions.len(), l.coefficients.len(), l.terms())
        };
        println!("{name}: p, r, terms = {:?}; without rotors {:?}", size(&with), size(&without));
        let (p, r, terms) = size(&without);
        assert_eq!(p, functions, "{name}");
        if let Some(rest) = rest {
            assert_eq!((r, terms), rest, "{name}");
        }
        assert_eq!(with.functions, without.functions, "{name}: rotors add no function");
    }
}

#[test]
fn rotors_change_nothing_but_constants_of_the_diagonal() {
    let mut bare = arm("puma560_exact");
    let full = expand(&bare);
    bare.joints.iter_mut().for_each(|joint| joint.armature = 0.0);
    let motors: Vec<f64> = arm("puma560_exact").joints.iter().map(|joint| joint.armature).collect();
    let bare = expand(&bare);
    let q = [0.3, -1.0, 0.7, 0.2, -0.9, 1.4];
    let (a, b) = (full.at(&q), bare.at(&q));
    for i in 0..6 {
        assert!((a.gravity[i] - b.gravity[i]).abs() < 1e-12);
        for j in 0..6 {
            let rotor = if i == j { motors[i] } else { 0.0 };
            assert!((a.mass_matrix[i][j] - b.mass_matrix[i][j] - rotor).abs() < 1e-12, "d{i}{j}");
            for k in 0..6 {
                assert!((a.christoffel[i][j][k] - b.christoffel[i][j][k]).abs() < 1e-12, "h{i}{j}{k}");
            }
        }
    }
}

#[test]
fn the_exact_code_costs_no_more_than_it_did() {
    let known = [
        ("arm3_exact", 83, 2),
        ("puma3", 113, 2),
        ("puma560_exact", 322, 4),
        ("ur5", 258, 5),
        ("panda", 585, 6),
        ("stanford", 280, 3),
    ];
    for (name, arithmetic, trig_pairs) in known {
        let operations = recursive(&arm(name)).operations();
        println!("{name}: {operations:?}");
        assert_eq!((operations.arithmetic(), operations.trig_pairs), (arithmetic, trig_pairs), "{name}");
    }
}
