"""What was found: quantities with unit and definition, tables, notices."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._errors import GearcutError

if TYPE_CHECKING:
    import pandas
    import pyarrow

SCHEMA_VERSION = 4
"""Layout of ``results.json`` that is read."""


@dataclass(frozen=True)
class Quantity:
    """A value that explains itself."""

    key: str
    """Path in the findings."""
    value: float | int | str | None
    """Number in its unit, count or word; none where there is no value, for the reason ``why``."""
    unit: str | None
    """Unit, ``"1"`` for a pure number; none for words."""
    definition: str
    """What the value is."""
    why: str | None = None
    """Why there is no value."""
    place: Mapping[str, float | int | str] | None = None
    """Where the value was found, by coordinates whose names carry their units."""
    title: str = ""
    """What it is called where people read it."""

    @property
    def words(self) -> str:
        """Value and unit."""
        if self.value is None:
            return f"none: {self.why}"
        number = f"{self.value:.6g}" if isinstance(self.value, float) else str(self.value)
        return number if self.unit in (None, "1") else f"{number} {self.unit}"

    def __float__(self) -> float:
        """The number; NaN where there is no value."""
        return float("nan") if self.value is None else float(self.value)

    def __repr__(self) -> str:
        return f"<{self.key}: {self.words}>"


@dataclass(frozen=True)
class Notice:
    """What must be known before the numbers are trusted."""

    id: str
    """Id in docs/notices.md."""
    severity: str
    """``fault``, ``warning`` or ``note``."""
    text: str
    """What is wrong, where, and what to do about it."""
    section: str | None = None
    """Path of the numbers that it is about, where it is about some alone."""

    def __str__(self) -> str:
        return f"{self.severity}: {self.text} [{self.id}]"


class Table(Mapping[str, "NDArray[Any]"]):
    """A table: columns of numpy by key.

    Numbers are ``float64``, NaN where a value is missing; counts without gaps are ``int64``; words are objects.
    pandas, polars and DuckDB read it as Arrow (:meth:`to_arrow`).
    """

    def __init__(
        self,
        key: str,
        title: str,
        columns: Mapping[str, NDArray[Any]],
        units: Mapping[str, str | None],
        definitions: Mapping[str, str],
    ) -> None:
        self.key = key
        """Path in the findings."""
        self.title = title
        """What it is about."""
        self.units = units
        """Unit of each column, ``"1"`` for pure numbers; none for words."""
        self.definitions = definitions
        """What the values of each column are."""
        self._columns = columns

    def __getitem__(self, key: str) -> NDArray[Any]:
        if key in self._columns:
            return self._columns[key]
        raise unknown(key, self._columns)

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()), ()))

    def to_pandas(self) -> pandas.DataFrame:
        """As a data frame; units and definitions are in ``attrs``."""
        import pandas

        frame = pandas.DataFrame(dict(self._columns))
        frame.attrs.update(title=self.title, units=dict(self.units), definitions=dict(self.definitions))
        return frame

    def to_arrow(self) -> pyarrow.Table:
        """As a table of Arrow; each field's metadata has its unit and definition."""
        import pyarrow

        fields, arrays = [], []
        for key, column in self._columns.items():
            array = pyarrow.array(column, from_pandas=True)
            about = {"unit": self.units[key] or "", "definition": self.definitions[key]}
            fields.append(pyarrow.field(key, array.type, metadata=about))
            arrays.append(array)
        return pyarrow.Table.from_arrays(arrays, schema=pyarrow.schema(fields, metadata={"title": self.title}))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return f"<gearcut.Table {self.key}: {self.rows} rows of {', '.join(self._columns)}>"

    def _repr_html_(self) -> str:
        heads = "".join(f"<th>{escape(head(key, self.units[key]))}</th>" for key in self._columns)
        shown = list(zip(*(column[:MOST_SHOWN] for column in self._columns.values())))
        rows = "".join("<tr>" + "".join(f"<td>{escape(cell(of))}</td>" for of in row) + "</tr>" for row in shown)
        more = f"<p>{self.rows - MOST_SHOWN} more rows</p>" if self.rows > MOST_SHOWN else ""
        return f"<b>{escape(self.title)}</b><table><tr>{heads}</tr>{rows}</table>{more}"


MOST_SHOWN = 20
"""Rows of a table that a notebook shows."""


def head(key: str, unit: str | None) -> str:
    """Key and unit of a column."""
    return key if unit in (None, "1") else f"{key} ({unit})"


def cell(value: object) -> str:
    """A value of a table."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def unknown(key: str, known: Mapping[str, object]) -> KeyError:
    """The error for a key that is none, with the nearest ones."""
    alike = get_close_matches(key, known, n=3)
    return KeyError(f"{key!r}; did you mean {' or '.join(alike)}?" if alike else key)


class Findings(Mapping[str, Quantity]):
    """Quantities by path: ``findings["smallest_stock"]``, ``findings["operations.finish.axes.work_speed"]``.

    Numbers of the whole gear come first, under their keys alone.
    """

    def __init__(self, document: Mapping[str, Any], folder: Path | None = None) -> None:
        self.scene: str = document["scene"]
        """Name of the scene."""
        self.process: str = document["process"]
        """Name of the process."""
        self.program_version: str = document["program_version"]
        """Version of gearcut that found it."""
        self.complete: bool = document["complete"]
        """Whether all flanks were cut; otherwise the numbers cover the finished ones only."""
        self.notices = [Notice(**notice) for notice in document["warnings"]]
        """What must be known before the numbers are trusted, the gravest first."""
        self.folder = folder
        """Folder of the files; none where nothing was written."""
        self._quantities = {key: quantity(key, entry) for key, entry in document["headline"].items()}
        self.headline: tuple[str, ...] = tuple(self._quantities)
        """Keys of what to look at first."""
        self._tables: dict[str, Mapping[str, Any]] = {}
        for key, section in document["sections"].items():
            self._walk(key, section)

    def _walk(self, path: str, section: Mapping[str, Any]) -> None:
        for key, entry in section.items():
            below = f"{path}.{key}"
            if key.startswith("$"):
                continue
            if isinstance(entry.get("definition"), str):
                self._quantities[below] = quantity(below, entry)
            elif isinstance(entry.get("columns"), list):
                self._tables[below] = entry
            else:
                self._walk(below, entry)

    @property
    def tables(self) -> list[str]:
        """Paths of the tables."""
        return list(self._tables)

    def table(self, path: str) -> Table:
        """A table by its path."""
        if path not in self._tables:
            raise unknown(path, self._tables)
        document = self._tables[path]
        keys = [column["key"] for column in document["columns"]]
        rows = document["rows"]
        if document.get("rows_in_file"):
            if self.folder is None:
                raise GearcutError(f"the rows of {path} are in a file; give the cut a folder, out=...")
            return read_csv(self.folder / document["file"], path, document["title"], document["columns"])
        columns = {key: column_of([row[place] for row in rows]) for place, key in enumerate(keys)}
        units = {column["key"]: column["unit"] for column in document["columns"]}
        definitions = {column["key"]: column["definition"] for column in document["columns"]}
        return Table(path, document["title"], columns, units, definitions)

    def __getitem__(self, key: str) -> Quantity:
        if key in self._quantities:
            return self._quantities[key]
        raise unknown(key, self._quantities)

    def __iter__(self) -> Iterator[str]:
        return iter(self._quantities)

    def __len__(self) -> int:
        return len(self._quantities)

    def to_pandas(self) -> pandas.DataFrame:
        """All quantities, a row each: value, unit, definition, why there is no value."""
        import pandas

        of = list(self._quantities.values())
        columns = ("value", "unit", "definition", "why")
        return pandas.DataFrame(
            {name: [getattr(entry, name) for entry in of] for name in columns},
            index=pandas.Index([entry.key for entry in of], name="key"),
        )

    def __repr__(self) -> str:
        return f"<gearcut.Findings of {self.scene}: {len(self)} quantities, {len(self._tables)} tables>"

    def _repr_html_(self) -> str:
        shown = (self._quantities[key] for key in self.headline)
        rows = "".join(
            f"<tr title='{escape(of.definition, quote=True)}'><td>{escape(of.title)}</td>"
            f"<td>{escape(of.words)}</td></tr>"
            for of in shown
        )
        notices = "".join(f"<li>{escape(str(notice))}</li>" for notice in self.notices)
        return f"<b>{escape(self.scene)}</b>{self._picture()}<table>{rows}</table><ul>{notices}</ul>"

    def _picture(self) -> str:
        """The drawn gear, where there is one."""
        drawn = None if self.folder is None else self.folder / "pictures" / "gear.png"
        if drawn is None or not drawn.is_file():
            return ""
        from base64 import b64encode

        picture = b64encode(drawn.read_bytes()).decode()
        return f"<br><img width='400' alt='the gear' src='data:image/png;base64,{picture}'>"


def read(folder: str | os.PathLike[str]) -> Findings:
    """The findings of an earlier run, by its folder."""
    folder = Path(folder)
    document = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    version = document.get("schema_version")
    if version != SCHEMA_VERSION:
        raise GearcutError(f"{folder} has schema version {version}, this gearcut reads {SCHEMA_VERSION}; cut it again")
    return Findings(document, folder)


def quantity(key: str, entry: Mapping[str, Any]) -> Quantity:
    """A quantity of its form in a document."""
    title = entry.get("title") or key.rpartition(".")[2].replace("_", " ")
    value, unit, definition = entry["value"], entry.get("unit"), entry["definition"]
    return Quantity(key, value, unit, definition, entry.get("why"), entry.get("place"), title)


def column_of(cells: list[Any]) -> NDArray[Any]:
    """A column of cells: counts, numbers or words."""
    if all(isinstance(of, int) for of in cells):
        return np.array(cells, dtype=np.int64)
    if all(of is None or isinstance(of, (int, float)) for of in cells):
        return np.array([np.nan if of is None else of for of in cells], dtype=np.float64)
    return np.array(cells, dtype=object)


def read_csv(path: Path, key: str, title: str, columns: list[Mapping[str, Any]] | None = None) -> Table:
    """A table of a CSV file; without ``columns``, its heads say keys and units in one word."""
    with path.open(newline="", encoding="utf-8") as file:
        heads, *rows = csv.reader(file)
    keys = heads if columns is None else [column["key"] for column in columns]
    read = {key: column_of([parsed(row[place]) for row in rows]) for place, key in enumerate(keys)}
    units = {of: unit_of(of) for of in heads} if columns is None else {of["key"]: of["unit"] for of in columns}
    definitions = {column["key"]: column["definition"] for column in columns or ()}
    return Table(key, title, read, units, {**dict.fromkeys(keys, ""), **definitions})


def unit_of(head: str) -> str:
    """The unit at the end of a head of numbers: ``deg/s^2`` of ``work_acceleration_deg_per_s2``."""
    found = re.search(r"_((?:mm|deg|s)(?:_per_s2?)?)$", head)
    return "1" if found is None else found[1].replace("_per_s2", "/s^2").replace("_per_s", "/s")


def parsed(text: str) -> float | int | str | None:
    """A cell of a CSV file."""
    if text == "":
        return None
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            pass
    return text
