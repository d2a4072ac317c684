"""The TOML file of a study: its keys, validated, and messages about what is wrong in it."""

from __future__ import annotations

import tomllib
from functools import partial
from inspect import signature
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, BeforeValidator, Field, PlainValidator, ValidationError, model_validator

from jaxkin._files import check_file
from jaxkin.geometry.movements import is_length
from jaxkin.geometry.units import METRES
from jaxkin.io.named_effects import Settings, check_effects
from jaxkin.io.ranges import FORM, MAX_POSES, RADIANS, Range, read_range
from jaxkin.io.study_couplings import CouplingTable
from jaxkin.io.study_errors import messages
from jaxkin.io.study_tables import STRICT, FiniteNumber, one_of
from jaxkin.joints import pairs
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.curve_joints import FOLLOWERS
from jaxkin.joints.joint import Joint
from jaxkin.joints.limits import with_limits
from jaxkin.mobility.alignment import MISALIGNMENT_LEVELS

JOINT_FUNCTIONS = {str(kind): function for kind, function in pairs.JOINTS_BY_HAND.items()} | {
    "contact": pairs.contact_joint
}
"""Kinds of joints by hand; the keys that each takes are the arguments of its function."""

MAX_STUDY_BYTES = 1_000_000
"""Bytes of a study at most; they are written by people."""

Triple = Annotated[list[FiniteNumber], Field(min_length=3, max_length=3)]
PlanePoint = Annotated[list[FiniteNumber], Field(min_length=2, max_length=2)]
MatrixRow = Annotated[list[FiniteNumber], Field(min_length=4, max_length=4)]
Frame = Annotated[list[MatrixRow], Field(min_length=4, max_length=4)]
TwoNames = Annotated[list[str], Field(min_length=2, max_length=2)]
TwoNumbers = Annotated[list[float], Field(min_length=2, max_length=2)]


def _geometry(value: object) -> object:
    values = value.values() if isinstance(value, dict) and value else [value]
    if not all(isinstance(file, str) and file for file in values):
        raise ValueError(f"expected the name of a file, or a table of files by part, got {value!r}")
    return value


def _as_range(value: object) -> object:
    """Read a text or a list as the table that says the same."""
    if isinstance(value, str):
        return {"values": read_range(value).tolist()}
    if isinstance(value, list):
        return {"values": value}
    if isinstance(value, dict):
        return value
    raise ValueError(f"expected a text {FORM}, a list of numbers, or a table, got {value!r}")


def _settings(value: object) -> object:
    """Take whether an effect is asked for, or its settings."""
    if isinstance(value, bool | dict):
        return value
    raise ValueError(f'expected true, false, or a table of settings such as {{ density = "steel" }}, got {value!r}')


class ToleranceTable(BaseModel):
    """What still counts as touching: the arguments of `Assembly.contacts`."""

    model_config = STRICT
    length: Annotated[FiniteNumber, Field(gt=0)] | None = None
    angle: Annotated[FiniteNumber, Field(gt=0)] | None = None
    fit: Annotated[FiniteNumber, Field(ge=0)] | None = None

    def given(self) -> dict[str, float]:
        """Return the tolerances that were said, by name."""
        return self.model_dump(exclude_none=True)


class JointTable(BaseModel):
    """A joint by hand: its kind, its two parts, and what the function of that kind takes."""

    model_config = STRICT
    kind: Annotated[str, BeforeValidator(partial(one_of, JOINT_FUNCTIONS))]
    parts: TwoNames
    point: Triple | None = None
    axis: Triple | None = None
    axis1: Triple | None = None
    axis2: Triple | None = None
    normal: Triple | None = None
    direction: Triple | None = None
    centre: Triple | None = None
    pitch: FiniteNumber | None = None
    profile: list[PlanePoint] | None = None
    surface: list[list[Triple]] | None = None
    closed: bool | Annotated[list[bool], Field(min_length=2, max_length=2)] | None = None
    follower: Annotated[str, BeforeValidator(partial(one_of, FOLLOWERS))] | None = None
    radius: FiniteNumber | None = None
    point2: Triple | None = None
    direction2: Triple | None = None
    profile2: list[PlanePoint] | None = None
    closed2: bool | None = None
    contact: Triple | None = None
    state: str | None = None
    frames: list[Frame] | None = None
    region: Annotated[str, BeforeValidator(partial(one_of, ("circle",)))] | None = None
    limits: TwoNumbers | dict[str, TwoNumbers] | None = None
    off: bool = False

    @model_validator(mode="after")
    def _keys_of_the_kind(self) -> JointTable:
        needed = {
            name: p for name, p in signature(JOINT_FUNCTIONS[self.kind]).parameters.items() if p.kind is p.KEYWORD_ONLY
        }
        missing = [name for name, p in needed.items() if p.default is p.empty and getattr(self, name) is None]
        if missing:
            raise ValueError(f"a joint of kind {self.kind!r} needs {' and '.join(missing)}")
        if beyond := [name for name in self.arguments() if name not in needed]:
            takes = f"takes {', '.join(needed)}" if needed else "takes nothing but its parts"
            raise ValueError(f"a joint of kind {self.kind!r} has no {beyond[0]}; it {takes}")
        return self

    def arguments(self) -> dict[str, Any]:
        """Return the keys that were said beside the kind and the parts, as arguments of the function of the kind."""
        said = self.model_dump(exclude_none=True, exclude={"kind", "parts", "limits", "off"})
        return {
            name: np.array(value, float) if isinstance(value, list) and name != "closed" else value
            for name, value in said.items()
        }

    def limited(self, joint: Joint) -> Joint:
        """Make the joint with its limits, which a study has in degrees and lengths."""
        if self.limits is None:
            return joint
        names = joint.coordinates
        said = self.limits if isinstance(self.limits, dict) else dict.fromkeys(names[:1], self.limits)
        for name, (low, high) in said.items():
            if not low <= high:  # refused here, in the unit in which they were written
                raise ValueError(
                    f"joint {joint.name!r}: the limits of {name} must be two numbers, the lower one first, in degrees "
                    f"or a length, got [{low:g}, {high:g}]"
                )
        given = {
            name: ends if name in names and is_length(name) else [float(np.radians(end)) for end in ends]
            for name, ends in said.items()
        }
        return with_limits(joint, given if len(names) == 1 or isinstance(self.limits, dict) else self.limits)


class RangeTable(BaseModel):
    """The displacements of a joint coordinate: `values`, or `poses` of them evenly `from` one `to` another."""

    model_config = STRICT
    first: FiniteNumber | None = Field(None, alias="from")
    last: FiniteNumber | None = Field(None, alias="to")
    poses: Annotated[int, Field(ge=1, le=MAX_POSES)] | None = None
    values: Annotated[list[FiniteNumber], Field(min_length=1)] | None = None
    unit: Annotated[str, BeforeValidator(partial(one_of, ("", *RADIANS, *filter(None, METRES))))] = ""

    @model_validator(mode="after")
    def _one_way(self) -> RangeTable:
        ends = [self.first, self.last, self.poses]
        if (self.values is None) == (None in ends) or (self.values is not None and ends != [None] * 3):
            raise ValueError("expected either values, or from, to and poses, beside the unit")
        if self.poses == 1 and self.first != self.last:
            raise ValueError(
                f"one pose cannot be both from = {self.first:g} and to = {self.last:g}; give 2 poses or more, or "
                f"values = [{self.first:g}]"
            )
        return self

    def range(self) -> Range:
        """Return the range of values, with the unit of these."""
        if self.values is not None:
            return Range(np.array(self.values, float), self.unit)
        return Range(np.linspace(self.first or 0.0, self.last or 0.0, self.poses or 1), self.unit)


Drive = dict[str, Annotated[RangeTable, BeforeValidator(_as_range)]]


class InsteadTable(BaseModel):
    """What is taken in place of the fixed parts, or of the drive, or of both, that stand elsewhere in the study."""

    model_config = STRICT
    fixed: Annotated[list[str], Field(min_length=1)] | None = None
    drive: Drive | None = None


class StudyFile(BaseModel):
    """The keys of a study."""

    model_config = STRICT
    geometry: Annotated[Any, BeforeValidator(_geometry)] = None
    loops: Annotated[str, Field(min_length=1)] | None = None
    unit: Annotated[str, BeforeValidator(partial(one_of, METRES))] = ""
    rename: dict[str, str] = {}
    fixed: Annotated[list[str], Field(min_length=1)]
    rigid: list[Annotated[list[str], Field(min_length=1)]] = []
    ignore: list[TwoNames] = []
    exclude: list[str] = []
    motors: list[str] = []
    contacts: bool = True
    infer: bool = True
    clearance: Annotated[FiniteNumber, Field(ge=0)] | None = None
    combine: bool = True
    align: Annotated[FiniteNumber, Field(ge=0, le=MISALIGNMENT_LEVELS[-1])] | None = None
    tolerance: ToleranceTable = ToleranceTable()
    joints: dict[str, JointTable] = {}
    couplings: dict[str, CouplingTable] = {}
    drive: Drive = {}
    instead: InsteadTable = InsteadTable()
    effects: dict[str, Annotated[bool | dict[str, Any], PlainValidator(_settings)]] = {}

    @model_validator(mode="after")
    def _solids_or_joints(self) -> StudyFile:
        if self.geometry is None:
            if not self.joints:
                raise ValueError("there is nothing to study: expected geometry, or joints, or both")
            for key in ("loops", "rename", "rigid", "ignore", "exclude", "clearance", "tolerance"):
                if key in self.model_fields_set:
                    raise ValueError(f"{key} is about parts from files, but no geometry is given; leave it out")
        if not self.contacts:
            for key in ("tolerance", "clearance", "ignore", "combine"):
                if key in self.model_fields_set:
                    raise ValueError(
                        f"{key} is about contacts, which contacts = false does not look for; leave {key} out, or "
                        "delete contacts = false, and [joints] and rigid where these are to be found anew"
                    )
        return self

    def made_joints(self, file: str) -> tuple[Joint, ...]:
        """Make the joints by hand that are not off; ValueError for an axis that is none, and the like."""
        made = []
        for name, table in self.joints.items():
            if table.off:
                continue
            try:
                joint = JOINT_FUNCTIONS[table.kind](name, table.parts[0], table.parts[1], **table.arguments())
                made.append(table.limited(joint))
            except ValueError as error:
                raise ValueError(f"{file}: {error}") from None
        return tuple(made)

    def made_couplings(self, file: str) -> tuple[Coupling, ...]:
        """Make the couplings; ValueError for a ratio of zero, and the like."""
        made = []
        for name, table in self.couplings.items():
            try:
                made.append(table.made(name))
            except ValueError as error:
                raise ValueError(f"{file}: couplings.{name}: {error}") from None
        return tuple(made)

    def asked_effects(self, file: str) -> Settings:
        """Find the effects that are not off, with their settings; ValueError for names of no effect."""
        try:
            check_effects(self.effects)
        except ValueError as error:
            raise ValueError(f"{file}: effects: {error}") from None
        return {name: {} if said is True else said for name, said in self.effects.items() if said is not False}

    def ranges(self) -> dict[str, Range]:
        """Return the drive as it was written: a range for each coordinate, by name."""
        drive = self.drive if self.instead.drive is None else self.instead.drive
        return {name: table.range() for name, table in drive.items()}


_KEYS = {
    (): tuple(StudyFile.model_fields),
    ("tolerance",): tuple(ToleranceTable.model_fields),
    ("joints", "*"): tuple(JointTable.model_fields),
    ("couplings", "*"): tuple(CouplingTable.model_fields),
    ("drive", "*"): ("from", "to", "poses", "values", "unit"),
    ("instead",): tuple(InsteadTable.model_fields),
    ("instead", "drive", "*"): ("from", "to", "poses", "values", "unit"),
}


def read_study_file(path: Path) -> StudyFile:
    """Read the file as it is written, validated; ValueError, FileNotFoundError otherwise."""
    if (size := check_file(path, "TOML file of a study")) > MAX_STUDY_BYTES:
        raise ValueError(f"{path.name} has {size} bytes: a study has {MAX_STUDY_BYTES} at most")
    try:
        said = tomllib.loads(path.read_bytes().decode("utf-8-sig"))  # editors of Windows write a mark
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path.name} cannot be read as TOML: {error}") from None
    except RecursionError:
        raise ValueError(f"{path.name} cannot be read as TOML: it is nested too deeply") from None
    try:
        return StudyFile.model_validate(said)
    except ValidationError as error:
        raise ValueError(messages(error, path.name, _KEYS)) from None
