//! The numbers that decide, on one line.

use super::figure::{Figure, Panel, Tile};
use super::study::Study;
use super::words::{self, worst};
use crate::control::StepGraph;
use crate::guarantee::Kind;

/// Cost, error, guarantee, size and period of this size of the model.
pub(super) fn figure(study: &Study) -> Figure {
    let generation = &study.generation;
    let mut tiles = vec![cost(study)];
    if let Some(torque) = generation.torque() {
        let fraction = torque.fraction();
        tiles.push(Tile {
            name: "Certified torque error",
            value: words::percent(fraction, true),
            note: "of the peak torque, worst joint".to_string(),
        });
    }
    if let Some(statement) = generation.statement() {
        let (value, note) = match (statement.kind, study.promised()) {
            (Kind::Sampled, Some(sampled)) => {
                let joints = &generation.arm().joints;
                let settled = sampled.settled_error.as_ref().map_or(String::new(), |error| {
                    format!(", {} from {} on", worst(joints, error), words::time_up(sampled.settle))
                });
                let any = worst(joints, &sampled.reach);
                ("sampled loop".to_string(), format!("within {any} at any time{settled}, worst joint"))
            }
            (Kind::Continuous, _) => {
                ("continuous law".to_string(), "the held torque counts to first order".to_string())
            }
            _ => ("none".to_string(), statement.reasons.first().cloned().unwrap_or_default()),
        };
        tiles.push(Tile { name: "Guarantee", value, note });
    }
    if let Some(design) = generation.design() {
        let note = format!("longest stable: {}", words::time_down(design.guarantee.period_max));
        tiles.push(Tile { name: "Control period", value: words::time(design.period), note });
    }
    let lines = study.module.lines().count();
    tiles.push(Tile {
        name: "Module",
        value: format!("{} kB", words::plain(study.module.len() as f64 / 1e3)),
        note: format!("{lines} lines of Rust, {}", generation.form().name()),
    });
    Figure { caption: generation.verdict(), panels: vec![Panel::Tiles { tiles }] }
}

fn cost(study: &Study) -> Tile {
    let generation = &study.generation;
    let (name, own, exact) = match generation.step() {
        Some(step) => {
            let exact = generation.exact_step().map(|step| step.operations().cost());
            ("Control step", StepGraph::operations(step).cost(), exact)
        }
        None => (
            "Model",
            generation.code().operations().cost(),
            Some(generation.exact_code().operations().cost()),
        ),
    };
    let exact = exact.filter(|_| !generation.reduced().is_exact());
    let note = match exact {
        Some(exact) if own < exact => {
            let saved = (exact - own) as f64 / exact as f64;
            format!("operations, {} fewer than the exact model's {exact}", words::percent(saved, false))
        }
        Some(exact) => format!("operations, and the exact model's take {exact}"),
        None => "operations".to_string(),
    };
    Tile { name, value: own.to_string(), note }
}
