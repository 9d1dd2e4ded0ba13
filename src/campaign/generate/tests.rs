use std::collections::HashSet;

use super::{Request, kinds};

/// Every kind with its suite's smallest size and its default, and the variant.
fn requests(seeds: std::ops::Range<u64>) -> impl Iterator<Item = Request> {
    kinds().flat_map(move |kind| {
        let [small, ..] = kind.size.suite;
        seeds.clone().flat_map(move |seed| {
            let request = Request::new(kind, seed);
            let variant = kind.variant.map(|_| Request { is_variant: true, ..request });
            [request, Request { size: small, ..request }].into_iter().chain(variant)
        })
    })
}

#[test]
fn every_file_is_a_valid_scenario_of_its_family_that_loads_as_it_says() {
    for request in requests(0..3) {
        let generated = request.generate().unwrap_or_else(|error| panic!("{}: {error}", request.command()));
        let scenario = generated.scenario();
        assert_eq!((scenario.family(), &scenario.name), (request.kind.family, &generated.name));
        assert!(scenario.tags.iter().any(|tag| tag == "generated"));
        let planner = planners::find(&scenario.planner.name).expect("the planner exists");
        assert_eq!((planner.unsupported_reason)(&scenario), None, "{}", generated.name);
        assert!(generated.text.contains(&request.command()), "{}", generated.text);
        assert!(generated.text.lines().all(|line| !line.starts_with('#') || line.len() <= 120), "{}", generated.text);
    }
}

#[test]
fn the_same_request_gives_the_same_file_and_another_seed_another() {
    for request in requests(0..2) {
        let text = |seed| Request { seed, ..request }.generate().unwrap().text;
        assert_eq!(text(3), text(3));
        let body = |text: &str| text.split_once("[world").unwrap().1.to_owned();
        assert_ne!(body(&text(3)), body(&text(4)), "{}", request.name());
    }
}

#[test]
fn names_of_requests_and_kinds_are_unique() {
    let names: Vec<&str> = kinds().map(|kind| kind.name).collect();
    assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{names:?}");
    let ring = Request::new(super::find("ring").unwrap(), 3);
    let variants = [
        ring,
        Request { size: 9, ..ring },
        Request { density: 0.06, ..ring },
        Request { density: 0.005, ..ring },
        Request { density: 0.0055, ..ring },
        Request { is_variant: true, ..ring },
        Request { seed: 4, ..ring },
    ];
    assert_eq!(variants.iter().map(Request::name).collect::<HashSet<_>>().len(), variants.len());
}

#[test]
fn sizes_densities_and_variants_out_of_range_are_refused() {
    for kind in kinds() {
        let request = Request::new(kind, 0);
        assert!(Request { size: kind.size.max + 1, ..request }.generate().is_err());
        assert!(kind.size.min == 0 || Request { size: kind.size.min - 1, ..request }.generate().is_err());
        for density in [-0.01, kind.density.max + 0.01, f64::NAN, f64::INFINITY] {
            assert!(Request { density, ..request }.generate().is_err(), "{} {density}", kind.name);
        }
        assert!(kind.variant.is_some() || Request { is_variant: true, ..request }.generate().is_err());
        assert!(kind.size.suite.iter().all(|size| (kind.size.min..=kind.size.max).contains(size)));
    }
}
