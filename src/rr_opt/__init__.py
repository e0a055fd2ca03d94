"""rr-opt: find the best gait of a Roller Racer, and check it.

The paper behind the names: A. Kilin, Yu. Karavaev and K. Yefremov, "Experimental
investigations of the controlled motion of the Roller Racer robot".
"""

from __future__ import annotations

__version__ = "0.1.0"
