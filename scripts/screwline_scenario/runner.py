"""Takes the steps of a scenario."""
import os
import time

import rospy
import rosservice
import tf2_ros
from geometry_msgs.msg import Pose, TransformStamped, Vector3

from .bag_check import check_bag
from .expectations import compare
from .expressions import ExpressionError, number
from .messages import FieldError, fill, lookup, pose_from
from .recorder import Recorder, make_room
from .report import formatted, labelled
from .session import NotRunnable, Session, ensure_master

ANSWER_TOLERANCE = 1e-9
SECONDS_TO_ANSWER = 20
SECONDS_TO_CONNECT = 0.5  # of a new publisher with who listens
CALL_KEYS = {'title', 'service', 'q', 'request', 'expect', 'tolerance', 'print'}
ROWS_OF = {'lost_directions': 'task', 'self_motions': 'joint_names', 'task_jacobian': 'joint_names',
           'jacobian': 'joint_names'}  # whose length is the number of columns
COLUMNS_OF = {'modified_dh': 4, 'screw_axes': 6, 'supported_wrenches': 6}


def run_scenario(scenario, report, bag_dir, rviz):
    """Fills the report. `bag_dir`: where bags go, None for no recording. @raise NotRunnable"""
    report.say('%s: %s' % (scenario.name, scenario.description))
    master = ensure_master()
    try:
        rospy.init_node('scenario', disable_signals=True)
        for part in scenario.parts:
            bag = os.path.join(os.path.abspath(bag_dir), scenario.bag_name(part)) if bag_dir else None
            run_part(part, report, bag, rviz)
    finally:
        rospy.signal_shutdown('done')
        if master:
            master.stop()


def run_part(part, report, bag, rviz):
    report.say()
    report.say('robot %s' % part.robot)
    recorder, runner = None, None
    if bag:
        make_room(bag)
    session = Session(part, rviz)
    try:
        session.wait_for_services()
        if bag:
            recorder = Recorder(bag, part.motion)
            recorder.wait_for_connections()
        runner = PartRunner(part, report)
        for kind, content in part.steps:
            session.process.require_running()
            if recorder:
                recorder.require_running()
            runner.take(kind, content)
    finally:
        close([runner, recorder, session])
    if bag:
        check_bag(bag, part, runner.windows(), recorder.topics, report)


def close(things):
    """Stops each, whatever becomes of the others."""
    if things:
        try:
            if things[0]:
                things[0].stop()
        finally:
            close(things[1:])


class PartRunner:
    def __init__(self, part, report):
        self.part, self.report = part, report
        self.mover, self.broadcaster = None, None
        if part.motion:
            from .motion import Mover
            self.mover = Mover(part, report)

    def windows(self):
        return self.mover.windows if self.mover else []

    def stop(self):
        if self.mover:
            self.mover.stop()

    def take(self, kind, content):
        """A step that breaks off counts as failed; the next ones are still taken."""
        count = len(self.report.steps)
        try:
            getattr(self, kind)(content)
        except (FieldError, ExpressionError, rospy.ServiceException, rospy.ROSException) as error:
            if len(self.report.steps) == count:
                self.report.begin(kind)
            self.report.check(kind, str(error) or type(error).__name__)

    def say(self, text):
        self.report.say('    ' + text)

    def wait(self, seconds):
        time.sleep(float(seconds))

    def frame(self, step):
        """A constant frame on tf: {name, parent, xyz, rpy}."""
        transform = TransformStamped(child_frame_id=step['name'])
        transform.header.frame_id, transform.header.stamp = step['parent'], rospy.Time.now()
        pose = pose_from(Pose(), step, self.part.values)
        transform.transform.translation = Vector3(pose.position.x, pose.position.y, pose.position.z)
        transform.transform.rotation = pose.orientation
        self.broadcaster = tf2_ros.StaticTransformBroadcaster()
        self.broadcaster.sendTransform(transform)
        time.sleep(SECONDS_TO_CONNECT)

    def move(self, step):
        if self.mover is None:
            raise FieldError('this part has motion: false')
        self.mover.move(step)

    def call(self, step):
        unknown = set(step) - CALL_KEYS
        if unknown:
            raise FieldError('call: unknown keys %s' % ', '.join(sorted(unknown)))
        service = '/kinematics_server/' + step['service'] if '/' not in step['service'] else step['service']
        self.report.begin(step.get('title', step['service']))
        rospy.wait_for_service(service, SECONDS_TO_ANSWER)
        service_class = rosservice.get_service_class_by_name(service)
        request = fill(service_class._request_class(), step.get('request', {}), self.part.values)
        if 'q' in step:
            request.joint_state.position = fill(type(request.joint_state)(), {'position': step['q']}, self.part.values).position
        self.judge(step, rospy.ServiceProxy(service, service_class)(request))

    def judge(self, step, answer):
        expected = dict({'success': True}, **step.get('expect', {}))
        for path in step.get('print', []):
            self.report.detail(labelled(path, formatted(lookup(answer, path), columns(answer, path))))
        if answer.message:
            self.report.detail('says: ' + answer.message)
        for path, wanted in expected.items():
            problem, deviation = compare(lookup(answer, path), wanted, number(step.get('tolerance', ANSWER_TOLERANCE)), self.part.values)
            self.report.check(path, problem, deviation)


def columns(answer, path):
    if path in ROWS_OF:
        return max(1, len(getattr(answer, ROWS_OF[path])))
    return COLUMNS_OF.get(path)
