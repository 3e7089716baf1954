//! The generated modules, and of each what a timer interrupt calls.
#![allow(unsafe_code, reason = "the names by which the linker finds each control step")]

use gramforge_runtime::reference::QuinticTicks;
use gramforge_runtime::{ControlStep, StepController};

/// One whole step: evaluates the reference at a tick, takes the control step, gives the torque to drive with; whether
/// there was no fault.
pub type Control<S, const N: usize, const P: usize> =
    fn(&mut StepController<S, N, P>, q: &[f32; N], qd: &[f32; N], tick: u32, torque: &mut [f32; N]) -> bool;

/// What is known of a module.
#[derive(Clone, Copy, Debug)]
pub struct Case<S: ControlStep<N, P, Scalar = f32>, const N: usize, const P: usize> {
    /// Name of the module.
    pub name: &'static str,
    /// Its motion.
    pub reference: QuinticTicks<f32, N>,
    /// Its whole step.
    pub control: Control<S, N, P>,
    /// Puts a controller at its start.
    pub start: fn(&mut StepController<S, N, P>),
    /// How far the measured position may be off the motion, rad or m.
    pub error: f32,
}

macro_rules! modules {
    ($($name:ident $model:ident, $n:literal joints, $p:literal learnt, off by $error:literal;)*) => {
        $(
            #[allow(missing_docs, reason = "generated")]
            #[rustfmt::skip]
            pub mod $name {
                include!(concat!(env!("MODULES"), "/", stringify!($name), ".rs"));

                /// What is measured of this module.
                pub const CASE: super::Case<$model, $n, $p> = super::Case {
                    name: stringify!($name),
                    reference: REFERENCE,
                    control: super::steps::$name,
                    start: super::starts::$name,
                    error: $error,
                };
            }
        )*

        /// The whole steps, by the names of their modules.
        pub mod steps {
            use gramforge_runtime::{StepController, TickReference};

            $(
                /// As [`Control`](super::Control).
                #[unsafe(no_mangle)]
                #[inline(never)]
                pub fn $name(
                    controller: &mut StepController<super::$name::$model, $n, $p>,
                    q: &[f32; $n],
                    qd: &[f32; $n],
                    tick: u32,
                    torque: &mut [f32; $n],
                ) -> bool {
                    let desired = super::$name::REFERENCE.at(tick);
                    match controller.step(q, qd, &desired) {
                        Ok(command) => {
                            *torque = command.torque;
                            true
                        }
                        Err(fault) => {
                            *torque = fault.command;
                            false
                        }
                    }
                }
            )*
        }

        /// What stands before the loop, by the names of the modules.
        pub mod starts {
            use gramforge_runtime::StepController;

            $(
                /// Puts a controller at its start.
                #[inline(never)]
                pub fn $name(controller: &mut StepController<super::$name::$model, $n, $p>) {
                    *controller = super::$name::controller();
                }
            )*
        }

        /// Measures every module.
        pub fn measure_all() {
            $(crate::measure::measure(&$name::CASE);)*
        }
    };
}

modules! {
    arm3_xi2 Arm3Xi2, 3 joints, 0 learnt, off by 0.2;
    arm3_exact Arm3Exact, 3 joints, 0 learnt, off by 0.2;
    arm3_robust Arm3Robust, 3 joints, 0 learnt, off by 0.2;
    arm3_adaptive Arm3Adaptive, 3 joints, 1 learnt, off by 0.2;
    puma560_exact Puma560Exact, 6 joints, 0 learnt, off by 0.1;
    puma560_one_percent Puma560OnePercent, 6 joints, 0 learnt, off by 2.0;
    puma560_robust Puma560Robust, 6 joints, 0 learnt, off by 0.1;
    puma560_adaptive Puma560Adaptive, 6 joints, 1 learnt, off by 0.1;
    panda_exact PandaExact, 7 joints, 0 learnt, off by 0.05;
}
