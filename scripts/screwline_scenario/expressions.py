"""Numbers of a scenario may be written as arithmetic: "pi/2", "deg(60)", "L1*cos(th1)"."""
import ast
import math
import operator

OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos,
}
FUNCTIONS = {'sqrt': math.sqrt, 'sin': math.sin, 'cos': math.cos, 'deg': math.radians, 'abs': abs, 'atan2': math.atan2}
CONSTANTS = {'pi': math.pi, 'inf': math.inf}


class ExpressionError(ValueError):
    """The text is no arithmetic, or names something unknown."""


def evaluate(text, values=None):
    """The number that a text stands for; `values` are the variables it may name."""
    names = dict(CONSTANTS, **(values or {}))
    try:
        return float(value_of(ast.parse(text.strip(), mode='eval').body, names))
    except (SyntaxError, KeyError, TypeError, ValueError, ZeroDivisionError) as error:
        raise ExpressionError('"%s" is no number: %s' % (text, error)) from error


def value_of(node, names):
    if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        return node.value
    if isinstance(node, ast.Name):
        return names[node.id]
    if isinstance(node, ast.UnaryOp):
        return OPERATORS[type(node.op)](value_of(node.operand, names))
    if isinstance(node, ast.BinOp):
        return OPERATORS[type(node.op)](value_of(node.left, names), value_of(node.right, names))
    if isinstance(node, ast.Call) and not node.keywords:
        return FUNCTIONS[node.func.id](*[value_of(argument, names) for argument in node.args])
    raise ValueError('only arithmetic is allowed')


def numbers(tree, values=None):
    """A list of numbers out of nested lists of numbers and texts, flattened."""
    if isinstance(tree, (list, tuple)):
        return [number for branch in tree for number in numbers(branch, values)]
    if isinstance(tree, bool) or not isinstance(tree, (int, float, str)):
        raise ExpressionError('%r is no number' % (tree,))
    return [evaluate(tree, values) if isinstance(tree, str) else float(tree)]


def number(leaf, values=None):
    found = numbers(leaf, values)
    if len(found) != 1:
        raise ExpressionError('%r is no number' % (leaf,))
    return found[0]
