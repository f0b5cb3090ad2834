"""Types, stubs, builders and notebooks are what they should be."""

import doctest
import subprocess
import sys
from pathlib import Path

import pytest

import spinneb

HERE = Path(__file__).parents[1]
USER = '''
import numpy as np
import spinneb as sn

system = sn.System(
    sn.triangular(8, 8, periodic=True, shape=sn.shapes.disc(3) | sn.shapes.box([0, 0], [2, 2])),
    [sn.exchange(J=["10 meV"]), sn.dmi(D="1 meV", kind="interfacial"), sn.Term(lambda m: m[:, 2], lambda m: 0 * m)],
    moment="3 mu_B",
)
result = sn.barrier(system, sn.skyrmion(radius=4), np.zeros((64, 3)), guess=sn.sweep("left"), temperatures=[300])
barrier: float = result.barrier_meV["forward"] if result.barrier_meV is not None else 0.0
spins: np.ndarray = result.saddles[0].spins
'''


def run(*arguments):
    return subprocess.run([sys.executable, "-m", *map(str, arguments)], capture_output=True, text=True, cwd=HERE)


def test_the_example_of_the_package_is_right():
    assert doctest.testmod(spinneb) == (0, 5)


def test_builders_are_those_of_the_schema():
    done = subprocess.run([sys.executable, HERE / "generate.py", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_types_are_strict(tmp_path):
    pytest.importorskip("mypy")
    done = run("mypy", "--strict", "--cache-dir", tmp_path / "cache", "-p", "spinneb")
    assert done.returncode == 0, done.stdout
    (tmp_path / "user.py").write_text(USER)
    done = run("mypy", "--strict", "--cache-dir", tmp_path / "cache", tmp_path / "user.py")
    assert done.returncode == 0, done.stdout
    (tmp_path / "wrong.py").write_text("import spinneb as sn\nsn.domain_wall(centre=3)\nsn.uniform(3)\n")
    done = run("mypy", "--strict", "--cache-dir", tmp_path / "cache", tmp_path / "wrong.py")
    assert done.stdout.count("error:") >= 2, done.stdout


def test_stubs_are_those_of_the_module(tmp_path):
    pytest.importorskip("mypy")
    done = run("mypy.stubtest", "spinneb._core", "--ignore-missing-stub")
    assert done.returncode == 0, done.stdout
