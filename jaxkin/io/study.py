"""A study: an assembly or joints by hand, what the user says about it, and its drive; read from one TOML file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from jaxkin._guesses import Guided
from jaxkin._names import listed, nearest
from jaxkin.assembly.wheels import wheels_last
from jaxkin.contacts.contact import Contacts
from jaxkin.io.load import load
from jaxkin.io.named_effects import Result, Settings, compute
from jaxkin.io.ranges import Range, RangeValues, in_radians
from jaxkin.joints.coupling import Coupling
from jaxkin.joints.joint import Joint
from jaxkin.linkage.coordinates import coordinates
from jaxkin.mechanism.mechanism import Mechanism

if TYPE_CHECKING:
    from jaxkin.assembly.assembly import Assembly
    from jaxkin.mechanism.motion import Motion


@dataclass(frozen=True, eq=False, repr=False)
class Study(Guided):
    """All that a sweep needs, each step taken when it is first asked for."""

    source: str
    """The file that says it."""
    assembly: Assembly | None
    """None where all joints are by hand."""
    fixed: Sequence[str] = ()
    rigid: Sequence[Sequence[str]] = ()
    ignore: Sequence[Sequence[str]] = ()
    joints: Sequence[Joint] = ()
    couplings: Sequence[Coupling] = ()
    combine: bool = True
    exclude: Sequence[str] = ()
    """Parts to leave out."""
    infer: bool = True
    """Whether what solids imply beside exact contacts is taken: see `Assembly.mechanism`."""
    detect: bool = True
    """Whether contacts are looked for; otherwise the joints by hand are all there are: see `Assembly.of_joints`."""
    clearance: float | None = None
    """The largest clearance of a pin that is inferred: see `Assembly.mechanism`."""
    align: float | None = None
    """The largest misalignment that is taken for rounding: see `Mechanism.build`."""
    tolerance: Mapping[str, float] = field(default_factory=dict)
    """Of `Assembly.contacts`: length, angle, fit."""
    ranges: Mapping[str, Range] = field(default_factory=dict)
    """The drive as it was written, by joint or coordinate."""
    saved: Mechanism | None = None
    """The mechanism of a file that `Mechanism.save` wrote, which says all but the drive and the effects."""
    motors: Sequence[str] = ()
    """Joints or coordinates with a motor, of mechanisms from files that name some."""
    unit: str = ""
    """Of lengths, where there is no assembly to say it."""
    effects: Settings = field(default_factory=dict)
    """The effects that are asked for, with their settings."""

    def __repr__(self) -> str:
        return f"<Study {self.source!r}>"

    @cached_property
    def contacts(self) -> Contacts:
        """The contacts of the assembly, within the tolerances of the study; none where they are not looked for."""
        if self.assembly is None or not self.detect or self.by_export:
            return Contacts(())
        return self.assembly.contacts(**self.tolerance)  # pyright: ignore[reportArgumentType]

    @property
    def by_export(self) -> bool:
        """Whether what a CAD system exported makes the mechanism, not contacts: see `Assembly.mechanism`."""
        return self.assembly is not None and self.assembly.exported is not None and self.detect and self.infer

    @property
    def held(self) -> Sequence[str]:
        """The parts that are fixed: by the study, or else by the CAD system; none where neither says any."""
        exported = self.assembly.exported if self.assembly and self.by_export else None
        return self.fixed or (exported.fixed if exported else ())

    @cached_property
    def mechanism(self) -> Mechanism:
        """The mechanism; ValueError where what is said about it makes none."""
        try:
            found = self._uncoupled()
            found = found.with_couplings(self.couplings) if self.couplings else found
            return self._with_motors(found) if self.motors else found
        except ValueError as error:
            # the same error with its traceback, which tells what is refused from a defect
            if self.source.endswith(".toml") and self.source not in str(error):
                error.args = (f"{self.source}: {error}",)
            raise

    def _with_motors(self, found: Mechanism) -> Mechanism:
        try:
            coordinates(found.linkage, self.motors)
        except ValueError as error:
            raise ValueError(f"motors: {error}") from None
        return replace(found, motors=tuple(self.motors))

    def _uncoupled(self) -> Mechanism:
        """Make the mechanism without the couplings of the study."""
        if self.saved is not None:
            if self.fixed or self.rigid or self.ignore or self.exclude or not (self.combine and self.infer):
                raise ValueError(
                    f"{self.source} holds a whole mechanism, with its joints, bodies and fixed parts: give it without "
                    "options that say anything about these"
                )
            return self.saved
        if self.assembly is None:
            return Mechanism.build(fixed=self.fixed, joints=self.joints, unit=self.unit, align=self.align)
        if not self.held:
            raise ValueError(f"no part is fixed; the parts are {', '.join(self.assembly.names)}")
        if not self.detect:
            return self.assembly.of_joints(
                fixed=self.fixed, rigid=self.rigid, joints=self.joints, align=self.align, exclude=self.exclude
            )
        return self.assembly.mechanism(
            fixed=self.fixed,
            rigid=self.rigid,
            ignore=self.ignore,
            joints=self.joints,
            combine=self.combine,
            contacts=None if self.by_export else self.contacts,
            align=self.align,
            exclude=self.exclude,
            infer=self.infer,
            clearance=self.clearance,
        )

    @cached_property
    def drive(self) -> Mapping[str, RangeValues]:
        """The driven displacements by coordinate, in radians and in the unit of the mechanism."""
        if not self.ranges:
            joints = self.mechanism.all_joints
            names = ", ".join(name for joint in joints for name in joint.full_names)
            drivable = wheels_last(self.mechanism)
            enough = f"; {listed(drivable)} would be enough" if drivable else ""
            raise ValueError(
                f"nothing is driven: give --drive JOINT=RANGE, once or more, or [drive] in a study{enough}; there are "
                f"{names or 'no coordinates at all'}"
            )
        kept = {joint.name for joint in self.mechanism.all_joints}
        for joint in self.joints:
            if joint.name not in kept and any(name in (joint.name, *joint.full_names) for name in self.ranges):
                told = [note for note in self.mechanism.history if note.startswith(f"joint {joint.name!r} is left out")]
                why = told[0] if told else f"joint {joint.name!r} is not in the mechanism"
                raise ValueError(f"{self.source}: {why}, but it is driven: take that back, or drive another joint")
        return in_radians(self.mechanism, self.ranges)

    def sweep(self) -> Motion:
        """Compute the motion of the mechanism for the drive."""
        return self.mechanism.sweep(self.drive)

    def computed(self, motion: Motion) -> dict[str, Result]:
        """Compute the effects of a motion that the study asks for, by name."""
        return compute(motion, self.effects)


def load_study(
    path: str | Path, *, seconds: float | None = None, progress: Callable[[int, int], None] | None = None
) -> Study:
    """Load the study that a TOML file describes; its geometry is looked for beside the file, and read as by `load`,
    within `seconds` a file and with its `progress`.

    Raises FileNotFoundError where there is no such file, and ValueError, with the key, what arrived and what was
    expected, where it is no study. What it says about parts and joints is checked when `mechanism` or `drive` is asked
    for.
    """
    from jaxkin.io.study_file import read_study_file

    path = Path(path)
    said = read_study_file(path)
    joints = said.made_joints(path.name)
    common = {
        "fixed": said.instead.fixed or said.fixed,
        "rigid": said.rigid,
        "ignore": said.ignore,
        "exclude": said.exclude,
        "motors": said.motors,
    }
    common |= {"couplings": said.made_couplings(path.name)}
    common |= {"joints": joints, "combine": said.combine, "detect": said.contacts, "infer": said.infer}
    common |= {"ranges": said.ranges(), "unit": said.unit, "align": said.align}
    common |= {"clearance": said.clearance, "effects": said.asked_effects(path.name)}
    if said.geometry is None:
        return Study(path.name, None, **common)
    place = path.parent
    source = said.geometry
    assembly = load(
        place / source if isinstance(source, str) else {part: place / file for part, file in source.items()},
        seconds=seconds,
        loops=None if said.loops is None else place / said.loops,
        progress=progress,
    )
    if assembly.saved is not None:
        raise ValueError(
            f"{path.name}: {assembly.source} holds a whole mechanism, with its joints and fixed parts, about which a "
            f"study says nothing: give it in place of the study, as in jaxkin sweep {assembly.source} --drive ..., or "
            f"load({assembly.source!r}).mechanism()"
        )
    if not assembly.unit:  # formats of meshes that have none
        assembly = replace(assembly, unit=said.unit)
    if said.unit and said.unit != assembly.unit:
        raise ValueError(
            f"{path.name}: unit is {said.unit!r}, but {assembly.source} is in {assembly.unit!r}; write all lengths of "
            f"{path.name} in {assembly.unit} and unit = {assembly.unit!r}"
        )
    assembly = _renamed(assembly, said.rename, path.name)
    return Study(path.name, assembly, tolerance=said.tolerance.given(), **common)


def _renamed(assembly: Assembly, names: Mapping[str, str], source: str) -> Assembly:
    for old in names:
        if old not in assembly.names:
            raise ValueError(
                f"{source}: rename: {assembly.source} has no part {old!r} to rename{nearest(old, assembly.names)}"
            )
    parts = tuple(replace(part, name=names.get(part.name, part.name)) for part in assembly.parts)
    taken = [part.name for part in parts]
    for new in names.values():
        if taken.count(new) > 1:
            raise ValueError(f"{source}: rename: two parts would be called {new!r}; give each a name of its own")
    return replace(assembly, parts=parts, exported=assembly.exported and assembly.exported.renamed(names))
