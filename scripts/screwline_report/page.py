"""The page of a report: HTML with everything in it, the figures too."""
import base64
import html
import math
import os

STYLE = """
body { font: 16px/1.5 sans-serif; color: #1a1a1a; background: #ffffff; max-width: 1100px; margin: 2em auto; padding: 0 1em; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2em; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
div.wide { overflow-x: auto; }
th, td { padding: 0.3em 0.8em; border-bottom: 1px solid #d0d0d0; text-align: right; white-space: nowrap; }
th { text-align: right; vertical-align: bottom; font-weight: 600; } th.text, td.text { text-align: left; }
td.over { background: #ffe3d3; font-weight: 600; }
img { max-width: 100%; } figure { margin: 0; } figcaption { color: #444444; }
"""
WITHIN = 1.0 + 1e-6  # A share of a limit beyond it is over the limit.


def write_page(recording, figures, folder):
    """Writes index.html. Its path."""
    parts = ['<!DOCTYPE html>', '<html lang="en">', '<head>', '<meta charset="utf-8">',
             '<meta name="viewport" content="width=device-width, initial-scale=1">',
             '<title>%s</title>' % html.escape(recording.name), '<style>%s</style>' % STYLE, '</head>', '<body>',
             '<h1>%s</h1>' % html.escape(recording.name), '<p>%s</p>' % html.escape(summary_of(recording)),
             '<h2>Motions</h2>', motions_table(recording), '<h2>Joints</h2>', joints_table(recording)]
    for figure in figures:
        parts += ['<h2>%s</h2>' % html.escape(figure.title), figure_of(figure)]
    parts += ['</body>', '</html>', '']
    path = os.path.join(folder, 'index.html')
    with open(path, 'w', encoding='utf-8') as stream:
        stream.write('\n'.join(parts))
    return path


def summary_of(recording):
    total = sum(motion.duration for motion in recording.motions)
    text = '%d %s, %.2f s in motion; %d samples of joint_states.' % (
        len(recording.motions), 'motion' if len(recording.motions) == 1 else 'motions', total, len(recording.times))
    return '%s: %s' % (recording.description, text) if recording.description else text


def number(value):
    if value is None or math.isnan(value):
        return '–'
    if math.isinf(value):
        return '∞'
    return '%.4g' % value


def largest(values):
    return max(values, default=float('nan'))


def cell(text, kind=''):
    return '<td%s>%s</td>' % (' class="%s"' % kind if kind else '', html.escape(text))


def table(heads, rows):
    """`heads`: (text, is text). `rows`: lists of cells."""
    head = ''.join('<th%s>%s</th>' % (' class="text"' if is_text else '', html.escape(text)) for text, is_text in heads)
    body = '\n'.join('<tr>%s</tr>' % ''.join(row) for row in rows)
    return '<div class="wide"><table>\n<thead><tr>%s</tr></thead>\n<tbody>\n%s\n</tbody></table></div>' % (head, body)


def share(ratio):
    """A cell with a share of the limits."""
    text = '–' if math.isnan(ratio) else '∞' if math.isinf(ratio) else '%.1f' % (100.0 * ratio)
    return cell(text, 'over' if ratio > WITHIN else '')


def motions_table(recording):
    heads = [('', False), ('motion', True), ('begin [s]', False), ('duration [s]', False), ('tool path [m]', False),
             ('peak speed [m/s]', False), ('max. curvature [1/m]', False), ('energy [SI]', False), ('limit use [%]', False),
             ('goal error', False)]
    rows = []
    for motion in recording.motions:
        m = motion.metrics
        figures = [m.path_length, m.peak_speed, m.max_curvature, m.energy] if m else [None] * 4
        rows.append([cell(str(motion.number)), cell(motion.title or 'motion', 'text'), cell('%.2f' % motion.begin),
                     cell('%.4f' % motion.duration), *[cell(number(value)) for value in figures],
                     share(largest(m.limit_ratio) if m else float('nan')), cell(number(m.goal_error if m else None))])
    return table(heads, rows)


def joints_table(recording):
    heads = [('', False), ('joint', True), ('unit', True), ('peak velocity [/s]', False), ('peak acceleration [/s²]', False),
             ('peak jerk [/s³]', False), ('rms acceleration [/s²]', False), ('travel', False), ('limit use [%]', False)]
    unit_of = dict(zip(recording.joint_names, recording.units))
    rows = []
    for motion in recording.motions:
        m = motion.metrics
        for i, name in enumerate(m.joint_names if m else []):
            values = [m.peak_velocity[i], m.peak_acceleration[i], m.peak_jerk[i], m.rms_acceleration[i], m.travel[i]]
            rows.append([cell(str(motion.number)), cell(name, 'text'), cell(unit_of.get(name, 'rad or m'), 'text'),
                         *[cell(number(value)) for value in values], share(m.limit_ratio[i])])
    return table(heads, rows)


def figure_of(figure):
    with open(figure.file, 'rb') as stream:
        data = base64.b64encode(stream.read()).decode('ascii')
    return '<figure><img alt="%s" src="data:image/png;base64,%s"><figcaption>%s</figcaption></figure>' % (
        html.escape(figure.title), data, html.escape(figure.caption))
