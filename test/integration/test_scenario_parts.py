#!/usr/bin/python3
"""The parts of the scenario runner that need no master: numbers, messages, expectations, the files themselves."""
import math
import os
import sys
import tempfile
import unittest

import numpy as np

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, 'scripts'))
from screwline_scenario import description, expectations, expressions, messages, report, streams  # noqa: E402


class Expressions(unittest.TestCase):
    def test_arithmetic(self):
        self.assertAlmostEqual(expressions.evaluate('20*sqrt(3)'), 20 * math.sqrt(3))
        self.assertAlmostEqual(expressions.evaluate('-deg(90) + L**2/2', {'L': 2}), 2 - math.pi / 2)
        self.assertEqual(expressions.numbers([[1, '2*3'], 'x'], {'x': 4}), [1, 6, 4])

    def test_nothing_but_arithmetic(self):
        for text in ('__import__("os")', 'x', '1 +', '"a"', '(1).real', '1/0', '[1]', 'sqrt(-1)', 'lambda: 1', ''):
            with self.assertRaises(expressions.ExpressionError, msg=text):
                expressions.evaluate(text)
        for tree in ({}, None, True):
            with self.assertRaises(expressions.ExpressionError):
                expressions.numbers(tree)


class Expectations(unittest.TestCase):
    def problem(self, actual, expected, tolerance=1e-9):
        return expectations.compare(actual, expected, tolerance, {'a': 1.5})[0]

    def test_numbers(self):
        self.assertEqual(self.problem([1.5, 2.0], ['a', 2]), '')
        self.assertEqual(self.problem([1.5, [2.0]], [['a'], 2]), '')
        self.assertIn('expected 2', self.problem([1.5, 2.1], ['a', 2]))
        self.assertIn('has 1 numbers', self.problem([1.5], [1, 2]))
        self.assertTrue(self.problem([float('nan')], [1]))
        self.assertEqual(self.problem(math.inf, 'inf'), '')

    def test_texts_and_booleans(self):
        self.assertEqual(self.problem(True, True), '')
        self.assertTrue(self.problem(True, False))
        self.assertTrue(self.problem('elbow up', 'elbow down'))
        self.assertEqual(self.problem(['x', 'y'], ['x', 'y']), '')
        self.assertEqual(self.problem('elbow up', {'contains': 'up'}), '')
        self.assertTrue(self.problem('elbow up', {'contains': 'down'}))

    def test_sets_of_angles(self):
        rows = [(0.1, 3.0), (1.0, 2.0)]
        self.assertEqual(self.problem(rows, {'rows': [[1, 2], ['0.1+2*pi', 3]]}), '')
        self.assertTrue(self.problem(rows, {'rows': [[1, 2]]}))
        self.assertTrue(self.problem(rows, {'rows': [[1, 2], [0.1, 3.01]]}))
        self.assertEqual(self.problem(rows, {'includes': [1, 2]}), '')
        self.assertTrue(self.problem(rows, {'includes': [2, 1]}))

    def test_directions_and_bounds(self):
        self.assertEqual(self.problem([0.0, -2.0], {'along': [0, 1]}), '')
        self.assertTrue(self.problem([0.1, -2.0], {'along': [0, 1]}))
        self.assertEqual(self.problem([0.5, 1.0], {'min': 0.5, 'max': 1}), '')
        self.assertTrue(self.problem([0.5, 1.1], {'max': 1}))
        self.assertTrue(self.problem([], {'count': 1}))
        self.assertTrue(self.problem(1.0, {'nearly': 1}))


class Messages(unittest.TestCase):
    def test_fill_lookup_flatten(self):
        from screwline.srv import ComputeIKRequest, PlanTrajectoryRequest
        data = {'pose': {'header': {'frame_id': 'tool0'}, 'pose': {'xyz': [1, 'x', 3], 'rpy': [0, 0, 'pi/2']}}, 'max_solutions': 2}
        request = messages.fill(ComputeIKRequest(), data, {'x': 2})
        self.assertEqual(messages.flattened(request.pose.pose.position), [1, 2, 3])
        self.assertAlmostEqual(request.pose.pose.orientation.z, math.sqrt(0.5))
        self.assertIs(type(request.max_solutions), int)
        plan = messages.fill(PlanTrajectoryRequest(), {'waypoints': [{'position': [1, 2]}, {'position': [3, 'x']}]}, {'x': 2})
        self.assertEqual(messages.lookup(plan, 'waypoints.position'), [[1, 2], [3, 2]])

    def test_unknown_fields(self):
        from screwline.srv import ComputeFKRequest
        for data in ({'link': ['tool0']}, {'joint_state': {'position': 'x'}}, {'links': 3}):
            with self.assertRaises(messages.FieldError):
                messages.fill(ComputeFKRequest(), data, {})
        with self.assertRaises(messages.FieldError):
            messages.lookup(ComputeFKRequest(), 'joint_state.angle')


class Interpolation(unittest.TestCase):
    def test_between_uneven_samples(self):
        seconds = np.linspace(0, 1, 101) + 1e-3 * np.sin(np.arange(101))
        rows = np.column_stack([np.sin(3 * seconds), np.cos(2 * seconds)])
        for t in np.linspace(0, 1, 37):
            off = np.abs(streams.interpolated(seconds, rows, t) - [np.sin(3 * t), np.cos(2 * t)]).max()
            self.assertLess(off, 1e-9)
        self.assertEqual(list(streams.interpolated(seconds, rows, seconds[5])), list(rows[5]))


class Reports(unittest.TestCase):
    def test_exit_code(self):
        quiet = report.Report()
        quiet.say = lambda text='': None
        quiet.begin('good')
        quiet.check('x', '', 0.0)
        self.assertEqual(quiet.summary(), 0)
        quiet.begin('bad')
        quiet.check('x', 'is 2', 1.0)
        self.assertEqual(quiet.summary(), 1)


class Descriptions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        path = os.environ.get('ROS_PACKAGE_PATH', '')
        os.environ['ROS_PACKAGE_PATH'] = os.pathsep.join([ROOT] + [path] * bool(path))

    def load(self, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'x.yaml')
            with open(path, 'w') as stream:
                stream.write(text)
            return description.load_scenario(path)

    def test_every_scenario_loads(self):
        names = description.scenario_names()
        self.assertLessEqual({'prrr_retraction', 'rrp_tool_velocity', 'planar_3r_via', 'planar_3r_multipoint', 'rrprrr_twist',
                              'orienting_statics', 'craig_eight', 'demo'}, set(names))
        for name in names:
            scenario = description.load_scenario(name)
            self.assertTrue(scenario.description, name)
            bags = [scenario.bag_name(part) for part in scenario.parts]
            self.assertEqual(len(bags), len(set(bags)))
            for part in scenario.parts:
                self.assertTrue(os.path.exists(os.path.join(ROOT, 'urdf', part.robot + '.urdf')), part.robot)

    def test_rate_replaces_the_scenarios(self):
        self.assertEqual(description.load_scenario('rrprrr_twist', 250.0).parts[0].rate, 250.0)

    def test_refusals(self):
        for text, what in (
                ('robot: x', 'has no steps'), ('steps: [{wait: 1}]', 'has no robot'), ('[]', 'no mapping'), ('{', 'x.yaml'),
                ('{robot: x, steps: [{wait: 1}], speed: 3}', 'unknown keys speed'),
                ('{robot: x, steps: [{weight: 1}]}', 'steps[0]'), ('{robot: x, steps: [{wait: 1, say: a}]}', 'steps[0]'),
                ('{robot: x, values: {a: b}, steps: [{wait: 1}]}', 'values.a'), ('{robot: x, parts: []}', 'beside parts')):
            with self.assertRaises(description.DescriptionError, msg=text) as caught:
                self.load(text)
            self.assertIn(what, str(caught.exception))
        with self.assertRaises(description.DescriptionError):
            description.load_scenario('no_such_scenario')


if __name__ == '__main__':
    unittest.main()
