#!/usr/bin/python3
"""Every robot of urdf/ and config/robots/ against its golden file, with a forward kinematics of its own (numpy)."""

import functools
import math
import os
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
import yaml
from data_support import GOLDEN, ROOT, TASK_OF

TOLERANCE = 1e-12
GOLDEN_OF = {
    'prrr_arm': 'seed000_prrr',
    'rrp_spherical': 'seed001_rrp_spherical__special',
    'rr_planar': 'seed003_01_rr_planar',
    'rrr_planar': 'seed003_02_rrr_planar',
    'rrr_articulated': 'seed003_03_rrr_articulated',
    'rrp_offset': 'seed003_04_rrp_offset',
    'rpp_cylindrical': 'seed003_05_rpp_cylindrical',
    'spherical_wrist': 'seed003_06_wrist',
    'scara': 'seed003_07_scara',
    'prrr_column': 'seed003_08_prrr',
    'rrprrr': 'seed004_01_rrprrr__special',
    'rrr_orthogonal': 'seed004_02_rrr_dh',
    'orienting_3r': 'seed004_03_orienting_3r',
    'planar_3r': 'seed004_05_planar_3r__special',
}
LIMIT_KEYS = {
    'has_velocity_limits', 'max_velocity', 'has_acceleration_limits', 'max_acceleration', 'has_jerk_limits', 'max_jerk'
}

INERTIA_KEYS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')


def numbers(element, attribute, default='0 0 0'):
    text = default if element is None else element.get(attribute, default)
    return np.array([float(word) for word in text.split()])


def turn(axis, angle):
    """Rotation matrix about a unit axis (Rodrigues)."""
    x, y, z = axis
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * skew + (1 - math.cos(angle)) * skew @ skew


def transform(rotation, position):
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = position
    return result


def rpy_rotation(rpy):
    return turn((0, 0, 1), rpy[2]) @ turn((0, 1, 0), rpy[1]) @ turn((1, 0, 0), rpy[0])


class UrdfJoint:
    def __init__(self, element):
        self.name = element.get('name')
        self.type = element.get('type')
        self.parent = element.find('parent').get('link')
        self.child = element.find('child').get('link')
        origin = element.find('origin')
        self.origin = transform(rpy_rotation(numbers(origin, 'rpy')), numbers(origin, 'xyz'))
        self.axis = numbers(element.find('axis'), 'xyz', '1 0 0')
        limit = element.find('limit')
        self.limit = {key: float(value) for key, value in limit.attrib.items()} if limit is not None else {}

    def motion(self, q):
        if self.type == 'fixed':
            return np.eye(4)
        if self.type == 'prismatic':
            return transform(np.eye(3), self.axis * q)
        return transform(turn(self.axis, q), np.zeros(3))

    def contains(self, q):
        return self.type == 'continuous' or self.limit['lower'] <= q <= self.limit['upper']


class Robot:
    def __init__(self, name):
        self.name = name
        self.xml = ElementTree.parse(os.path.join(ROOT, 'urdf', name + '.urdf')).getroot()
        self.links = [link.get('name') for link in self.xml.findall('link')]
        self.joints = [UrdfJoint(joint) for joint in self.xml.findall('joint')]
        with open(os.path.join(ROOT, 'config', 'robots', name + '.yaml')) as stream:
            self.config = yaml.safe_load(stream)

    def chain(self):
        """The joints from base_link to tool0; raises where the tree branches or leaves a link out."""
        by_parent = {}
        for joint in self.joints:
            if joint.parent in by_parent:
                raise ValueError('%s: link %s has two children' % (self.name, joint.parent))
            by_parent[joint.parent] = joint
        joints, link = [], 'base_link'
        while link in by_parent:
            joints.append(by_parent[link])
            link = joints[-1].child
        if link != 'tool0' or len(joints) != len(self.joints) or len(joints) + 1 != len(self.links):
            raise ValueError('%s: base_link to tool0 is not the whole tree' % self.name)
        return joints

    def moving(self):
        return [joint for joint in self.chain() if joint.type != 'fixed']

    def forward(self, q):
        pose, values = np.eye(4), iter(q)
        for joint in self.chain():
            pose = pose @ joint.origin @ joint.motion(0.0 if joint.type == 'fixed' else next(values))
        return pose


def golden(name):
    with open(os.path.join(GOLDEN, GOLDEN_OF[name] + '.yaml')) as stream:
        return yaml.load(stream, getattr(yaml, 'CSafeLoader', yaml.SafeLoader))


def worst_deviation(robot, data):
    return max(np.abs(robot.forward(case['q']) - np.array(case['pose'])).max() for case in data['cases'])


def golden_configurations(data):
    for case in data['cases']:
        yield case['id'], case['q']
        for key in ('solutions', 'samples'):
            for solution in case['ik'].get(key) or []:
                yield case['id'], solution['q']


def config_errors(robot, task):
    """What is wrong with config/robots/NAME.yaml; empty where nothing is."""
    errors = []
    if set(robot.config) != {'task', 'robot_description_planning'}:
        errors.append('top-level keys %s' % sorted(robot.config))
    if robot.config.get('task') != task:
        errors.append('task %s, expected %s' % (robot.config.get('task'), task))
    planning = robot.config.get('robot_description_planning', {})
    if set(planning) != {'joint_limits'}:
        errors.append('robot_description_planning keys %s' % sorted(planning))
    limits = planning.get('joint_limits', {})
    if set(limits) != {joint.name for joint in robot.moving()}:
        errors.append('joint_limits of %s' % sorted(limits))
    for name, values in limits.items():
        if set(values) != LIMIT_KEYS:
            errors.append('%s keys %s' % (name, sorted(values)))
        for key in LIMIT_KEYS & set(values):
            good = values[key] is True if key.startswith('has_') else isinstance(values[key], float) and values[key] > 0
            if not good:
                errors.append('%s/%s is %r' % (name, key, values[key]))
    return errors


def for_each_robot(law):
    """A law of one robot and its golden data becomes a test of all 14, each a subtest."""

    @functools.wraps(law)
    def test(self):
        for name in GOLDEN_OF:
            with self.subTest(robot=name):
                law(self, Robot(name), self.golden[name])

    return test


class RobotFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.golden = {name: golden(name) for name in GOLDEN_OF}

    def test_one_urdf_and_one_config_per_mechanism(self):
        for folder, ending in (('urdf', '.urdf'), ('config/robots', '.yaml')):
            found = {entry[:-len(ending)] for entry in os.listdir(os.path.join(ROOT, folder)) if entry.endswith(ending)}
            self.assertLessEqual(set(GOLDEN_OF), found)

    @for_each_robot
    def test_joint_names_types_and_robot_name(self, robot, data):
        self.assertEqual(robot.xml.get('name'), robot.name)
        self.assertEqual([j.name for j in robot.moving()], [j['name'] for j in data['model']['joints']])
        types = ['revolute' if j.type == 'continuous' else j.type for j in robot.moving()]
        self.assertEqual(types, [j['type'] for j in data['model']['joints']])

    @for_each_robot
    def test_forward_kinematics_equals_golden_poses(self, robot, data):
        home = robot.forward([0.0] * len(robot.moving()))
        self.assertLess(np.abs(home - data['model']['home_pose']).max(), TOLERANCE)
        self.assertLess(worst_deviation(robot, data), TOLERANCE)

    @for_each_robot
    def test_axes_are_unit_vectors(self, robot, _):
        for joint in robot.moving():
            self.assertAlmostEqual(np.linalg.norm(joint.axis), 1.0, delta=TOLERANCE, msg=joint.name)

    @for_each_robot
    def test_limits_contain_every_golden_configuration(self, robot, data):
        for case, q in golden_configurations(data):
            for joint, value in zip(robot.moving(), q):
                self.assertTrue(joint.contains(value), '%s: %s = %r' % (case, joint.name, value))

    @for_each_robot
    def test_limits_are_complete_and_contain_zero(self, robot, _):
        for joint in robot.moving():
            self.assertGreater(joint.limit['velocity'], 0.0, joint.name)
            self.assertGreater(joint.limit['effort'], 0.0, joint.name)
            self.assertTrue(joint.contains(0.0), joint.name)
            self.assertEqual('lower' in joint.limit, joint.type != 'continuous', joint.name)

    @for_each_robot
    def test_every_link_is_drawn_and_moving_links_have_mass(self, robot, _):
        materials = {material.get('name') for material in robot.xml.findall('material')}
        for link in robot.xml.findall('link'):
            visuals = link.findall('visual')
            self.assertTrue(visuals, link.get('name'))
            for visual in visuals:
                self.assertIn(visual.find('geometry')[0].tag, ('box', 'cylinder', 'sphere'))
                self.assertIn(visual.find('material').get('name'), materials)
        for joint in robot.moving():
            link = robot.xml.find("link[@name='%s']" % joint.child)
            self.assertGreater(float(link.find('inertial/mass').get('value')), 0.0, joint.child)

    @for_each_robot
    def test_inertias_are_physical(self, robot, _):
        for element in robot.xml.findall('link/inertial/inertia'):
            ixx, ixy, ixz, iyy, iyz, izz = (float(element.get(key)) for key in INERTIA_KEYS)
            principal = np.linalg.eigvalsh([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
            self.assertGreater(principal[0], 0.0)
            self.assertLessEqual(principal[2], 1.02 * (principal[0] + principal[1]))

    @for_each_robot
    def test_config_is_complete_and_agrees_with_the_urdf(self, robot, data):
        self.assertEqual(config_errors(robot, TASK_OF[data['model']['task']]), [])
        limits = robot.config['robot_description_planning']['joint_limits']
        for joint in robot.moving():
            self.assertEqual(limits[joint.name]['max_velocity'], joint.limit['velocity'], joint.name)


class TheCheckerItselfFails(unittest.TestCase):
    """A wrong file must not pass."""

    def test_perturbed_origin(self):
        robot = Robot('scara')
        robot.joints[1].origin[0, 3] += 1e-9
        self.assertGreater(worst_deviation(robot, golden('scara')), TOLERANCE)

    def test_rounded_rpy(self):
        robot = Robot('orienting_3r')
        robot.joints[1].origin = transform(rpy_rotation([2.0943951, 0, 0]), np.zeros(3))
        self.assertGreater(worst_deviation(robot, golden('orienting_3r')), TOLERANCE)

    def test_flipped_axis(self):
        robot = Robot('rrp_spherical')
        robot.joints[1].axis = -robot.joints[1].axis
        self.assertGreater(worst_deviation(robot, golden('rrp_spherical')), TOLERANCE)

    def test_narrow_limit(self):
        robot = Robot('planar_3r')
        robot.joints[1].limit['upper'] = 3.0
        outside = [q for _, q in golden_configurations(golden('planar_3r')) if not robot.joints[1].contains(q[1])]
        self.assertTrue(outside)

    def test_branching_tree(self):
        robot = Robot('rr_planar')
        robot.joints[1].parent = 'base_link'
        self.assertRaises(ValueError, robot.chain)

    def test_unknown_and_missing_keys(self):
        robot = Robot('rr_planar')
        robot.config['tusk'] = robot.config.pop('task')
        del robot.config['robot_description_planning']['joint_limits']['theta1']['max_jerk']
        self.assertEqual(len(config_errors(robot, ['x', 'y'])), 3)


if __name__ == '__main__':
    unittest.main()
