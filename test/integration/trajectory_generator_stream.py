#!/usr/bin/python3
"""trajectory_generator ~execute and ~stop: what is streamed is what was planned, sample for sample, without a jump."""
import math
import unittest

import numpy as np
import rospy
import rostest
from kinematics_server_support import pose_matrix
from screwline.msg import ErrorCode
from test_robot_files import Robot
from trajectory_generator_support import Generator, Recorder, trajectory

VELOCITY, ACCELERATION = 5.0, 25.0  # limits of each joint of planar_3r
NAMES = ['theta1', 'theta2', 'theta3']
STREAMS = ('joint_states', 'time_scaling', 'tool_pose', 'tool_twist')


class Stream(unittest.TestCase):
    RATE = 100.0

    @classmethod
    def setUpClass(cls):
        cls.generator = Generator.of('planar_3r', 'stream', rate=cls.RATE)
        cls.robot = Robot('planar_3r')
        cls.recorder = Recorder('stream')
        cls.recorder.wait_until_streaming()

    @classmethod
    def tearDownClass(cls):
        cls.generator.shut_down()

    def here(self):
        return list(self.recorder.last('joint_states').position)

    def go(self, message=None):
        """Executes; the instants at which the motion starts and ends."""
        before = len(self.recorder.all('joint_trajectory'))
        self.answer = self.generator.executed(message)
        while len(self.recorder.all('joint_trajectory')) == before:
            rospy.sleep(0.005)
        announced = self.recorder.last('joint_trajectory')
        return announced.header.stamp, announced.header.stamp + announced.points[-1].time_from_start

    def go_home(self):
        self.generator.planned('polynomial_345', [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        self.recorder.wait_past(self.go()[1])
        self.recorder.wait_past(self.recorder.last('joint_states').header.stamp)

    def check_smooth(self, first, last):
        seconds, q, v = self.recorder.states(first, last)
        dt = np.diff(seconds)[:, None]
        self.assertTrue((dt > 0.0).all())
        self.assertTrue((np.abs(np.diff(q, axis=0)) <= VELOCITY * dt * 1.001 + 1e-9).all())
        self.assertTrue((np.abs(np.diff(v, axis=0)) <= ACCELERATION * dt * 1.001 + 1e-9).all())

    def test_every_sample_of_a_motion(self):
        self.go_home()
        plan = self.generator.planned('polynomial_345', [0.0, 0.0, 0.0], [1.0, -0.7, 0.4], duration=2.0)
        first, last = self.go()
        self.assertEqual(last - first, rospy.Duration(2.0))
        self.recorder.wait_past(last + rospy.Duration(0.1))
        period = int(1e9 / self.RATE)
        for topic in STREAMS:
            stamps = [m.header.stamp for m in self.recorder.between(topic, first, last)]
            self.assertEqual([(s - first).to_nsec() for s in stamps], [period * i for i in range(201)], topic)
        _, q, v = self.recorder.states(first, last)
        np.testing.assert_allclose(q, [p.positions for p in plan.trajectory.points], atol=1e-9)
        np.testing.assert_allclose(v, [p.velocities for p in plan.trajectory.points], atol=1e-9)
        self.check_tool(first, last)
        scaling = self.recorder.between('time_scaling', first, last)
        np.testing.assert_allclose([m.tau[0] for m in scaling], plan.time_scaling.tau, atol=1e-9)
        np.testing.assert_allclose([m.s[0] for m in scaling], plan.time_scaling.s, atol=1e-9)
        np.testing.assert_allclose([m.dds[0] for m in scaling], plan.time_scaling.dds, atol=1e-6)
        held = self.recorder.last('joint_states')
        self.assertEqual(list(held.velocity), [0.0] * 3)
        self.assertEqual(list(held.name), NAMES)
        np.testing.assert_allclose(held.position, [1.0, -0.7, 0.4], atol=1e-12)
        self.assertEqual(self.recorder.last('metrics'), plan.metrics)

    def check_tool(self, first, last):
        _, q, _ = self.recorder.states(first, last)
        poses = self.recorder.between('tool_pose', first, last)
        twists = self.recorder.between('tool_twist', first, last)
        for position, message in zip(q, poses):
            self.assertEqual(message.header.frame_id, 'base_link')
            np.testing.assert_allclose(pose_matrix(message.pose), self.robot.forward(position), atol=1e-9)
        origin = np.array([[m.pose.position.x, m.pose.position.y] for m in poses])
        linear = np.array([[m.twist.linear.x, m.twist.linear.y] for m in twists])
        np.testing.assert_allclose((origin[2:] - origin[:-2]) * 0.5 * self.RATE, linear[1:-1], atol=5e-3)
        self.assertEqual(twists[0].header.frame_id, 'base_link')

    def test_an_end_between_two_periods(self):
        self.go_home()
        self.generator.planned('cycloidal', [0.0, 0.0, 0.0], [0.5, 0.2, 0.1], duration=1.2345)
        first, last = self.go()
        self.recorder.wait_past(last + rospy.Duration(0.1))
        seconds, q, v = self.recorder.states(first, last)
        self.assertEqual(len(seconds), 125)
        self.assertEqual((last - first).to_nsec(), 1234500000)
        self.assertEqual(seconds[0], 0.0)
        self.assertAlmostEqual(seconds[-1], 1.2345, delta=1e-9)
        np.testing.assert_allclose(q[-1], [0.5, 0.2, 0.1], atol=1e-12)

    def test_what_is_latched_reaches_a_late_listener(self):
        self.go_home()
        plan = self.generator.planned('cubic', [0.0, 0.0, 0.0], [0.3, 0.2, 0.1])
        first, _ = self.go()
        late = Recorder('stream')
        late.wait_until_streaming()
        while late.last('joint_trajectory') is None or late.last('metrics') is None:
            rospy.sleep(0.01)
        self.assertEqual(late.last('joint_trajectory').header.stamp, first)
        self.assertEqual(len(late.last('joint_trajectory').points), len(plan.trajectory.points))
        self.assertTrue(math.isinf(late.last('metrics').peak_jerk[0]))

    def test_stop(self):
        self.go_home()
        self.generator.planned('polynomial_345', [0.0, 0.0, 0.0], [2.0, -1.0, 1.0], duration=2.0)
        first, _ = self.go()
        rospy.sleep(0.9)
        answer = self.generator.stop()
        self.assertTrue(answer.success, answer.message)
        now = rospy.Time.now()
        self.recorder.wait_past(now + rospy.Duration(0.8))
        stopped = self.recorder.last('joint_states')
        self.assertEqual(list(stopped.velocity), [0.0] * 3)
        self.assertLess(stopped.position[0], 1.9)
        self.assertGreater(stopped.position[0], 0.1)
        self.check_smooth(first, stopped.header.stamp)
        self.assertIn('at rest', self.generator.stop().message)

    def test_replaced_in_flight(self):
        self.go_home()
        self.generator.planned('polynomial_345', [0.0, 0.0, 0.0], [2.0, -1.0, 1.0], duration=2.0)
        first, _ = self.go()
        for goal in ([-0.5, 0.5, 0.2], [0.4, -0.2, -0.3]):
            rospy.sleep(0.5)
            self.generator.planned('polynomial_345', [0.5, 0.0, 0.0], goal, duration=1.0)
            begin, last = self.go()
            self.assertIn('begins with', self.answer.message)
            announced = self.recorder.last('joint_trajectory')
        self.recorder.wait_past(last + rospy.Duration(0.1))
        self.check_smooth(first, last)
        np.testing.assert_allclose(self.here(), goal, atol=1e-12)
        times = [p.time_from_start.to_sec() for p in announced.points]
        self.assertTrue((np.diff(times) > 0.0).all())
        seconds, q, _ = self.recorder.states(begin, last)
        wanted = np.array([np.interp(seconds, times, [p.positions[j] for p in announced.points]) for j in range(3)]).T
        np.testing.assert_allclose(q, wanted, atol=1e-3)

    def test_given_trajectory_names_in_any_order(self):
        self.go_home()
        times, q = [0.0, 0.5, 1.0], [[0.0, 0.0, 0.0], [0.1, 0.2, 0.3], [0.2, 0.4, 0.6]]
        rates = [[0.0] * 3, [0.2, 0.4, 0.6], [0.0] * 3]
        order = [1, 2, 0]
        message = trajectory(times, [[x[i] for i in order] for x in q], [[x[i] for i in order] for x in rates],
                             names=[NAMES[i] for i in order])
        first, last = self.go(message)
        self.recorder.wait_past(last + rospy.Duration(0.05))
        seconds, streamed, _ = self.recorder.states(first, last)
        self.assertEqual(len(seconds), 101)
        np.testing.assert_allclose(streamed[[0, 50, 100]], q, atol=1e-9)

    def test_given_trajectory_from_the_present_state(self):
        self.go_home()
        first, last = self.go(trajectory([1.0], [[0.3, 0.2, 0.1]], [[0.0] * 3], [[0.0] * 3]))
        self.assertEqual((last - first).to_sec(), 1.0)
        self.recorder.wait_past(last + rospy.Duration(0.05))
        self.check_smooth(first, last)
        np.testing.assert_allclose(self.here(), [0.3, 0.2, 0.1], atol=1e-12)

    def refused(self, code, words, message):
        before = self.here()
        answer = self.generator.execute(message)
        self.assertFalse(answer.success, words)
        self.assertEqual(answer.error_code, code, answer.message)
        for word in words:
            self.assertIn(word, answer.message)
        self.assertEqual(self.here(), before)

    def test_refuses(self):
        self.go_home()
        state, goal, infeasible = ErrorCode.INVALID_ROBOT_STATE, ErrorCode.INVALID_GOAL, ErrorCode.LIMITS_INFEASIBLE
        zero, there = [0.0] * 3, [0.1] * 3
        self.refused(state, ['points[1].positions', '2', '3'], trajectory([0, 1], [zero, [0.1, 0.2]]))
        self.refused(state, ['points[1].positions', 'nan'], trajectory([0, 1], [zero, [0.1, math.nan, 0.0]]))
        self.refused(state, ['points[1].velocities'], trajectory([0, 1], [zero, there], [zero, [math.inf, 0, 0]]))
        self.refused(state, ['joint_names', 'elbow'], trajectory([0, 1], [zero, there], names=['theta1', 'elbow', 'theta3']))
        self.refused(state, ['joint_names', 'theta3'], trajectory([0, 1], [zero, there], names=['theta3', 'theta3', 'theta1']))
        self.refused(goal, ['points[1].time_from_start'], trajectory([0, 0], [zero, there]))
        self.refused(goal, ['points[2].time_from_start'], trajectory([0, 1, 0.5], [zero, there, zero]))
        self.refused(goal, ['points[0].time_from_start'], trajectory([-1, 1], [zero, there]))
        self.refused(goal, ['points[1].velocities'], trajectory([0, 1], [zero, there], [zero, []]))
        self.refused(infeasible, ['theta2', '3.5', '3.2'], trajectory([0, 9], [zero, [0.0, 3.5, 0.0]]))
        self.refused(infeasible, ['theta1', 'velocity', '5'], trajectory([0, 0.1], [zero, [1.0, 0.0, 0.0]]))


class FastStream(unittest.TestCase):
    def test_thousand_a_second(self):
        generator = Generator.of('planar_3r', 'fast', rate=1000)
        self.addCleanup(generator.shut_down)
        recorder = Recorder('fast')
        recorder.wait_until_streaming()
        generator.planned('polynomial_345', [0.0, 0.0, 0.0], [1.0, -0.7, 0.4], duration=2.0)
        generator.executed()
        recorder.wait_past(rospy.Time.now() + rospy.Duration(2.1))
        first = recorder.last('joint_trajectory').header.stamp
        for topic in STREAMS:
            stamps = [(m.header.stamp - first).to_nsec() for m in recorder.between(topic, first, first + rospy.Duration(2.0))]
            self.assertEqual(stamps, [1000000 * i for i in range(2001)], topic)


if __name__ == '__main__':
    rospy.init_node('trajectory_generator_stream')
    rostest.rosrun('screwline', 'trajectory_generator_stream', 'trajectory_generator_stream')
