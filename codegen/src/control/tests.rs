//! Guarantees and their ingredients, on the report's arm.

use super::inertia::{Cell, Inertia};
use super::*;
use crate::arm::Body;
use crate::dynamics::mass_matrix;
use crate::lagrangian::expand;
use crate::numerics::linalg::{dense, symmetric_eigenvalues};
use crate::numerics::low_discrepancy::LowDiscrepancy;
use crate::simulate::example::three_link;

fn unit(index: usize, n: usize) -> Vec<f64> {
    LowDiscrepancy::new(n).point(index)
}

#[test]
fn k_star_is_the_smallest_multiple() {
    let (mut sum, mut star) = (0.0, 0.0);
    for index in 0..200 {
        let n = 2 + index % 5;
        let entries = unit(index, 5 * n);
        let delta_c: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| 4.0 * entries[(i * 3 + j * 5 + index) % (5 * n)]).collect())
            .collect();
        let k = smallest_multiple(&delta_c);
        let at = |k: f64| least_eigenvalue(&family::multiple_of_identity(k, n), &delta_c);
        assert!(outweighs(at(k), &delta_c), "{}", at(k));
        assert!(!outweighs(at(0.99 * k), &delta_c));
        // No member of the family does worse than the vertices.
        let member = |t: &[f64]| {
            let entry = |i: usize, j: usize| {
                let half = |a: usize, b: usize| delta_c[a][b] * (2.0 * t[(a * n + b) % t.len()] - 1.0);
                let c1 = if i == j { k } else { 0.0 };
                c1 + 0.5 * (half(i, j) + half(j, i))
            };
            let rows: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect();
            symmetric_eigenvalues(&rows)[0]
        };
        assert!((0..50).all(|m| member(&unit(m, n * n)) >= at(k) - 1e-9));
        star += k;
        sum += delta_c.iter().flatten().sum::<f64>();
    }
    println!("k* is {:.3} of the sum of ΔC on average", star / sum);
    assert!(star < 0.6 * sum);
}

#[test]
fn bounds_on_d_hold_and_are_near() {
    let arm = three_link();
    let inertia = Inertia::new(&arm, &expand(&arm), &[0.0; 3]);
    let boxes = [
        Cell { centre: vec![0.0; 3], half: vec![3.2; 3] },
        Cell { centre: vec![0.7, 0.7, -1.7], half: vec![0.9, 0.6, 0.7] },
        Cell { centre: vec![0.7, 0.7, -0.1], half: vec![0.9, 0.6, 0.3] },
    ];
    for cell in boxes {
        let extremes = inertia.largest(vec![cell.clone()], 0.05, 20_000, |low, high| {
            let inverse = low.clone().cholesky().map(|factor| factor.inverse());
            let entry = |i: usize| inverse.as_ref().map_or(f64::INFINITY, |m| m[(i, i)]);
            let top = inverse.as_ref().map_or(f64::INFINITY, |m| m.symmetric_eigenvalues().max());
            vec![top, entry(0), entry(1), entry(2), high.symmetric_eigenvalues().max()]
        });
        let mut seen = [0.0_f64; 5];
        let spread = LowDiscrepancy::new(3);
        for index in 0..100_000 {
            let u = spread.point(index);
            let q: Vec<f64> = (0..3).map(|i| cell.centre[i] + cell.half[i] * (2.0 * u[i] - 1.0)).collect();
            let d = dense(&mass_matrix(&arm, &q));
            let inverse = d.clone().try_inverse().unwrap();
            let values = d.symmetric_eigenvalues();
            let now = [1.0 / values.min(), inverse[(0, 0)], inverse[(1, 1)], inverse[(2, 2)], values.max()];
            seen.iter_mut().zip(now).for_each(|(s, v)| *s = s.max(v));
        }
        println!("certified {:?}\nsampled   {seen:?}", extremes.bound);
        for (bound, seen) in extremes.bound.iter().zip(seen) {
            assert!(*bound >= seen && *bound < 1.2 * seen, "{bound} against {seen}");
        }
    }
}

/// Two parallel axes that carry nothing but a point at the far end: stretched out, it cannot be pushed along the arm.
#[test]
fn what_cannot_be_certified_is_said_to_be_so() {
    let mut arm = three_link();
    arm.joints.remove(0);
    for joint in &mut arm.joints {
        (joint.body, joint.armature) = (Body::default(), 0.0);
    }
    let out = arm.joints[1].pose.translation;
    let length = libm::sqrt(out.iter().map(|x| x * x).sum());
    arm.joints[1].body = Body::from_com(1.0, out.map(|x| 1.2 * x / length), [[0.0; 3]; 3]);
    let inertia = Inertia::new(&arm, &expand(&arm), &[0.0; 2]);
    let damping = family::multiple_of_identity(10.0, 2);
    let over = |centre: f64, half: f64| {
        let cells = vec![Cell { centre: vec![0.0, centre], half: vec![0.1, half] }];
        form::fastest(&inertia, cells, &damping)
    };
    let (bent, stretched) = (over(1.0, 0.3), over(0.013, 0.3));
    println!("{bent:?}, {stretched:?}");
    assert!(bent.certified && !stretched.certified);
    // λ_max(D⁻¹K) ≥ K/λ_min(D).
    for k in 0..=100 {
        let q = [0.0, 0.7 + 0.006 * f64::from(k)];
        let least = symmetric_eigenvalues(&mass_matrix(&arm, &q))[0];
        assert!(bent.rate >= 10.0 / least, "{} {}", bent.rate, 10.0 / least);
    }
}
