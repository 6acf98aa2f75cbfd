#!/usr/bin/env python3
"""No expected output of a test says that a comparison failed: expected.py SOURCE_FOLDER"""

import pathlib
import re
import sys

failed = [
    f"{path}:{number}: {line}"
    for path in sorted(pathlib.Path(sys.argv[1], "tests").rglob("*.output"))
    for number, line in enumerate(path.read_text().splitlines(), 1)
    if re.search(r"\bNO\b", line)
]
print("\n".join(failed))
sys.exit(1 if failed else 0)
