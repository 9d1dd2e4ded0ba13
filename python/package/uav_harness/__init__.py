"""Flies UAV trajectory plans in simulation and judges them: can this be flown, and with what margin in metres?

World frame ENU (x east, y north, z up), SI units, radians. Arrays are NumPy arrays of float64.

>>> import uav_harness as harness
>>> scenario = harness.Scenario.load("shipped:paper-map")
>>> report = harness.run(scenario, planner="rrt-star", seed=1)
>>> report.verdict in ("pass", "fail")
True
>>> report.check("plan.clearance").margin > 0
True
"""

from uav_harness.flights import Check, Flight, Plan, Report, check, judge, run, simulate
from uav_harness.geometry import BSpline, ClosestApproach, Distances, Motion, closest_approach, signed_distance
from uav_harness.guards import Assessment, Guard, Margin
from uav_harness.native import Bug, InvalidInput
from uav_harness.planning import InLoopPlanner, Observation, Planner, Reply
from uav_harness.scenarios import Scenario, planners, shipped
from uav_harness.tables import Table

__all__ = [
    "Assessment",
    "BSpline",
    "Bug",
    "Check",
    "ClosestApproach",
    "Distances",
    "Flight",
    "Guard",
    "InLoopPlanner",
    "InvalidInput",
    "Margin",
    "Motion",
    "Observation",
    "Plan",
    "Planner",
    "Reply",
    "Report",
    "Scenario",
    "Table",
    "check",
    "closest_approach",
    "judge",
    "planners",
    "run",
    "shipped",
    "signed_distance",
    "simulate",
]
