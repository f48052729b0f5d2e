"""Registers the environment with Gymnasium."""

import gymnasium

ENV_ID = "SnakesAndStairs-v0"


def register() -> None:
    """Registers ``SnakesAndStairs-v0``, once. Importing the package does so."""
    if ENV_ID not in gymnasium.registry:
        gymnasium.register(
            id=ENV_ID,
            entry_point="snakes_and_stairs.environment:SnakesAndStairsEnv",
            vector_entry_point="snakes_and_stairs.vector_environment:SnakesAndStairsVectorEnv",
            # The trial itself truncates an episode, so no wrapper has to.
            max_episode_steps=None,
            order_enforce=True,
            disable_env_checker=False,
        )
