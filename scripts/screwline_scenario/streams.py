"""What the trajectory generator streams, kept by stamp, and its value at an instant."""
import math
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory

from .messages import flattened

NEIGHBOURS = 6  # samples that an interpolation between samples takes


class Stream:
    """Samples of one topic: stamps [s, from an origin] and rows of numbers."""

    def __init__(self, topic, message_type, row_of):
        self.lock = threading.Lock()
        self.row_of = row_of
        self.stamps, self.rows = [], []
        self.subscriber = rospy.Subscriber(topic, message_type, self.take, queue_size=10000, tcp_nodelay=True)

    def take(self, message):
        with self.lock:
            self.stamps.append(message.header.stamp)
            self.rows.append(self.row_of(message))

    def latest(self):
        with self.lock:
            return (self.stamps[-1], self.rows[-1]) if self.stamps else (rospy.Time(0), None)

    def since(self, origin):
        """Seconds from `origin`, and rows, as arrays."""
        with self.lock:
            seconds = np.array([(stamp - origin).to_sec() for stamp in self.stamps])
            return seconds, np.array(self.rows, dtype=float)


def between(seconds, rows, first, last):
    """The part of a stream within [first, last], to the clock's resolution."""
    inside = (seconds >= first - 1e-7) & (seconds <= last + 1e-7)
    return seconds[inside], rows[inside]


def samples_of(duration, rate):
    """How many samples a motion has: one each period from its start on, and one at its end."""
    return math.ceil(duration * rate - 1e-6) + 1


def interpolated(seconds, rows, instant):
    """The value at an instant, by the polynomial through the nearest samples (exact where one is there)."""
    nearest = np.sort(np.argsort(np.abs(seconds - instant))[:NEIGHBOURS])
    t, values = seconds[nearest] - instant, rows[nearest]
    if np.abs(t).min() < 1e-9:
        return values[np.abs(t).argmin()]
    weights = np.array([np.prod([-other / (own - other) for other in t if other != own]) for own in t])
    return weights @ values


class MotionStreams:
    def __init__(self):
        self.states = Stream('joint_states', JointState, lambda m: list(m.position) + list(m.velocity))
        self.topics = {
            'joint_states': self.states,
            'tool_twist': Stream('tool_twist', TwistStamped, lambda m: flattened(m.twist)),
            'tool_pose': Stream('tool_pose', PoseStamped, lambda m: flattened(m.pose)),
        }
        self.trajectory = None
        self.subscriber = rospy.Subscriber('joint_trajectory', JointTrajectory, self.take_trajectory, queue_size=10)

    def stop(self):
        for listener in [self, *self.topics.values()]:
            listener.subscriber.unregister()

    def take_trajectory(self, message):
        self.trajectory = message

    def position(self):
        _, row = self.states.latest()
        return None if row is None else row[:len(row) // 2]

    def wait_for(self, condition, seconds):
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                return False
            time.sleep(0.005)
        return True
