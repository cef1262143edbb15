#!/usr/bin/python3
"""Both clients of examples/, run as a user runs them, say what the services answer."""
import re
import subprocess
import unittest

import roslib.packages
import rospy
import rostest
from screwline.srv import ComputeFK, ComputeIK, Describe
from sensor_msgs.msg import JointState

SECONDS = 60
DIGITS = 1e-4  # that the clients print, a little more


def output_of(program):
    """(exit code, standard output, standard error) of one of the package's programs."""
    path = roslib.packages.find_node('screwline', program)[0]
    answer = subprocess.run([path], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=SECONDS)
    return answer.returncode, answer.stdout, answer.stderr


def solutions_in(output):
    """{branch: joint values} of the lines that hold nothing but numbers and a branch."""
    found = {}
    for line in output.splitlines():
        match = re.fullmatch(r'((?:\s+-?\d+\.\d{4})+)  (\D*)', line)
        if match:
            found[match.group(2)] = [float(number) for number in match.group(1).split()]
    return found


class ExamplesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('examples_test')
        rospy.wait_for_service('/kinematics_server/describe', SECONDS)
        cls.motion = rospy.get_param('~motion')
        if cls.motion:
            rospy.wait_for_service('/trajectory_generator/plan', SECONDS)
        cls.robot = rospy.ServiceProxy('/kinematics_server/describe', Describe)()

    def check_client(self, program):
        code, output, errors = output_of(program)
        self.assertEqual(code, 0, errors)
        wanted = [0.5 + 0.2 * i for i in range(len(self.robot.joint_names))]
        joints = JointState(name=self.robot.joint_names,
                            position=[min(max(q, a), b) for q, a, b in zip(wanted, self.robot.lower, self.robot.upper)])
        pose = rospy.ServiceProxy('/kinematics_server/compute_fk', ComputeFK)(joint_state=joints).poses[0]
        answer = rospy.ServiceProxy('/kinematics_server/compute_ik', ComputeIK)(pose=pose)
        found = solutions_in(output)
        self.assertEqual(set(found), {solution.branch for solution in answer.solutions}, output)
        for solution in answer.solutions:
            for printed, value in zip(found[solution.branch], solution.position):
                self.assertAlmostEqual(printed, value, delta=DIGITS)
        self.assertIn(self.robot.ik_method, output)
        self.assertIn('%s, complete:' % answer.message, output)
        self.assertIn('from the nearest singularity', output)
        self.assertEqual('arrived at' in output, self.motion, output)

    def test_python_client(self):
        self.check_client('client.py')

    def test_cpp_client(self):
        self.check_client('example_client')


if __name__ == '__main__':
    rostest.rosrun('screwline', 'examples', ExamplesTest)
