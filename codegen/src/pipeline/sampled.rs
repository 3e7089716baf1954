//! Stage 3: where the model must be good, and what its errors are compared with.

use super::Means;
use super::expanded::Expanded;
use super::setting::Setting;
use crate::arm::{Arm, JointKind, indefinite_among};
use crate::bounds::{TorqueScale, position_bound};
use crate::check::Checked;
use crate::domain::Measure;
use crate::dynamics::mass_matrix;
use crate::error::{Diagnostics, Error};
use crate::number::decimal;
use crate::progress::Stage;
use crate::reduction;
use crate::spec::RefitSpec;
use crate::trig::Trig;

/// Positions of the domain at which D is looked at.
const POSITIONS: usize = 512;

/// The same for each vertex of the uncertain parameters' box.
const VERTEX_POSITIONS: usize = 64;

/// An exact model with the positions and torques that a simpler one is judged by.
///
/// Holds: every angle of the domain is within the range of the sines; D(q) of a controlled arm, and of all that it may be,
/// was positive definite at the points looked at.
#[derive(Clone, Debug)]
pub(super) struct Sampled {
    /// The exact model.
    pub expanded: Expanded,
    /// Domain, sines and rounded rotations.
    pub setting: Setting,
    /// The domain as weighted points.
    pub measure: Measure,
    /// The points that parameters are fitted to.
    pub points: Vec<Vec<f64>>,
    /// Rates and peak torques; `None` over a workspace where a joint lacks a limit.
    pub scale: Option<TorqueScale>,
}

impl Sampled {
    /// # Errors
    /// [`Error::Input`] where an angle is beyond the sines' range or D is not positive definite.
    pub fn new(expanded: Expanded, means: Means) -> Result<Self, Error> {
        let Expanded { checked, lagrangian, .. } = &expanded;
        let Checked { loaded, built, domain, .. } = checked;
        let arm = &built.arm;
        let setting = Setting::new(checked);
        let mut faults = Diagnostics::of(&loaded.path);
        check_angles(&setting.sines, &position_bound(domain), arm, &mut faults);
        faults.finish(())?;
        let stage = Stage::new(means.progress, "measure", 1);
        let measure = Measure::new(domain, arm);
        if checked.control.is_some() {
            check_definite(checked, &measure)?;
        }
        drop(stage);
        let points = match loaded.spec.refit {
            RefitSpec::Minimax => reduction::extremes(&measure, domain),
            RefitSpec::LeastSquares => measure.points.clone(),
        };
        let Setting { sines, position_bound, angles, .. } = &setting;
        let scale = TorqueScale::new(arm, domain)
            .map(|scale| scale.reserving((arm, lagrangian), position_bound, angles.as_ref(), sines));
        Ok(Self { setting, measure, points, scale, expanded })
    }
}

/// The domain may hold states that the look at the limits has missed, such as a wrist stretched out.
fn check_definite(checked: &Checked, measure: &Measure) -> Result<(), Error> {
    let Checked { loaded, built, .. } = checked;
    let mut faults = Diagnostics::of(&loaded.path);
    let seen = |most: usize| measure.points.iter().step_by(measure.points.len().div_ceil(most).max(1));
    if let Some(state) = indefinite_among(seen(POSITIONS), |q| mass_matrix(&built.arm, q)) {
        state.report(&built.arm, &mut faults);
        return Err(faults.into_error());
    }
    for u in built.uncertainty.vertices() {
        let member = built.uncertainty.at(&built.arm, &u);
        if let Some(state) = indefinite_among(seen(VERTEX_POSITIONS), |q| mass_matrix(&member, q)) {
            state.report_member(&built.uncertainty, &u, &mut faults);
            return Err(faults.into_error());
        }
    }
    Ok(())
}

/// Faults where the domain holds angles for which the sines chosen promise nothing.
fn check_angles(sines: &Trig, position_bound: &[f64], arm: &Arm, faults: &mut Diagnostics) {
    let turning =
        arm.joints.iter().zip(position_bound).filter(|(joint, _)| joint.kind == JointKind::Revolute);
    for (joint, most) in turning.filter(|(_, most)| **most > sines.range) {
        faults.push(
            "emit.trig",
            format!(
                "takes angles up to {} rad, and {} may reach {} rad",
                decimal(sines.range, 1),
                joint.name,
                decimal(*most, 1)
            ),
            "write \"libm\", or correct the motion or the limits",
        );
    }
}
