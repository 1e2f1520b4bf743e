"""Examples of the docs run."""

import re
from pathlib import Path

import pytest

import gearcut

ROOT = Path(__file__).parents[2]


def test_the_page_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    examples = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs" / "python.md").read_text(), re.DOTALL | re.MULTILINE)
    assert len(examples) == 6
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for example in examples:
        exec(compile(example, "docs/python.md", "exec"), names)


def test_the_head_of_the_package_runs() -> None:
    import doctest

    failed, tried = doctest.testmod(gearcut)
    assert (failed, tried) == (0, 6)
