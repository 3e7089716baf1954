//! Random chains with followers, their generation, and its errors against the oracle.

use gramforge::Generation;
use gramforge_tests::chain::{Chain, Link};
use gramforge_tests::random::Random;
use gramforge_tests::{difference, largest};
use serde_json::{Value, json};

/// Multipliers that are met in robots, and odd ones.
const MULTIPLIERS: [f64; 9] = [1.0, -1.0, 2.0, -0.5, 0.5, 0.25, -3.0, 1.5, -0.75];

/// A sound body and joint of random shape.
pub fn link(random: &mut Random, prismatic: bool, follows: (usize, f64, f64)) -> Link {
    let mut three = |most: f64| -> [f64; 3] { random.array(most) };
    let (xyz, rpy, axis, com, com_rpy) = (three(0.5), three(1.4), three(1.0), three(0.3), three(1.4));
    let [a, b, c] = three(0.4).map(|x| 0.6 + x);
    // Moments of a box, with products that leave them definite.
    let inertia = [0.02 * (b + c), 0.02 * (a + c), 0.02 * (a + b), 0.001, -0.0015, 0.0007];
    let mass = 1.5 + three(1.0)[0];
    Link { prismatic, xyz, rpy, axis, mass, com, com_rpy, inertia, armature: 0.0, follows }
}

/// A random chain of 2 to 5 joints of which at least one follows an earlier or a later one.
pub fn chain(seed: u64) -> Chain {
    let mut random = Random::new(seed);
    let mut pick = |n: usize| ((random.signed() + 1.0) * 0.5 * n as f64) as usize;
    let joints = 2 + pick(4);
    let multiplier = MULTIPLIERS[pick(MULTIPLIERS.len())];
    let other = MULTIPLIERS[pick(MULTIPLIERS.len())];
    let sliding = seed % 4 == 3;
    let twice = joints > 3 && seed.is_multiple_of(2);
    let first = seed % 5 == 4;
    let follows: Vec<(usize, f64, f64)> = (0..joints)
        .map(|i| match i {
            0 if first => (0, multiplier, 0.3),
            _ if first => (i - 1, 1.0, 0.0),
            _ if i + 1 == joints => (0, multiplier, 0.3),
            _ if twice && i + 2 == joints => (0, other, -0.2),
            _ => (i, 1.0, 0.0),
        })
        .collect();
    let links =
        follows.into_iter().map(|follows| link(&mut random, sliding && follows.0 == 0, follows)).collect();
    Chain { links, gravity: [0.3, -0.2, -9.81] }
}

pub fn loaded(
    chain: &Chain,
    more: &Value,
    folder: &std::path::Path,
) -> Result<gramforge::load::Loaded, String> {
    std::fs::write(folder.join("arm.urdf"), chain.urdf()).expect("a file");
    let n = chain.dof();
    let mut spec = json!({
        "name": "follower", "arm": { "urdf": "arm.urdf", "gravity": chain.gravity }, "model": "exact",
        "motion": { "quintic": { "from": vec![0.1; n], "to": vec![0.3; n], "duration": 2.0 } },
    });
    for (key, value) in more.as_object().expect("an object") {
        spec[key] = value.clone();
    }
    gramforge::load::parse(&spec.to_string(), &folder.join("arm.json")).map_err(|error| error.to_string())
}

pub fn generation(chain: &Chain, more: &Value) -> Result<Generation, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let loaded = loaded(chain, more, folder.path())?;
    Generation::new(loaded).map_err(|error| error.to_string())
}

pub fn checked(chain: &Chain) -> gramforge::internals::check::Checked {
    let folder = tempfile::tempdir().expect("a folder");
    let loaded = loaded(chain, &json!({}), folder.path()).unwrap_or_else(|error| panic!("{error}"));
    gramforge::internals::check::checked(loaded, gramforge::internals::check::Extent::Whole)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Largest error of each of D, C, G and τ over states, as a part of the largest value.
pub fn errors(chain: &Chain, seed: u64, ours: impl Fn(&[f64], &[f64], &[f64]) -> [Vec<f64>; 4]) -> [f64; 4] {
    let n = chain.dof();
    let mut random = Random::new(seed);
    let (mut worst, mut scale) = ([0.0_f64; 4], [0.0_f64; 4]);
    for _ in 0..10 {
        let (q, qd, qdd) = (random.vector(n, 1.9), random.vector(n, 3.0), random.vector(n, 9.0));
        let theirs = [
            chain.mass_matrix(&q).concat(),
            chain.coriolis(&q, &qd).concat(),
            chain.gravity_torque(&q),
            chain.torque(&q, &qd, &qdd),
        ];
        for (k, (ours, theirs)) in ours(&q, &qd, &qdd).iter().zip(&theirs).enumerate() {
            worst[k] = worst[k].max(difference(ours, theirs));
            scale[k] = scale[k].max(largest(theirs));
        }
    }
    std::array::from_fn(|k| if scale[k] == 0.0 { worst[k] } else { worst[k] / scale[k] })
}

/// D, C, G and τ by the passivity torque D a_r + C v_r + G.
pub fn terms(
    torque: impl Fn(&[f64], &[f64], &[f64], &[f64]) -> Vec<f64>,
    n: usize,
    x: [&[f64]; 3],
) -> [Vec<f64>; 4] {
    let [q, qd, qdd] = x;
    let rest = vec![0.0; n];
    let unit = |j: usize| -> Vec<f64> { (0..n).map(|i| if i == j { 1.0 } else { 0.0 }).collect() };
    let g = torque(q, &rest, &rest, &rest);
    let less = |x: Vec<f64>| -> Vec<f64> { x.iter().zip(&g).map(|(x, g)| x - g).collect() };
    let by_rows = |columns: Vec<Vec<f64>>| {
        (0..n).flat_map(|i| columns.iter().map(move |c| c[i]).collect::<Vec<_>>()).collect()
    };
    let d = by_rows((0..n).map(|j| less(torque(q, &rest, &rest, &unit(j)))).collect());
    let c = by_rows((0..n).map(|j| less(torque(q, qd, &unit(j), &rest))).collect());
    [d, c, g.clone(), torque(q, qd, qd, qdd)]
}
