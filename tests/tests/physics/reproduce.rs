//! The report's section 4: which of its claims the runs bear out.

use gramforge::internals::progress::Silent;
use gramforge::internals::report::{Figures, figures};
use gramforge::internals::reproduce::{claims, run};

#[test]
fn the_reports_claims_hold_where_they_can() {
    let cases = run(&Silent).unwrap();
    let claims = claims(&cases);
    for claim in &claims {
        println!(
            "{}: {} ({})",
            claim.claim,
            claim.measured,
            if claim.holds { "holds" } else { "does not hold" }
        );
    }
    let verdict = |start: &str| -> Vec<bool> {
        let found: Vec<bool> =
            claims.iter().filter(|c| c.claim.starts_with(start)).map(|c| c.holds).collect();
        assert!(!found.is_empty(), "{start}");
        found
    };
    let all = |start: &str| assert!(verdict(start).iter().all(|holds| *holds), "{start}");
    all("Fig. 4: the simplified law tracks slightly better");
    all("Figs. 2, 4: convergence");
    all("a boundary layer removes");
    for load in ["-20 %", "+20 %"] {
        for period in ["10.00", "2.000"] {
            all(&format!(
                "Fig. 6, {period} ms, load {load}, adapting all parameters: robust converges faster"
            ));
            all(&format!("Fig. 5, {period} ms, load {load}, adapting all parameters: robust chatters more"));
        }
        all(&format!("2.000 ms, load {load}: a boundary layer quiets both"));
    }
    // The gains as printed contradict the report's own figures.
    assert_eq!(verdict("the same with the gains as printed"), [false]);

    let drawn = figures(&Figures {
        joints: &cases.nominal.arm().joints,
        motion: cases.nominal.motion().unwrap(),
        exact: &cases.simplified.exact,
        simplified: &cases.simplified.law,
        robust: &cases.loaded[1].robust[1].law,
        adaptive: &cases.loaded[1].adaptive[1].law,
    })
    .unwrap();
    let names: Vec<&str> = drawn.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["figure2.svg", "figure3.svg", "figure4.svg", "figure5.svg", "figure6.svg"]);
    assert!(drawn.iter().all(|(_, svg)| svg.contains("joint3") && !svg.contains("NaN")));
}
