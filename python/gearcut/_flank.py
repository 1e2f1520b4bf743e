"""One flank: heights over the target, place by place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._native import NO_PASS

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class Flank:
    """A flank after all operations. Arrays have the shape ``[columns, rows]`` and are those that gearcut filled.

    A column is a place along the profile, a row a place along the tooth.
    """

    tooth: int
    """Tooth, from 1, counter-clockwise."""
    side: str
    """``left`` or ``right``."""
    operations: list[str]
    """Names of the operations in their order."""
    u_mm: NDArray[np.float64]
    """Arcs of the target profile from the form point to the tip, mm: the columns."""
    v_mm: NDArray[np.float64]
    """Places along the tooth from the middle of the face, mm: the rows."""
    points_mm: NDArray[np.float64]
    """Points of the target, gear frame, mm: ``[columns, rows, 3]``."""
    normals: NDArray[np.float64]
    """Outward unit normals of the target, gear frame: ``[columns, rows, 3]``."""
    deviations_mm: list[NDArray[np.float32]]
    """Normal deviations from the target after each operation, mm, positive where material is left."""
    passes: list[NDArray[np.uint32]]
    """Pass that left the surface after each operation; ``gearcut.NO_PASS`` where none came and the blank stands."""

    @property
    def shape(self) -> tuple[int, int]:
        """Columns and rows."""
        return len(self.u_mm), len(self.v_mm)

    def index(self, operation: str | int = -1) -> int:
        """Number of an operation, by its name or number; the last one unless another is named."""
        if isinstance(operation, str):
            if operation not in self.operations:
                raise KeyError(f"{operation!r}; the operations are {', '.join(self.operations)}")
            return self.operations.index(operation)
        return range(len(self.operations))[operation]

    def deviation_mm(self, operation: str | int = -1) -> NDArray[np.float32]:
        """Normal deviation after an operation, mm; see :attr:`deviations_mm`."""
        return self.deviations_mm[self.index(operation)]

    def is_cut(self, operation: str | int = -1) -> NDArray[np.bool_]:
        """Where a pass of this operation or an earlier one came."""
        return np.not_equal(self.passes[self.index(operation)], NO_PASS)

    def stock_mm(self, operation: str | int) -> NDArray[np.float32]:
        """What an operation left for those after it, mm; NaN where a pass of it or of the last one is missing."""
        stock = self.deviation_mm(operation) - self.deviation_mm()
        stock[~(self.is_cut(operation) & self.is_cut())] = np.nan
        return stock

    def surface_mm(self, operation: str | int = -1) -> NDArray[np.float64]:
        """Points of the surface after an operation, gear frame, mm: ``[columns, rows, 3]``."""
        return self.points_mm + self.deviation_mm(operation)[..., np.newaxis].astype(np.float64) * self.normals

    def to_xarray(self) -> xarray.Dataset:
        """Deviations and passes of all operations over ``u`` and ``v``, with units; the arrays are the same."""
        import xarray

        about = {"units": "mm", "long_name": "normal deviation from the target, positive where material is left"}
        variables: dict[str, Any] = {}
        for name, deviation_mm, passes in zip(self.operations, self.deviations_mm, self.passes):
            variables[f"deviation_{name}"] = (("u", "v"), deviation_mm, {**about, "operation": name})
            variables[f"pass_{name}"] = (("u", "v"), passes, {"long_name": "pass that left the surface"})
        along = {"units": "mm", "long_name": "arc of the target profile from the form point"}
        across = {"units": "mm", "long_name": "place along the tooth from the middle of the face"}
        places = {"u": ("u", self.u_mm, along), "v": ("v", self.v_mm, across)}
        return xarray.Dataset(variables, places, {"tooth": self.tooth, "side": self.side})

    def __repr__(self) -> str:
        columns, rows = self.shape
        cut = self.deviation_mm()[self.is_cut()]
        found = f"{1e3 * cut.min():.3f} to {1e3 * cut.max():.3f} um" if cut.size else "not cut"
        return f"<gearcut.Flank tooth {self.tooth} {self.side}: {columns} x {rows}, {self.operations[-1]} {found}>"
