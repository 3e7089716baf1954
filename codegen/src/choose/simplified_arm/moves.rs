//! What may be left out at a step.

use super::refit::Kept;
use crate::arm::{Inertial, Quantity};

/// Every simpler choice of groups: a parameter of one joint less, or several together, with or without a rotor inertia
/// in their place; or two second moments made equal, so that the body is round.
pub(super) fn moves(kept: &Kept, parameters: &[Inertial], joints: usize) -> Vec<Vec<Vec<usize>>> {
    let place =
        |joint: usize, quantity: Quantity| parameters.iter().position(|p| *p == Inertial { joint, quantity });
    let alive = |p: &usize| kept.groups.iter().any(|group| group.contains(p));
    let mut out: Vec<Vec<Vec<usize>>> = Vec::new();
    let mut add = |groups: Vec<Vec<usize>>| {
        if groups != kept.groups && !out.contains(&groups) {
            out.push(groups);
        }
    };
    let without = |lost: &[usize]| -> Vec<Vec<usize>> {
        let rest = |group: &Vec<usize>| group.iter().copied().filter(|p| !lost.contains(p)).collect();
        kept.groups.iter().map(rest).filter(|group: &Vec<usize>| !group.is_empty()).collect()
    };
    for joint in 0..joints {
        let of = |quantities: &[Quantity]| -> Vec<usize> {
            quantities.iter().filter_map(|&q| place(joint, q)).filter(alive).collect()
        };
        use Quantity::{Armature, First, Mass, Second};
        let first = of(&[First(0), First(1), First(2)]);
        let cross = of(&[Second(0, 1), Second(0, 2), Second(1, 2)]);
        let diagonal = of(&[Second(0, 0), Second(1, 1), Second(2, 2)]);
        let second: Vec<usize> = diagonal.iter().chain(&cross).copied().collect();
        let body: Vec<usize> = of(&[Mass]).into_iter().chain(first.iter().chain(&second).copied()).collect();
        let single: Vec<Vec<usize>> = body.iter().copied().chain(of(&[Armature])).map(|p| vec![p]).collect();
        let pairs = [First(0), First(1), First(2)]
            .iter()
            .flat_map(|&a| [Second(0, 1), Second(0, 2), Second(1, 2)].map(|b| of(&[a, b])));
        let skew = [[(0, 1), (0, 2)], [(0, 1), (1, 2)], [(0, 2), (1, 2)]];
        let skew = skew.iter().map(|pair| of(&pair.map(|(i, j)| Second(i, j))));
        let sets: Vec<Vec<usize>> = single
            .into_iter()
            .chain(pairs)
            .chain(skew)
            .chain([first, cross.clone(), diagonal, second, body])
            .collect();
        let armature = place(joint, Armature).filter(|p| !alive(p));
        for lost in sets.iter().filter(|set| !set.is_empty()) {
            add(without(lost));
            if let Some(armature) = armature {
                let mut groups = without(lost);
                groups.push(vec![armature]);
                groups.sort();
                add(groups);
            }
        }
        if let (Some(x), Some(y)) = (place(joint, Second(0, 0)), place(joint, Second(1, 1)))
            && alive(&x)
            && alive(&y)
            && !kept.groups.iter().any(|g| g.contains(&x) && g.contains(&y))
        {
            let mut groups = without(&[x, y]);
            groups.push(vec![x, y]);
            groups.sort();
            add(groups.clone());
            groups.retain(|group| !group.iter().any(|p| cross.contains(p)));
            add(groups);
        }
    }
    out
}
