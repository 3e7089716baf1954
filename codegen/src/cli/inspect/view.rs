//! Gathers what is shown.

use super::{
    AdaptationView, BoundsView, ControlView, Costs, DomainView, EstimateView, GuaranteeView, Inspection,
    PromiseView, RangeView, RatesView, ReferenceView, StepCosts,
};
use crate::bounds::{Bounds, Effort, Rates, estimate, factor_bounds, six_digits_up, worst_ratio};
use crate::control::{Envelope, RobustGain, StepGraph};
use crate::domain::Domain;
use crate::emit::{ABSOLUTE_VALUES, COMPARISONS, functions};
use crate::guarantee::Sampled;
use crate::pipeline::{Generation, Limits};
use crate::reduction::Dictionary;
use crate::spec::MatrixSpec;

/// `size` is that of the module, bytes.
pub(super) fn view(generation: &Generation, size: usize, limits: Option<Limits>) -> Inspection<'_> {
    let (arm, lagrangian, reduced) = (generation.arm(), generation.lagrangian(), generation.reduced());
    let (code, exact_code) = (generation.code(), generation.exact_code());
    let design = generation.design();
    let operations = Costs { reduced: code.operations(), exact: exact_code.operations() };
    let control = design.as_ref().map(|design| {
        let Envelope { v_max, level, position_error, velocity_error, speed } = &design.envelope;
        ControlView {
            W: MatrixSpec::of(&design.w),
            Pqq: MatrixSpec::of(&design.gains.pqq),
            Omega: MatrixSpec::of(&design.omega),
            boundary_layer: design.boundary_layer.as_deref(),
            robust_gain: match &design.robust_gain {
                RobustGain::Constant(gain) => Some(gain),
                RobustGain::State => None,
            },
            period: design.period,
            k_star: design.k_star,
            v_max: *v_max,
            level: *level,
            position_error,
            velocity_error,
            speed,
        }
    });
    let continuous = design.as_ref().map(|design| {
        let promised = &design.guarantee;
        GuaranteeView {
            holds: promised.holds,
            reasons: &promised.reasons,
            initial_error_max: &promised.initial_error_max,
            period_max: promised.period_max,
            final_error: &promised.final_error,
            tube_needed: promised.tube_needed.as_deref(),
            inertia_min: promised.inertia.least,
            inertia_certified: promised.inertia.certified,
        }
    });
    let uncertainty = generation.uncertainty().parameters.iter().map(|p| RangeView {
        name: &p.name,
        nominal: p.nominal,
        low: p.nominal + p.low,
        high: p.nominal + p.high,
    });
    Inspection {
        uncertainty: uncertainty.collect(),
        adaptation: adaptation(generation),
        name: &generation.spec().name,
        joints: arm.dof(),
        joint_names: arm.joints.iter().map(|joint| joint.name.as_str()).collect(),
        functions: lagrangian.functions.len(),
        candidates: Dictionary::of(generation.spec().dictionary).functions(lagrangian).len(),
        coefficients: lagrangian.coefficients.len(),
        terms: lagrangian.terms(),
        selected: functions(lagrangian, reduced),
        simplified_arm: reduced.simplified_arm().map_or(&[], |simplified_arm| &simplified_arm.parameters),
        bounds: bounds_view(generation),
        torque_error: generation.torque().map(|torque| torque.error.clone()),
        peak_torque: generation.torque().map(|torque| torque.peak.clone()),
        torque_rates: generation.torque().map(|torque| rates(&torque.rates)),
        torque_error_of_law: generation.met().map(|met| met.error.as_slice()),
        law_rates: generation.met().map(|met| rates(&met.rates)),
        domain: domain_view(generation.domain()),
        form: generation.form().name(),
        verdict: generation.verdict(),
        operations,
        step_operations: step_costs(generation),
        step_rounding: generation.rounding().map(|rounding| rounding.torque.as_slice()),
        size,
        control,
        guarantee: promise(generation, limits),
        reference: reference(generation),
        continuous,
        warnings: generation.warnings(),
    }
}

fn reference(generation: &Generation) -> Option<ReferenceView<'_>> {
    let limits = generation.design()?.reference.as_ref()?;
    let checked = generation.spec().emit.check_reference;
    let count = |each: usize| if checked { each * limits.velocity.len() } else { 0 };
    Some(ReferenceView {
        position: &limits.position,
        velocity: &limits.velocity,
        acceleration: &limits.acceleration,
        checked,
        comparisons: count(COMPARISONS),
        absolute_values: count(ABSOLUTE_VALUES),
    })
}

fn promise(generation: &Generation, limits: Option<Limits>) -> Option<PromiseView<'_>> {
    let statement = generation.statement()?;
    let sampled = statement.promised();
    let up = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| six_digits_up(*x)).collect() };
    // The torque that is asked for shows what is missing where limits are too low.
    let [low, high] =
        statement.sampled.as_ref().map(Sampled::torque_range).map_or([None, None], |range| range.map(Some));
    let (period_max, initial_error_max) = limits.map(|limits| (limits.period, limits.initial_error)).unzip();
    Some(PromiseView {
        kind: statement.kind.name(),
        reasons: &statement.reasons,
        reach: sampled.map(|sampled| up(&sampled.reach)),
        settle: sampled.map(|sampled| sampled.settle),
        settled_error: sampled.and_then(|sampled| sampled.settled_error.as_deref()).map(up),
        end_error: sampled.map(|sampled| up(&sampled.end_error)),
        valid_until: sampled.and_then(|sampled| sampled.valid_until),
        torque_min: low,
        torque_max: high,
        period_max,
        initial_error_max,
    })
}

fn bounds_view(generation: &Generation) -> BoundsView<'_> {
    let bounds = generation.bounds();
    BoundsView {
        kind: "certified",
        D: &bounds.d,
        H: &bounds.h,
        G: &bounds.g,
        B: diagonal(&bounds.b),
        C: generation.design().map(|design| design.delta_c.as_slice()),
        worst_ratio: worst_ratio(generation.lagrangian(), generation.certificates()),
        estimate: estimated(generation),
        factor: by_factor(generation),
    }
}

fn step_costs(generation: &Generation) -> Option<StepCosts> {
    let reduced = generation.step()?.operations();
    Some(StepCosts { reduced, exact: generation.exact_step().map(StepGraph::operations) })
}

fn rates(rates: &Rates) -> RatesView<'_> {
    let Rates { speed, reference_speed, reference_acceleration } = rates;
    RatesView { speed, reference_speed, reference_acceleration }
}

fn adaptation(generation: &Generation) -> Option<AdaptationView<'_>> {
    let adaptation = generation.design()?.adaptation.as_ref()?;
    let regressor = generation.regressor()?;
    let mut operations = regressor.code.operations();
    if regressor.own_base {
        let own = generation.code().operations();
        operations.mul += own.mul;
        operations.add += own.add;
        operations.fused += own.fused;
        operations.trig_pairs = operations.trig_pairs.max(own.trig_pairs);
    }
    let parameter = |k: usize| RangeView {
        name: &adaptation.names[k],
        nominal: adaptation.initial[k],
        low: adaptation.low[k],
        high: adaptation.high[k],
    };
    let parameters = (0..adaptation.names.len()).map(parameter).collect();
    Some(AdaptationView { parameters, rate: &adaptation.rate, operations })
}

fn diagonal(values: &[f64]) -> Vec<Vec<f64>> {
    let row = |i: usize| (0..values.len()).map(|j| if i == j { values[i] } else { 0.0 }).collect();
    (0..values.len()).map(row).collect()
}

fn estimated(generation: &Generation) -> Option<EstimateView> {
    let lagrangian = generation.lagrangian();
    let deltas = estimate(lagrangian, generation.reduced(), generation.domain())?;
    let Bounds { d, h, g, .. } = Bounds::new(lagrangian, &deltas);
    Some(EstimateView { D: d, H: h, G: g })
}

fn by_factor(generation: &Generation) -> Option<EstimateView> {
    let (lagrangian, uncertainty) = (generation.lagrangian(), generation.uncertainty());
    generation.regression()?;
    let (reduced, domain) = (generation.reduced(), generation.domain());
    let deltas = factor_bounds(lagrangian, reduced, uncertainty, domain, &Effort::default());
    let Bounds { d, h, g, .. } = Bounds::new(lagrangian, &deltas);
    Some(EstimateView { D: d, H: h, G: g })
}

fn domain_view(domain: &Domain) -> DomainView {
    let (kind, position_error, position) = match domain {
        Domain::Path(_) => ("trajectory", None, None),
        Domain::Tube(_, errors) => ("tube", Some(errors.clone()), None),
        Domain::Workspace(limits) => ("workspace", None, Some(limits.clone())),
    };
    DomainView { kind, position_error, position }
}
