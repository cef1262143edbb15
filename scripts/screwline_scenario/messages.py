"""Messages from what a scenario's YAML says, and numbers out of messages."""
import math

import genpy
import roslib.message

from .expressions import ExpressionError, number, numbers


class FieldError(Exception):
    """A request names a field that the message does not have, or gives it what it can not hold."""


def fill(message, data, values):
    """Sets the fields of a message that `data` names."""
    for field, given in data.items():
        if field not in message.__slots__:
            raise FieldError('%s has no field %s' % (message._type, field))
        field_type = message._slot_types[message.__slots__.index(field)]
        try:
            setattr(message, field, converted(field_type, given, values))
        except (ExpressionError, TypeError, ValueError) as error:
            raise FieldError('%s.%s: %s' % (message._type, field, error)) from error
    return message


def converted(field_type, given, values):
    if field_type.endswith('[]'):
        element = field_type[:-2]
        if is_number(element):
            return [cast(element, x) for x in numbers(given, values)]
        return [converted(element, item, values) for item in given]
    if is_number(field_type):
        return cast(field_type, number(given, values))
    if field_type in ('string', 'bool'):
        return {'string': str, 'bool': bool}[field_type](given)
    message = roslib.message.get_message_class(field_type)()
    if field_type == 'geometry_msgs/Pose' and set(given) <= {'xyz', 'rpy'}:
        return pose_from(message, given, values)
    if isinstance(given, list):  # the three numbers of a Point or Vector3
        given = dict(zip(message.__slots__, given))
    return fill(message, given, values)


def is_number(field_type):
    return field_type.startswith(('float', 'int', 'uint'))


def cast(field_type, value):
    return value if field_type.startswith('float') else int(value)


def pose_from(message, given, values):
    """A pose of xyz [m] and roll, pitch, yaw [rad] about fixed axes."""
    position = numbers(given.get('xyz', [0, 0, 0]), values)
    quaternion = quaternion_from(*numbers(given.get('rpy', [0, 0, 0]), values))
    message.position.x, message.position.y, message.position.z = position
    message.orientation.x, message.orientation.y, message.orientation.z, message.orientation.w = quaternion
    return message


def quaternion_from(roll, pitch, yaw):
    cr, cp, cy = (math.cos(angle / 2) for angle in (roll, pitch, yaw))
    sr, sp, sy = (math.sin(angle / 2) for angle in (roll, pitch, yaw))
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def lookup(message, path):
    """The value at a dotted path; a list on the way gives the list of its elements' values."""
    for name in path.split('.'):
        if isinstance(message, (list, tuple)):
            message = [getattr(element, name) for element in message]
        elif not hasattr(message, name):
            raise FieldError('%s has no field %s' % (message._type, name))
        else:
            message = getattr(message, name)
    return message


def flattened(value):
    """The numbers of a value: of a message those of its fields in order, headers left out."""
    if isinstance(value, genpy.Message):
        fields = [name for name in value.__slots__ if name != 'header']
        return [x for name in fields for x in flattened(getattr(value, name))]
    if isinstance(value, (list, tuple)):
        return [x for element in value for x in flattened(element)]
    return [float(value)]
