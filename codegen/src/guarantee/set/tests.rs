use super::*;
use crate::numerics::low_discrepancy::LowDiscrepancy;

/// Two joints with more generators than are kept.
fn crowded() -> ErrorSet {
    let mut set = ErrorSet::new(&[0.1, 0.2], &[0.3, 0.0], 1);
    set.centre = vec![0.01, -0.02, 0.03, 0.04];
    set.shared[0] = vec![0.02, 0.01, -0.1, 0.2];
    let points = LowDiscrepancy::new(4);
    for index in 0..600 {
        let size = 0.1 / (1.0 + index as f64);
        set.add(points.point(index).into_iter().map(|x| size * (2.0 * x - 1.0)));
    }
    set
}

#[test]
fn boxed_generators_hold_all_members() {
    let n = 2;
    let gains = Gains {
        p12: vec![vec![5.0, 0.5], vec![0.5, 3.0]],
        damping: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
        pqq: vec![vec![1.0, 0.0], vec![0.0, 1.0]],
    };
    let (before, mut after) = (crowded(), crowded());
    after.reduce(&gains);
    assert!(after.generators() <= 2 * KEPT * n && before.generators() > 600);
    // The support of the set in many directions: that of all members is no larger afterwards.
    let points = LowDiscrepancy::new(4);
    for index in 0..2000 {
        let map = vec![points.point(index).into_iter().map(|x| 2.0 * x - 1.0).collect::<Vec<f64>>()];
        let [exact, boxed] = [&before, &after].map(|set| set.image(&map).sizes()[0]);
        assert!(boxed >= exact * (1.0 - 1e-12), "{boxed} {exact}");
    }
    // Along the axes of the box nothing is lost.
    for (exact, boxed) in before.turned_hull(&gains).iter().zip(after.turned_hull(&gains)) {
        assert!((exact - boxed).abs() <= 1e-9 * exact, "{boxed} {exact}");
    }
}

#[test]
fn a_map_and_its_image_agree() {
    let map: Vec<Vec<f64>> =
        vec![vec![1.0, 0.1, 0.01, 0.0], vec![0.0, 0.9, 0.0, 0.01], vec![-3.0, 0.0, 0.5, 0.2], vec![0.0; 4]];
    let mut set = crowded();
    let sizes = set.image(&map).sizes();
    set.mapped(&map);
    for (size, own) in sizes.iter().zip(set.hull()) {
        assert!((size - own).abs() <= 1e-11 * (1.0 + size), "{size} {own}");
    }
}

#[test]
fn what_is_left_beside_a_middle_is_counted_number_by_number() {
    let set = crowded();
    let left = set.less(&set.middle());
    // Of centre and shared generators nothing is left, of the others all.
    for (k, left) in left.hull().into_iter().enumerate() {
        let own: f64 = set.rows[k].iter().map(|part| part.abs()).sum();
        assert!((left - own).abs() <= 1e-11 * own, "{left} {own}");
    }
    let mut other = set.middle();
    other.shared[0][1] += 0.07;
    other.centre[1] -= 0.02;
    let moved = set.less(&other).hull()[1] - left.hull()[1];
    assert!((moved - 0.09).abs() < 1e-12, "{moved}");
}

/// A member for these u_m and ε_g, without what is boxed.
fn member(set: &ErrorSet, u: &[f64], epsilon: &[f64]) -> Vec<f64> {
    let weights: Vec<f64> = u.iter().copied().chain(u.iter().map(|u| 2.0 * u * u - 1.0)).collect();
    let part = |k: usize| {
        let shared: f64 = set.shared.iter().zip(&weights).map(|(shared, weight)| shared[k] * weight).sum();
        set.centre[k] + shared + set.rows[k].iter().zip(epsilon).map(|(x, epsilon)| x * epsilon).sum::<f64>()
    };
    (0..set.centre.len()).map(part).collect()
}

#[test]
fn the_product_with_an_uncertain_number_is_known_up_to_its_rest() {
    let (n, [middle, half]) = (2, [0.3, 0.2]);
    let points = LowDiscrepancy::new(8);
    let random = |index: usize, size: f64| -> Vec<f64> {
        points.point(index).iter().map(|x| size * (2.0 * x - 1.0)).collect()
    };
    let mut set = ErrorSet::new(&[0.0; 2], &[0.0; 2], n);
    set.centre.copy_from_slice(&random(1, 1.0)[..4]);
    for (m, shared) in set.shared.iter_mut().enumerate() {
        shared.copy_from_slice(&random(2 + m, 1.0)[..4]);
    }
    for index in 10..12 {
        set.add(random(index, 0.1).into_iter());
    }
    let image = set.image(&[vec![1.0, 0.0, 0.0, 0.0]]);
    for m in 0..n {
        let known = image.times_number(0, m, middle, half);
        let mut most: f64 = 0.0;
        for index in 100..4000 {
            let point = random(index, 1.0);
            // The corners are among them.
            let u: Vec<f64> = point[..2].iter().map(|u| (2.0 * u).clamp(-1.0, 1.0)).collect();
            let x = member(&set, &u, &point[2..4].iter().map(|x| x.signum()).collect::<Vec<f64>>())[0];
            let weights = [1.0, u[0], u[1], 2.0 * u[0] * u[0] - 1.0, 2.0 * u[1] * u[1] - 1.0];
            let said: f64 = known.weights.iter().zip(weights).map(|(known, weight)| known * weight).sum();
            let off = ((middle + half * u[m]) * x - said).abs();
            assert!(off <= known.rest, "{off} {}", known.rest);
            most = most.max(off);
        }
        // The rest is no larger than it must be.
        assert!(most > 0.5 * known.rest, "{most} {}", known.rest);
    }
}
