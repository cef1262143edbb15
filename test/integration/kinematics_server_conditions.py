#!/usr/bin/python3
"""analyze_singularity's conditions: fitted to numbers at first, derived exactly soon after, with the same meaning."""
import itertools
import signal
import time
import unittest

import numpy as np
import rospy
import rostest
from data_support import golden
from kinematics_server_support import Server, state
from test_robot_files import GOLDEN_OF

NUMBERS = itertools.count()
SECONDS = 60
SLOW = ('panda', 'gen3_7dof')


def note_of(server):
    return next(note for note in server.ask('describe').notes if note.startswith('the conditions of analyze_singularity'))


def condition_values(answer):
    return {condition.expression: condition for condition in answer.conditions}


class Conditions(unittest.TestCase):
    def served(self, robot, **params):
        server = Server.of(robot, namespace='%s_%d' % (robot, next(NUMBERS)), **params)
        self.addCleanup(server.shut_down)
        return server

    def derived(self, robot):
        server = self.served(robot)
        deadline = time.monotonic() + SECONDS
        while not note_of(server).endswith('are derived exactly'):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        return server

    def test_derived_ones_mean_what_the_fitted_ones_do(self):
        for robot, name in GOLDEN_OF.items():
            fitted, derived = self.served(robot, conditions_timeout=0), self.derived(robot)
            self.assertTrue(note_of(fitted).endswith('are fitted to numbers'))
            for case in golden(name)['cases']:
                with self.subTest(robot, case=case['id']):
                    answers = [server.ask('analyze_singularity', joint_state=state(case['q'])) for server in (fitted, derived)]
                    expected, found = (condition_values(answer) for answer in answers)
                    self.assertEqual(set(found), set(expected))
                    for expression, condition in found.items():
                        other = expected[expression]
                        self.assertEqual((condition.name, condition.meaning, condition.latex, condition.active),
                                         (other.name, other.meaning, other.latex, other.active))
                        self.assertAlmostEqual(condition.value, other.value, delta=1e-9)
                    self.assertEqual(any(condition.active for condition in answers[1].conditions), answers[1].singular)
                    self.assertAlmostEqual(answers[0].distance_to_singularity, answers[1].distance_to_singularity, delta=1e-6)
            fitted.shut_down()
            derived.shut_down()

    def test_derived_ones_take_the_place_of_the_fitted(self):
        for robot, fitted_names, derived_names in (('youbot_arm', ['determinant'], ['elbow', 'determinant']),
                                                   ('jaco2_6dof', ['determinant'], ['arm'])):
            for server, names in ((self.served(robot, conditions_timeout=0), fitted_names), (self.derived(robot), derived_names)):
                count = len(server.ask('describe').joint_names)
                answer = server.ask('analyze_singularity', joint_state=state([0.3 + 0.1 * i for i in range(count)]))
                self.assertEqual([condition.name for condition in answer.conditions], names)
                self.assertFalse(answer.singular or any(condition.active for condition in answer.conditions))
        q = [0.3, 0.4, 0.0, 0.5, 0.6]  # sin(arm_joint_3) = 0
        answer = self.derived('youbot_arm').ask('analyze_singularity', joint_state=state(q))
        self.assertTrue(answer.singular)
        self.assertEqual([condition.active for condition in answer.conditions if condition.name == 'elbow'], [True])

    def test_other_tasks_keep_fitted_ones(self):
        server = self.derived('puma560')
        q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
        answer = server.ask('analyze_singularity', joint_state=state(q), task=['x', 'y', 'z'])
        self.assertEqual([condition.name for condition in answer.conditions], ['determinant'])

    def test_time_that_is_too_short_leaves_the_fitted_ones(self):
        server = self.served('panda', conditions_timeout=1e-3)
        deadline = time.monotonic() + SECONDS
        while 'time limit' not in note_of(server):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        self.assertTrue(server.ask('analyze_singularity', joint_state=state([0.1] * 7)).conditions)

    def test_serves_and_ends_at_once_while_it_derives(self):
        for robot in SLOW:
            with self.subTest(robot):
                server = self.served(robot)
                answer = server.ask('analyze_singularity', joint_state=state([0.3] * 7))
                self.assertTrue(np.isfinite(answer.manipulability))
                begin = time.monotonic()
                server.process.send_signal(signal.SIGINT)
                self.assertEqual(server.process.wait(timeout=20), 0)
                self.assertLess(time.monotonic() - begin, 5.0)

    def test_a_bad_limit_is_refused(self):
        server = self.served('rr_planar', conditions_timeout=-1)
        status, lines, _ = server.ended()
        self.assertEqual(status, 1)
        self.assertIn('~conditions_timeout', ''.join(lines))


if __name__ == '__main__':
    rospy.init_node('kinematics_server_conditions')
    rostest.rosrun('screwline', 'kinematics_server_conditions', Conditions)
