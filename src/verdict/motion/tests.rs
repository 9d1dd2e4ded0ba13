use super::{Knot, Motion, Segment};

fn knot(t_s: f64, x_m: f64, vx_mps: f64) -> Knot {
    Knot { t_s, position_m: [x_m, 0.0, 0.0], velocity_mps: [vx_mps, 0.0, 0.0] }
}

#[test]
fn a_part_of_a_segment_is_the_same_curve() {
    // x = t³ between 1 s and 3 s.
    let segment = Segment::between(&knot(1.0, 1.0, 3.0), &knot(3.0, 27.0, 27.0));
    let part = segment.during(1.5, 2.0);
    let expected = Segment::between(&knot(1.5, 3.375, 6.75), &knot(2.0, 8.0, 12.0));
    for (point, wanted) in part.points_m.iter().zip(expected.points_m) {
        assert!((point[0] - wanted[0]).abs() < 1e-13, "{part:?}");
    }
    assert_eq!(part.t_s, [1.5, 2.0]);
    assert_eq!(segment.during(1.0, 3.0), segment);
}

/// Samples of x = t³/6, 0.1 s apart, and one that follows another within a microsecond: its jerk would be rounding.
#[test]
fn an_interval_far_below_the_others_does_not_decide_the_error_of_interpolation() {
    let cubic = |t_s: f64| knot(t_s, t_s.powi(3) / 6.0, t_s * t_s / 2.0);
    let mut knots: Vec<Knot> = (0..=40).map(|step| cubic(f64::from(step) / 10.0)).collect();
    let deviation_m = |knots: &[Knot]| Motion::new("uav", knots.to_vec()).unwrap().sampled().deviation_m();
    assert!(deviation_m(&knots) < 1e-12);
    knots.insert(20, Knot { position_m: [cubic(1.900_001).position_m[0] + 1e-9, 0.0, 0.0], ..cubic(1.900_001) });
    assert!(deviation_m(&knots) < 1e-12, "{}", deviation_m(&knots));
    // One in the middle of an interval does: a jump of a millimetre is no rounding.
    knots[20] = Knot { position_m: [cubic(1.95).position_m[0] + 1e-3, 0.0, 0.0], ..cubic(1.95) };
    assert!(deviation_m(&knots) > 1e-5, "{}", deviation_m(&knots));
}

/// x = t³/6 for 1 s, then 10⁴ times the jerk for a millisecond: a kink of the controls, and no error of interpolation.
#[test]
fn a_kink_at_a_node_is_no_error_of_interpolation() {
    let cubic = |t_s: f64| knot(t_s, t_s.powi(3) / 6.0, t_s * t_s / 2.0);
    let mut knots: Vec<Knot> = (0..=20).map(|step| cubic(f64::from(step) / 20.0)).collect();
    let after = |later_s: f64| {
        let x_m = 1.0 / 6.0 + later_s / 2.0 + later_s * later_s / 2.0 + 1e4 * later_s.powi(3) / 6.0;
        knot(1.0 + later_s, x_m, 0.5 + later_s + 1e4 * later_s * later_s / 2.0)
    };
    let joined = [&knots[..], &[0.0005, 0.001].map(after)].concat();
    knots.extend([0.0, 0.0005, 0.001].map(after));
    let deviation_m = |knots: Vec<Knot>| Motion::new("uav", knots).unwrap().sampled().deviation_m();
    assert!(deviation_m(knots) < 1e-9);
    // Without a node there, the same change is an error of interpolation.
    assert!(deviation_m(joined) > 0.1);
}

#[test]
fn motions_that_cannot_be_judged_are_refused() {
    let refused = |knots: Vec<Knot>| Motion::new("uav-1", knots).is_err();
    assert!(refused(vec![]));
    assert!(refused(vec![knot(0.0, 0.0, 1.0)]));
    assert!(refused(vec![knot(0.0, 0.0, 1.0), knot(1.0, f64::NAN, 1.0)]));
    assert!(refused(vec![knot(0.0, 0.0, 1.0), knot(1.0, 0.0, f64::INFINITY)]));
    assert!(refused(vec![knot(0.0, 0.0, 1.0), knot(1.0, 1e12, 1.0)]));
    assert!(refused(vec![knot(0.0, 0.0, 1.0), knot(f64::NAN, 0.0, 1.0)]));
    assert!(refused(vec![knot(1.0, 0.0, 1.0), knot(0.0, 0.0, 1.0)]));
    assert!(!refused(vec![knot(0.0, 0.0, 1.0), knot(1.0, 1.0, 1.0)]));
}
