//! The peak torque at few corners, against all of them and against another search.

use std::path::Path;

use super::*;
use crate::check::prepare;

/// Another search: random positions, and from the best of them random steps that shrink.
fn other(arm: &Arm, limits: &[[f64; 2]], rates: &Rates, i: usize) -> f64 {
    let n = arm.dof();
    let spread = LowDiscrepancy::new(2 * n);
    let value = |unit: &[f64]| largest(arm, &in_box(limits, unit), rates)[i];
    let mut seen: Vec<(Vec<f64>, f64)> = (0..1500)
        .map(|index| {
            let unit = spread.point(7 * index + 3)[n..].to_vec();
            let height = value(&unit);
            (unit, height)
        })
        .collect();
    seen.sort_by(|a, b| b.1.total_cmp(&a.1));
    let climb = |(mut at, mut peak): (Vec<f64>, f64)| {
        let mut step = 0.3;
        for index in 0..250 {
            let u = spread.point(11 * index);
            let next: Vec<f64> =
                at.iter().zip(&u).map(|(x, u)| (x + step * (2.0 * u - 1.0)).clamp(0.0, 1.0)).collect();
            let there = value(&next);
            if there > peak {
                (at, peak) = (next, there);
            }
            step *= 0.98;
        }
        peak
    };
    seen.into_iter().take(8).map(climb).fold(0.0, f64::max)
}

/// The corners that are left out are not the worst ones, to the last bit.
#[test]
fn the_same_torque_is_found_at_few_corners_as_at_all() {
    for name in ["puma3", "puma560_workspace", "stanford", "ur5"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../tests/data/{name}.json"));
        let arm = prepare(&path).expect("a sound specification").built.arm;
        let n = arm.dof();
        let rates = Rates {
            speed: (0..n).map(|j| 1.0 + 0.3 * j as f64).collect(),
            reference_speed: vec![2.0; n],
            reference_acceleration: vec![5.0; n],
        };
        let limits = arm.joint_box();
        let corners = Corners::new(&arm, &limits, &rates);
        let spread = LowDiscrepancy::new(n);
        let mut run = 0;
        for index in 0..100 {
            let unit = if index < 80 { spread.point(index) } else { corner(3 * index, n) };
            let q = in_box(&limits, &unit);
            let all = largest(&arm, &q, &rates);
            assert_eq!(corners.all(&q), all, "{name}, {q:?}");
            for i in 0..n {
                assert_eq!(corners.above(&q, i, all[i]), None);
                assert_eq!(corners.above(&q, i, all[i].next_down()), Some(all[i]), "{name}, {q:?}, {i}");
                let there = corners.composite(&q).expect("no joint follows another");
                let estimate = corners.estimate(&there, i);
                assert!((estimate.peak - all[i]).abs() <= 0.1 * corners.apart[i], "{name}, {q:?}, {i}");
                run += estimate.near(corners.apart[i]).count();
            }
        }
        assert!(run < (100 * n) << (n - 1), "{name}: {run} corners are no fewer");
    }
}

#[test]
fn another_search_finds_no_more() {
    for name in ["puma3", "stanford"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../tests/data/{name}.json"));
        let arm = prepare(&path).expect("a sound specification").built.arm;
        let n = arm.dof();
        let rates = Rates {
            speed: vec![2.0; n],
            reference_speed: vec![2.0; n],
            reference_acceleration: vec![5.0; n],
        };
        let limits = arm.joint_box();
        let peaks = workspace_peak_torque(&arm, &limits, &rates);
        for i in 0..n.min(4) {
            let found = other(&arm, &limits, &rates, i);
            println!("{name}, joint {}: {:.6}, another search {found:.6}", i + 1, peaks[i]);
            assert!(peaks[i] >= 0.995 * found, "{name}, joint {}", i + 1);
        }
    }
}
