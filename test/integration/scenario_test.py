#!/usr/bin/python3
"""Runs one scenario with recording, as a user does, and looks into its bags with nothing of the runner's own."""
import csv
import glob
import math
import os
import re
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import rospkg
import rospy
import rostest
import yaml
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

ROOT = rospkg.RosPack().get_path('screwline')
TOPICS = {'/joint_states', '/joint_trajectory', '/tf', '/tf_static', '/frame_broadcaster/markers', '/metrics', '/time_scaling',
          '/tool_pose', '/tool_twist'}
SECONDS = 350


class Bag:
    """What is in a bag, by topic; what is said of each frame, by stamp."""

    def __init__(self, path):
        self.messages = {}
        with rosbag.Bag(path) as bag:
            for topic, message, _ in bag.read_messages():
                self.messages.setdefault(topic, []).append(message)
        self.frames = {}
        for message in self.messages.get('/tf', []) + self.messages.get('/tf_static', []):
            for transform in message.transforms:
                self.frames.setdefault(transform.child_frame_id, []).append(transform)

    def stamps(self, topic):
        return np.array([message.header.stamp.to_nsec() for message in self.messages[topic]])

    def motions(self):
        """(start [ns], duration [ns], trajectory) of each motion executed."""
        for trajectory in self.messages['/joint_trajectory']:
            yield trajectory.header.stamp.to_nsec(), trajectory.points[-1].time_from_start.to_nsec(), trajectory


class ScenarioRun(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('scenario_test')
        cls.name = rospy.get_param('~scenario')
        cls.folder = tempfile.TemporaryDirectory(prefix='screwline-bags-')
        command = ['rosrun', 'screwline', 'scenario', cls.name, '--record', '--bag-dir', cls.folder.name]
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SECONDS, check=False)
        cls.code, cls.output = run.returncode, run.stdout
        print(run.stdout)
        cls.paths = sorted(glob.glob(os.path.join(cls.folder.name, '*.bag')))
        cls.bags = [Bag(path) for path in cls.paths]
        with open(os.path.join(ROOT, 'config', 'scenarios', cls.name + '.yaml')) as stream:
            cls.scenario = yaml.safe_load(stream)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_step_is_ok(self):
        self.assertEqual(self.code, 0, self.output)
        lines = [line for line in self.output.splitlines() if line.startswith('[scenario] ')]
        self.assertRegex(lines[-1], r'^\[scenario\] OK: \d+ steps as expected$')
        steps = sum(not set(step) & {'frame', 'say', 'wait'} for part in self.parts() for step in part['steps'])
        self.assertEqual(len([line for line in lines if re.match(r'\[scenario\] +\d+\. OK ', line)]), steps + len(self.parts()))

    def parts(self):
        return self.scenario.get('parts', [self.scenario])

    def test_one_closed_bag_for_each_robot(self):
        self.assertEqual(len(self.paths), len(self.parts()))
        self.assertEqual(glob.glob(os.path.join(self.folder.name, '*.active')), [])
        for path in self.paths:
            info = subprocess.check_output(['rosbag', 'info', '--yaml', path], text=True)
            self.assertTrue(yaml.safe_load(info)['indexed'], path)

    def test_every_topic(self):
        for path, bag in zip(self.paths, self.bags):
            self.assertEqual(TOPICS - set(bag.messages), set(), path)

    def test_every_sample_from_the_first_to_the_last(self):
        for path, bag, part in zip(self.paths, self.bags, self.in_bag_order()):
            rate = part.get('rate', 100)
            for topic in ('/joint_states', '/tool_pose', '/tool_twist'):
                stamps = bag.stamps(topic)
                self.assertTrue((np.diff(stamps) > 0).all(), '%s %s' % (path, topic))
                for begin, duration, _ in bag.motions():
                    seconds = (stamps[(stamps >= begin - 100) & (stamps <= begin + duration + 100)] - begin) * 1e-9
                    expected = math.ceil(duration * 1e-9 * rate - 1e-6) + 1
                    self.assertEqual(len(seconds), expected, '%s %s' % (path, topic))
                    self.assertLess(seconds[0], 1.01 / rate)
                    self.assertGreater(seconds[-1], duration * 1e-9 - 1.01 / rate)
                    self.assertLess(np.diff(seconds).max(), 2.5 / rate, '%s %s' % (path, topic))

    def in_bag_order(self):
        return sorted(self.parts(), key=lambda part: part['robot'])

    def test_motions_end_at_their_goals(self):
        for path, bag in zip(self.paths, self.bags):
            stamps = bag.stamps('/joint_states')
            for begin, duration, trajectory in bag.motions():
                last = bag.messages['/joint_states'][int(np.searchsorted(stamps, begin + duration - 100))]
                position = dict(zip(last.name, last.position))
                for name, goal in zip(trajectory.joint_names, trajectory.points[-1].positions):
                    self.assertAlmostEqual(position[name], goal, delta=1e-9, msg=path)

    def test_frames_are_complete(self):
        for path, bag, part in zip(self.paths, self.bags, self.in_bag_order()):
            states = bag.stamps('/joint_states')
            names = ['screwline/tool'] + ['screwline/dh_%d' % (i + 1) for i in range(len(bag.messages['/joint_states'][0].name))]
            for name in names:
                stamps = {transform.header.stamp.to_nsec() for transform in bag.frames[name]}
                missing = [i for i, stamp in enumerate(states) if stamp not in stamps and 5 <= i < len(states) - 5]
                self.assertEqual(missing, [], '%s %s, samples of %d' % (path, name, len(states)))
            self.assertIn('tool0', bag.frames)
            self.assertIn('screwline/dh_0', bag.frames)
            self.assertIn('screwline/target', bag.frames)

    def test_tool_frame_is_the_tool_pose(self):
        for path, bag in zip(self.paths, self.bags):
            poses = {pose.header.stamp.to_nsec(): pose.pose for pose in bag.messages['/tool_pose']}
            compared = 0
            for transform in bag.frames['screwline/tool']:
                pose = poses.get(transform.header.stamp.to_nsec())
                if pose is None:
                    continue
                compared += 1
                t, p = transform.transform.translation, pose.position
                self.assertLess(max(abs(t.x - p.x), abs(t.y - p.y), abs(t.z - p.z)), 1e-9, path)
            self.assertGreater(compared, 50)

    def test_replay_plays_all_of_it(self):
        if self.name != 'rrprrr_twist':
            return
        states, clocks = [], []
        subscribers = [rospy.Subscriber('/joint_states', JointState, states.append, queue_size=1000),
                       rospy.Subscriber('/clock', Clock, clocks.append, queue_size=1000)]
        try:
            command = ['roslaunch', 'screwline', 'replay.launch', 'bag:=' + self.paths[0], 'robot:=rrprrr', 'rviz:=false']
            subprocess.run(command, stdout=subprocess.DEVNULL, timeout=60, check=True)
        finally:
            rospy.delete_param('/use_sim_time')
        rospy.sleep(0.2)
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual(len(states), len(self.bags[0].messages['/joint_states']))
        self.assertTrue(clocks)

    def test_tool_twist_of_seed_001(self):
        if self.name != 'rrp_tool_velocity':
            return
        with open(os.path.join(ROOT, 'test', 'data', 'rrp_tool_velocity.csv')) as stream:
            table = np.array([[float(row[key]) for key in ('t', 'vx', 'vy', 'vz', 'wx', 'wy', 'wz')] for row in csv.DictReader(stream)])
        begin = list(self.bags[0].motions())[-1][0]
        t = (self.bags[0].stamps('/tool_twist') - begin) * 1e-9
        twists = np.array([[m.twist.linear.x, m.twist.linear.y, m.twist.linear.z, m.twist.angular.x, m.twist.angular.y,
                            m.twist.angular.z] for m in self.bags[0].messages['/tool_twist']])
        inside = (t > -1e-7) & (t < 20 + 1e-7)
        t, twists = t[inside], twists[inside]
        for row in table:
            nearest = np.sort(np.argsort(np.abs(t - row[0]))[:8])
            scale = (t[nearest] - row[0]) * 100
            for k in range(6):
                value = np.polynomial.Polynomial(np.linalg.solve(np.vander(scale, increasing=True), twists[nearest, k]))(0.0)
                self.assertAlmostEqual(value, row[k + 1], delta=1e-6, msg='t = %g' % row[0])


if __name__ == '__main__':
    rostest.rosrun('screwline', 'scenario', ScenarioRun)
