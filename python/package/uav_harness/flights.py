"""Plans, flights and verdicts."""

from __future__ import annotations

import html
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from uav_harness import native
from uav_harness.geometry import Motion
from uav_harness.planning import InLoopPlanner, Planner, replan_by
from uav_harness.scenarios import Scenario
from uav_harness.tables import Table, columns_of

Progress = Callable[[str], object]
"""Receives lines of text during a long call, `print` for example."""


class Plan:
    """A complete plan: what was missing has been reconstructed."""

    def __init__(self, inner: native.Plan) -> None:
        self._native = inner

    @classmethod
    def read(cls, scenario: Scenario, plan: Any, name: str = "plan") -> Plan:
        """Reads a plan for a scenario.

        `plan`: the path of a CSV, JSON or Parquet file; columns (a dict, a data frame of pandas or polars, an Arrow stream)
        with one row per vehicle and time, as in `harness check --help`; a `Motion` for a single multirotor; a reply of the
        planner protocol (a dict with `trajectories`); or a `Plan`. `name`: name of the planner.

        Raises InvalidInput with row, column and remedy.
        """
        if isinstance(plan, Plan):
            return plan
        if isinstance(plan, str | PathLike):
            return cls(native.read_plan_file(scenario._native, plan))
        if isinstance(plan, Mapping) and ("trajectories" in plan or "status" in plan):
            reply = {"protocol": 2, "status": "solved", **plan}
            text = json.dumps(reply, default=lambda value: value.tolist())
            return cls(native.read_plan_reply(scenario._native, name, scenario.seed, text))
        columns = plan.columns() if isinstance(plan, Motion) else columns_of(plan)
        return cls(native.read_plan_tables(scenario._native, name, _by_vehicle(scenario, columns)))

    def to_dict(self) -> dict[str, Any]:
        """`plan.json` as data."""
        plan: dict[str, Any] = json.loads(self._native.to_json())
        return plan

    def save(self, path: str | PathLike[str]) -> None:
        """Writes the plan as .json or .csv."""
        is_csv = Path(path).suffix == ".csv"
        Path(path).write_text(self._native.to_csv() if is_csv else self._native.to_json())


def _by_vehicle(scenario: Scenario, columns: Mapping[str, Any]) -> list[tuple[str, Any, list[tuple[str, Any]]]]:
    """One table per vehicle: its name, its times, its other columns."""
    if "t_s" not in columns:
        raise native.InvalidInput(f"plan: found the columns {', '.join(columns)}, expected `t_s` with the time in s")
    vehicles = columns.get("vehicle")
    if vehicles is None:
        if len(scenario.vehicles) > 1:
            raise native.InvalidInput("plan: found no column `vehicle`, expected one: the scenario has several vehicles")
        rows_of = {scenario.vehicles[0]: slice(None)}
    else:
        names = np.asarray(vehicles).astype(str)
        rows_of = {str(name): names == name for name in dict.fromkeys(names)}

    def numbers(name: str, rows: Any) -> Any:
        try:
            return np.ascontiguousarray(np.asarray(columns[name])[rows], dtype=np.float64)
        except ValueError as error:
            raise native.InvalidInput(f"plan: {name}: {error}, expected numbers") from error

    others = [name for name in columns if name not in ("t_s", "vehicle")]
    return [
        (vehicle, numbers("t_s", rows), [(name, numbers(name, rows)) for name in others])
        for vehicle, rows in rows_of.items()
    ]


class Flight:
    """A simulated flight, with the plan that was flown."""

    def __init__(self, inner: native.Flight) -> None:
        self._native = inner

    @property
    def plan(self) -> Plan:
        """The plan; of in-loop planners, the references that the vehicles followed."""
        return Plan(self._native.plan)

    @property
    def is_flown(self) -> bool:
        """Whether there was a plan that could be flown."""
        return self._native.is_flown

    @property
    def vehicles(self) -> list[str]:
        """Names of the vehicles with a log."""
        return self._native.vehicles

    def log(self, vehicle: str | None = None) -> Table:
        """The log of one vehicle, one row per step, or of all of them with a column `vehicle`.

        `t_s`, position `x_m`.., velocity `vx_mps`.., attitude (quaternion, world from body), wind, measurements, reference,
        commands and controls, and those of a load: the columns of `harness run --record parquet`.
        """
        if vehicle is not None:
            return Table(self._columns(self.vehicles.index(vehicle)))
        logs = [self._columns(index) for index in range(len(self.vehicles))]
        names = np.repeat(np.array(self.vehicles), [len(log["t_s"]) for log in logs]) if logs else np.array([])
        joined = {name: np.concatenate([log[name] for log in logs]) for name in (logs[0] if logs else ())}
        return Table({"vehicle": names, **joined})

    def _columns(self, index: int) -> dict[str, Any]:
        return {name: np.frombuffer(numbers) for name, numbers in self._native.columns(index)}

    def to_arrow(self) -> Any:
        """The log of all vehicles as a pyarrow table."""
        return self.log().to_arrow()

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self.log().__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return f"<Flight of {', '.join(self.vehicles) or 'nothing'}>"


@dataclass(frozen=True)
class Check:
    """One check of a verdict."""

    name: str
    """Group and name, as `flight.separation`."""
    status: str
    """`pass`, `fail`, `undecided` or `skip`."""
    unit: str
    value: float | None = None
    """What was measured, in `unit`."""
    limit: float | None = None
    margin: float | None = None
    """Distance to the limit, positive when it is kept, in `unit`."""
    lower: float | None = None
    upper: float | None = None
    at_s: float | None = None
    between: list[str] = field(default_factory=list)
    """The vehicles and obstacles concerned."""
    advisory: bool = False
    reason: str | None = None


class Report:
    """A verdict with everything that it is about."""

    def __init__(self, inner: native.Judged, flight: Flight) -> None:
        self._native = inner
        self.flight = flight
        self._fields: dict[str, Any] = json.loads(inner.report)

    @property
    def verdict(self) -> str:
        """`pass`, `fail` or `no-plan`."""
        verdict: str = self._fields["verdict"]
        return verdict

    @property
    def passed(self) -> bool:
        """Whether every deciding check passed."""
        return self.verdict == "pass"

    @property
    def checks(self) -> list[Check]:
        """Every check, in the order nodes, plan, flight."""
        return [Check(**check) for check in self._fields["checks"]]

    def check(self, name: str) -> Check:
        """The check of this name. Raises KeyError."""
        for check in self.checks:
            if check.name == name:
                return check
        raise KeyError(name)

    @property
    def failed(self) -> list[Check]:
        """The deciding checks that failed or are undecided."""
        return [check for check in self.checks if check.status in ("fail", "undecided") and not check.advisory]

    @property
    def metrics(self) -> dict[str, Any]:
        """Figures without a limit."""
        metrics: dict[str, Any] = self._fields["metrics"]
        return metrics

    @property
    def plan(self) -> Plan:
        """The plan."""
        return self.flight.plan

    def to_dict(self) -> dict[str, Any]:
        """`report.json` as data."""
        return self._fields

    def checks_table(self) -> Table:
        """The checks as columns; numbers that are missing are NaN."""
        rows = self.checks
        words = {name: np.array([str(getattr(row, name) or "") for row in rows]) for name in ("name", "status", "unit", "reason")}
        between = np.array([", ".join(row.between) for row in rows])
        numbers = {
            name: np.array([np.nan if (value := getattr(row, name)) is None else value for row in rows], dtype=float)
            for name in ("value", "limit", "margin", "lower", "upper", "at_s")
        }
        return Table({**words, "between": between, **numbers})

    def save_rrd(self, path: str | PathLike[str]) -> None:
        """Writes the recording for rerun."""
        self.save(Path(path).with_suffix(".rrd"))

    def save(self, path: str | PathLike[str]) -> None:
        """Writes a recording: .rrd (rerun), .mcap (Foxglove) or .parquet (the log)."""
        self._native.save(path)

    def __repr__(self) -> str:
        head = f"<Report {self.verdict.upper()}  {self._fields['scenario']} · {self._fields['planner']}"
        return "\n  ".join([head, *(_line(check) for check in self.failed or self._key_checks())]) + ">"

    def _key_checks(self) -> list[Check]:
        keys = ("plan.separation", "plan.clearance", "flight.separation", "flight.clearance", "flight.tracking_max")
        return [check for check in self.checks if check.name in keys and check.margin is not None]

    def _repr_html_(self) -> str:
        cells = ["check", "status", "value", "limit", "margin", "unit", "at s", "between, remarks"]
        header = "".join(f"<th>{cell}</th>" for cell in cells)
        rows = "".join(_html_row(check) for check in self.checks if check.status != "skip")
        title = html.escape(f"{self.verdict.upper()}  {self._fields['scenario']} · {self._fields['planner']}")
        return f"<b>{title}</b><table><tr>{header}</tr>{rows}</table>"


def _line(check: Check) -> str:
    margin = "" if check.margin is None else f" {check.margin:+.3f} {check.unit}"
    where = "" if check.at_s is None else f" at {check.at_s:.2f} s"
    who = f" ({' and '.join(check.between)})" if check.between else ""
    return f"{check.name} {check.status}{margin}{where}{who}"


def _html_row(check: Check) -> str:
    numbers = (check.value, check.limit, check.margin)
    texts = ["" if number is None else f"{number:.3f}" for number in numbers]
    when = "" if check.at_s is None else f"{check.at_s:.2f}"
    remarks = ", ".join([*check.between, *filter(None, [check.reason])])
    cells = [check.name, check.status, *texts, check.unit, when, remarks]
    return "<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>"


def run(
    scenario: Scenario,
    planner: str | Planner | InLoopPlanner | None = None,
    *,
    seed: int | None = None,
    progress: Progress | None = None,
) -> Report:
    """Plans, flies and judges.

    `planner`: the name of a planner (default: the one that the scenario names), a function from the request to a plan, or an
    object with `replan(observation)`. Exceptions of the planner are passed on. `seed`: in place of the scenario's.

    Other threads run meanwhile; Ctrl-C ends the call. Raises InvalidInput, and Bug for a bug of the package.

    >>> def straight(request):
    ...     vehicle = request["vehicles"][0]
    ...     start, goal = (vehicle[end]["position_m"] for end in ("start", "goal"))
    ...     return Motion([0.0, 60.0], [start, goal], [[0.0, 0.0, 0.0]] * 2)
    >>> report = run(Scenario.load("shipped:trap"), straight)
    >>> report.verdict, [check.name for check in report.failed if check.name == "plan.clearance"]
    ('fail', ['plan.clearance'])
    """
    return judge(scenario, _flown(scenario, planner, _seed(scenario, seed), progress))


def _flown(scenario: Scenario, planner: Any, seed: int, progress: Progress | None) -> Flight:
    inner = scenario._native
    if planner is None or isinstance(planner, str):
        return Flight(native.fly_registered(inner, planner or scenario.planner, seed, progress))
    name = _name_of(planner)
    if hasattr(planner, "replan"):
        return Flight(native.fly_in_loop(inner, name, replan_by(planner), seed, progress))
    plan = Plan.read(scenario, planner(scenario.request(seed)), name)
    return Flight(native.fly_plan(inner, plan._native, seed, progress))


def _name_of(planner: Any) -> str:
    name = getattr(planner, "__name__", type(planner).__name__)
    return "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in name).strip("-") or "planner"


def _seed(scenario: Scenario, seed: int | None) -> int:
    return scenario.seed if seed is None else seed


def simulate(
    scenario: Scenario, plan: Any, *, seed: int | None = None, progress: Progress | None = None
) -> Flight:
    """Flies a plan on the nonlinear model, with a tracking controller, in the scenario's wind; without a verdict.

    `plan`: in any form that `Plan.read` takes.
    """
    read = Plan.read(scenario, plan)
    return Flight(native.fly_plan(scenario._native, read._native, _seed(scenario, seed), progress))


def check(
    scenario: Scenario,
    plan: Any,
    *,
    name: str = "plan",
    seed: int | None = None,
    progress: Progress | None = None,
) -> Report:
    """Flies and judges a plan that exists, in any form that `Plan.read` takes."""
    read = Plan.read(scenario, plan, name)
    return judge(scenario, Flight(native.fly_plan(scenario._native, read._native, _seed(scenario, seed), progress)))


def judge(scenario: Scenario, flight: Flight) -> Report:
    """Judges a flight, against the limits of another scenario too: an edited one, for example."""
    return Report(native.judge(scenario._native, flight._native), flight)
