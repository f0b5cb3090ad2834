"""What runs have found."""

from __future__ import annotations

import io
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._html import drawing, paragraph, table
from ._optional import needs
from ._values import Array, in_nm

if TYPE_CHECKING:
    import pandas  # type: ignore[import-untyped,unused-ignore]
    import xarray
    from matplotlib.axes import Axes

__all__ = ["Check", "Landscape", "Rates", "Relaxed", "Result", "Saddle"]

Way = Literal["forward", "backward"]
Theory = Literal["htst", "langer"]
#: kinds of files that hold all of a result
_WHOLE = ["csv", "npz", "ovf"]


def vacant_sites(core: _core.Config | _core.Outcome) -> NDArray[np.bool_]:
    """Which sites have no spin, read-only."""
    vacant = np.array(core.vacant, dtype=bool)
    vacant.flags.writeable = False
    return vacant


def _read_only(numbers: Array) -> Array:
    numbers.flags.writeable = False
    return numbers


class Saddle:
    """A saddle of a path: the highest point of a pass."""

    def __init__(self, told: Mapping[str, Any], spins: Array) -> None:
        #: as summary.json has it
        self.summary: dict[str, Any] = dict(told)
        #: the vectors, (N, 3), read-only
        self.spins = spins

    @property
    def energy_meV(self) -> float:
        """Total energy."""
        return float(self.summary["energy_meV"])

    @property
    def above_initial_meV(self) -> float:
        """Energy above the initial state, which is not the difference of two large numbers."""
        return float(self.summary["energy_above_initial_meV"])

    @property
    def reaction_coordinate_rad(self) -> float:
        """Where on the path."""
        return float(self.summary["reaction_coordinate_rad"])

    @property
    def image(self) -> int:
        """The nearest image of the path."""
        return int(self.summary["image"])

    @property
    def negative_modes(self) -> int | None:
        """Directions that lead down: 1 of a saddle that is one."""
        found = self.summary["negative_modes"]
        return None if found is None else int(found)

    @property
    def zero_modes(self) -> int | None:
        """Directions that leave the energy as it is."""
        found = self.summary["zero_modes"]
        return None if found is None else int(found)

    @property
    def max_torque_meV(self) -> float | None:
        """What is left of the torque on any spin."""
        found = self.summary["max_torque_meV"]
        return None if found is None else float(found)

    @property
    def lowest_eigenvalues_meV(self) -> Array:
        """Of the Hessian on the spheres."""
        return _read_only(np.asarray(self.summary["lowest_eigenvalues_meV"], dtype=np.float64))

    def __repr__(self) -> str:
        return f"<Saddle {self.above_initial_meV:.6f} meV above the initial state, image {self.image}>"


class Result:
    """A minimum-energy path with its barrier and saddles; :func:`~spinneb.run`, :func:`~spinneb.barrier` and
    :func:`~spinneb.load` make it.

    Arrays are of float64 and read-only, without copies, and stay good for as long as anything refers to them. A result can be
    pickled; one of a system with terms of your own forgets their functions then, which only :func:`~spinneb.rates` would need.
    """

    def __init__(self, core: _core.Outcome, summary: dict[str, Any] | None = None) -> None:
        self._core = core
        self._summary = summary

    @property
    def summary(self) -> dict[str, Any]:
        """All numbers, as summary.json has them."""
        if self._summary is None:
            self._summary = json.loads(self._core.summary())
        return self._summary

    @property
    def name(self) -> str:
        """Name of the run."""
        return str(self.summary["name"])

    @property
    def config(self) -> dict[str, Any]:
        """The config as run, complete with its material."""
        found: dict[str, Any] = json.loads(self._core.json)
        return found

    @property
    def barrier_meV(self) -> Mapping[str, float] | None:
        """The barrier ``["forward"]`` (from the initial state) and ``["backward"]``; None where there is none to tell, as
        ``stop_reason`` says."""
        found: Mapping[str, float] | None = self.summary["barrier_meV"]
        return found

    @property
    def certified(self) -> bool:
        """Whether ends and saddles are proven to be what they are said to be."""
        return bool(self.summary["certified"])

    @property
    def converged(self) -> bool:
        """Whether the band met its tolerance."""
        return bool(self.summary["converged"])

    @property
    def stop_reason(self) -> str:
        """Why the run ended."""
        return str(self.summary["stop_reason"])

    @property
    def warnings(self) -> list[str]:
        """What you should know."""
        return list(self.summary["warnings"])

    @property
    def search(self) -> dict[str, Any]:
        """What was looked for below the best of the first paths: ``effort``, the number of ``searches`` and of the last ``quiet``
        ones, which brought no news, ``minima`` and ``saddles`` known in the end, ``lowered_by_meV``, and whether it ended before
        its time because its work was ``spent``; empty for results of version 0.1.0."""
        return dict(self.summary.get("search") or {})

    @property
    def spins(self) -> Array:
        """The path, (image, site, xyz)."""
        return np.asarray(self._core.spins)

    @property
    def initial(self) -> Array:
        """The initial state as relaxed, (site, xyz)."""
        first: Array = self.spins[0]
        return first

    @property
    def final(self) -> Array:
        """The final state as relaxed, (site, xyz)."""
        last: Array = self.spins[-1]
        return last

    @property
    def energies_meV(self) -> Array:
        """Total energy of each image."""
        return self._column("energies_meV")

    @property
    def above_initial_meV(self) -> Array:
        """Energy of each image above the initial state, which is not the difference of two large numbers."""
        return self._column("above_initial_meV")

    @property
    def reaction_coordinate_rad(self) -> Array:
        """Geodesic length of the path up to each image."""
        return self._column("reaction_coordinate_rad")

    @property
    def terms_meV(self) -> dict[str, Array]:
        """Energy of each image by energy term."""
        return {name: np.asarray(mev) for name, mev in self._core.terms}

    @property
    def profile(self) -> tuple[Array, Array]:
        """The interpolated energy path: reaction coordinate (rad) and energy above the initial state (meV)."""
        s, e = self._core.profile
        return np.asarray(s), np.asarray(e)

    @property
    def saddles(self) -> list[Saddle]:
        """The saddles along the path, in its order."""
        return [Saddle(told, np.asarray(m)) for told, m in zip(self.summary["saddles"], self._core.saddles)]

    @property
    def rates(self) -> Rates | None:
        """Rates and lifetimes, if the run had temperatures; :func:`~spinneb.rates` gives those at any others."""
        return Rates(self) if "rates" in self.summary else None

    @property
    def minima(self) -> list[Array]:
        """Minima between the ends, each (site, xyz)."""
        return [np.asarray(m) for m in self._core.minima]

    @property
    def places(self) -> Array:
        """Where the sites are, (site, xyz), in lattice constants; in a chain x is the number of the site."""
        return np.asarray(self._core.places)

    @property
    def places_nm(self) -> Array | None:
        """The same in nm; ``None`` where the lattice was given no length."""
        return in_nm(self.places, self._core.spacing_nm)

    @property
    def vacant(self) -> NDArray[np.bool_]:
        """Which sites have no spin, (site,): their vectors are +z, and mean nothing."""
        return vacant_sites(self._core)

    def _column(self, name: str) -> Array:
        return np.asarray(self._core.column(name))

    # tables and pictures

    def to_dataframe(self) -> pandas.DataFrame:
        """A row an image, as path.csv has it (pandas)."""
        needs("pandas")
        import pandas

        return pandas.DataFrame(self._table())

    def _table(self) -> dict[str, NDArray[Any]]:
        return {
            "image": np.arange(len(self.energies_meV)),
            "reaction_coordinate_rad": self.reaction_coordinate_rad,
            "energy_meV": self.energies_meV,
            **{f"{name}_meV": mev for name, mev in self.terms_meV.items()},
            "max_perpendicular_torque_meV": self._column("max_perpendicular_torque_meV"),
            "energy_above_initial_meV": self.above_initial_meV,
            **({} if (charge := self._core.column("charge")) is None else {"charge": np.asarray(charge)}),
        }

    def to_xarray(self) -> xarray.Dataset:
        """Spins and energies with their coordinates (xarray)."""
        needs("xarray")
        import xarray

        table = self._table()
        images = {"image": table.pop("image"), "reaction_coordinate_rad": ("image", table.pop("reaction_coordinate_rad"))}
        places = {axis: ("site", self.places[:, k]) for k, axis in enumerate("xyz")}
        return xarray.Dataset(
            {"spins": (("image", "site", "component"), self.spins), **{key: ("image", value) for key, value in table.items()}},
            coords={**images, "component": list("xyz"), **places},
            attrs={"name": self.name, "certified": int(self.certified), "summary": json.dumps(self.summary)},
        )

    def plot(self, ax: Axes | None = None, **style: Any) -> Axes:
        """The energy path on matplotlib axes: images, the curve through them, saddles, the barrier.

        Its title says how certain the barrier is: one that is not certified has the digits that are known, and ends that relaxed
        far from where they were put are named. ``style`` goes to the curve (``color=``, ``label=``, ``linewidth=`` …).
        """
        from .plotting import energy_path

        words = "no barrier"
        if self.barrier_meV is not None:
            forward, backward = self.barrier_meV["forward"], self.barrier_meV["backward"]
            back = "" if np.isclose(forward, backward, rtol=1e-6) else f", back {self._core.told(backward)} meV"
            words = f"barrier {self._core.told(forward)} meV{back}"
        saddles = [(saddle.reaction_coordinate_rad, saddle.above_initial_meV) for saddle in self.saddles]
        images = self.reaction_coordinate_rad, self.above_initial_meV
        title = "\n".join([f"{self.name}: {words}", *self._core.notes])
        return energy_path(self.profile, images, saddles, title, ax, **style)

    def _chosen(self, images: Sequence[int] | None) -> tuple[list[Array], list[str]]:
        """Images of the path and what they are called: the initial state, those at the saddles and the final state, if none are
        named."""
        path, e = self.spins, self.above_initial_meV
        last = len(path) - 1
        tops = [saddle.image for saddle in self.saddles]
        if images is None:
            images = sorted({0, *(tops if len(tops) <= 3 else [int(np.argmax(e))]), last})
        missing = [k for k in images if not -len(path) <= k <= last]
        if missing:
            raise IndexError(f"there is no image {missing[0]}: the path has images 0 to {last}")
        picked = [range(len(path))[k] for k in images]
        words = {0: "initial", last: "final"}
        titles = [f"{words.get(k, 'saddle' if k in tops else f'image {k}')}\n{self._core.told(e[k])} meV" for k in picked]
        # an end that moved says so over its own spins, all else over the highest
        for note in self._core.notes:
            end = next((k for k, name in words.items() if note.startswith(f"the {name} state")), None)
            place = end if end is not None else max(picked, key=lambda k: e[k], default=0)
            note = note.removeprefix(f"the {words[end]} state ") if end is not None else note
            titles = [f"{title}\n{note}" if k == place else title for k, title in zip(picked, titles)]
        return [path[k] for k in picked], titles

    def plot_spins(
        self, images: Sequence[int] | None = None, axes: Sequence[Axes] | None = None, key: Axes | None = None
    ) -> list[Axes]:
        """The spins of some images side by side, on matplotlib axes: hue for the direction in the plane, lightness for m_z.

        Left out, ``images`` are the initial state, those at the saddles, and the final state. The figure has a key of the colours;
        beside ``axes`` of your own it is drawn on those of ``key``.
        """
        from .plotting import maps

        states, titles = self._chosen(images)
        return maps(states, self.places, self.vacant, titles, axes, key)

    def plot_3d(self, images: Sequence[int] | None = None, plotter: Any = None, **style: Any) -> Any:
        """The spins of some images side by side as arrows in three dimensions: a ``pyvista.Plotter``, in the colours of
        :meth:`plot_spins`.

        ``result.plot_3d().show()`` opens them; ``.screenshot("spins.png")`` makes a file, where there is no screen after
        ``pyvista.OFF_SCREEN = True``.

        Parameters
        ----------
        images
            As in :meth:`plot_spins`.
        plotter
            Its view is drawn into, in place of a plotter with a view an image.
        style
            For pyvista's ``add_mesh``: ``opacity=``, ``color="red", rgb=False, scalars=None`` …
        """
        from .scenes import arrows

        states, titles = self._chosen(images)
        return arrows(states, self.places, self.vacant, titles, plotter, **style)

    def html(self) -> str:
        """The report: a page for a browser that needs no network."""
        return self._core.html()

    def _repr_html_(self) -> str:
        import html

        page = html.escape(self.html(), quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 720px; border: 0" sandbox="allow-scripts"></iframe>'

    # files

    def save(self, folder: str | os.PathLike[str], *, formats: Sequence[str] | None = None, force: bool = False) -> None:
        """Writes the files of the result to a folder, as ``spinneb run`` does.

        Parameters
        ----------
        folder
            An earlier result of another config in it is refused, but for ``force``.
        formats
            Kinds of files (``spinneb list formats``): ``["csv", "npz", "ovf", "html", "svg", "png"]``; those of the config if
            left out. :func:`~spinneb.load` needs csv, npz and ovf.
        force
            Replace what is there.
        """
        self._core.save(os.fspath(folder), None if formats is None else list(formats), force)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._core.files(_WHOLE), self.summary)

    def __repr__(self) -> str:
        why = f", {self.stop_reason}" if self.barrier_meV is None else ""
        spent = ", the search for lower passes ended early as its work was spent" if self.search.get("spent") else ""
        return f"<Result {self.name}: {self._core.words()}{why}{spent}>"


def _restored(files: Mapping[str, bytes], summary: dict[str, Any]) -> Result:
    """A result from its files."""
    with _placed(files) as folder:
        return Result(_core.read(folder), summary)


@contextmanager
def _placed(files: Mapping[str, bytes]) -> Iterator[str]:
    """A folder that holds files for as long as it is needed."""
    import tempfile

    with tempfile.TemporaryDirectory(prefix="spinneb-") as folder:
        for name, content in files.items():
            file = Path(folder, name)
            file.parent.mkdir(exist_ok=True)
            file.write_bytes(content)
        yield folder


class Relaxed:
    """A state relaxed by itself."""

    def __init__(
        self, told: Mapping[str, Any], spins: Array, places: Array, vacant: NDArray[np.bool_], spacing_nm: float | None = None
    ) -> None:
        #: as relax.json has it
        self.summary: dict[str, Any] = {key: value for key, value in told.items() if key != "files"}
        #: the vectors, (N, 3), read-only
        self.spins = spins
        #: where the sites are, (N, 3), in lattice constants
        self.places = places
        #: the same in nm; ``None`` where the lattice was given no length
        self.places_nm = in_nm(places, spacing_nm)
        #: which sites have no spin, (N,), read-only
        self.vacant = vacant

    @property
    def is_minimum(self) -> bool:
        """Whether it is proven to be a minimum, perhaps a flat one."""
        return bool(self.summary["minimum"] and self.summary["converged"])

    @property
    def energy_meV(self) -> float:
        """Total energy."""
        return float(self.summary["energy_meV"])

    @property
    def energies_meV(self) -> dict[str, float]:
        """Energy by term."""
        return dict(self.summary["energies_meV"])

    @property
    def lowest_eigenvalues_meV(self) -> Array:
        """Of the Hessian on the spheres, zero modes apart."""
        return _read_only(np.asarray(self.summary["lowest_eigenvalues_meV"], dtype=np.float64))

    @property
    def largest_rotation_rad(self) -> float:
        """How far a spin has turned at most."""
        return float(self.summary["largest_rotation_rad"])

    @property
    def warnings(self) -> list[str]:
        """What you should know."""
        return list(self.summary["warnings"])

    def plot_spins(self, axes: Sequence[Axes] | None = None, key: Axes | None = None) -> list[Axes]:
        """The spins, on matplotlib axes, as of :meth:`Result.plot_spins`."""
        from .plotting import maps

        return maps([self.spins], self.places, self.vacant, [f"{self.energy_meV:.4f} meV"], axes, key)

    def plot_3d(self, plotter: Any = None, **style: Any) -> Any:
        """The spins as arrows in three dimensions: a ``pyvista.Plotter``, as of :meth:`Result.plot_3d`."""
        from .scenes import arrows

        return arrows([self.spins], self.places, self.vacant, [f"{self.energy_meV:.4f} meV"], plotter, **style)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """Its spins: it can stand for a state."""
        return np.array(self.spins, dtype=dtype) if copy else np.asarray(self.spins, dtype=dtype)

    def __repr__(self) -> str:
        kind = "a minimum" if self.is_minimum else "no minimum"
        return f"<Relaxed state: {self.energy_meV:.6f} meV, {kind}>"


class Check(Mapping[str, str]):
    """What a config would run, by key; ``print`` shows it as ``spinneb check`` does."""

    def __init__(self, rows: Sequence[tuple[str, str]]) -> None:
        self._rows = list(rows)
        self._content: dict[str, str] = {}
        last = ""
        for key, words in self._rows:
            last = key or last
            self._content[last] = f"{self._content[last]}\n{words}" if last in self._content else words

    def __getitem__(self, key: str) -> str:
        return self._content[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._content)

    def __len__(self) -> int:
        return len(self._content)

    def __repr__(self) -> str:
        return "\n".join(f"{key:<13}{words}" for key, words in self._rows)


class Rates:
    """Rates and lifetimes of a path."""

    def __init__(self, result: Result) -> None:
        #: the result with its rates, to be saved
        self.result = result

    @property
    def saddles(self) -> list[dict[str, Any]]:
        """Over each saddle, each way: ``rates`` of summary.json."""
        return list(self.result.summary["rates"])

    @property
    def transitions(self) -> list[dict[str, Any]]:
        """From end to end, each way: ``transition_rates`` of summary.json."""
        return list(self.result.summary["transition_rates"])

    def _rows(self, way: Way) -> list[dict[str, Any]]:
        _one_of(way, Way, "way")
        found = [one["temperatures"] for one in self.transitions if one["direction"] == way]
        return list(found[0]) if found else []

    @property
    def temperatures_K(self) -> Array:
        """The temperatures."""
        return np.array([row["temperature_K"] for row in self._rows("forward")], dtype=np.float64)

    def lifetimes_s(self, way: Way = "forward", *, log10: bool = False) -> Array:
        """Mean times from one end to the other at the temperatures; NaN where there is none, as ``reasons`` says, and infinite where
        one is too long for a number.

        ``log10`` gives decimal logarithms, which no time is too long for.
        """
        if log10:
            return np.array([_or_nan(row["log10_first_passage_s"]) for row in self._rows(way)], dtype=np.float64)
        return np.array([_time_s(row, "first_passage_s") for row in self._rows(way)], dtype=np.float64)

    def network_lifetimes_s(self, way: Way = "forward") -> Array:
        """The same over all saddles that the run found, also those that are not the path's own; NaN where none were looked for."""
        found = [row if row.get("log10_network_first_passage_s") is not None else None for row in self._rows(way)]
        return np.array([np.nan if row is None else _time_s(row, "network_first_passage_s") for row in found], dtype=np.float64)

    @property
    def reasons(self) -> list[str | None]:
        """Why there is no lifetime at each temperature; None where there is one."""
        return self._reasons("forward")

    def _reasons(self, way: Way) -> list[str | None]:
        refused = [one["refused"] for one in self.transitions if one["direction"] == way]
        whole = refused[0] if refused else None
        return [row["reason"] or whole if row["log10_first_passage_s"] is None else None for row in self._rows(way)]

    def prefactors_Hz(self, way: Way = "forward", *, theory: Theory = "langer") -> Array:
        """Attempt frequencies of the rates over the saddles, in their order along the path; NaN where a saddle has none.

        Where states slide freely they depend on temperature, as T to ``prefactor_temperature_exponent`` of :attr:`saddles`, and are
        those at ``prefactor_temperature_K`` there.
        """
        _one_of(way, Way, "way")
        _one_of(theory, Theory, "theory")
        found = [one[f"{theory}_prefactor_Hz"] for one in self.saddles if one["direction"] == way]
        return np.array([np.nan if value is None else value for value in found], dtype=np.float64)

    def to_dataframe(self) -> pandas.DataFrame:
        """A row a direction and temperature (pandas)."""
        needs("pandas")
        import pandas

        def told(row: dict[str, Any]) -> dict[str, Any]:
            return {key: _time_s(row, key) if f"log10_{key}" in row else value for key, value in row.items()}

        rows = [{"direction": one["direction"], **told(row)} for one in self.transitions for row in one["temperatures"]]
        return pandas.DataFrame(rows)

    def plot(self, ax: Axes | None = None, **style: Any) -> Axes:
        """Mean lifetimes (s, on a logarithmic scale) against 1000 K / T, on matplotlib axes, as arrhenius.png has them.

        Both ways, where they differ. Grey where a barrier is below 5 k_BT, or pale where it is so all along, as the theories need
        more; times below 1e-15 s or beyond 1e25 s are left out. ``style`` goes to the curves (``color=``, ``label=``, ``linewidth=`` …).
        """
        from .plotting import lifetimes

        forward, backward = (self._curve(way) for way in ("forward", "backward"))
        if np.allclose(forward[1], backward[1], rtol=0, atol=5e-4, equal_nan=True):
            return lifetimes({"mean lifetime": forward}, ax, **style)
        return lifetimes({"forward": forward, "backward": backward}, ax, **style)

    def _curve(self, way: Way) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Temperatures (K) from hot to cold, decimal logarithms of lifetimes (s), and where the barrier is low."""
        order = np.argsort(-self.temperatures_K)
        low = np.array([row["barrier_over_kT"] < 5 for row in self._rows(way)], dtype=bool)
        return self.temperatures_K[order], self.lifetimes_s(way, log10=True)[order], low[order]

    def _told(self, way: Way) -> list[str]:
        """The lifetimes in words, also those too long for a number, each with what is known of its error, or why there are none."""
        within = [row["known_within_factor"] for row in self._rows(way)]
        times = zip(self.lifetimes_s(way), self.lifetimes_s(way, log10=True), within, self._reasons(way))
        return [f"none: {why}" if why else _time(s, log10, factor) for s, log10, factor, why in times]

    def _lines(self, way: Way) -> list[tuple[str, str, str]]:
        """Temperature, barrier over kT and lifetime; one line for neighbours that have none for one reason."""
        every = zip(self._rows(way), self._told(way))
        rows = [(f"{row['temperature_K']:g} K", f"{row['barrier_over_kT']:.3g}", told) for row, told in every]
        lines = []
        for told, same in groupby(rows, key=lambda row: row[2]):
            (first, high, _), *others = same
            if others and told.startswith("none"):
                last, low, _ = others[-1]
                lines.append((f"{first} to {last} ({1 + len(others)} temperatures)", f"{high} to {low}", told))
            else:
                lines += [(first, high, told), *others]
        return lines

    def _repr_html_(self) -> str:
        rows = [(way, *line) for way in ("forward", "backward") for line in self._lines(way)]
        figure = self.result._core.files(["svg"]).get("arrhenius.svg", b"")
        head = ("", "temperature", "barrier / kT", "mean lifetime")
        return paragraph(f"Rates {self.result.name}") + table(rows, head) + drawing(figure)

    def __repr__(self) -> str:
        return "\n".join([f"<Rates {self.result.name}", *(f"  {t}: {told}" for t, _, told in self._lines("forward"))]) + ">"


def _or_nan(value: float | None) -> float:
    """NaN where there is none."""
    return float("nan") if value is None else float(value)


def _time_s(row: Mapping[str, Any], key: str) -> float:
    """A time of a row of rates; one that is too long or too short for a number is infinite or zero."""
    value, log10 = row[key], row[f"log10_{key}"]
    if value is None and log10 is not None:
        return float("inf") if log10 > 0 else 0.0
    return _or_nan(value)


def _time(seconds: float, log10: float, factor: float | None) -> str:
    """A lifetime with as many digits as its error leaves, and the error."""
    digits = 1 if factor is None else min(max(int(np.ceil(-np.log10(max(factor - 1, 1e-12)))), 1), 4)
    time = f"{seconds:.{digits}g} s" if 0.0 < seconds < np.inf else f"10^{log10:.0f} s"
    known = "no better than an order of magnitude, if at all" if factor is None else f"within a factor of {factor:.2g}"
    return f"{time} ({known})"


class Landscape:
    """Minima and saddles, how they are joined, and how long states live."""

    def __init__(self, core: _core.Landscape | None = None, files: Mapping[str, bytes] | None = None) -> None:
        self._core = core
        found: Mapping[str, bytes] = files if core is None and files is not None else core.files() if core else {}
        #: all files by name, as ``spinneb landscape`` writes them
        self.files: dict[str, bytes] = dict(found)
        self._document: dict[str, Any] = json.loads(self.files["landscape.json"])
        with np.load(io.BytesIO(self.files["landscape.npz"])) as arrays:
            #: landscape.npz
            self.arrays: dict[str, Array] = {name: _read_only(arrays[name]) for name in arrays.files}

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json."""
        found: dict[str, Any] = json.loads(self.files["summary.json"])
        return found

    @property
    def finished(self) -> bool:
        """Whether the search came to its stop before its work was spent."""
        return bool(self.summary["converged"])

    @property
    def warnings(self) -> list[str]:
        """What you should know."""
        return list(self.summary["warnings"])

    @property
    def minimum_kinds(self) -> list[dict[str, Any]]:
        """One of each kind of minima that symmetry makes of each other."""
        return list(self._document["minima"])

    @property
    def saddle_kinds(self) -> list[dict[str, Any]]:
        """One of each kind of saddles that symmetry makes of each other."""
        return list(self._document["saddles"])

    @property
    def minima(self) -> list[dict[str, Any]]:
        """All minima: a dictionary each, as minima.csv has them."""
        return self._table("minima.csv")

    @property
    def saddles(self) -> list[dict[str, Any]]:
        """All saddles: a dictionary each, as saddles.csv has them."""
        return self._table("saddles.csv")

    @property
    def minimum_spins(self) -> Array:
        """The vectors of all minima, (minimum, site, xyz)."""
        return self.arrays["minima"]

    @property
    def saddle_spins(self) -> Array:
        """The vectors of all saddles, (saddle, site, xyz)."""
        return self.arrays["saddles"]

    @property
    def lifetimes(self) -> list[dict[str, Any]]:
        """lifetimes.csv, where there are temperatures."""
        return self._table("lifetimes.csv") if "lifetimes.csv" in self.files else []

    def _table(self, name: str) -> list[dict[str, Any]]:
        import csv

        rows = csv.DictReader(io.StringIO(self.files[name].decode()))
        return [{key: _number(value) for key, value in row.items()} for row in rows]

    def to_dataframe(self, table: Literal["minima", "saddles", "lifetimes"] = "minima") -> pandas.DataFrame:
        """One of the tables (pandas)."""
        needs("pandas")
        import pandas

        if f"{table}.csv" not in self.files:
            raise ValueError(f"there is no table {table!r} here" + (", as no temperatures were given" if table == "lifetimes" else ""))
        return pandas.read_csv(io.BytesIO(self.files[f"{table}.csv"]))

    def graph(self) -> Any:
        """Minima and saddles as a graph (networkx)."""
        needs("networkx")
        import networkx  # type: ignore[import-untyped,unused-ignore]

        return networkx.parse_graphml(self.files["landscape.graphml"].decode())

    def save(self, folder: str | os.PathLike[str], *, force: bool = False) -> None:
        """Writes the files to a folder, as ``spinneb landscape`` does."""
        if self._core is None:
            with _placed(self.files) as place:
                config = _core.Config(None, self.files["config.json"].decode(), place, [], [], "landscape")
            self._core = config.landscape_of(self.files)
        self._core.save(os.fspath(folder), force)

    def _repr_html_(self) -> str:
        return paragraph(repr(self)[1:-1]) + drawing(self.files.get("disconnectivity.svg", b""))

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (None, self.files)

    def __repr__(self) -> str:
        told = self.summary
        each = (("minima", told["minima"], told["kinds_of_minima"]), ("saddles", told["saddles"], told["kinds_of_saddles"]))
        return f"<Landscape {told['name']}: " + ", ".join(f"{n} {what} of {kinds} kind{'s' * (kinds != 1)}" for what, n, kinds in each) + ">"


def _one_of(word: str, words: Any, name: str) -> None:
    """An error where a word is none of a Literal's."""
    if word not in get_args(words):
        raise ValueError(f"{name} is one of {', '.join(map(repr, get_args(words)))}, found {word!r}")


def _number(text: str | None) -> Any:
    """A cell of a table: a number where it is one, None where it is empty."""
    if not text:
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
