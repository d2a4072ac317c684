"""An assembly: the parts of a mechanism as solids in their assembled pose."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from jaxkin.geometry.part import Part


@dataclass(frozen=True, eq=False)
class Assembly:
    """Solids in their assembled pose, as they were read."""

    parts: tuple[Part, ...]
    unit: str
    """Unit of all lengths, such as "mm"."""
    source: str
    """The file that it was read from."""

    def __str__(self) -> str:
        lines = [f"Assembly of {len(self.parts)} parts from {self.source}, lengths in {self.unit}"]
        width = max(len(part.name) for part in self.parts)
        for part in self.parts:
            kinds = Counter(face.surface.kind for face in part.faces)
            faces = ", ".join(f"{count} {kind}{'s' if count > 1 else ''}" for kind, count in sorted(kinds.items()))
            lines.append(f"  {part.name.ljust(width)}  {faces or 'no face that was understood'}")
            lines += [f"  {' ' * width}    {note}" for note in part.notes]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<Assembly {self.source!r}: {', '.join(part.name for part in self.parts)}; {self.unit}>"
