"""Couplings in studies: the tables `[couplings.NAME]`, read and written."""

from __future__ import annotations

from functools import partial
from inspect import signature
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, Field, model_validator

from jaxkin.io.study_tables import STRICT, Number, one_of
from jaxkin.joints import coupling
from jaxkin.joints.coupling import Coupling

COUPLING_FUNCTIONS = {
    function.__name__: function
    for function in (
        coupling.gear,
        coupling.belt,
        coupling.rack,
        coupling.differential,
        coupling.relation,
        coupling.polynomial,
    )
}
"""Kinds of couplings; the keys that each takes are the arguments of its function."""


class CouplingTable(BaseModel):
    """A coupling: its kind, and what the function of that kind takes."""

    model_config = STRICT
    kind: Annotated[str, BeforeValidator(partial(one_of, COUPLING_FUNCTIONS))]
    a: str | None = None
    b: str | None = None
    ratio: Number | None = None
    radius_a: Number | None = None
    radius_b: Number | None = None
    pinion: str | None = None
    rack: str | None = None
    radius: Number | None = None
    carrier: str | None = None
    factors: dict[str, Number] | None = None
    offset: Number | None = None
    follower: str | None = None
    leader: str | None = None
    coefficients: Annotated[list[Number], Field(min_length=2)] | None = None

    @model_validator(mode="after")
    def _keys_of_the_kind(self) -> CouplingTable:
        takes = {name: p for name, p in signature(COUPLING_FUNCTIONS[self.kind]).parameters.items() if name != "name"}
        missing = [name for name, p in takes.items() if p.default is p.empty and getattr(self, name) is None]
        if missing:
            raise ValueError(f"a coupling of kind {self.kind!r} needs {' and '.join(missing)}")
        if beyond := [name for name in self.arguments() if name not in takes]:
            raise ValueError(f"a coupling of kind {self.kind!r} has no {beyond[0]}; it takes {', '.join(takes)}")
        return self

    def arguments(self) -> dict[str, Any]:
        """What was said beside the kind."""
        return self.model_dump(exclude_none=True, exclude={"kind"})

    def made(self, name: str) -> Coupling:
        """The coupling; ValueError for numbers that make none."""
        return COUPLING_FUNCTIONS[self.kind](**self.arguments(), name=name)


def coupling_keys(given: Coupling) -> dict[str, object]:
    """The keys of a table that says a coupling; ValueError for polynomials of several coordinates."""
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
