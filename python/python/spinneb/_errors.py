"""What can go wrong."""

__all__ = ["ConfigError", "SpinnebError"]


class SpinnebError(Exception):
    """A computation that cannot go on, or a folder that holds no result."""


class ConfigError(SpinnebError, ValueError):
    """Something wrong with a config, in the words of the command line."""
