"""HP-GL from elsewhere: read by an allow-list, given roles by a person, and written anew.

``read`` turns bytes into strokes of each pen, in mm, and refuses what it does not know; ``plan``
makes a plan of them; ``asked`` makes a proved job folder of a file and a person's words. Foreign
bytes never reach a port: what is sent was written by our own writers from that plan.
"""

from foldmill_fabricate.foreign.asked import Asked, make_folder
from foldmill_fabricate.foreign.plan import Use, plan_drawing, write_drawing
from foldmill_fabricate.foreign.read import Drawing, read

__all__ = ["Asked", "Drawing", "Use", "make_folder", "plan_drawing", "read", "write_drawing"]
