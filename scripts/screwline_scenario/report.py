"""What a scenario says: each line starts with [scenario], the summary comes last."""
import genpy
import numpy as np

from .messages import flattened

WIDTH = 60


class Report:
    def __init__(self):
        self.steps = []  # [title, what is wrong with it]
        self.deviations = {}  # index of the step: largest deviation relative to its tolerance, as a text

    def say(self, text=''):
        for line in text.split('\n'):
            print(('[scenario] ' + line).rstrip(), flush=True)

    def begin(self, title):
        self.steps.append([title, []])
        self.say('%2d. %s' % (len(self.steps), title))

    def detail(self, text):
        self.say('\n'.join('      ' + line for line in text.split('\n')))

    def check(self, what, problem, deviation=None):
        """One expectation of the present step; `problem` is empty where it is met."""
        if problem:
            self.steps[-1][1].append('%s: %s' % (what, problem))
        shown = '' if deviation is None else ' (off by %.1e)' % deviation
        self.detail('%-6s %s%s%s' % ('FAILED' if problem else 'ok', what, shown, ': ' + problem if problem else ''))
        if deviation is not None:
            worst = self.deviations.get(len(self.steps), 0.0)
            self.deviations[len(self.steps)] = max(worst, deviation)

    def failed(self):
        return [step for step in self.steps if step[1]]

    def summary(self):
        """Prints the summary; the exit code."""
        self.say()
        self.say('summary')
        for i, (title, problems) in enumerate(self.steps, start=1):
            deviation = self.deviations.get(i)
            shown = '' if deviation is None else 'off by at most %.1e' % deviation
            self.say('%2d. %-6s %-*s %s' % (i, 'FAILED' if problems else 'OK', WIDTH, title[:WIDTH], shown))
            for problem in problems:
                self.say('           %s' % problem)
        failures = len(self.failed())
        done = 'OK: %d steps as expected' % len(self.steps)
        self.say('FAILED: %d of %d steps' % (failures, len(self.steps)) if failures else done)
        return 1 if failures else 0


def formatted(value, columns=None):
    """A value as a table shows it; lists of numbers in rows of `columns`."""
    if isinstance(value, genpy.Message):
        value = flattened(value)
    if isinstance(value, float):
        return '%.6g' % value
    if isinstance(value, (list, tuple, np.ndarray)) and len(value) and isinstance(value[0], (int, float)):
        columns = columns if columns and len(value) % columns == 0 else len(value)
        rows = np.array(value, dtype=float).reshape(-1, columns)
        return '\n'.join(' '.join('%10s' % ('%.5g' % (x + 0.0 if abs(x) > 5e-13 else 0.0)) for x in row) for row in rows)
    if isinstance(value, (list, tuple)):
        return '\n'.join(formatted(item, columns) for item in value) if value else '(none)'
    return str(value)


def labelled(label, text):
    """A label beside the first of several lines."""
    lines = text.split('\n')
    return '\n'.join('%-22s %s' % (label if i == 0 else '', line) for i, line in enumerate(lines))
