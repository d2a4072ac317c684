"""The glossary has one meaning a word."""

import re
from collections import Counter

from documents import ROOT


def test_no_term_stands_twice():
    text = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    terms = Counter(term for line in re.findall(r"^(\S.*)\n:   ", text, re.M) for term in line.split(", "))
    assert len(terms) > 60
    assert {term for term, count in terms.items() if count > 1} == set()
