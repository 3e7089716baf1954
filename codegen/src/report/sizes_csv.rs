//! A sweep as a CSV file.

use crate::error::Error;
use crate::number::scientific;
use crate::sizes::{Entry, Row};

/// Columns of one value a row.
const COLUMNS: [&str; 18] = [
    "spec",
    "size",
    "refused",
    "form",
    "functions",
    "mul",
    "add",
    "sines",
    "operations",
    "exact_operations",
    "worst_torque_fraction",
    "gain",
    "period_s",
    "period_max_s",
    "guarantee",
    "valid_until_s",
    "bytes",
    "lines",
];
/// Columns of one value a joint.
const BY_JOINT: [&str; 5] =
    ["torque_error", "peak_torque", "switching_gain", "certified_error", "certified_settled_error"];

/// The rows of a sweep as CSV, full digits, a column a joint for what is by joint; what is not known is empty.
///
/// # Errors
/// [`Error::Internal`] for defects.
pub fn sizes_csv(entries: &[&Entry]) -> Result<String, Error> {
    let rows = || entries.iter().filter_map(|entry| entry.row.as_ref());
    let joints =
        rows().flat_map(|row| by_joint(row).into_iter().flatten().map(<[f64]>::len)).max().unwrap_or(0);
    let heads = BY_JOINT.iter().flat_map(|name| (1..=joints).map(move |i| format!("{name}_{i}")));
    let header: Vec<String> = COLUMNS.iter().map(ToString::to_string).chain(heads).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let failed = |error: String| Error::Internal(format!("cannot write CSV: {error}"));
    writer.write_record(&header).map_err(|error| failed(error.to_string()))?;
    for entry in entries {
        let mut cells =
            vec![entry.spec.clone(), entry.size.clone(), entry.refused.clone().unwrap_or_default()];
        if let Some(row) = &entry.row {
            cells.extend(single(row)?);
            for values in by_joint(row) {
                let cell = |i: usize| values.and_then(|x| x.get(i)).map_or(String::new(), |x| scientific(*x));
                cells.extend((0..joints).map(cell));
            }
        }
        cells.resize(header.len(), String::new());
        writer.write_record(&cells).map_err(|error| failed(error.to_string()))?;
    }
    let bytes = writer.into_inner().map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
}

/// The values of [`COLUMNS`] after the first three.
fn single(row: &Row) -> Result<Vec<String>, Error> {
    let number = |value: Option<f64>| value.map_or(String::new(), scientific);
    let gain = serde_json::to_value(row.gain).map_err(|error| Error::Internal(error.to_string()))?;
    let guarantee = row.guarantee.as_ref();
    Ok(vec![
        row.form.clone(),
        row.functions.to_string(),
        row.operations.mul.to_string(),
        row.operations.add.to_string(),
        row.operations.sines.to_string(),
        row.operations.total.to_string(),
        row.exact_operations.map_or(String::new(), |exact| exact.total.to_string()),
        number(row.worst_fraction()),
        gain.as_str().unwrap_or_default().to_string(),
        number(row.period),
        number(row.period_max),
        guarantee.map_or(String::new(), |promise| promise.kind.clone()),
        number(guarantee.and_then(|promise| promise.valid_until)),
        row.bytes.to_string(),
        row.lines.to_string(),
    ])
}

/// The values of [`BY_JOINT`].
fn by_joint(row: &Row) -> [Option<&[f64]>; 5] {
    let promise = row.guarantee.as_ref();
    [
        row.torque_error.as_deref(),
        row.peak_torque.as_deref(),
        row.switching_gain.as_deref(),
        promise.and_then(|promise| promise.reach.as_deref()),
        promise.and_then(|promise| promise.settled_error.as_deref()),
    ]
}
