"""Whether a bag is whole: every topic there, every sample of every motion from the first to the last, frames with them."""
import os

import rosbag
import rospy

from .streams import samples_of

TOOL_FRAME = 'screwline/tool'
LATCHED_ONCE_PER_MOTION = ('/joint_trajectory', '/metrics')
STREAMED = ('/joint_states', '/tool_pose', '/tool_twist')
CLOCK = rospy.Duration(0, 100)  # what rounding may do to a stamp


def check_bag(path, part, windows, topics, report):
    report.begin('bag %s' % path)
    with rosbag.Bag(path) as bag:
        counts = {topic: info.message_count for topic, info in bag.get_type_and_topic_info().topics.items()}
        report.detail('%.1f MB; %s' % (os.path.getsize(path) / 1e6,
                                       ', '.join('%s %d' % item for item in sorted(counts.items()))))
        missing = [topic for topic in topics if not counts.get(topic) and (windows or topic in ('/tf_static',))]
        report.check('every topic', 'nothing on %s' % ', '.join(missing) if missing else '')
        if not windows:
            return
        for topic in LATCHED_ONCE_PER_MOTION:
            short = counts.get(topic, 0) < len(windows)
            report.check('%s of each motion' % topic, '%d of %d' % (counts.get(topic, 0), len(windows)) if short else '')
        stamps = {topic: [message.header.stamp for _, message, _ in bag.read_messages([topic])] for topic in STREAMED}
        for topic in STREAMED:
            report.check('every sample of %s' % topic, samples_missing(stamps[topic], windows, part.rate))
        frames = {transform.header.stamp for _, message, _ in bag.read_messages(['/tf'])
                  for transform in message.transforms if transform.child_frame_id == TOOL_FRAME}
        without = [stamp for stamp in stamps['/joint_states'] if inside(stamp, windows) and stamp not in frames]
        report.check('%s at every sample' % TOOL_FRAME, 'missing at %d' % len(without) if without else '')


def inside(stamp, windows):
    return any(begin - CLOCK <= stamp <= begin + rospy.Duration(duration) + CLOCK for begin, duration in windows)


def samples_missing(stamps, windows, rate):
    if any(later <= earlier for earlier, later in zip(stamps, stamps[1:])):
        return 'stamps do not increase'
    for begin, duration in windows:
        found = [(stamp - begin).to_sec() for stamp in stamps if inside(stamp, [(begin, duration)])]
        expected = samples_of(duration, rate)
        if len(found) != expected:
            return '%d of %d in a motion of %.3f s' % (len(found), expected, duration)
        if found[0] > 1.5 / rate or duration - found[-1] > 1.5 / rate:
            return 'the motion of %.3f s is held from %.3f to %.3f s' % (duration, found[0], found[-1])
    return ''
