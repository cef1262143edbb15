#!/usr/bin/python3
"""frame_broadcaster beside robot_state_publisher: frames on tf, markers, what it refuses to start with."""
import os
import signal
import subprocess
import sys
import unittest
import xmlrpc.client

import numpy as np
import rosgraph
import rospkg
import rospy
import rostest
import tf2_ros
import yaml
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker, MarkerArray

ROOT = rospkg.RosPack().get_path('screwline')
sys.path.insert(0, os.path.join(ROOT, 'test', 'integration'))
from test_robot_files import Robot  # noqa: E402  the tests' own forward kinematics

JOINTS = ['q1', 'q2', 'q3', 'q4', 'q5', 'q6']
PERIOD = 0.01


def matrix(transform):
    t, q = transform.transform.translation, transform.transform.rotation
    x, y, z, w = q.x, q.y, q.z, q.w
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation, (t.x, t.y, t.z)
    return result


class FrameBroadcaster(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('frame_broadcaster_test')
        cls.robot = Robot('rrprrr')
        cls.buffer = tf2_ros.Buffer(rospy.Duration(100))
        cls.listener = tf2_ros.TransformListener(cls.buffer)
        cls.markers = []
        cls.subscriber = rospy.Subscriber('frame_broadcaster/markers', MarkerArray, cls.markers.append, queue_size=100)
        cls.states = rospy.Publisher('joint_states', JointState, queue_size=1000, tcp_nodelay=True)
        cls.trajectories = rospy.Publisher('joint_trajectory', JointTrajectory, queue_size=1, latch=True)
        cls.targets = rospy.Publisher('target', PoseStamped, queue_size=1, latch=True)
        while cls.states.get_num_connections() < 2 or not cls.subscriber.get_num_connections():
            rospy.sleep(0.05)

    def publish(self, q, order=None):
        """A joint state now; its stamp."""
        order = order or list(range(6))
        state = JointState(name=[JOINTS[i] for i in order], position=[q[i] for i in order])
        state.header.stamp = rospy.Time.now()
        self.states.publish(state)
        return state.header.stamp

    def frame(self, name, stamp, parent='base_link'):
        return matrix(self.buffer.lookup_transform(parent, name, stamp, rospy.Duration(5)))

    def test_tool_is_the_urdfs_tool_and_forward_kinematics(self):
        random = np.random.RandomState(7)
        for _ in range(20):
            q = random.uniform(-1, 1, 6)
            q[2] = random.uniform(0, 0.7)
            stamp = self.publish(q, order=list(random.permutation(6)))
            expected = self.robot.forward(q)
            for name in ('screwline/tool', 'tool0'):
                self.assertLess(np.abs(self.frame(name, stamp) - expected).max(), 1e-9, name)
            rospy.sleep(PERIOD)

    def test_dh_frames_follow_the_joints(self):
        q = [0.3, 0.4, 0.2, -0.5, 0.6, 0.7]
        stamp = self.publish(q)
        rates = []
        for i in range(1, 7):
            rates.append(self.frame('screwline/dh_%d' % i, stamp)[:3, 2])
        pose = self.robot.forward(q)
        for i, axis in enumerate(rates):
            shifted = list(q)
            shifted[i] += 1e-6
            change = (self.robot.forward(shifted) - pose) / 1e-6
            if i == 2:
                self.assertLess(np.abs(change[:3, 3] - axis).max(), 1e-6)
            else:
                spin = change[:3, :3] @ pose[:3, :3].T
                found = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
                self.assertLess(np.abs(found - axis).max(), 1e-5, 'axis %d' % (i + 1))

    def test_base_frame_is_static(self):
        self.publish([0] * 6)
        self.assertTrue(self.buffer.lookup_transform('base_link', 'screwline/dh_0', rospy.Time(0), rospy.Duration(5)))
        frames = yaml.safe_load(self.buffer.all_frames_as_yaml())
        self.assertEqual(frames['screwline/dh_0']['parent'], 'base_link')
        self.assertEqual(frames['screwline/dh_0']['most_recent_transform'], 0.0)

    def test_no_frame_has_two_parents_or_is_the_urdfs(self):
        self.publish([0] * 6)
        rospy.sleep(0.2)
        frames = yaml.safe_load(self.buffer.all_frames_as_yaml())
        own = {name for name in frames if name.startswith('screwline/')}
        self.assertLessEqual({'screwline/dh_%d' % i for i in range(7)} | {'screwline/tool'}, own)
        self.assertFalse(own & set(self.robot.links))
        for name in self.robot.links[1:]:
            self.assertIn('robot_state_publisher', frames[name]['broadcaster'] + 'robot_state_publisher')

    def test_target_from_trajectory_and_from_pose(self):
        goal = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        self.trajectories.publish(JointTrajectory(joint_names=JOINTS, points=[JointTrajectoryPoint(positions=goal)]))
        self.assert_target(self.robot.forward(goal))
        pose = PoseStamped()
        pose.header.frame_id = 'tool0'
        pose.pose.position.x, pose.pose.orientation.w = 0.25, 1.0
        self.targets.publish(pose)
        expected = self.robot.forward([0] * 6)
        expected[:3, 3] += 0.25 * expected[:3, 0]
        self.assert_target(expected)

    def assert_target(self, expected):
        for _ in range(200):
            stamp = self.publish([0] * 6)
            rospy.sleep(PERIOD)
            try:
                if np.abs(self.frame('screwline/target', stamp) - expected).max() < 1e-9:
                    return
            except tf2_ros.TransformException:
                continue
        self.fail('no such target')

    def test_markers_keep_their_rate_and_the_stamps_of_joint_states(self):
        rospy.sleep(0.3)
        del self.markers[:]
        stamps = []
        for i in range(100):
            stamps.append(self.publish([0.01 * i] * 6))
            rospy.sleep(PERIOD)
        rospy.sleep(0.3)
        span = (stamps[-1] - stamps[0]).to_sec()
        self.assertTrue(0.8 * 20 * span - 2 < len(self.markers) < 20 * span + 2, '%d in %.2f s' % (len(self.markers), span))
        for array in self.markers:
            self.assertEqual({marker.header.frame_id for marker in array.markers}, {'base_link'})
            self.assertTrue(all(marker.header.stamp in stamps for marker in array.markers))
        shown = {marker.ns for marker in self.markers[-1].markers if marker.action == Marker.ADD}
        self.assertLessEqual({'screw_axes', 'manipulability', 'tool_path'}, shown)

    def test_lost_directions_appear_where_the_arm_is_stretched(self):
        for elbow, lost in ((np.pi / 2, True), (0.0, False)):
            self.publish([0.1, elbow, 0.2, 0.3, 0.4, 0.5])
            rospy.sleep(0.2)
            self.publish([0.1, elbow, 0.2, 0.3, 0.4, 0.5])
            rospy.sleep(0.2)
            shown = {marker.ns for marker in self.markers[-1].markers if marker.action == Marker.ADD}
            self.assertEqual('lost_directions' in shown, lost, elbow)

    def test_no_frame_is_lost_while_the_node_gets_no_time(self):
        rospy.sleep(0.3)
        told = []
        listener = rospy.Subscriber('/tf', TFMessage, told.append, queue_size=None, tcp_nodelay=True)
        while listener.get_num_connections() < 2:
            rospy.sleep(0.05)
        pid = xmlrpc.client.ServerProxy(rosgraph.Master('/test').lookupNode('/frame_broadcaster')).getPid('/test')[2]
        os.kill(pid, signal.SIGSTOP)
        try:
            stamps = []
            for i in range(600):
                stamps.append(self.publish([0.001 * i] * 6))
                rospy.sleep(0.002)
        finally:
            os.kill(pid, signal.SIGCONT)
        self.frame('screwline/tool', stamps[-1])
        rospy.sleep(0.5)
        listener.unregister()
        found = {transform.header.stamp for message in told for transform in message.transforms
                 if transform.child_frame_id == 'screwline/tool'}
        self.assertEqual(len(set(stamps) - found), 0)

    def test_bad_messages_are_passed_over(self):
        self.states.publish(JointState(name=['q1'], position=[0.0, 1.0]))
        self.states.publish(JointState(name=JOINTS, position=[float('nan')] * 6))
        self.trajectories.publish(JointTrajectory(joint_names=['q1'], points=[JointTrajectoryPoint()]))
        self.targets.publish(PoseStamped())
        q = [0.2] * 6
        stamp = self.publish(q)
        self.assertLess(np.abs(self.frame('screwline/tool', stamp) - self.robot.forward(q)).max(), 1e-9)


class Refusals(unittest.TestCase):
    def start(self, parameters):
        """Exit code and output of a broadcaster of its own with these private parameters."""
        for name, value in parameters.items():
            rospy.set_param('/refused/' + name, value)
        program = subprocess.check_output(['catkin_find', '--first-only', '--libexec', 'screwline', 'frame_broadcaster'], text=True)
        try:
            run = subprocess.run([program.strip(), '__name:=refused'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=10,
                                 text=True, check=False)
        finally:
            rosgraph.Master('/test').deleteParam('/refused')
        return run.returncode, [line for line in run.stdout.splitlines() if 'FATAL' in line]

    def refused(self, parameters, what):
        code, lines = self.start(parameters)
        self.assertEqual((code, len(lines)), (1, 1), lines)
        self.assertIn(what, lines[0])

    def test_a_frame_of_the_urdf(self):
        urdf = rospy.get_param('/robot_description').replace('"upper_arm"', '"screwline/dh_3"')
        self.refused({'robot_description': urdf}, "'screwline/dh_3' is a link")

    def test_bad_parameters(self):
        self.refused({'frame_prefix': '/x'}, '~frame_prefix')
        self.refused({'marker_rat': 3.0}, '~marker_rat')

    def test_malformed_robot(self):
        self.refused({'robot_description': '<robot'}, 'can not be broadcast')


if __name__ == '__main__':
    rostest.rosrun('screwline', 'frame_broadcaster_test', __name__)
