"""Packages that only some things need."""

from importlib import import_module

__all__ = ["needs"]


def needs(package: str) -> None:
    """Sees that a package is there, or says how it comes."""
    try:
        import_module(package)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise
        raise ModuleNotFoundError(f"this needs {package}, which is not installed: pip install {package}", name=package) from None
