//! The descent: at each level of the error, what saves most for what it adds, as long as something is admitted.

use super::ArmCandidate;
use super::moves::moves;
use super::refit::Kept;
use super::table::Table;
use crate::arm::{Arm, Inertial, Quantity};
use crate::parallel::Parallelize;
use crate::torque::{Plan, costs, planned};

/// The first level: the error at the points as a fraction of the joint's peak torque.
const FIRST: f64 = 2e-4;
/// Ratio of neighbouring levels.
const STEP: f64 = 1.15;
/// The last in any case.
const LAST: f64 = 0.5;
/// Moves whose error is above the level by no more than this factor are refitted.
const NEARLY: f64 = 2.5;
/// Moves that are looked at closely at a step, the most promising first.
const TRIED: usize = 40;
/// So many at a time, until one is admitted.
const TOGETHER: usize = 8;
/// Of these, so many are refitted.
const REFITTED: usize = 2;
/// Arms whose recursions are counted in one graph.
const COUNTED: usize = 16;

struct Descent<'a> {
    table: &'a Table,
    arm: &'a Arm,
    parameters: &'a [Inertial],
    refits: bool,
    /// That of the whole arm and the last.
    plans: Vec<Plan>,
    kept: Kept,
    /// How many moves each point has ruled out.
    culprits: Vec<usize>,
}

/// The members with errors up to `most`.
pub(super) fn members(
    table: &Table,
    arm: &Arm,
    parameters: &[Inertial],
    most: f64,
    least: usize,
    refits: bool,
) -> Vec<ArmCandidate> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for p in (0..parameters.len()).filter(|&p| table.own[p] != 0.0) {
        // Second moments that are equal stay so: the recursion takes them together.
        let twin = |group: &&mut Vec<usize>| group.iter().all(|&q| alike(table, parameters, p, q));
        match groups.iter_mut().find(twin) {
            Some(group) => group.push(p),
            None => groups.push(vec![p]),
        }
    }
    let kept = Kept { groups, theta: table.own.clone() };
    let plan = planned(arm, &[]).1;
    let mut descent =
        Descent { table, arm, parameters, refits, plans: vec![plan], kept, culprits: vec![0; table.points] };
    let mut out: Vec<ArmCandidate> = Vec::new();
    let mut cheapest = usize::MAX;
    let mut level = FIRST;
    while level <= most.min(LAST) {
        let before = descent.kept.groups.clone();
        while descent.step(level) {}
        level *= STEP;
        if before == descent.kept.groups {
            continue;
        }
        if refits {
            descent.kept.theta = descent.kept.refitted(table).0;
        }
        let arm = descent.with(&descent.kept.theta);
        let (code, plan) = planned(&arm, &descent.plans);
        descent.plans.truncate(1);
        descent.plans.push(plan);
        let cost = code.operations().cost();
        if cost < least {
            break;
        }
        if cost < cheapest {
            cheapest = cost;
            let lost = |p: &usize| table.own[*p] != 0.0 && !descent.kept.groups.iter().any(|g| g.contains(p));
            let lost = (0..parameters.len()).filter(lost).map(|p| parameters[p]).collect();
            let theta = &descent.kept.theta;
            out.push(ArmCandidate {
                error: table.error(theta),
                separate: table.separate(theta),
                arm,
                lost,
                code,
            });
        }
    }
    out
}

/// Second moments of one body that are equal but for rounding.
fn alike(table: &Table, parameters: &[Inertial], p: usize, q: usize) -> bool {
    let second = |p: usize| matches!(parameters[p].quantity, Quantity::Second(..));
    let (a, b) = (table.own[p], table.own[q]);
    let equal = (a - b).abs() <= 1e-12 * a.abs();
    equal && second(p) && second(q) && parameters[p].joint == parameters[q].joint
}

impl Descent<'_> {
    /// Takes the most promising move that is admitted; false where none is.
    fn step(&mut self, level: f64) -> bool {
        let mut found = self.promising(level);
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let most = if self.refits { NEARLY * level } else { level };
        let order = self.strictest_first();
        let mut errors: Vec<f64> = Vec::new();
        for some in found.chunks(TOGETHER).take(TRIED / TOGETHER) {
            let error = |next: &Kept| self.table.error_within(&next.theta, &order, most);
            for error in some.par_iter().map(|(_, next)| error(next)).collect::<Vec<_>>() {
                if let Err(culprit) = error {
                    self.culprits[culprit] += 1;
                }
                // Above the most that is refitted no move is looked at again.
                errors.push(error.unwrap_or(f64::INFINITY));
            }
            if errors.iter().any(|&error| error <= level) {
                break;
            }
        }
        let admitted = errors.iter().position(|&error| error <= level);
        let before = admitted.unwrap_or(errors.len());
        let better = if self.refits {
            let nearly = (0..before).filter(|&i| errors[i] <= NEARLY * level).take(REFITTED);
            let refitted: Vec<(usize, (Vec<f64>, f64))> = nearly
                .collect::<Vec<_>>()
                .into_par_iter()
                .map(|i| (i, found[i].1.refitted(self.table)))
                .collect();
            refitted.into_iter().find(|(_, (_, error))| *error <= level)
        } else {
            None
        };
        match (better, admitted) {
            (Some((index, (theta, _))), _) => {
                self.kept = Kept { theta, ..found.swap_remove(index).1 };
                true
            }
            (None, Some(index)) => {
                self.kept = found.swap_remove(index).1;
                true
            }
            (None, None) => false,
        }
    }

    /// The points, those first that are likely to rule out a move.
    fn strictest_first(&self) -> Vec<usize> {
        let errors = self.table.error_by_point(&self.kept.theta);
        let mut order: Vec<usize> = (0..self.table.points).collect();
        let later = |a: usize, b: usize| {
            self.culprits[b].cmp(&self.culprits[a]).then(errors[b].total_cmp(&errors[a])).then(a.cmp(&b))
        };
        order.sort_by(|&a, &b| later(a, b));
        order
    }

    /// The moves that save something, with what they save for what they add.
    fn promising(&self, level: f64) -> Vec<(f64, Kept)> {
        let most = if self.refits { NEARLY * level } else { level };
        let near = |groups: Vec<Vec<usize>>| {
            let mut next = Kept { groups, theta: Vec::new() };
            let rotor =
                |group: &Vec<usize>| group.iter().any(|&p| self.parameters[p].quantity == Quantity::Armature);
            next.theta = next.near(self.table, &self.kept.theta, |group| self.refits || rotor(group))?;
            if self.least(&next.theta) > most {
                return None;
            }
            // By the structure alone: what a refit makes of equal numbers is seen at the end of the level.
            let mut structure = next.start(&self.kept.theta);
            for (plain, fitted) in structure.iter_mut().zip(&next.theta).filter(|(plain, _)| **plain == 0.0) {
                *plain = *fitted;
            }
            Some((self.with(&structure), next))
        };
        let moves = moves(&self.kept, self.parameters, self.arm.dof());
        let (arms, found): (Vec<Arm>, Vec<Kept>) =
            moves.into_par_iter().filter_map(near).collect::<Vec<_>>().into_iter().unzip();
        let whole = self.with(&self.kept.theta);
        let counted: Vec<usize> =
            arms.chunks(COUNTED).into_par_iter().flat_map_iter(|arms| self.costs(&whole, arms)).collect();
        let now = self.costs(&whole, std::slice::from_ref(&whole)).first().copied().unwrap_or(usize::MAX);
        let promise = |(cost, next): (usize, Kept)| {
            let saved = now.checked_sub(cost).filter(|&saved| saved > 0)?;
            Some((saved as f64 / self.burden(&next.theta).max(1e-12), next))
        };
        counted.into_iter().zip(found).filter_map(promise).collect()
    }

    /// What the recursions of arms like `whole` cost by the cheapest of the plans.
    fn costs(&self, whole: &Arm, arms: &[Arm]) -> Vec<usize> {
        let by_plan = self.plans.iter().map(|plan| costs(whole, arms, plan));
        let cheaper = |a: Vec<usize>, b: Vec<usize>| a.into_iter().zip(b).map(|(a, b)| a.min(b)).collect();
        by_plan.reduce(cheaper).unwrap_or_else(|| vec![usize::MAX; arms.len()])
    }

    /// Root of the squares by which the model moves.
    fn burden(&self, theta: &[f64]) -> f64 {
        self.table.distance(theta, &self.kept.theta)
    }

    /// The largest error is no smaller: a sum of absolute values is at least the root of the sum of their squares, and
    /// the largest at least the mean.
    fn least(&self, theta: &[f64]) -> f64 {
        let sums = self.table.points * self.table.shares.len();
        self.table.distance(theta, &self.table.own) / libm::sqrt(sums.max(1) as f64)
    }

    /// The arm with those values: its own bodies and what they differ by, so that what the recursion may gather on a
    /// joint has its own size to be measured by.
    fn with(&self, theta: &[f64]) -> Arm {
        let mut arm = self.arm.clone();
        for ((&parameter, value), own) in self.parameters.iter().zip(theta).zip(&self.table.own) {
            if value != own {
                arm.set_inertial(parameter, arm.inertial(parameter) + (value - own));
            }
        }
        arm
    }
}
