"""Reads a recording with the library `mcap`, and asserts that everything the scenario has is in it."""

import json
import sys
from collections import defaultdict

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    (metadata,) = reader.iter_metadata()
    assert metadata.name == "harness", metadata
    attached = {attachment.name: json.loads(attachment.data) for attachment in reader.iter_attachments()}
    schemas, messages = {}, defaultdict(list)
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        schemas[channel.topic] = schema.name
        messages[channel.topic].append((message.log_time, decoded))

scenario = metadata.metadata["scenario"]
assert attached.keys() == {"scenario.json", "plan.json", "verdict.json"}, attached.keys()
assert attached["scenario.json"]["name"] == scenario
checks = {check["name"]: check for check in attached["verdict.json"]["checks"]}
scene = {entity.id: entity for entity in messages["/world"][0][1].entities}
frames = {
    transform.child_frame_id: transform for _, poses in messages["/tf"] for transform in poses.transforms
}
times = [time for time, _ in messages["/tf"]]
assert times == sorted(times) and times[0] == 0, times[:3]
for topic in ["/fleet", "/moving"]:
    for entity in messages[topic][0][1].entities if topic in messages else []:
        assert entity.frame_locked and entity.frame_id == entity.id and entity.id in frames, entity


def has(topics):
    assert topics.items() <= schemas.items(), schemas


def smallest(field):
    return min(getattr(distances, field) for _, distances in messages["/distances"])


def pair():
    expected = {"scenario": "pair", "planner": "parallel-scp", "seed": "0", "verdict": "PASS"}
    assert expected.items() <= metadata.metadata.items(), metadata.metadata
    assert attached["verdict.json"]["outcome"] == "pass"
    topics = {
        "/world": "foxglove.SceneUpdate",
        "/fleet": "foxglove.SceneUpdate",
        "/tf": "foxglove.FrameTransforms",
        "/vehicles/uav-1": "aircraft.Aircraft",
        "/vehicles/uav-2": "aircraft.Aircraft",
        "/distances": "distances.Distances",
        "/log": "foxglove.Log",
        "/plots/separation_m/fleet": "point.Point",
        "/limits/separation_m/limit": "point.Point",
        "/limits/tracking_m/limit": "point.Point",
    }
    for quantity in ["n_x", "n_y", "n_z", "airspeed_mps", "altitude_m"]:
        topics |= {f"/limits/{quantity}/{bound}": "point.Point" for bound in ["lowest", "highest"]}
    if 30e9 <= times[-1]:  # shorter flights have no trail
        topics |= {f"/trail/{vehicle}": "foxglove.SceneUpdate" for vehicle in ["uav-1", "uav-2"]}
    assert schemas == topics, schemas.keys() ^ topics.keys()
    poses = messages["/tf"]
    assert 25e9 < times[-1] < 40e9, times[-1]
    first, last = poses[0][1].transforms, poses[-1][1].transforms
    vehicles = ["uav-1", "uav-1/upright", "uav-2", "uav-2/upright"]
    assert [(pose.parent_frame_id, pose.child_frame_id) for pose in first] == [("world", it) for it in vehicles]
    assert abs(first[2].translation.x) < 1e-9 and abs(first[2].translation.y - 100) < 1e-9, first[2]
    assert last[0].translation.x > 1000, last[0]
    assert {"map/outline", "map/grid", "obstacles", "planned/uav-1", "flown/uav-2", "ends/goals"} <= scene.keys(), scene
    assert abs(smallest("separation_m") - checks["flight.separation"]["value"]) < 1e-3
    assert any("start of 2 vehicles" in line.message for _, line in messages["/log"])
    airspeeds = [aircraft.airspeed_mps for _, aircraft in messages["/vehicles/uav-1"]]
    assert 20 < min(airspeeds) and max(airspeeds) < 60, (min(airspeeds), max(airspeeds))


def corridor_moving():
    carts = [cart["name"] for cart in attached["scenario.json"]["world"]["moving"]]
    assert carts and frames.keys() >= {"uav-1", *carts}, frames.keys()
    assert {entity.id for entity in messages["/moving"][0][1].entities} == set(carts)
    has({f"/{kind}/uav-1": "foxglove.SceneUpdate" for kind in ["horizon", "candidates", "route", "cost_map"]})
    has({"/vehicles/uav-1": "pointmass.PointMass", "/plots/planning_time_ms/uav-1": "point.Point"})
    # of everything, what moves included
    assert abs(smallest("clearance_m") - checks["flight.clearance"]["value"]) < 1e-3
    speeds = [vehicle.airspeed_mps for _, vehicle in messages["/vehicles/uav-1"]]
    assert 0.5 < max(speeds) < 10, max(speeds)


def pop_up():
    hidden = {f"/hidden/{name}" for name in attached["scenario.json"]["world"]["hidden"]}
    assert hidden and hidden <= schemas.keys(), schemas
    for topic in hidden:  # unknown at first, then sensed: two looks of edges and of faces
        assert len(messages[topic]) == 4, messages[topic]
    assert any("discovers" in line.message for _, line in messages["/log"])


def gate():
    gates = [gate["name"] for gate in attached["scenario.json"]["world"]["gates"]]
    windows = {f"gates/{gate}/{of}" for gate in gates for of in ["quadrotor", "load"]}
    assert windows and windows | {"map/ground"} <= scene.keys(), scene.keys()
    assert frames.keys() >= {"carrier", "carrier/load"}, frames.keys()
    has({"/cables/carrier": "foxglove.SceneUpdate", "/envelopes/carrier": "foxglove.SceneUpdate"})
    has({"/vehicles/carrier": "quadrotor.Quadrotor", "/state/cable/flown": "state.State"})
    has({"/plots/tension_n/flown": "point.Point", "/plots/clearance_m/body": "point.Point"})
    tensions = [vehicle.tension_n for _, vehicle in messages["/vehicles/carrier"]]
    assert max(tensions) > 0, tensions


{"pair": pair, "corridor-moving": corridor_moving, "pop-up": pop_up, "gate": gate}[scenario]()
