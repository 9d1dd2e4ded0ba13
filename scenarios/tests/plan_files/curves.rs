//! Polynomial pieces, Bezier curves and B-splines.

use scenarios::curve::Curve;
use scenarios::plan_input::{ImportedTrajectory, parse_csv, parse_json};

use crate::tables::hoverer;
use crate::{assert_rejected, scenario};

#[track_caller]
fn curve(text: &str) -> Curve {
    let read = if text.starts_with('{') {
        parse_json("plan.json", text, &hoverer())
    } else {
        parse_csv("plan.csv", text, &hoverer())
    };
    let (_, mut tracks) = read.unwrap_or_else(|error| panic!("{:#?}", error.lines()));
    let Some(ImportedTrajectory::Curve(curve)) = tracks.pop() else { panic!("not a curve") };
    curve
}

fn document(form: &str) -> String {
    format!(r#"{{"trajectories": [{{"vehicle": "uav-1", {form}}}]}}"#)
}

/// x = t² on [0, 1], then x = 1 + 2 τ on [1, 3]; y = 0, z = 2: in four notations.
#[test]
fn notations_of_the_same_curve_agree() {
    let csv = "Duration,x^0,x^1,x^2,y^0,z^0,yaw^0,\n1,0,0,1,0,2,0,\n2,1,2,0,0,2,0,\n";
    let polynomials = document(
        r#""polynomials": [{"duration_s": 1, "x": [0, 0, 1], "y": [], "z": [2]}, {"duration_s": 2, "x": [1, 2], "y": [0], "z": [2]}]"#,
    );
    let bezier = document(
        r#""bezier": [{"duration_s": 1, "points_m": [[0,0,2],[0,0,2],[1,0,2]]}, {"duration_s": 2, "points_m": [[1,0,2],[5,0,2]]}]"#,
    );
    let spline = document(
        r#""b_spline": {"degree": 2, "knots_s": [0,0,0,1,1,3,3,3], "points_m": [[0,0,2],[0,0,2],[1,0,2],[3,0,2],[5,0,2]]}"#,
    );
    for text in [csv.to_owned(), polynomials, bezier, spline] {
        let curve = curve(&text);
        assert_eq!((curve.pieces.len(), curve.end_s()), (2, 3.0), "{text}");
        for (piece, u, x_m) in [(0, 0.5, 0.25), (0, 1.0, 1.0), (1, 0.25, 2.0), (1, 1.0, 5.0)] {
            let found_m = curve.pieces[piece].position_m(u);
            assert!((found_m[0] - x_m).abs() < 1e-12 && found_m[2] == 2.0, "{text}: {found_m:?}");
        }
        assert!(curve.joints().all(|joint| joint.is_rounding), "{text}");
    }
}

/// Two pieces with six decimals, as uav_trajectories writes them: the jump of the last digit is rounding, a larger one is not.
#[test]
fn the_digits_of_a_file_tell_jumps_from_rounding() {
    let text = |x: &str| {
        format!(
            "duration,x^0,x^1,y^0,z^0\n1.000000,0.000000,1.000000,0.000000,2.000000\n1.000000,{x},1.000000,0.000000,2.000000\n"
        )
    };
    let is_rounding = |x: &str| curve(&text(x)).joints().next().unwrap().is_rounding;
    assert!(is_rounding("1.000002") && !is_rounding("1.000010") && !is_rounding("1.500000"));
    // Numbers written by hand are exact.
    let by_hand = curve("duration,x^0,x^1,y^0,z^0\n1,0,1,0,2\n1,1.01,1,0,2\n");
    assert!(!by_hand.joints().next().unwrap().is_rounding);
}

#[test]
fn curves_that_are_none_are_refused() {
    let csv = |text: &str, parts: &[&str]| assert_rejected(parse_csv("plan.csv", text, &hoverer()), parts);
    csv("duration,x^0,x^2,y^0,z^0\n1,0,1,0,2\n", &["without the ones below it"]);
    csv("duration,x^0,y^0\n1,0,0\n", &["z^0"]);
    csv("duration,x^0,y^0,z^0\n0,0,0,2\n", &["plan.csv:2: duration: found 0 s"]);
    csv("duration,x^0,y^0,z^0\n1,0,nan,2\n", &["plan.csv:2: y^0: found \"nan\""]);
    csv("duration,x^0,y^0,z^0\n1,0,0\n", &["plan.csv:2: line: found 3 values"]);
    csv("duration,x^0,y^0,z^0\n1000,0,0,2\n", &["1000 s at the end", "milliseconds"]);
    csv("duration,x^0,y^0,z^0\n", &["no row of `uav-1`"]);
    let json =
        |form: &str, parts: &[&str]| assert_rejected(parse_json("plan.json", &document(form), &hoverer()), parts);
    json(r#""bezier": []"#, &["no piece"]);
    json(r#""bezier": [{"duration_s": -1, "points_m": [[0,0,2]]}]"#, &["-1 s"]);
    json(r#""bezier": [{"duration_s": 1, "points_m": []}]"#, &["0 control points"]);
    json(r#""bezier": [{"duration_s": 1, "points_m": [[0,0,2]]}], "t_s": [0]"#, &["more than one form"]);
    json(r#""b_spline": {"degree": 3, "interval_s": 1, "points_m": [[0,0,2]]}"#, &["5 knots for 1 control points"]);
    json(r#""b_spline": {"degree": 0, "interval_s": 1, "points_m": [[0,0,2]]}"#, &["degree", "1 to 31"]);
    json(r#""b_spline": {"degree": 1, "points_m": [[0,0,2],[1,0,2]]}"#, &["no interval and no knots"]);
}

/// An aircraft cannot jump; a scenario with several vehicles needs their names.
#[test]
fn a_fixed_wing_s_pieces_continue_each_other() {
    let rows = |jump_m: f64| {
        let row = |name: &str, y: f64, x: f64| format!("{name},14,{x},35,{y},400\n");
        let rows =
            [("uav-1", -100.0), ("uav-2", 100.0)].map(|(name, y)| row(name, y, 0.0) + &row(name, y, 490.0 + jump_m));
        format!("vehicle,duration,x^0,x^1,y^0,z^0\n{}", rows.concat())
    };
    let (_, tracks) = parse_csv("plan.csv", &rows(0.0), &scenario()).unwrap();
    assert!(tracks.iter().all(|track| matches!(track, ImportedTrajectory::Curve(_))));
    let error = parse_csv("plan.csv", &rows(0.5), &scenario()).unwrap_err();
    assert!(error.lines()[0].contains("a jump by 0.5 m and 0 m/s at 14 s"), "{:?}", error.lines());
    let unnamed = parse_csv("plan.csv", "duration,x^0,y^0,z^0\n1,0,0,2\n", &scenario());
    assert_rejected(unnamed, &["column `vehicle`", "into one file"]);
}
