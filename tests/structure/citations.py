#!/usr/bin/env python3
"""Holds the citations in comments against the equations of the method: citations.py <source folder>

The equations stand in contrib/doc/theory.md. A display there carries `\\tag{12}`, the number of the paper, or
`\\tag{W1}`, a letter and a number of its own; `\\tag{36, 37, 41}` is three tags. Sections are numbered headings,
`## 3.` or `### 3.1`.

Comments of .cc and .h files and all of .md files in source/, include/ and tests/ cite them in these ways, which may run
over the end of a line:

    eq. 48      eq. (48)      eqs. 2, 3 and W1      eq. 10-15      equations (60)-(61)
    theory section 3.1      theory.md, section 3      (section 3)

A range cites all that lies between its ends. An equation of another publication has a year or a name right before it,
"Puso & Laursen (2004), eq. 12" or "(Wriggers eq. 5)", and is passed over. A word with a capital letter is taken for a
name, unless it begins a sentence or a comment or is one of NOT_AUTHORS: where a name begins a sentence, give the year,
too. What is passed over is listed. A section of another publication has its name before it in the same brackets.

Fails, with exit code 1, where a citation has no tag or no heading, where a tag or a heading is there twice, and where
the page itself refers to a tag or to a section that it does not have. Prints what it counted, and the tags that nothing
cites, which is no failure.
"""

import collections
import pathlib
import re
import sys
import textwrap

NOT_AUTHORS = {"Newton", "Coulomb", "Tresca", "Signorini", "Lambda", "Krylov", "Schur", "Gauss", "Anderson", "GMRES"}

TAG = r"\(?[A-Z]?\d+\)?(?!\.\d)(?!\w)"
BETWEEN = r"\s*(?:,\s*(?:and\s+)?|\s+and\s+|\s*[-\u2013]\s*|\s+to\s+)\s*"
EQUATIONS = re.compile(rf"\b[Ee]qs?\.\s*(?P<list>{TAG}(?:{BETWEEN}{TAG})*)")
SPELT_OUT = re.compile(rf"\b[Ee]quations?\s+(?P<list>\([A-Z]?\d+\)(?:{BETWEEN}\([A-Z]?\d+\))*)")
BROKEN = re.compile(r"\b[Ee]qs?\.\s*\(?\w+(?:\.\w+)*")
SECTION = r"(\d+(?:\.\d+)*(?: [A-Z]\b)?)"
SECTIONS = re.compile(rf"\btheory(?:\.md)?,?\s+section\s+{SECTION}|\(section\s+{SECTION}\)")
NAME = re.compile(r"(?P<before>^|.)\s*\b(?P<name>[A-Z][\w-]*[a-z])(?:'s)?,?\s*$")
YEAR = re.compile(r"\b(?:19|20)\d\d\)?,?[\s(]*$")


def equations_of(page):
    """Tags and section numbers of the page, as counters."""
    text = page.read_text(encoding="utf-8")
    tags = [tag.strip() for group in re.findall(r"\\tag\{([^}]*)\}", text) for tag in group.split(",")]
    headings = re.findall(r"^#{2,4} (\d+(?:\.\d+)*)\.?\s", text, re.MULTILINE)
    return collections.Counter(tags), collections.Counter(headings)


def comments(file):
    """(text, line number of each character) of the comments of a file; lines that follow each other are one text."""
    whole = file.suffix == ".md"
    text, numbers, in_block = "", [], False
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        code, part = line, line if whole else None
        if not whole:
            if not in_block:
                code = re.sub(r'"(?:\\.|[^"\\])*"', '""', line)  # no comments in strings
            start = re.search(r"//+<?|/\*+", code) if not in_block else None
            if in_block or start:
                part = code[start.end() if start else 0:]
                in_block = (in_block or start.group().startswith("/*")) and "*/" not in part
                part = re.sub(r"^\s*\*(?!/)|\*/.*", "", part)
        if part is None or not part.strip():
            if text:
                yield text, numbers
            text, numbers = "", []
            continue
        text += part.strip() + " "
        numbers += [number] * (len(part.strip()) + 1)
    if text:
        yield text, numbers


def expand(cited):
    """Tags of a list such as `2, 3 and W1` or `10-15`, one by one; None where a range is none."""
    items = re.findall(r"\(?([A-Z]?\d+)\)?|([-\u2013]|\bto\b)", cited)
    tags, is_range = [], False
    for tag, dash in items:
        if dash:
            is_range = True
        elif is_range:
            first, last = (re.fullmatch(r"([A-Z]?)(\d+)", t).groups() for t in (tags[-1], tag))
            if first[0] != last[0] or int(first[1]) >= int(last[1]):
                return None
            tags += [f"{first[0]}{n}" for n in range(int(first[1]) + 1, int(last[1]) + 1)]
            is_range = False
        else:
            tags.append(tag)
    return tags


def is_foreign(before):
    """Whether a year, or a name that does not begin a sentence, stands right before a citation."""
    name = NAME.search(before)
    return bool(YEAR.search(before)) or bool(
        name and name.group("before") not in ("", ".", ":", ";", "?", "!") and name.group("name") not in NOT_AUTHORS)


def check_file(file, here, tags, headings):
    """Tags that the comments of a file cite, numbers of sections, what is wrong, and what is passed over."""
    cited, sections, mistakes, passed_over = [], 0, [], []
    for text, numbers in comments(file):
        understood = set()
        for found in list(EQUATIONS.finditer(text)) + list(SPELT_OUT.finditer(text)):
            understood.add(found.start())
            place = f"{here}:{numbers[found.start()]}"
            if is_foreign(text[:found.start()]):
                passed_over.append(f"{place}: '{text[max(0, found.start() - 30):found.end()]}'")
                continue
            each = expand(found.group("list"))
            if each is None:
                mistakes.append(f"{place}: '{found.group()}' is no range")
                continue
            cited += each
            mistakes += [f"{place}: '{found.group()}' cites {tag}, which theory.md does not have"
                         for tag in each if tag not in tags]
        for found in BROKEN.finditer(text):
            if found.start() not in understood and re.search(r"\d", found.group()):
                if not is_foreign(text[:found.start()]):
                    mistakes.append(f"{here}:{numbers[found.start()]}: '{found.group()}' is no tag")
        for found in SECTIONS.finditer(text):
            sections += 1
            section = found.group(1) or found.group(2)
            if section not in headings:
                mistakes.append(f"{here}:{numbers[found.start()]}: section {section} has no heading in theory.md")
    return cited, sections, mistakes, passed_over


def check_page(page, tags, headings):
    """What is wrong with the page itself."""
    mistakes = [f"{page.name}: tag {tag} is there {n} times" for tag, n in tags.items() if n > 1]
    mistakes += [f"{page.name}: section {section} is there {n} times" for section, n in headings.items() if n > 1]
    mistakes += [f"{page.name}: '{tag}' is no tag" for tag in tags if not re.fullmatch(r"[A-Z]?\d+", tag)]
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        for tag in re.findall(r"(?<![\w\\{}])\(([A-Z]?\d{1,2})\)", line):
            if tag not in tags:
                mistakes.append(f"{page.name}:{number}: refers to {tag}, which is no tag")
        for section in re.findall(rf"\bsections? {SECTION}", line, re.IGNORECASE):
            if section.split()[0] not in headings:
                mistakes.append(f"{page.name}:{number}: refers to section {section}, which has no heading")
    return mistakes


def main():
    top = pathlib.Path(sys.argv[1])
    page = top / "contrib" / "doc" / "theory.md"
    if not page.exists():
        print(f"{page} is missing")
        return 1
    tags, headings = equations_of(page)
    mistakes = check_page(page, tags, headings)
    cited, passed_over, n_sections, n_files = collections.Counter(), [], 0, 0
    for folder in ("source", "include", "tests"):
        for file in sorted((top / folder).rglob("*")):
            if file.suffix in (".cc", ".h", ".md"):
                of_file, sections, wrong, foreign = check_file(file, file.relative_to(top), tags, headings)
                cited.update(of_file)
                n_sections += sections
                mistakes += wrong
                passed_over += foreign
                n_files += 1
    print(f"{len(tags)} tags and {len(headings)} sections in theory.md; {sum(cited.values())} citations of "
          f"{sum(tag in tags for tag in cited)} tags and {n_sections} of sections in {n_files} files")
    for place in passed_over:
        print(f"passed over, of another publication: {place}")
    never = [tag for tag in tags if tag not in cited]
    print(textwrap.fill(f"{len(never)} tags that nothing cites: " + " ".join(never), 120))
    for mistake in mistakes:
        print(mistake)
    return 1 if mistakes else 0


if __name__ == "__main__":
    sys.exit(main())
