#!/usr/bin/python3
"""trajectory_generator ~plan and ~list_profiles: every profile keeps its promises, every bad request is refused."""
import math
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from kinematics_server_support import matrix, pose_matrix, pose_message
from screwline.msg import ErrorCode
from test_robot_files import Robot
from trajectory_generator_support import Generator, request, waypoint

A, B, C = [0.2, -0.4, 0.3], [0.5, 0.3, -0.2], [-0.6, 0.8, 0.1]
SINUSOID = {'amplitude_0': 0.5, 'omega_0': 2.0, 'phase_0': 0.3, 'offset_1': 0.4, 'amplitude_2': 0.2, 'omega_2': 3.0}
MEETS_VIAS = {'via_per_joint', 'multipoint_trapezoidal', 'multipoint_cubic', 'multipoint_quintic', 'bspline_interpolating'}
TAKES_VIA = MEETS_VIAS | {'via_scalar', 'bspline'}
SCALAR = {'rectangular', 'cubic', 'trapezoidal', 'double_s', 'polynomial_345', 'polynomial_4567', 'cycloidal', 'minimum_jerk', 'via_scalar',
          'path_time_optimal'}
NAMES = ['theta1', 'theta2', 'theta3']


def sine(duration=2.0):
    return request('sinusoidal', duration=duration, parameter_names=list(SINUSOID), parameter_values=list(SINUSOID.values()))


def question(profile, **fields):
    if profile == 'sinusoidal':
        return sine(**fields)
    return request(profile, A, *([B] if profile in TAKES_VIA else []), C, **fields)


class Plan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.generator = Generator.of('planar_3r')
        cls.robot = Robot('planar_3r')
        cls.profiles = [name for name in cls.generator.list_profiles().profiles if not name.startswith('cartesian')]

    @classmethod
    def tearDownClass(cls):
        cls.generator.shut_down()

    def plan(self, asked):
        answer = self.generator.plan(asked)
        self.assertTrue(answer.success, (asked.profile, answer.message))
        return answer

    def arrays(self, answer):
        points = answer.trajectory.points
        times = np.array([p.time_from_start.to_nsec() * 1e-9 for p in points])
        return (times,) + tuple(np.array([getattr(p, f) for p in points]) for f in ('positions', 'velocities', 'accelerations'))

    def test_profiles_are_listed_with_their_parameters(self):
        answer = self.generator.list_profiles()
        self.assertTrue(answer.success)
        self.assertEqual([detail.name for detail in answer.details], list(answer.profiles))
        self.assertGreaterEqual(set(answer.profiles), TAKES_VIA | SCALAR | {'sinusoidal'})
        for detail in answer.details:
            self.assertTrue(detail.meaning)
            self.assertEqual(len(detail.parameter_names), len(detail.parameter_meanings))

    def test_every_profile(self):
        for profile in self.profiles:
            fields = {} if profile == 'sinusoidal' else {'duration': 2.0}
            answer = self.plan(question(profile, **fields))
            times, q, v, a = self.arrays(answer)
            self.assertEqual(answer.duration, 2.0, profile)
            self.assertEqual(list(answer.joint_names), NAMES)
            self.assertEqual((times[0], times[-1], len(times)), (0.0, 2.0, 201), profile)
            self.assertEqual(len(answer.jerks), 3 * len(times))
            if profile != 'sinusoidal':
                np.testing.assert_allclose(q[0], A, atol=1e-12)
                np.testing.assert_allclose(q[-1], C, atol=1e-12)
            self.check_derivatives(profile, times, q, v, a)
            self.assertLess(answer.metrics.goal_error, 1e-9)

    def check_derivatives(self, profile, times, q, v, a):
        """Central differences, away from the corners of the piecewise profiles."""
        h = times[1] - times[0]
        for values, rates, scale in ((q, v, 50.0), (v, a, 500.0)):
            off = np.abs((values[2:] - values[:-2]) / (2 * h) - rates[1:-1]).max(axis=1)
            self.assertLess(np.median(off), scale * h * h, profile)

    def test_shortest_keeps_the_limits(self):
        for profile in self.profiles:
            if profile == 'sinusoidal':
                continue
            answer = self.plan(question(profile))
            self.assertTrue(0.0 < answer.duration < 10.0, profile)
            self.assertLessEqual(max(answer.metrics.limit_ratio), 1.0 + 1e-8, profile)
            self.assertGreater(max(answer.metrics.limit_ratio), 0.95, profile)
            half = self.plan(question(profile, velocity_scaling=0.5, acceleration_scaling=0.25, jerk_scaling=0.125))
            self.assertAlmostEqual(half.duration, 2.0 * answer.duration, delta=0.05 * answer.duration, msg=profile)

    def test_one_scaling_or_none(self):
        for profile in self.profiles:
            scaling = self.plan(question(profile)).time_scaling
            if profile not in SCALAR:
                self.assertEqual(len(scaling.tau) + len(scaling.s), 0, profile)
                continue
            self.assertEqual((scaling.tau[0], scaling.tau[-1]), (0.0, 1.0))
            self.assertAlmostEqual(scaling.s[-1], 1.0, delta=1e-12)
            self.assertEqual(len({len(x) for x in (scaling.tau, scaling.s, scaling.ds, scaling.dds, scaling.ddds)}), 1)

    def test_vias(self):
        for profile in TAKES_VIA:
            answer = self.plan(question(profile, duration=2.0))
            missed = matrix(answer.via_joint_errors, 3)
            self.assertEqual(missed.shape, (1, 3))
            self.assertTrue((missed >= 0.0).all())
            self.assertEqual(missed.max() < 1e-9, profile in MEETS_VIAS, profile)
            self.assertEqual('missed' in answer.message, profile not in MEETS_VIAS, answer.message)

    def test_rounded_corners(self):
        def lines(radius, **fields):
            return self.plan(request('path_time_optimal', A, B, C, parameter_names=['blend_radius'], parameter_values=[radius], **fields))
        rounded, stopped, smooth = lines(0.2), lines(0.0), lines(0.2, jerk_limits=[50.0, 50.0, 50.0])
        self.assertLess(rounded.duration, stopped.duration)
        self.assertLess(rounded.duration, smooth.duration)
        self.assertTrue(math.isinf(max(rounded.metrics.peak_jerk)))
        self.assertLessEqual(max(smooth.metrics.peak_jerk), 50.0 * (1.0 + 1e-8))
        self.assertTrue(0.0 < np.linalg.norm(smooth.via_joint_errors) < 0.1)
        self.assertLess(max(stopped.via_joint_errors), 1e-9)
        self.assertIn('the lines between them at up to', smooth.message)

    def test_times_given_for_some(self):
        way = [A, waypoint(B, time=0.9), C, A]
        answer = self.plan(request('multipoint_cubic', *way))
        times, q, _, _ = self.arrays(answer)
        np.testing.assert_allclose([np.interp(0.9, times, q[:, j]) for j in range(3)], B, atol=1e-3)
        way[1] = waypoint(B, time=0.01)
        self.refused(ErrorCode.LIMITS_INFEASIBLE, ['waypoints[1].time is 0.01 s', 'are feasible'], request('multipoint_cubic', *way, duration=9.0))

    def test_what_via_scalar_misses_at_the_tip(self):
        answer = self.plan(question('via_scalar', duration=2.0))
        _, q, _, _ = self.arrays(answer)
        middle, wanted = self.robot.forward(q[100]), self.robot.forward(B)
        self.assertAlmostEqual(answer.via_position_errors[0], np.linalg.norm(middle[:3, 3] - wanted[:3, 3]), delta=1e-9)
        self.assertAlmostEqual(answer.via_orientation_errors[0], abs(sum(q[100]) - sum(B)), delta=1e-9)

    def test_metrics(self):
        metrics = self.plan(question('rectangular', duration=2.0)).metrics
        self.assertTrue(all(math.isinf(x) for x in metrics.peak_jerk))
        answer = self.plan(question('polynomial_345', duration=2.0))
        _, q, v, a = self.arrays(answer)
        metrics = answer.metrics
        np.testing.assert_allclose(metrics.peak_velocity, np.abs(v).max(axis=0), rtol=1e-3)
        np.testing.assert_allclose(metrics.peak_acceleration, np.abs(a).max(axis=0), rtol=1e-3)
        np.testing.assert_allclose(metrics.travel, np.abs(np.array(C) - A), rtol=1e-9)
        np.testing.assert_allclose(metrics.rms_acceleration, np.sqrt((a**2).mean(axis=0)), rtol=1e-2)
        path = np.array([self.robot.forward(x)[:3, 3] for x in q])
        length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
        self.assertAlmostEqual(metrics.path_length, length, delta=1e-4)
        self.assertAlmostEqual(metrics.peak_speed, (np.linalg.norm(np.diff(path, axis=0), axis=1) / 0.01).max(), delta=1e-3)
        self.assertAlmostEqual(metrics.max_curvature, curvature(path), delta=2e-2 * metrics.max_curvature)

    def test_names_in_any_order(self):
        order = [2, 0, 1]
        plain = self.plan(request('cubic', A, C, velocity_limits=[1.0, 2.0, 3.0]))
        named = self.plan(request('cubic', [A[i] for i in order], [C[i] for i in order], joint_names=[NAMES[i] for i in order],
                                  velocity_limits=[[1.0, 2.0, 3.0][i] for i in order]))
        self.assertEqual(plain.trajectory.points, named.trajectory.points)

    def test_poses(self):
        targets = [pose_message(self.robot.forward(q)) for q in (A, [0.4, -0.6, 0.2], [0.6, -0.9, 0.1])]
        points = [waypoint(pose=PoseStamped(pose=pose)) for pose in targets]
        answer = self.plan(request('multipoint_cubic', *points, duration=3.0))
        _, q, _, _ = self.arrays(answer)
        for target, at in zip((targets[0], targets[-1]), (q[0], q[-1])):
            np.testing.assert_allclose(self.robot.forward(at), pose_matrix(target), atol=1e-8)
        self.assertLess(max(answer.via_position_errors), 1e-9)

    def test_the_branch_asked_for_is_kept(self):
        targets = [pose_message(self.robot.forward(q)) for q in (A, [0.4, -0.6, 0.2])]
        ends = []
        for branch in ('elbow up', 'elbow down'):
            first = waypoint(pose=PoseStamped(pose=targets[0]), branch=branch)
            answer = self.plan(request('cubic', first, waypoint(pose=PoseStamped(pose=targets[1]))))
            _, q, _, _ = self.arrays(answer)
            np.testing.assert_allclose(self.robot.forward(q[-1]), pose_matrix(targets[1]), atol=1e-8)
            self.assertGreater(q[0][1] * q[-1][1], 0.0)
            ends.append(q[-1][1])
        self.assertLess(ends[0] * ends[1], 0.0)

    def test_pose_in_the_frame_of_a_fixed_link(self):
        pose = PoseStamped(pose=pose_message(self.robot.forward(A)))
        pose.header.frame_id = 'base_link'
        answer = self.plan(request('cubic', waypoint(pose=pose), C))
        np.testing.assert_allclose(self.robot.forward(self.arrays(answer)[1][0]), pose_matrix(pose.pose), atol=1e-8)

    def pose(self, q, x=0.0, y=0.0):
        pose = pose_message(self.robot.forward(q))
        pose.position.x += x
        pose.position.y += y
        return waypoint(pose=PoseStamped(pose=pose))

    def tips(self, answer):
        _, q, _, _ = self.arrays(answer)
        return np.array([self.robot.forward(x) for x in q])

    def test_cartesian_line(self):
        start, goal = self.robot.forward(A), self.robot.forward([0.4, -0.9, 0.2])
        way = goal[:3, 3] - start[:3, 3]
        for law in ('', 'polynomial_345', 'double_s'):
            answer = self.plan(request('cartesian_line', A, self.pose([0.4, -0.9, 0.2]), time_law=law))
            tips = self.tips(answer)
            off = np.linalg.norm(np.cross(tips[:, :3, 3] - start[:3, 3], way), axis=1) / np.linalg.norm(way)
            self.assertLess(off.max(), 1e-6)
            np.testing.assert_allclose(tips[-1], goal, atol=1e-8)
            self.assertLessEqual(max(answer.metrics.limit_ratio), 1.0 + 1e-8)
            self.assertAlmostEqual(answer.metrics.path_length, np.linalg.norm(way), delta=1e-6)
            self.assertLess(answer.metrics.goal_error, 1e-9)
            self.assertIn('of 2 branches carry the whole path', answer.message)
            self.assertEqual((answer.time_scaling.s[0], answer.time_scaling.tau[-1]), (0.0, 1.0))

    def test_cartesian_corners(self):
        way = [A, self.pose(A, -0.3), self.pose(A, -0.3, -0.3)]
        stopped = self.plan(request('cartesian_line', *way))
        self.assertLess(max(stopped.via_position_errors), 1e-8)
        blended = self.plan(request('cartesian_line', *way, parameter_names=['blend_radius'], parameter_values=[0.1]))
        self.assertLess(blended.duration, stopped.duration)
        self.assertTrue(0.0 < blended.via_position_errors[0] < 0.1)

    def test_cartesian_arc(self):
        answer = self.plan(request('cartesian_arc', A, self.pose(A, -0.2, -0.2), self.pose(A, -0.4)))
        tips = self.tips(answer)
        centre = self.robot.forward(A)[:3, 3] - [0.2, 0.0, 0.0]
        np.testing.assert_allclose(np.linalg.norm(tips[:, :3, 3] - centre, axis=1), 0.2, atol=1e-6)
        self.assertLess(max(answer.via_position_errors), 1e-8)

    def test_refuses_cartesian_paths(self):
        far = self.pose(A, 9.0)
        self.refused(ErrorCode.PATH_NOT_CONTINUOUS, ['out of reach', 'elbow', '%'], request('cartesian_line', A, far))
        self.refused(ErrorCode.NO_IK_SOLUTION, ['waypoints[0].pose'], request('cartesian_line', far, self.pose(A)))
        self.refused(ErrorCode.INVALID_GOAL, ['time_law', 'warp', 'double_s'],
                     request('cartesian_line', A, self.pose(A, -0.1), time_law='warp'))
        self.refused(ErrorCode.INVALID_GOAL, ['time_law'], request('cubic', A, C, time_law='cubic'))
        self.refused(ErrorCode.INVALID_GOAL, ['one line'], request('cartesian_arc', A, self.pose(A, -0.1), self.pose(A, -0.2)))
        self.refused(ErrorCode.LIMITS_INFEASIBLE, ['0.01', 'shortest'],
                     request('cartesian_line', A, self.pose(A, -0.3), duration=0.01))

    def refused(self, code, words, asked):
        answer = self.generator.plan(asked)
        self.assertFalse(answer.success, words)
        self.assertEqual(answer.error_code, code, answer.message)
        self.assertEqual(len(answer.trajectory.points), 0)
        for word in words:
            self.assertIn(word, answer.message)

    def test_refuses_profiles_and_parameters(self):
        self.refused(ErrorCode.UNKNOWN_PROFILE, ['warp', 'cubic'], request('warp', A, C))
        self.refused(ErrorCode.UNKNOWN_PROFILE, [], request('', A, C))
        self.refused(ErrorCode.INVALID_GOAL, ['parameter_values', '1', '0'], request('trapezoidal', A, C, parameter_names=['peak_velocity']))
        self.refused(ErrorCode.INVALID_GOAL, ['speed'], request('trapezoidal', A, C, parameter_names=['speed'], parameter_values=[1.0]))
        self.refused(ErrorCode.INVALID_GOAL, ['peak_velocity'],
                     request('trapezoidal', A, C, parameter_names=['peak_velocity'], parameter_values=[math.nan]))

    def test_refuses_waypoints(self):
        goal, state = ErrorCode.INVALID_GOAL, ErrorCode.INVALID_ROBOT_STATE
        self.refused(goal, ['waypoints'], request('cubic'))
        self.refused(goal, ['waypoints'], request('cubic', A))
        self.refused(goal, ['waypoints'], request('cubic', A, B, C))
        self.refused(state, ['waypoints[1].position', '2', '3'], request('cubic', A, [0.1, 0.2]))
        self.refused(state, ['waypoints[1].position[2]', 'nan'], request('cubic', A, [0.1, 0.2, math.nan]))
        self.refused(state, ['waypoints[1].position[0]'], request('cubic', A, [2e6, 0.2, 0.0]))
        self.refused(goal, ['waypoints[1].position', 'theta2', '3.5', '3.2'], request('cubic', A, [0.0, 3.5, 0.0]))
        self.refused(state, ['joint_names', 'elbow'], request('cubic', A, C, joint_names=['theta1', 'elbow', 'theta3']))
        self.refused(state, ['joint_names', 'theta1'], request('cubic', A, C, joint_names=['theta1', 'theta1', 'theta3']))
        self.refused(state, ['waypoints[1].velocity'], request('cubic', A, waypoint(C, velocity=[0.0])))
        self.refused(goal, ['waypoints[1].velocity'], request('cubic', A, waypoint(C, velocity=[1.0, 0.0, 0.0])))
        self.refused(goal, ['waypoints[0].time'], request('cubic', waypoint(A, time=1.0), C))
        self.refused(goal, ['waypoints[2].time'], request('multipoint_cubic', A, waypoint(B, time=2.0), waypoint(C, time=1.0)))
        self.refused(goal, ['duration', '2', '3'], request('cubic', A, waypoint(C, time=3.0), duration=2.0))

    def test_refuses_durations_limits_and_scalings(self):
        goal, infeasible = ErrorCode.INVALID_GOAL, ErrorCode.LIMITS_INFEASIBLE
        self.refused(goal, ['duration', '-1'], request('cubic', A, C, duration=-1.0))
        self.refused(goal, ['duration'], request('cubic', A, C, duration=math.inf))
        self.refused(infeasible, ['0.01', 'shortest'], request('cubic', A, C, duration=0.01))
        self.refused(goal, ['sample_period'], request('cubic', A, C, sample_period=-0.1))
        self.refused(ErrorCode.TOO_LARGE, ['1000000'], request('cubic', A, C, duration=20.0, sample_period=1e-5))
        self.refused(ErrorCode.INVALID_ROBOT_STATE, ['velocity_limits', '2', '3'], request('cubic', A, C, velocity_limits=[1.0, 1.0]))
        for value in (0.0, -1.0, math.nan, math.inf):
            self.refused(goal, ['jerk_limits[1]'], request('cubic', A, C, jerk_limits=[1.0, value, 1.0]))
        for value in (-0.5, 1.5, math.nan):
            self.refused(goal, ['velocity_scaling'], request('cubic', A, C, velocity_scaling=value))

    def test_refuses_poses(self):
        pose = PoseStamped(pose=pose_message(self.robot.forward(A)))
        far = PoseStamped(pose=pose_message(self.robot.forward(A)))
        far.pose.position.x = 9.0
        self.refused(ErrorCode.NO_IK_SOLUTION, ['waypoints[1].pose'], request('cubic', A, waypoint(pose=far)))
        lost = PoseStamped(pose=pose.pose)
        lost.header.frame_id = 'mars'
        self.refused(ErrorCode.FRAME_TRANSFORM_FAILURE, ['waypoints[1]', 'mars'], request('cubic', A, waypoint(pose=lost)))
        self.refused(ErrorCode.INVALID_GOAL, ['waypoints[1].pose', 'norm'], request('cubic', A, waypoint()))
        self.refused(ErrorCode.INVALID_GOAL, ['waypoints[1]', 'sideways'],
                     request('cubic', A, waypoint(pose=pose, branch='elbow sideways')))
        broken = PoseStamped(pose=pose_message(self.robot.forward(A)))
        broken.pose.position.y = math.nan
        self.refused(ErrorCode.INVALID_GOAL, ['waypoints[1].pose.pose.position.y'], request('cubic', A, waypoint(pose=broken)))


def curvature(path):
    """Largest curvature by circles through three neighbours, away from the resting ends."""
    a, b, c = path[20:-22], path[21:-21], path[22:-20]
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    sides = [np.linalg.norm(x - y, axis=1) for x, y in ((a, b), (b, c), (c, a))]
    return (4.0 * area / (sides[0] * sides[1] * sides[2])).max()


if __name__ == '__main__':
    rospy.init_node('trajectory_generator_plan')
    rostest.rosrun('screwline', 'trajectory_generator_plan', Plan)
