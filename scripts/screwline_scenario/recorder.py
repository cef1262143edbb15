"""Records a bag that is complete: motion starts when every publisher is connected, and the bag is closed at the end."""
import os
import time
import xmlrpc.client

import roslib.packages
import rosgraph

from .session import NotRunnable, Process, log_folder, wait_until

NODE = '/scenario_recorder'
STATIC_TOPICS = ['/tf', '/tf_static', '/frame_broadcaster/markers']
MOTION_TOPICS = ['/joint_states', '/joint_trajectory', '/metrics', '/time_scaling', '/tool_pose', '/tool_twist']
LAST_HANDSHAKES = 0.3  # [s] for publishers to take in what the recorder has sent them
LAST_MESSAGES = 0.5  # [s] for what is on its way when the recording ends


def make_room(path):
    """An earlier bag of the same name makes way. @raise NotRunnable"""
    try:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        for leftover in (path, path + '.active'):
            if os.path.exists(leftover):
                os.remove(leftover)
    except OSError as error:
        raise NotRunnable('no bag can be written: %s' % error)


class Recorder:
    """Records into a path for which there is room: see make_room()."""

    def __init__(self, path, motion):
        self.path = path
        self.topics = STATIC_TOPICS + MOTION_TOPICS * motion
        self.master = rosgraph.Master('/scenario')
        program = roslib.packages.find_node('screwline', 'recorder')[0]
        command = [program, path, *self.topics, '__name:=' + NODE[1:]]
        self.process = Process(command, os.path.join(log_folder(), 'screwline-record.log'))

    def require_running(self):
        self.process.require_running()

    def wait_for_connections(self):
        wait_until(self.connected, [self.process], 'a publisher of each of %s' % ', '.join(self.topics))
        time.sleep(LAST_HANDSHAKES)

    def connected(self):
        """Every topic has a publisher, and the recorder a connection to each publisher."""
        publishers = dict(self.master.getSystemState()[0])
        wanted = {(node, topic) for topic in self.topics for node in publishers.get(topic, [])}
        return {topic for _, topic in wanted} == set(self.topics) and wanted <= self.connections()

    def connections(self):
        """(publisher, topic) of what the recorder hears."""
        try:
            recorder = xmlrpc.client.ServerProxy(self.master.lookupNode(NODE))
            connections = recorder.getBusInfo(NODE)[2]
        except (rosgraph.MasterError, OSError):
            return set()
        nodes = {self.uri_of(node): node for node in {name for _, names in self.master.getSystemState()[0] for name in names}}
        return {(nodes.get(c[1], c[1]), c[4]) for c in connections if c[2] == 'i' and (len(c) < 6 or c[5])}

    def uri_of(self, node):
        try:
            return self.master.lookupNode(node)
        except rosgraph.MasterError:
            return ''

    def stop(self):
        """The bag is closed and holds all that came when this returns."""
        time.sleep(LAST_MESSAGES)
        if self.process.stop() != 0:
            raise NotRunnable('%s is not complete: %s' % (self.path, self.process.last_lines()))
