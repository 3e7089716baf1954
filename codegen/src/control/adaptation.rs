//! What a law that learns adds to the argument of stability, section 3.3 of the report.

use super::DesignProblem;
use crate::bounds::Rates;
use crate::error::Error;
use crate::lagrangian::Lagrangian;
use crate::reduction::Regression;
use crate::spec::VectorSpec;
use crate::text::has;

/// The numbers of equation (49), one for each parameter θ_k.
#[derive(Clone, Debug, PartialEq)]
pub struct Adaptation {
    /// What they stand for.
    pub names: Vec<String>,
    /// Diagonal of Pθθ⁻¹.
    pub rate: Vec<f64>,
    /// Lowest value.
    pub low: Vec<f64>,
    /// Highest value.
    pub high: Vec<f64>,
    /// θ̂ at the start: the arm's own.
    pub initial: Vec<f64>,
}

impl Adaptation {
    /// From the specification's Pθθ; `None` where the law does not learn.
    ///
    /// # Errors
    /// [`Error::Input`] where Pθθ has not one entry for each parameter, or there is nothing to learn.
    pub(super) fn new(problem: &DesignProblem) -> Result<Option<Self>, Error> {
        let Some(regression) = problem.regression else { return Ok(None) };
        let parameters = &regression.parameters;
        let count = parameters.len();
        let refuse = |field: &str, problem_is: String, help: String| {
            Err(Error::input(problem.file, field, problem_is, help))
        };
        if count == 0 {
            let help =
                "widen an interval of `control.uncertainty`, or take law `report` or `tight`".to_string();
            return refuse("control.law", "is `adaptive`, and no parameter can vary".to_string(), help);
        }
        let spec = &problem.control.adaptation;
        let Some(p_theta) = spec.p_theta.by_joint(count) else {
            let help = format!("write one number, or {count}, one for each parameter");
            let found = match &spec.p_theta {
                VectorSpec::List(list) => has(list.len()),
                VectorSpec::Scalar(_) => String::new(),
            };
            return refuse("control.adaptation.Ptheta", found, help);
        };
        let rate: Vec<f64> = p_theta.iter().map(|p| 1.0 / p).collect();
        if !rate.iter().all(|rate| rate.is_finite()) {
            let help = "write larger numbers: its inverse is the rate of learning".to_string();
            return refuse("control.adaptation.Ptheta", "has an inverse that overflows".to_string(), help);
        }
        let list = |of: fn(&crate::reduction::Learnt) -> f64| parameters.iter().map(of).collect();
        Ok(Some(Self {
            names: parameters.iter().map(|p| p.name.clone()).collect(),
            rate,
            low: list(|p| p.low),
            high: list(|p| p.high),
            initial: list(|p| p.initial),
        }))
    }
}

/// What θ_e = θ̂ − θ can do to V.
pub(super) struct Learning<'a> {
    adaptation: &'a Adaptation,
    lagrangian: &'a Lagrangian,
    /// sup|∂α̂_m/∂θ_k| by parameter and coefficient.
    effects: Vec<Vec<(usize, f64)>>,
    /// max ½ θ_eᵀ Pθθ θ_e at the start, J.
    pub(super) start: f64,
    /// The same at any time, J.
    pub(super) energy: f64,
}

impl<'a> Learning<'a> {
    pub(super) fn new(
        adaptation: &'a Adaptation,
        regression: &Regression,
        lagrangian: &'a Lagrangian,
        position_bound: &[f64],
    ) -> Self {
        let Adaptation { rate, low, high, initial, .. } = adaptation;
        let energy = |width: &dyn Fn(usize) -> f64| {
            rate.iter().enumerate().map(|(k, rate)| 0.5 * width(k) * width(k) / rate).sum()
        };
        Self {
            start: energy(&|k| (high[k] - initial[k]).max(initial[k] - low[k])),
            energy: energy(&|k| high[k] - low[k]),
            effects: regression.largest_effects(lagrangian, position_bound),
            adaptation,
            lagrangian,
        }
    }

    /// sup |Y_ik| by parameter k and row i for rates up to these.
    fn columns(&self, rates: &Rates) -> Vec<Vec<f64>> {
        let n = self.lagrangian.dof;
        let rows: Vec<Vec<f64>> = (0..n).map(|i| rates.multipliers(self.lagrangian, i)).collect();
        let entry = |effects: &[(usize, f64)], row: &[f64]| -> f64 {
            effects.iter().map(|&(m, size)| size * row[m]).sum()
        };
        self.effects.iter().map(|effects| rows.iter().map(|row| entry(effects, row)).collect()).collect()
    }

    /// sup |Y θ_e|_i, N·m, for rates up to these.
    pub(super) fn torque(&self, rates: &Rates) -> Vec<f64> {
        let Adaptation { low, high, .. } = self.adaptation;
        let mut out = vec![0.0; self.lagrangian.dof];
        for (k, column) in self.columns(rates).iter().enumerate() {
            out.iter_mut().zip(column).for_each(|(sum, y)| *sum += y * (high[k] - low[k]));
        }
        out
    }

    /// The part of zᵀMz that the square of an Euler step of `period` s takes back, given |(M⁻¹)_ss|.
    ///
    /// It raises V1 by ½T²(Yᵀs)ᵀPθθ⁻¹(Yᵀs) a period, and (Y_kᵀs)² ≤ Y_kᵀ(M⁻¹)_ss Y_k · zᵀMz.
    pub(super) fn step(&self, rates: &Rates, inverse: impl Fn(usize, usize) -> f64, period: f64) -> f64 {
        let square = |(column, rate): (&Vec<f64>, &f64)| {
            let row = |i: usize| column.iter().enumerate().map(|(j, y)| inverse(i, j) * y).sum::<f64>();
            rate * column.iter().enumerate().map(|(i, y)| y * row(i)).sum::<f64>()
        };
        0.5 * period * self.columns(rates).iter().zip(&self.adaptation.rate).map(square).sum::<f64>()
    }

    /// What learning adds to the gain on s within one period, N·m·s/rad: row sums of T Y Pθθ⁻¹ Yᵀ.
    pub(super) fn gain(&self, rates: &Rates, period: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.lagrangian.dof];
        for (column, rate) in self.columns(rates).iter().zip(&self.adaptation.rate) {
            let sum: f64 = column.iter().sum();
            out.iter_mut().zip(column).for_each(|(out, y)| *out += period * rate * y * sum);
        }
        out
    }
}

/// The parameters of a regression in the order of [`Adaptation`].
///
/// # Errors
/// [`Error::Internal`] where the law learns without a regression.
pub(super) fn regression<'a>(problem: &DesignProblem<'a>) -> Result<&'a Regression, Error> {
    problem.regression.ok_or_else(|| Error::Internal("a law that learns has no parameters".to_string()))
}
