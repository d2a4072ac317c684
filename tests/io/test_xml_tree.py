"""XML in the encodings that systems write it in."""

import pytest

from jaxkin.io.xml_tree import parse_xml

HEAD = '<?xml version="1.0" encoding="{}"?>\n'


@pytest.mark.parametrize(
    ("said", "encoding", "name"),
    [
        ("UTF-8", "utf-8-sig", "Träger 零件"),
        ("utf8", "utf-8", "Träger 零件"),  # was damaged XML
        ("utf-16", "utf-16", "Träger 零件"),
        ("ISO-8859-1", "latin-1", "Träger"),
        ("windows-1252", "cp1252", "Träger €"),
        ("GB2312", "gb2312", "零件"),  # these were refused by a message without the name of the file
        ("gbk", "gbk", "零件"),
        ("Big5", "big5", "零件"),
        ("Shift_JIS", "shift_jis", "部品"),
        ("EUC-KR", "euc_kr", "부품"),
    ],
)
def test_names_are_read_in_the_encoding_that_the_file_declares(said, encoding, name):
    root = parse_xml(f'{HEAD.format(said)}<robot name="{name}"/>'.encode(encoding), "robot.urdf")
    assert root.get("name") == name


@pytest.mark.parametrize("said", ["nonsense", "utf-7", "rot13", "hex", "gbk"])
def test_what_is_in_no_encoding_that_is_known_is_refused_by_the_name_of_the_file(said):
    with pytest.raises(ValueError, match=r"^robot\.urdf: damaged XML: "):
        parse_xml(HEAD.format(said).encode() + b'<robot name="\xff\xff"/>', "robot.urdf")


def test_entities_are_refused_in_any_encoding():
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaa">]><x>&a;</x>'
    for encoding in ("utf-8", "utf-16", "gbk"):
        with pytest.raises(ValueError, match="DOCTYPE"):
            parse_xml((HEAD.format(encoding) + bomb).encode(encoding), "bad.xml")
