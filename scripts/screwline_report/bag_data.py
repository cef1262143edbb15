"""What a bag holds of the motions that were streamed while it was recorded."""
import numpy as np
import rosbag

from screwline_scenario.expressions import ExpressionError, number, numbers

SAME_MOTION = 2.0  # [s] between the messages that announce one motion
REACHED = 1e-3  # [rad or m] at a waypoint
TOPICS = ('/joint_states', '/joint_trajectory', '/metrics', '/time_scaling', '/tool_pose', '/tool_twist')


class NoMotion(Exception):
    """The bag can not be read, or nothing moves in it."""


class Motion:
    """One motion: when it was, what was planned, what it cost. Times are in s from the recording's first motion."""

    def __init__(self, index, message, begin, metrics):
        self.number = index
        self.begin = begin
        self.times = np.array([point.time_from_start.to_sec() for point in message.points])
        self.duration = self.times[-1]
        self.positions = np.array([point.positions for point in message.points])
        self.accelerations = np.array([point.accelerations for point in message.points if point.accelerations])
        self.metrics = metrics
        self.scaling = np.empty((0, 3))  # tau, s, ds/dtau
        self.title = ''
        self.is_transfer = False  # to where the next motion begins, no step of the scenario

    def holds(self, times):
        """Which instants are inside, to the resolution of a stamp."""
        return (times >= self.begin - 1e-6) & (times <= self.begin + self.duration + 1e-6)


class Recording:
    """All of a bag: joint states by joint, the tool's path and speed, the motions."""

    def __init__(self, source, messages):
        self.name, self.path, self.description = source.name, source.path, source.description
        trajectories = [(stamp, m) for stamp, m in messages['/joint_trajectory'] if m.points]
        if not trajectories or not messages['/joint_states']:
            raise NoMotion('%s has no motion: it lacks %s' % (
                source.path, 'joint_trajectory' if messages['/joint_states'] else 'joint_states'))
        self.origin = trajectories[0][1].header.stamp
        self.joint_names = list(trajectories[0][1].joint_names)
        types = source.joint_types()
        self.units = [{'prismatic': 'm', 'revolute': 'rad', 'continuous': 'rad'}.get(types.get(name), 'rad or m')
                      for name in self.joint_names]
        self.read_states(messages['/joint_states'])
        self.read_tool(messages)
        self.motions = [Motion(i + 1, m, self.seconds(m.header.stamp), nearest(stamp, messages['/metrics']))
                        for i, (stamp, m) in enumerate(trajectories)]
        self.read_scalings(messages['/time_scaling'])
        if source.part is not None:
            name_motions(self.motions, source.part)

    def seconds(self, stamp):
        return (stamp - self.origin).to_sec()

    def read_states(self, states):
        """Values in the trajectory's order of joints, whatever order a message has."""
        complete = [m for _, m in states if set(self.joint_names) <= set(m.name)]
        if not complete:
            raise NoMotion('%s: no joint_states of %s' % (self.path, ', '.join(self.joint_names)))
        orders = [[m.name.index(name) for name in self.joint_names] for m in complete]
        self.times = np.array([self.seconds(m.header.stamp) for m in complete])
        self.positions = np.array([[m.position[i] for i in order] for m, order in zip(complete, orders)])
        self.velocities = np.array([[m.velocity[i] if m.velocity else np.nan for i in order]
                                    for m, order in zip(complete, orders)])

    def read_tool(self, messages):
        poses = [(self.seconds(m.header.stamp), m.pose.position) for _, m in messages['/tool_pose']]
        twists = [(self.seconds(m.header.stamp), m.twist.linear) for _, m in messages['/tool_twist']]
        self.tool_times = np.array([t for t, _ in poses])
        self.tool_path = np.array([[p.x, p.y, p.z] for _, p in poses]).reshape(-1, 3)
        self.speed_times = np.array([t for t, _ in twists])
        self.speeds = np.linalg.norm(np.array([[v.x, v.y, v.z] for _, v in twists]).reshape(-1, 3), axis=1)

    def read_scalings(self, messages):
        rows = [(self.seconds(m.header.stamp), m.tau[0], m.s[0], m.ds[0]) for _, m in messages if m.tau and m.s and m.ds]
        rows = np.array(rows).reshape(-1, 4)
        for motion in self.motions:
            motion.scaling = rows[motion.holds(rows[:, 0])][:, 1:]


def read_recording(source):
    """@raise NoMotion"""
    messages = {topic: [] for topic in TOPICS}
    try:
        with rosbag.Bag(source.path) as bag:
            for topic, message, stamp in bag.read_messages(TOPICS):
                messages[topic].append((stamp, message))
    except (rosbag.ROSBagException, OSError) as error:
        raise NoMotion('%s can not be read: %s' % (source.path, error)) from error
    return Recording(source, messages)


def nearest(stamp, messages):
    """The message that was recorded at about the same time, or None."""
    near = min(messages, key=lambda entry: abs((entry[0] - stamp).to_sec()), default=None)
    return near[1] if near and abs((near[0] - stamp).to_sec()) < SAME_MOTION else None


def name_motions(motions, part):
    """Each motion that goes from a step's first to its last waypoint has its title, in order; the others are transfers."""
    moves = [content for kind, content in part.steps if kind == 'move']
    for motion in motions:
        found = next((i for i, move in enumerate(moves) if is_of(motion, move, part.values)), None)
        if found is None:
            motion.title, motion.is_transfer = 'transfer', True
        else:
            motion.title = moves[found].get('title', moves[found]['profile'])
            moves = moves[found + 1:]


def is_of(motion, move, values):
    waypoints = move.get('waypoints', [])
    try:
        if 'duration' in move and abs(number(move['duration'], values) - motion.duration) > 1e-6:
            return False
        ends = [(waypoint, q) for waypoint, q in zip(waypoints[:1] + waypoints[-1:], motion.positions[[0, -1]])
                if isinstance(waypoint, list)]
        return all(np.abs(numbers(waypoint, values) - q).max() < REACHED for waypoint, q in ends)
    except (ExpressionError, ValueError):
        return False
