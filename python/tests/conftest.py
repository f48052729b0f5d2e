"""Paths and small worlds that several tests use."""

import os
import subprocess
from pathlib import Path

import pytest

PYTHON = Path(__file__).resolve().parent.parent
SAVES = PYTHON.parent / "saves"
#: A short trial on few steps: some milliseconds of computing.
SHORT = {"trial.duration_s": 2}


@pytest.fixture(scope="session")
def snakes():
    """Runs the program, which the variable SNAKES names, and returns what it prints."""
    program = os.environ.get("SNAKES")
    if not program:
        pytest.skip("the variable SNAKES does not name the program")

    def run(*arguments, cwd=None):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run
