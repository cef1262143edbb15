#!/usr/bin/python3
"""kinematics_server and what callers send: joint names in any order, frames, links, every bad input; it lives on."""

import itertools
import math
import threading
import unittest

import genpy
import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import (Point, Pose, PoseStamped, Quaternion, TransformStamped, Twist, TwistStamped, Vector3,
                               Wrench, WrenchStamped)
from kinematics_server_support import Server, matrix, pose_matrix, pose_message, state
from screwline.msg import ErrorCode
from screwline.srv import ComputeIK, ComputeStaticsRequest, ComputeVelocityRequest
from std_msgs.msg import Header

NAN, INFINITY = float('nan'), float('inf')
NAMES = ['theta1', 'theta2', 'theta3', 'd4']
Q = [0.3, -0.7, 0.4, 0.2]
RATES = [0.1, 0.2, -0.3, 0.4]
STATE, GOAL, LINK = ErrorCode.INVALID_ROBOT_STATE, ErrorCode.INVALID_GOAL, ErrorCode.INVALID_LINK_NAME
FRAME, LARGE = ErrorCode.FRAME_TRANSFORM_FAILURE, ErrorCode.TOO_LARGE
LAB = np.array([[0.0, -1.0, 0.0, 0.5], [1.0, 0.0, 0.0, -0.25], [0.0, 0.0, 1.0, 0.125], [0.0, 0.0, 0.0, 1.0]])
TO_WRENCH = ComputeStaticsRequest.EFFORT_TO_WRENCH
TO_JOINT = ComputeVelocityRequest.TWIST_TO_JOINT


def target(x=0.6, y=0.3, z=-0.2, quaternion=(0.0, 0.0, 0.0, 1.0), frame=''):
    return PoseStamped(header=Header(frame_id=frame), pose=Pose(Point(x, y, z), Quaternion(*quaternion)))


def twist(linear=(0.1, 0.0, 0.0), angular=(0.0, 0.0, 0.0), frame=''):
    return TwistStamped(header=Header(frame_id=frame), twist=Twist(Vector3(*linear), Vector3(*angular)))


def wrench(force=(1.0, 2.0, 3.0), torque=(0.1, 0.2, 0.3), frame=''):
    return WrenchStamped(header=Header(frame_id=frame), wrench=Wrench(Vector3(*force), Vector3(*torque)))


def publish_lab_frame():
    """The frame 'lab', which is no link of the arm, at LAB in its base link."""
    broadcaster = tf2_ros.StaticTransformBroadcaster()
    transform = TransformStamped(header=Header(frame_id='base_link', stamp=rospy.Time.now()), child_frame_id='lab')
    pose = pose_message(LAB)
    transform.transform.translation = Vector3(pose.position.x, pose.position.y, pose.position.z)
    transform.transform.rotation = pose.orientation
    broadcaster.sendTransform(transform)
    return broadcaster


class WithServer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.broadcaster = publish_lab_frame()
        cls.server = Server.of('scara')
        cls.server.ask('describe')

    @classmethod
    def tearDownClass(cls):
        cls.server.shut_down()

    def ask(self, service, **fields):
        return self.server.ask(service, **fields)

    def close(self, actual, expected):
        actual, expected = np.array(actual), np.array(expected)
        self.assertEqual(actual.shape, expected.shape)
        self.assertTrue(actual.size == 0 or np.abs(actual - expected).max() < 1e-9, (actual, expected))


class GoodRequests(WithServer):
    def test_joint_names_in_any_order(self):
        for order in itertools.permutations(range(4)):
            named = state([Q[i] for i in order], [NAMES[i] for i in order], [RATES[i] for i in order])
            plain = state(Q, velocity=RATES)
            poses = [self.ask('compute_fk', joint_state=values).poses for values in (named, plain)]
            self.assertEqual(*poses)
            answer = self.ask('compute_velocity', joint_state=named)
            self.assertEqual(answer.joint_names, NAMES)
            self.assertEqual(list(answer.velocity), RATES)
            effort = [[1.0, 2.0, 3.0, 4.0][i] for i in order]
            answer = self.ask('compute_statics', joint_state=named, effort=effort, direction=TO_WRENCH)
            self.close(answer.effort, [1.0, 2.0, 3.0, 4.0])

    def test_every_link_in_every_frame(self):
        links = ['base_link', 'upper_arm', 'forearm', 'spindle', 'quill', 'tool0']
        base = self.ask('compute_fk', joint_state=state(Q), links=links)
        poses = {link: pose_matrix(pose.pose) for link, pose in zip(links, base.poses)}
        poses['lab'] = LAB
        self.close(poses['base_link'], np.eye(4))
        for frame in poses:
            answer = self.ask('compute_fk', joint_state=state(Q), links=links, frame_id=frame)
            self.assertEqual(answer.links, links)
            for link, pose in zip(links, answer.poses):
                self.assertEqual(pose.header.frame_id, frame)
                self.close(pose_matrix(pose.pose), np.linalg.inv(poses[frame]) @ poses[link])

    def test_jacobian_of_every_link(self):
        base = self.ask('compute_jacobian', joint_state=state(Q))
        for link, moved in (('base_link', 0), ('upper_arm', 1), ('forearm', 2), ('spindle', 3), ('tool0', 4)):
            for method in range(5):
                answer = self.ask('compute_jacobian', joint_state=state(Q), link_name=link, method=method)
                jacobian = matrix(answer.jacobian, 4)
                self.close(jacobian[3:, :moved], matrix(base.jacobian, 4)[3:, :moved])
                self.assertFalse(jacobian[:, moved:].any())
                self.assertLess(answer.method_disagreement, 1e-7)
        answer = self.ask('compute_jacobian', joint_state=state(Q), link_name='forearm')
        self.close(matrix(answer.jacobian, 4)[:2, 0], [-0.7 * math.sin(0.3), 0.7 * math.cos(0.3)])

    def test_jacobian_along_a_frames_axes(self):
        base = self.ask('compute_jacobian', joint_state=state(Q))
        self.assertEqual(base.task, ['x', 'y', 'z', 'rz'])
        self.close(base.task_jacobian, matrix(base.jacobian, 4)[[0, 1, 2, 5]].ravel())
        lab = self.ask('compute_jacobian', joint_state=state(Q), frame_id='lab')
        turn = np.kron(np.eye(2), LAB[:3, :3].T)
        self.close(matrix(lab.jacobian, 4), turn @ matrix(base.jacobian, 4))

    def test_inverse_kinematics_in_a_tf_frame(self):
        wanted = pose_matrix(self.ask('compute_fk', joint_state=state(Q)).poses[0].pose)
        pose = PoseStamped(header=Header(frame_id='lab'), pose=pose_message(np.linalg.inv(LAB) @ wanted))
        answer = self.ask('compute_ik', pose=pose, seed=state(Q))
        self.assertEqual(answer.joint_names, NAMES)
        self.close(answer.solutions[0].position, Q)
        self.assertEqual(answer.solutions[0], answer.closest)
        self.assertGreater(len(answer.solutions), 1)
        one = self.ask('compute_ik', pose=pose, seed=state(Q), max_solutions=1)
        self.assertEqual(one.solutions, answer.solutions[:1])

    def test_seed_in_another_order(self):
        seed = state(Q[::-1], NAMES[::-1])
        wanted = self.ask('compute_fk', joint_state=state(Q)).poses[0]
        self.close(self.ask('compute_ik', pose=wanted, seed=seed).solutions[0].position, Q)

    def test_what_the_task_does_not_read_may_be_anything(self):
        pose = target(z=NAN, quaternion=(NAN, 0.0, 0.0, 0.0))
        answer = self.ask('compute_ik', pose=pose, task=['x', 'y'], max_solutions=1)
        found = self.ask('compute_fk', joint_state=state(answer.solutions[0].position)).poses[0].pose.position
        self.close([found.x, found.y], [0.6, 0.3])
        partly = twist((0.1, 0.0, NAN))
        self.ask('compute_velocity', joint_state=state(Q), twist=partly, task=['x', 'y'], direction=TO_JOINT)

    def test_a_nearly_unit_quaternion_is_normalised(self):
        self.assertEqual(self.ask('compute_ik', pose=target(quaternion=(0.0, 0.0, 0.0, 1.0005))).solutions,
                         self.ask('compute_ik', pose=target()).solutions)

    def test_statics_in_a_links_frame(self):
        at = pose_matrix(self.ask('compute_fk', joint_state=state(Q)).poses[0].pose)[:3, :3]
        force, torque = np.array([1.0, -2.0, 3.0]), np.array([0.5, 0.25, -0.125])
        tool = self.ask('compute_statics', joint_state=state(Q), wrench=wrench(force, torque, 'tool0'))
        base = self.ask('compute_statics', joint_state=state(Q), wrench=wrench(at @ force, at @ torque))
        self.close(tool.effort, base.effort)
        self.assertEqual(tool.wrench.header.frame_id, 'tool0')
        self.assertEqual(base.wrench.header.frame_id, 'base_link')

    def test_answers_from_many_threads_are_the_same(self):
        def answers():
            server = Server.__new__(Server)
            server.name = self.server.name
            return [server.ask('compute_ik', pose=target(x=0.4 + 0.01 * i)).solutions for i in range(30)] + \
                   [server.ask('analyze_singularity', joint_state=state([0.1 * i] * 4)) for i in range(5)]

        expected = str(answers())
        found = [None] * 6

        def run(place):
            found[place] = str(answers())

        threads = [threading.Thread(target=run, args=(place,)) for place in range(len(found))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [expected] * len(found))


class BadRequests(WithServer):
    def tearDown(self):
        self.assertIsNone(self.server.process.poll(), 'the node has ended')
        self.ask('compute_fk', joint_state=state(Q))

    def refused(self, code, *words, service='compute_fk', **fields):
        answer = getattr(self.server, service)(**fields)
        self.assertFalse(answer.success, fields)
        self.assertEqual(answer.error_code, code, answer.message)
        for word in words:
            self.assertIn(word, answer.message)

    def at_q(self, service, code, *words, **fields):
        """Refused although the joint values are good."""
        self.refused(code, *words, service=service, **dict({'joint_state': state(Q)}, **fields))

    def test_joint_states(self):
        for service in ('compute_fk', 'compute_jacobian', 'analyze_singularity', 'compute_statics', 'compute_velocity'):
            with self.subTest(service):
                self.refuse_joint_states(service)

    def refuse_joint_states(self, service):
        def refused(*words, joint_state):
            self.refused(STATE, *words, service=service, joint_state=joint_state)

        refused("joint_state.position has 0 values, chain 'scara' has 4 joints", joint_state=state([]))
        refused('joint_state.position has 3 values', joint_state=state(Q[:3]))
        refused('joint_state.position has 5 values', joint_state=state(Q + [0.0]))
        refused('has 4 values, joint_state.name has 3 names', joint_state=state(Q, NAMES[:3]))
        with_unknown, with_repeated = ['theta1', 'elbow', 'theta3', 'd4'], ['theta1', 'theta1', 'theta3', 'd4']
        refused("joint_state.name[1] is 'elbow'", "'scara' has no such joint", joint_state=state(Q, with_unknown))
        refused("'theta1', as joint_state.name[0] is already", joint_state=state(Q, with_repeated))
        refused("lacks joint 'd4'", joint_state=state(Q[:3], NAMES[:3]))
        refused("'finger'", joint_state=state(Q + [0.0], NAMES + ['finger']))
        for value in (NAN, INFINITY, -INFINITY, 1.1e6, -1e300):
            refused('joint_state.position[2]', joint_state=state(Q[:2] + [value, 0.0]))
        refused(joint_state=state([0.0] * 200000))
        refused(joint_state=state([0.0] * 20000, ['theta1'] * 20000))

    def test_links(self):
        self.refused(LINK, "links[1] is 'hand'", joint_state=state(Q), links=['tool0', 'hand'])
        self.refused(LINK, "links[0] is ''", joint_state=state(Q), links=[''])
        self.refused(LARGE, '10001', '10000', joint_state=state(Q), links=['tool0'] * 10001)
        self.at_q('compute_jacobian', LINK, 'hand', link_name='hand')
        self.refused(LINK, 'hand', service='compute_ik', pose=target(), link_name='hand')
        self.refused(LINK, 'forearm', service='compute_ik', pose=target(), link_name='forearm')

    def test_frames(self):
        for frame in ('nowhere', '/base_link', ' ', 'x' * 5000, 'no\nwhere'):
            self.refused(FRAME, 'frame_id', joint_state=state(Q), frame_id=frame)
        self.at_q('compute_jacobian', FRAME, 'nowhere', frame_id='nowhere')
        self.refused(FRAME, 'nowhere', service='compute_ik', pose=target(frame='nowhere'))
        self.refused(FRAME, 'forearm', service='compute_ik', pose=target(frame='forearm'))
        self.at_q('compute_statics', FRAME, 'nowhere', wrench=wrench(frame='nowhere'))
        moving = state(Q, velocity=RATES)
        self.at_q('compute_velocity', FRAME, 'nowhere', joint_state=moving, twist=twist(frame='nowhere'))

    def test_methods_and_directions(self):
        self.at_q('compute_jacobian', GOAL, 'method is 5', method=5)
        self.at_q('compute_statics', GOAL, 'direction is 2', direction=2)
        self.at_q('compute_velocity', GOAL, 'direction is 255', direction=255)

    def test_tasks(self):
        for task in (['x', 'w'], ['x', 'x'], [''], ['x'] * 1000, ['X']):
            self.refused(GOAL, service='compute_ik', pose=target(), task=task)
            self.at_q('analyze_singularity', GOAL, task=task)
            self.at_q('compute_statics', GOAL, effort=Q, task=task, direction=TO_WRENCH)
            self.at_q('compute_velocity', GOAL, task=task, direction=TO_JOINT)

        self.refused(GOAL, '2 of rx ry rz', service='compute_ik', pose=target(), task=['x', 'rx', 'ry'])
        self.refused(GOAL, '1 of tx ty tz', service='compute_ik', pose=target(), task=['x', 'tx'])
        self.refused(GOAL, "'ty' stands beside 'rx'", service='compute_ik', pose=target(), task=['x', 'rx', 'ty'])

    def test_target_poses(self):
        for value in (NAN, INFINITY, 1e7):
            self.refused(GOAL, 'pose.position.y', service='compute_ik', pose=target(y=value))
            pose = target(quaternion=(0.0, 0.0, value, 1.0))
            self.refused(GOAL, 'pose.orientation.z', service='compute_ik', pose=pose)
        self.refused(GOAL, 'norm 0', service='compute_ik', pose=target(quaternion=(0.0, 0.0, 0.0, 0.0)))
        self.refused(GOAL, 'norm 1.002', service='compute_ik', pose=target(quaternion=(0.0, 0.0, 0.0, 1.002)))
        self.refused(GOAL, service='compute_ik', pose=target(quaternion=(math.sin(0.05), 0.0, 0.0, math.cos(0.05))))

    def test_seeds(self):
        self.refused(STATE, 'seed.position has 3 values', service='compute_ik', pose=target(), seed=state(Q[:3]))
        self.refused(STATE, 'seed.name', service='compute_ik', pose=target(), seed=state(Q, ['a', 'b', 'c', 'd']))
        self.refused(STATE, 'seed.name', service='compute_ik', pose=target(), seed=state([], NAMES))
        self.refused(STATE, 'seed.position[0]', service='compute_ik', pose=target(), seed=state([NAN] + Q[1:]))

    def test_other_numbers_of_inverse_kinematics(self):
        self.refused(GOAL, 'timeout is -1', service='compute_ik', pose=target(), timeout=-1.0)
        self.refused(GOAL, 'timeout is nan', service='compute_ik', pose=target(), timeout=NAN)
        self.refused(GOAL, 'sideways', service='compute_ik', pose=target(), branch='sideways')
        self.refused(GOAL, 'redundancy[0]', service='compute_ik', pose=target(), redundancy=[NAN])
        self.refused(LARGE, 'redundancy', service='compute_ik', pose=target(), redundancy=[0.0] * 100000)
        self.refused(GOAL, 'max_solutions is 4294967295', service='compute_ik', pose=target(), max_solutions=2**32 - 1)
        proxy = rospy.ServiceProxy(self.server.name + '/compute_ik', ComputeIK)
        self.assertRaises((rospy.ServiceException, genpy.SerializationError), proxy, pose=target(), max_solutions=-1)

    def test_out_of_reach(self):
        self.refused(ErrorCode.NO_IK_SOLUTION, 'unreachable', service='compute_ik', pose=target(x=5.0))
        self.refused(ErrorCode.NO_IK_SOLUTION, 'limits', service='compute_ik', pose=target(z=-3.0))
        self.refused(ErrorCode.NO_IK_SOLUTION, service='compute_ik', pose=target(x=1e6))

    def test_wrenches_and_efforts(self):
        self.at_q('compute_statics', GOAL, 'wrench.force.x', wrench=wrench((NAN, 0.0, 0.0)))
        self.at_q('compute_statics', GOAL, 'wrench.torque.z', wrench=wrench(torque=(0.0, 0.0, 1e9)))
        for effort in ([], Q[:3], Q + Q):
            self.at_q('compute_statics', STATE, 'effort has', effort=effort, direction=TO_WRENCH)
        self.at_q('compute_statics', STATE, 'effort[1]', effort=[0.0, NAN, 0.0, 0.0], direction=TO_WRENCH)

    def test_rates_and_twists(self):
        self.at_q('compute_velocity', STATE, 'joint_state.velocity has 0 values')
        moving = state(Q, velocity=[0.0, 0.0, 0.0, NAN])
        self.at_q('compute_velocity', STATE, 'joint_state.velocity[3]', joint_state=moving)
        self.at_q('compute_velocity', GOAL, 'twist.linear.y', twist=twist((0.0, NAN, 0.0)), direction=TO_JOINT)
        turning = twist(angular=(0.0, 0.0, INFINITY))
        self.at_q('compute_velocity', GOAL, 'twist.angular.z', twist=turning, direction=TO_JOINT)

    def test_reference_points(self):
        self.at_q('compute_jacobian', GOAL, 'reference_point.z', reference_point=Point(0.0, 0.0, NAN))
        self.at_q('compute_jacobian', GOAL, 'reference_point.x', reference_point=Point(2e6, 0.0, 0.0))


if __name__ == '__main__':
    rospy.init_node('kinematics_server_requests')
    rostest.rosrun('screwline', 'kinematics_server_requests', 'kinematics_server_requests')
