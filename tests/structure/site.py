#!/usr/bin/env python3
"""The site of the documentation: site.py <source folder>

Builds it (contrib/site/build fails on dead links, pages in no menu, and lists and tables that are not seen as such) and looks
for what a reader would miss first; then holds the check of links against a small site with one mistake of each kind.
"""

import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True

SOURCE = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(SOURCE / "contrib" / "site"))
import links  # noqa: E402


def build(folder):
    """Faults of the site that the command makes."""
    made = subprocess.run([SOURCE / "contrib" / "site" / "build", folder], capture_output=True, text=True)
    if made.returncode:
        return [made.stdout + made.stderr]
    faults = []
    for page, text in (
        ("index.html", "first_case"),
        ("contrib/doc/theory/index.html", "\\tag{K1}"),
        ("contrib/doc/parameters/index.html", "Friction coefficient"),
        ("search/search_index.json", "Viscous stabilisation"),
    ):
        file = folder / page
        if not file.is_file() or text not in file.read_text(encoding="utf-8"):
            faults.append(f"{page} has no {text}")
    return faults


def mistakes(folder):
    """Faults of the check itself: what it does not object to in pages that are wrong."""
    (folder / "right.html").write_text('<h2 id="here">Here</h2><p>See <a href="wrong.html#there">there</a></p>')
    (folder / "wrong.html").write_text(
        '<h2 id="there">There</h2><a href="gone.html">1</a><a href="right.html#gone">2</a><img src="gone.png">'
        '<p>Three things:\n- one\n- two</p><a href="#there">3</a><a href="https://nowhere.invalid">4</a>')
    found = links.check(folder)
    expected = ["wrong.html: not seen as a list", "wrong.html: gone.html leads", "wrong.html: right.html#gone: the page has no",
                "wrong.html: gone.png leads"]
    return [f"not found: {start}" for start in expected if not any(line.startswith(start) for line in found)] + [
        f"found: {line}" for line in found if not any(line.startswith(start) for start in expected)]


with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
    faults = build(pathlib.Path(one) / "site") + mistakes(pathlib.Path(other))
print("\n".join(faults) or "The site is whole.")
sys.exit(1 if faults else 0)
