"""A step that plans a motion, has it streamed, and holds the stream against the plan."""
import csv
import os

import numpy as np
import rospy
from screwline.msg import Waypoint
from screwline.srv import ExecuteTrajectory, PlanTrajectory, PlanTrajectoryRequest

from .description import package_path
from .expressions import number, numbers
from .messages import FieldError, fill, lookup
from .expectations import compare, compare_numbers
from .report import formatted, labelled
from .streams import MotionStreams, between, interpolated, samples_of

SECONDS_TO_START = 5  # that a motion may take to begin after its execution was asked for
MOVE_KEYS = {'title', 'profile', 'waypoints', 'duration', 'parameters', 'scaling', 'expect', 'tolerance', 'print', 'at', 'table'}
ANSWER_TOLERANCE = 1e-9
STREAM_TOLERANCE = 1e-6
SHAPE_TOLERANCE = 1e-4  # where the plan is only known at its samples
REST = 1e-7  # [rad or m] nearer to its first waypoint a motion begins without a transfer


class Mover:
    def __init__(self, part, report):
        self.part, self.report = part, report
        self.plan = rospy.ServiceProxy('/trajectory_generator/plan', PlanTrajectory)
        self.execute = rospy.ServiceProxy('/trajectory_generator/execute', ExecuteTrajectory)
        self.streams = MotionStreams()
        self.windows = []  # (first stamp, duration) of each motion streamed

    def stop(self):
        self.streams.stop()

    def move(self, step):
        unknown = set(step) - MOVE_KEYS
        if unknown:
            raise FieldError('move: unknown keys %s' % ', '.join(sorted(unknown)))
        request = self.request(step)
        self.report.begin(step.get('title', 'move by %s' % request.profile))
        answer = self.plan(request)
        self.judge_answer(step, answer)
        if answer.success and self.go_to(answer.trajectory.points[0].positions):
            answer = self.plan(request)
            self.stream(answer)
            self.judge_stream(answer)
            for instant in step.get('at', []):
                self.judge_instant(instant, answer.duration)
            if 'table' in step:
                self.judge_table(step['table'])

    def request(self, step):
        request = PlanTrajectoryRequest(profile=step['profile'])
        request.duration = number(step.get('duration', 0), self.part.values)
        for given in step.get('waypoints', []):
            data = {'position': given} if isinstance(given, list) else given
            if 'xyz' in data or 'rpy' in data:
                data = dict({'pose': {'pose': {k: data[k] for k in ('xyz', 'rpy') if k in data}}},
                            **{k: v for k, v in data.items() if k not in ('xyz', 'rpy')})
            request.waypoints.append(fill(Waypoint(), data, self.part.values))
        for name, value in step.get('parameters', {}).items():
            request.parameter_names.append(name)
            request.parameter_values.append(number(value, self.part.values))
        return request

    def judge_answer(self, step, answer):
        expected = dict({'success': True}, **step.get('expect', {}))
        if not answer.success:
            self.report.detail('error %d: %s' % (answer.error_code, answer.message))
        for path, wanted in expected.items():
            problem, deviation = compare(lookup(answer, path), wanted, number(step.get('tolerance', ANSWER_TOLERANCE)), self.part.values)
            self.report.check(path, problem, deviation)
        if not answer.success:
            return
        metrics = answer.metrics
        self.report.detail('%.4f s; peak velocity %s, acceleration %s, jerk %s; path %.4f m' % (
            answer.duration, formatted(max(metrics.peak_velocity)), formatted(max(metrics.peak_acceleration)),
            formatted(max(metrics.peak_jerk)), metrics.path_length))
        if answer.message:
            self.report.detail('says: ' + answer.message)
        for path in step.get('print', []):
            self.report.detail(labelled(path, formatted(lookup(answer, path), len(answer.joint_names))))

    def go_to(self, start):
        """Moves to where a motion begins. False where that failed."""
        self.streams.wait_for(lambda: self.streams.position() is not None, SECONDS_TO_START)
        here = self.streams.position()
        if here is None:
            self.report.check('joint_states', 'nobody publishes them')
            return False
        if np.abs(np.array(here) - np.array(start)).max() < REST:
            return True
        request = PlanTrajectoryRequest(profile='polynomial_345')
        request.waypoints = [Waypoint(position=list(here)), Waypoint(position=list(start))]
        transfer = self.plan(request)
        if not transfer.success:
            self.report.check('transfer to the start', transfer.message)
            return False
        return self.stream(transfer)

    def stream(self, planned):
        """Executes the last plan and waits until it is over."""
        before = self.streams.trajectory
        answer = self.execute()
        if not answer.success:
            self.report.check('execute', answer.message)
            return False
        if not self.streams.wait_for(lambda: self.streams.trajectory is not before, SECONDS_TO_START):
            self.report.check('joint_trajectory', 'nothing was published')
            return False
        announced = self.streams.trajectory
        lead = announced.points[-1].time_from_start.to_sec() - planned.duration
        begin = announced.header.stamp + rospy.Duration(max(lead, 0.0))
        end = begin + rospy.Duration(planned.duration + 2.0 / self.part.rate)
        over = self.streams.wait_for(lambda: self.streams.states.latest()[0] >= end,
                                     planned.duration + SECONDS_TO_START)
        if not over:
            self.report.check('joint_states', 'ended before the motion did')
            return False
        rospy.sleep(0.05)  # what other topics say of the last sample
        self.windows.append((begin, planned.duration))
        return True

    def window(self, topic='joint_states'):
        begin, duration = self.windows[-1]
        seconds, rows = self.streams.topics[topic].since(begin)
        return between(seconds, rows, 0.0, duration)

    def judge_stream(self, answer):
        """The stream is dense, in order, and what was planned."""
        seconds, rows = self.window()
        expected = samples_of(answer.duration, self.part.rate)
        self.report.check('%d samples streamed' % len(seconds), '' if len(seconds) == expected else 'expected %d' % expected)
        problem = '' if len(seconds) > 1 and np.diff(seconds).min() > 0 else 'they are not'
        self.report.check('stamps increase', problem)
        if problem:
            return
        times = np.array([point.time_from_start.to_sec() for point in answer.trajectory.points])
        planned = np.array([point.positions for point in answer.trajectory.points])
        inner = [i for i, t in enumerate(seconds) if times[2] < t < times[-3]] if len(times) > 8 else []
        streamed = [x for i in inner for x in rows[i][:planned.shape[1]]]
        wanted = [x for i in inner for x in interpolated(times, planned, seconds[i])]
        self.report.check('stream as planned', *compare_numbers(streamed, wanted, SHAPE_TOLERANCE))
        last = list(self.streams.position())
        self.report.check('ends at the goal', *compare_numbers(last, list(planned[-1]), ANSWER_TOLERANCE))

    def judge_instant(self, instant, duration):
        """{time or tau, topic: [numbers], ...} against the streams there."""
        time = number(instant['tau'], self.part.values) * duration if 'tau' in instant else number(instant['time'], self.part.values)
        for topic in set(instant) - {'time', 'tau', 'tolerance'}:
            wanted = numbers(instant[topic], self.part.values)
            found = list(interpolated(*self.window(topic), time)[:len(wanted)])
            self.report.detail(labelled('%s at %.3f s' % (topic, time), formatted(found)))
            self.report.check(topic, *compare_numbers(found, wanted, number(instant.get('tolerance', STREAM_TOLERANCE))))

    def judge_table(self, table):
        """Streams against the columns of a CSV file at its instants."""
        path = os.path.join(package_path(), table['file'])
        tolerance = number(table.get('tolerance', STREAM_TOLERANCE))
        with open(path) as stream:
            rows = list(csv.DictReader(stream))
        for topic, columns in table['columns'].items():
            seconds, values = self.window(topic)
            worst, when = 0.0, 0.0
            for row in rows:
                found = interpolated(seconds, values, float(row[table['time']]))[:len(columns)]
                off = max(abs(x - float(row[column])) for x, column in zip(found, columns))
                worst, when = max((worst, when), (off, float(row[table['time']])))
            problem = '' if worst <= tolerance else 'off by %.2g at %.2f s' % (worst, when)
            self.report.check('%s at %d instants of %s' % (topic, len(rows), os.path.basename(path)), problem, worst)
