#!/usr/bin/python3
"""derive against compute_jacobian: the factors that it names are evaluated as a client would."""

import math
import unittest

import numpy as np
import rospy
import rostest
from kinematics_server_support import Server, state
from screwline.msg import ErrorCode

ROBOTS = ['rr_planar', 'rrr_articulated', 'scara', 'rrprrr', 'puma560']
FUNCTIONS = {'sin': math.sin, 'cos': math.cos, 'sqrt': math.sqrt, 'pi': math.pi}


def value_of(factor, names):
    return eval(factor.replace('^', '**'), {'__builtins__': {}}, {**FUNCTIONS, **names})


class Derivations(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.servers = {robot: Server.of(robot) for robot in ROBOTS}

    @classmethod
    def tearDownClass(cls):
        for server in cls.servers.values():
            server.shut_down()

    def product(self, answer, q):
        names = dict(zip(answer.symbols, answer.symbol_values))
        names.update(zip(answer.joint_names, q))
        return np.prod([value_of(factor, names) for factor in answer.factors])

    def test_product_of_the_factors_is_the_determinant(self):
        for robot, server in self.servers.items():
            answer = server.ask('derive')
            self.assertTrue(answer.success, answer.message)
            self.assertLess(answer.worst_deviation, 1e-9, robot)
            random = np.random.RandomState(5)
            for _ in range(10):
                q = random.uniform(-1.0, 1.0, len(answer.joint_names))
                determinant = server.ask('compute_jacobian', joint_state=state(q)).determinant
                self.assertAlmostEqual(self.product(answer, q), determinant, delta=1e-10, msg=robot)
                self.assertGreater(abs(self.product(answer, q + 0.1) - determinant), 1e-10, robot)

    def test_every_quantity_and_format(self):
        server = self.servers['puma560']
        for form in ('markdown', 'latex', 'text', 'html'):
            for quantity in ('fk', 'jacobian', 'propagation', 'determinant', 'singularities', 'statics', 'ik'):
                answer = server.ask('derive', quantities=[quantity], format=form)
                self.assertTrue(answer.success, answer.message)
                self.assertGreater(len(answer.document), 100)
                self.assertEqual(len(answer.symbols), len(answer.symbol_values))
                self.assertEqual(bool(answer.factors), quantity in ('determinant', 'singularities'), quantity)
        self.assertIn('wrist', server.ask('derive', quantities=['singularities']).document)
        self.assertIn('shoulder', server.ask('derive', quantities=['ik'], format='text').document)

    def test_the_same_question_has_the_same_answer(self):
        server = self.servers['scara']
        self.assertEqual(server.ask('derive').document, server.ask('derive').document)

    def test_what_is_not_known_is_refused_by_name(self):
        for request, words in (({'format': 'docx'}, 'docx'), ({'format': 'pdf'}, 'pdf'), ({'quantities': ['dynamics']}, 'dynamics'),
                               ({'quantities': ['fk'] * 1000}, 'quantities')):
            answer = self.servers['scara'].derive(**request)
            self.assertFalse(answer.success)
            self.assertIn(answer.error_code, (ErrorCode.INVALID_GOAL, ErrorCode.TOO_LARGE))
            self.assertIn(words, answer.message)


if __name__ == '__main__':
    rospy.init_node('kinematics_server_derive')
    rostest.rosrun('screwline', 'kinematics_server_derive', Derivations)
