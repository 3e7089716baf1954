//! The numbers that sum up a run.

use serde::Serialize;

use super::run::Trace;

/// The position error that counts as converged, rad or m.
pub const CONVERGED: f64 = 0.01;

/// How well a run tracked and what it cost, over its control instants.
///
/// Lists have one entry a joint. A run that has diverged is summed up to the instant at which it did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Metrics {
    /// Root of the mean square of q_e, rad or m.
    pub rms_error: Vec<f64>,
    /// Root of the mean square of the length of q_e, all joints together, rad (m).
    pub rms_error_total: f64,
    /// |q_e| at the last instant, rad or m.
    pub final_error: Vec<f64>,
    /// The last control instant at which the error of some joint exceeds [`CONVERGED`], s; 0 where none ever does,
    /// `None` where one still does at the end.
    pub convergence_time: Option<f64>,
    /// Σ_k |τ_k+1 − τ_k|, N·m or N: what chatter raises.
    pub torque_total_variation: Vec<f64>,
    /// Largest |τ|, N·m or N.
    pub peak_torque: Vec<f64>,
    /// Control periods in which a limit cut the torque of some joint.
    pub saturated_steps: usize,
    /// Control periods in which the fault policy stood in for the law.
    pub faulted_steps: usize,
    /// Instant from which the run could not go on, s: the state overflowed in the period after it, reached a position
    /// where the mass matrix is not positive definite, or a joint had gone a full turn (6.28 m) beyond its initial
    /// error. `None` for a run to the end: a loop that oscillates without growing goes on, and never converges.
    pub diverged_at: Option<f64>,
}

impl Metrics {
    /// Sums up a trace of `n` joints; an empty one gives zeros.
    pub(super) fn new(
        trace: &Trace,
        n: usize,
        saturated_steps: usize,
        faulted_steps: usize,
        diverged_at: Option<f64>,
    ) -> Self {
        let errors = &trace.position_error;
        let count = errors.len().max(1) as f64;
        let mean_square: Vec<f64> =
            (0..n).map(|i| errors.iter().map(|q_e| q_e[i] * q_e[i]).sum::<f64>() / count).collect();
        let variation = |i: usize| trace.torque.windows(2).map(|pair| (pair[1][i] - pair[0][i]).abs()).sum();
        let peak = |i: usize| trace.torque.iter().fold(0.0_f64, |peak, torque| peak.max(torque[i].abs()));
        Self {
            rms_error: mean_square.iter().map(|&square| libm::sqrt(square)).collect(),
            rms_error_total: libm::sqrt(mean_square.iter().sum()),
            final_error: errors.last().map_or(vec![0.0; n], |q_e| q_e.iter().map(|e| e.abs()).collect()),
            convergence_time: if diverged_at.is_some() { None } else { convergence_time(trace) },
            torque_total_variation: (0..n).map(variation).collect(),
            peak_torque: (0..n).map(peak).collect(),
            saturated_steps,
            faulted_steps,
            diverged_at,
        }
    }
}

fn convergence_time(trace: &Trace) -> Option<f64> {
    let outside = |q_e: &Vec<f64>| q_e.iter().any(|e| e.abs() > CONVERGED);
    match trace.position_error.iter().rposition(outside) {
        None => Some(0.0),
        Some(last) if last + 1 == trace.position_error.len() => None,
        Some(last) => trace.time.get(last).copied(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(errors: &[f64]) -> Trace {
        Trace {
            time: (0..errors.len()).map(|k| k as f64 * 0.5).collect(),
            position_error: errors.iter().map(|&e| vec![e, 0.0]).collect(),
            torque: errors.iter().map(|&e| vec![10.0 * e, -1.0]).collect(),
            lyapunov: vec![0.0; errors.len()],
            ..Trace::default()
        }
    }

    #[test]
    fn sums_up_by_joint() {
        let metrics = Metrics::new(&trace(&[0.3, -0.4, 0.0, 0.0]), 2, 3, 1, None);
        assert_eq!(metrics.rms_error, [0.25, 0.0]);
        assert_eq!(metrics.rms_error_total, 0.25);
        assert_eq!(metrics.final_error, [0.0, 0.0]);
        assert_eq!(metrics.torque_total_variation, [11.0, 0.0]);
        assert_eq!(metrics.peak_torque, [4.0, 1.0]);
        assert_eq!(metrics.convergence_time, Some(0.5));
        assert_eq!((metrics.saturated_steps, metrics.faulted_steps), (3, 1));
    }

    #[test]
    fn convergence_is_for_good() {
        let time = |errors: &[f64]| Metrics::new(&trace(errors), 2, 0, 0, None).convergence_time;
        assert_eq!(time(&[0.2, 0.005, -0.02, 0.009]), Some(1.0));
        assert_eq!(time(&[0.01, 0.0]), Some(0.0));
        assert_eq!(time(&[0.0, 0.02]), None);
        assert_eq!(Metrics::new(&trace(&[0.0, 0.0]), 2, 0, 0, Some(1.0)).convergence_time, None);
        assert_eq!(Metrics::new(&trace(&[]), 2, 0, 0, Some(0.0)).final_error, [0.0, 0.0]);
    }
}
