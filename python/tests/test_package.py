"""The package from end to end, installed from its wheel, away from the repository."""

import json
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import uav_harness as harness

COMMAND = Path(sys.executable).with_name("harness")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture(scope="module")
def scenario():
    return harness.Scenario.load("shipped:paper-map")


@pytest.fixture(scope="module")
def report(scenario):
    return harness.run(scenario, "rrt-star", seed=1)


def command(*arguments):
    return subprocess.run([COMMAND, *arguments], capture_output=True, text=True, timeout=300)


def without_times(report):
    """The part of a report that does not depend on the machine."""
    plan = {key: value for key, value in report["plan"].items() if key not in ("wall_s", "distributed_s")}
    return {**report, "plan": plan, "timings": None}


def columns(report):
    """The plan of a report as columns."""
    trajectory = report.plan.to_dict()["trajectories"][0]
    return {name: np.array(values) for name, values in table_of(trajectory).items()}


def table_of(trajectory):
    states = trajectory["states"]
    names = ("x_m", "y_m", "z_m"), ("vx_mps", "vy_mps", "vz_mps")
    table = {"t_s": trajectory["times_s"] if "times_s" in trajectory else trajectory["t_s"]}
    for key, axes in zip(("position_m", "velocity_mps"), names, strict=True):
        for axis, name in enumerate(axes):
            table[name] = [state[key][axis] for state in states]
    return table


def test_the_report_is_that_of_the_command(report):
    ran = command("run", "--name", "paper-map", "-p", "rrt-star", "--seed", "1", "--record", "none", "-q")
    assert ran.returncode == (0 if report.passed else 1), ran.stderr
    written = json.loads(Path("out/paper-map/rrt-star/report.json").read_text())
    assert without_times(written) == without_times(report.to_dict())


def test_the_command_needs_no_checkout():
    listed = command("list", "--json")
    names = {scenario["name"] for scenario in json.loads(listed.stdout)["scenarios"]}
    assert names == set(harness.shipped()) and "rendezvous-7" in names
    version = command("--version").stdout
    assert "commit" in version and "features rrd, mcap, parquet" in version, version
    assert command("run", "nowhere.toml").returncode == 2


def test_a_plan_in_any_form_has_one_verdict(scenario, report, tmp_path):
    import pandas
    import polars
    import pyarrow

    plan = columns(report)
    frames = [
        plan,
        harness.Table(plan),
        pandas.DataFrame(plan),
        polars.DataFrame(plan),
        pyarrow.table(plan),
        {**plan, "vehicle": np.array(["uav-1"] * len(plan["t_s"]))},
    ]
    pandas.DataFrame(plan).to_csv("plan.csv", index=False)
    report.plan.save("plan.json")
    expected = [(check.name, check.status, check.margin) for check in harness.check(scenario, plan).checks]
    assert [status for _, status, _ in expected].count("skip") < len(expected) / 2
    for form in [*frames, "plan.csv", Path("plan.json")]:
        checks = harness.check(scenario, form).checks
        assert [(check.name, check.status, check.margin) for check in checks] == expected, type(form)


def test_errors_have_the_text_of_the_command(scenario, report):
    plan = columns(report)
    plan["z_m"][3] = np.inf
    with pytest.raises(harness.InvalidInput, match="plan, row 4: z_m of uav-1: found inf"):
        harness.check(scenario, plan)
    with pytest.raises(harness.InvalidInput, match="expected `t_s`"):
        harness.check(scenario, {"x_m": [1.0]})
    with pytest.raises(harness.InvalidInput, match="did you mean `rrt-star`"):
        harness.run(scenario, "rrt-stra")
    with pytest.raises(harness.InvalidInput, match="cannot handle this scenario"):
        harness.run(scenario, "fleet-scp")
    Path("bad.toml").write_text(scenario.to_toml().replace('name = "paper-map"', 'name = "bad"\nnam = 1'))
    with pytest.raises(harness.InvalidInput) as raised:
        harness.Scenario.load("bad.toml")
    assert str(raised.value).startswith("bad.toml:") and "nam: found an unknown key" in str(raised.value)
    assert "nam: found an unknown key" in " ".join(command("run", "bad.toml").stderr.split())
    with pytest.raises(harness.InvalidInput):
        harness.Scenario.load("shipped:paper-mop")
    with pytest.raises(TypeError, match="found int"):
        harness.check(scenario, 3)


def test_tables_go_to_data_frames(report):
    import pandas
    import polars

    log = report.flight.log()
    arrow = log.to_arrow()
    assert report.flight.to_arrow().num_rows == log.rows
    assert arrow.num_rows == log.rows and arrow.column_names == list(log)
    assert arrow.column("x_m").chunk(0).buffers()[1].address == log["x_m"].ctypes.data, "not copied"
    assert polars.DataFrame(report.flight).height == log.rows
    assert len(pandas.DataFrame(report.flight.log("uav-1"))) == log.rows
    checks = polars.DataFrame(report.checks_table())
    assert checks.filter(polars.col("status") == "fail").height == sum(c.status == "fail" for c in report.checks)


def test_a_report_shows_itself(report):
    assert repr(report).startswith(f"<Report {report.verdict.upper()}  paper-map · rrt-star")
    assert "plan.clearance" in repr(report)
    html = report._repr_html_()
    assert html.count("<tr>") == 1 + sum(check.status != "skip" for check in report.checks)
    assert "<td>plan.clearance</td>" in html


@pytest.mark.parametrize("name", ["flight.rrd", "flight.mcap", "flight.parquet"])
def test_recordings_are_written(report, name):
    report.save(name)
    assert Path(name).stat().st_size > 10_000
    with pytest.raises(harness.InvalidInput, match="written as .rrd"):
        report.save("flight.txt")


def test_judging_again_finds_other_limits(scenario, report):
    again = harness.judge(scenario, report.flight)
    assert without_times(again.to_dict()) == without_times(report.to_dict())
    tightened = scenario.edited({"verdict.tracking_max_m": 1e-6})
    assert harness.judge(tightened, report.flight).check("flight.tracking_max").status == "fail"


class Straight:
    """Flies towards the goal at 1 m/s, 3 s ahead, through everything."""

    def __init__(self, goal):
        self.goal = np.array(goal)
        self.seen = []

    def replan(self, observation):
        self.seen.append(observation)
        velocity, lead_s = np.array(observation["velocity_mps"]), observation["takes_effect_s"] - observation["t_s"]
        here = observation["position_m"] + velocity * lead_s
        away = self.goal - here
        direction = away / max(np.linalg.norm(away), 1e-9)
        ahead = here + direction * min(1.5, np.linalg.norm(away))
        begin = observation["takes_effect_s"]
        return [begin, begin + 3.0], [here, ahead], [velocity, np.zeros(3)]


def test_an_in_loop_planner_is_called_and_flown(scenario):
    planner = Straight([-25.0, -3.0, 2.0])
    report = harness.run(scenario.edited({"simulation.max_duration_s": 6.0}), planner)
    assert len(planner.seen) > 10 and planner.seen[0]["vehicle"] == "uav-1"
    assert len(planner.seen[0]["known"]["prisms"]) == 10
    log = report.flight.log("uav-1")
    assert log["x_m"][-1] < 24.0, "it flew west"
    assert report.check("flight.planner").status == "pass", report.check("flight.planner")


def test_keeping_the_reference_hovers(scenario):
    class Keeps:
        def replan(self, observation):
            return None

    report = harness.run(scenario.edited({"simulation.max_duration_s": 2.0}), Keeps())
    log = report.flight.log("uav-1")
    assert np.ptp(log["x_m"]) < 0.1 and not report.passed


def test_exceptions_of_planners_are_passed_on(scenario):
    class Fails:
        def replan(self, observation):
            raise ZeroDivisionError("on purpose")

    def fails(request):
        raise KeyError("on purpose")

    with pytest.raises(ZeroDivisionError, match="on purpose"):
        harness.run(scenario, Fails())
    with pytest.raises(KeyError):
        harness.run(scenario, fails)

    class Nonsense:
        def replan(self, observation):
            return {"path": []}

    with pytest.raises(harness.InvalidInput, match="its reply is invalid"):
        harness.run(scenario, Nonsense())


def test_a_function_sees_no_disturbances_and_may_have_no_plan():
    windy = harness.Scenario.load("shipped:rendezvous-7-wind")
    seen = {}

    def gives_up(request):
        seen.update(request, scenario=None)
        return {"status": "no-plan", "reason": "it did not try"}

    report = harness.run(windy, gives_up)
    assert report.verdict == "no-plan" and not report.flight.is_flown and report.flight.log().rows == 0
    assert len(seen["vehicles"]) == 7 and "wind" not in json.dumps(seen)
    assert "it did not try" in json.dumps(report.to_dict()["plan"])


def test_other_threads_run_and_progress_is_shown():
    scenario = harness.Scenario.load("shipped:forest")
    lines, ticks, over = [], [], threading.Event()

    def tick():
        while not over.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    report = harness.run(scenario, progress=lines.append)
    over.set()
    thread.join()
    assert report.flight.is_flown
    assert any(line.startswith("flying: ") for line in lines), lines
    assert len(ticks) > 5


def test_an_interrupt_ends_a_long_call():
    scenario = harness.Scenario.load("shipped:traffic-1000")
    began = time.monotonic()
    timer = threading.Timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        while True:
            harness.run(scenario)
    assert time.monotonic() - began < 60.0


def test_a_callback_that_fails_ends_the_call():
    def fail(line):
        raise RuntimeError(line)

    with pytest.raises(RuntimeError, match="ing: "):
        while True:
            harness.run(harness.Scenario.load("shipped:forest"), progress=fail)


def test_edits_are_checked(scenario):
    other = scenario.edited({"simulation.seed": 5, "vehicles.0.start.x_m": 24.0})
    assert other.seed == 5 and other["vehicles"][0]["start"]["x_m"] == 24.0 and scenario.seed != 5
    assert harness.Scenario.from_dict(other.to_dict()).to_toml() == other.to_toml()
    path = other.save()
    assert harness.Scenario.load(path).to_toml() == other.to_toml()
    with pytest.raises(harness.InvalidInput, match="unknown key"):
        scenario.edited({"world.wall": 3})
