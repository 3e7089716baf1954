//! The Newton–Euler recursion with its quadratic terms polarised.
//!
//! Inverse dynamics is quadratic in the joint velocities. Replacing every product x·y of velocities by
//! ½(x·y_r + x_r·y) turns it into the symmetric bilinear form, and since h_ijk is symmetric in j and k
//! that form is unique: one pass yields D a_r + C(q, q̇) v_r + G with the Christoffel C.

use super::scalar::{Scalar, Vector, add, apply, cross, lift};
use crate::arm::{Arm, Coupling, Joint, JointKind};

/// Where a joint stands, in the form its kind needs.
#[derive(Clone, Copy, Debug)]
pub enum Position<S> {
    /// Sine and cosine of the joint angle.
    Revolute {
        /// sin q.
        sin: S,
        /// cos q.
        cos: S,
    },
    /// Displacement, m.
    Prismatic(S),
}

/// How the frame of one joint moves.
struct Motion<S> {
    /// ω, moved frame.
    velocity: Vector<S>,
    /// ω_r: the angular velocity that v_r would give.
    reference: Vector<S>,
    /// Polarised ω̇.
    angular: Vector<S>,
    /// Polarised acceleration of the frame's origin, less gravity.
    linear: Vector<S>,
    /// [ω̇]× + ½(ω ω_rᵀ + ω_r ωᵀ) − (ω·ω_r)·1: takes a point of the frame to its acceleration.
    gradient: [Vector<S>; 3],
}

/// D(q) a_r + C(q, q̇) v_r + G(q), N·m or N, without friction but with armature; gravity in m/s², base frame.
///
/// Slices have one entry a coordinate, but for `q`, which has one for each joint of [`Arm::moving`]; missing entries end
/// the recursion early. Where joints follow others, with rates J q̇, the chain's torque τ' gives Jᵀ τ'.
/// Newton–Euler after Luh, Walker and Paul (1980).
pub fn passivity_torque<S: Scalar>(
    arm: &Arm,
    gravity: [f64; 3],
    q: &[Position<S>],
    qd: &[S],
    v_r: &[S],
    a_r: &[S],
) -> Vec<S> {
    let Some(linkage) = &arm.linkage else { return serial(&arm.joints, gravity, q, qd, v_r, a_r) };
    let spread = |x: &[S]| -> Vec<S> {
        let rate = |c: &Coupling| x.get(c.coordinate).map(|x| x.constant(c.multiplier) * *x);
        linkage.couplings.iter().map_while(rate).collect()
    };
    let along = serial(&linkage.chain.joints, gravity, q, &spread(qd), &spread(v_r), &spread(a_r));
    let mut torque: Vec<S> =
        arm.joints.iter().zip(a_r).map(|(joint, &a)| a.constant(joint.armature) * a).collect();
    for (tau, coupling) in along.iter().zip(&linkage.couplings) {
        if let Some(sum) = torque.get_mut(coupling.coordinate) {
            *sum = *sum + tau.constant(coupling.multiplier) * *tau;
        }
    }
    torque
}

/// D(q) by rows, kg·m² and the like; slices as for [`passivity_torque`], `like` any number of their kind.
pub fn inertia<S: Scalar>(arm: &Arm, q: &[Position<S>], like: S) -> Vec<Vec<S>> {
    let n = arm.dof();
    let zero = like.constant(0.0);
    let mut d = vec![vec![zero; n]; n];
    for j in 0..n {
        // An acceleration of joint j moves no body before it, and D is symmetric.
        let first = if arm.linkage.is_none() { j } else { 0 };
        let rest = vec![zero; n - first];
        let mut unit = rest.clone();
        unit[j - first] = like.constant(1.0);
        let column = if arm.linkage.is_none() {
            serial(&arm.joints[first..], [0.0; 3], q.get(first..).unwrap_or(&[]), &rest, &rest, &unit)
        } else {
            passivity_torque(arm, [0.0; 3], q, &rest, &rest, &unit)
        };
        for (i, entry) in (first..).zip(column) {
            (d[i][j], d[j][i]) = (entry, entry);
        }
    }
    d
}

/// The same as [`passivity_torque`] of a chain all of whose joints move by themselves.
fn serial<S: Scalar>(
    joints: &[Joint],
    gravity: [f64; 3],
    q: &[Position<S>],
    qd: &[S],
    v_r: &[S],
    a_r: &[S],
) -> Vec<S> {
    let Some(&like) = qd.first() else { return Vec::new() };
    let zero = lift(like, [0.0; 3]);
    let mut parent = Motion {
        velocity: zero,
        reference: zero,
        angular: zero,
        linear: lift(like, gravity.map(|g| 0.0 - g)),
        gradient: [zero; 3],
    };
    let mut wrenches = Vec::with_capacity(joints.len());
    for ((((joint, &q), &qd), &v_r), &a_r) in joints.iter().zip(q).zip(qd).zip(v_r).zip(a_r) {
        let moved = advance(joint, &parent, q, qd, v_r, a_r);
        wrenches.push(wrench(joint, &moved));
        parent = moved;
    }
    let mut torque = Vec::with_capacity(wrenches.len());
    let mut carried = (zero, zero);
    let links: Vec<_> = joints.iter().zip(q).zip(&wrenches).zip(a_r).collect();
    for (((joint, &q), &(force, moment)), &a_r) in links.into_iter().rev() {
        let force = add(force, carried.0);
        let moment = add(moment, carried.1);
        let along = match joint.kind {
            JointKind::Revolute => moment[2],
            JointKind::Prismatic => force[2],
        };
        torque.push(along + a_r.constant(joint.armature) * a_r);
        let force = outward(joint, q, force);
        let arm_of_force = cross(origin(joint, q, like), force);
        carried = (force, add(outward(joint, q, moment), arm_of_force));
    }
    torque.reverse();
    torque
}

/// The motion of `joint`'s moved frame from that of the frame before.
fn advance<S: Scalar>(joint: &Joint, parent: &Motion<S>, q: Position<S>, qd: S, v_r: S, a_r: S) -> Motion<S> {
    let mut velocity = inward(joint, q, parent.velocity);
    let mut reference = inward(joint, q, parent.reference);
    let mut angular = inward(joint, q, parent.angular);
    let swept = apply(&parent.gradient, origin(joint, q, qd));
    let mut linear = inward(joint, q, add(parent.linear, swept));
    // (ω × z) v_r + (ω_r × z) q̇ has no z component.
    let bend_x = velocity[1] * v_r + reference[1] * qd;
    let bend_y = -(velocity[0] * v_r + reference[0] * qd);
    match joint.kind {
        JointKind::Revolute => {
            let half = qd.constant(0.5);
            angular = [angular[0] + half * bend_x, angular[1] + half * bend_y, angular[2] + a_r];
            velocity[2] = velocity[2] + qd;
            reference[2] = reference[2] + v_r;
        }
        JointKind::Prismatic => linear = [linear[0] + bend_x, linear[1] + bend_y, linear[2] + a_r],
    }
    let gradient = gradient(velocity, reference, angular);
    Motion { velocity, reference, angular, linear, gradient }
}

/// [ω̇]× + ½(ω ω_rᵀ + ω_r ωᵀ) − (ω·ω_r)·1.
fn gradient<S: Scalar>(w: Vector<S>, r: Vector<S>, angular: Vector<S>) -> [Vector<S>; 3] {
    let half = w[0].constant(0.5);
    let squares = [w[0] * r[0], w[1] * r[1], w[2] * r[2]];
    let mixed = |i: usize, j: usize| half * (w[i] * r[j] + w[j] * r[i]);
    let (xy, xz, yz) = (mixed(0, 1), mixed(0, 2), mixed(1, 2));
    [
        [-(squares[1] + squares[2]), xy - angular[2], xz + angular[1]],
        [xy + angular[2], -(squares[0] + squares[2]), yz - angular[0]],
        [xz - angular[1], yz + angular[0], -(squares[0] + squares[1])],
    ]
}

/// Force and moment (about the frame's origin) that move the joint's body, moved frame.
fn wrench<S: Scalar>(joint: &Joint, moved: &Motion<S>) -> (Vector<S>, Vector<S>) {
    let like = moved.linear[0];
    let mass = like.constant(joint.body.mass);
    let first_moment = lift(like, joint.body.first_moment);
    let force = add(moved.linear.map(|a| mass * a), apply(&moved.gradient, first_moment));
    let sigma = joint.body.pseudo_inertia.map(|row| lift(like, row));
    // M = gradient · Σ; ∫ x × (gradient x) dm is the axial vector of M − Mᵀ.
    let entry = |i: usize, j: usize| {
        moved.gradient[i][0] * sigma[0][j]
            + moved.gradient[i][1] * sigma[1][j]
            + moved.gradient[i][2] * sigma[2][j]
    };
    let turning = [entry(2, 1) - entry(1, 2), entry(0, 2) - entry(2, 0), entry(1, 0) - entry(0, 1)];
    (force, add(turning, cross(first_moment, moved.linear)))
}

/// A vector of the frame before, in the joint's moved frame.
fn inward<S: Scalar>(joint: &Joint, q: Position<S>, x: Vector<S>) -> Vector<S> {
    let like = x[0];
    let r = &joint.pose.rotation;
    let turned: Vector<S> = std::array::from_fn(|i| {
        like.constant(r[0][i]) * x[0] + like.constant(r[1][i]) * x[1] + like.constant(r[2][i]) * x[2]
    });
    match q {
        Position::Revolute { sin, cos } => {
            [cos * turned[0] + sin * turned[1], cos * turned[1] - sin * turned[0], turned[2]]
        }
        Position::Prismatic(_) => turned,
    }
}

/// A vector of the joint's moved frame, in the frame before.
fn outward<S: Scalar>(joint: &Joint, q: Position<S>, x: Vector<S>) -> Vector<S> {
    let turned = match q {
        Position::Revolute { sin, cos } => [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]],
        Position::Prismatic(_) => x,
    };
    let rotation = joint.pose.rotation.map(|row| lift(x[0], row));
    apply(&rotation, turned)
}

/// Origin of the joint's moved frame in the frame before.
fn origin<S: Scalar>(joint: &Joint, q: Position<S>, like: S) -> Vector<S> {
    let fixed = lift(like, joint.pose.translation);
    match q {
        Position::Revolute { .. } => fixed,
        Position::Prismatic(q) => {
            std::array::from_fn(|i| fixed[i] + like.constant(joint.pose.rotation[i][2]) * q)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::model::{mass_matrix, positions};
    use super::inertia;
    use crate::simulate::example::{three_link, two_of_three};

    #[test]
    fn inertia_is_the_mass_matrix_with_and_without_joints_that_follow_others() {
        for arm in [three_link(), two_of_three()] {
            let q: Vec<f64> = [0.3, -0.8, 1.1].into_iter().take(arm.dof()).collect();
            let made = inertia(&arm, &positions(&arm, &q), 0.0);
            let d = mass_matrix(&arm, &q);
            assert_eq!((made.len(), d.len()), (arm.dof(), arm.dof()));
            for (entry, exact) in made.iter().flatten().zip(d.iter().flatten()) {
                assert!((entry - exact).abs() < 1e-13 * (1.0 + exact.abs()), "{entry} {exact}");
            }
        }
    }
}
