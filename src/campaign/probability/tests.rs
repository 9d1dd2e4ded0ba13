//! Against closed forms: linear limits of normal inputs, two failure regions, a sphere.

use super::splitting::{Point, RunEnd};
use super::{Decision, Estimate, Method, Options, decide, estimate_with};

const OPTIONS: Options = Options {
    method: Method::Splitting,
    at_most: None,
    confidence: 0.95,
    flights: 100_000,
    runs: 10,
    particles: 16,
    moves: 4,
    seed: 0,
};

/// -Φ⁻¹(p) of 1e-3, 1e-6 and 1e-9.
const BETA: [(f64, f64); 3] =
    [(1e-3, 3.090_232_306_167_814), (1e-6, 4.753_424_308_822_899), (1e-9, 5.997_807_015_007_687)];

/// A limit that is linear in four inputs: fails with probability Φ(-beta).
fn linear(beta: f64) -> impl Fn(&Point) -> Option<f64> + Sync {
    move |point| Some(beta - point.normals.iter().zip([0.8, -0.4, 0.4, 0.2]).map(|(u, a)| a * u).sum::<f64>())
}

fn estimate(score: &(impl Fn(&Point) -> Option<f64> + Sync), options: &Options) -> Estimate {
    estimate_with(4, false, score, options, &|_, _| {})
}

#[test]
fn linear_limits_are_met_down_to_a_billionth_within_a_factor_of_two() {
    for (p, beta) in BETA {
        let mut within = 0;
        for seed in 0..20 {
            let found = estimate(&linear(beta), &Options { seed, ..OPTIONS });
            assert!(found.runs.iter().all(|run| run.end == RunEnd::Failed));
            assert!(found.flights <= 10_000 || p < 1e-6, "{} flights for {p}", found.flights);
            within += usize::from((p / 2.0..=p * 2.0).contains(&found.interval.estimate));
        }
        assert!(within >= if p < 1e-6 { 17 } else { 18 }, "{within} of 20 estimates of {p} are within a factor of 2");
    }
}

/// Binomial slack: of 200 intervals of 95 %, fewer than 183 contain the truth with a probability below 1 in 1,000.
#[test]
fn intervals_contain_the_truth_as_often_as_they_say() {
    let (p, beta) = (1e-4, 3.719_016_485_455_709);
    let contains = |seed: &u64| {
        let interval = estimate(&linear(beta), &Options { seed: *seed, ..OPTIONS }).interval;
        (interval.lower..=interval.upper).contains(&p)
    };
    let covered = (0..200).filter(contains).count();
    assert!(covered >= 183, "{covered} of 200");
}

/// P(|u| > b) = 2 Φ(-b), in two regions on opposite sides; P(|(u1, u2)| > r) = exp(-r²/2), in all directions.
#[test]
fn failures_in_several_regions_are_counted_together() {
    let both = |point: &Point| Some(4.753_424_308_822_899 - point.normals[0].abs());
    let ring = |point: &Point| Some(5.0 - point.normals[0].hypot(point.normals[1]));
    let of = |score: &(dyn Fn(&Point) -> Option<f64> + Sync)| {
        let intervals =
            (0..40).map(|seed| estimate(&|point: &Point| score(point), &Options { seed, ..OPTIONS }).interval);
        intervals.collect::<Vec<_>>()
    };
    for (intervals, p) in [(of(&both), 2e-6), (of(&ring), (-12.5_f64).exp())] {
        let covered = intervals.iter().filter(|it| (it.lower..=it.upper).contains(&p)).count();
        assert!(covered >= 34, "{covered} of 40 intervals contain {p}");
    }
}

#[test]
fn splitting_agrees_with_plain_draws() {
    let p = 1e-3;
    let plain = Options { method: Method::MonteCarlo, flights: 40_000, ..OPTIONS };
    let found = estimate(&linear(BETA[0].1), &plain);
    assert!((found.interval.lower..=found.interval.upper).contains(&p), "{:?}", found.interval);
    // 40 failures are expected, with a standard deviation of 6.3.
    assert!((0.5e-3..1.5e-3).contains(&found.interval.estimate) && found.runs.is_empty() && found.flights == 40_000);
}

#[test]
fn the_question_is_answered_yes_no_or_undecided() {
    let answer = |beta: f64, at_most: f64| {
        let options = Options { at_most: Some(at_most), ..OPTIONS };
        decide(estimate(&linear(beta), &options).interval, at_most)
    };
    assert_eq!(answer(BETA[2].1, 1e-6), Decision::Yes);
    assert_eq!(answer(BETA[0].1, 1e-6), Decision::No);
    assert_eq!(answer(BETA[1].1, 1e-6), Decision::Undecided);
}

/// What never fails is bounded from above, and costs no more than the question needs.
#[test]
fn what_never_fails_has_an_upper_bound() {
    let never = |point: &Point| Some(linear(0.0)(point)?.exp());
    let found = estimate(&never, &Options { at_most: Some(1e-4), ..OPTIONS });
    assert!(found.interval.estimate == 0.0 && found.interval.upper < 1e-4, "{:?}", found.interval);
    assert!(found.runs.iter().all(|run| run.end == RunEnd::Rarer) && found.flights < 12_000);
    let short = estimate(&never, &Options { flights: 1000, ..OPTIONS });
    assert!(short.runs.iter().all(|run| run.end == RunEnd::OutOfFlights));
    assert!(short.flights <= 1000 + 10 * OPTIONS.moves && short.interval.lower == 0.0 && short.interval.upper > 1e-4);
}

/// Without a margin that guides it, splitting is no better than plain draws, and says so.
#[test]
fn equal_scores_and_invalid_scenarios_end_a_run_without_a_claim() {
    let blind = estimate(&|_| Some(1.0), &OPTIONS);
    assert!(
        blind.runs.iter().all(|run| run.end == RunEnd::Stuck) && blind.interval.upper == 1.0,
        "{:?}",
        blind.interval
    );
    let invalid = estimate(&|_| None, &OPTIONS);
    assert!(invalid.runs.iter().all(|run| run.end == RunEnd::Invalid) && invalid.flights == 0);
    let always = estimate(&|_| Some(-1.0), &OPTIONS);
    assert!(always.interval.estimate == 1.0 && always.interval.lower > 0.9, "{:?}", always.interval);
}

/// Scores in steps: many particles are removed at once. The limit lies on a step, so that p stays Φ(-beta).
#[test]
fn scores_in_steps_are_estimated_too() {
    let (p, beta) = BETA[0];
    let steps = |point: &Point| linear(beta)(point).map(|score| (score * 4.0).ceil());
    let contains = |seed: &u64| {
        let interval = estimate(&steps, &Options { seed: *seed, ..OPTIONS }).interval;
        (interval.lower..=interval.upper).contains(&p)
    };
    let covered = (0..40).filter(contains).count();
    assert!(covered >= 34, "{covered} of 40");
}

/// Invalid scenarios are not among the possible ones: P(u > 1 | u > 0) = 2 Φ(-1).
#[test]
fn the_probability_is_that_among_valid_scenarios() {
    let half = |point: &Point| (point.normals[0] > 0.0).then(|| 1.0 - point.normals[0]);
    for method in [Method::Splitting, Method::MonteCarlo] {
        let found = estimate(&half, &Options { method, flights: 4000, ..OPTIONS });
        assert!((found.interval.lower..=found.interval.upper).contains(&0.317_310_5), "{:?}", found.interval);
    }
}

/// A random seed is one more input: here it adds a normal number, so that the limit is at beta / √2.
#[test]
fn random_seeds_are_part_of_the_probability() {
    let noise = |seed: u64| {
        use rand_distr::{Distribution, StandardNormal};
        let normal: f64 = StandardNormal.sample(&mut scenarios::stream(seed, "test"));
        normal
    };
    let (p, beta) = BETA[0];
    let score = |point: &Point| Some(beta * 2.0_f64.sqrt() - point.normals[0] - noise(point.seed?));
    let contains = |seed: &u64| {
        let options = Options { moves: 8, seed: *seed, ..OPTIONS };
        let interval = estimate_with(1, true, &score, &options, &|_, _| {}).interval;
        (interval.lower..=interval.upper).contains(&p)
    };
    let covered = (0..40).filter(contains).count();
    assert!(covered >= 34, "{covered} of 40");
}

#[test]
fn the_likeliest_failure_is_near_the_design_point() {
    let found = estimate(&linear(BETA[1].1), &OPTIONS);
    let length = super::length(&found.likeliest.unwrap()).sqrt();
    assert!((4.753..5.3).contains(&length), "{length}");
}

#[test]
fn the_number_of_threads_decides_nothing() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| estimate(&linear(3.0), &OPTIONS).runs)
    };
    assert_eq!(with(1), with(5));
}
