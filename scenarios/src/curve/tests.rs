use super::{BSpline, Curve, Piece, PieceRounding, distance};

fn polynomial() -> [Vec<f64>; 3] {
    [vec![1.0, -2.0, 0.5, 0.3, -0.2, 0.05, 0.01, -0.004], vec![0.0, 1.0, 0.0, -0.4], vec![2.0]]
}

/// Value of the derivative of this order of `polynomial` at τ, by Horner's rule.
fn exact(order: usize, tau: f64) -> [f64; 3] {
    polynomial().map(|c| {
        let falling = |k: usize| (0..order).map(|i| (k - i) as f64).product::<f64>();
        (order..c.len()).rev().fold(0.0, |sum, k| sum * tau + c[k] * falling(k))
    })
}

fn piece() -> Piece {
    Piece::from_power(3.0, 2.5, &polynomial(), PieceRounding::default())
}

#[test]
fn a_piece_is_its_polynomial_with_all_derivatives() {
    let piece = piece();
    assert_eq!((piece.degree(), piece.t_s), (7, [3.0, 5.5]));
    for u in [0.0, 0.2, 0.5, 0.9, 1.0] {
        for order in 0..=7 {
            let found = super::value(&piece.derivative(order), u);
            assert!(distance(found, exact(order, 2.5 * u)) < 1e-9, "order {order} at {u}: {found:?}");
        }
    }
    assert_eq!(piece.derivative(9), vec![[0.0; 3]]);
}

/// The cubics are compared with the polynomial itself between their nodes: no bound is exceeded.
#[test]
fn the_errors_of_the_cubics_are_bounded() {
    let curve = Curve { vehicle: "uav".into(), pieces: vec![piece()] };
    for aim in [1.0, 0.1, 1e-3] {
        let (nodes, error) = curve.cubics(aim);
        assert!(error.acceleration_mps2 <= aim && nodes.len() > 3);
        let mut largest = [0.0_f64; 2];
        for pair in nodes.windows(2) {
            let h = pair[1].t_s - pair[0].t_s;
            for k in 0..=10 {
                let u = f64::from(k) / 10.0;
                let at = |axis: usize| {
                    let [p0, p1] = [pair[0].position_m[axis], pair[1].position_m[axis]];
                    let [m0, m1] = [pair[0].velocity_mps[axis] * h, pair[1].velocity_mps[axis] * h];
                    let (c2, c3) = (3.0 * (p1 - p0) - 2.0 * m0 - m1, 2.0 * (p0 - p1) + m0 + m1);
                    [p0 + u * (m0 + u * (c2 + u * c3)), (2.0 * c2 + 6.0 * u * c3) / (h * h)]
                };
                let tau = pair[0].t_s + u * h - 3.0;
                let off = |part: usize, order: usize| distance([0, 1, 2].map(|axis| at(axis)[part]), exact(order, tau));
                largest = [largest[0].max(off(0, 0)), largest[1].max(off(1, 2))];
            }
        }
        assert!(
            largest[0] <= error.position_m + 1e-12 && largest[1] <= error.acceleration_mps2 + 1e-6,
            "{largest:?} {error:?}"
        );
        // The bounds are no wild guesses.
        assert!(largest[1] > error.acceleration_mps2 / 20.0, "{largest:?} {error:?}");
    }
}

#[test]
fn a_cubic_stays_one_cubic_without_error() {
    let coefficients = [vec![1.0, 2.0, -1.0, 0.5], vec![0.0], vec![1.0, 1.0]];
    let piece = Piece::from_power(0.0, 4.0, &coefficients, PieceRounding::default());
    let (nodes, error) = Curve { vehicle: "uav".into(), pieces: vec![piece] }.cubics(1e-3);
    assert_eq!((nodes.len(), error.position_m, error.acceleration_mps2), (2, 0.0, 0.0));
    assert!((nodes[1].velocity_mps[0] - (2.0 - 8.0 + 24.0)).abs() < 1e-12);
}

/// Pieces of a uniform cubic B-spline against its matrix form, and continuous to the second derivative.
#[test]
fn a_b_spline_becomes_its_pieces() {
    let points_m: Vec<[f64; 3]> = (0..7).map(|k| [f64::from(k * k), f64::from(k % 3), 1.0]).collect();
    let pieces = BSpline::uniform(3, 0.5, points_m.clone()).pieces();
    assert_eq!((pieces.len(), pieces[0].t_s, pieces[3].t_s), (4, [0.0, 0.5], [1.5, 2.0]));
    for (k, piece) in pieces.iter().enumerate() {
        let u: f64 = 0.3;
        let weights = [
            (1.0 - u).powi(3),
            3.0 * u.powi(3) - 6.0 * u * u + 4.0,
            -3.0 * u.powi(3) + 3.0 * u * u + 3.0 * u + 1.0,
            u.powi(3),
        ];
        let expected = [0, 1, 2].map(|axis| (0..4).map(|i| weights[i] * points_m[k + i][axis]).sum::<f64>() / 6.0);
        assert!(distance(piece.position_m(u), expected) < 1e-12);
    }
    let curve = Curve { vehicle: "uav".into(), pieces };
    assert!(curve.joints().all(|joint| joint.is_rounding));
    for pair in curve.pieces.windows(2) {
        let [last, first] = [pair[0].derivative(2)[1], pair[1].derivative(2)[0]];
        assert!(distance(last, first) < 1e-10);
    }
}

/// With a full knot at both ends the curve begins at its first control point, and a double knot inside is no piece.
#[test]
fn repeated_knots_are_no_pieces() {
    let knots_s = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0];
    let points_m: Vec<[f64; 3]> = (0..5).map(|k| [f64::from(k), 0.0, 0.0]).collect();
    let pieces = BSpline { degree: 2, knots_s, points_m }.pieces();
    assert_eq!(pieces.iter().map(|piece| piece.t_s).collect::<Vec<_>>(), [[0.0, 1.0], [1.0, 2.0]]);
    assert_eq!((pieces[0].points_m[0][0], pieces[1].points_m[2][0]), (0.0, 4.0));
    assert_eq!(pieces[0].points_m[2], pieces[1].points_m[0]);
}

#[test]
fn a_jump_is_told_from_rounding() {
    let line = |begin_s: f64, x_m: f64, rounding_m: f64| {
        let rounding = PieceRounding { position_m: rounding_m, velocity_mps: 0.0 };
        Piece::from_power(begin_s, 1.0, &[vec![x_m, 1.0], vec![0.0], vec![0.0]], rounding)
    };
    let joint = |x_m: f64| {
        let curve = Curve { vehicle: "uav".into(), pieces: vec![line(0.0, 0.0, 5e-7), line(1.0, x_m, 5e-7)] };
        (curve.joints().next().unwrap().is_rounding, curve.cubics(1e-3).0.len())
    };
    assert_eq!(joint(1.0 + 9e-7), (true, 3));
    assert_eq!(joint(1.0 + 2e-6), (false, 4));
}

/// Joining two pieces moves them by half of the rounding, and changes the acceleration by little: the whole piece gives way.
#[test]
fn joining_two_pieces_hardly_changes_their_acceleration() {
    let rounding = PieceRounding { position_m: 5e-6, velocity_mps: 5e-6 };
    let cubic = |begin_s: f64, x_m: f64| {
        Piece::from_power(begin_s, 1.0, &[vec![x_m, 1.0], vec![0.0, 0.0, 0.0, 0.0, 0.1], vec![0.0]], rounding)
    };
    let curve = Curve { vehicle: "uav".into(), pieces: vec![cubic(0.0, 0.0), cubic(1.0, 1.000_004)] };
    assert!(!curve.joints().next().unwrap().is_rounding, "the velocities of y differ");
    let line =
        |begin_s: f64, x_m: f64| Piece::from_power(begin_s, 1.0, &[vec![x_m, 1.0], vec![0.0], vec![0.0]], rounding);
    let curve = Curve { vehicle: "uav".into(), pieces: vec![line(0.0, 0.0), line(1.0, 1.000_004)] };
    let (nodes, error) = curve.cubics(1e-3);
    assert!((nodes[1].position_m[0] - 1.000_002).abs() < 1e-12 && (nodes[1].velocity_mps[0] - 1.0).abs() < 1e-12);
    assert!((error.position_m - 7e-6).abs() < 1e-9, "{error:?}");
    assert!(error.acceleration_mps2 > 1e-6 && error.acceleration_mps2 < 3e-5, "{error:?}");
}
