"""What results offer: views, tables, figures, files, pickles."""

import copy
import gc
import json
import pickle

import numpy as np
import pytest

import spinneb as sn


def test_arrays_are_read_only_views_of_one_memory(reversal):
    spins = reversal.spins
    assert spins.dtype == np.float64 and spins.ndim == 3 and spins.shape[1:] == (20, 3)
    assert not spins.flags.writeable and not spins.flags.owndata
    address = spins.__array_interface__["data"][0]
    assert reversal.spins.__array_interface__["data"][0] == address
    assert np.shares_memory(reversal.initial, spins) and np.shares_memory(reversal.final, spins)
    with pytest.raises(ValueError):
        spins[0, 0, 0] = 1
    assert np.allclose(np.linalg.norm(spins, axis=2), 1, atol=1e-14)
    for column in (reversal.energies_meV, reversal.above_initial_meV, reversal.reaction_coordinate_rad):
        assert not column.flags.writeable and column.shape == (len(spins),)
    assert reversal.energies_meV.__array_interface__["data"][0] == reversal.energies_meV.__array_interface__["data"][0]


def test_arrays_outlive_their_result(chain):
    result = sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"))
    spins, saddle = result.spins, result.saddles[0].spins
    kept = spins.copy(), saddle.copy()
    del result
    gc.collect()
    junk = [np.ones(spins.size) for _ in range(50)]
    assert np.array_equal(spins, kept[0]) and np.array_equal(saddle, kept[1])
    assert len(junk) == 50


def test_numbers_are_named_as_in_the_summary(reversal):
    assert reversal.barrier_meV["forward"] == reversal.summary["barrier_meV"]["forward"]
    assert reversal.certified and reversal.converged and isinstance(reversal.warnings, list)
    saddle = reversal.saddles[0]
    assert saddle.negative_modes == 1 and saddle.spins.shape == (20, 3)
    assert saddle.above_initial_meV == pytest.approx(reversal.barrier_meV["forward"])
    assert saddle.lowest_eigenvalues_meV[0] < 0 and not saddle.lowest_eigenvalues_meV.flags.writeable
    assert sum(mev for mev in reversal.terms_meV.values()) == pytest.approx(reversal.energies_meV)
    s, e = reversal.profile
    assert e.max() == pytest.approx(reversal.barrier_meV["forward"], rel=1e-3)
    assert repr(reversal).startswith("<Result chain: barrier 6.2") and "certified" in repr(reversal)
    assert reversal.places[:, 0].tolist() == list(range(20)) and reversal.places_nm is None


def test_a_search_whose_work_was_spent_is_told_of(reversal):
    assert reversal.search == reversal.summary["search"] and reversal.search["effort"] == "normal"
    assert not reversal.search["spent"] and "search" not in repr(reversal)
    spent = sn.Result(reversal._core, {**reversal.summary, "search": {**reversal.search, "spent": True}})
    assert repr(spent).endswith("certified, the search for lower passes ended early as its work was spent>")


def test_a_run_with_temperatures_has_the_rates_that_are_made_of_it_later(chain, reversal):
    assert reversal.rates is None
    result = sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), temperatures=[4.0])
    assert result.rates.lifetimes_s() == pytest.approx(sn.rates(reversal, 4.0).lifetimes_s(), rel=1e-12)


def test_what_is_given_stands_beside_what_the_system_asks_for(chain):
    system = chain.replaced(rates={"damping": 0.5, "theory": ["langer"]}, path={"images": 23}, search={"effort": "none"})
    config = sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), guess=sn.sweep("left"), temperatures=[4.0]).config
    assert config["rates"]["damping"] == 0.5 and config["rates"]["theory"] == ["langer"]
    assert config["path"]["images"] == 23 and config["search"] == {"effort": "none"}
    # a key that is given whole is what is given
    config = sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), rates={"g_factor": 2.1}, temperatures=[4.0]).config
    assert config["rates"]["g_factor"] == 2.1 and config["rates"].get("damping", 0.1) == 0.1


def test_a_time_too_long_for_a_number_is_infinite(reversal):
    rates = sn.rates(reversal, [0.05, 4.0])
    assert rates.lifetimes_s()[0] == np.inf and np.isfinite(rates.lifetimes_s(log10=True)).all() and rates.reasons == [None, None]
    assert rates.to_dataframe()["first_passage_s"][0] == np.inf and "10^" in rates._told("forward")[0]


def test_temperatures_are_numbers_quantities_or_a_range(chain, reversal):
    several = [4.0, [2.0, "3 K"], (t for t in (2.0, 3.0)), np.array(4.0), {"from": "2 K", "to": "4 K", "points": 3}]
    found = [sn.rates(reversal, asked).temperatures_K.tolist() for asked in several]
    assert found == [[4.0], [2.0, 3.0], [2.0, 3.0], [4.0], [2.0, 3.0, 4.0]]
    with pytest.raises(TypeError, match="temperatures are numbers in K"):
        sn.rates(reversal, [[2.0, 3.0]])


def test_words_that_name_nothing_are_refused(chain, reversal):
    rates = sn.rates(reversal, 4.0)
    for wrong in (lambda: rates.lifetimes_s("backwards"), lambda: rates.prefactors_Hz("back")):
        with pytest.raises(ValueError, match="way is one of 'forward', 'backward', found 'back"):
            wrong()
    with pytest.raises(ValueError, match="theory is one of 'htst', 'langer'"):
        rates.prefactors_Hz(theory="Langer")
    pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="no temperatures were given"):
        sn.landscape(chain, effort="none", energy_window="7 meV").to_dataframe("lifetimes")


def test_a_landscape_is_saved_wherever_it_comes_from(chain, tmp_path):
    found = sn.landscape(chain, effort="quick", energy_window="9 meV")
    found.save(tmp_path / "own")
    pickle.loads(pickle.dumps(found)).save(tmp_path / "pickled")
    sn.load(tmp_path / "own").save(tmp_path / "loaded")
    for other in ("pickled", "loaded"):
        for file in (tmp_path / "own").iterdir():
            assert file.name == "manifest.json" or (tmp_path / other / file.name).read_bytes() == file.read_bytes()


def test_rates_made_later_keep_what_the_config_says_of_them(chain):
    ends = [sn.uniform("z"), sn.uniform("-z")]
    result = sn.barrier(chain, *ends, rates={"temperatures": ["4 K"], "damping": 0.5, "theory": ["langer"]})
    lifetimes = result.rates.lifetimes_s()
    assert sn.rates(result, 4.0).lifetimes_s() == pytest.approx(lifetimes, rel=1e-12)
    assert sn.rates(result, 4.0, damping=0.1).lifetimes_s() != pytest.approx(lifetimes, rel=1e-3)


def test_tables_have_the_columns_of_path_csv(reversal):
    frame = reversal.to_dataframe()
    header = reversal._core.files(["csv"])["path.csv"].decode().splitlines()[0].split(",")
    assert list(frame.columns) == header
    assert frame["energy_meV"].to_numpy() == pytest.approx(reversal.energies_meV)
    data = reversal.to_xarray()
    assert data["spins"].dims == ("image", "site", "component")
    assert float(data["spins"].sel(component="z").isel(image=0, site=3)) == reversal.spins[0, 3, 2]


def test_the_table_of_a_film_has_its_charge():
    system = sn.System(sn.triangular(6, 6), [sn.exchange(J=["5 meV"]), sn.anisotropy(K="1 meV")], moment="3 mu_B")
    film = sn.barrier(system, sn.uniform("z"), sn.uniform("-z"), effort="none")
    frame = film.to_dataframe()
    header = film._core.files(["csv"])["path.csv"].decode().splitlines()[0].split(",")
    assert list(frame.columns) == header and header[-1] == "charge"
    assert frame["charge"].to_numpy() == pytest.approx(0, abs=0.6) and "charge" in film.to_xarray()


def test_what_is_in_doubt_is_told_in_every_figure(reversal):
    config = {**reversal.config, "neb": {"max_evaluations": 5}, "path": {"images": 11}}
    # this wall leaves the chain, the side that is longer stays
    config |= {"initial": {"domain_wall": {"center": 4}}, "final": {"uniform": {"direction": [0, 0, 1]}}}
    open_ = sn.run(config)
    assert not open_.certified
    title = open_.plot().get_title()
    assert "not certified" in title and "≈" in title and "initial state relaxed far" in title
    titles = [axes.get_title() for axes in open_.plot_spins()]
    assert "relaxed far" in titles[0] and any("not certified" in title for title in titles)
    assert "about" in repr(open_) and "not certified" in repr(open_)
    sure = [reversal.plot().get_title(), *(axes.get_title() for axes in reversal.plot_spins())]
    assert not any("not certified" in title or "≈" in title for title in sure)


def test_lifetimes_below_five_kt_are_grey(reversal):
    axes = sn.rates(reversal, [4.0, 10.0, 20.0, 30.0]).plot()
    sure, grey = axes.get_lines()[:2]
    # from hot to cold
    assert np.isnan(sure.get_ydata()).tolist() == [True, True, False, False]
    assert np.isnan(grey.get_ydata()).tolist() == [False, False, False, True]
    assert grey.get_color() != sure.get_color()


def test_lifetimes_are_an_arrhenius_plot(chain, reversal):
    axes = sn.rates(reversal, [2.0, 4.0, 0.01]).plot()
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_yscale()) == ("1000 K / T", "mean lifetime (s)", "log")
    curve = axes.get_lines()[0]
    # from hot to cold, without a time that is beyond all that a figure shows
    assert curve.get_xdata() == pytest.approx([250, 500, 100000])
    assert curve.get_ydata() == pytest.approx([*sn.rates(reversal, [4.0, 2.0]).lifetimes_s(), np.nan], nan_ok=True)
    assert [text.get_text() for text in axes.texts] == ["1 s"] and axes.get_legend() is None
    field = chain.replaced(energy=[*chain.energy, sn.zeeman(B=["0 T", "0 T", "0.3 T"])])
    both = sn.rates(sn.barrier(field, sn.uniform("z"), sn.uniform("-z")), [2.0, 4.0, 20.0]).plot()
    assert [text.get_text() for text in both.get_legend().get_texts()] == ["forward", "backward", "barrier below 5 $k_BT$"]
    assert "0.01 K: 10^3138 s" in repr(sn.rates(reversal, 0.01))
    none = sn.rates(reversal, 300).plot()
    assert "no lifetime" in none.texts[0].get_text()


def test_maps_of_spins_have_a_key_of_their_colours(reversal):
    import matplotlib.pyplot as plt

    first = reversal.plot_spins()[0].figure
    assert len(first.axes) == 4 and "m_z" in first.axes[-1].texts[-1].get_text()
    assert "arrows" in first.axes[-1].texts[-1].get_text()
    film = sn.relax(sn.System(sn.square(4, 4), [sn.exchange(J=["5 meV"]), sn.anisotropy(K="1 meV")]), sn.uniform("z"))
    key = film.plot_spins()[0].figure.axes[-1]
    assert [text.get_text() for text in key.texts[:2]] == ["+x", "+y"] and "arrows" not in key.texts[-1].get_text()
    # white in the middle and black around it, as the film's spins up are white
    colours = key.get_images()[0].get_array()
    assert colours[100, 100, :3].min() > 0.9 and colours[100, 0, :3].max() < 0.2
    _, (map_, own) = plt.subplots(1, 2)
    assert film.plot_spins([map_]) == [map_] and not own.texts
    assert film.plot_spins([map_], key=own) == [map_] and own.texts


def test_sites_without_a_spin_are_told_and_left_blank():
    from matplotlib.collections import PolyCollection

    lattice = sn.grid(8, 6, 1, cell=["2 nm", "4 nm", "1 nm"], vacant=[17, 18])
    film = sn.System(lattice, [sn.exchange(A="13 pJ/m"), sn.anisotropy(K="500 kJ/m^3")], Ms="800 kA/m")
    state = sn.relax(film, sn.uniform("-z"))
    assert np.flatnonzero(state.vacant).tolist() == [17, 18] and state.spins[~state.vacant].mean(0)[2] == -1
    (cells,) = [one for one in state.plot_spins()[0].collections if isinstance(one, PolyCollection)]
    assert len(cells.get_paths()) == 46
    # as high as the next site is far: twice as high as wide
    wide, high = np.ptp(cells.get_paths()[0].vertices, axis=0)
    assert high == pytest.approx(2 * wide)


def test_figures_are_drawn_on_axes(reversal):
    axes = reversal.plot()
    assert axes.get_xlabel() == "reaction coordinate (rad)" and "6.2" in axes.get_title()
    assert reversal.plot(axes, color="k") is axes
    assert len(reversal.plot_spins()) == 3
    assert len(reversal.plot_spins([0, -1])) == 2
    with pytest.raises(IndexError, match="no image 99: the path has images 0 to"):
        reversal.plot_spins([0, 99])
    film = sn.System(sn.triangular(6, 6), [sn.exchange(J=["5 meV"]), sn.anisotropy(K="1 meV")])
    assert len(sn.barrier(film, sn.uniform("z"), sn.uniform("-z"), effort="none").plot_spins()) >= 2
    assert len(sn.relax(film, sn.uniform("z")).plot_spins()) == 1


def test_spins_are_drawn_in_three_dimensions(reversal, monkeypatch):
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    monkeypatch.setattr(pyvista, "OFF_SCREEN", True)
    views = reversal.plot_3d()
    assert views.shape == (1, 3)
    picture = views.screenshot(return_img=True)
    # up is drawn light and down dark: the last view is darker than the first
    first, last = picture[100:, : picture.shape[1] // 3], picture[100:, -picture.shape[1] // 3 :]
    assert last.min() < first.min() < 250
    scene = pyvista.Plotter()
    assert reversal.plot_3d([0], plotter=scene, opacity=0.5) is scene
    [actor] = scene.actors.values()
    # an arrow for each site, of its own length along its spin
    size = np.ptp(np.asarray(actor.mapper.dataset.points), axis=0)
    assert size[0] == pytest.approx(19, abs=0.5) and size[2] == pytest.approx(0.85, abs=1e-3)
    crystal = sn.System(sn.cubic(3, 3, 3), [sn.exchange(J=["5 meV"]), sn.anisotropy(K="1 meV")])
    assert sn.relax(crystal, sn.uniform("z")).plot_3d().screenshot(return_img=True).std() > 1


def test_the_report_stands_in_the_cell(reversal):
    cell = reversal._repr_html_()
    assert cell.startswith("<iframe srcdoc=") and "6.2" in cell
    assert reversal.html().lstrip().lower().startswith("<!doctype html>")


def test_temperatures_without_a_lifetime_for_one_reason_are_one_line(reversal):
    told = repr(sn.rates(reversal, [2.0, 4.0, 300.0, 400.0, 500.0]))
    assert told.count("\n") == 3 and "300 K to 500 K (3 temperatures): none: ΔE is below 1 k_BT" in told
    # HTST has no rate where the moment along an axis is conserved
    found = sn.rates(reversal, np.arange(1, 11), theory=["htst"])
    assert repr(found).count("conserved") == 1 and "1 K to 10 K (10 temperatures): none" in repr(found)
    assert found._repr_html_().count("conserved") == 2 and len(found.result.warnings) == 1


def test_rates_and_systems_are_tables_in_a_cell(chain, reversal):
    cell = sn.rates(reversal, [0.01, 2.0, 4.0, 300.0])._repr_html_()
    for words in ("<th", "barrier / kT", "forward", "backward", ">300 K<", "10^3138 s", "none: ΔE is below 1 k_BT", "1000 K / T"):
        assert words in cell, words
    assert cell.count("<svg") == 1 and cell.count("<tr>") == 9
    assert "<svg" not in sn.rates(reversal, 4.0)._repr_html_()
    own = sn.Term(lambda m: m[:, 2], lambda m: np.tile([0.0, 0.0, 1.0], (len(m), 1)), name="a<b")
    system = chain.replaced(energy=[*chain.energy, own], initial=reversal.initial, final=sn.uniform("-z"), neb={"tolerance": 1e-7})
    cell = system._repr_html_()
    expected = ("System chain", "chain(sites=20)", "2 mu_B", "exchange(J=", "a&lt;b", "vectors of shape (20, 3)", "uniform(", "tolerance")
    for words in expected:
        assert words in cell, words


def test_results_are_saved_and_loaded(reversal, tmp_path):
    folder = tmp_path / "chain"
    reversal.save(folder)
    assert (folder / "report.html").exists() and (folder / "energy_path.svg").exists()
    again = sn.load(folder)
    assert np.array_equal(again.spins, reversal.spins)
    assert np.array_equal(again.saddles[0].spins, reversal.saddles[0].spins)
    assert again.summary == reversal.summary and again.config == reversal.config
    # the same result with other files takes its place; another one is refused
    reversal.save(folder, formats=["csv", "npz", "ovf", "vtk"])
    assert (folder / "path.pvd").exists() and not (folder / "report.html").exists()
    other = sn.System(sn.chain(10), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")], name="other")
    other = sn.barrier(other, sn.uniform("z"), sn.uniform("-z"))
    with pytest.raises(sn.SpinnebError, match="use force=True to replace"):
        other.save(folder)
    other.save(folder, force=True, formats=["csv", "npz", "ovf"])
    assert sn.load(folder).name == "other" and not (folder / "report.html").exists()
    with pytest.raises(sn.ConfigError, match="known kinds"):
        other.save(folder, formats=["cvs"], force=True)


def test_places_are_known_before_and_after_a_run_in_nm_too():
    grid = sn.System(
        sn.grid((4, 3, 1), cell=["2 nm", "4 nm", "1 nm"]), [sn.exchange(A="13 pJ/m"), sn.anisotropy(K="0.5 MJ/m^3")], Ms="800 kA/m"
    )
    x, y = np.meshgrid(1 + 2 * np.arange(4), 2 + 4 * np.arange(3))
    wanted = np.stack([x.ravel(), y.ravel(), np.full(12, 0.5)], axis=1)
    state = sn.relax(grid, sn.uniform("z"))
    result = sn.barrier(grid, sn.uniform("z"), sn.uniform("-z"))
    for places_nm in (grid.places_nm, state.places_nm, result.places_nm):
        assert np.abs(places_nm - wanted).max() < 1e-12 and not places_nm.flags.writeable
    assert np.abs(grid.places - wanted / 2).max() < 1e-12
    atoms = sn.System(sn.triangular(3, 3), [sn.exchange(J=["1 meV"])])
    assert atoms.places.shape == (9, 3) and atoms.places_nm is None


def test_a_run_writes_to_its_folder(chain, tmp_path):
    result = sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), out=tmp_path / "r")
    assert json.loads((tmp_path / "r" / "summary.json").read_text())["barrier_meV"] == result.barrier_meV
    table = tmp_path / "s" / "path.csv"
    table.parent.mkdir()
    table.write_text("of another program")
    with pytest.raises(sn.SpinnebError, match=r"path.csv.*force=True to replace[^-]*$"):
        sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), out=table.parent)
    sn.barrier(chain, sn.uniform("z"), sn.uniform("-z"), out=table.parent, force=True)
    assert sn.load(table.parent).barrier_meV == result.barrier_meV


def test_results_are_pickled(reversal, chain):
    again = pickle.loads(pickle.dumps(reversal))
    assert np.array_equal(again.spins, reversal.spins) and again.summary == reversal.summary
    assert np.array_equal(again.saddles[0].spins, reversal.saddles[0].spins)
    # and again, with all that belongs to it
    again = pickle.loads(pickle.dumps(again))
    assert again.plot().get_title() == reversal.plot().get_title()
    found = pickle.loads(pickle.dumps(sn.rates(reversal, [4.0])))
    assert found.lifetimes_s() > 0
    assert pickle.loads(pickle.dumps(sn.skyrmion(radius=3))) == sn.skyrmion(radius=3)
    assert pickle.loads(pickle.dumps(chain)).to_json() == chain.to_json()


def test_a_result_without_a_saddle_is_stored_like_any_other(chain, tmp_path):
    switched = chain.replaced(energy=[*chain.energy, sn.zeeman(B=["0 T", "0 T", "20 T"])])
    result = sn.barrier(switched, sn.uniform("-z"), sn.uniform("z"), out=tmp_path / "own")
    assert result.barrier_meV is None and not result.saddles
    result.save(tmp_path / "saved")
    others = [pickle.loads(pickle.dumps(result)), copy.deepcopy(result), sn.load(tmp_path / "own"), sn.load(tmp_path / "saved")]
    others.append(sn.barrier(switched, sn.uniform("-z"), sn.uniform("z"), out=tmp_path / "own", resume=True))
    for other in others:
        assert other.summary == result.summary and np.array_equal(other.spins, result.spins)


def test_a_band_is_told_of_as_ase_does(reversal, tmp_path):
    tools = sn.NEBTools(reversal)
    barrier, difference = tools.get_barrier()
    assert barrier == pytest.approx(reversal.barrier_meV["forward"] * 1e-3) and abs(difference) < 1e-12
    assert tools.get_barrier(fit=False)[0] == pytest.approx(reversal.above_initial_meV.max() * 1e-3)
    assert tools.get_barrier(raw=True)[0] == pytest.approx(reversal.saddles[0].energy_meV * 1e-3)
    reversal.save(tmp_path / "r", formats=["csv", "npz", "ovf"])
    assert sn.NEBTools(tmp_path / "r").plot_band().axes


def test_fields_of_ubermag_come_in_and_go_out():
    df = pytest.importorskip("discretisedfield")
    mesh = df.Mesh(p1=(0, 0, 0), p2=(20e-9, 12e-9, 3e-9), n=(5, 3, 1))
    field = df.Field(mesh, nvdim=3, value=lambda r: (r[0], r[1], 5e-9), norm=8e5)
    lattice, spins, norm = sn.from_field(field)
    assert lattice["grid"]["cells"] == [5, 3, 1] and norm == pytest.approx(8e5)
    # the first direction is the fastest
    assert spins[1] == pytest.approx(field.array[1, 0, 0] / 8e5) and spins[5] == pytest.approx(field.array[0, 1, 0] / 8e5)
    film = sn.System(lattice, [sn.exchange(A="13 pJ/m"), sn.anisotropy(K="500 kJ/m^3")], Ms=f"{norm} A/m")
    result = sn.barrier(film, spins, sn.uniform("-z"), relax_ends=False, effort=None)
    back = sn.to_field(result, 0, norm=norm)
    assert np.allclose(back.array, field.array) and back.mesh.allclose(mesh)
    # holes have no vectors, however they were named
    holed = film.replaced(lattice=sn.grid(5, 3, 1, cell=["4 nm", "4 nm", "3 nm"], vacant={"from": 0, "to": 3}))
    result = sn.barrier(holed, sn.uniform("z"), sn.uniform("-z"), relax_ends=False)
    blank = sn.to_field(result, 0).norm.array.transpose(2, 1, 0, 3).ravel() == 0
    assert 0 < blank.sum() < 5 and np.array_equal(blank, result.vacant)
