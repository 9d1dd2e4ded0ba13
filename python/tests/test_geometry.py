"""Geometry and the guard."""

import numpy as np
import pytest

import uav_harness as harness


@pytest.fixture(scope="module")
def scenario():
    return harness.Scenario.load("shipped:paper-map")


def test_distance_and_gradient_agree(scenario):
    random = np.random.default_rng(1)
    points = random.uniform([-25, -14, 0.5], [25, 12, 3.5], (500, 3))
    at = harness.signed_distance(scenario, points)
    step = 1e-4
    for axis in range(3):
        moved = points.copy()
        moved[:, axis] += step
        change = (harness.signed_distance(scenario, moved).distance_m - at.distance_m) / step
        assert np.median(np.abs(change - at.gradient[:, axis])) < 1e-3
    lengths = np.linalg.norm(at.gradient, axis=1)
    assert np.median(np.abs(lengths - 1)) < 1e-6
    assert set(at.obstacle) <= {f"block-{index}" for index in range(1, 11)}


def test_inside_is_negative():
    forest = harness.Scenario.load("shipped:forest")
    tree = forest["world"]["cylinders"][4]
    at = harness.signed_distance(forest, [*tree["center_m"], 1.0])
    assert at.distance_m[0] == pytest.approx(-tree["radius_m"]) and at.obstacle == [tree["name"]]


def test_a_spline_and_its_cubics_are_one_curve():
    points = np.random.default_rng(2).normal(size=(9, 3))
    spline = harness.BSpline(points, 0.4)
    times = np.linspace(0, spline.duration_s, 101)
    positions, velocities = spline.motion().at(times)
    np.testing.assert_allclose(positions, spline.at(times), atol=1e-12)
    np.testing.assert_allclose(velocities, spline.at(times, 1), atol=1e-9)
    step = 1e-5
    inner = times[1:-1]
    slope = (spline.at(inner + step, 1) - spline.at(inner - step, 1)) / (2 * step)
    assert np.quantile(np.abs(slope - spline.at(inner, 2)), 0.9) < 1e-5
    with pytest.raises(harness.InvalidInput, match="n >= 4"):
        harness.BSpline(points[:3], 0.4).at(0.0)


def test_motions_that_are_none_are_refused():
    with pytest.raises(harness.InvalidInput, match="as many of each"):
        harness.Motion([0.0, 1.0], [[0, 0, 0]], [[0, 0, 0]]).at(0.5)
    with pytest.raises(harness.InvalidInput):
        harness.Motion([1.0, 0.0], np.zeros((2, 3)), np.zeros((2, 3))).at(0.5)
    assert np.isnan(harness.Motion([0.0, 1.0], np.zeros((2, 3)), np.zeros((2, 3))).at(2.0)[0]).all()


def test_the_guard_answers_as_the_judge(scenario):
    start = [25.0, 0.0, 2.0]
    guard = harness.Guard(scenario)
    spline = harness.BSpline(np.array([start] * 3 + [[24, 0, 2], [22, 0.5, 2]] + [[21.0, 1, 2]] * 3), 1.0)
    candidate = spline.motion()
    assessment = guard.judge(candidate, measured=(0.0, start, [0.0, 0.0, 0.0]))
    report = harness.check(scenario, candidate)
    for margin in assessment.margins[2:]:
        judged = report.check(margin.check)
        assert margin.status == judged.status
        assert margin.margin == pytest.approx(judged.margin, rel=0.06)
    away = guard.judge(candidate, measured=(0.0, [25.0, 5.0, 2.0], [0.0, 0.0, 0.0]))
    assert away.status == "fail" and away.check("start.position").status == "fail" and not away.passed
    broken = guard.judge(harness.Motion([0.0, np.nan], [start] * 2, np.zeros((2, 3))))
    assert broken.status == "fail" and broken.reason


def test_the_guard_knows_what_it_is_told(scenario):
    guard = harness.Guard(scenario)
    through = harness.Motion([0.0, 60.0], [[25.0, 0.0, 2.0], [-25.0, -3.0, 2.0]], np.zeros((2, 3)))
    hit = guard.judge(through).check("plan.clearance")
    assert hit.status == "fail" and hit.of.startswith("block-")
    empty = {key: value for key, value in scenario.to_dict()["world"].items() if key == "map"}
    guard.set_world(scenario.edited({"world": empty}))
    assert guard.judge(through).check("plan.clearance").of == "map frame"
    with pytest.raises(harness.InvalidInput, match="found the family fixed wing"):
        harness.Guard(harness.Scenario.load("shipped:rendezvous-1"))
