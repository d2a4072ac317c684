"""XML of unknown origin, read without entities and within bounds."""

from __future__ import annotations

import codecs
import re
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from jaxkin._files import check_file

MOST_BYTES = 256_000_000
"""Of one file: 175 placed parts take 135 kB, so this is room for 300,000."""

OF_NUMBERS = "0123456789.+-eE, \t\r\n"
"""What lists of numbers are written with."""

MOST_LETTERS = 4096
"""Of a text in an attribute that is no list of numbers: as long as a path may be, and far above any name."""

MOST_DEEP = 200
"""Elements inside each other: an instance five assemblies deep is at depth 8."""

_DECLARED = re.compile(rb"<\?xml\b[^>]*?\bencoding\s*=\s*[\"']([\w.:-]+)[\"']")
"""The encoding that XML declares, in one that has the letters of ASCII in their places."""
_RECODED = {"gb2312", "gbk", "gb18030", "big5", "big5hkscs", "cp950", "shift_jis", "cp932", "euc_jp", "iso2022_jp",
            "euc_kr", "cp949", "johab"}  # fmt: skip
"""Encodings of Eastern Asia, as Python calls them: the parser knows none of more than one byte a letter but Unicode."""

MACROS = "xacro:"
"""Prefix of the tags of the macro language of robot files: they are no elements of a format."""
OLD_MACROS = ("include", "macro", "property", "if", "unless")
"""Such tags as old files have them, without the prefix, in the root element."""


def read_xml(path: Path) -> Element:
    """Read the root element of an XML file, tags without their namespaces but for `MACROS`.

    Raises FileNotFoundError where there is no file, and ValueError, in one line, where the file is larger or deeper
    than the bounds, declares a document type (the only place of entities), has a name as long as a book, or is damaged.
    """
    if (size := check_file(path, "file in XML")) > MOST_BYTES:
        raise ValueError(f"{path.name}: {size} bytes of XML; at most {MOST_BYTES} are read")
    return parse_xml(path.read_bytes(), path.name)


def parse_xml(data: bytes, name: str) -> Element:
    """Read the root element of XML as `read_xml` does; `name` is what messages call it."""
    builder, depth = TreeBuilder(), 0
    data, encoding = _for_parser(data.lstrip(), name)  # many readers take blank lines before the declaration
    parser = expat.ParserCreate(encoding)

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > MOST_DEEP:
            raise ValueError(f"{name}: elements nested more than {MOST_DEEP} deep")
        for key, text in attributes.items():
            if len(text) > MOST_LETTERS and text[:MOST_LETTERS].strip(OF_NUMBERS):
                raise ValueError(f"{name}: <{tag[:MOST_DEEP]}>: {key[:MOST_DEEP]!r} is a text of {len(text)} letters")
        builder.start(_local(tag), attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(_local(tag))

    def refuse(*_: object) -> None:
        raise ValueError(f"{name}: declares a document type (DOCTYPE), which may hold entities; remove the line")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = builder.data
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, LookupError, ValueError) as error:  # of encodings that are none, or not known
        if isinstance(error, ValueError) and str(error).startswith(name):
            raise
        raise ValueError(f"{name}: damaged XML: {error}") from None
    return builder.close()


def _for_parser(data: bytes, name: str) -> tuple[bytes, str | None]:
    """Recode XML in an encoding of `_RECODED`, and name what it is in then; None where the parser finds that itself.

    What calls itself utf8 is in UTF-8, which the parser knows by no other name.
    """
    declared = _DECLARED.match(data)
    called = declared[1].decode() if declared else ""
    try:
        encoding = codecs.lookup(called).name if called else ""
        if encoding in _RECODED:
            return data.decode(encoding).encode(), "utf-8"
    except LookupError:
        raise ValueError(f"{name}: damaged XML: unknown encoding {called!r}; save it in UTF-8") from None
    except UnicodeError:
        raise ValueError(f"{name}: damaged XML: it is not in {called}, as it declares; save it in UTF-8") from None
    return data, "utf-8" if encoding == "utf-8" else None


def _local(tag: str) -> str:
    return tag if tag.startswith(MACROS) else tag.rpartition(":")[2]


def has_macros(root: Element) -> bool:
    """Check whether a robot file is still to be expanded: it has macros of xacro, or their parameters in attributes."""
    written = "".join(value for each in root.iter() for value in each.attrib.values())
    marked = any(each.tag.startswith(MACROS) for each in root.iter()) or "${" in written or "$(" in written
    return marked or any(each.tag in OLD_MACROS for each in root)
