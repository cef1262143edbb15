#!/usr/bin/python3
"""What kinematics_server.launch and trajectory_generator.launch put on the parameter server; no master needed."""

import os
import unittest

import roslaunch.config
import roslaunch.xmlloader
import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROBOTS = sorted(entry[:-len('.urdf')] for entry in os.listdir(os.path.join(ROOT, 'urdf')) if entry.endswith('.urdf'))
NODES = ('kinematics_server', 'trajectory_generator')
JOINT_LIMITS = '/robot_description_planning/joint_limits/'


def parameters(node, *arguments):
    """Parameters by name, and the nodes, of a launch file started with these arguments."""
    config = roslaunch.config.ROSLaunchConfig()
    path = os.path.join(ROOT, 'launch', node + '.launch')
    roslaunch.xmlloader.XmlLoader().load(path, config, argv=[path] + list(arguments), verbose=False)
    return {name: param.value for name, param in config.params.items()}, config.nodes


def robot_config(robot):
    with open(os.path.join(ROOT, 'config', 'robots', robot + '.yaml')) as stream:
        return yaml.safe_load(stream)


class RobotLaunch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        path = os.environ.get('ROS_PACKAGE_PATH', '')
        os.environ['ROS_PACKAGE_PATH'] = os.pathsep.join([ROOT] + [path] * bool(path))

    def test_every_robot_by_name(self):
        for node in NODES:
            for robot in ROBOTS:
                with self.subTest(node=node, robot=robot):
                    params, nodes = parameters(node, 'robot:=' + robot)
                    expected = robot_config(robot)
                    self.assertEqual([(n.package, n.type, n.name) for n in nodes], [('screwline', node, node)])
                    self.assertIn('<robot name="%s">' % robot, params['/robot_description'])
                    self.assertEqual(params['/%s/task' % node], expected['task'])
                    for joint, limits in expected['robot_description_planning']['joint_limits'].items():
                        for key, value in limits.items():
                            self.assertEqual(params[JOINT_LIMITS + joint + '/' + key], value)

    def test_given_task_replaces_the_configured_one(self):
        for node in NODES:
            params, _ = parameters(node, 'robot:=scara', 'task:=[x, y, rz]')
            self.assertEqual(params['/%s/task' % node], ['x', 'y', 'rz'])

    def test_a_path_is_served_without_configuration(self):
        path = os.path.join(ROOT, 'urdf', 'scara.urdf')
        for node in NODES:
            params, _ = parameters(node, 'robot:=' + path)
            self.assertIn('<robot name="scara">', params['/robot_description'])
            self.assertEqual(set(params) - {'/robot_description', '/trajectory_generator/rate'}, set())

    def test_optional_links_are_set_only_where_given(self):
        for node in NODES:
            params, _ = parameters(node, 'robot:=scara')
            self.assertNotIn('/%s/base_link' % node, params)
            self.assertNotIn('/%s/tip_link' % node, params)
            params, _ = parameters(node, 'robot:=scara', 'base_link:=upper_arm', 'tip_link:=quill')
            self.assertEqual(params['/%s/base_link' % node], 'upper_arm')
            self.assertEqual(params['/%s/tip_link' % node], 'quill')

    def test_rate(self):
        self.assertEqual(parameters('trajectory_generator')[0]['/trajectory_generator/rate'], 100)
        self.assertEqual(parameters('trajectory_generator', 'rate:=500')[0]['/trajectory_generator/rate'], 500)

    def test_an_unknown_robot_is_an_error(self):
        for node in NODES:
            with self.assertRaises(Exception):
                parameters(node, 'robot:=no_such_robot')


if __name__ == '__main__':
    unittest.main()
