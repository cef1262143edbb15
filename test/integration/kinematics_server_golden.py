#!/usr/bin/python3
"""Every number of the golden files as kinematics_server answers it: the robots of urdf/, other models made anew."""

import copy
import functools
import math
import unittest

import numpy as np
import rospy
import rostest
from data_support import TASK_OF, golden, golden_names
from kinematics_server_support import Server, golden_urdf, matrix, pose_matrix, pose_message, state
from geometry_msgs.msg import Point, PoseStamped, Twist, TwistStamped, Vector3, Wrench, WrenchStamped
from screwline.srv import ComputeJacobianRequest, ComputeStaticsRequest, ComputeVelocityRequest
from std_msgs.msg import Header
from test_robot_files import GOLDEN_OF

TOLERANCE = 1e-9
TIP = 'tool0'
TO_JOINT = ComputeVelocityRequest.TWIST_TO_JOINT
TO_WRENCH = ComputeStaticsRequest.EFFORT_TO_WRENCH


def vector3(values):
    return Vector3(*(float(value) for value in values))


def components(message):
    """Of a Twist or a Wrench, linear first."""
    parts = (message.linear, message.angular) if isinstance(message, Twist) else (message.force, message.torque)
    return np.array([getattr(part, axis) for part in parts for axis in 'xyz'])


def wrench(values, frame=''):
    return WrenchStamped(header=Header(frame_id=frame), wrench=Wrench(vector3(values[:3]), vector3(values[3:])))


def twist(values, frame=''):
    return TwistStamped(header=Header(frame_id=frame), twist=Twist(vector3(values[:3]), vector3(values[3:])))


def projector(rows, columns):
    rows = matrix(rows, columns)
    return rows.T @ rows


def gap(a, b, turning):
    """Largest joint difference, angles modulo a turn."""
    difference = np.array(a) - np.array(b)
    wrapped = np.where(turning, (difference + math.pi) % (2 * math.pi) - math.pi, difference)
    return np.abs(wrapped).max()


class Checks:
    def close(self, actual, expected, tolerance=TOLERANCE):
        actual, expected = np.array(actual, dtype=float), np.array(expected, dtype=float)
        self.assertEqual(actual.shape, expected.shape)
        if actual.size:
            self.assertLess(np.abs(actual - expected).max(), tolerance)

    def check_fk(self, server, case):
        answer = server.ask('compute_fk', joint_state=state(case['q']))
        self.assertEqual(answer.links, [TIP])
        self.close(pose_matrix(answer.poses[0].pose), case['pose'])
        inverse = server.ask('compute_fk', joint_state=state(case['q']), links=['base_link', TIP], frame_id=TIP)
        self.close(pose_matrix(inverse.poses[0].pose), np.linalg.inv(case['pose']))
        self.close(pose_matrix(inverse.poses[1].pose), np.eye(4))

    def check_jacobian(self, server, case):
        n = len(case['q'])
        for method in range(5):
            numerical = method == ComputeJacobianRequest.NUMERICAL
            for frame, key in (('', 'jacobian_base'), (TIP, 'jacobian_tool')):
                answer = server.ask('compute_jacobian', joint_state=state(case['q']), method=method, frame_id=frame)
                self.close(matrix(answer.jacobian, n), case[key], 1e-5 if numerical else TOLERANCE)
                self.assertLess(answer.method_disagreement, 1e-5)
            if answer.task and len(answer.task) == n:
                self.close(answer.determinant, case['det_task'], 1e-5 if numerical else TOLERANCE)
            else:
                self.assertTrue(math.isnan(answer.determinant))

    def check_reference_point(self, server, case):
        point = np.array([0.3, -0.2, 0.5])
        n = len(case['q'])
        jacobian = np.array(case['jacobian_tool'])
        expected = np.vstack([jacobian[:3] + np.cross(jacobian[3:].T, point).T, jacobian[3:]])
        answer = server.ask('compute_jacobian', joint_state=state(case['q']), frame_id=TIP, link_name=TIP,
                            reference_point=Point(*point))
        self.close(matrix(answer.jacobian, n), expected)

    def check_singularity(self, server, case):
        answer = server.ask('analyze_singularity', joint_state=state(case['q']))
        m, n = len(answer.task), len(case['q'])
        self.close(answer.singular_values, case['singular_values_task'])
        self.assertEqual(answer.rank, case['rank_task'])
        self.assertEqual(answer.singular, case['rank_task'] < min(m, n))
        self.close(answer.manipulability, case['manipulability_task'])
        if m == n:
            self.close(answer.determinant, case['det_task'])
        self.assertEqual(len(answer.lost_directions), m * (m - answer.rank))
        self.assertEqual(len(answer.self_motions), n * (n - answer.rank))
        if 'lost_task_directions' in case:
            self.close(projector(answer.lost_directions, m), projector(case['lost_task_directions'], m))
        if 'null_joint_rates' in case:
            self.close(projector(answer.self_motions, n), projector(case['null_joint_rates'], n))
        self.assertEqual(any(condition.active for condition in answer.conditions), answer.singular)

    def check_velocity(self, server, case):
        rates = case['velocity']['qd']
        for frame, key in (('', 'twist_base'), (TIP, 'twist_tool')):
            moving = state(case['q'], velocity=rates)
            answer = server.ask('compute_velocity', joint_state=moving, twist=twist([0] * 6, frame))
            self.close(components(answer.twist.twist), case['velocity'][key])
            self.assertEqual(answer.twist.header.frame_id, frame or 'base_link')
            wanted = twist(case['velocity'][key], frame)
            back = server.ask('compute_velocity', joint_state=state(case['q']), twist=wanted, direction=TO_JOINT)
            self.assertTrue(back.exact, case['id'])
            if case['kind'] == 'regular':
                self.close(back.velocity, rates, 1e-8)

    def check_statics(self, server, case):
        load = case['statics']['wrench']
        for frame, key in (('', 'tau_if_wrench_in_base'), (TIP, 'tau_if_wrench_in_tool')):
            answer = server.ask('compute_statics', joint_state=state(case['q']), wrench=wrench(load, frame))
            self.close(answer.effort, case['statics'][key])
            self.close(components(answer.wrench.wrench), load)
            self.assertEqual(len(answer.supported_wrenches), 6 * (6 - case['rank_full']))
            self.close(matrix(answer.supported_wrenches, 6) @ np.array(case['jacobian_base']),
                       np.zeros((6 - case['rank_full'], len(case['q']))))
            back = server.ask('compute_statics', joint_state=state(case['q']), effort=answer.effort,
                              wrench=wrench(load, frame), direction=TO_WRENCH)
            if case['kind'] == 'regular':
                self.assertTrue(back.exact)
                self.close(back.effort, answer.effort)

    def check_ik(self, server, case, turning):
        pose = PoseStamped(pose=pose_message(case['pose']))
        answer = server.ask('compute_ik', pose=pose, ignore_limits=True)
        self.assertTrue(answer.complete, answer.message)
        for solution in answer.solutions:
            self.assertLess(solution.position_error, TOLERANCE)
            self.assertLess(solution.orientation_error, TOLERANCE)
        found = [solution.position for solution in answer.solutions]
        if case['ik']['status'] == 'finite':
            expected = [solution['q'] for solution in case['ik']['solutions']]
            self.assertEqual(len(found), len(expected), (found, expected))
            for solution in expected:
                nearest = min(gap(solution, other, turning) for other in found)
                self.assertLess(nearest, 1e-6, (case['id'], found, expected))
        else:
            self.assertTrue(any(solution.self_motion for solution in answer.solutions), case['id'])

    def check_unreachable(self, server, data):
        for entry in data['unreachable_poses']:
            answer = server.compute_ik(pose=PoseStamped(pose=pose_message(entry['pose'])))
            self.assertFalse(answer.success)
            self.assertEqual(answer.error_code, -31, answer.message)
            self.assertGreater(answer.distance_to_reachable, 0.0)
            self.assertEqual(len(answer.closest.position), len(answer.joint_names))
            self.assertIn('unreachable', answer.message)

    def check_describe(self, server, data):
        answer = server.ask('describe')
        joints = data['model']['joints']
        self.assertEqual(answer.joint_names, [joint['name'] for joint in joints])
        screws = np.array(data['model']['screw_axes_space_w_v'])
        self.close(matrix(answer.screw_axes, 6), screws[:, [3, 4, 5, 0, 1, 2]])
        self.close(pose_matrix(answer.home), data['model']['home_pose'])
        self.assertEqual(len(answer.modified_dh), 4 * len(joints))
        self.assertEqual(answer.task, TASK_OF[data['model']['task']])
        self.assertTrue(answer.ik_complete)
        self.assertTrue(answer.ik_method)

    def check(self, server, data, checks):
        self.addCleanup(server.shut_down)
        turning = [joint['type'] != 'prismatic' for joint in data['model']['joints']]
        with self.subTest('describe'):
            self.check_describe(server, data)
        for case in data['cases']:
            for name in checks:
                with self.subTest(name, case=case['id']):
                    getattr(self, 'check_' + name)(server, case)
            with self.subTest('ik', case=case['id']):
                self.check_ik(server, case, turning)
        with self.subTest('unreachable'):
            self.check_unreachable(server, data)


ALL = ('fk', 'jacobian', 'reference_point', 'singularity', 'velocity', 'statics')


def shipped_robot(robot, name):
    def test(self):
        self.check(Server.of(robot), golden(name), ALL)

    return test


def made_anew(name):
    def test(self):
        data = golden(name)
        task = TASK_OF[data['model']['task']]
        self.check(Server(name, golden_urdf(data['model']), {'task': task}), data, ALL)

    return test


class Golden(Checks, unittest.TestCase):
    """Tests are made below, one for each robot and each other model."""


class TheCheckerItselfFails(Checks, unittest.TestCase):
    """One wrong digit in the data is seen by the check that reads it."""

    @classmethod
    def setUpClass(cls):
        cls.server = Server.of('scara', namespace='checker')
        cls.data = golden(GOLDEN_OF['scara'])

    @classmethod
    def tearDownClass(cls):
        cls.server.shut_down()

    def fails(self, check, path):
        case = copy.deepcopy(self.data['cases'][0])
        *way, last = path
        place = functools.reduce(lambda value, key: value[key], way, case)
        check(self.server, case)
        place[last] += 1e-5 if 'ik' in path else 2e-9
        with self.assertRaises(AssertionError, msg=str(path)):
            check(self.server, case)

    def test_one_wrong_digit(self):
        self.fails(self.check_fk, ['pose', 1, 3])
        self.fails(self.check_jacobian, ['jacobian_base', 0, 1])
        self.fails(self.check_jacobian, ['jacobian_tool', 5, 2])
        self.fails(self.check_jacobian, ['det_task'])
        self.fails(self.check_reference_point, ['jacobian_tool', 2, 3])
        self.fails(self.check_singularity, ['singular_values_task', 3])
        self.fails(self.check_singularity, ['manipulability_task'])
        self.fails(self.check_velocity, ['velocity', 'twist_base', 5])
        self.fails(self.check_velocity, ['velocity', 'twist_tool', 0])
        self.fails(self.check_statics, ['statics', 'tau_if_wrench_in_base', 3])
        self.fails(self.check_statics, ['statics', 'tau_if_wrench_in_tool', 1])
        turning = [True, True, True, False]
        self.fails(lambda server, case: self.check_ik(server, case, turning), ['ik', 'solutions', 1, 'q', 2])


for _robot, _name in GOLDEN_OF.items():
    setattr(Golden, 'test_robot_' + _robot, shipped_robot(_robot, _name))
for _name in golden_names():
    if _name not in GOLDEN_OF.values():
        setattr(Golden, 'test_model_' + _name, made_anew(_name))

if __name__ == '__main__':
    rospy.init_node('kinematics_server_golden')
    rostest.rosrun('screwline', 'kinematics_server_golden', 'kinematics_server_golden')
