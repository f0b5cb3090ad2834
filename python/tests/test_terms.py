"""Energy terms written in Python."""

import json

import numpy as np
import pytest

import spinneb as sn

EXCHANGE = sn.exchange(J=["10 meV"])
UP, DOWN = sn.uniform("z"), sn.uniform("-z")


def easy(m):
    return 0.5 * (1 - m[:, 2] ** 2)


def easy_gradient(m):
    return np.stack([0 * m[:, 0], 0 * m[:, 0], -m[:, 2]], axis=1)


def system(*terms, sites=20):
    return sn.System(sn.chain(sites), [EXCHANGE, *terms], moment="2 mu_B", name="own")


def test_an_easy_axis_of_ones_own_is_as_good_as_the_built_in_one(reversal):
    result = sn.barrier(system(sn.Term(easy, easy_gradient)), UP, DOWN)
    assert result.certified
    assert result.barrier_meV["forward"] == pytest.approx(reversal.barrier_meV["forward"], abs=1e-11)
    assert list(result.terms_meV) == ["exchange", "easy"]


def test_a_function_whose_name_is_taken_in_tables_makes_a_term_too():
    def energy(m):
        return easy(m)

    def exchange(m):
        return easy(m)

    assert [sn.Term(f, easy_gradient).name for f in (easy, energy, exchange, lambda m: easy(m))] == ["easy", "term", "term", "term"]
    result = sn.barrier(system(sn.Term(energy, easy_gradient)), UP, DOWN)
    assert list(result.terms_meV) == ["exchange", "term"]


def test_terms_of_fourth_degree_and_of_one_number_run(reversal):
    def fourth(m):
        return float(0.5 * (1 - m[:, 2] ** 4).sum())

    def slope(m):
        g = np.zeros_like(m)
        g[:, 2] = -2 * m[:, 2] ** 3
        return g

    def curve(m, v):
        h = np.zeros_like(m)
        h[:, 2] = -6 * m[:, 2] ** 2 * v[:, 2]
        return h

    built_in = sn.anisotropy(K="0 meV", K2="0.5 meV")
    wanted = sn.barrier(system(built_in, sites=10), UP, DOWN).barrier_meV["forward"]
    for term in (sn.Term(fourth, slope), sn.Term(fourth, slope, hessian=curve, quadratic=False, reach=0)):
        result = sn.barrier(system(term, sites=10), UP, DOWN)
        assert result.barrier_meV["forward"] == pytest.approx(wanted, abs=1e-9)
        assert result.certified


def test_a_term_in_which_all_sites_meet_runs():
    def field(m):
        return float(m[:, 2].sum() ** 2) / len(m)

    def gradient(m):
        return np.outer(np.full(len(m), 2 * m[:, 2].sum() / len(m)), [0, 0, 1])

    for reach in (None, "dense"):
        own = sn.Term(field, gradient, name="mean", reach=reach)
        result = sn.barrier(system(sn.anisotropy(K="1.5 meV"), own, sites=8), UP, DOWN)
        assert result.certified


def test_a_system_keeps_its_own_terms_when_others_are_added():
    one = system(sn.Term(easy, easy_gradient, name="one"))
    two = one.replaced(energy=[*one.energy, sn.Term(easy, easy_gradient, name="two")])
    assert [term.name for term in two.terms] == ["one", "two"]
    assert list(sn.barrier(two, UP, DOWN, effort="none").terms_meV) == ["exchange", "one", "two"]


def test_a_term_of_single_precision_is_refused_as_that():
    rough = sn.Term(lambda m: easy(m.astype(np.float32)), easy_gradient)
    with pytest.raises(ValueError, match="float32, but energies need float64"):
        sn.barrier(system(rough), UP, DOWN)


def test_wrong_terms_are_refused_with_what_is_wrong():
    def refused(term, words, sites=20):
        with pytest.raises(ValueError, match=words):
            sn.barrier(system(term, sites=sites), UP, DOWN)

    refused(sn.Term(easy, lambda m: 1.01 * easy_gradient(m)), "gradient is not that of its energy")
    refused(sn.Term(easy, easy_gradient, quadratic=True, reach=-1), "reach")
    refused(sn.Term(lambda m: easy(m) * np.nan, easy_gradient, name="nan"), "not finite")
    refused(sn.Term(lambda m: easy(m) ** 2, lambda m: 2 * easy(m)[:, None] * easy_gradient(m), name="q", quadratic=True),
            "said to be quadratic")
    refused(sn.Term(lambda m: None, easy_gradient, name="none"), "energy of the term 'none' returned nothing")
    refused(sn.Term(lambda m: easy(m)[:3], easy_gradient), r"shape \(3,\), expected \(20,\)")
    refused(sn.Term(easy, lambda m: m[:, :2]), r"shape \(20, 2\), expected \(20, 3\)")
    refused(sn.Term(easy, easy_gradient, name="exchange"), "the name of something else")
    refused(sn.Term(easy, easy_gradient, name="a b"), "custom_terms")
    with pytest.raises(ValueError, match="two terms are called 'easy'"):
        system(sn.Term(easy, easy_gradient), sn.Term(easy, easy_gradient))


def test_what_a_function_raises_is_raised():
    calls = []

    def late(m):
        calls.append(1)
        if len(calls) > 60:
            raise ZeroDivisionError("in my function")
        return easy_gradient(m)

    with pytest.raises(ZeroDivisionError, match="in my function"):
        sn.barrier(system(sn.Term(easy, late)), UP, DOWN)


def test_an_energy_that_becomes_none_on_the_way_is_an_error():
    calls = []

    def late(m):
        calls.append(1)
        return easy_gradient(m) * (np.nan if len(calls) > 60 else 1)

    with pytest.raises(sn.SpinnebError, match='not a finite number, that of "easy"|"easy": '):
        sn.barrier(system(sn.Term(easy, late)), UP, DOWN)


def test_the_command_line_refuses_a_config_with_such_a_term(command, tmp_path):
    file = tmp_path / "own.json"
    file.write_text(system(sn.Term(easy, easy_gradient)).to_json(UP, DOWN))
    done = command("run", file)
    assert done.returncode == 2 and '"easy" is a term of the program that wrote this config' in done.stderr


def test_relaxed_states_rates_and_pickles_of_such_systems(tmp_path):
    own = system(sn.Term(easy, easy_gradient))
    assert sn.relax(own, UP).energies_meV["easy"] == 0
    result = sn.barrier(own, UP, DOWN, out=tmp_path / "r")
    assert sn.rates(result, 5).lifetimes_s() > 0
    stored = sn.load(tmp_path / "r")
    assert np.array_equal(stored.spins, result.spins)
    assert json.loads((tmp_path / "r" / "config.json").read_text())["custom_terms"] == ["easy"]
    # the functions may be others: the folder is written anew
    sn.barrier(system(sn.Term(lambda m: 2 * easy(m), lambda m: 2 * easy_gradient(m), name="easy")), UP, DOWN, out=tmp_path / "r")
    assert sn.load(tmp_path / "r").barrier_meV["forward"] > 1.2 * stored.barrier_meV["forward"]
