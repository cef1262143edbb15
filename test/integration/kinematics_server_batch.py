#!/usr/bin/python3
"""compute_fk_batch and compute_ik_batch against single calls, at full size, with every bad input and beside other questions."""

import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from kinematics_server_support import Server, matrix, state
from screwline.msg import ErrorCode

NAN, INFINITY = float('nan'), float('inf')
ROBOTS = ['rrr_articulated', 'rrprrr', 'scara', 'planar_3r', 'spherical_wrist']
STATE, GOAL, LARGE = ErrorCode.INVALID_ROBOT_STATE, ErrorCode.INVALID_GOAL, ErrorCode.TOO_LARGE
IDENTITY = [0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0]


def configurations(server, count, seed=1):
    """Rows within the limits, and within 3 where there are none or wide ones."""
    chain = server.ask('describe')
    lower, upper = np.maximum(chain.lower, -3.0), np.minimum(chain.upper, 3.0)
    return np.random.RandomState(seed).uniform(lower, upper, (count, len(chain.joint_names)))


def numbers_of(pose):
    p, q = pose.position, pose.orientation
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w]


def pose_of(row):
    return PoseStamped(pose=Pose(Point(*row[:3]), Quaternion(*row[3:])))


class Batches(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.servers = {robot: Server.of(robot) for robot in ROBOTS}

    @classmethod
    def tearDownClass(cls):
        for server in cls.servers.values():
            server.shut_down()

    def poses(self, server, q):
        return matrix(server.ask('compute_fk_batch', positions=q.ravel().tolist()).poses, 7)

    def test_forward_equals_single_calls(self):
        for robot, server in self.servers.items():
            for count in (1, 2, 7, 150):
                q = configurations(server, count)
                poses = self.poses(server, q)
                self.assertEqual(len(poses), count)
                for row, values in zip(poses, q):
                    single = np.array(numbers_of(server.ask('compute_fk', joint_state=state(values)).poses[0].pose))
                    self.assertLess(np.abs(row[:3] - single[:3]).max(), 1e-12, robot)
                    # At half a turn the two signs are one rotation.
                    off = min(np.abs(row[3:] - single[3:]).max(), np.abs(row[3:] + single[3:]).max())
                    self.assertLess(off, 1e-12, robot)
                    self.assertGreaterEqual(row[6], 0.0)

    def test_forward_of_many(self):
        server = self.servers['rrprrr']
        q = configurations(server, 200000)
        start = time.monotonic()
        poses = self.poses(server, q)
        self.assertLess(time.monotonic() - start, 30.0)
        for first in (0, 99999, 199990):
            self.assertTrue((self.poses(server, q[first:first + 10]) == poses[first:first + 10]).all())
        self.assertLess(np.abs(np.linalg.norm(poses[:, 3:], axis=1) - 1.0).max(), 1e-14)

    def check_rows(self, server, targets, answer, rows, **fields):
        """The solutions of some rows are those of compute_ik, number by number."""
        ends = np.cumsum(answer.counts)
        positions = matrix(answer.positions, len(answer.joint_names))
        self.assertEqual(len(answer.counts), len(targets))
        self.assertEqual(len(answer.complete), len(targets))
        self.assertEqual(len(positions), ends[-1])
        for row in rows:
            single = server.compute_ik(pose=pose_of(targets[row]), **fields)
            self.assertEqual(answer.counts[row], len(single.solutions), single.message)
            self.assertEqual(answer.complete[row], single.complete)
            self.assertEqual(answer.joint_names, single.joint_names)
            own = positions[ends[row] - answer.counts[row]:ends[row]]
            self.assertEqual(own.tolist(), [list(solution.position) for solution in single.solutions])

    def test_inverse_equals_single_calls(self):
        for robot, server in self.servers.items():
            with self.subTest(robot):
                targets = self.poses(server, configurations(server, 60))
                targets[::7, :3] += 20.0  # Out of reach, where a position is asked for.
                flat = targets.ravel().tolist()
                for fields in ({}, {'max_solutions': 1}, {'ignore_limits': True}):
                    answer = server.ask('compute_ik_batch', poses=flat, **fields)
                    self.check_rows(server, targets, answer, range(60), **fields)
                    none = sum(1 for count in answer.counts if count == 0)
                    self.assertIn('%d of 60 poses without a solution' % none, answer.message)

    def test_inverse_of_many(self):
        server = self.servers['rrprrr']
        q = configurations(server, 20000)
        targets = self.poses(server, q)
        start = time.monotonic()
        answer = server.ask('compute_ik_batch', poses=targets.ravel().tolist())
        self.assertLess(time.monotonic() - start, 60.0)
        self.check_rows(server, targets, answer, range(0, 20000, 400))
        self.assertEqual(answer.message, '0 of 20000 poses without a solution')
        self.assertTrue(all(answer.complete))
        # Each solution brings the tip where it has to be.
        found = self.poses(server, matrix(answer.positions, len(answer.joint_names)))
        wanted = np.repeat(targets, answer.counts, axis=0)
        self.assertLess(np.abs(found[:, :3] - wanted[:, :3]).max(), 1e-8)
        self.assertGreater(np.abs((found[:, 3:] * wanted[:, 3:]).sum(axis=1)).min(), 1.0 - 1e-12)

    def test_many_out_of_reach_are_told_soon(self):
        server = self.servers['rrprrr']
        targets = self.poses(server, configurations(server, 20000))
        targets[:, 0] += 100.0
        start = time.monotonic()
        answer = server.ask('compute_ik_batch', poses=targets.ravel().tolist())
        self.assertLess(time.monotonic() - start, 30.0)
        self.assertEqual(set(answer.counts), {0})
        self.assertEqual(answer.message, '20000 of 20000 poses without a solution')

    def test_what_the_task_does_not_read_may_be_anything(self):
        server = self.servers['rrr_articulated']
        targets = self.poses(server, configurations(server, 5))
        expected = server.ask('compute_ik_batch', poses=targets.ravel().tolist())
        targets[:, 3:] = NAN
        self.assertEqual(server.ask('compute_ik_batch', poses=targets.ravel().tolist()), expected)

    def test_threads_give_the_same_answer(self):
        one, two = [Server.of('rrprrr', 'with_%d' % threads, threads=threads) for threads in (1, 5)]
        try:
            q = configurations(one, 20001)
            self.assertTrue((self.poses(one, q) == self.poses(two, q)).all())
            poses = self.poses(one, q[:3001]).ravel().tolist()
            answers = [server.ask('compute_ik_batch', poses=poses) for server in (one, two)]
            self.assertEqual(*answers)
        finally:
            one.shut_down()
            two.shut_down()


class Together(unittest.TestCase):
    def setUp(self):
        self.server = Server.of('rrprrr', 'together', threads=1)

    def tearDown(self):
        self.server.shut_down()

    def test_other_questions_get_through(self):
        """With one thread for requests, a batch of some seconds keeps nobody waiting."""
        q = configurations(self.server, 60000)
        poses = list(self.server.ask('compute_fk_batch', positions=q.ravel().tolist()).poses)
        answers = []
        thread = threading.Thread(target=lambda: answers.append(self.server.compute_ik_batch(poses=poses)))
        thread.start()
        meanwhile = 0
        while thread.is_alive():
            self.server.ask('compute_fk', joint_state=state(q[0]))
            meanwhile += not answers
        thread.join()
        self.assertTrue(answers[0].success)
        self.assertGreater(meanwhile, 20)


class BadRequests(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server.of('rrprrr', 'refusing', max_batch=1000)
        cls.planar = Server.of('planar_3r', 'refusing_planar')

    @classmethod
    def tearDownClass(cls):
        cls.server.shut_down()
        cls.planar.shut_down()

    def refused(self, service, code, *words, server=None, **fields):
        answer = getattr(server or self.server, service)(**fields)
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_code, code, answer.message)
        for word in words:
            self.assertIn(word, answer.message)
        self.assertFalse(getattr(answer, 'poses', None) or getattr(answer, 'counts', None))

    def test_positions(self):
        def refused(code, *words, positions):
            self.refused('compute_fk_batch', code, *words, positions=positions)

        refused(STATE, 'positions has 0 numbers', '6', positions=[])
        refused(STATE, 'positions has 1 number,', 'multiple of 6', positions=[0.0])
        refused(STATE, 'positions has 13 numbers', 'multiple of 6', positions=[0.0] * 13)
        refused(LARGE, '1001 rows', '~max_batch is 1000', positions=[0.0] * 6006)
        self.server.ask('compute_fk_batch', positions=[0.0] * 6000)
        for value in (NAN, INFINITY, -INFINITY, 1.1e6, -1e300):
            bad = [0.0] * 60
            bad[44] = value
            refused(STATE, 'positions[44] (row 7) is ', '1000000', positions=bad)

    def test_poses(self):
        def refused(code, *words, poses, server=None):
            self.refused('compute_ik_batch', code, *words, poses=poses, server=server)

        refused(GOAL, 'poses has 0 numbers', '7', poses=[])
        refused(GOAL, 'poses has 20 numbers', 'multiple of 7', poses=[0.0] * 20)
        refused(LARGE, '1001 rows', '~max_batch is 1000', poses=IDENTITY * 1001)
        for column in range(7):
            for value in (NAN, INFINITY, -1.1e6):
                bad = IDENTITY * 4
                bad[14 + column] = value
                refused(GOAL, 'poses[%d] (row 2) is ' % (14 + column), poses=bad)
        for w, norm in ((0.0, 'norm 0,'), (1.002, 'norm 1.002'), (-0.998, 'norm 0.998')):
            refused(GOAL, 'row 3 of poses', norm, poses=IDENTITY * 3 + [0.0] * 6 + [w])
        self.server.ask('compute_ik_batch', poses=IDENTITY[:6] + [1.0009])
        tilted = [0.0, 0.0, 0.0, np.sin(0.05), 0.0, 0.0, np.cos(0.05)]
        refused(GOAL, 'row 1', 'axis by 0.1', poses=[0.0] * 6 + [1.0] + tilted, server=self.planar)
        self.refused('compute_ik_batch', GOAL, 'max_solutions', poses=IDENTITY, max_solutions=2**32 - 1)

    def test_time_runs_out(self):
        server = Server.of('rrprrr', 'hurried', batch_timeout=1e-6)
        try:
            answer = server.compute_ik_batch(poses=IDENTITY * 1000)
            self.assertEqual((answer.success, answer.error_code), (False, ErrorCode.TIMED_OUT))
            self.assertIn('of 1000 poses were not looked at within ~batch_timeout', answer.message)
            self.assertEqual((len(answer.counts), len(answer.complete)), (1000, 1000))
        finally:
            server.shut_down()


if __name__ == '__main__':
    rospy.init_node('kinematics_server_batch')
    rostest.rosrun('screwline', 'kinematics_server_batch', 'kinematics_server_batch')
