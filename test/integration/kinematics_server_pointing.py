#!/usr/bin/python3
"""kinematics_server and the direction of a tool's axis: rows tx ty tz, of five joints and of six."""

import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from kinematics_server_support import Server, matrix, pose_matrix, pose_message, rotation_of, state
from screwline.msg import ErrorCode
from screwline.srv import ComputeStaticsRequest, ComputeVelocityRequest

Q = [0.4, -0.5, 0.9, 0.3, -0.2]
X_AXIS = ['x', 'y', 'z', 'ty', 'tz']
Z_AXIS = ['x', 'y', 'z', 'tx', 'ty']
TO_WRENCH = ComputeStaticsRequest.EFFORT_TO_WRENCH
TO_JOINT = ComputeVelocityRequest.TWIST_TO_JOINT


def turned(pose, axis, angle):
    """The pose turned about its own axis."""
    turn = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    turn[i, i] = turn[j, j] = np.cos(angle)
    turn[i, j], turn[j, i] = -np.sin(angle), np.sin(angle)
    return PoseStamped(pose=pose_message(pose_matrix(pose) @ turn))


class Pointing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server.of('youbot_arm', task=X_AXIS)

    @classmethod
    def tearDownClass(cls):
        cls.server.shut_down()

    def ask(self, service, **fields):
        return self.server.ask(service, **fields)

    def tip(self, position):
        return self.ask('compute_fk', joint_state=state(position)).poses[0].pose

    def same_direction(self, pose, other, axis):
        a, b = pose_matrix(pose), pose_matrix(other)
        self.assertLess(np.abs(a[:3, 3] - b[:3, 3]).max(), 1e-9)
        self.assertLess(np.abs(a[:3, axis] - b[:3, axis]).max(), 1e-9)

    def test_describe(self):
        answer = self.ask('describe')
        self.assertEqual(answer.task, X_AXIS)
        self.assertTrue(answer.ik_complete, answer.ik_method)
        self.assertIn('closed form', answer.ik_method)

    def test_every_solution(self):
        wanted = self.tip(Q)
        answer = self.ask('compute_ik', pose=turned(wanted, 0, 1.1), seed=state(Q), ignore_limits=True)
        self.assertTrue(answer.complete, answer.message)
        self.assertGreater(len(answer.solutions), 1)
        self.assertLess(np.abs(np.array(answer.solutions[0].position) - Q).max(), 1e-9)
        for solution in answer.solutions:
            self.same_direction(self.tip(solution.position), wanted, 0)

    def test_last_joint_is_free_about_z(self):
        wanted = self.tip(Q)
        answer = self.ask('compute_ik', pose=turned(wanted, 2, -0.7), task=Z_AXIS, seed=state(Q), ignore_limits=True)
        self.assertTrue(answer.complete, answer.message)
        for solution in answer.solutions:
            self.assertEqual(solution.free_joints, ['arm_joint_5'])
            self.assertTrue(solution.singular)
            self.same_direction(self.tip(solution.position), wanted, 2)
        answer = self.ask('analyze_singularity', joint_state=state(Q), task=Z_AXIS)
        self.assertTrue(answer.singular)
        self.assertEqual(answer.rank, 4)

    def test_out_of_the_arms_plane(self):
        upright = self.tip(Q[:4] + [0.0])
        self.ask('compute_ik', pose=turned(upright, 1, 0.1), task=Z_AXIS, ignore_limits=True)
        answer = self.server.compute_ik(pose=turned(upright, 0, 0.2), task=Z_AXIS, ignore_limits=True)
        self.assertEqual(answer.error_code, ErrorCode.NO_IK_SOLUTION)
        self.assertIn('unreachable', answer.message)
        self.assertGreater(answer.distance_to_reachable, 0.0)

    def test_rows_along_the_tools_axes(self):
        rotation = rotation_of(self.tip(Q).orientation)
        for frame in ('', 'tool0', 'arm_link_2'):
            answer = self.ask('compute_jacobian', joint_state=state(Q), frame_id=frame)
            self.assertEqual(answer.task, X_AXIS)
            rows = matrix(answer.task_jacobian, 5)
            base = matrix(self.ask('compute_jacobian', joint_state=state(Q)).jacobian, 5)
            self.assertLess(np.abs(rows[3:] - (rotation.T @ base[3:])[1:]).max(), 1e-12)
            self.assertLess(np.abs(rows[:3] - matrix(answer.jacobian, 5)[:3]).max(), 1e-12)
            self.assertAlmostEqual(answer.determinant, np.linalg.det(rows), places=12)

    def test_rates_and_wrenches(self):
        rates = [0.3, -0.1, 0.2, 0.4, -0.5]
        twist = self.ask('compute_velocity', joint_state=state(Q, velocity=rates)).twist
        answer = self.ask('compute_velocity', joint_state=state(Q), twist=twist, direction=TO_JOINT)
        self.assertTrue(answer.exact)
        self.assertLess(np.abs(np.array(answer.velocity) - rates).max(), 1e-9)
        efforts = [1.0, 2.0, -1.0, 0.5, 0.25]
        answer = self.ask('compute_statics', joint_state=state(Q), effort=efforts, direction=TO_WRENCH)
        self.assertTrue(answer.exact)
        torque = answer.wrench.wrench.torque
        axis = rotation_of(self.tip(Q).orientation)[:, 0]
        self.assertAlmostEqual(axis @ [torque.x, torque.y, torque.z], 0.0, places=12)


if __name__ == '__main__':
    rospy.init_node('kinematics_server_pointing')
    rostest.rosrun('screwline', 'kinematics_server_pointing', 'kinematics_server_pointing')
