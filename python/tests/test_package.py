"""The package as its readers see it: stubs, docstrings, and the README's code."""

import importlib.metadata
import inspect
import re
import subprocess
import sys

import pytest
from conftest import PYTHON

import snakes_and_stairs as sns


def test_the_stub_agrees_with_the_compiled_module(tmp_path):
    command = [sys.executable, "-m", "mypy.stubtest", "snakes_and_stairs._core", "--ignore-disjoint-bases"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_r10_the_package_has_the_version_of_its_distribution():
    assert sns.__version__ == importlib.metadata.version("snakes-and-stairs")


def test_everything_public_has_a_docstring():
    missing = []
    for name in sns.__all__:
        of = getattr(sns, name)
        if not (inspect.isclass(of) or callable(of)):
            continue
        if not inspect.getdoc(of):
            missing.append(name)
        if inspect.isclass(of):
            for member, value in vars(of).items():
                if not member.startswith("_") and not inspect.getdoc(value):
                    missing.append(f"{name}.{member}")
    # gymnasium's attributes of classes are data.
    missing = [name for name in missing if not name.endswith((".metadata",))]
    assert missing == []


def test_the_examples_of_the_readme_run(tmp_path, monkeypatch):
    monkeypatch.chdir(PYTHON.parent)
    blocks = re.findall(r"```python\n(.*?)```", (PYTHON / "README.md").read_text(), re.DOTALL)
    assert len(blocks) >= 4
    for block in blocks:
        # Every block stands alone, and writes into a folder of the test.
        exec(compile(block.replace("/tmp/", f"{tmp_path}/"), "README.md", "exec"), {})


@pytest.mark.parametrize("module", ["snakes_and_stairs", "snakes_and_stairs._core"])
def test_an_import_without_pandas_and_gymnasium_extras_works(module):
    code = f"import sys; sys.modules['pandas'] = None; import {module}"
    subprocess.run([sys.executable, "-c", code], check=True)
