//! Quantiles against closed forms, in both tails, and what is refused.

use super::{Distribution, DistributionError, RandomField, lower_tail, standard_quantile};

fn value(text: &str, u: f64) -> f64 {
    text.parse::<Distribution>().unwrap().value(u)
}

fn assert_close(found: f64, wanted: f64) {
    assert!((found - wanted).abs() <= 1e-9 * wanted.abs().max(1e-3), "{found} instead of {wanted}");
}

#[test]
fn quantiles_agree_with_closed_forms_far_into_both_tails() {
    // Φ(-6) = 9.865876450376946e-10
    let tail = 9.865_876_450_376_946e-10;
    assert_close(value("-2..8", 0.0), 3.0);
    assert_close(value("0..1", -6.0), tail);
    // To the last bit of a number near 1.
    assert!((1.0 - value("0..1", 6.0) - tail).abs() < 2e-16);
    assert_close(value("normal(5, 2)", -3.0), -1.0);
    assert_close(value("lognormal(2, 0.5)", 2.0), 2.0 * 1.0_f64.exp());
    assert_close(value("weibull(2, 6)", 6.0), 6.0 * (-tail.ln()).sqrt());
    assert_close(value("weibull(1, 3)", -6.0), 3.0 * tail);
    assert!(value("weibull(2, 6)", 37.0).is_finite());
}

#[test]
fn truncated_normals_follow_the_definition_and_stay_in_their_range() {
    for text in ["normal(0, 1, -1..2)", "normal(1, 2, 3..9)", "normal(0, 1, -9..-8)", "normal(0, 1, 0..inf)"] {
        let Distribution::Normal { mean, deviation, range } = text.parse().unwrap() else { panic!("{text}") };
        let [a, b] = range.map(|bound| (bound - mean) / deviation);
        for u in [-5.0, -1.0, 0.0, 0.7, 5.0] {
            let x = value(text, u);
            assert!((range[0]..=range[1]).contains(&x), "{text} at {u}: {x}");
            let z = (x - mean) / deviation;
            // The odds of being below x, in the tail in which they do not cancel.
            let [below, above] = if a > 0.0 {
                [lower_tail(-a) - lower_tail(-z), lower_tail(-z) - lower_tail(-b)]
            } else {
                [lower_tail(z) - lower_tail(a), lower_tail(b) - lower_tail(z)]
            };
            let odds = (lower_tail(u) / lower_tail(-u), below / above);
            assert!((odds.0 / odds.1 - 1.0).abs() < 1e-5, "{text} at {u}: {odds:?}");
        }
        assert!(value(text, -40.0).is_finite() && value(text, -40.0) >= range[0]);
    }
}

#[test]
fn the_normal_quantile_inverts_its_distribution() {
    for z in [-30.0, -12.0, -6.0, -2.5, -0.1, 0.0] {
        assert!((standard_quantile(lower_tail(z)) - z).abs() < 1e-12 * (1.0 - z), "{z}");
    }
}

#[test]
fn fields_are_read_and_written_back() {
    for text in
        ["a.b[0]=-2..8", "a=normal(0, 3)", "a=normal(0, 3, 0..10)", "wind=weibull(2, 6)", "a=lognormal(1, 0.25)"]
    {
        assert_eq!(text.parse::<RandomField>().unwrap().to_string(), text);
    }
    assert_eq!("a= normal(0,3) ".parse::<RandomField>().unwrap().to_string(), "a=normal(0, 3)");
}

#[test]
fn malformed_and_impossible_distributions_are_refused() {
    let error = |text: &str| text.parse::<RandomField>().unwrap_err();
    assert!(["a", "=0..1", "a..b=0..1"].iter().all(|text| error(text) == DistributionError::Field));
    for text in
        ["a=1", "a=x..1", "a=gauss(0, 1)", "a=normal(0)", "a=normal(0, 1", "a=weibull(1, 2, 3)", "a=normal(0, 1, 2)"]
    {
        assert!(matches!(error(text), DistributionError::Form { .. }), "{text}");
    }
    for text in [
        "a=1..1",
        "a=2..1",
        "a=0..inf",
        "a=normal(0, 0)",
        "a=normal(0, -1)",
        "a=normal(NaN, 1)",
        "a=normal(0, 1, 3..2)",
        "a=lognormal(-1, 1)",
        "a=weibull(0, 1)",
        "a=normal(0, 1, 40..50)",
    ] {
        assert!(matches!(error(text), DistributionError::Parameter { .. }), "{text}: {:?}", error(text));
    }
}
