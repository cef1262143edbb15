#!/usr/bin/python3
"""A robot that can't be served ends kinematics_server within 5 s: one FATAL line that says what and where, status 1."""

import itertools
import signal
import unittest

import rospy
import rostest
from data_support import read_text, robot_config
from kinematics_server_support import Server
from node_support import assert_refused

NUMBERS = itertools.count()
PLANAR = read_text('urdf', 'rr_planar.urdf')
TWO_ARMS = PLANAR.replace('</robot>', '''
  <link name="other"/>
  <joint name="side" type="revolute">
    <parent link="base_link"/><child link="other"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>''')


SNAKE_JOINT = '''
<joint name="j%d" type="revolute">
  <parent link="l%d"/><child link="l%d"/><origin xyz="0.1 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="1" velocity="1"/>
</joint>'''


def snake(joints):
    links = ''.join('<link name="l%d"/>' % i for i in range(joints + 1))
    return '<robot name="snake">%s%s</robot>' % (links, ''.join(SNAKE_JOINT % (i, i, i + 1) for i in range(joints)))


class Refused(unittest.TestCase):
    def refused(self, *words, urdf=PLANAR, params=None, limits=None):
        assert_refused(self, Server('refused%d' % next(NUMBERS), urdf, params, limits), words)

    def test_no_robot_description(self):
        self.refused('robot_description', urdf=None)

    def test_robot_description_is_no_string(self):
        self.refused('robot_description', urdf=7)

    def test_malformed_xml(self):
        self.refused(urdf='<robot name="r"><link name="a">')

    def test_not_a_urdf(self):
        self.refused(urdf='hello')
        self.refused(urdf='')

    def test_nothing_moves(self):
        self.refused(urdf='<robot name="stone"><link name="a"/></robot>')

    def test_several_chains_and_no_choice(self):
        self.refused('other', urdf=TWO_ARMS)

    def test_unknown_links(self):
        self.refused('nowhere', params={'tip_link': 'nowhere'})
        self.refused('nowhere', params={'base_link': 'nowhere'})

    def test_bad_axis(self):
        self.refused('theta1', urdf=PLANAR.replace('<axis xyz="0 0 1"/>', '<axis xyz="0 0 0"/>', 1))
        self.refused(urdf=PLANAR.replace('<axis xyz="0 0 1"/>', '<axis xyz="nan 0 1"/>'))

    def test_limits_the_wrong_way_round(self):
        self.refused('theta1', '99', urdf=PLANAR.replace('lower="-6.283185"', 'lower="99"', 1))

    def test_too_many_joints(self):
        self.refused('65', '64', urdf=snake(65))
        self.refused('max_joints', '8', urdf=snake(9), params={'max_joints': 8})

    def test_bad_task(self):
        self.refused('~task', 'q', params={'task': ['x', 'q']})
        self.refused('~task', params={'task': ['x', 'x']})
        self.refused('~task', params={'task': []})
        self.refused('~task', params={'task': 'x'})
        self.refused('~task', params={'task': ['x', 3]})

    def test_bad_private_parameters(self):
        self.refused('~ik_timeout', '-1', params={'ik_timeout': -1})
        self.refused('~ik_timeout', params={'ik_timeout': float('nan')})
        self.refused('~ik_timeout', params={'ik_timeout': 'soon'})
        self.refused('~threads', params={'threads': -1})
        self.refused('~threads', params={'threads': 1.5})
        self.refused('~max_batch', params={'max_batch': 0})
        self.refused('~max_joints', '65', params={'max_joints': 65})
        self.refused('~rotation_weight', params={'rotation_weight': 0})
        self.refused('~base_link', params={'base_link': 4})

    def test_unknown_private_parameter(self):
        self.refused('~ik_timout', 'ik_timeout', params={'ik_timout': 0.2})

    def test_bad_planning_limits(self):
        self.refused('theta1', 'max_jerk', limits={'theta1': {'has_jerk_limits': True}})
        self.refused('theta1', 'max_jerk', limits={'theta1': {'max_jerk': -4.0}})
        self.refused('theta1', 'max_acceleration', limits={'theta1': {'max_acceleration': 'fast'}})
        self.refused('theta1', limits={'theta1': 3})
        self.refused('joint_limits', limits=3)


class Served(unittest.TestCase):
    def served(self, urdf, params=None, limits=None):
        server = Server('served%d' % next(NUMBERS), urdf, params, limits)
        self.addCleanup(server.shut_down)
        return server.ask('describe')

    def test_choice_among_chains(self):
        answer = self.served(TWO_ARMS, {'tip_link': 'other'})
        self.assertEqual(answer.joint_names, ['side'])
        self.assertEqual(answer.tip_link, 'other')

    def test_as_many_joints_as_are_served(self):
        self.assertEqual(len(self.served(snake(7)).joint_names), 7)

    def test_assumed_limits_are_noted(self):
        answer = self.served(PLANAR)
        self.assertEqual(list(answer.acceleration_limits), [4.0 * v for v in answer.velocity_limits])
        self.assertEqual(list(answer.jerk_limits), [20.0 * a for a in answer.acceleration_limits])
        notes = ' '.join(answer.notes)
        self.assertIn('acceleration limits are assumed', notes)
        self.assertIn('jerk limits are assumed', notes)
        self.assertIn('derived', notes)
        self.assertEqual(answer.task, ['x', 'y'])

    def test_planning_limits_and_their_flags(self):
        limits = robot_config('rr_planar')['robot_description_planning']['joint_limits']
        limits['theta2'].update(has_acceleration_limits=False, max_velocity=1.0, has_position_limits=True)
        limits['elsewhere'] = {'max_jerk': 1}
        answer = self.served(PLANAR, limits=limits)
        self.assertEqual(answer.acceleration_limits[0], limits['theta1']['max_acceleration'])
        self.assertEqual(answer.acceleration_limits[1], 4.0 * answer.velocity_limits[1])
        self.assertEqual(answer.jerk_limits[1], limits['theta2']['max_jerk'])
        self.assertNotEqual(answer.velocity_limits[1], 1.0)
        notes = ' '.join(answer.notes)
        self.assertIn('acceleration limits are assumed (full speed in 0.25 s): theta2', notes)
        self.assertIn('max_velocity 1 is not read', notes)
        self.assertIn('position limits are the robot description', notes)

    def test_robot_description_above_the_node(self):
        rospy.set_param('/robot_description', PLANAR)
        self.addCleanup(rospy.delete_param, '/robot_description')
        self.assertEqual(self.served(None).joint_names, ['theta1', 'theta2'])

    def test_terminates_cleanly(self):
        server = Server('served%d' % next(NUMBERS), PLANAR)
        server.ask('describe')
        server.process.send_signal(signal.SIGINT)
        self.assertEqual(server.ended()[0], 0)


if __name__ == '__main__':
    rospy.init_node('kinematics_server_startup')
    rostest.rosrun('screwline', 'kinematics_server_startup', 'kinematics_server_startup')
