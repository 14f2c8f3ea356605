"""Encoders as joints of a robot in ROS 2: sensor_msgs/JointState over DDS, without an installation of ROS on the card's machine.

    pip install cyclonedds
    python ros2_joint_states.py tcp:127.0.0.1:7700 --joint shoulder --joint elbow

and on a machine with ROS 2 ``ros2 topic echo /joint_states``. For a robot's ros2_control the package
joint_state_topic_hardware_interface makes them state interfaces, in its URDF:

    <ros2_control name="encoders" type="system">
      <hardware>
        <plugin>joint_state_topic_hardware_interface/JointStateTopicSystem</plugin>
        <param name="joint_states_topic">/joint_states</param>
      </hardware>
      <joint name="shoulder"><state_interface name="position"/><state_interface name="velocity"/></joint>
    </ros2_control>

Positions are in radians or metres, from the encoder's zero, turns unwrapped. A joint whose last trigger brought no position is left out of
that message, and its cause is printed on stderr. So subscribers see an outdated joint, never a held position.
"""

import argparse
import math
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

import endat
import numpy as np
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.idl.annotations import final
from cyclonedds.pub import DataWriter, Publisher
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from numpy.typing import NDArray

# Names of types and topics of ROS 2 on the wire: a type ends with an underscore in a module dds_, a topic begins with rt/.


@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: types.int32
    nanosec: types.uint32


@dataclass
@final
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time
    frame_id: str


@dataclass
@final
class JointState(IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):
    header: Header
    name: types.sequence[str]
    position: types.sequence[types.float64]
    velocity: types.sequence[types.float64]
    effort: types.sequence[types.float64]


#: Default quality of service of ROS 2: reliable, the last ten, in the plain form of CDR.
QOS = Qos(
    Policy.Reliability.Reliable(duration(milliseconds=100)),
    Policy.Durability.Volatile,
    Policy.History.KeepLast(10),
    Policy.DataRepresentation(use_cdrv0_representation=True),
)

#: In SI units, as in ROS.
SI = {"deg": math.pi / 180, "mm": 1e-3, "counts": 1.0}


class Joint:
    """A channel: turns are counted from block to block."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._position: float | None = None

    def take(self, seconds: NDArray[np.float64], channel: endat.ChannelSamples) -> tuple[float, float] | None:
        """Position and velocity at the end of a block; None if its last trigger brought no position."""
        at = np.flatnonzero(channel.fresh)
        if len(at) == 0:
            return None
        positions = channel.unwrapped()[at]
        # Unwrap what the encoder does not count, from the previous block.
        if channel.wraps_at is not None and self._position is not None:
            period = channel.wraps_at * (channel.turns_counted or 1)
            positions = np.unwrap(np.append(self._position, positions), period=period)[1:]
        self._position = float(positions[-1])
        if not channel.fresh[-1]:
            return None
        span = seconds[at[-1]] - seconds[at[0]]
        velocity = float(positions[-1] - positions[0]) / span if span > 0 else math.nan
        return self._position * SI[channel.unit], velocity * SI[channel.unit]


def states(card: endat.Card, joints: list[Joint], block: int) -> Iterator[JointState]:
    """A message for each block of the card's stream."""
    for rows in card.stream(block):
        now = time.time_ns()
        stamp = Time(now // 1_000_000_000, now % 1_000_000_000)
        message = JointState(Header(stamp, ""), [], [], [], [])
        for joint, channel in zip(joints, rows.channels, strict=True):
            state = joint.take(rows.time_s, channel)
            if state is None:
                print(f"{joint.name}: no position: {channel.cause_names()[-1]}", file=sys.stderr)
                continue
            message.name.append(joint.name)
            message.position.append(state[0])
            message.velocity.append(state[1])
        yield message


def main() -> None:
    parser = argparse.ArgumentParser(description="Publishes encoders as joints of ROS 2.")
    parser.add_argument("port", nargs="?", default="virtual", help="as in endat.connect")
    parser.add_argument("--joint", action="append", default=[], help="name of each channel's joint, in their order [joint_0 ...]")
    parser.add_argument("--topic", default="/joint_states")
    parser.add_argument("--domain", type=int, default=0, help="ROS_DOMAIN_ID")
    parser.add_argument("--block", type=int, default=100, help="triggers of a message")
    parser.add_argument("--messages", type=int, help="end after this number of messages")
    arguments = parser.parse_args()
    participant = DomainParticipant(arguments.domain)
    topic = Topic(participant, "rt" + arguments.topic, JointState, qos=QOS)
    writer = DataWriter(Publisher(participant), topic, qos=QOS)
    with endat.connect(arguments.port) as card:
        count = len(card.read())
        if arguments.joint and len(arguments.joint) != count:
            parser.error(f"--joint: given {len(arguments.joint)} times; the card has {count} channels")
        names = arguments.joint or [f"joint_{n}" for n in range(count)]
        for n, message in enumerate(states(card, [Joint(name) for name in names], arguments.block), 1):
            writer.write(message)
            if n == arguments.messages:
                break


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass
    except endat.EndatError as error:
        sys.exit(str(error))
