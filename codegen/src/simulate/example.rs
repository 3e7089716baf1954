//! Arms and scenarios for the tests: the three-link arm of the report's section 4, and chains of n joints.

use std::path::Path;
use std::sync::Arc;

use super::{Comparison, Scenario, simulate};
use crate::arm::{Arm, Body, Coupling, Joint, JointKind, Limits, Linkage, Transform, Uncertainty};
use crate::bounds::{Bounds, Effort, certified, position_bound, recursion_rounding};
use crate::check::{Control, GainSource, InitialError, Tuning};
use crate::control::{Design, DesignProblem, design};
use crate::domain::{Domain, Measure};
use crate::error::Error;
use crate::graph::Graph;
use crate::lagrangian::expand;
use crate::motion::Motion;
use crate::reduction::shared;
use crate::spec::{AdaptationSpec, CoriolisTermSpec, LawSpec, OnFaultSpec, RobustGainSpec, SimulationSpec};
use crate::torque::{expanded, recursive};

/// A link: α (quarter turns), a, d, mass, diagonal of the pseudo-inertia, first moment, in its standard frame.
type Link = (f64, f64, f64, f64, [f64; 3], [f64; 3]);

/// Owns what a [`Scenario`] borrows.
pub(crate) struct Example {
    pub(crate) arm: Arm,
    pub(crate) motion: Arc<Motion>,
    pub(crate) design: Design,
    pub(crate) code: Graph,
    pub(crate) bounds: Bounds,
    pub(crate) initial: InitialError,
    pub(crate) simulation: SimulationSpec,
}

impl Example {
    /// The arm along a quintic, reduced to `functions` over a tube of 0.05 rad (`None`: exact), initial error 0.2 rad,
    /// W = 40, Pqq = 0.25, Ω = 1.
    pub(crate) fn new(
        arm: Arm,
        from: &[f64],
        to: &[f64],
        functions: Option<usize>,
        boundary_layer: Option<f64>,
    ) -> Self {
        Self::within(arm, [from, to], functions, boundary_layer, [0.05, 0.2])
    }

    /// The same over a tube and from an initial error of one's own.
    fn within(
        arm: Arm,
        [from, to]: [&[f64]; 2],
        functions: Option<usize>,
        boundary_layer: Option<f64>,
        [tube, error]: [f64; 2],
    ) -> Self {
        let n = arm.dof();
        let motion = Arc::new(Motion::Quintic { from: from.to_vec(), to: to.to_vec(), duration: 5.0 });
        let tube = Domain::Tube(motion.clone(), vec![tube; n]);
        let measure = Measure::new(&tube, &arm);
        let lagrangian = expand(&arm);
        let (code, bounds) = match functions {
            Some(functions) => {
                let reduced = shared(&lagrangian, &measure, functions);
                let proofs = certified(&lagrangian, &reduced, &tube, &Effort::default());
                let deltas: Vec<f64> = proofs.iter().map(|proof| proof.bound).collect();
                (expanded(&arm, &lagrangian, &reduced), Bounds::new(&lagrangian, &deltas))
            }
            None => (recursive(&arm), Bounds::new(&lagrangian, &vec![0.0; lagrangian.coefficients.len()])),
        };
        let diagonal =
            |value: f64| (0..n).map(|i| (0..n).map(|j| if i == j { value } else { 0.0 }).collect()).collect();
        let control = Control {
            law: if functions.is_some() { LawSpec::Report } else { LawSpec::Exact },
            gains: GainSource::Given(Tuning {
                period: 0.01,
                w: diagonal(40.0),
                pqq: diagonal(0.25),
                omega: diagonal(1.0),
                boundary_layer: boundary_layer.map(|phi| vec![phi; n]),
            }),
            initial_error: InitialError { position: vec![error; n], velocity: vec![0.0; n] },
            coriolis_term: CoriolisTermSpec::Matrix,
            delta_c1: None,
            robust_gain: RobustGainSpec::State,
            adaptation: AdaptationSpec::default(),
            allow_long_period: true,
            require_guarantee: None,
            settle: None,
            compensate_coulomb: false,
            on_fault: OnFaultSpec::Hold,
        };
        let rounding = recursion_rounding(&arm, &position_bound(&tube));
        let design = design(
            &DesignProblem {
                file: Path::new("example.json"),
                control: &control,
                arm: &arm,
                given: (&arm, &Uncertainty::default()),
                angles: None,
                lagrangian: &lagrangian,
                bounds: &bounds,
                rounding: &rounding,
                single: None,
                domain: &tube,
                motion: Some(&motion),
                uncertainty: &Uncertainty::default(),
                regression: None,
                seek_tube: false,
                torque_error: &|rates| bounds.torque(rates),
                progress: &crate::progress::Silent,
            },
            false,
        )
        .unwrap();
        let initial = control.initial_error;
        Self { arm, motion, design, code, bounds, initial, simulation: SimulationSpec::default() }
    }

    /// The report's example with its initial error, reduced to `functions`.
    pub(crate) fn three_link(functions: Option<usize>, boundary_layer: Option<f64>) -> Self {
        Self::new(three_link(), &[0.0, 0.3, -1.2], &[1.5, 1.2, -2.2], functions, boundary_layer)
    }

    /// 0.2 s of a chain of `n` joints at rest, exact.
    pub(crate) fn chain(n: usize) -> Self {
        let rest = vec![0.3; n];
        // Bounds on D over a tube are another test's matter, and take long for eight joints.
        let mut out = Self::within(chain(n), [&rest, &rest], None, None, [0.0, 0.0]);
        out.initial.position = vec![0.2; n];
        out.simulation.duration = Some(0.2);
        out
    }

    pub(crate) fn simulate(&self) -> Result<Comparison, Error> {
        simulate(&Scenario {
            file: Path::new("example.json"),
            arm: &self.arm,
            plant: &self.arm,
            exact: &recursive(&self.arm),
            motion: &self.motion,
            design: &self.design,
            code: &self.code,
            bounds: &self.bounds,
            regressor: None,
            initial: &self.initial,
            simulation: &self.simulation,
            scalar: crate::spec::ScalarSpec::F64,
        })
    }
}

/// The same chain, whose third joint turns half as far as the second, the other way.
pub(crate) fn two_of_three() -> Arm {
    let chain = three_link();
    let mut arm = chain.clone();
    arm.joints.truncate(2);
    for joint in &mut arm.joints {
        joint.body = Body::default();
    }
    let follows = |coordinate, multiplier, offset| Coupling { coordinate, multiplier, offset };
    let couplings = vec![follows(0, 1.0, 0.0), follows(1, 1.0, 0.0), follows(1, -0.5, 0.1)];
    arm.linkage = Some(Box::new(Linkage { chain, couplings }));
    arm
}

/// The arm of the report's Table 1.
pub(crate) fn three_link() -> Arm {
    arm(&[
        (1.0, 0.0, 0.5, 5.5, [0.000391, 0.208, 0.000391], [0.0, -0.625, 0.0]),
        (0.0, 0.5, 0.0, 4.0, [0.125, 0.000115, 0.000115], [-0.375, 0.0, 0.0]),
        (0.0, 0.6, 0.0, 3.5, [0.120, 0.0000563, 0.0000563], [-0.3, 0.0, 0.0]),
    ])
}

/// Links of 0.3 m and 5 kg, each turned by a quarter against the one before, on drives with heavy rotors.
fn chain(n: usize) -> Arm {
    let mut arm = arm(&vec![(1.0, 0.3, 0.0, 5.0, [0.15, 0.01, 0.01], [-0.75, 0.0, 0.0]); n]);
    arm.joints.iter_mut().for_each(|joint| joint.armature = 1.0);
    arm
}

fn arm(links: &[Link]) -> Arm {
    let mut pose = Transform::IDENTITY;
    let mut joints = Vec::new();
    for &(turns, a, d, mass, pseudo, moment) in links {
        let end = Transform::translation([a, 0.0, d])
            .then(&Transform::rotation(0, turns * std::f64::consts::FRAC_PI_2));
        joints.push(Joint {
            name: format!("joint{}", joints.len() + 1),
            kind: JointKind::Revolute,
            pose,
            body: moved(&end, mass, pseudo, moment),
            link: Transform::IDENTITY,
            armature: 0.0,
            viscous_friction: 0.0,
            coulomb_friction: [0.0; 2],
            limits: Limits::default(),
        });
        pose = end;
    }
    Arm { gravity: [0.0, 0.0, -9.81], joints, tip: pose, linkage: None }
}

/// A body of the frame `at`, in the frame that `at` is placed in: x → R x + t.
fn moved(at: &Transform, mass: f64, pseudo: [f64; 3], moment: [f64; 3]) -> Body {
    let (r, t, turned) = (&at.rotation, at.translation, at.turn(moment));
    let sigma = |i: usize, j: usize| {
        let central: f64 = (0..3).map(|k| r[i][k] * pseudo[k] * r[j][k]).sum();
        central + turned[i] * t[j] + t[i] * turned[j] + mass * t[i] * t[j]
    };
    Body {
        mass,
        first_moment: std::array::from_fn(|i| turned[i] + mass * t[i]),
        pseudo_inertia: std::array::from_fn(|i| std::array::from_fn(|j| sigma(i, j))),
    }
}
