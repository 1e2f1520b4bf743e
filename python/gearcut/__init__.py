"""gearcut: cuts gears stroke by stroke in the computer, and measures the gear.

>>> import gearcut
>>> gear = {
...     "gear": {"module_mm": 3.0, "teeth": 24, "face_width_mm": 10.0},
...     "tool": {"shaper_cutter": {"teeth": 20}},
... }
>>> flank = gearcut.Job(gear).flank(7, "left")
>>> deviation_um = 1e3 * flank.deviation_mm("finish")
>>> findings = gearcut.cut(gear, draft=True)
>>> findings["smallest_stock"].unit
'mm'
"""

from ._errors import GearcutError, Problem, RefusedError, SceneError
from ._findings import Findings, Notice, Quantity, Table, read
from ._flank import Flank
from ._job import Axes, Checked, Job, Texture, axes, check, cut, pair, texture
from ._native import NO_PASS, __version__
from ._scene import Scene
from ._study import maps, read_study, study

__all__ = [
    "NO_PASS",
    "Axes",
    "Checked",
    "Findings",
    "Flank",
    "GearcutError",
    "Job",
    "Notice",
    "Problem",
    "Quantity",
    "RefusedError",
    "Scene",
    "SceneError",
    "Table",
    "Texture",
    "__version__",
    "axes",
    "check",
    "cut",
    "maps",
    "pair",
    "read",
    "read_study",
    "study",
    "texture",
]
