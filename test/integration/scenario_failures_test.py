#!/usr/bin/python3
"""A scenario that fails, can not be run or is interrupted says so by its exit code, and leaves nothing running."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import rosgraph
import rostest

SECONDS = 90
GOOD = '{call: {service: compute_fk, q: [0, 0], expect: {poses.pose.position: [1.2, 0, 0]}}}'
WRONG = '{call: {service: compute_fk, q: [0, 0], expect: {poses.pose.position: [1.3, 0, 0]}}}'
REFUSED = '{call: {service: compute_fk, q: [0, 0, 0]}}'
NO_FIELD = '{call: {service: compute_fk, request: {link: [tool0]}}}'


class ScenarioFailures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        nodes = rosgraph.Master('/test').getSystemState()
        running = {node for kind in nodes for _, names in kind for node in names} & {'/kinematics_server', '/frame_broadcaster'}
        self.assertEqual(running, set())
        self.folder.cleanup()

    def command(self, steps, robot='rr_planar'):
        path = os.path.join(self.folder.name, 'case.yaml')
        with open(path, 'w') as stream:
            stream.write('{robot: %s, motion: false, steps: [%s]}' % (robot, ', '.join(steps)))
        return ['rosrun', 'screwline', 'scenario', path]

    def outcome(self, command):
        run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=SECONDS, check=False)
        print(run.stdout)
        return run.returncode, run.stdout

    def test_all_good(self):
        self.assertEqual(self.outcome(self.command([GOOD]))[0], 0)

    def test_steps_that_fail_are_named_and_the_others_taken(self):
        code, output = self.outcome(self.command([WRONG, REFUSED, NO_FIELD, GOOD]))
        self.assertEqual(code, 1)
        self.assertIn('FAILED: 3 of 4 steps', output)
        self.assertIn('expected 1.3', output)
        self.assertIn("chain 'rr_planar' has 2 joints", output)
        self.assertIn('no field link', output)

    def test_unknown_scenario(self):
        code, output = self.outcome(['rosrun', 'screwline', 'scenario', 'no_such_scenario'])
        self.assertEqual(code, 2)
        self.assertIn('craig_eight', output)

    def test_unknown_robot(self):
        code, output = self.outcome(self.command([GOOD], robot='no_such_robot'))
        self.assertEqual(code, 2)
        self.assertIn('no_such_robot', output)

    def test_a_folder_that_can_not_be_written(self):
        code, output = self.outcome(self.command([GOOD]) + ['--record', '--bag-dir', '/proc/no_such_folder'])
        self.assertEqual(code, 2)
        self.assertIn('no bag can be written', output)
        self.assertIn('/proc/no_such_folder', output)

    def test_interrupted(self):
        with subprocess.Popen(self.command(['{say: it waits}', '{wait: 60}']), stdout=subprocess.PIPE, text=True) as child:
            for line in child.stdout:
                if 'it waits' in line:
                    break
            child.send_signal(signal.SIGINT)
            output = child.communicate(timeout=SECONDS)[0]
        self.assertEqual(child.returncode, 2)
        self.assertIn('interrupted', output)


if __name__ == '__main__':
    rostest.rosrun('screwline', 'scenario_failures', ScenarioFailures)
