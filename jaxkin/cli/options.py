"""What stands on the command line beside the file: ranges of `--drive`, parts of `--rigid` and `--ignore`."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jaxkin.io.ranges import Range
    from jaxkin.io.study import Study

_BETWEEN = re.compile(r"\s-\s|,(?!\s*\d)")
"""What stands between the parts of an option: a comma, or the dash of the reports; but "face 3, 8" is one face."""


@dataclass(frozen=True)
class Options:
    """The options as they were written, in the order of the commands: first those that all of them have."""

    fixed: Sequence[str] = ()
    rigid: Sequence[str] = ()
    ignore: Sequence[str] = ()
    exclude: Sequence[str] = ()
    exact_only: bool = False
    no_combine: bool = False
    unit: str | None = None
    loops_file: Path | None = None
    seconds: float | None = None
    drive: Sequence[str] = ()
    effects: Sequence[str] = ()

    def on(self, files: Sequence[Path], progress: Callable[[int, int], None] | None = None) -> Study:
        """Make the study of a file, or of files of one part each, with the options; `progress` is that of `load`."""
        drives = parse_drives(self.drive)
        effects = parse_effects(self.effects)
        rigid, ignore = parse_parts("--rigid", self.rigid), parse_parts("--ignore", self.ignore)
        study = self._study(files, progress)
        return replace(
            study,
            fixed=list(dict.fromkeys((*study.fixed, *self.fixed))),
            rigid=[*study.rigid, *rigid],
            ignore=[*study.ignore, *ignore],
            ranges=drives or study.ranges,
            combine=study.combine and not self.no_combine,
            exclude=[*study.exclude, *self.exclude],
            infer=study.infer and not self.exact_only,
            effects={name: study.effects.get(name, {}) for name in (*study.effects, *effects)},
        )

    def _study(self, files: Sequence[Path], progress: Callable[[int, int], None] | None) -> Study:
        """Make the study of what the files say."""
        from jaxkin.io.load import load
        from jaxkin.io.study import Study, load_study

        studies = [file for file in files if file.suffix.lower() == ".toml"]
        if len(files) == 1 and studies:
            if self.unit:
                raise ValueError(f'--unit {self.unit}: write unit = "{self.unit}" in {files[0].name}')
            if self.loops_file:
                raise ValueError(f"--loops {self.loops_file}: write the key loops beside geometry in {files[0].name}")
            return load_study(files[0], seconds=self.seconds, progress=progress)
        if studies:
            raise ValueError(
                f"{studies[0].name} is a study, which names its geometry itself: give it alone, and write geometry = "
                '{ crank = "crank.stl", ... } in it'
            )
        if len(files) == 1:
            given = load(files[0], unit=self.unit, seconds=self.seconds, loops=self.loops_file, progress=progress)
            if given.saved is not None:
                return Study(files[0].name, None, saved=given.saved)
            return Study(files[0].name, given)
        parts = {file.stem: file for file in files}
        if len(parts) < len(files):
            first: dict[str, Path] = {}
            one, other = next(
                (file, first[file.stem]) for file in files if first.setdefault(file.stem, file) is not file
            )
            if one == other:
                raise ValueError(f"{one} is given twice: give each file once")
            raise ValueError(
                f"{one} and {other}: two parts would be called {one.stem!r}; rename a file, or name "
                "the parts in a study"
            )
        assembly = load(parts, unit=self.unit, seconds=self.seconds, loops=self.loops_file, progress=progress)
        return Study(assembly.source, assembly)


def parse_drives(options: Iterable[str]) -> dict[str, Range]:
    """Read displacements by name as they were written, one option each: "crank=0:360:361" or "crank=0,10,25".

    Raises ValueError for an option that cannot be read, and for a name given twice.
    """
    from jaxkin.io.ranges import FORM, Range, read_range

    drives: dict[str, Range] = {}
    for option in options:
        name, equals, values = option.rpartition("=")
        if not equals or not name:
            raise ValueError(f"--drive {option}: write JOINT={FORM}")
        if name in drives:
            raise ValueError(f"--drive {option}: {name} was given a range already; give each joint coordinate once")
        try:
            drives[name] = Range(read_range(values))
        except ValueError as error:
            raise ValueError(f"--drive {option}: {error}") from None
    return drives


def parse_effects(options: Iterable[str]) -> list[str]:
    """Read the names of effects, commas between them; ValueError for others."""
    from jaxkin.io.named_effects import check_effects

    names = [name.strip() for option in options for name in option.split(",")]
    try:
        check_effects(names)
    except ValueError as error:
        raise ValueError(f"--effects {','.join(options)}: {error}") from None
    return names


def parse_parts(option: str, values: Iterable[str]) -> list[list[str]]:
    """Read the parts that each value of an option names: "bolt,plate" or "bolt face 3 - plate face 7"; two at least."""
    groups = []
    for value in values:
        names = [name.strip() for name in _BETWEEN.split(value)]
        if not all(names) or (len(names) < 2 and "*" not in value):
            raise ValueError(
                f"{option} {value}: expected two parts with a comma between them, as in bolt,plate, or Arm* for several"
            )
        groups.append(names)
    return groups
