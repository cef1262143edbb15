#!/usr/bin/python3
"""The recorder node: all that is published is in a bag that is closed by a signal; played, it latches what was latched."""
import os
import signal
import subprocess
import tempfile
import unittest

import roslib.packages
import rosbag
import rosgraph
import rospy
import rostest
from std_msgs.msg import Int32, String

MESSAGES = 5000
SECONDS = 30


class RecorderNode(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix='screwline-recorder-')
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, 'test.bag')

    def start(self, *arguments):
        program = roslib.packages.find_node('screwline', 'recorder')[0]
        return subprocess.Popen([program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

    def outcome(self, process):
        output = process.communicate(timeout=SECONDS)[0]
        print(output)
        return process.returncode, output

    def advertise(self, topic, kind, **options):
        publisher = rospy.Publisher(topic, kind, queue_size=2 * MESSAGES, **options)
        self.addCleanup(publisher.unregister)
        return publisher

    def wait_until(self, condition):
        deadline = rospy.get_time() + SECONDS
        while not condition():
            self.assertLess(rospy.get_time(), deadline)
            rospy.sleep(0.02)

    def recorded(self, kind):
        """A bag of many numbers and one latched text, closed by a signal."""
        process = self.start(self.path, 'numbers', '/fact', '/numbers', 'numbers:=counted')
        fact = self.advertise('/fact', String, latch=True)
        fact.publish('before anybody listened')
        numbers = self.advertise('/counted', Int32)
        heard = []
        subscriber = rospy.Subscriber('/counted', Int32, heard.append)
        self.wait_until(lambda: numbers.get_num_connections() == 2 and fact.get_num_connections() == 1)
        for number in range(MESSAGES):
            numbers.publish(number)
        self.wait_until(lambda: len(heard) == MESSAGES)
        subscriber.unregister()
        rospy.sleep(0.5)
        process.send_signal(kind)
        code, output = self.outcome(process)
        self.assertEqual(code, 0, output)
        self.assertIn('%d messages' % (MESSAGES + 1), output)

    def test_holds_all_that_was_published_and_is_closed_by_either_signal(self):
        for kind in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(kind):
                self.recorded(kind)
                self.assertEqual(os.listdir(self.folder.name), ['test.bag'])
                with rosbag.Bag(self.path) as bag:
                    read = [message.data for _, message, _ in bag.read_messages(['/counted'])]
                    self.assertEqual(read, list(range(MESSAGES)))
                    latching = {c.topic: bytes(c.header['latching']) for c in bag._get_connections()}
                self.assertEqual(latching, {'/fact': b'1', '/counted': b'0'})
                os.remove(self.path)

    def test_is_latched_again_when_it_is_played(self):
        self.recorded(signal.SIGINT)
        player = subprocess.Popen(['rosbag', 'play', '--quiet', '--keep-alive', '--rate=100', '--delay=0', self.path, '/fact:=/late'],
                                  stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
        try:
            self.wait_until(lambda: any(topic == '/late' for topic, _ in rosgraph.Master('/test').getSystemState()[0]))
            rospy.sleep(2.0)
            self.assertEqual(rospy.wait_for_message('/late', String, SECONDS).data, 'before anybody listened')
        finally:
            player.terminate()
            player.wait(SECONDS)

    def test_says_what_it_can_not_write(self):
        missing = os.path.join(self.folder.name, 'missing', 'test.bag')
        code, output = self.outcome(self.start(missing, '/numbers'))
        self.assertEqual(code, 1)
        fatal = [line for line in output.splitlines() if 'FATAL' in line]
        self.assertEqual(len(fatal), 1, output)
        self.assertIn(missing, fatal[0])
        self.assertIn('No such file or directory', fatal[0])

    def test_a_full_disk_ends_it(self):
        os.symlink('/dev/full', self.path + '.active')
        numbers = self.advertise('/numbers', Int32)
        process = self.start(self.path, '/numbers')
        while process.poll() is None and not rospy.is_shutdown():
            numbers.publish(1)
            rospy.sleep(0.001)
        code, output = self.outcome(process)
        self.assertEqual(code, 1)
        self.assertIn('No space left on device', output)

    def test_wrong_arguments(self):
        for arguments in ([], [self.path], ['--help', '/numbers']):
            code, output = self.outcome(self.start(*arguments))
            self.assertEqual(code, 2)
            self.assertIn('usage', output)


if __name__ == '__main__':
    rospy.init_node('recorder_test')
    rostest.rosrun('screwline', 'recorder_node', RecorderNode)
