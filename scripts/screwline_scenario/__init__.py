"""What `rosrun screwline scenario` is made of."""
import threading

if not hasattr(threading.Thread, 'isAlive'):
    # Debian 11's rospy, as it shuts down, calls what its Python no longer has.
    threading.Thread.isAlive = threading.Thread.is_alive
