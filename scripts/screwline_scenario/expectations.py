"""What is expected of an answer, and whether it is so.

An expectation is a plain value (numbers within the tolerance, texts and booleans equal), or a mapping with one of
  contains: TEXT     the text contains it          count: N       the list has so many elements
  rows: [[..], ..]   the lists of angles are these, in any order, modulo full turns
  includes: [..]     one of the lists of angles is this, modulo full turns
  along: [..]        parallel to this vector, either way         min: X, max: X    within these bounds
"""
import math

import numpy as np

from .expressions import number, numbers
from .messages import flattened

CHECKS = {}


def check(name):
    def register(function):
        CHECKS[name] = function
        return function
    return register


def compare(actual, expected, tolerance, values):
    """(what is wrong or '', deviation or None)"""
    if isinstance(expected, dict):
        for name, wanted in expected.items():
            if name not in CHECKS:
                return 'no such check: %s' % name, None
            problem, deviation = CHECKS[name](actual, wanted, tolerance, values)
            if problem:
                break
        return problem, deviation
    if isinstance(actual, (bool, str)):
        return ('' if actual == expected else 'is %r, expected %r' % (actual, expected)), None
    if isinstance(expected, list) and any(isinstance(item, str) for item in actual_list(actual)):
        return ('' if list(actual) == expected else 'is %s, expected %s' % (actual, expected)), None
    return compare_numbers(flattened(actual), numbers(expected, values), tolerance)


def actual_list(actual):
    return actual if isinstance(actual, (list, tuple)) else []


def compare_numbers(found, wanted, tolerance):
    if len(found) != len(wanted):
        return 'has %d numbers, expected %d' % (len(found), len(wanted)), None
    if not wanted:
        return '', 0.0
    differences = [0.0 if a == b else abs(a - b) for a, b in zip(found, wanted)]
    if any(math.isnan(x) for x in differences):
        return 'is not a number', None
    worst = int(np.argmax(differences))
    if differences[worst] <= tolerance:
        return '', differences[worst]
    return 'is %.9g%s, expected %.9g within %.1g' % (
        found[worst], ' at [%d]' % worst if len(wanted) > 1 else '', wanted[worst], tolerance), differences[worst]


def turned_off(a, b):
    """Largest difference of two lists of angles, modulo full turns."""
    return max(abs(math.remainder(x - y, 2 * math.pi)) for x, y in zip(a, b)) if len(a) == len(b) else math.inf


def nearest_off(row, others):
    return min((turned_off(row, other) for other in others), default=math.inf)


def row_text(row):
    return '(' + ', '.join('%.6g' % x for x in row) + ')'


@check('contains')
def _contains(actual, wanted, _, __):
    return ('' if wanted in str(actual) else '"%s" does not contain "%s"' % (actual, wanted)), None


@check('count')
def _count(actual, wanted, _, values):
    return ('' if len(actual) == number(wanted, values) else 'has %d, expected %s' % (len(actual), wanted)), None


@check('rows')
def _rows(actual, wanted, tolerance, values):
    found = [list(row) for row in actual]
    rows = [numbers(row, values) for row in wanted]
    if len(found) != len(rows):
        return 'are %d: %s; expected %d' % (len(found), ' '.join(row_text(row) for row in found), len(rows)), None
    worst = max((nearest_off(row, found) for row in rows), default=0.0)
    missing = [row for row in rows if nearest_off(row, found) > tolerance]
    return ('lack %s' % row_text(missing[0]) if missing else ''), worst


@check('includes')
def _includes(actual, wanted, tolerance, values):
    row = numbers(wanted, values)
    off = nearest_off(row, [list(other) for other in actual])
    return ('' if off <= tolerance else 'lack %s' % row_text(row)), off


@check('along')
def _along(actual, wanted, tolerance, values):
    a, b = np.array(flattened(actual)), np.array(numbers(wanted, values))
    if a.shape != b.shape:
        return 'has %d numbers, expected %d' % (a.size, b.size), None
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    off = float(min(np.abs(a - b).max(), np.abs(a + b).max()))
    return ('' if off <= tolerance else 'is %s, expected along %s' % (row_text(a), row_text(b))), off


@check('min')
def _min(actual, wanted, _, values):
    least = min(flattened(actual))
    return ('' if least >= number(wanted, values) else 'is %.9g, below %s' % (least, wanted)), None


@check('max')
def _max(actual, wanted, _, values):
    most = max(flattened(actual))
    return ('' if most <= number(wanted, values) else 'is %.9g, above %s' % (most, wanted)), None
