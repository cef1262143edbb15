#!/usr/bin/python3
"""trajectory_generator in flight: pause, resume, speed_override, tracking; a minute of stream at 1 kHz without a lost sample."""
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from screwline.msg import TrajectoryMetrics
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from trajectory_generator_support import Generator, Recorder, wait_for

VELOCITY, ACCELERATION = 5.0, 25.0  # limits of each joint of planar_3r
START, GOAL = [0.0, 0.0, 0.0], [1.0, -0.7, 0.4]


class Flight(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.generator = Generator.of('planar_3r', 'flight', rate=100, tracked_joint_states='measured')
        cls.recorder = Recorder('flight')
        cls.recorder.wait_until_streaming()
        cls.speed = rospy.Publisher('/flight/speed_override', Float64, queue_size=1)
        cls.measured = rospy.Publisher('/flight/measured', JointState, queue_size=100)
        wait_for(lambda: cls.speed.get_num_connections() and cls.measured.get_num_connections())

    @classmethod
    def tearDownClass(cls):
        cls.generator.shut_down()

    def setUp(self):
        self.generator.resume()
        self.speed.publish(1.0)
        self.generator.planned('polynomial_345', START, START)
        self.generator.executed()
        wait_for(lambda: np.allclose(self.position(), START, atol=1e-12) and self.still())

    def position(self):
        return np.array(self.recorder.last('joint_states').position)

    def still(self):
        return not any(self.recorder.last('joint_states').velocity)

    def go(self, duration=2.0):
        self.generator.planned('polynomial_345', START, GOAL, duration=duration)
        answer = self.generator.executed()
        self.first = rospy.Time.now()
        return answer

    def check_on_the_path(self):
        """Without a jump, and wherever the robot was, on the line from start to goal."""
        last = self.recorder.last('joint_states').header.stamp
        seconds, q, v = self.recorder.states(self.first, last)
        dt = np.diff(seconds)[:, None]
        self.assertTrue((np.abs(np.diff(q, axis=0)) <= VELOCITY * dt * 1.001 + 1e-9).all())
        self.assertTrue((np.abs(np.diff(v, axis=0)) <= ACCELERATION * dt * 1.001 + 1e-9).all())
        np.testing.assert_allclose(q, np.outer(q[:, 0], GOAL), atol=1e-9)
        self.assertTrue((np.diff(q[:, 0]) >= -1e-12).all())

    def test_pause_and_resume(self):
        self.go()
        rospy.sleep(0.8)
        answer = self.generator.pause()
        self.assertTrue(answer.success)
        self.assertIn('at rest on its path in', answer.message)
        wait_for(self.still)
        here = self.position()
        self.assertTrue(0.0 < here[0] < 1.0)
        rospy.sleep(0.5)
        np.testing.assert_array_equal(self.position(), here)
        self.assertIn('paused already', self.generator.pause().message)
        self.assertIn('at its speed in', self.generator.resume().message)
        wait_for(lambda: np.allclose(self.position(), GOAL, atol=1e-12))
        self.check_on_the_path()

    def test_a_pause_keeps_what_is_executed(self):
        self.assertIn('nothing moves', self.generator.pause().message)
        self.assertIn('~resume', self.go(1.0).message)
        rospy.sleep(0.5)
        np.testing.assert_array_equal(self.position(), START)
        self.assertTrue(self.generator.resume().success)
        wait_for(lambda: np.allclose(self.position(), GOAL, atol=1e-12))
        self.assertIn('nothing is paused', self.generator.resume().message)

    def test_stop_ends_a_pause(self):
        self.go()
        rospy.sleep(0.5)
        self.generator.pause()
        self.assertTrue(self.generator.stop().success)
        wait_for(self.still)
        self.assertIn('nothing is paused', self.generator.resume().message)
        self.assertLess(self.position()[0], 1.0)

    def test_speed_override(self):
        self.go(1.0)
        for speed in (0.5, 0.0, 0.2, 1.0, float('nan'), 1.5, -0.1, 0.4):  # What is not a speed is refused and changes nothing.
            self.speed.publish(speed)
            rospy.sleep(0.15)
        began = time.monotonic()
        wait_for(lambda: np.allclose(self.position(), GOAL, atol=1e-12))
        self.assertGreater(time.monotonic() - began, 0.2)
        self.check_on_the_path()

    def test_replaced_while_slow(self):
        self.speed.publish(0.3)
        rospy.sleep(0.2)
        self.assertIn('0.3 of its speed', self.go(1.0).message)
        rospy.sleep(1.0)
        self.generator.planned('polynomial_345', [0.3, 0.1, 0.0], [0.5, 0.5, 0.5], duration=0.5)
        answer = self.generator.executed()
        self.assertIn('begins with', answer.message)
        self.speed.publish(1.0)
        wait_for(lambda: np.allclose(self.position(), [0.5, 0.5, 0.5], atol=1e-12))
        _, _, v = self.recorder.states(self.first, self.recorder.last('joint_states').header.stamp)
        self.assertTrue((np.abs(np.diff(v, axis=0)) <= ACCELERATION * 0.01 * 1.001 + 1e-9).all())

    def test_tracking_error(self):
        def echo(state):
            position = [x + 0.01 for x in state.position]
            self.measured.publish(JointState(header=state.header, name=state.name, position=position))
        echoing = rospy.Subscriber('/flight/joint_states', JointState, echo, tcp_nodelay=True)
        self.addCleanup(echoing.unregister)
        wait_for(lambda: echoing.get_num_connections())
        self.go(1.0)
        wait_for(lambda: len(self.recorder.last('metrics').tracking_error_max) == 3)
        metrics = self.recorder.last('metrics')
        np.testing.assert_allclose(metrics.tracking_error_max, [0.01] * 3, atol=1e-6)
        np.testing.assert_allclose(metrics.tracking_error_rms, [0.01] * 3, atol=1e-6)


class Minute(unittest.TestCase):
    SECONDS = 60

    def test_a_minute_at_a_thousand_hertz(self):
        generator = Generator.of('planar_3r', 'minute', rate=1000)
        self.addCleanup(generator.shut_down)
        stamps, reports, announced = [], [], []
        lock = threading.Lock()
        arrivals = []

        def take(state):
            with lock:
                stamps.append(state.header.stamp.to_nsec())
                arrivals.append(time.monotonic())
        rospy.Subscriber('/minute/joint_states', JointState, take, queue_size=100, tcp_nodelay=True, buff_size=1 << 20)
        rospy.Subscriber('/minute/diagnostics', DiagnosticArray, reports.append)
        rospy.Subscriber('/minute/metrics', TrajectoryMetrics, announced.append)
        wait_for(lambda: len(stamps) > 100)
        generator.planned('polynomial_345', START, GOAL, duration=float(self.SECONDS))
        generator.executed()
        begin = len(stamps)
        wait_for(lambda: any(s.name.endswith('motion') and s.values[0].value == str(1000 * self.SECONDS + 1)
                             for r in reports for s in r.status), self.SECONDS + 20.0)
        with lock:
            got = np.array(stamps[begin:begin + 1000 * self.SECONDS])
            came = np.array(arrivals[begin:begin + 1000 * self.SECONDS])
        np.testing.assert_array_equal(np.diff(got), 1000000)  # None lost, in order.
        # The period that all arrivals together have: the first and the last alone would measure when this process was given time.
        mean = 1e6 * np.polyfit(np.arange(len(came)), came - came[0], 1)[0]
        motion = [s for r in reports for s in r.status if s.name.endswith('motion')][-1]
        print('mean period of arrival %.4f us; %s' % (mean, {v.key: v.value for v in motion.values}))
        self.assertAlmostEqual(mean, 1000.0, delta=0.1)
        self.assertGreater(len(reports), self.SECONDS - 5)


if __name__ == '__main__':
    rospy.init_node('trajectory_generator_flight')
    rostest.rosrun('screwline', 'trajectory_generator_flight', 'trajectory_generator_flight')
