"""Reads a recording of the scenario `pair` with the library `mcap`, and asserts that everything is in it."""

import json
import sys
from collections import defaultdict

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    (metadata,) = reader.iter_metadata()
    assert metadata.name == "harness", metadata
    expected = {"scenario": "pair", "planner": "parallel-scp", "seed": "0", "verdict": "PASS"}
    assert expected.items() <= metadata.metadata.items(), metadata.metadata
    attached = {attachment.name: json.loads(attachment.data) for attachment in reader.iter_attachments()}
    assert attached.keys() == {"scenario.json", "plan.json", "verdict.json"}, attached.keys()
    assert attached["scenario.json"]["name"] == "pair" and attached["verdict.json"]["outcome"] == "pass"

    schemas, messages = {}, defaultdict(list)
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        schemas[channel.topic] = schema.name
        messages[channel.topic].append((message.log_time, decoded))

assert schemas == {
    "/world": "foxglove.SceneUpdate",
    "/fleet": "foxglove.SceneUpdate",
    "/tf": "foxglove.FrameTransforms",
    "/vehicles/uav-1": "aircraft.Aircraft",
    "/vehicles/uav-2": "aircraft.Aircraft",
    "/distances": "distances.Distances",
    "/log": "foxglove.Log",
}, schemas
poses = messages["/tf"]
times = [time for time, _ in poses]
assert times == sorted(times) and times[0] == 0 and 25e9 < times[-1] < 40e9, (times[0], times[-1])
first, last = poses[0][1].transforms, poses[-1][1].transforms
assert [(pose.parent_frame_id, pose.child_frame_id) for pose in first] == [("world", "uav-1"), ("world", "uav-2")]
assert abs(first[1].translation.x) < 1e-9 and abs(first[1].translation.y - 100) < 1e-9, first[1]
assert last[0].translation.x > 1000, last[0]
scene = {entity.id for entity in messages["/world"][0][1].entities}
assert {"map", "obstacles", "planned/uav-1", "flown/uav-2"} <= scene, scene
fleet = messages["/fleet"][0][1].entities
assert all(entity.frame_locked and entity.frame_id == entity.id for entity in fleet), fleet
separations = [distances.separation_m for _, distances in messages["/distances"]]
checks = {check["name"]: check for check in attached["verdict.json"]["checks"]}
assert abs(min(separations) - checks["flight.separation"]["value"]) < 1e-3, min(separations)
assert any("start of 2 vehicles" in line.message for _, line in messages["/log"])
