//! Desired motions of every form: derivatives that are derivatives, and tables that are passed through.

use gramforge::internals::motion::Motion;
use gramforge_tests::{difference, motion};

/// One specification for each form.
const FORMS: [(&str, &str); 4] = [
    ("quintic", "arm3_exact"),
    ("waypoints", "arm3_waypoints"),
    ("sinusoids", "arm3_sinusoids"),
    ("csv", "arm3_csv"),
];

#[test]
fn velocities_and_accelerations_are_derivatives() {
    let step = 1e-5;
    for (form, spec) in FORMS {
        let motion = motion(spec);
        let mut worst = [0.0_f64; 2];
        for k in 1..400 {
            let t = motion.duration() * f64::from(k) / 400.0;
            let (before, now, after) = (motion.at(t - step), motion.at(t), motion.at(t + step));
            let slope = |a: &[f64], b: &[f64]| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| (b - a) / (2.0 * step)).collect()
            };
            worst[0] = worst[0].max(difference(&slope(&before.q, &after.q), &now.qd));
            worst[1] = worst[1].max(difference(&slope(&before.qd, &after.qd), &now.qdd));
        }
        println!("{form}: velocity off by {:.1e} rad/s, acceleration by {:.1e} rad/s²", worst[0], worst[1]);
        // The rounding of a central difference is 1e-11; at a knot of a cubic q̈ has a corner of some jerk · step.
        assert!(worst[0] < 1e-8, "{form}");
        assert!(worst[1] < 1e-3, "{form}");
    }
}

#[test]
fn a_motion_stands_still_beyond_its_ends() {
    for (form, spec) in FORMS {
        let motion = motion(spec);
        let end = motion.duration();
        assert_eq!(motion.at(-1.0), motion.at(0.0), "{form}");
        assert_eq!(motion.at(end + 1.0), motion.at(end), "{form}");
        assert!(motion.at(0.5 * end) != motion.at(0.0), "{form}");
    }
}

#[test]
fn quintic_and_waypoints_rest_at_both_ends() {
    for spec in ["arm3_exact", "arm3_waypoints"] {
        let motion = motion(spec);
        for t in [0.0, motion.duration()] {
            assert!(difference(&motion.at(t).qd, &[0.0; 3]) < 1e-14, "{spec} at {t}");
        }
    }
}

#[test]
fn a_table_is_passed_through() {
    let motion = motion("arm3_csv");
    let Motion::Spline(spline) = &motion else { panic!("a table becomes a spline") };
    let text = include_str!("../../data/arm3_motion.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(spline.times.len(), rows.len());
    let start = rows[0][0];
    for row in &rows {
        let apart = difference(&motion.at(row[0] - start).q, &row[1..]);
        assert!(apart < 1e-14, "{row:?}: {apart:e}");
    }
    // C2: both sides of every inner knot agree.
    for &knot in &spline.times[1..spline.times.len() - 1] {
        let (before, after) = (motion.at(knot - 1e-9), motion.at(knot + 1e-9));
        assert!(difference(&before.qd, &after.qd) < 1e-7 && difference(&before.qdd, &after.qdd) < 1e-6);
    }
}
