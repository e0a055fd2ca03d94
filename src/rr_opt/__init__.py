"""rr-opt: find the best gait of a Roller Racer, and check it.

The paper behind the names: A. Kilin, Yu. Karavaev and K. Yefremov, "Experimental
investigations of the controlled motion of the Roller Racer robot".
"""

from __future__ import annotations

from rr_opt.version import __version__

__all__ = ["__version__"]
