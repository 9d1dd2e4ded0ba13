"""Planners in Python: a function before the flight, or an object in the loop."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

Observation = dict[str, Any]
"""What a vehicle knows at one instant: the in-loop request of docs/external-planners.md.

`t_s`, `takes_effect_s`, `position_m`, `velocity_mps`, `acceleration_mps2`, `world_from_body`, `in_force` (the nodes of the
reference in force), `known` (map and static obstacles), `discovered`, `moving`, `neighbours`, `last`, and `vehicle`.
"""

Reply = None | str | Mapping[str, Any] | Sequence[Any]
"""What `replan` returns: nodes to fly, or `None` or a reason to keep the reference in force.

Nodes are a sequence of dicts with `t_s`, `position_m` and `velocity_mps`, or three arrays `(t_s, position_m, velocity_mps)`
of the shapes (n,), (n, 3) and (n, 3). A dict is a whole reply of the protocol: `{"fly": [...]}` or `{"keep": reason}`.
"""

Planner = Callable[[dict[str, Any]], Any]
"""A planner before the flight: from the request (`Scenario.request`) to a plan in any form that `check` takes."""


class InLoopPlanner(Protocol):
    """A planner in the loop, for multirotors. One object plans for all vehicles; `observation["vehicle"]` names the one."""

    def replan(self, observation: Observation) -> Reply:
        """Plans from `observation["takes_effect_s"]` on. Between two nodes the reference is a cubic; after the last it hovers.

        The same observations in the same order must give the same replies.
        """
        ...


def replan_by(planner: InLoopPlanner) -> Callable[[str, str], str]:
    """The planner as a function from the text of a request to that of a reply."""

    def replan(_vehicle: str, request: str) -> str:
        return json.dumps(_reply(planner.replan(json.loads(request))), default=_plain)

    return replan


def _reply(reply: Reply) -> dict[str, Any]:
    if reply is None:
        return {"keep": "the planner keeps the reference in force"}
    if isinstance(reply, str):
        return {"keep": reply}
    if isinstance(reply, Mapping):
        return dict(reply)
    if len(reply) == 3 and np.ndim(reply[0]) == 1 and np.ndim(reply[1]) == 2:
        times, positions, velocities = (np.asarray(array, dtype=float).tolist() for array in reply)
        rows = zip(times, positions, velocities, strict=True)
        return {"fly": [{"t_s": t, "position_m": p, "velocity_mps": v} for t, p, v in rows]}
    return {"fly": list(reply)}


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a reply holds {type(value).__name__}, expected numbers, lists and dicts")
