"""What the rostests of kinematics_server share: the server, robots of golden models, messages as matrices."""
import math
import xml.etree.ElementTree as ElementTree

import numpy as np
from geometry_msgs.msg import Pose
from node_support import ServedNode
from screwline.srv import (AnalyzeSingularity, ComputeFK, ComputeFKBatch, ComputeIK, ComputeIKBatch, ComputeJacobian,
                           ComputeStatics, ComputeVelocity, Derive, Describe)
from sensor_msgs.msg import JointState


class Server(ServedNode):
    NODE = 'kinematics_server'
    SERVICES = {
        'describe': Describe,
        'derive': Derive,
        'compute_fk': ComputeFK,
        'compute_fk_batch': ComputeFKBatch,
        'compute_ik': ComputeIK,
        'compute_ik_batch': ComputeIKBatch,
        'compute_jacobian': ComputeJacobian,
        'analyze_singularity': AnalyzeSingularity,
        'compute_statics': ComputeStatics,
        'compute_velocity': ComputeVelocity,
    }


def rpy_of(rotation):
    """Roll, pitch, yaw of a rotation matrix, R = Rz(yaw) Ry(pitch) Rx(roll)."""
    pitch = math.atan2(-rotation[2][0], math.hypot(rotation[0][0], rotation[1][0]))
    if abs(math.cos(pitch)) < 1e-12:
        return math.atan2(-rotation[1][2], rotation[1][1]), pitch, 0.0
    return math.atan2(rotation[2][1], rotation[2][2]), pitch, math.atan2(rotation[1][0], rotation[0][0])


def add_joint(robot, name, kind, child, xyz, rpy=(0, 0, 0), axis=None):
    parent = robot.findall('link')[-1].get('name')
    joint = ElementTree.SubElement(robot, 'joint', name=name, type=kind)
    ElementTree.SubElement(joint, 'parent', link=parent)
    ElementTree.SubElement(joint, 'child', link=child)
    ElementTree.SubElement(joint, 'origin', xyz=' '.join(map(repr, xyz)), rpy=' '.join(map(repr, rpy)))
    if axis is not None:
        ElementTree.SubElement(joint, 'axis', xyz=' '.join(map(repr, axis)))
        ElementTree.SubElement(joint, 'limit', lower='-10', upper='10', effort='100', velocity='2')
    ElementTree.SubElement(robot, 'link', name=child)


def golden_urdf(model):
    """A robot of a golden model, made from its screw axes and home pose alone."""
    robot = ElementTree.Element('robot', name='golden')
    ElementTree.SubElement(robot, 'link', name='base_link')
    place = np.zeros(3)
    for number, (joint, screw) in enumerate(zip(model['joints'], model['screw_axes_space_w_v']), start=1):
        w, v = np.array(screw[:3]), np.array(screw[3:])
        turns = joint['type'] != 'prismatic'
        point = np.cross(w, v) if turns else place
        axis = w if turns else v
        add_joint(robot, joint['name'], joint['type'], 'link%d' % number, (point - place).tolist(), axis=axis.tolist())
        place = point
    home = np.array(model['home_pose'])
    add_joint(robot, 'tool', 'fixed', 'tool0', (home[:3, 3] - place).tolist(), rpy_of(home))
    return ElementTree.tostring(robot, encoding='unicode')


def state(position, name=(), velocity=()):
    return JointState(name=list(name), position=list(position), velocity=list(velocity))


def matrix(values, columns):
    return np.array(values, dtype=float).reshape(-1, columns)


def rotation_of(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def pose_matrix(pose):
    result = np.eye(4)
    result[:3, :3] = rotation_of(pose.orientation)
    result[:3, 3] = (pose.position.x, pose.position.y, pose.position.z)
    return result


def quaternion_of(rotation):
    """x y z w of a rotation matrix: the eigenvector of the largest eigenvalue (Bar-Itzhack)."""
    r = np.array(rotation)
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], r[1, 0] + r[0, 1], r[2, 0] + r[0, 2], r[2, 1] - r[1, 2]],
                  [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]],
                  [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
                  [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]]])
    return np.linalg.eigh(k)[1][:, 3]


def pose_message(transform):
    transform = np.array(transform)
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = (float(value) for value in transform[:3, 3])
    quaternion = (float(value) for value in quaternion_of(transform[:3, :3]))
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = quaternion
    return pose
