"""rosrun screwline report on bags that are made here: figures, the page and its table, and what it refuses."""
import html.parser
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped
from screwline.msg import TimeScaling, TrajectoryMetrics
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
REPORT = os.path.join(ROOT, 'scripts', 'report')
NAMES = ['theta1', 'theta2', 'theta3']
A, C = [math.radians(x) for x in (60, -30, 60)], [math.radians(x) for x in (150, -90, 60)]
FIGURES = ('positions', 'velocities', 'accelerations', 'time_scaling', 'tool_path', 'tool_speed', 'limit_use')
BEGIN, DURATION, PERIOD = 100.0, 2.0, 0.02
SCENARIO = """description: two moves <of a test> & more
robot: planar_3r
steps:
  - move: {title: "out & <away>", profile: cubic, duration: 2, waypoints: [[deg(60), deg(-30), deg(60)], [deg(150), deg(-90), deg(60)]]}
"""


def cubic(tau):
    return 3 * tau**2 - 2 * tau**3, 6 * tau - 6 * tau**2, 6 - 12 * tau


def point(start, goal, time):
    s, ds, dds = cubic(time / DURATION)
    delta = [b - a for a, b in zip(start, goal)]
    return JointTrajectoryPoint(positions=[a + d * s for a, d in zip(start, delta)],
                                velocities=[d * ds / DURATION for d in delta],
                                accelerations=[d * dds / DURATION**2 for d in delta], time_from_start=rospy.Duration(time))


def write_motion(bag, begin, start, goal, ratio):
    times = [i * PERIOD for i in range(int(round(DURATION / PERIOD)) + 1)]
    trajectory = JointTrajectory(joint_names=NAMES, points=[point(start, goal, t) for t in times])
    trajectory.header.stamp = rospy.Time(begin)
    bag.write('/joint_trajectory', trajectory, rospy.Time(begin))
    bag.write('/metrics', TrajectoryMetrics(
        joint_names=NAMES, peak_velocity=[1.178, 0.785, 0.0], peak_acceleration=[2.356, 1.571, 0.0],
        peak_jerk=[math.inf, math.inf, 0.0], rms_acceleration=[1.36, 0.907, 0.0], jerk_integral=[math.inf] * 3,
        travel=[1.571, 1.047, 0.0], limit_ratio=[ratio, 0.5 * ratio, 0.0], path_length=1.2345, max_curvature=0.9876,
        peak_speed=1.111, energy=5.55, goal_error=0.0), rospy.Time(begin))
    for t in times:
        stamp = rospy.Time(begin + t)
        state = point(start, goal, t)
        reversed_state = JointState(name=NAMES[::-1], position=state.positions[::-1], velocity=state.velocities[::-1])
        reversed_state.header.stamp = stamp
        pose, twist = PoseStamped(), TwistStamped()
        pose.header.stamp = twist.header.stamp = stamp
        pose.pose.position.x, pose.pose.position.y = math.cos(state.positions[0]), math.sin(state.positions[0])
        twist.twist.linear.x = state.velocities[0]
        s, ds, dds = cubic(t / DURATION)
        scaling = TimeScaling(tau=[t / DURATION], s=[s], ds=[ds], dds=[dds], ddds=[-12.0])
        scaling.header.stamp = stamp
        for topic, message in (('joint_states', reversed_state), ('tool_pose', pose), ('tool_twist', twist), ('time_scaling', scaling)):
            bag.write('/' + topic, message, stamp)


class Page(html.parser.HTMLParser):
    """Text of the table's rows, sources of images, whether tags are closed."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.images, self.open, self.links = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag not in ('meta', 'img', 'link', 'br'):
            self.open.append(tag)
        if tag == 'tr':
            self.rows.append([])
        if tag in ('td', 'th'):
            self.rows[-1].append('')
        if tag == 'img':
            self.images.append(attributes['src'])
        self.links += [value for name, value in attributes.items() if name in ('href', 'src') and not value.startswith('data:')]

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, '%s closes %s' % (tag, self.open)
        self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1] in ('td', 'th'):
            self.rows[-1][-1] += data


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='screwline_report_')
        cls.bag = os.path.join(cls.folder, 'planar_3r_via.bag')
        with rosbag.Bag(cls.bag, 'w') as bag:
            write_motion(bag, BEGIN, A, C, 0.5)
            write_motion(bag, BEGIN + DURATION + 0.5, C, A, 1.25)
        cls.answer = cls.report(cls.bag)
        cls.made = os.path.join(cls.folder, 'results', 'planar_3r_via')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    @classmethod
    def report(cls, *arguments):
        return subprocess.run([sys.executable, REPORT, *arguments, '--output', os.path.join(cls.folder, 'results'),
                               '--bag-dir', cls.folder], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)

    def page(self):
        with open(os.path.join(self.made, 'index.html'), encoding='utf-8') as stream:
            return stream.read()

    def test_says_where_the_page_is(self):
        self.assertEqual(self.answer.returncode, 0, self.answer.stderr)
        self.assertEqual(self.answer.stdout.strip(), os.path.join(self.made, 'index.html'))

    def test_every_figure_is_a_png_of_a_readable_size(self):
        for name in FIGURES:
            with open(os.path.join(self.made, name + '.png'), 'rb') as stream:
                data = stream.read()
            self.assertEqual(data[:8], b'\x89PNG\r\n\x1a\n', name)
            width, height = struct.unpack('>II', data[16:24])
            self.assertGreater(width, 700, name)
            self.assertGreater(height, 300, name)

    def test_page_is_complete_in_itself(self):
        page = Page(self.page())
        self.assertEqual(page.open, [])
        self.assertEqual(page.links, [])
        self.assertEqual(len(page.images), len(FIGURES))
        self.assertTrue(all(image.startswith('data:image/png;base64,') for image in page.images))

    def test_table_has_the_metrics(self):
        rows = Page(self.page()).rows
        self.assertTrue(rows[1][1].startswith('via_scalar'), rows[1])  # from A to C in 2 s: that scenario's first step
        self.assertEqual(rows[1][:1] + rows[1][2:], ['1', '0.00', '2.0000', '1.234', '1.111', '0.9876', '5.55', '50.0', '0'])
        self.assertEqual(rows[2][0:4] + [rows[2][8]], ['2', 'transfer', '2.50', '2.0000', '125.0'])
        self.assertEqual(rows[4], ['1', 'theta1', 'rad', '1.178', '2.356', '∞', '1.36', '1.571', '50.0'])
        self.assertIn('<td class="over">125.0</td>', self.page())

    def test_browser_shows_the_page(self):
        browser = next(filter(None, map(shutil.which, ('chromium', 'chromium-browser', 'google-chrome'))), None)
        if browser is None:
            self.skipTest('no chromium here; the page was parsed')
        dom = subprocess.run([browser, '--headless', '--no-sandbox', '--disable-gpu', '--dump-dom',
                              'file://' + os.path.join(self.made, 'index.html')],
                             stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True, timeout=120).stdout
        self.assertEqual(len(re.findall('<figure>', dom)), len(FIGURES))

    def test_scenario_file_names_its_motions(self):
        scenario = os.path.join(self.folder, 'two_moves.yaml')
        with open(scenario, 'w') as stream:
            stream.write(SCENARIO)
        shutil.copy(self.bag, os.path.join(self.folder, 'two_moves.bag'))
        answer = self.report(scenario)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        with open(os.path.join(self.folder, 'results', 'two_moves', 'index.html'), encoding='utf-8') as stream:
            text = stream.read()
        self.assertEqual([row[1] for row in Page(text).rows[1:3]], ['out & <away>', 'transfer'])
        self.assertIn('two moves &lt;of a test&gt; &amp; more', text)

    def test_bag_of_no_scenario_is_drawn_too(self):
        other = os.path.join(self.folder, 'something.bag')
        shutil.copy(self.bag, other)
        self.assertEqual(self.report(other).returncode, 0)
        with open(os.path.join(self.folder, 'results', 'something', 'index.html'), encoding='utf-8') as stream:
            self.assertEqual(Page(stream.read()).rows[4][2], 'rad or m')

    def refused(self, code, words, *arguments):
        answer = self.report(*arguments)
        self.assertEqual(answer.returncode, code, answer.stderr)
        self.assertIn(words, answer.stderr)
        self.assertNotIn('Traceback', answer.stderr)

    def test_refuses_what_it_can_not_draw(self):
        empty, torn = os.path.join(self.folder, 'empty.bag'), os.path.join(self.folder, 'torn.bag')
        with rosbag.Bag(empty, 'w') as bag:
            bag.write('/joint_states', JointState(name=NAMES, position=A), rospy.Time(BEGIN))
        still = os.path.join(self.folder, 'still.yaml')
        with open(still, 'w') as stream:
            stream.write('{robot: scara, motion: false, steps: [{say: nothing}]}')
        with open(torn, 'wb') as stream:
            stream.write(b'no bag at all')
        self.refused(1, 'lacks joint_trajectory', empty)
        self.refused(1, 'can not be read', torn)
        self.refused(2, 'no bag', os.path.join(self.folder, 'nowhere.bag'))
        self.refused(2, 'neither a bag nor a scenario', 'no_such_scenario')
        self.refused(2, 'moves nothing', still)
        self.refused(2, '--record', 'planar_3r_multipoint')


if __name__ == '__main__':
    unittest.main()
