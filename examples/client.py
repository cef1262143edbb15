#!/usr/bin/python3
"""A client of screwline in Python: every way to reach a pose, the best of them explained, and a motion there.

    roslaunch screwline bringup.launch robot:=planar_3r     # in one terminal
    rosrun screwline client.py                              # in another

Works with every robot. Without trajectory_generator nothing moves.
"""
import math
import sys

import rospy
import rosservice
from geometry_msgs.msg import WrenchStamped
from screwline.msg import Waypoint
from screwline.srv import (AnalyzeSingularity, ComputeFK, ComputeIK, ComputeStatics, Describe, ExecuteTrajectory,
                           PlanTrajectory)
from sensor_msgs.msg import JointState

LONGEST_WAIT = 20.0  # s


class Refused(Exception):
    """A service answered, and its answer is no."""


def ask(service, service_type, **request):
    """Calls a service by its fields. An answer without success says in its message which input broke which bound."""
    answer = rospy.ServiceProxy(service, service_type)(**request)
    if not answer.success:
        raise Refused('%s: error %d: %s' % (service, answer.error_code, answer.message))
    return answer


def numbers(values):
    return ' '.join('%8.4f' % value for value in values)


def some_configuration(robot):
    """Joint values inside the limits, and away from where most arms are singular."""
    wanted = [0.5 + 0.2 * i for i in range(len(robot.joint_names))]
    return [min(max(value, lower), upper) for value, lower, upper in zip(wanted, robot.lower, robot.upper)]


def best_solution(pose):
    """All solutions for a pose of the tip, of which the one with the greatest manipulability is the best."""
    answer = ask('kinematics_server/compute_ik', ComputeIK, pose=pose)
    print('%s, %s:' % (answer.message, 'complete' if answer.complete else 'there may be more'))
    for solution in answer.solutions:
        print('  %s  %s' % (numbers(solution.position), solution.branch))
    return max(answer.solutions, key=lambda solution: round(solution.manipulability, 9))  # of equals the nearest


def explain(joints):
    """What the arm can do at a configuration: how far it is from a singularity, and what a push of 10 N costs it."""
    analysis = ask('kinematics_server/analyze_singularity', AnalyzeSingularity, joint_state=joints)
    print('manipulability %.4f, %.4f from the nearest singularity' % (
        analysis.manipulability, analysis.distance_to_singularity))
    for condition in analysis.conditions:
        print('  %s: %s, here %.4f' % (condition.name, condition.expression, condition.value))
    push = WrenchStamped()
    push.wrench.force.x = 10.0  # of the tool on the environment
    efforts = ask('kinematics_server/compute_statics', ComputeStatics, joint_state=joints, wrench=push)
    print('efforts for a push of 10 N along x: %s' % numbers(efforts.effort))


def present_position(joint_names):
    """Joint values in the chain's order; a JointState may have any order, and other joints too."""
    state = rospy.wait_for_message('joint_states', JointState, LONGEST_WAIT)
    value_of = dict(zip(state.name, state.position))
    return [value_of[name] for name in joint_names]


def move_to(pose, goal, joint_names):
    """Plans a motion to the pose on the goal's branch, in the shortest time at half the speed limits; does it."""
    start = Waypoint(position=present_position(joint_names))
    plan = ask('trajectory_generator/plan', PlanTrajectory, profile='minimum_jerk', velocity_scaling=0.5,
               waypoints=[start, Waypoint(pose=pose, branch=goal.branch)])
    print('planned: %.3f s, tool path %.3f m, peak speed %.3f m/s' % (
        plan.duration, plan.metrics.path_length, plan.metrics.peak_speed))
    ask('trajectory_generator/execute', ExecuteTrajectory)
    planned_goal = plan.trajectory.points[-1].positions
    deadline = rospy.Time.now() + rospy.Duration(plan.duration + LONGEST_WAIT)
    while math.dist(present_position(joint_names), planned_goal) > 1e-6:
        if rospy.Time.now() > deadline:
            raise Refused('the motion did not arrive')
    print('arrived at %s' % numbers(planned_goal))


def main():
    rospy.init_node('screwline_client', anonymous=True)
    rospy.wait_for_service('kinematics_server/describe', LONGEST_WAIT)
    robot = ask('kinematics_server/describe', Describe)
    print('%s to %s: %s' % (robot.base_link, robot.tip_link, ', '.join(robot.joint_names)))
    print('task %s, %s' % (' '.join(robot.task), robot.ik_method))

    joints = JointState(name=robot.joint_names, position=some_configuration(robot))
    pose = ask('kinematics_server/compute_fk', ComputeFK, joint_state=joints).poses[0]
    best = best_solution(pose)
    explain(JointState(name=robot.joint_names, position=best.position))

    if '%s/plan' % rospy.resolve_name('trajectory_generator') in rosservice.get_service_list():
        move_to(pose, best, robot.joint_names)


if __name__ == '__main__':
    try:
        main()
    except (Refused, rospy.ROSException) as error:
        sys.exit('client.py: %s' % error)
