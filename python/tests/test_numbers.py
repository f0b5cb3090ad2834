"""What Python finds is what the command line finds, to the bit."""

import io
import json
import os
from pathlib import Path

import numpy as np
import pytest

import spinneb as sn

SHIPPED = Path(os.environ.get("SPINNEB_CONFIGS") or Path(__file__).parents[2] / "configs")
CONFIGS = sorted(path.stem for path in SHIPPED.glob("*.json"))
QUICK = ["wall_nucleation", "wall_depinning", "coherent_reversal", "chirality_reversal", "antiferromagnet", "nanowire_pinning"]


def numbers(summary):
    """A summary without what depends on the machine."""
    summary = json.loads(json.dumps(summary))
    summary.pop("manifest", None)
    del summary["work"]["seconds"], summary["work"]["threads"]
    return summary


def same(config, command, folder):
    done = command("run", config, "--out", folder, "--quiet", "--json")
    assert done.returncode in (0, 3), done.stderr
    result = sn.run(config)
    stored = json.loads((folder / "summary.json").read_text())
    assert numbers(result.summary) == numbers(stored)
    with np.load(folder / "path.npz") as arrays:
        assert np.array_equal(result.spins, arrays["spins"])
        assert np.array_equal(result.energies_meV, arrays["energy_meV"])
        assert np.array_equal(result.reaction_coordinate_rad, arrays["reaction_coordinate_rad"])
    assert result.summary["barrier_meV"] == json.loads(done.stdout)["barrier_meV"]


@pytest.mark.parametrize("name", QUICK)
def test_quick_configs_have_the_numbers_of_the_command_line(name, configs, command, tmp_path):
    same(set_formats(configs / f"{name}.json", tmp_path), command, tmp_path / "out")


@pytest.mark.slow
@pytest.mark.parametrize("name", CONFIGS)
def test_every_config_has_the_numbers_of_the_command_line(name, configs, command, tmp_path):
    same(set_formats(configs / f"{name}.json", tmp_path), command, tmp_path / "out")


def set_formats(config, folder):
    """The config with npz among its files and no figures, beside the materials that it names."""
    text = json.loads(config.read_text())
    text["output"] = {"formats": ["npz"], "plots": []}
    text.setdefault("name", config.stem)
    whole = json.dumps(text).replace('"materials/', f'"{config.parent}/materials/')
    file = folder / config.name
    file.write_text(whole)
    return file


def test_a_system_is_the_config_that_says_the_same(chain, reversal, tmp_path, command):
    file = tmp_path / "chain.json"
    file.write_text(chain.to_json(sn.uniform("z"), sn.uniform("-z")))
    assert numbers(sn.run(file).summary) == numbers(reversal.summary)
    assert numbers(sn.run(json.loads(file.read_text())).summary) == numbers(reversal.summary)
    assert command("check", file).returncode == 0


def test_threads_change_nothing(chain):
    one, two = (sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), threads=n) for n in (1, 2))
    assert np.array_equal(one.spins, two.spins)
    assert numbers(one.summary) == numbers(two.summary)
    assert (one.summary["work"]["threads"], two.summary["work"]["threads"]) == (1, 2)


def test_values_are_set_as_on_the_command_line(configs):
    result = sn.run(configs / "wall_nucleation.json", set={"path.images": 9, "name": "other"})
    assert (result.name, len(result.spins)) == ("other", 9)


def test_a_state_and_a_first_path_may_be_arrays(chain, reversal):
    again = sn.barrier(chain, reversal.initial, reversal.final, guess=reversal.spins, images=len(reversal.spins))
    assert again.barrier_meV["forward"] == pytest.approx(reversal.barrier_meV["forward"], abs=1e-11)
    assert again.config["path"]["guess"]["file"]["path"] == "inputs/guess.npy"
    turned = -reversal.initial
    assert sn.barrier(chain, turned, reversal.initial).certified
    with pytest.raises(ValueError, match=r"found an array of shape \(20, 2\), expected \(sites, 3\)"):
        sn.barrier(chain, reversal.initial[:, :2], reversal.final)
    with pytest.raises(ValueError, match=r"expected \(images, sites, 3\)"):
        sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), guess=reversal.initial)


def test_the_command_comes_along_with_its_sweeps(command, configs, tmp_path):
    sweep = {"config": str(configs / "coherent_reversal.json"), "set": {"output": {"formats": [], "plots": []}},
             "grid": {"path.images": [9, 11]}}
    (tmp_path / "s.json").write_text(json.dumps(sweep))
    done = command("sweep", "s.json", "--jobs", "2", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [json.loads(line)["certified"] for line in done.stdout.splitlines()] == [True, True]
    assert command("--version").stdout.strip() == f"spinneb {sn.__version__}"
    assert command("run").returncode == 2


def test_states_are_relaxed_and_told_of(chain, command, tmp_path):
    state = sn.relax(chain, sn.domain_wall(10))
    assert state.is_minimum and state.energies_meV.keys() == {"exchange", "anisotropy"}
    assert not state.spins.flags.writeable and state.spins.shape == (20, 3)
    assert state.energy_meV == pytest.approx(sum(state.energies_meV.values()), abs=1e-9)
    both = sn.relax(chain, sn.uniform("z"), sn.uniform([1, 0, 0]))
    assert [one.is_minimum for one in both] == [True, True]
    # a relaxed state stands for a state
    assert sn.barrier(chain, both[0], sn.uniform("-z")).certified
    (tmp_path / "c.json").write_text(chain.to_json(sn.domain_wall(10), sn.uniform("z")))
    told = command("relax", tmp_path / "c.json", "--json", "--quiet").stdout.splitlines()
    assert json.loads(told[0])["energy_meV"] == state.energy_meV
    # and what was said of the config is said of the state
    np.save(tmp_path / "long.npy", np.tile([0.0, 0.0, 3.0], (20, 1)))
    long = sn.relax(chain, sn.file(str(tmp_path / "long.npy")))
    assert any("only their directions are used" in warning for warning in long.warnings), long.warnings


def test_a_check_says_what_the_command_line_says(configs, command):
    file = configs / "dmi_chain.json"
    found = sn.check(file)
    rows = repr(found).splitlines()
    told = command("check", file).stdout.splitlines()[1:]
    drop = [k for k, row in enumerate(rows) if row.startswith("time")]
    assert [row for k, row in enumerate(rows) if k not in drop] == [row[2:] for k, row in enumerate(told) if k not in drop]
    assert "exchange" in found["energies"] and "images" in found


def test_a_landscape_is_that_of_the_command_line(chain, command, tmp_path):
    (tmp_path / "c.json").write_text(chain.to_json())
    chosen = ["--set", 'landscape.energy_window="9 meV"', "--effort", "quick", "--quiet"]
    assert command("landscape", tmp_path / "c.json", "--out", tmp_path / "l", *chosen).returncode == 0
    found = sn.landscape(chain, energy_window="9 meV", effort="quick")
    stored = sn.load(tmp_path / "l")
    assert found.finished and stored.finished
    assert found.minimum_kinds == stored.minimum_kinds
    assert found.saddles == stored.saddles and len(found.saddles) >= 1
    assert len(found.minima) == found.summary["minima"]
    assert found.minimum_spins.shape == (len(found.minima), 20, 3) and len(found.saddle_spins) == len(found.saddles)
    assert "<svg" in found._repr_html_()


def test_every_part_of_a_config_can_be_written_by_a_builder():
    schema = json.loads(sn._core.config_schema())
    for module, family in [(sn.lattices, "LatticeSpec"), (sn.terms, "TermSpec"), (sn.states, "StateSpec"),
                           (sn.guesses, "GuessSpec"), (sn.optimisers, "OptimiserSpec"), (sn.shapes, "Shape")]:
        members = [next(iter(choice["properties"])) for choice in schema["definitions"][family]["oneOf"]]
        assert [name.rstrip("_") for name in module.__all__] == members


def test_pieces_show_themselves_as_they_are_written():
    assert sn.uniform("-z") == {"uniform": {"direction": [0, 0, -1]}}
    assert sn.exchange(J="10 meV") == sn.exchange(J=["10 meV"])
    assert repr(sn.exchange(J=["10 meV"])) == "exchange(J=['10 meV'])"
    assert repr(sn.square(4, 5, periodic=True)) == "square(4, 5, periodic=True)"
    assert sn.triangular(4, 5, periodic=True) == {"triangular": {"cells": [4, 5], "periodic": True}}
    assert sn.square((4, 5)) == sn.square(4, 5) == sn.square(*np.array([4, 5])) and sn.lattices.grid(4, cell=["1 nm"])["grid"]["cells"] == [4]
    assert (sn.shapes.disc(3) & ~sn.shapes.disc(1)) == {"all": [{"disc": {"radius": 3}}, {"not": {"disc": {"radius": 1}}}]}
    assert sn.sweep("left") == {"sweep": {"from": "left"}}
    assert sn.zeeman(B=np.array(["1 T", "0 T", "0 T"])) == {"zeeman": {"B": ["1 T", "0 T", "0 T"]}}
    assert sn.regions(sn.uniform("z"), pin=sn.uniform("x"))["regions"].keys() == {"default", "pin"}
    assert json.loads(json.dumps(sn.random(3))) == {"random": {"seed": 3}}


def test_rates_are_those_of_a_run_that_asks_for_them(configs):
    config = json.loads((configs / "wall_nucleation.json").read_text())
    config["material"] = str(configs / "materials" / "toy.json")
    plain, asked = sn.run(config), sn.run({**config, "rates": {"temperatures": ["5 K", "8 K"]}})
    found = sn.rates(plain, [5, "8 K"])
    times = [[row["first_passage_s"] for row in one["temperatures"]] for one in asked.summary["transition_rates"]]
    assert found.lifetimes_s() == pytest.approx(times[0], rel=1e-9) and found.lifetimes_s("backward") == pytest.approx(times[1], rel=1e-9)
    assert found.saddles[0]["langer_prefactor_Hz"] == pytest.approx(asked.summary["rates"][0]["langer_prefactor_Hz"], rel=1e-9)
    assert np.array_equal(found.temperatures_K, [5, 8])
    assert np.all(np.diff(found.lifetimes_s()) < 0)
    assert found.lifetimes_s(log10=True) == pytest.approx(np.log10(found.lifetimes_s()))
    assert "rates" not in plain.summary or plain.summary["rates"] is None
    assert len(found.to_dataframe()) == 4


def test_a_stored_file_of_arrays_is_not_needed_to_run_again(reversal):
    with np.load(io.BytesIO(reversal._core.files(["npz"])["path.npz"])) as arrays:
        assert np.array_equal(arrays["spins"], reversal.spins)
