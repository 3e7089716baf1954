//! The intervals of one body, as independent parameters.

use super::place::Place;
use super::{Body, Parameter, Transform};
use crate::error::Diagnostics;
use crate::spec::{LinkUncertaintySpec, PayloadUncertaintySpec, SymmetricIntervalsSpec};

/// Rounding that passes where an interval must hold the arm's own value, relative to the values and their sources.
const SLACK: f64 = 1e-9;
/// What a change of frame costs in rounding, likewise: an end of an interval this near to the arm's own value is it.
const ROUNDING: f64 = 1e-14;

/// The intervals of one body.
pub(super) struct Given {
    mass: Option<[f64; 2]>,
    pub(super) at: Option<[f64; 3]>,
    first_moment: Option<[Option<[f64; 2]>; 3]>,
    pseudo_inertia: Option<SymmetricIntervalsSpec>,
}

/// A body and where it stands.
pub(super) struct Carried<'a> {
    /// Number of the joint that moves it, from 0.
    pub(super) joint: usize,
    /// The arm's own body, in the frame of its intervals.
    pub(super) body: &'a Body,
    /// This frame in the moved frame of the joint.
    pub(super) frame: &'a Transform,
}

impl Given {
    pub(super) fn payload(spec: &PayloadUncertaintySpec) -> Self {
        let PayloadUncertaintySpec { mass, at, first_moment, pseudo_inertia } = spec.clone();
        Self { mass, at, first_moment, pseudo_inertia }
    }

    pub(super) fn link(spec: &LinkUncertaintySpec) -> Self {
        let LinkUncertaintySpec { mass, at, first_moment, pseudo_inertia, .. } = spec.clone();
        Self { mass, at, first_moment, pseudo_inertia }
    }

    /// One parameter for each interval of the body `carried`.
    pub(super) fn parameters(
        &self,
        name: &str,
        carried: &Carried,
        place: &Place,
        faults: &mut Diagnostics,
    ) -> Vec<Parameter> {
        let Carried { joint, body: nominal, frame } = *carried;
        let at = self.at.unwrap_or_default();
        let [moments, inertias] = sizes(nominal, frame);
        let mut numbers =
            vec![("mass".to_string(), self.mass, nominal.mass, Body::from_com(1.0, at, [[0.0; 3]; 3]), true)];
        for i in 0..3 {
            let mut body = Body::default();
            body.first_moment[i] = 1.0;
            let range = self.first_moment.and_then(|m| m[i]);
            numbers.push((format!("first_moment[{i}]"), range, nominal.first_moment[i], body, false));
        }
        let sigma = self.pseudo_inertia.clone().unwrap_or_default();
        let entries = [
            ("xx", sigma.xx, 0, 0),
            ("yy", sigma.yy, 1, 1),
            ("zz", sigma.zz, 2, 2),
            ("xy", sigma.xy, 0, 1),
            ("xz", sigma.xz, 0, 2),
            ("yz", sigma.yz, 1, 2),
        ];
        for (entry, range, i, j) in entries {
            let mut body = Body::default();
            body.pseudo_inertia[i][j] = 1.0;
            body.pseudo_inertia[j][i] = 1.0;
            let field = format!("pseudo_inertia.{entry}");
            numbers.push((field, range, nominal.pseudo_inertia[i][j], body, i == j));
        }
        if numbers.iter().all(|(_, range, ..)| range.is_none()) {
            place.fault(faults, "names no uncertain number", "write an interval, such as `mass`");
        }
        if !at.iter().all(|v| v.is_finite()) {
            place.at("at").fault(faults, format!("is {at:?}"), "write three finite numbers, in m");
        }
        let mut out = Vec::new();
        for (field, range, value, body, grows) in numbers {
            let Some(range) = range else { continue };
            let not_negative = field == "mass";
            let size = if not_negative {
                value
            } else {
                value.abs().max(if field.starts_with('f') { moments } else { inertias })
            };
            let Some([low, high]) = about(range, value, size, not_negative, &place.at(&field), faults) else {
                continue;
            };
            if low == high {
                continue;
            }
            let name = format!("{name}.{field}");
            out.push(Parameter { name, joint, body: body.moved(frame), nominal: value, low, high, grows });
        }
        out
    }
}

/// Sizes of the numbers from which first moments and pseudo-inertias of a body in its frame are computed.
fn sizes(body: &Body, frame: &Transform) -> [f64; 2] {
    let moved = body.moved(frame);
    let position_bound = frame.translation.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let most = |m: f64, x: &f64| m.max(x.abs());
    let moments = body.first_moment.iter().chain(&moved.first_moment).fold(body.mass * position_bound, most);
    let inertias = body.pseudo_inertia.iter().chain(&moved.pseudo_inertia).flatten();
    [moments, inertias.fold(moments * position_bound, most)]
}

/// The interval counted from `value`, which was computed from numbers of `size`; a fault where it does not hold it.
pub(super) fn about(
    range: [f64; 2],
    value: f64,
    size: f64,
    not_negative: bool,
    place: &Place,
    faults: &mut Diagnostics,
) -> Option<[f64; 2]> {
    let [low, high] = range;
    let size = low.abs().max(high.abs()).max(size);
    let slack = SLACK * size;
    if !(low.is_finite() && high.is_finite() && low <= high) {
        place.fault(faults, format!("is {range:?}"), "write two finite numbers, the lower one first");
    } else if not_negative && low < 0.0 {
        place.fault(faults, format!("is {range:?}"), "write numbers of at least 0");
    } else if value < low - slack || high + slack < value {
        place.fault(
            faults,
            format!("is {range:?}, which does not contain the arm's own {value}"),
            "write an interval about the arm's own value, or change the arm",
        );
    } else {
        let from = |end: f64| if (end - value).abs() <= ROUNDING * size { 0.0 } else { end - value };
        return Some([from(low).min(0.0), from(high).max(0.0)]);
    }
    None
}
