"""Evaluation in batches, and the project's own strategies by ask and tell."""

from __future__ import annotations

import json
import os
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._core import Champion, Evaluations
from ._options import Path, plain

Settings = Optional[Mapping[str, Any]]
#: Genomes: the rows of an array, or dictionaries with all genes.
Genomes = Union[ArrayLike, Mapping[str, Any], Sequence[Mapping[str, Any]]]


class Problem:
    """A preset with changed settings, as a function of genomes.

    A genome is a row of ``dimension`` numbers, each from 0 to 1: the position of a gene in its range (see :attr:`genes`).
    Numbers outside have a genome, too: an angle turns on, anything else is reflected at the ends of its range. So a method
    needs no bounds. All 64 bits of a number count: keep genomes as float64.

    Where bodies or networks grow, or a controller learns (as in ``bodies``, ``creatures``, ``neat`` and ``xcs``), genomes have no
    common length. There a genome is a dictionary with all genes as champions' files have them, in and out of every method, and
    ``dimension`` and ``genes`` are refused.

    Arguments
        preset: a shipped preset (see :func:`presets`) or the path of a file.
        stairs: changes of the stairs by name: ``{"steps": 5, "rise_m": 0.3}``.
        settings: changes of other settings, as ``--set`` of the program takes them. Those of the search are refused.
    """

    def __init__(
        self,
        preset: Path = "climb",
        *,
        stairs: Settings = None,
        settings: Settings = None,
    ):
        self._core = _core.Problem(os.fspath(preset), plain(stairs), plain(settings), "evaluation")

    @property
    def preset(self) -> str:
        """The name of the preset."""
        return self._core.preset

    @property
    def dimension(self) -> int:
        """Numbers in a genome."""
        return self._core.dimension

    @property
    def steps(self) -> int:
        """Steps of the stairs."""
        return self._core.steps

    @property
    def duration_s(self) -> float:
        """Simulated seconds of a trial."""
        return self._core.duration_s

    @property
    def settings(self) -> dict[str, str]:
        """All settings by their full names, with their values as text."""
        return self._core.settings

    @property
    def genes(self) -> list[dict[str, Any]]:
        """Index, field (its path in a saved genome), name, unit and allowed values of each number of a genome."""
        return self._core.genes

    def random(self, count: int, seed: int = 1) -> Union[np.ndarray, list[dict[str, Any]]]:
        """``count`` random genomes: the first generation of a run with this seed, bit for bit."""
        return self._core.random(count, seed)

    def evaluate(self, genomes: Genomes, *, threads: Optional[int] = None) -> Evaluations:
        """Simulates genomes (an array of shape ``(n, dimension)``, or of ``(dimension,)`` for one; or dictionaries) on all cores.

        Each result depends on its genome alone, bit for bit: neither on the others nor on ``threads``. An interrupt ends it as
        soon as the snakes end that are being simulated.
        """
        return self._core.evaluate(_packed(genomes), threads)

    def decode(self, genomes: Genomes) -> list[dict[str, Any]]:
        """The genes of genomes as dictionaries, in their units, as champions' files have them."""
        return self._core.decode(_packed(genomes))

    def genome_of(self, champion: Union[Path, Champion]) -> Union[np.ndarray, dict[str, Any]]:
        """The genome of a saved champion (or the path of its file): a row, or a dictionary.

        A row stands for the champion's genes to the last bit. A ``UserWarning`` tells where that is impossible: for an angle beyond
        a full turn, and for a gene so near to 0, between a negative and a positive end of its range, that 64 bits miss it.
        """
        if not isinstance(champion, Champion):
            champion = _core.load_champion(champion)
        return self._core.genome_of(champion)

    def save_champion(
        self,
        path: Path,
        genome: Union[ArrayLike, Mapping[str, Any]],
        *,
        seed: int = 0,
        generation: int = 1,
        individual: int = 0,
    ) -> None:
        """Writes a genome with its trial and evaluation to a file that the program opens, replays and examines.

        ``seed``, ``generation`` and ``individual`` are written as its origin, for people. An interrupt leaves no file.
        """
        self._core.save_champion(path, _packed(genome), seed, generation, individual)

    def __repr__(self) -> str:
        return f"<Problem {self.preset}: {self._core.controller}>"


class Search:
    """One of the project's strategies, a generation at a time.

    ::

        search = Search("climb", strategy="cma_es", seed=1)
        while not search.is_over:
            genomes = search.ask()
            search.tell(search.evaluate())

    Asked, evaluated by :meth:`evaluate` and told so, it makes the generations of ``snakes --no-render`` with the same settings
    and seed, bit for bit. Strategies whose individuals are more than numbers (bodies, NEAT's networks, learners) do the same;
    their genomes are dictionaries: see :class:`Problem`. A search can be pickled and copied between any two calls, and goes on with
    the same bits.

    Arguments
        preset, stairs, settings: as those of :class:`Problem`; here settings may also change the search.
        strategy: ``"halving"``, ``"ga"``, ``"cma_es"``, ``"map_elites"``, ``"novelty"``, ``"random"``, ``"neat"``, ``"q_learning"``,
            ``"xcs"``, ``"zcs"``, or one that varies bodies; None for the preset's. Those that evolve stairs are refused.
        seed: of all random numbers.
        founder: a champion, or the path of its file, from which the first generation descends.
    """

    def __init__(
        self,
        preset: Path = "climb",
        *,
        strategy: Optional[str] = None,
        seed: int = 1,
        stairs: Settings = None,
        settings: Settings = None,
        founder: Union[None, Path, Champion] = None,
    ):
        if founder is not None and not isinstance(founder, Champion):
            founder = _core.load_champion(founder)
        problem = _core.Problem(os.fspath(preset), plain(stairs), plain(settings), "search", strategy)
        self._core = _core.Search(problem, seed, founder)

    @property
    def strategy(self) -> str:
        """The name of the strategy."""
        return self._core.strategy

    @property
    def seed(self) -> int:
        """The seed of all random numbers."""
        return self._core.seed

    @property
    def dimension(self) -> int:
        """Numbers in a genome."""
        return self._core.problem.dimension

    @property
    def settings(self) -> dict[str, str]:
        """All settings by their full names, with their values as text."""
        return self._core.problem.settings

    @property
    def generation(self) -> int:
        """Finished generations."""
        return self._core.generation

    @property
    def evaluations(self) -> int:
        """Evaluations told so far."""
        return self._core.evaluations

    @property
    def population(self) -> int:
        """Snakes in the next generation."""
        return self._core.population

    @property
    def is_over(self) -> bool:
        """Whether a run of these settings would end here. One may go on."""
        return self._core.is_over

    def ask(self) -> Union[np.ndarray, list[dict[str, Any]]]:
        """The genomes of the next generation: rows of numbers from 0 to 1, or dictionaries. Asking twice gives the same.

        A row stands for the genome to the last bit; a ``UserWarning`` tells of one that does not (see :meth:`Problem.genome_of`).
        """
        return self._core.ask()

    def evaluate(self, *, threads: Optional[int] = None) -> Evaluations:
        """Evaluates the next generation as a run does, on all cores."""
        return self._core.evaluate(threads)

    def champion(self, index: int) -> Champion:
        """A snake of the generation that was asked for and not told yet, evaluated in its trial, with all that it is: also
        networks that grow and what a learner knows."""
        return self._core.champion(index)

    def save_champion(self, path: Path, index: int) -> None:
        """Writes such a snake to a file that the program opens, replays and examines. An interrupt leaves no file."""
        self._core.save_champion(path, index)

    def tell(
        self,
        results: Union[Evaluations, ArrayLike],
        *,
        disqualified: Optional[ArrayLike] = None,
    ) -> None:
        """Learns from results of the generation that was asked for, in its order.

        ``results`` are :class:`Evaluations` of these genomes, or a fitness of your own (larger is better) with optional flags of
        individuals that do not count. MAP-Elites, novelty search and the learners need :class:`Evaluations`.
        """
        if isinstance(results, Evaluations):
            if disqualified is not None:
                raise ValueError("disqualified is given; allowed: None beside Evaluations, which say it")
            self._core.tell(results)
            return
        fitness = _vector("fitness", results, np.float64)
        flags = None if disqualified is None else _vector("disqualified", disqualified, np.bool_)
        self._core.tell_fitness(fitness, flags)

    def archive(self) -> Optional[dict[str, Any]]:
        """The archive of MAP-Elites: axes, numbers of columns and rows, coverage, QD score, and the elites with their
        cells and genomes; elites with bodies of their own have length, width and height of each block instead. None for
        other strategies."""
        return self._core.archive()

    def __repr__(self) -> str:
        return repr(self._core)


def evaluate(
    genomes: Genomes,
    preset: Path = "climb",
    *,
    stairs: Settings = None,
    settings: Settings = None,
    threads: Optional[int] = None,
) -> Evaluations:
    """Simulates genomes in a preset: ``Problem(preset, ...).evaluate(genomes)``."""
    return Problem(preset, stairs=stairs, settings=settings).evaluate(genomes, threads=threads)


def _packed(genomes: Any) -> Union[np.ndarray, str]:
    """Genomes as the core reads them: an array of rows, or a text of JSON."""
    if isinstance(genomes, Mapping):
        genomes = [genomes]
    if isinstance(genomes, (list, tuple)) and any(isinstance(one, Mapping) for one in genomes):
        return json.dumps(genomes)
    rows = np.atleast_2d(np.asarray(genomes, dtype=np.float64))
    if rows.ndim != 2:
        raise ValueError(f"genomes is of shape {rows.shape}; allowed: shape (n, dimension)")
    return rows


def _vector(field: str, values: ArrayLike, kind: type) -> np.ndarray:
    vector: np.ndarray = np.asarray(values, dtype=kind)
    if vector.ndim != 1:
        raise ValueError(f"{field} is of shape {vector.shape}; allowed: shape (n,)")
    return vector
