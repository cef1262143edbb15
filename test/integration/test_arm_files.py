#!/usr/bin/python3
"""The makers' arms of urdf/ and config/robots/: files as complete as the other robots', forward kinematics by other descriptions."""

import functools
import math
import os
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
import yaml
from test_robot_files import GOLDEN_OF, LIMIT_KEYS, ROOT, Robot, config_errors, rpy_rotation, transform, turn

TOLERANCE = 1e-12
POSES = 50
WHOLE_POSE = ['x', 'y', 'z', 'rx', 'ry', 'rz']
TASK_OF = {'scara_600': ['x', 'y', 'z', 'rz']}
WITHOUT_ZERO = {'panda': {'joint4'}, 'stanford_arm': {'d3'}, 'jaco2_6dof': {'joint_2', 'joint_3'}}
NAMES = {'pi': math.pi, 'deg': math.radians(1), 'sqrt': math.sqrt, '__builtins__': {}}


def numbers(values):
    """Lists of numbers and of expressions as 'pi/2'."""
    if isinstance(values, list):
        return [numbers(value) for value in values]
    return float(eval(values, NAMES)) if isinstance(values, str) else float(values)


def along(x, y, z):
    return transform(np.eye(3), [x, y, z])


def rotation_about(axis, angle):
    return transform(turn(axis, angle), np.zeros(3))


def frame(values):
    return transform(rpy_rotation(values[3:]), np.array(values[:3]))


def by_table(table, q):
    pose = np.eye(4)
    for i, row in enumerate(numbers(table['rows'])):
        modified = table['convention'] == 'modified'
        alpha, a, d, theta = row if modified else (row[3], row[2], row[1], row[0])
        value = table.get('signs', [1] * len(q))[i] * q[i]
        if i in table.get('slides', []):
            d += value
        else:
            theta += value
        screw = rotation_about((0, 0, 1), theta) @ along(0, 0, d)
        link = rotation_about((1, 0, 0), alpha) @ along(a, 0, 0)
        pose = pose @ (link @ screw if modified else screw @ link)
    return pose


def by_opw(table, q):
    """Forward kinematics in the words of the paper (its equations of section II), not as a chain of transforms."""
    n = {key: float(value) for key, value in table['lengths'].items()}
    t = [sign * value + offset for sign, value, offset in zip(table['signs'], q, numbers(table['offsets']))]
    psi = math.atan2(n['a2'], n['c3'])
    k = math.hypot(n['a2'], n['c3'])
    cx1 = n['c2'] * math.sin(t[1]) + k * math.sin(t[1] + t[2] + psi) + n['a1']
    cz1 = n['c2'] * math.cos(t[1]) + k * math.cos(t[1] + t[2] + psi)
    centre = [cx1 * math.cos(t[0]) - n['b'] * math.sin(t[0]), cx1 * math.sin(t[0]) + n['b'] * math.cos(t[0]), cz1 + n['c1']]
    arm = turn((0, 0, 1), t[0]) @ turn((0, 1, 0), t[1] + t[2])
    rotation = arm @ turn((0, 0, 1), t[3]) @ turn((0, 1, 0), t[4]) @ turn((0, 0, 1), t[5])
    return transform(rotation, np.array(centre) + n['c4'] * rotation[:, 2])


def by_description(table, q):
    pose = by_opw(table, q) if table['convention'] == 'opw' else by_table(table, q)
    return frame(numbers(table.get('base', [0] * 6))) @ pose @ frame(numbers(table.get('tool', [0] * 6)))


def configurations(robot, seed=20261124):
    random = np.random.RandomState(seed)
    for _ in range(POSES):
        yield [random.uniform(-3, 3) for _ in robot.moving()]


def worst_deviation(robot, table):
    return max(np.abs(robot.forward(q) - by_description(table, q)).max() for q in configurations(robot))


def tables():
    with open(os.path.join(ROOT, 'test', 'data', 'dh_tables.yaml')) as stream:
        return yaml.safe_load(stream)


def for_each_arm(law):
    """A law of one robot and its other description becomes a test of all, each a subtest."""

    @functools.wraps(law)
    def test(self):
        for name, table in tables().items():
            with self.subTest(robot=name):
                law(self, Robot(name), table)

    return test


class ArmFiles(unittest.TestCase):
    def test_every_robot_is_checked_here_or_against_golden_data(self):
        for folder, ending in (('urdf', '.urdf'), ('config/robots', '.yaml')):
            found = {entry[:-len(ending)] for entry in os.listdir(os.path.join(ROOT, folder)) if entry.endswith(ending)}
            self.assertEqual(found, set(GOLDEN_OF) | set(tables()), folder)

    @for_each_arm
    def test_every_robot_has_a_row_in_the_list_of_mechanisms(self, robot, _):
        with open(os.path.join(ROOT, 'doc', 'mechanisms.md')) as stream:
            text = stream.read()
        self.assertIn('| `%s` |' % robot.name, text)

    @for_each_arm
    def test_the_source_is_named(self, robot, _):
        with open(os.path.join(ROOT, 'urdf', robot.name + '.urdf')) as stream:
            comment = stream.read().split('-->')[0]
        self.assertIn(robot.name + ':', comment)
        self.assertRegex(comment, r'Lengths|Denavit-Hartenberg')

    @for_each_arm
    def test_forward_kinematics_by_another_description(self, robot, table):
        self.assertLess(worst_deviation(robot, table), TOLERANCE)

    @for_each_arm
    def test_poses_that_others_printed(self, robot, table):
        for pose in table.get('poses', []):
            found = robot.forward(numbers(pose['q']))
            self.assertLess(np.abs(found[:3, 3] - numbers(pose['position'])).max(), pose['tolerance'])
            self.assertLess(np.abs(found[:3, :3] - numbers(pose['rotation'])).max(), pose['tolerance'])

    def test_sixteen_printed_solutions_reach_the_printed_pose(self):
        table, robot = tables()['six_r_16'], Robot('six_r_16')
        self.assertEqual(len(table['solutions_in_degrees']), 16)
        for solution in table['solutions_in_degrees']:
            found = robot.forward(np.radians(solution))
            for key, values in (('position', found[:3, 3]), ('rotation', found[:3, :3])):
                worst = np.abs(values - numbers(table['pose'][key])).max()
                self.assertLess(worst, table['pose']['tolerance'], '%s: %s' % (solution, key))

    @for_each_arm
    def test_axes_are_unit_vectors(self, robot, _):
        for joint in robot.moving():
            self.assertAlmostEqual(np.linalg.norm(joint.axis), 1.0, delta=TOLERANCE, msg=joint.name)

    @for_each_arm
    def test_limits_are_complete(self, robot, _):
        for joint in robot.moving():
            self.assertGreater(joint.limit['velocity'], 0.0, joint.name)
            self.assertGreater(joint.limit['effort'], 0.0, joint.name)
            self.assertEqual('lower' in joint.limit, joint.type != 'continuous', joint.name)
            self.assertEqual(joint.contains(0.0), joint.name not in WITHOUT_ZERO.get(robot.name, ()), joint.name)

    @for_each_arm
    def test_every_link_is_drawn_and_moving_links_have_mass(self, robot, _):
        materials = {material.get('name') for material in robot.xml.findall('material')}
        for link in robot.xml.findall('link'):
            self.assertTrue(link.findall('visual'), link.get('name'))
            for visual in link.findall('visual'):
                self.assertIn(visual.find('geometry')[0].tag, ('box', 'cylinder', 'sphere'))
                self.assertIn(visual.find('material').get('name'), materials)
        for joint in robot.moving():
            link = robot.xml.find("link[@name='%s']" % joint.child)
            self.assertGreater(float(link.find('inertial/mass').get('value')), 0.0, joint.child)
            self.assertTrue(inertia_is_physical(link.find('inertial/inertia')), joint.child)

    @for_each_arm
    def test_config_is_complete_and_agrees_with_the_urdf(self, robot, _):
        self.assertEqual(config_errors(robot, TASK_OF.get(robot.name, WHOLE_POSE)), [])
        limits = robot.config['robot_description_planning']['joint_limits']
        for joint in robot.moving():
            self.assertEqual(set(limits[joint.name]), LIMIT_KEYS)
            self.assertEqual(limits[joint.name]['max_velocity'], joint.limit['velocity'], joint.name)


def inertia_is_physical(element):
    ixx, ixy, ixz, iyy, iyz, izz = (float(element.get(key)) for key in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz'))
    principal = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return principal[0] > 0.0 and principal[2] <= 1.02 * (principal[0] + principal[1])


class TheCheckerItselfFails(unittest.TestCase):
    """A wrong file must not pass."""

    def test_perturbed_length(self):
        robot, table = Robot('ur5'), tables()['ur5']
        robot.joints[2].origin[0, 3] += 1e-9
        self.assertGreater(worst_deviation(robot, table), TOLERANCE)

    def test_flipped_axis(self):
        robot, table = Robot('kr6_r900'), tables()['kr6_r900']
        robot.joints[3].axis = -robot.joints[3].axis
        self.assertGreater(worst_deviation(robot, table), 1e-3)

    def test_needle_like_inertia(self):
        self.assertFalse(inertia_is_physical(
            ElementTree.fromstring('<inertia ixx="1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>')))


if __name__ == '__main__':
    unittest.main()
