"""What the command line says when something is wrong: one line for the user's mistakes, a traceback for ours."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

import typer


@contextmanager
def one_line_errors() -> Iterator[None]:
    """Turn an error about the user's input into its message on stderr and exit code 2; others pass unchanged.

    Warnings on the way become one line each on stderr, too, without the line of source that raised them.
    """
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _say_warning
            yield
    except (ValueError, KeyError, OSError, ImportError) as error:
        if not about_input(error):
            raise
        # the text of a KeyError is its argument in quotes
        typer.echo(f"jaxkin: {error.args[0] if isinstance(error, KeyError) else error}", err=True)
        raise typer.Exit(2) from None


def _say_warning(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    file: TextIO | None = None,
    line: str | None = None,
) -> None:
    """Print a warning as a message of the command line; of a kind that is not for users, with its origin."""
    origin = "" if category is UserWarning else f" ({category.__name__} at {filename}:{lineno})"
    typer.echo(f"jaxkin: warning: {message}{origin}", err=True)


def about_input(error: BaseException) -> bool:
    """Tell whether an error is about the input: files, missing extras, and what jaxkin itself refuses.

    An error out of numpy or JAX is a defect, and keeps its traceback.
    """
    if isinstance(error, OSError):
        return error.__cause__ is None or about_input(error.__cause__)
    if not isinstance(error, ValueError | KeyError | ImportError) or (trace := error.__traceback__) is None:
        return False
    while trace.tb_next:
        trace = trace.tb_next
    return trace.tb_frame.f_globals["__name__"].startswith("jaxkin.")
