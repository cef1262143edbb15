"""Starts and stops what a scenario needs: a master where there is none, the nodes of one robot."""
import os
import signal
import socket
import subprocess
import time
import urllib.parse

import rosgraph
import rosservice

from .description import package_path

STOP_SECONDS = 10
START_SECONDS = 60
BROADCASTER_TOPICS = 3  # joint_states, joint_trajectory, target


class NotRunnable(Exception):
    """What a scenario needs did not come up, or went down."""


class Process:
    """A child in a process group of its own, its output in a file."""

    def __init__(self, command, log):
        self.name = os.path.basename(command[0])
        self.log = log
        os.makedirs(os.path.dirname(log), exist_ok=True)
        with open(log, 'w') as stream:
            self.child = subprocess.Popen(command, stdout=stream, stderr=subprocess.STDOUT, start_new_session=True)

    def require_running(self):
        if self.child.poll() is not None:
            raise NotRunnable('%s ended with code %d; the end of %s:\n%s' % (
                self.name, self.child.returncode, self.log, self.last_lines()))

    def last_lines(self, count=12):
        with open(self.log, errors='replace') as stream:
            return ''.join([line for line in stream.readlines() if line.strip()][-count:]).rstrip()

    def stop(self):
        """Interrupts it and waits; what does not end is killed. Its exit code."""
        for kind, seconds in ((signal.SIGINT, STOP_SECONDS), (signal.SIGTERM, STOP_SECONDS), (signal.SIGKILL, None)):
            if self.child.poll() is None:
                self.child.send_signal(kind)
            try:
                return self.child.wait(seconds)
            except subprocess.TimeoutExpired:
                continue
        return self.child.returncode


def log_folder():
    return os.environ.get('ROS_LOG_DIR', os.path.join(os.environ.get('ROS_HOME', os.path.expanduser('~/.ros')), 'log'))


def ensure_master():
    """A process that serves ROS_MASTER_URI; None where one is there already."""
    if rosgraph.is_master_online():
        return None
    address = urllib.parse.urlparse(rosgraph.get_master_uri())
    if address.hostname not in ('localhost', '127.0.0.1', socket.gethostname()):
        raise NotRunnable('no master at %s' % rosgraph.get_master_uri())
    command = ['rosmaster', '--core', '-p', str(address.port)]
    master = Process(command, os.path.join(log_folder(), 'screwline-master.log'))
    wait_until(rosgraph.is_master_online, [master], 'the master')
    return master


def wait_until(condition, processes, what, seconds=START_SECONDS):
    deadline = time.monotonic() + seconds
    while not condition():
        for process in processes:
            process.require_running()
        if time.monotonic() > deadline:
            said = processes[-1].last_lines() if processes else ''
            raise NotRunnable('%s did not come up within %d s\n%s' % (what, seconds, said))
        time.sleep(0.05)


def urdf_of(robot):
    return robot if robot.endswith('.urdf') else os.path.join(package_path(), 'urdf', robot + '.urdf')


class Session:
    """The nodes of one robot, by bringup.launch."""

    def __init__(self, part, rviz):
        self.nodes = ['kinematics_server', 'frame_broadcaster'] + ['trajectory_generator'] * part.motion
        self.master = rosgraph.Master('/scenario')
        self.refuse_second()
        if not os.path.exists(urdf_of(part.robot)):
            raise NotRunnable('there is no robot %s: %s is missing' % (part.robot, urdf_of(part.robot)))
        for node, parameters in part.parameters.items():
            for name, value in parameters.items():
                self.master.setParam('/%s/%s' % (node, name), value)
        arguments = ['robot:=' + part.robot, 'rate:=%g' % part.rate, 'motion:=%s' % str(bool(part.motion)).lower(),
                     'rviz:=%s' % str(bool(rviz)).lower()]
        self.process = Process(['roslaunch', 'screwline', 'bringup.launch'] + arguments,
                               os.path.join(log_folder(), 'screwline-%s.log' % part.robot))

    def refuse_second(self):
        for node in self.nodes:
            try:
                self.master.lookupNode('/' + node)
            except rosgraph.MasterError:
                continue
            raise NotRunnable('a %s runs already under %s' % (node, rosgraph.get_master_uri()))

    def wait_for_services(self):
        wanted = ['/kinematics_server/describe'] + ['/trajectory_generator/plan'] * ('trajectory_generator' in self.nodes)
        wait_until(lambda: all(self.serves(name) for name in wanted), [self.process], ' and '.join(wanted))
        # A node that is interrupted while it starts may leave its name with the master.
        wait_until(self.listens, [self.process], 'frame_broadcaster')

    def listens(self):
        """Whether the frame_broadcaster hears all its topics."""
        return sum('/frame_broadcaster' in nodes for _, nodes in self.master.getSystemState()[1]) >= BROADCASTER_TOPICS

    def serves(self, name):
        try:
            return rosservice.get_service_type(name) is not None
        except rosservice.ROSServiceIOException:
            return False

    def stop(self):
        self.process.stop()
        for name in ('robot_description', 'robot_description_planning', *self.nodes):
            if self.master.hasParam('/' + name):
                self.master.deleteParam('/' + name)
