"""The golden files and the shipped robots, as tests read them."""
import functools
import os

import yaml

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GOLDEN = os.path.join(ROOT, 'test', 'data', 'golden')
TASK_OF = {
    'xy': ['x', 'y'],
    'xy_phi': ['x', 'y', 'rz'],
    'xyz': ['x', 'y', 'z'],
    'xyz_phi': ['x', 'y', 'z', 'rz'],
    'R': ['rx', 'ry', 'rz'],
    'pose': ['x', 'y', 'z', 'rx', 'ry', 'rz'],
}


def read_text(*parts):
    with open(os.path.join(ROOT, *parts)) as stream:
        return stream.read()


@functools.lru_cache(maxsize=None)
def golden(name):
    return yaml.load(read_text('test', 'data', 'golden', name + '.yaml'), getattr(yaml, 'CSafeLoader', yaml.SafeLoader))


def golden_names():
    return sorted(name[:-len('.yaml')] for name in os.listdir(GOLDEN) if name.endswith('.yaml'))


def robot_config(robot):
    return yaml.safe_load(read_text('config', 'robots', robot + '.yaml'))
