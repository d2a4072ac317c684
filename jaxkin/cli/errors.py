"""What the command line says when something is wrong: one line for the user's mistakes, a traceback for ours."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import typer


@contextmanager
def one_line_errors() -> Iterator[None]:
    """Turn an error about the user's input into its message on stderr and exit code 2; others pass unchanged."""
    try:
        yield
    except (ValueError, KeyError, OSError, ImportError) as error:
        if not _about_input(error):
            raise
        # the text of a KeyError is its argument in quotes
        typer.echo(f"jaxkin: {error.args[0] if isinstance(error, KeyError) else error}", err=True)
        raise typer.Exit(2) from None


def _about_input(error: BaseException) -> bool:
    """Tell whether an error is about the input: files, missing extras, and what jaxkin itself refuses.

    An error out of numpy or JAX is a defect, and keeps its traceback.
    """
    if isinstance(error, OSError):
        return error.__cause__ is None or _about_input(error.__cause__)
    if not isinstance(error, ValueError | KeyError | ImportError) or (trace := error.__traceback__) is None:
        return False
    while trace.tb_next:
        trace = trace.tb_next
    return trace.tb_frame.f_globals["__name__"].startswith("jaxkin.")
