"""A node that serves one robot, as a process of a test's own."""
import subprocess
import time

import roslib.packages
import rospy
from data_support import read_text, robot_config
from screwline.msg import ErrorCode


class ServedNode:
    """NODE in a namespace; `params` are its private ones, `limits` those of joint_limits. Services of SERVICES are its attributes."""

    NODE = ''
    SERVICES = {}

    def __init__(self, namespace, urdf=None, params=None, limits=None):
        self.namespace = namespace
        self.name = '/%s/%s' % (namespace, self.NODE)
        if urdf is not None:
            rospy.set_param('/%s/robot_description' % namespace, urdf)
        if limits is not None:
            rospy.set_param('/%s/robot_description_planning/joint_limits' % namespace, limits)
        for key, value in (params or {}).items():
            rospy.set_param('%s/%s' % (self.name, key), value)
        node = roslib.packages.find_node('screwline', self.NODE)[0]
        self.started = time.monotonic()
        self.process = subprocess.Popen([node, '__ns:=' + namespace], stderr=subprocess.PIPE,
                                        stdout=subprocess.DEVNULL, universal_newlines=True)

    @classmethod
    def of(cls, robot, namespace=None, **params):
        """One of the robots of urdf/ with its configuration."""
        config = robot_config(robot)
        params.setdefault('task', config['task'])
        limits = config['robot_description_planning']['joint_limits']
        return cls(namespace or robot, read_text('urdf', robot + '.urdf'), params, limits)

    def __getattr__(self, service):
        if service not in self.SERVICES:
            raise AttributeError(service)
        address = '%s/%s' % (self.name, service)
        rospy.wait_for_service(address, timeout=30.0)
        proxy = rospy.ServiceProxy(address, self.SERVICES[service], persistent=True)
        setattr(self, service, proxy)
        return proxy

    def ask(self, service, **fields):
        """The answer to a good question."""
        response = getattr(self, service)(**fields)
        assert response.success and response.error_code == ErrorCode.SUCCESS, (service, fields, response.message)
        return response

    def ended(self, within=10.0):
        """Waits for the end: exit status, lines of stderr, seconds since the start."""
        _, text = self.process.communicate(timeout=within)
        return self.process.returncode, text.splitlines(), time.monotonic() - self.started

    def shut_down(self):
        """What it wrote to stderr."""
        if self.process.poll() is None:
            self.process.terminate()
        return self.process.communicate(timeout=20.0)[1]


def assert_refused(test, node, words):
    """The node ends within 5 s, with status 1 and one FATAL line that holds the words."""
    status, lines, seconds = node.ended()
    fatal = [line for line in lines if 'FATAL' in line]
    test.assertEqual(status, 1, lines)
    test.assertEqual(len(fatal), 1, lines)
    test.assertLess(seconds, 5.0)
    for word in words:
        test.assertIn(word, fatal[0])
