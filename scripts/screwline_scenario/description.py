"""Reads config/scenarios/NAME.yaml and refuses what it can not mean.

A scenario has a `description` and either a `robot` with its `steps`, or several such in a list of `parts`. Besides:
`rate` [Hz] of the streams; `motion: false` where no trajectory_generator is needed; `values`, names for the part's
numbers; `parameters`, private ones by node.
"""
import os

import rospkg
import yaml

from .expressions import ExpressionError, number

PART_KEYS = {'robot', 'steps', 'rate', 'motion', 'values', 'parameters'}
STEP_KINDS = {'say', 'call', 'frame', 'move', 'wait'}


class DescriptionError(Exception):
    """The scenario's file is missing or not as it has to be."""


class Part:
    """One robot and the steps to take with it."""

    def __init__(self, data, where):
        unknown = set(data) - PART_KEYS
        if unknown:
            raise DescriptionError('%s: unknown keys %s' % (where, ', '.join(sorted(unknown))))
        for key in ('robot', 'steps'):
            if not data.get(key):
                raise DescriptionError('%s has no %s' % (where, key))
        self.robot = data['robot']
        self.rate = float(data.get('rate', 100))
        self.motion = data.get('motion', True)
        self.parameters = data.get('parameters', {})
        self.values = {}
        for name, value in data.get('values', {}).items():
            self.values[name] = evaluated(value, self.values, '%s: values.%s' % (where, name))
        self.steps = [checked_step(step, '%s: steps[%d]' % (where, i)) for i, step in enumerate(data['steps'])]


class Scenario:
    def __init__(self, name, data):
        if not isinstance(data, dict):
            raise DescriptionError('%s is no mapping' % name)
        self.name = name
        self.description = data.pop('description', '')
        parts = data.pop('parts', None)
        if parts is None:
            parts = [data]
        elif data:
            raise DescriptionError('%s: %s beside parts' % (name, ', '.join(sorted(data))))
        self.parts = [Part(part, '%s: parts[%d]' % (name, i)) for i, part in enumerate(parts)]

    def bag_name(self, part):
        return self.name + ('-' + part.robot if len(self.parts) > 1 else '') + '.bag'


def evaluated(value, values, where):
    try:
        return number(value, values)
    except ExpressionError as error:
        raise DescriptionError('%s: %s' % (where, error)) from error


def checked_step(step, where):
    """(kind, content) of a step."""
    if not isinstance(step, dict) or len(step) != 1 or next(iter(step)) not in STEP_KINDS:
        raise DescriptionError('%s must have one key, of %s' % (where, ', '.join(sorted(STEP_KINDS))))
    return next(iter(step.items()))


def package_path():
    return rospkg.RosPack().get_path('screwline')


def scenario_names():
    folder = os.path.join(package_path(), 'config', 'scenarios')
    return sorted(entry[:-len('.yaml')] for entry in os.listdir(folder) if entry.endswith('.yaml'))


def load_scenario(name, rate=None):
    """A scenario by its name or its file; `rate` replaces those in it. @raise DescriptionError"""
    path = name if name.endswith('.yaml') else os.path.join(package_path(), 'config', 'scenarios', name + '.yaml')
    try:
        with open(path) as stream:
            data = yaml.safe_load(stream)
    except (OSError, yaml.YAMLError) as error:
        raise DescriptionError('scenario %s: %s; known are %s' % (name, error, ', '.join(scenario_names()))) from error
    scenario = Scenario(os.path.basename(path)[:-len('.yaml')], data)
    for part in scenario.parts:
        part.rate = rate or part.rate
    return scenario
