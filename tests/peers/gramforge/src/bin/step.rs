//! Runs whole control periods of generated controllers, as `native/step.c` does for the law written by hand:
//!
//! ```text
//! step CONTROLLER STATES torques|count|time      as in main.rs; a state is t, q, q̇
//! step CONTROLLER STATES constants               prints the constants of the hand-written law as a C header
//! ```

use std::hint::black_box;

use gramforge_runtime::{
    Bounds, ConstantGainLaw, CoriolisTerm, Gains, Model, QuinticReference, ReportLaw, Settings,
    StepController, Switching,
};

#[path = "../drive.rs"]
mod drive;

/// t, q, q̇.
type State<const N: usize> = (f64, [f64; N], [f64; N]);

/// Includes each module, with the period that is measured.
macro_rules! steps {
    ($($name:ident $model:ident $joints:literal)*) => {
        $(
            #[allow(dead_code)]
            mod $name {
                include!(concat!(env!("GRAMFORGE_MODULES"), "/", stringify!($name), ".rs"));

                pub type Loop = crate::StepController<$model, $joints>;

                /// Not inlined, as calls across object files are not; its name is what callgrind counts by.
                #[inline(never)]
                pub fn measured(controller: &mut Loop, (t, q, qd): &crate::State<$joints>) -> [f64; $joints] {
                    let desired = gramforge_runtime::Reference::at(&REFERENCE, *t);
                    match controller.step(q, qd, &desired) {
                        Ok(command) => command.torque,
                        Err(fault) => fault.command,
                    }
                }
            }
        )*

        fn run(name: &str, numbers: &[f64], mode: &str) {
            match name {
                $(stringify!($name) => {
                    let mut controller = $name::controller();
                    if mode == "constants" {
                        match constants(&$name::$model, &$name::LAW, &$name::SETTINGS, &$name::REFERENCE) {
                            Ok(text) => print!("{text}"),
                            Err(what) => {
                                eprintln!("the law has {what}, which native/step.c leaves out");
                                std::process::exit(1);
                            }
                        }
                    } else {
                        // By a pointer, so that the caller cannot change how it is called.
                        let measured = black_box($name::measured as fn(&mut _, &_) -> _);
                        drive::drive(&states(numbers), |state| measured(&mut controller, state), mode);
                    }
                })*
                _ => panic!("no controller {name}"),
            }
        }
    };
}

// `steps! { MODULE TYPE JOINTS … }` for every module that compare.py has generated.
include!(concat!(env!("GRAMFORGE_MODULES"), "/steps.rs"));

fn states<const N: usize>(numbers: &[f64]) -> Vec<State<N>> {
    let state = |line: &[f64]| {
        (line[0], std::array::from_fn(|i| line[1 + i]), std::array::from_fn(|i| line[1 + N + i]))
    };
    numbers.chunks_exact(1 + 2 * N).map(state).collect()
}

/// Bounds of an exact model that are smaller come from right angles written with few digits: nobody would write them by hand.
const NEGLIGIBLE: f64 = 1e-8;

/// What native/step.c needs of a law whose gain ρ is a number by joint.
trait Written<const N: usize> {
    fn gains(&self) -> &Gains<f64, N>;
    fn switching(&self) -> &Switching<f64, N>;
    fn coulomb(&self) -> &[[f64; 2]; N];
    /// ρ, or what the law has instead of a number.
    fn robust_gain(&self, bounds: &Bounds<f64, N>) -> Result<[f64; N], &'static str>;
}

impl<const N: usize> Written<N> for ConstantGainLaw<f64, N> {
    fn gains(&self) -> &Gains<f64, N> {
        &self.gains
    }
    fn switching(&self) -> &Switching<f64, N> {
        &self.switching
    }
    fn coulomb(&self) -> &[[f64; 2]; N] {
        &self.coulomb
    }
    fn robust_gain(&self, _bounds: &Bounds<f64, N>) -> Result<[f64; N], &'static str> {
        Ok(self.robust_gain)
    }
}

impl<const N: usize> Written<N> for ReportLaw<f64, N> {
    fn gains(&self) -> &Gains<f64, N> {
        &self.gains
    }
    fn switching(&self) -> &Switching<f64, N> {
        &self.switching
    }
    fn coulomb(&self) -> &[[f64; 2]; N] {
        &self.coulomb
    }
    fn robust_gain(&self, bounds: &Bounds<f64, N>) -> Result<[f64; N], &'static str> {
        let zero = |matrix: &[[f64; N]; N]| matrix.as_flattened().iter().all(|x| x.abs() < NEGLIGIBLE);
        if !(zero(&bounds.d) && zero(&self.delta_c) && zero(&[bounds.b; N])) {
            return Err("bounds of an uncertain model");
        }
        if !matches!(&self.coriolis_term, CoriolisTerm::Matrix(matrix) if zero(matrix)) {
            return Err("a Coriolis term");
        }
        Ok(std::array::from_fn(|i| bounds.g[i] + self.disturbance[i]))
    }
}

/// What native/step.c includes; else what the law has and that file leaves out.
fn constants<const N: usize>(
    model: &impl Model<N, Scalar = f64>,
    law: &impl Written<N>,
    Settings { torque_limit, .. }: &Settings<f64, N>,
    reference: &QuinticReference<f64, N>,
) -> Result<String, &'static str> {
    let gain = law.robust_gain(model.bounds())?;
    let gains = law.gains();
    if *law.coulomb() != [[0.0; 2]; N] {
        return Err("compensation of Coulomb friction");
    }
    if [&gains.p12, &gains.damping, &gains.pqq].into_iter().any(is_full) {
        return Err("gains that are not diagonal");
    }
    let (robust, limited) =
        (gain.iter().any(|x| x.abs() >= NEGLIGIBLE), torque_limit.iter().any(Option::is_some));
    let layer = match *law.switching() {
        Switching::BoundaryLayer(phi) if robust => Some(phi),
        _ => None,
    };
    let flag = |name, value: bool| format!("#define {name} {}\n", i32::from(value));
    let mut text = format!("#define N {N}\n#define DURATION {:?}\n", reference.duration);
    text += &(flag("ROBUST", robust) + &flag("LAYER", layer.is_some()) + &flag("LIMITED", limited));
    text += &(vector("FROM", reference.from) + &vector("TO", reference.to));
    text += &(vector("P12", diagonal(&gains.p12)) + &vector("DAMPING", diagonal(&gains.damping)));
    text += &(vector("PQQ", diagonal(&gains.pqq)) + &vector("VISCOUS", model.viscous_friction()));
    text += &(vector("GAIN", gain) + &vector("PHI", layer.unwrap_or([1.0; N])));
    Ok(text + &vector("LIMIT", torque_limit.map(|limit| limit.unwrap_or(f64::MAX))))
}

fn is_full<const N: usize>(matrix: &[[f64; N]; N]) -> bool {
    matrix.as_flattened().iter().enumerate().any(|(k, x)| k % (N + 1) != 0 && *x != 0.0)
}

fn diagonal<const N: usize>(matrix: &[[f64; N]; N]) -> [f64; N] {
    std::array::from_fn(|i| matrix[i][i])
}

fn vector<const N: usize>(name: &str, values: [f64; N]) -> String {
    format!("static const double {name}[N] = {{{}}};\n", values.map(|x| format!("{x:?}")).join(", "))
}

fn main() {
    drive::main(run);
}
