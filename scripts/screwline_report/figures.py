"""The figures of a report, one function each; drawn without a screen."""
import os

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from mpl_toolkits.mplot3d import Axes3D  # noqa: E402,F401  (older matplotlib needs it for projection='3d')

# Okabe & Ito: told apart by people who are colour-blind; its yellow is left out, it is faint on white.
COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#000000')
DASHES = ('-', '--', ':', '-.')
STYLE = {
    'font.size': 12, 'axes.titlesize': 13, 'axes.grid': True, 'grid.color': '#d9d9d9', 'axes.axisbelow': True,
    'axes.spines.top': False, 'axes.spines.right': False, 'figure.facecolor': 'white', 'savefig.facecolor': 'white',
    'legend.frameon': False, 'lines.linewidth': 1.8,
}
WIDTH, DPI = 10.0, 110


class Figure:
    def __init__(self, file, title, caption):
        self.file, self.title, self.caption = file, title, caption


def style_of(index):
    return {'color': COLOURS[index % len(COLOURS)], 'linestyle': DASHES[index // len(COLOURS) % len(DASHES)]}


def draw_all(recording, folder):
    """Draws what the recording has into PNG files. [Figure]"""
    drawings = (draw_positions, draw_velocities, draw_accelerations, draw_scalings, draw_path, draw_speed, draw_limit_use)
    figures = []
    with plt.rc_context(STYLE):
        for drawing in drawings:
            figure = drawing(recording, folder)
            if figure is not None:
                figures.append(figure)
    return figures


def save(canvas, folder, name, title, caption):
    path = os.path.join(folder, name + '.png')
    canvas.savefig(path, dpi=DPI, bbox_inches='tight')
    plt.close(canvas)
    return Figure(path, title, caption)


def name_of(motion):
    """For a legend: the number, and the title up to its first comma or colon."""
    title = motion.title.split(',')[0].split(':')[0]
    return '%d  %s' % (motion.number, title) if title else 'motion %d' % motion.number


def styled(motions):
    """(motion, style) of each; transfers to where a motion begins stand back."""
    shown = [motion for motion in motions if not motion.is_transfer]
    for motion in motions:
        if motion.is_transfer:
            yield motion, {'color': '#b8b8b8', 'linestyle': '-', 'linewidth': 1.0, 'zorder': 1.5}
        else:
            yield motion, dict(style_of(shown.index(motion)), label=name_of(motion))


def legend_below(canvas, panel, names):
    """A legend under the whole figure."""
    handles, labels = panel.get_legend_handles_labels()
    if handles:
        canvas.legend(handles, labels, loc='upper center', bbox_to_anchor=(0.5, 0.0), fontsize=11, ncol=3 if names > 3 else max(1, names))


def over_time(recording, folder, name, quantity, per, curves):
    """One panel for each unit. `curves(j)` gives (times, values) pairs of joint j."""
    units = sorted(set(recording.units), reverse=True)
    canvas, panels = plt.subplots(len(units), 1, sharex=True, squeeze=False, figsize=(WIDTH, 1.2 + 3.2 * len(units)))
    for panel, unit in zip(panels[:, 0], units):
        for j, joint in enumerate(recording.joint_names):
            if recording.units[j] != unit:
                continue
            for k, (times, values) in enumerate(curves(j)):
                panel.plot(times, values, label='_' if k else joint, **style_of(j))
        panel.set_ylabel('%s [%s]' % (quantity, unit + per if ' or ' not in unit else 'rad%s or m%s' % (per, per)))
        mark_motions(panel, recording)
        panel.legend(loc='center left', bbox_to_anchor=(1.0, 0.5))
    panels[-1, 0].set_xlabel('time [s]')
    return save(canvas, folder, name, 'Joint ' + name, '')


def mark_motions(panel, recording):
    """Light bands where the arm moves, numbered; rest is left white, and long rest at both ends is left out."""
    for motion in recording.motions:
        panel.axvspan(motion.begin, motion.begin + motion.duration, color='#eef3f7', zorder=-2, linewidth=0)
        panel.annotate(str(motion.number), (motion.begin + 0.5 * motion.duration, 1.0), xycoords=('data', 'axes fraction'),
                       ha='center', va='bottom', color='#555555')
    last = recording.motions[-1]
    panel.set_xlim(-0.2, max(motion.begin + motion.duration for motion in (last, *recording.motions)) + 0.2)


def draw_positions(recording, folder):
    figure = over_time(recording, folder, 'positions', 'position', '',
                       lambda j: [(recording.times, recording.positions[:, j])])
    figure.caption = 'As streamed on joint_states. Bands are motions, numbered as in the table.'
    return figure


def draw_velocities(recording, folder):
    figure = over_time(recording, folder, 'velocities', 'velocity', '/s',
                       lambda j: [(recording.times, recording.velocities[:, j])])
    figure.caption = 'As streamed on joint_states.'
    return figure


def draw_accelerations(recording, folder):
    motions = [motion for motion in recording.motions if len(motion.accelerations) == len(motion.times)]
    if not motions:
        return None
    figure = over_time(recording, folder, 'accelerations', 'acceleration', '/s²', lambda j: [
        (motion.begin + motion.times, motion.accelerations[:, j]) for motion in motions])
    figure.caption = 'As planned, at the points of joint_trajectory; joint_states has no accelerations.'
    return figure


def draw_scalings(recording, folder):
    scaled = [motion for motion in recording.motions if len(motion.scaling)]
    if not scaled:
        return None
    canvas, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(WIDTH, 7.0))
    for motion, style in styled(scaled):
        upper.plot(motion.scaling[:, 0], motion.scaling[:, 1], **style)
        lower.plot(motion.scaling[:, 0], motion.scaling[:, 2], **style)
    upper.set_ylabel('s [1]')
    lower.set_ylabel('ds/dτ [1]')
    lower.set_xlabel('τ = time / duration [1]')
    legend_below(canvas, upper, len(scaled))
    return save(canvas, folder, 'time_scaling', 'Time scaling s(τ)',
                'Of the motions that are one scalar s(τ) for all joints; grey: transfers between motions.')


def draw_path(recording, folder):
    if not len(recording.tool_path):
        return None
    canvas = plt.figure(figsize=(WIDTH, 4.8))
    solid = canvas.add_subplot(1, 2, 1, projection='3d')
    plan = canvas.add_subplot(1, 2, 2)
    for motion, style in styled(recording.motions):
        path = recording.tool_path[motion.holds(recording.tool_times)]
        if not len(path):
            continue
        solid.plot(path[:, 0], path[:, 1], path[:, 2], **style)
        plan.plot(path[:, 0], path[:, 1], **style)
        if motion.is_transfer:
            continue
        plan.plot(path[0, 0], path[0, 1], 'o', color='white', markeredgecolor='#333333', markersize=6)
        plan.plot(path[-1, 0], path[-1, 1], 'o', color='#333333', markersize=5)
    solid.set_xlabel('x [m]')
    solid.set_ylabel('y [m]')
    solid.set_zlabel('z [m]')
    middle, half = cube_around(recording.tool_path)
    solid.set_xlim(middle[0] - half, middle[0] + half)
    solid.set_ylim(middle[1] - half, middle[1] + half)
    solid.set_zlim(middle[2] - half, middle[2] + half)
    solid.tick_params(labelsize=9)
    plan.set_xlabel('x [m]')
    plan.set_ylabel('y [m]')
    plan.set_aspect('equal', adjustable='datalim')
    plan.set_title('plan view')
    canvas.subplots_adjust(wspace=0.45)
    legend_below(canvas, plan, len(recording.motions))
    return save(canvas, folder, 'tool_path', 'Tool path', 'Base frame. Open circle: start; full circle: end of a motion; grey: transfers between motions.')


def cube_around(points):
    low, high = points.min(axis=0), points.max(axis=0)
    return 0.5 * (low + high), max(0.55 * float((high - low).max()), 1e-3)


def draw_speed(recording, folder):
    if not len(recording.speeds):
        return None
    canvas, panel = plt.subplots(figsize=(WIDTH, 3.6))
    panel.plot(recording.speed_times, recording.speeds, color=COLOURS[0])
    panel.set_xlabel('time [s]')
    panel.set_ylabel('tool speed [m/s]')
    panel.set_ylim(bottom=0.0)
    mark_motions(panel, recording)
    return save(canvas, folder, 'tool_speed', 'Tool speed', 'Of the tip\'s origin, as streamed on tool_twist.')


def draw_limit_use(recording, folder):
    measured = [motion for motion in recording.motions if motion.metrics is not None and motion.metrics.limit_ratio]
    if not measured:
        return None
    canvas, panel = plt.subplots(figsize=(WIDTH, 3.8))
    count = len(recording.joint_names)
    for j, joint in enumerate(recording.joint_names):
        shares = [100.0 * ratio_of(motion.metrics, joint) for motion in measured]
        places = np.arange(len(measured)) + (j - 0.5 * (count - 1)) * 0.8 / count
        panel.bar(places, shares, 0.8 / count, label=joint, color=COLOURS[j % len(COLOURS)],
                  hatch='//' if j >= len(COLOURS) else None)
    panel.axhline(100.0, color='#333333', linewidth=1.2, linestyle='--')
    panel.set_xticks(range(len(measured)))
    panel.set_xticklabels([str(motion.number) for motion in measured])
    panel.set_xlabel('motion')
    panel.set_ylabel('share of the limit [%]')
    panel.grid(axis='x', visible=False)
    panel.legend(loc='center left', bbox_to_anchor=(1.0, 0.5))
    return save(canvas, folder, 'limit_use', 'Limit use',
                'Largest share of a velocity, acceleration or jerk limit that a joint uses; orders that step to infinity do not count.')


def ratio_of(metrics, joint):
    names = list(metrics.joint_names)
    return metrics.limit_ratio[names.index(joint)] if joint in names else 0.0
