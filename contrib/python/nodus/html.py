"""Tables for notebooks."""

import html


def table(header, rows, title=""):
    """A table of texts."""
    cells = "".join(f"<th>{html.escape(str(name))}</th>" for name in header)
    text = f"<p>{html.escape(title)}</p>" if title else ""
    text += f"<table><tr>{cells}</tr>" if header else "<table>"
    for row in rows:
        text += "<tr>" + "".join(f'<td style="text-align: left">{html.escape(str(cell))}</td>' for cell in row) + "</tr>"
    return text + "</table>"
