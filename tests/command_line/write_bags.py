"""Writes one flight of the scenario hoverer.toml as bags of ROS 2, with other people's libraries, and as log.csv.

6 m along x in 6 s, from rest to rest, then 1 s at the goal; the body is turned to the left by 90 degrees.
"""

import math
import struct
import sys
from pathlib import Path

import numpy
from mcap.writer import CompressionType
from mcap_ros2.writer import Writer as McapWriter
from pyulog import ULog
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

SEPARATOR = "=" * 80 + "\n"
TIME = SEPARATOR + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
HEADER = SEPARATOR + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + TIME
VECTORS = "".join(
    SEPARATOR + f"MSG: geometry_msgs/{name}\n" + "".join(f"float64 {axis}\n" for axis in axes)
    for name, axes in [("Point", "xyz"), ("Vector3", "xyz"), ("Quaternion", "xyzw")]
)
POSE = SEPARATOR + "MSG: geometry_msgs/Pose\nPoint position\nQuaternion orientation\n"
POSE_STAMPED = "std_msgs/Header header\ngeometry_msgs/Pose pose\n"
SCHEMAS = {
    "geometry_msgs/msg/PoseStamped": POSE_STAMPED + HEADER + POSE + VECTORS,
    "nav_msgs/msg/Path": "# a path\nstd_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"
    + SEPARATOR + "MSG: geometry_msgs/PoseStamped\n" + POSE_STAMPED + HEADER + POSE + VECTORS,
    "trajectory_msgs/msg/MultiDOFJointTrajectory": "std_msgs/Header header\nstring[] joint_names\n"
    "MultiDOFJointTrajectoryPoint[] points\n"
    + SEPARATOR + "MSG: trajectory_msgs/MultiDOFJointTrajectoryPoint\ngeometry_msgs/Transform[] transforms\n"
    "geometry_msgs/Twist[] velocities\ngeometry_msgs/Twist[] accelerations\n"
    "builtin_interfaces/Duration time_from_start\n"
    + SEPARATOR + "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n"
    + SEPARATOR + "MSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n"
    + SEPARATOR + "MSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n" + HEADER + VECTORS,
    "px4_msgs/msg/VehicleLocalPosition": "uint32 MESSAGE_VERSION = 0\nuint64 timestamp # us\nuint64 timestamp_sample\n"
    "bool xy_valid\nbool z_valid\nfloat32 x\nfloat32 y\nfloat32 z\nfloat32[2] delta_xy\nfloat32 vx\nfloat32 vy\n"
    "float32 vz\nuint8 xy_reset_counter\nfloat32 heading\n",
    "px4_msgs/msg/TrajectorySetpoint": "uint64 timestamp\nfloat32[3] position\nfloat32[3] velocity\nfloat32 yaw\n",
    "own_msgs/msg/State": "own_msgs/Place place\nfloat64 seconds\n"
    + SEPARATOR + "MSG: own_msgs/Place\nfloat64 east\nfloat64 north\nfloat64 down\n",
}
START_NS = 1_700_000_000_123_456_789


def samples(every_ms):
    for k in range(7000 // every_ms + 1):
        t = k * every_ms / 1000
        u = min(t / 6, 1)
        yield k * every_ms * 1_000_000, 6 * u**3 * (10 - 15 * u + 6 * u * u), 30 * u * u * (1 - u) ** 2


def stamp(ns):
    return {"sec": ns // 1_000_000_000, "nanosec": ns % 1_000_000_000}


def header(ns):
    return {"stamp": stamp(ns), "frame_id": "map"}


def pose(x):
    turned = {"x": 0.0, "y": 0.0, "z": math.sqrt(0.5), "w": math.sqrt(0.5)}
    return {"position": {"x": x, "y": 0.0, "z": 2.0}, "orientation": turned}


def write(folder, name, topics, **options):
    with open(folder / name, "wb") as file:
        writer = McapWriter(file, **options)
        known = {}
        for topic, kind, ns, message in topics:
            if kind not in known:
                known[kind] = writer.register_msgdef(kind, SCHEMAS[kind])
            writer.write_message(topic, known[kind], message, log_time=ns, publish_time=ns)
        writer.finish()


def write_plans(folder):
    rows = list(samples(20))
    poses = [{"header": header(ns), "pose": pose(x)} for ns, x, _ in rows]
    path = {"header": header(0), "poses": poses}
    points = [
        {
            "transforms": [{"translation": pose(x)["position"], "rotation": pose(x)["orientation"]}],
            "velocities": [{"linear": {"x": v, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}],
            "accelerations": [],
            "time_from_start": stamp(ns),
        }
        for ns, x, v in rows
    ]
    trajectory = {"header": header(START_NS), "joint_names": ["base"], "points": points}
    messages = [
        ("/path", "nav_msgs/msg/Path", START_NS, path),
        ("/trajectory", "trajectory_msgs/msg/MultiDOFJointTrajectory", START_NS, trajectory),
    ]
    write(folder, "plans.mcap", messages)


def write_flights(folder, name, every_ms, kinds, **options):
    messages = []
    for ns, x, v in samples(every_ms):
        now = START_NS + ns
        messages.append(("/pose", "geometry_msgs/msg/PoseStamped", now, {"header": header(now), "pose": pose(x)}))
        own = {"place": {"east": x, "north": 0.0, "down": -2.0}, "seconds": 5.0 + ns * 1e-9}
        messages.append(("/own", "own_msgs/msg/State", now, own))
        us = 7_000_000 + ns // 1000
        local = {
            "timestamp": us, "timestamp_sample": us, "xy_valid": True, "z_valid": True, "x": 0.0, "y": x, "z": -2.0,
            "delta_xy": [0.0, 0.0], "vx": 0.0, "vy": v, "vz": 0.0, "xy_reset_counter": 0, "heading": 0.0,
        }
        messages.append(("/fmu/out/vehicle_local_position", "px4_msgs/msg/VehicleLocalPosition", now, local))
        setpoint = {"timestamp": us, "position": [0.01, x, -2.0], "velocity": [math.nan] * 3, "yaw": math.nan}
        messages.append(("/fmu/in/trajectory_setpoint", "px4_msgs/msg/TrajectorySetpoint", now, setpoint))
    messages = [message for message in messages if message[1].split("/")[0] in kinds]
    write(folder, name, messages, **options)


def write_odometry(folder):
    """By rosbags, whose messages and definitions are its own."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    kinds = store.types
    vector, quaternion = kinds["geometry_msgs/msg/Vector3"], kinds["geometry_msgs/msg/Quaternion"]
    point, twist = kinds["geometry_msgs/msg/Point"], kinds["geometry_msgs/msg/Twist"]
    odometry = kinds["nav_msgs/msg/Odometry"]
    turned, still, unknown = quaternion(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)), vector(0.0, 0.0, 0.0), numpy.zeros(36)
    with Writer(folder / "odometry", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        connection = writer.add_connection("/odom", odometry.__msgtype__, typestore=store)
        for ns, x, v in samples(20):
            now = START_NS + ns
            head = kinds["std_msgs/msg/Header"](kinds["builtin_interfaces/msg/Time"](**stamp(now)), "map")
            placed = kinds["geometry_msgs/msg/Pose"](point(x, 0.0, 2.0), turned)
            # Eastwards is to the right of a body that looks north.
            moving = twist(vector(0.0, -v, 0.0), still)
            message = odometry(
                head, "base_link",
                kinds["geometry_msgs/msg/PoseWithCovariance"](placed, unknown),
                kinds["geometry_msgs/msg/TwistWithCovariance"](moving, unknown),
            )
            writer.write(connection, now, store.serialize_cdr(message, odometry.__msgtype__))


def write_ulog(folder):
    """By pyulog, which writes what it has read: its parts are put together here."""
    log = ULog(None)
    formats = {
        "vehicle_local_position": ["uint64_t timestamp", "float x", "float y", "float z", "float[2] delta_xy", "float vx",
                                   "float vy", "float vz", "bool xy_valid", "bool z_valid", "uint8_t[6] _padding0"],
        "trajectory_setpoint": ["uint64_t timestamp", "float[3] position", "float yaw"],
    }
    for number, (name, fields) in enumerate(formats.items()):
        format_header = struct.pack("<HB", 0, 0)
        text = (name + ":" + ";".join(fields) + ";").encode()
        log._message_formats[name] = ULog.MessageFormat(text, format_header)
        subscription = ULog._MessageAddLogged(
            struct.pack("<BH", 0, number) + name.encode(), format_header, log._message_formats
        )
        rows = []
        for ns, x, v in samples(20):
            us = 7_000_000 + ns // 1000
            rows.append(
                struct.pack("<Q8f??", us, 0.0, x, -2.0, 0.0, 0.0, 0.0, v, 0.0, True, True)
                if number == 0
                else struct.pack("<Q4f", us, 0.01, x, -2.0, math.nan)
            )
        subscription.buffer = bytearray(b"".join(rows))
        log._data_list.append(ULog.Data(subscription))
    log.write_ulog(str(folder / "px4.ulg"))


def write_csv(folder):
    rows = [f"{ns * 1e-9!r},{x!r},0,2,{v!r},0,0\n" for ns, x, v in samples(20)]
    (folder / "log.csv").write_text("t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n" + "".join(rows))


if __name__ == "__main__":
    place = Path(sys.argv[1])
    if "--fixture" in sys.argv:
        # tests/judge/px4.mcap: without compression and checksums, so that damage reaches the messages.
        plain = {"compression": CompressionType.NONE, "enable_crcs": False}
        write_flights(place, "px4.mcap", 100, ["px4_msgs"], **plain)
        sys.exit()
    write_plans(place)
    write_flights(place, "flights.mcap", 20, ["geometry_msgs", "px4_msgs", "own_msgs"])
    write_odometry(place)
    write_ulog(place)
    write_csv(place)
