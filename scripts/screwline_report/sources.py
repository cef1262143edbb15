"""Which bags are meant, and what is known of the scenario that each was recorded from."""
import os
import xml.etree.ElementTree as ElementTree

from screwline_scenario.description import DescriptionError, load_scenario, package_path, scenario_names


class NoBag(Exception):
    """There is no bag of that name."""


class Source:
    """A bag, and the part of a scenario that it is of; None where it is of none."""

    def __init__(self, path, part=None, description=''):
        self.path, self.part, self.description = path, part, description

    @property
    def name(self):
        return os.path.splitext(os.path.basename(self.path))[0]

    def joint_types(self):
        """{joint: 'revolute', ...} of the scenario's robot; empty where that is not known."""
        if self.part is None:
            return {}
        robot = self.part.robot
        path = robot if robot.endswith('.urdf') else os.path.join(package_path(), 'urdf', robot + '.urdf')
        return {joint.get('name'): joint.get('type') for joint in ElementTree.parse(path).getroot().findall('joint')}


def find_bags(name, bag_dir):
    """The bags of a scenario, or the one bag that is named. @raise NoBag"""
    if name.endswith('.bag'):
        if not os.path.isfile(name):
            raise NoBag('no bag %s' % name)
        return [source_of(name)]
    try:
        scenario = load_scenario(name)
    except DescriptionError as error:
        raise NoBag('%s is neither a bag nor a scenario: %s' % (name, error)) from error
    sources = [Source(os.path.join(bag_dir, scenario.bag_name(part)), part, scenario.description)
               for part in scenario.parts if part.motion]
    if not sources:
        raise NoBag('scenario %s moves nothing, there is nothing to draw' % name)
    missing = [source.path for source in sources if not os.path.isfile(source.path)]
    if missing:
        raise NoBag('no bag %s: record it by `rosrun screwline scenario %s --record`' % (missing[0], name))
    return sources


def source_of(path):
    """A bag is of the scenario whose bags have its name."""
    for name in scenario_names():
        scenario = load_scenario(name)
        for part in scenario.parts:
            if scenario.bag_name(part) == os.path.basename(path):
                return Source(path, part, scenario.description)
    return Source(path)
