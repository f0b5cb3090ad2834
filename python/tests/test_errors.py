"""Errors say what the command line says."""

import pickle
import sys

import numpy as np
import pytest

import spinneb as sn


@pytest.fixture
def bad(tmp_path):
    def write(text):
        file = tmp_path / "bad.json"
        file.write_text(text)
        return file

    return write


GOOD = '{"material": "fept", "lattice": {"chain": {"sites": 9}}, "initial": {"uniform": {"direction": [0, 0, 1]}}, %s}'


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        GOOD % '"finale": {"uniform": {"direction": [0, 0, -1]}}',
        GOOD % '"final": {"uniform": {"direction": [0, 0, 0]}}, "name": 3, "path": {"images": "many"}',
        GOOD % '"final": {"uniform": {"direction": [0, 0, 1]}}, "energy": [{"exchange": {"J": [10]}}]',
        GOOD % '"final": {"uniform": {"direction": [0, 0, -1]}}, "energy": [{"dmi": {"D": "1 meV"}}]',
    ],
)
def test_a_bad_file_is_told_of_in_the_words_of_the_command_line(bad, command, text):
    file = bad(text)
    with pytest.raises(sn.ConfigError) as error:
        sn.run(file)
    done = command("run", file)
    assert done.returncode == 2
    assert done.stderr.strip() == "\n".join(f"error: {line}" for line in str(error.value).splitlines())


def test_errors_are_value_errors_with_the_path_of_the_key(chain):
    with pytest.raises(ValueError, match=r'^lattice\.chain\.sties: unknown key "sties": did you mean "sites"\?'):
        sn.run({**chain.config(sn.uniform("z"), sn.uniform("-z")), "lattice": {"chain": {"sties": 3}}})
    with pytest.raises(sn.ConfigError, match=r"^energy\[0\]\.exchange\.J"):
        sn.barrier(chain.replaced(energy=[sn.exchange(J=[10])]), sn.uniform("z"), sn.uniform("-z"))
    with pytest.raises(sn.ConfigError, match="key \"final\" is missing"):
        sn.run(chain.replaced(initial=sn.uniform("z")))
    with pytest.raises(sn.ConfigError, match="--set path.images"):
        sn.run(chain.config(sn.uniform("z"), sn.uniform("-z")), set={"path.images": 1})
    assert issubclass(sn.ConfigError, sn.SpinnebError)


def test_several_errors_are_told_at_once(chain):
    with pytest.raises(sn.ConfigError) as error:
        sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), search={"bogus": 1}, neb={"tolerance": -1})
    assert len(str(error.value).splitlines()) == 2


def test_what_is_no_system_is_refused_with_what_would_be_one(chain):
    with pytest.raises(TypeError, match=r"^barrier takes a System.*found chain\(sites=20\)"):
        sn.barrier(sn.chain(20), sn.uniform("z"), sn.uniform("-z"))
    for part in (sn.chain(20), sn.uniform("z"), 3):
        with pytest.raises(TypeError, match="^expected a System, a file or a dictionary"):
            sn.run(part)
    with pytest.raises(TypeError, match=r"^energy is a list of terms, also of one: write \[exchange\(J=\['1 meV'\]\)\]"):
        sn.System(sn.chain(20), sn.exchange(J=["1 meV"]))


def test_what_is_no_state_or_term_is_refused_here(chain):
    with pytest.raises(TypeError, match="uniform\\('z'\\)"):
        sn.barrier(chain, "z", sn.uniform("-z"))
    with pytest.raises(TypeError, match="energy term"):
        sn.System(sn.chain(5), ["exchange"])
    with pytest.raises(TypeError):
        sn.uniform()
    with pytest.raises(TypeError):
        sn.domain_wall(3, widht=2)


def test_a_word_that_is_none_is_refused_at_once(chain):
    for change in (lambda: chain.replaced(enrgy=[]), lambda: sn.System(sn.chain(3), enrgy=[])):
        with pytest.raises(TypeError, match="^there is no key 'enrgy' in a config: did you mean 'energy'"):
            change()
    with pytest.raises(AttributeError, match="^a System has no 'mooment': did you mean 'moment'"):
        chain.mooment = "1 mu_B"
    chain.moment = "1 mu_B"
    assert chain.config(sn.uniform("z"), sn.uniform("-z"))["material"]["moment"] == "1 mu_B"


@pytest.mark.parametrize(
    "call, kind, told",
    [
        (lambda: sn.chain(-1), ValueError, "sites: found -1, expected 1 or more"),
        (lambda: sn.chain(10.0), TypeError, "sites: found 10.0, expected a whole number"),
        (lambda: sn.square(3, 0), ValueError, "cells: found 0, expected 1 or more"),
        (lambda: sn.square([3, 2.5]), TypeError, "cells: found 2.5, expected a whole number"),
        (lambda: sn.uniform("up"), ValueError, "direction: found 'up', expected x, y and z of a direction"),
        (lambda: sn.anisotropy(K="1 meV", axis="w"), ValueError, "axis: found 'w', expected"),
        (lambda: sn.domain_wall(3, through="atuo"), ValueError, "through: found 'atuo'.*or 'auto'"),
    ],
)
def test_arguments_of_builders_are_checked_where_they_are_given(call, kind, told):
    with pytest.raises(kind, match=f"^{told}"):
        call()
    assert sn.domain_wall(3, through="auto")["domain_wall"]["through"] == "auto"
    assert sn.chain(np.int64(3)) == sn.chain(3)


def test_what_would_be_right_is_told_of_text_that_is_none(chain, reversal):
    with pytest.raises(TypeError, match=r"such as uniform\(\[0, 0, 1\]\)"):
        sn.barrier(chain, "up", sn.uniform("-z"))
    with pytest.raises(TypeError, match="^found JSON text, expected a System, the name of a file or a dictionary"):
        sn.run(chain.to_json(sn.uniform("z"), sn.uniform("-z")))
    with pytest.raises(TypeError, match="^from_field takes a field of discretisedfield, found 3"):
        sn.from_field(3)
    one = sn.rates(reversal, 4, theory="langer")
    assert one.lifetimes_s() == sn.rates(reversal, 4, theory=["langer"]).lifetimes_s()


def test_an_uncertified_result_has_no_rates_and_says_why(chain):
    kept = sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), images=7, neb={"max_evaluations": 20}, saddle={"certify": False})
    with pytest.raises(sn.SpinnebError, match="this result is not certified, and rates need saddles and minima that are proven"):
        sn.rates(kept, 4)


def test_systems_are_equal_where_all_that_they_are_made_of_is(chain):
    other = chain.replaced(initial=sn.uniform("z"), rates={"temperatures": ["4 K"]})
    for system in (chain, other, chain.replaced(initial=np.array([[0.0, 0.0, 1.0]] * 20))):
        assert pickle.loads(pickle.dumps(system)) == system == system.replaced()
    assert chain != other and chain != 3
    term = sn.Term(np.sum, np.sign, name="sum")
    assert term == sn.Term(np.sum, np.sign, name="sum") != sn.Term(np.sum, np.cos, name="sum")


def test_vectors_that_are_none_are_named(chain, reversal):
    ends = sn.uniform("z"), sn.uniform("-z")
    broken = reversal.spins.copy()
    broken[2, 3, 1] = np.nan
    with pytest.raises(ValueError, match=r"^initial: site 3: \[.*nan.*\] has no direction"):
        sn.barrier(chain, broken[2], ends[1])
    with pytest.raises(ValueError, match=r"^state: site 3: .*three finite numbers"):
        sn.relax(chain, broken[2])
    with pytest.raises(ValueError, match=r"^guess: image 2, site 3: \[.*nan"):
        sn.barrier(chain, *ends, guess=broken)
    # arrays in a dictionary too
    with pytest.raises(ValueError, match=r"^guess: image 2, site 3: \[.*nan"):
        sn.run({**chain.config(*ends), "path": {"guess": broken}})
    wanted = r"expected \(images, sites, 3\) with 3 images or more"
    for few in (reversal.spins[:1], reversal.spins[0]):
        with pytest.raises(ValueError, match=rf"^guess: found an array of shape \(.*\), {wanted}"):
            sn.barrier(chain, *ends, guess=few)
    # the file that passes them on is no business of the user's
    with pytest.raises(sn.ConfigError, match="^path.guess: the array has 10 spins, but the chain has 20 sites"):
        sn.barrier(chain, *ends, guess=reversal.spins[:, :10])
    # what numpy would make numbers of without a word
    half_masked = np.ma.masked_array(broken[0], mask=[[k < 10] * 3 for k in range(20)])
    with pytest.raises(ValueError, match="^initial: found an array of which some numbers are masked"):
        sn.barrier(chain, half_masked, ends[1])
    for kind in ("complex128", "bool", "<U1"):
        with pytest.raises(TypeError, match=f"^state: found an array of {kind}, expected vectors"):
            sn.relax(chain, np.zeros((20, 3), dtype=kind))
    for nothing in ("left", sn.sweep, [[1, 2], [1, 2, 3]]):
        with pytest.raises(TypeError, match="^guess: found .*expected vectors"):
            sn.barrier(chain, *ends, guess=nothing)


def test_one_temperature_stands_for_a_list_of_one(chain, reversal):
    ends = sn.uniform("z"), sn.uniform("-z")
    want = sn.rates(reversal, [4.0]).lifetimes_s()
    for one in ("4 K", 4, np.int64(4), np.array(4.0)):
        assert sn.rates(reversal, one).lifetimes_s() == want
        assert sn.barrier(chain, *ends, temperatures=one).rates.lifetimes_s() == pytest.approx(want, rel=1e-12)
    assert sn.landscape(chain, temperatures="4 K").lifetimes
    with pytest.raises(TypeError, match="^rates takes a Result"):
        sn.rates(chain, 4)
    with pytest.raises(TypeError, match=r"^states is a list of states, also of one: write \[uniform"):
        sn.landscape(chain, states=sn.uniform("x"))


@pytest.mark.parametrize(
    "package, use",
    [
        ("matplotlib", lambda result: result.plot()),
        ("matplotlib", lambda result: result.plot_spins()),
        ("matplotlib", lambda result: sn.rates(result, 4).plot()),
        ("pandas", lambda result: result.to_dataframe()),
        ("pandas", lambda result: sn.rates(result, 4).to_dataframe()),
        ("xarray", lambda result: result.to_xarray()),
        ("pyvista", lambda result: result.plot_3d()),
        ("discretisedfield", lambda result: sn.to_field(result)),
    ],
)
def test_a_package_that_is_not_there_is_told_how_it_comes(reversal, monkeypatch, package, use):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ModuleNotFoundError, match=f"needs {package}, .*: pip install {package}$"):
        use(reversal)


def test_files_and_folders_that_are_not_there(tmp_path, chain, reversal):
    with pytest.raises(FileNotFoundError, match="nothing.json"):
        sn.run(tmp_path / "nothing.json")
    with pytest.raises(FileNotFoundError, match="no finished result"):
        sn.load(tmp_path)
    reversal.save(tmp_path / "r", formats=["csv"])
    with pytest.raises(sn.SpinnebError, match="there is no path.npz"):
        sn.load(tmp_path / "r")


def test_threads_are_counted(chain):
    for threads in (-1, 0, 100_000, 10**30):
        with pytest.raises(sn.ConfigError, match="threads"):
            sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), threads=threads)
    with pytest.raises(TypeError, match="threads: found 2.5, expected a whole number"):
        sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), threads=2.5)
    with pytest.raises(sn.ConfigError, match="modes: found -1, expected 0 or more"):
        sn.relax(chain, sn.uniform("z"), modes=-1)
    assert len(sn.relax(chain, sn.uniform("z"), modes=10**30).lowest_eigenvalues_meV) > 10


def test_a_run_without_a_barrier_says_why(chain):
    result = sn.barrier(chain, sn.uniform("z"), sn.uniform([0.1, 0, 1]))
    assert result.barrier_meV is None and result.stop_reason in repr(result)
    with pytest.raises(sn.SpinnebError, match="certified"):
        sn.rates(result, 300)


def test_errors_are_pickled(chain):
    with pytest.raises(sn.ConfigError) as error:
        sn.run({})
    assert str(pickle.loads(pickle.dumps(error.value))) == str(error.value)


def test_waypoints_may_be_vectors_and_what_is_wrong_with_them_is_said(chain):
    half = np.zeros((20, 3))
    half[:10, 2], half[10:, 2] = 1, -1
    by_vectors = sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), guess=sn.waypoints([half]))
    assert by_vectors.barrier_meV["forward"] > 0 and by_vectors.certified
    assert sn.waypoints([half]) == sn.waypoints([{"vectors": half}])
    with pytest.raises(ValueError, match=r"states\[1\]: found an array of shape \(3,\), expected \(sites, 3\)"):
        sn.waypoints([half, [0, 0, 1]])


def test_numbers_that_are_none_are_told_with_their_place(chain):
    with pytest.raises(ValueError, match=r"^neb\.tolerance: found nan, expected a finite number"):
        sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), neb={"tolerance": float("nan")})
    with pytest.raises(ValueError, match=r"^energy\[0\]\.zeeman\.B\[2\]: found inf"):
        sn.System(sn.chain(3), [sn.zeeman([0.0, 0.0, float("inf")])], moment="2 mu_B", name="x").to_json()
