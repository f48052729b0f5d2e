"""The compiled part: see python/src. Arguments are checked; a value that is not allowed raises ValueError."""

import os
from typing import Any, Optional, Union, final

import numpy as np
from numpy.typing import NDArray

_Path = Union[str, os.PathLike[str]]

__all__ = [
    "ENGINE_VERSION",
    "__version__",
    "Champion",
    "Evaluations",
    "Problem",
    "Search",
    "Worlds",
    "load_champion",
    "load_run",
    "presets",
    "replay",
    "unpacked_champion",
    "unpacked_evaluations",
    "unpacked_problem",
    "unpacked_search",
]

#: The version of the program.
__version__: str

#: The version of the engine. Trace hashes of different versions differ.
ENGINE_VERSION: int

def presets() -> dict[str, str]:
    """The names of the shipped presets with their descriptions, the default first."""

def load_champion(path: _Path) -> Champion:
    """Reads a champion's file."""

def load_run(folder: _Path) -> dict[str, Any]:
    """Reads a run's folder: ``preset``, ``seed``, ``founder``, ``settings``, ``generations`` (its lines of JSON), and
    ``champions`` (each with ``generation`` and ``champion``)."""

def replay(path: _Path) -> dict[str, Any]:
    """What ``snakes replay FILE --no-render --json`` prints: the champion simulated again and compared with its record."""

def unpacked_evaluations(text: str) -> Evaluations:
    """Evaluations from the text into which pickle packed them."""

def unpacked_champion(text: str, version: int, processors: str) -> Champion:
    """A champion from its file's text and the engine that recorded it."""

def unpacked_problem(text: str) -> Problem:
    """A problem from the text into which pickle packed it."""

def unpacked_search(
    problem: Problem, seed: int, founder: Optional[Champion], text: str
) -> Search:
    """A search from its problem, seed and founder, and the text into which pickle packed its state."""

@final
class Champion:
    """A saved champion, or a snake of a search or the episode of an environment as one."""

    @property
    def trace_hash(self) -> str:
        """The recorded trace hash, 16 hexadecimal digits."""

    def save(self, path: _Path) -> None:
        """Writes it to a file that the program opens, replays and examines."""

    def __reduce__(self) -> Any: ...

    def to_dict(self) -> dict[str, Any]:
        """Engine, origin, record, trial, genome and results of exams, as in the file. Hashes are hexadecimal there."""

    def evaluate(self) -> Evaluations:
        """Simulates it again in its own trial."""

    def trajectory(self) -> dict[str, NDArray[np.float64]]:
        """Its motion, simulated again: ``time_s`` (T), ``position_m`` (T, limbs, 3), ``rotation_xyzw`` (T, limbs, 4), and of shape
        (T, joints) ``joint_bend_rad``, ``joint_twist_rad``, ``joint_bend_rate_rad_s``, ``joint_twist_rate_rad_s``. The first moment is the start."""

@final
class Evaluations:
    """The results of a batch: arrays with a value per snake, in order. NaN where something was not measured."""

    def __len__(self) -> int: ...
    @property
    def fitness(self) -> NDArray[np.float64]:
        """By the measure ``trial.fitness``; of a disqualified snake, the fitness after its last healthy step. See :attr:`ranking`."""

    @property
    def ranking(self) -> NDArray[np.float64]:
        """Fitness by which snakes rank: minus infinity for a disqualified one."""

    @property
    def disqualified(self) -> NDArray[np.bool_]:
        """Whether the physics broke or was exploited, or the snake left the arena. Such a snake ranks last."""

    @property
    def reasons(self) -> list[Optional[str]]:
        """The reason of each disqualification; None for a healthy snake."""

    @property
    def endings(self) -> list[Optional[str]]:
        """How each trial ended, in words, such as "fell off the side from step 4"; None for a snake that was not simulated."""

    @property
    def on_landing(self) -> NDArray[np.bool_]:
        """Whether it ended healthy with all steps under its middle block."""

    @property
    def steps_climbed(self) -> NDArray[np.int64]:
        """Steps under the middle block at the end."""

    @property
    def physics_steps(self) -> NDArray[np.int64]:
        """Healthy physics steps."""

    @property
    def trace_hash(self) -> NDArray[np.str_]:
        """Hash over the bits of all poses, 16 hexadecimal digits: equal only if every step was."""

    @property
    def centre_y_m(self) -> NDArray[np.float64]:
        """y of the middle block at the end, in m."""

    @property
    def energy_j(self) -> NDArray[np.float64]:
        """Energy that the joints spent, in J."""

    @property
    def top_speed_m_s(self) -> NDArray[np.float64]:
        """Greatest speed of a block, in m/s."""

    @property
    def joint_drift_m(self) -> NDArray[np.float64]:
        """Greatest gap of a joint, in m."""

    @property
    def sideways_m(self) -> NDArray[np.float64]:
        """Greatest distance of a block from the middle of the stairs, in m."""

    @property
    def mean_height_m(self) -> NDArray[np.float64]:
        """Mean height of the blocks over the tread below the middle block, in m."""

    @property
    def mean_sideways_m(self) -> NDArray[np.float64]:
        """Mean distance of the middle block from the middle of the stairs, in m."""

    @property
    def contact_duty(self) -> NDArray[np.float64]:
        """Mean share of blocks that touch something, from 0 to 1."""

    @property
    def frequency_hz(self) -> NDArray[np.float64]:
        """Frequency of the controller, in Hz."""

    @property
    def cost_of_transport(self) -> NDArray[np.float64]:
        """Energy per weight and way; NaN without a way."""

    @property
    def climbing_efficiency(self) -> NDArray[np.float64]:
        """Share of the energy that lifted the snake; NaN without energy."""

@final
class Problem:
    """See :class:`snakes_and_stairs.Problem`."""

    def __new__(
        cls,
        preset: str,
        stairs: Optional[dict[str, Any]] = None,
        settings: Optional[dict[str, Any]] = None,
        purpose: str = "evaluation",
        strategy: Optional[str] = None,
        body: Union[None, int, Champion] = None,
    ) -> Problem: ...
    def __reduce__(self) -> Any: ...
    @property
    def preset(self) -> str: ...
    @property
    def controller(self) -> str: ...
    @property
    def dimension(self) -> int: ...
    @property
    def duration_s(self) -> float: ...
    @property
    def steps(self) -> int: ...
    @property
    def settings(self) -> dict[str, str]: ...
    @property
    def genes(self) -> list[dict[str, Any]]: ...
    def random(self, count: int, seed: int) -> Any: ...
    def decode(self, genomes: Union[NDArray[np.float64], str]) -> list[dict[str, Any]]: ...
    def genome_of(self, champion: Champion) -> Any: ...
    def evaluate(
        self, genomes: Union[NDArray[np.float64], str], threads: Optional[int] = None
    ) -> Evaluations: ...
    def save_champion(
        self,
        path: _Path,
        genome: Union[NDArray[np.float64], str],
        seed: int,
        generation: int,
        individual: int,
    ) -> None: ...

@final
class Search:
    """See :class:`snakes_and_stairs.Search`."""

    def __new__(
        cls, problem: Problem, seed: int, founder: Optional[Champion] = None
    ) -> Search: ...
    def __reduce__(self) -> Any: ...
    @property
    def problem(self) -> Problem: ...
    @property
    def strategy(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def generation(self) -> int: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def population(self) -> int: ...
    @property
    def is_over(self) -> bool: ...
    def ask(self) -> Any: ...
    def evaluate(self, threads: Optional[int] = None) -> Evaluations: ...
    def champion(self, index: int) -> Champion: ...
    def save_champion(self, path: _Path, index: int) -> None: ...
    def tell(self, results: Evaluations) -> None: ...
    def tell_fitness(
        self, fitness: NDArray[np.float64], disqualified: Optional[NDArray[np.bool_]] = None
    ) -> None: ...
    def archive(self) -> Optional[dict[str, Any]]: ...

@final
class Worlds:
    """Worlds of an environment. Methods take flags, one per world: worlds without one are left alone."""

    def __new__(
        cls,
        problem: Problem,
        count: int,
        actions: str,
        steps_per_action: int,
        stiffness_nm_per_rad: Optional[float] = None,
        damping_nms_per_rad: Optional[float] = None,
        perturbation: Union[None, bool, dict[str, float]] = None,
        disqualification_penalty: float = 0.0,
        threads: Optional[int] = None,
    ) -> Worlds: ...
    def __len__(self) -> int: ...
    @property
    def action_limits(self) -> NDArray[np.float32]: ...
    @property
    def senses(self) -> list[dict[str, Any]]: ...
    @property
    def servo(self) -> tuple[float, float]: ...
    @property
    def physics_steps_per_s(self) -> int: ...
    def reset(
        self, flags: NDArray[np.bool_], seeds: NDArray[np.uint64]
    ) -> NDArray[np.float32]: ...
    def step(
        self, flags: NDArray[np.bool_], actions: NDArray[np.float32]
    ) -> tuple[
        NDArray[np.float32], NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]
    ]: ...
    def state(self) -> dict[str, NDArray[Any]]: ...
    def evaluations(self, flags: NDArray[np.bool_]) -> list[Optional[dict[str, Any]]]: ...
    def poses(self, index: int) -> NDArray[np.float32]: ...
    def champion(self, index: int, seed: int, generation: int, individual: int) -> Champion: ...
    def picture(self, index: int, width: int, height: int) -> NDArray[np.uint8]: ...
    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, Any]]: ...
    def __getstate__(self) -> Any: ...
    def __setstate__(self, state: Any) -> None: ...
    def __deepcopy__(self, memo: Any, /) -> Worlds: ...
