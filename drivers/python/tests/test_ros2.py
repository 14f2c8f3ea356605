"""The example for ROS 2: messages on the wire, received by another participant and decoded by a reader of the ROS format."""

from __future__ import annotations

import importlib.util
import math
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import endat

EXAMPLE = Path(__file__).parent.parent / "examples" / "ros2_joint_states.py"

pytest.importorskip("cyclonedds")
rosbags = pytest.importorskip("rosbags.typesys")
#: Used by no other test, and hardly by a robot.
DOMAIN = 97
#: On this machine only, with any networks.
LOOPBACK = """<CycloneDDS><Domain><General>
<Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces><AllowMulticast>false</AllowMulticast>
</General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery>
</Domain></CycloneDDS>"""


@pytest.fixture(scope="module")
def example() -> Any:
    spec = importlib.util.spec_from_file_location("ros2_joint_states", EXAMPLE)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    # Dataclasses look up their module.
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def test_another_participant_takes_joints_of_the_card_in_radians(
    example: Any, service: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Catches a wrong topic, type or unit, and joints in the wrong order."""
    from cyclonedds.domain import DomainParticipant
    from cyclonedds.sub import DataReader, Subscriber
    from cyclonedds.topic import Topic

    monkeypatch.setenv("CYCLONEDDS_URI", LOOPBACK)
    participant = DomainParticipant(DOMAIN)
    topic = Topic(participant, "rt/joint_states", example.JointState, qos=example.QOS)
    assert topic.typename == "sensor_msgs::msg::dds_::JointState_"
    reader = DataReader(Subscriber(participant), topic, qos=example.QOS)
    command = [sys.executable, str(EXAMPLE), service, "--domain", str(DOMAIN), "--block", "20"]
    with subprocess.Popen([*command, "--joint", "shoulder", "--joint", "elbow"]) as node:
        taken: list[Any] = []
        end = time.monotonic() + 120
        try:
            while len(taken) < 5 and time.monotonic() < end and node.poll() is None:
                taken += reader.take(10)
                time.sleep(0.05)
        finally:
            node.terminate()
    assert len(taken) >= 5, node.returncode
    for message in taken:
        assert list(message.name) == ["shoulder", "elbow"]
        assert all(0 <= p < 2 * math.pi + 0.5 for p in message.position)
        # A quarter and three eighths of a turn a second, and a little swing.
        for velocity, turns in zip(message.velocity, (0.25, 0.375), strict=True):
            assert velocity == pytest.approx(turns * 2 * math.pi, rel=0.03)
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in taken]
    assert stamps == sorted(stamps) and abs(stamps[0] / 1e9 - time.time()) < 300


def test_the_bytes_are_those_of_a_joint_state(example: Any) -> None:
    """Catches a misplaced field: the reader has the definitions of ROS 2."""
    stamp = example.Time(1_700_000_000, 5)
    message = example.JointState(example.Header(stamp, "base"), ["a", "elbow"], [1.5, -2.25], [0.5, math.inf], [])
    raw = message.serialize(use_version_2=False)
    store = rosbags.get_typestore(rosbags.Stores.ROS2_HUMBLE)
    seen = store.deserialize_cdr(raw, "sensor_msgs/msg/JointState")
    assert (seen.header.stamp.sec, seen.header.stamp.nanosec, seen.header.frame_id) == (1_700_000_000, 5, "base")
    assert list(seen.name) == ["a", "elbow"] and list(seen.position) == [1.5, -2.25]
    assert list(seen.velocity) == [0.5, math.inf] and len(seen.effort) == 0


def test_turns_are_counted_on_and_a_held_position_is_left_out(example: Any, service: str) -> None:
    """Catches turns that are lost between two blocks, and a position that no trigger brought."""
    with endat.connect(service) as card:
        rows = card.samples(40)
    channel = rows.channels[0]
    assert channel.wraps_at == 360 and not channel.turns.any()
    joint = example.Joint("a")
    total = 0.0
    # A block is 0.2 turns; three turns are fifteen blocks.
    for block in range(16):
        degrees = (block * 72 + np.linspace(0, 71, len(rows))) % 360
        state = joint.take(rows.time_s, replace(channel, position=degrees))
        assert state is not None
        assert state[0] > total
        total = state[0]
    assert total == pytest.approx(math.radians(15 * 72 + 71))
    fresh = channel.fresh.copy()
    fresh[-1] = False
    assert joint.take(rows.time_s, replace(channel, fresh=fresh)) is None
    assert joint.take(rows.time_s, replace(channel, fresh=np.zeros_like(fresh))) is None
