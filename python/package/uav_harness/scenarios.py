"""Scenarios: the world, the vehicles, the limits and the disturbances."""

from __future__ import annotations

import copy
import json
from os import PathLike
from pathlib import Path
from typing import Any

from uav_harness import native


class Scenario:
    """A valid scenario. It does not change; edits make another one.

    >>> scenario = Scenario.load("shipped:rendezvous-7")
    >>> scenario.family, len(scenario.vehicles)
    ('fixed-wing', 7)
    >>> windy = scenario.edited({"simulation.seed": 3, "verdict.goal_m": 20.0})
    >>> windy["simulation"]["seed"], scenario["simulation"]["seed"] == 3
    (3, False)
    >>> scenario.edited({"verdict.goal_m": -1.0})
    Traceback (most recent call last):
    ...
    uav_harness.InvalidInput: ...
    """

    def __init__(self, inner: native.Scenario) -> None:
        self._native = inner

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Scenario:
        """Reads a scenario file; `shipped:NAME` is one that the package holds.

        Raises InvalidInput with file, line, field and remedy.
        """
        return cls(native.Scenario.load(path))

    @classmethod
    def from_dict(cls, fields: dict[str, Any]) -> Scenario:
        """A scenario from the keys of a scenario file. Raises InvalidInput."""
        return cls(native.Scenario.from_json(json.dumps(fields, default=_plain)))

    @classmethod
    def from_toml(cls, text: str, name: str) -> Scenario:
        """A scenario from the text of a scenario file; `name` is its file name in messages. Raises InvalidInput."""
        return cls(native.Scenario.from_toml(name, text))

    def to_dict(self) -> dict[str, Any]:
        """The keys of a scenario file, with all defaults."""
        fields: dict[str, Any] = json.loads(self._native.to_json())
        return fields

    def to_toml(self) -> str:
        """The text of a scenario file."""
        return self._native.to_toml()

    def edited(self, fields: dict[str, Any]) -> Scenario:
        """The scenario with other values, by their paths: `{"vehicles.0.start.x_m": 5.0, "simulation.wind": None}`.

        `None` removes a key. Raises InvalidInput if the result is no valid scenario, KeyError for a path into nothing.
        """
        edited = copy.deepcopy(self.to_dict())
        for path, value in fields.items():
            keys: list[Any] = [int(key) if key.isdigit() else key for key in path.split(".")]
            *parents, last = keys
            node: Any = edited
            for key in parents:
                node = node[key] if isinstance(node, list) else node.setdefault(key, {})
            node[last] = value
        return Scenario.from_dict(edited)

    def request(self, seed: int | None = None, time_limit_s: float = 60.0) -> dict[str, Any]:
        """What an external planner receives: everything that is known before the flight, and no disturbances."""
        request: dict[str, Any] = json.loads(self._native.request(seed, time_limit_s))
        return request

    def save(self, folder: str | PathLike[str] = ".") -> Path:
        """Writes the scenario to `folder`, under its name, and returns the path."""
        path = Path(folder) / f"{self.name}.toml"
        path.write_text(self.to_toml())
        return path

    @property
    def name(self) -> str:
        """The name, which is also that of its file."""
        return self._native.name

    @property
    def family(self) -> str:
        """`fixed-wing`, `slung-load` or `multirotor`."""
        return self._native.family

    @property
    def vehicles(self) -> list[str]:
        """The names of the vehicles."""
        return self._native.vehicles

    @property
    def planner(self) -> str:
        """The planner that the scenario names."""
        return self._native.planner

    @property
    def seed(self) -> int:
        """The seed of all random numbers."""
        return self._native.seed

    def __getitem__(self, key: str) -> Any:
        return self.to_dict()[key]

    def __repr__(self) -> str:
        return f"<Scenario {self.name}: {len(self.vehicles)} x {self.family}, planner {self.planner}>"


def shipped() -> list[str]:
    """Names of the scenarios that the package holds, for `Scenario.load("shipped:NAME")`."""
    return native.shipped_names()


def planners() -> list[str]:
    """Names of the planners that the package holds."""
    return [name for name, _ in native.planner_names()]


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"found {type(value).__name__}, expected what JSON can hold")
