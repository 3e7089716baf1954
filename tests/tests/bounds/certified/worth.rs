//! What a bound is worth in torque.

use gramforge::Generation;
use gramforge::internals::bounds::{Rates, peak_torque};
use gramforge::internals::lagrangian::Entry;
use gramforge::internals::motion::Motion;

/// The largest fraction of a joint's peak torque along `motion` that each coefficient's bound can cost, at the motion's
/// rates in a tube and at the joints' limits in a workspace.
pub fn worths(generation: &Generation, motion: &Motion) -> Vec<f64> {
    let arm = generation.arm();
    let rates = match &generation.motion() {
        Some(motion) => Rates::of(motion),
        None => Rates::limits(arm).expect("a workspace has limits on all rates"),
    };
    let peak = peak_torque(arm, motion);
    let (a, v, w) = (&rates.reference_acceleration, &rates.speed, &rates.reference_speed);
    let worth = |(coefficient, bound): (&gramforge::internals::lagrangian::Coefficient, f64)| {
        let mut multiplier = vec![0.0; arm.dof()];
        for place in &coefficient.places {
            match place.entry {
                Entry::D(i, j) => {
                    multiplier[i] += a[j];
                    if i != j {
                        multiplier[j] += a[i];
                    }
                }
                Entry::H(i, j, k) if j == k => multiplier[i] += v[j] * w[j],
                Entry::H(i, j, k) => multiplier[i] += v[j] * w[k] + v[k] * w[j],
                Entry::G(i) => multiplier[i] += 1.0,
            }
        }
        multiplier.iter().zip(&peak).map(|(u, peak)| bound * u / peak).fold(0.0, f64::max)
    };
    let bounds = generation.certificates().iter().map(|certificate| certificate.bound);
    generation.lagrangian().coefficients.iter().zip(bounds).map(worth).collect()
}
