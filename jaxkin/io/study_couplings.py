"""Couplings in studies: the tables `[couplings.NAME]`, read and written."""

from __future__ import annotations

from functools import partial
from inspect import Parameter, signature
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, create_model, model_validator

from jaxkin.io.study_tables import STRICT, FiniteNumber, one_of
from jaxkin.joints.coupling import COUPLINGS, Coupling

_VALUES = {
    "str": str,
    "Number": FiniteNumber,
    "Mapping[str, Number]": dict[str, FiniteNumber],
    "Sequence[Number] | Array | np.ndarray": Annotated[list[FiniteNumber], Field(min_length=2)],
}
"""Annotation of an argument in `jaxkin.joints.coupling` -> what a study may say for it."""


def _arguments(kind: str) -> dict[str, Parameter]:
    """List what the function of a kind of coupling takes, but for the name of the coupling."""
    return {name: each for name, each in signature(COUPLINGS[kind]).parameters.items() if name != "name"}


def _value(kind: str, argument: Parameter) -> Any:
    """Return what a study may say for an argument; TypeError for an annotation that has no row in `_VALUES`."""
    if argument.annotation not in _VALUES:
        raise TypeError(
            f"the argument {argument.name!r} of the coupling {kind!r} is annotated {argument.annotation!r}: give it "
            f"one of {', '.join(map(repr, _VALUES))}, or {__name__}._VALUES a row"
        )
    return _VALUES[argument.annotation] | None


_KEYS: dict[str, Any] = {
    name: (_value(kind, each), None) for kind in COUPLINGS for name, each in _arguments(kind).items()
}
"""Keys of a coupling, of whichever kind, and what each may hold."""


class CouplingTable(create_model("CouplingKeys", __config__=STRICT, **_KEYS)):
    """A coupling: its kind, and what the function of that kind takes."""

    kind: Annotated[str, BeforeValidator(partial(one_of, COUPLINGS))]

    @model_validator(mode="after")
    def _keys_of_the_kind(self) -> CouplingTable:
        takes = _arguments(self.kind)
        missing = [name for name, p in takes.items() if p.default is p.empty and getattr(self, name) is None]
        if missing:
            raise ValueError(f"a coupling of kind {self.kind!r} needs {' and '.join(missing)}")
        if beyond := [name for name in self.arguments() if name not in takes]:
            raise ValueError(f"a coupling of kind {self.kind!r} has no {beyond[0]}; it takes {', '.join(takes)}")
        return self

    def arguments(self) -> dict[str, Any]:
        """Return the keys that were said beside the kind, as arguments of the function of the kind."""
        return self.model_dump(exclude_none=True, exclude={"kind"})

    def made(self, name: str) -> Coupling:
        """Make the coupling, with its name; ValueError for numbers that make none."""
        return COUPLINGS[self.kind](**self.arguments(), name=name)


def coupling_keys(given: Coupling) -> dict[str, object]:
    """Write a coupling as the keys of its table in a study; ValueError for polynomials of several coordinates."""
    coefficients, offset = np.asarray(given.coefficients, float), float(given.offset)
    if coefficients.shape[1] == 1 or not coefficients[:, 1:].any():
        factors = dict(zip(given.coordinates, coefficients[:, 0].tolist(), strict=True))
        said: dict[str, object] = {"kind": "relation", "factors": factors}
        return said | ({"offset": offset} if offset else {})
    leader, follower = given.coordinates[0], given.coordinates[-1]
    if len(given.coordinates) != 2 or coefficients[1, 0] != -1.0 or coefficients[1, 1:].any():
        raise ValueError(f"coupling {given.name!r} of polynomials cannot be said in a study: {given}")
    powers = [-offset, *coefficients[0].tolist()]
    return {"kind": "polynomial", "follower": follower, "leader": leader, "coefficients": powers}
