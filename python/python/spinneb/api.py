"""What is done with a system or a config."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, Union, cast

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._read import read
from ._values import AnyState, Guess, Piece, as_count, as_guess, as_json, as_state
from .results import Check, Landscape, Rates, Relaxed, Result, vacant_sites
from .system import System

__all__ = ["barrier", "check", "landscape", "load", "rates", "relax", "run"]

#: a file, a dictionary, or a system with its states
Config = Union[str, "os.PathLike[str]", Mapping[str, Any], System]
#: True for a line that tells how far it is, or a function of what is known: stage, iteration, …
Progress = Union[bool, Callable[[dict[str, Any]], object], None]
Effort = Literal["none", "quick", "normal", "thorough"]
Theory = Literal["htst", "langer"]
#: in K, or quantities; one or several, or a range ``{"from": "2 K", "to": "4 K", "points": 3}``
Temperatures = Union[float, str, Iterable[Union[float, str]], Mapping[str, Any]]


def run(
    config: Config,
    *,
    out: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress = None,
    set: Mapping[str, Any] | None = None,
    force: bool = False,
    resume: bool = False,
) -> Result:
    """The minimum-energy path that a config asks for: what ``spinneb run`` does, to the bit.

    Parameters
    ----------
    config
        A file, a dictionary as in such a file, or a :class:`System` with its two states. Files that a dictionary names are looked
        for in the working directory.
    out
        Folder for the files of the result. An earlier result of another config there is refused, as on the command line. What was
        computed when the run is interrupted stays there, in a checkpoint.
    threads
        So many; one for each core if left out. Results do not depend on it.
    progress
        ``True`` for a line on stderr, or a function that is called with a dictionary: ``stage``, and of a band ``iteration``,
        ``images``, ``highest_image_meV``, ``largest_predicted_rotation_rad``, ``length_rad``. What it raises ends the run.
    set
        Values of keys in place of the config's: ``{"path.images": 41}``.
    force
        Replace what is in ``out``.
    resume
        Go on from the checkpoint in ``out``, or read the finished result of this config that is there; without either, start anew.
        What a :class:`Term` computes is not in a config, so that a finished result of a system with terms of your own is made anew.

    Raises
    ------
    ConfigError
        Something is wrong with the config.
    SpinnebError
        The computation cannot go on; an energy that is not a finite number, for example.
    KeyboardInterrupt
        Ctrl-C: within a second, but for lattices whose Hessian takes longer to factorise (50 × 50 × 50 sites: some 10 s).
    """
    count = _count(threads, "threads", 1)
    core = _config(config, "run", set)
    place = _place(out, resume)
    if place is not None and resume and core.is_finished(place, False):
        return cast(Result, load(place))
    with _telling(progress) as tell, _recording(place):
        return Result(core.run(count, tell, (place, resume, force)))


def barrier(
    system: System,
    initial: AnyState | None = None,
    final: AnyState | None = None,
    *,
    guess: Guess | Mapping[str, Any] | ArrayLike | None = None,
    images: int | None = None,
    relax_ends: bool | None = None,
    effort: Effort | None = None,
    temperatures: Temperatures | None = None,
    out: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress = None,
    force: bool = False,
    resume: bool = False,
    **options: Any,
) -> Result:
    """The minimum-energy path between two states of a system, with its barrier and saddles.

    Parameters
    ----------
    system
        The spins and their energy.
    initial, final
        The two states: ``sn.uniform("z")``, ``sn.skyrmion(radius=4)``, …, or vectors of the shape (N, 3), such as
        ``result.saddles[0].spins``.
    guess
        The first path: ``sn.sweep("left")``, …, or vectors of the shape (images, N, 3). All natural ones are tried if left out.
    images
        Number of images, both ends counted; as many as the path needs if left out.
    relax_ends
        Relax both ends to minima first (the default).
    effort
        How long lower passes are looked for.
    temperatures
        For rates and lifetimes, ``result.rates``: numbers in K, or quantities; one or several, or a range (see :func:`rates`).
    out, threads, progress, force, resume
        As in :func:`run`.
    options
        Any other key of a config, in place of the system's: ``neb={"tolerance": 1e-8}``, ``rates={"damping": 0.5, …}``.
    """
    if not isinstance(system, System):
        raise TypeError(f"barrier takes a System, made of a lattice and a list of terms, found {system!r}; run takes a config")

    def beside(key: str, **own: Any) -> None:
        """Puts what is given beside what else is asked for under a key, here or of the system."""
        given = {name: value for name, value in own.items() if value is not None}
        if given:
            options[key] = {**(options.get(key, system.options.get(key)) or {}), **given}

    beside("rates", temperatures=None if temperatures is None else _kelvin(temperatures))
    beside("path", guess=None if guess is None else as_guess(guess), images=images)
    beside("search", effort=effort)
    if relax_ends is not None:
        options["relax_ends"] = relax_ends
    changed = {"initial": system.initial if initial is None else initial, "final": system.final if final is None else final}
    return run(system.replaced(**changed, **options), out=out, threads=threads, progress=progress, force=force, resume=resume)


def relax(
    config: Config,
    *states: AnyState,
    modes: int = 6,
    threads: int | None = None,
    progress: Progress = None,
    set: Mapping[str, Any] | None = None,
) -> Relaxed | tuple[Relaxed, ...]:
    """States relaxed to minima: energy, torque, whether it is a minimum, lowest modes.

    Parameters
    ----------
    config
        The spins and their energy.
    states
        One or two states. Without any the config's own, ``initial`` and ``final``, as a tuple.
    modes
        How many of the lowest eigenvalues are computed.
    threads, progress, set
        As in :func:`run`.
    """
    if len(states) > 2:
        raise TypeError("relax takes one or two states at a time")
    if states:
        names = dict(zip(("initial", "final"), (as_state(state, "state") for state in states)))
        if isinstance(config, System):
            config = config.replaced(**{"initial": None, "final": None, **names})
        else:
            set = {**(set or {}), **names}
    wanted, count = _count(modes, "modes", 0) or 0, _count(threads, "threads", 1)
    core = _config(config, "relax", set)
    with _telling(progress) as tell:
        files, spins = core.relax(wanted, count, tell)
    told = json.loads(files["relax.json"])["states"]
    places, vacant = np.asarray(core.places), vacant_sites(core)
    found = tuple(Relaxed(one, np.asarray(m), places, vacant, core.spacing_nm) for one, m in zip(told, spins))
    return found[0] if len(states) == 1 else found


def check(config: Config, *, set: Mapping[str, Any] | None = None) -> Check:
    """What a config would run, without running it: sites, shells, energies, scales, images, memory, time.

    Two states that a system lacks are taken as uniform ones, up and down.
    """
    if isinstance(config, System):
        up, down = ({"uniform": {"direction": [0, 0, z]}} for z in (1, -1))
        config = config.replaced(
            initial=up if config.initial is None else config.initial, final=down if config.final is None else config.final
        )
    return Check(_config(config, "run", set).check())


def landscape(
    config: Config,
    *,
    energy_window: str | None = None,
    effort: Effort | None = None,
    states: Sequence[AnyState] = (),
    groups: Mapping[str, Any] | None = None,
    temperatures: Temperatures | None = None,
    out: str | os.PathLike[str] | None = None,
    threads: int | None = None,
    progress: Progress = None,
    set: Mapping[str, Any] | None = None,
    force: bool = False,
    resume: bool = False,
) -> Landscape:
    """All minima and saddles below an energy, how they are joined, and how long states live.

    Parameters
    ----------
    config
        The spins and their energy; states it may lack.
    energy_window
        How far above the lowest minimum: ``"20 meV"``; everything if left out.
    effort
        How long is looked.
    states
        Further states to start from.
    groups
        Groups of minima for lifetimes, by name: ``{"up": {"axis": [0, 0, 1], "from": 0.5}}``.
    temperatures
        For lifetimes: numbers in K, or quantities; one or several, or a range (see :func:`rates`).
    out, threads, progress, set, force, resume
        As in :func:`run`.
    """
    if isinstance(states, (str, Mapping)):
        raise TypeError(f"states is a list of states, also of one: write [{states!r}]")
    own = {
        "energy_window": energy_window,
        "effort": effort,
        "states": [as_state(state, "states") for state in states] or None,
        "groups": groups,
        "temperatures": None if temperatures is None else _kelvin(temperatures),
    }
    chosen = {f"landscape.{key}": value for key, value in own.items() if value is not None}
    count = _count(threads, "threads", 1)
    core = _config(config, "landscape", {**chosen, **(set or {})})
    place = _place(out, resume)
    if place is not None and resume and core.is_finished(place, True):
        return cast(Landscape, load(place))
    with _telling(progress) as tell, _recording(place):
        return Landscape(core.landscape(count, tell, (place, resume, force)))


def rates(
    result: Result,
    temperatures: Temperatures,
    *,
    damping: float | None = None,
    g_factor: float | None = None,
    theory: Theory | Sequence[Theory] | None = None,
) -> Rates:
    """Rates and lifetimes over the saddles of a certified result.

    Parameters
    ----------
    result
        A run; its moments say how fast spins precess.
    temperatures
        Numbers in K, or quantities; one or several, or a range ``{"from": "2 K", "to": "4 K", "points": 3}``.
    damping
        Gilbert damping; if left out, that of the result's config, else 0.1.
    g_factor
        g factor; if left out, that of the result's config, else 2.
    theory
        ``"htst"`` (harmonic transition state theory) or ``"langer"``, or a list of them; if left out, those of the result's config, else both.
    """
    if not isinstance(result, Result):
        raise TypeError(f"rates takes a Result, as run, barrier and load make it, found {result!r}")
    asked = {
        "temperatures": _kelvin(temperatures),
        "damping": damping,
        "g_factor": g_factor,
        "theory": [theory] if isinstance(theory, str) else theory,
    }
    json_text = as_json({key: value for key, value in asked.items() if value is not None})
    return Rates(Result(result._core.with_rates(json_text)))


def load(folder: str | os.PathLike[str]) -> Result | Landscape:
    """The result in a folder, of the command line or of :meth:`Result.save`; of ``spinneb landscape``, a :class:`Landscape`."""
    place = Path(folder)
    try:
        summary = json.loads((place / "summary.json").read_bytes())
    except FileNotFoundError as error:
        raise FileNotFoundError(error.errno, "no finished result (no summary.json) in", os.fspath(place)) from None
    if summary.get("kind") == "landscape":
        files = {path.name: path.read_bytes() for path in place.iterdir() if path.is_file()}
        return Landscape(files=files)
    summary.pop("manifest", None)
    return Result(_core.read(place), summary)


def _config(config: Config, kind: str, set: Mapping[str, Any] | None) -> _core.Config:
    """A config, read."""
    sets = [f"{key}={as_json(value)}" for key, value in (set or {}).items()]
    if isinstance(config, str) and config.lstrip().startswith("{"):
        raise TypeError("found JSON text, expected a System, the name of a file or a dictionary, as json.loads makes of that text")
    if isinstance(config, (str, os.PathLike)):
        return _core.Config(os.fspath(config), None, "", sets, [], kind)
    if isinstance(config, System):
        return read(config.config(), config.terms, kind, sets)
    if isinstance(config, Piece) or not isinstance(config, Mapping):
        raise TypeError(f"expected a System, a file or a dictionary as in such a file, found {config!r}")
    return read(dict(config), [], kind, sets)


def _place(out: str | os.PathLike[str] | None, resume: bool) -> str | None:
    if out is None and resume:
        raise ValueError("resume=True goes on from what is in a folder: give it as out")
    return None if out is None else os.fspath(out)


@contextmanager
def _recording(place: str | None) -> Iterator[None]:
    """Tells who interrupts what is recorded in a folder how it goes on."""
    try:
        yield
    except KeyboardInterrupt as stop:
        if place is not None and os.path.isdir(os.path.join(place, "checkpoint")) and hasattr(stop, "add_note"):
            stop.add_note(f"resume=True goes on from the checkpoint in {place}")
        raise


def _count(number: int | None, what: str, least: int) -> int | None:
    """A whole number, at least so many; more than any machine has are as many as fit."""
    found = as_count(number, what, least)
    return None if found is None else min(found, 2**31 - 1)


def _kelvin(temperatures: Temperatures) -> list[str] | dict[str, Any]:
    if isinstance(temperatures, Mapping):
        return dict(temperatures)
    several: list[Any]
    try:
        several = [temperatures] if isinstance(temperatures, str) else list(temperatures)  # type: ignore[arg-type]
    except TypeError:
        several = [temperatures]
    try:
        return [value if isinstance(value, str) else f"{float(value)!r} K" for value in several]
    except (TypeError, ValueError):
        raise TypeError(f"temperatures are numbers in K, or quantities such as '300 K', found {temperatures!r}") from None


class _telling:
    """What a run tells its progress to."""

    def __init__(self, progress: Progress) -> None:
        self.progress = progress
        self.width = 0

    def __enter__(self) -> Callable[[dict[str, Any]], object] | None:
        if self.progress is True:
            return self.line
        return None if self.progress in (None, False) else self.progress  # type: ignore[return-value]

    def line(self, news: dict[str, Any]) -> None:
        words = str(news["stage"])
        if "iteration" in news:
            words += (
                f": iteration {news['iteration']}, {news['images']} images, top {news['highest_image_meV']:.6g} meV, "
                f"{news['largest_predicted_rotation_rad']:.1e} rad to go"
            )
        print("\r" + words.ljust(self.width), end="", file=sys.stderr, flush=True)
        self.width = max(self.width, len(words))

    def __exit__(self, *_: object) -> None:
        if self.width:
            print("\r" + " " * self.width + "\r", end="", file=sys.stderr, flush=True)
