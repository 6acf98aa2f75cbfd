"""Anchors of headings as GitHub makes them, so that links to headings hold there and on the site."""

import re


def github(text, separator):
    """Lower case, punctuation left out, a hyphen for each blank."""
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", separator)
