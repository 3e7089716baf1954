//! The expansion of a family, against the oracle and against specifications with other numbers.

use gramforge::internals::arm::{Arm, Built, Uncertainty};
use gramforge::internals::dynamics::{coriolis, gravity, mass_matrix};
use gramforge::internals::lagrangian::{Combination, Lagrangian, expand_family};
use gramforge::internals::reduction::plus;
use gramforge_tests::random::Random;
use gramforge_tests::{difference, edited, edited_arm, largest};
use serde_json::{Value, json};

/// Mass, first moments and pseudo-inertias of the report's arm, about the numbers of its Table 1.
fn ten_numbers() -> Value {
    json!({ "links": [
        { "joint": "joint1", "pseudo_inertia": { "yy": [0.2, 0.21], "xy": [-0.001, 0.002], "zz": [0.0003, 0.0005] } },
        { "joint": "joint2", "mass": [3.5, 4.2], "at": [-0.1, 0.02, 0.03], "first_moment": [[-0.4, -0.375], null, [-0.01, 0.01]] },
        { "joint": "joint3", "mass": [2.8, 4.2], "first_moment": [[-0.35, -0.25], [-0.02, 0.01], null],
          "pseudo_inertia": { "xx": [0.12, 0.14] } }
    ] })
}

fn some_u(uncertainty: &Uncertainty, random: &mut Random) -> Vec<f64> {
    let of = |p: &gramforge::internals::arm::Parameter| {
        let share = 0.5 + 0.5 * random.signed();
        p.low + share * (p.high - p.low)
    };
    uncertainty.parameters.iter().map(of).collect()
}

fn combinations(lagrangian: &Lagrangian, u: &[f64]) -> Vec<Combination> {
    let of = |c: &gramforge::internals::lagrangian::Coefficient| {
        u.iter().zip(&c.variations).fold(c.terms.clone(), |sum, (u, v)| plus(&sum, *u, v))
    };
    lagrangian.coefficients.iter().map(of).collect()
}

/// Largest relative difference of D, C and G between the expansion at `u` and the oracle of `member`.
fn apart(lagrangian: &Lagrangian, u: &[f64], member: &Arm, random: &mut Random) -> f64 {
    let n = member.dof();
    let combinations = combinations(lagrangian, u);
    let mut worst = 0.0_f64;
    for _ in 0..10 {
        let (q, qd) = (random.vector(n, 3.0), random.vector(n, 2.0));
        let values = lagrangian.at_with(&combinations, &q);
        let pairs = [
            (values.mass_matrix.concat(), mass_matrix(member, &q).concat()),
            (values.coriolis(&qd).concat(), coriolis(member, &q, &qd).concat()),
            (values.gravity.clone(), gravity(member, &q)),
        ];
        for (mine, theirs) in pairs {
            worst = worst.max(difference(&mine, &theirs) / largest(&theirs));
        }
    }
    worst
}

#[test]
fn the_expansion_of_a_family_is_the_oracle_of_each_member() {
    let payload = json!({ "payload": { "mass": [0.0, 2.0], "at": [0.02, -0.01, 0.1], "first_moment": [null, null, [-0.05, 0.2]] } });
    let wrist = json!({ "links": [{ "joint": "joint3", "mass": [0.0, 9.0], "at": [0.1, 0.2, 0.3] }], "payload": { "mass": [0.0, 3.0],
        "pseudo_inertia": { "xx": [0.0, 0.1], "yz": [-0.01, 0.02] } } });
    for (name, intervals) in
        [("arm3_xi2", ten_numbers()), ("puma560_xi6", wrist.clone()), ("stanford", wrist), ("ur5", payload)]
    {
        let Built { arm, uncertainty, .. } = edited_arm(name, |v| v["control"]["uncertainty"] = intervals);
        let lagrangian = expand_family(&arm, &uncertainty);
        let mut random = Random::new(7);
        let mut worst = 0.0_f64;
        for _ in 0..8 {
            let u = some_u(&uncertainty, &mut random);
            worst = worst.max(apart(&lagrangian, &u, &uncertainty.at(&arm, &u), &mut random));
        }
        println!("{name}, {} uncertain numbers: {worst:.1e}", uncertainty.parameters.len());
        assert!(worst < 1e-11, "{name}: {worst:e}");
    }
}

/// The family is what its words say: the same arms come of a specification with other numbers.
#[test]
fn a_member_is_the_arm_with_that_number_in_its_specification() {
    let links = "/arm/dh/links";
    let edits: [(&str, f64); 5] = [
        ("2/mass", 4.2),
        ("2/first_moment/0", -0.25),
        ("0/pseudo_inertia/yy", 0.2),
        ("2/pseudo_inertia/xx", 0.14),
        ("1/first_moment/2", 0.01),
    ];
    let fields = [
        "links[2].mass",
        "links[2].first_moment[0]",
        "links[0].pseudo_inertia.yy",
        "links[2].pseudo_inertia.xx",
        "links[1].first_moment[2]",
    ];
    let Built { arm, uncertainty, .. } =
        edited_arm("arm3_xi2", |v| v["control"]["uncertainty"] = ten_numbers());
    let mut random = Random::new(3);
    let mut check = |arm: &Arm, uncertainty: &Uncertainty, field: &str, value: f64, other: &Arm| {
        let lagrangian = expand_family(arm, uncertainty);
        let at =
            |p: &gramforge::internals::arm::Parameter| if p.name == field { value - p.nominal } else { 0.0 };
        let u: Vec<f64> = uncertainty.parameters.iter().map(at).collect();
        assert!(u.iter().any(|u| *u != 0.0), "{field}");
        let worst = apart(&lagrangian, &u, other, &mut random);
        assert!(worst < 1e-11, "{field}: {worst:e}");
    };
    for ((pointer, value), field) in edits.into_iter().zip(fields) {
        let other =
            edited_arm("arm3_xi2", |v| *v.pointer_mut(&format!("{links}/{pointer}")).unwrap() = json!(value));
        check(&arm, &uncertainty, field, value, &other.arm);
    }
    let carried = |mass: f64| json!({ "mass": mass, "com": [0.02, -0.01, 0.1] });
    let Built { arm, uncertainty, .. } = edited_arm("ur5", |v| {
        v["arm"]["payload"] = carried(1.0);
        v["control"]["uncertainty"] = json!({ "payload": { "mass": [0.0, 2.0] } });
    });
    let other = edited_arm("ur5", |v| v["arm"]["payload"] = carried(1.7));
    check(&arm, &uncertainty, "payload.mass", 1.7, &other.arm);
}

#[test]
fn intervals_without_width_change_no_byte() {
    let points = json!({ "links": [
        { "joint": "joint1", "first_moment": [[0.0, 0.0], [-0.625, -0.625], [0.0, 0.0]], "pseudo_inertia": { "yy": [0.208, 0.208], "xy": [0.0, 0.0] } },
        { "joint": "joint3", "mass": [3.5, 3.5], "first_moment": [[-0.3, -0.3], [0.0, 0.0], null], "pseudo_inertia": { "xx": [0.12, 0.12] } }
    ], "viscous_friction": [[0.0, 0.0], null, null] });
    let module = |intervals: Option<Value>| {
        let generation = edited("arm3_xi2", |v| {
            if let Some(intervals) = intervals {
                v["control"]["uncertainty"] = intervals;
            }
        });
        let text = generation.unwrap().module().unwrap();
        text.lines().filter(|line| !line.contains("SHA-256")).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(module(Some(points)), module(None));
    let point = |x: f64| json!([x, x]);
    let com = [0.0175, -0.1105];
    let built = edited_arm("stanford", |v| {
        v["control"]["uncertainty"] = json!({ "links": [{ "joint": "joint1", "mass": point(9.29),
            "first_moment": [point(0.0), point(9.29 * com[0]), point(9.29 * com[1])], "pseudo_inertia": { "xy": point(0.0) } }] });
    });
    assert!(built.uncertainty.is_empty(), "{:?}", built.uncertainty);
}
