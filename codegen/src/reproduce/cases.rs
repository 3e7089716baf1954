//! The runs.

use std::path::Path;

use crate::error::Error;
use crate::load::{Loaded, parse};
use crate::pipeline::Generation;
use crate::progress::{Progress, Stage};
use crate::simulate::{Comparison, Scenario, simulate, simulate_on};
use crate::spec::{
    AdaptationSpec, ControlSpec, LawSpec, LinkUncertaintySpec, MatrixSpec, ParametersSpec, UncertaintySpec,
    VectorSpec,
};

const SPEC: &str = include_str!("../../specs/arm3.json");
/// The mass of the third link with its load, kg: 0.8 to 1.2 of 3.5.
const MASS: [f64; 2] = [2.8, 4.2];
/// φ of the boundary layer at the nominal load, rad/s, and at the others, where the gain that it softens is larger.
const LAYERS: [f64; 2] = [0.05, 0.2];
/// The report's control period and a shorter one, s: with the longer, the robust law's sign function drives the loop
/// into an oscillation as wide as its gain, which is no property of the law.
const PERIODS: [f64; 2] = [0.01, 0.002];
/// Specifications that are generated and simulated: three at the nominal load, five of [`LoadedCases`] with each period.
const CASES: usize = 3 + 5 * PERIODS.len();

/// All runs; each comparison has law (16) with the exact model of the arm as specified beside the law under test.
#[derive(Clone, Debug)]
pub struct Cases {
    /// The specification of the nominal case, with all that follows from it.
    pub nominal: Generation,
    /// Law (34), simplified model, nominal load.
    pub simplified: Comparison,
    /// The same with a boundary layer.
    pub layered: Comparison,
    /// The same with the gains as printed.
    pub printed: Comparison,
    /// Other loads, with the report's period and with a shorter one.
    pub loaded: [LoadedCases; 2],
}

/// Runs with the lightest and the heaviest load.
#[derive(Clone, Debug)]
pub struct LoadedCases {
    /// Control period, s.
    pub period: f64,
    /// Law (34) with robust bounds.
    pub robust: [Comparison; 2],
    /// Law (46), all parameters of the simplified model.
    pub adaptive: [Comparison; 2],
    /// Law (46), the uncertain mass alone.
    pub mass: [Comparison; 2],
    /// Law (34) with robust bounds and a boundary layer.
    pub robust_layered: [Comparison; 2],
    /// Law (46), all parameters, with a boundary layer.
    pub adaptive_layered: [Comparison; 2],
}

/// Runs every case, and tells `progress` of each.
///
/// # Errors
/// [`Error::Internal`] where the built-in specification does not pass its own checks.
pub fn run(progress: &dyn Progress) -> Result<Cases, Error> {
    let stage = Stage::new(progress, "cases of the report", CASES);
    let nominal = generation(|_| {})?;
    let alone = |edit: &dyn Fn(&mut ControlSpec)| -> Result<Comparison, Error> {
        let _part = stage.part();
        simulate(&Scenario::of(&generation(edit)?)?)
    };
    Ok(Cases {
        simplified: {
            let _part = stage.part();
            simulate(&Scenario::of(&nominal)?)?
        },
        nominal,
        layered: alone(&|control| layer(control, LAYERS[0]))?,
        printed: alone(&|control| control.pqq = Some(MatrixSpec::Scalar(4.0)))?,
        loaded: [loaded(PERIODS[0], &stage)?, loaded(PERIODS[1], &stage)?],
    })
}

fn layer(control: &mut ControlSpec, phi: f64) {
    control.boundary_layer = Some(VectorSpec::Scalar(phi));
}

fn learn(control: &mut ControlSpec, parameters: ParametersSpec) {
    control.law = LawSpec::Adaptive;
    control.adaptation = Some(AdaptationSpec { parameters, ..AdaptationSpec::default() });
}

fn loaded(period: f64, stage: &Stage) -> Result<LoadedCases, Error> {
    let both = |edit: &dyn Fn(&mut ControlSpec)| -> Result<[Comparison; 2], Error> {
        let _part = stage.part();
        let generation = generation(|control| {
            control.uncertainty = Some(load());
            control.period = Some(period);
            edit(control);
        })?;
        let scenario = Scenario::of(&generation)?;
        let on = |u: fn(&crate::arm::Parameter) -> f64| {
            let u: Vec<f64> = generation.uncertainty().parameters.iter().map(u).collect();
            simulate_on(&scenario, &generation.uncertainty().at(generation.arm(), &u))
        };
        Ok([on(|p| p.low)?, on(|p| p.high)?])
    };
    Ok(LoadedCases {
        period,
        robust: both(&|_| {})?,
        adaptive: both(&|control| learn(control, ParametersSpec::All))?,
        mass: both(&|control| learn(control, ParametersSpec::Uncertain))?,
        robust_layered: both(&|control| layer(control, LAYERS[1]))?,
        adaptive_layered: both(&|control| {
            learn(control, ParametersSpec::All);
            layer(control, LAYERS[1]);
        })?,
    })
}

/// The mass of the third link with its load, which sits at the link's end.
fn load() -> UncertaintySpec {
    let link = LinkUncertaintySpec {
        joint: "joint3".to_string(),
        mass: Some(MASS),
        at: None,
        first_moment: None,
        pseudo_inertia: None,
    };
    UncertaintySpec { links: vec![link], ..UncertaintySpec::default() }
}

/// The built-in specification with its controller edited; the report's period is the period, whatever the gains admit.
fn generation(edit: impl Fn(&mut ControlSpec)) -> Result<Generation, Error> {
    let mut loaded: Loaded = parse(SPEC, Path::new("arm3.json"))?;
    if let Some(control) = &mut loaded.spec.control {
        control.allow_long_period = true;
        edit(control);
    }
    Generation::new(loaded)
}
