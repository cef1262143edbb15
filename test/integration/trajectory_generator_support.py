"""What the rostests of trajectory_generator share: the node as a process of its own, a recorder of what it streams."""
import threading
import time

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped
from node_support import ServedNode
from screwline.msg import ErrorCode, TimeScaling, TrajectoryMetrics, Waypoint
from screwline.srv import ExecuteTrajectory, ListProfiles, PlanTrajectory, PlanTrajectoryRequest
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

TOPICS = {
    'joint_trajectory': JointTrajectory,
    'joint_states': JointState,
    'time_scaling': TimeScaling,
    'tool_pose': PoseStamped,
    'tool_twist': TwistStamped,
    'metrics': TrajectoryMetrics,
}


def waypoint(position=(), **fields):
    return Waypoint(position=list(position), **fields)


def request(profile, *positions, **fields):
    """A plan request through joint positions (or ready waypoints)."""
    points = [p if isinstance(p, Waypoint) else waypoint(p) for p in positions]
    return PlanTrajectoryRequest(profile=profile, waypoints=points, **fields)


def trajectory(times, positions, velocities=None, accelerations=None, names=()):
    message = JointTrajectory(joint_names=list(names))
    for i, (seconds, position) in enumerate(zip(times, positions)):
        point = JointTrajectoryPoint(positions=list(position), time_from_start=rospy.Duration.from_sec(seconds))
        if velocities is not None:
            point.velocities = list(velocities[i])
        if accelerations is not None:
            point.accelerations = list(accelerations[i])
        message.points.append(point)
    return message


def wait_for(condition, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError('not within %g s' % seconds)
        time.sleep(0.005)


class Generator(ServedNode):
    NODE = 'trajectory_generator'
    SERVICES = {'plan': PlanTrajectory, 'execute': ExecuteTrajectory, 'stop': Trigger, 'pause': Trigger, 'resume': Trigger, 'list_profiles': ListProfiles}

    def planned(self, profile, *positions, **fields):
        """The answer to a good plan request."""
        answer = self.plan(request(profile, *positions, **fields))
        assert answer.success and answer.error_code == ErrorCode.SUCCESS, (profile, answer.message)
        return answer

    def executed(self, message=None):
        answer = self.execute(message or JointTrajectory())
        assert answer.success and answer.error_code == ErrorCode.SUCCESS, answer.message
        return answer


class Recorder:
    """Everything that a generator publishes."""

    def __init__(self, namespace):
        self.lock = threading.Lock()
        self.messages = {topic: [] for topic in TOPICS}
        self.subscribers = [
            rospy.Subscriber('/%s/%s' % (namespace, topic), kind, self.take, callback_args=topic, queue_size=20000,
                             tcp_nodelay=True) for topic, kind in TOPICS.items()]

    def take(self, message, topic):
        with self.lock:
            self.messages[topic].append(message)

    def all(self, topic):
        with self.lock:
            return list(self.messages[topic])

    def last(self, topic):
        with self.lock:
            return self.messages[topic][-1] if self.messages[topic] else None

    def wait_until_streaming(self):
        streamed = [topic for topic in TOPICS if topic not in ('joint_trajectory', 'metrics')]
        wait_for(lambda: all(self.last(topic) for topic in streamed))

    def wait_past(self, instant):
        """Until every stream is past an instant."""
        for topic in ('joint_states', 'time_scaling', 'tool_pose', 'tool_twist'):
            wait_for(lambda topic=topic: self.last(topic).header.stamp > instant)

    def between(self, topic, first, last):
        return [m for m in self.all(topic) if first <= m.header.stamp <= last]

    def states(self, first, last):
        """Stamps [s from first], positions, velocities."""
        inside = self.between('joint_states', first, last)
        return (np.array([(m.header.stamp - first).to_nsec() * 1e-9 for m in inside]),
                np.array([m.position for m in inside]), np.array([m.velocity for m in inside]))
