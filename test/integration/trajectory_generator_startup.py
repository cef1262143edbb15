#!/usr/bin/python3
"""What keeps trajectory_generator from starting ends it with one FATAL line and status 1; how it starts, and ends."""
import itertools
import signal
import time
import unittest

import rospy
import rostest
from data_support import read_text
from node_support import assert_refused
from screwline.msg import ErrorCode
from trajectory_generator_support import Generator, JointTrajectory, Recorder, wait_for

NUMBERS = itertools.count()
URDF = read_text('urdf', 'rr_planar.urdf')


class Startup(unittest.TestCase):
    def refused(self, *words, urdf=URDF, **params):
        assert_refused(self, Generator('refused%d' % next(NUMBERS), urdf, params), words)

    def test_no_robot(self):
        self.refused('robot_description', urdf=None)
        self.refused(urdf='<robot name="r"><link name="a">')

    def test_bad_rates(self):
        for rate in (0, -1, 0.5, 1001, 1e9):
            self.refused('~rate', rate=rate)
        self.refused('~rate', 'number', rate='fast')

    def test_bad_parameters(self):
        self.refused('~ratte', 'rate', ratte=100)
        self.refused('~initial_position', '1', '2', initial_position=[0.5])
        self.refused('~initial_position', 'theta1', '99', initial_position=[99.0, 0.0])
        self.refused('~initial_position[1]', initial_position=[0.0, 'up'])
        self.refused('~initial_position', initial_position=0.5)
        self.refused('~ik_timeout', ik_timeout=0.0)
        self.refused('~threads', threads=-1)
        self.refused('~task', task=['q'])

    def test_starts_where_it_is_told(self):
        generator = Generator('placed', URDF, {'initial_position': [0.5, -1]})
        self.addCleanup(generator.shut_down)
        recorder = Recorder('placed')
        recorder.wait_until_streaming()
        self.assertEqual(list(recorder.last('joint_states').position), [0.5, -1.0])
        self.assertEqual(list(recorder.last('time_scaling').tau), [])
        answer = generator.execute(JointTrajectory())
        self.assertEqual(answer.error_code, ErrorCode.INVALID_GOAL)
        self.assertIn('nothing is planned', answer.message)

    def test_assumed_limits_are_told(self):
        generator = Generator('assumed', URDF)
        self.addCleanup(generator.shut_down)
        answer = generator.planned('cubic', [0.0, 0.0], [0.5, 0.5])
        self.assertIn('acceleration limits are assumed: theta1, theta2', answer.message)
        limits = {'acceleration_limits': [1.0, 1.0], 'jerk_limits': [9.0, 9.0]}
        self.assertNotIn('assumed', generator.planned('cubic', [0.0, 0.0], [0.5, 0.5], **limits).message)

    def test_interrupted_in_motion(self):
        generator = Generator('interrupted', URDF, {'rate': 1000})
        recorder = Recorder('interrupted')
        recorder.wait_until_streaming()
        generator.planned('cubic', [0.0, 0.0], [0.5, 0.5], duration=5.0)
        generator.executed()
        wait_for(lambda: recorder.last('joint_states').position[0] > 0.0)
        generator.process.send_signal(signal.SIGINT)
        asked = time.monotonic()
        status, lines, _ = generator.ended()
        self.assertEqual(status, 0, lines)
        self.assertLess(time.monotonic() - asked, 5.0)


if __name__ == '__main__':
    rospy.init_node('trajectory_generator_startup')
    rostest.rosrun('screwline', 'trajectory_generator_startup', Startup)
