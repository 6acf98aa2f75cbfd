"""The links of the pages, before and after they are made into a site."""

import html.parser
import pathlib
import re
import urllib.parse


def files_linked_from(page):
    """The local files that a Markdown page links to or shows."""
    targets = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    paths = [urllib.parse.unquote(target.partition("#")[0]) for target in targets if "://" not in target]
    return [(page.parent / path).resolve() for path in paths if path]


class Page(html.parser.HTMLParser):
    """Anchors and links of a made page, and paragraphs that look like a list or a table."""

    def __init__(self, file):
        super().__init__()
        self.anchors, self.links, self.odd = set(), [], []
        self._paragraph = None
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(filter(None, (attributes.get("id"), attributes.get("name"))))
        self.links += filter(None, (attributes.get("href"), attributes.get("src")))
        if tag == "p":
            self._paragraph = ""

    def handle_endtag(self, tag):
        if tag == "p" and self._paragraph is not None:
            if re.search(r"^(- |\d+\. |\||```)", self._paragraph, re.MULTILINE):
                self.odd.append(self._paragraph)
            self._paragraph = None

    def handle_data(self, data):
        if self._paragraph is not None:
            self._paragraph += data


def check(site):
    """One line for each link that leads nowhere and each paragraph that was meant to be a list or a table."""
    pages = {file: Page(file) for file in sorted(site.rglob("*.html")) if file.name != "404.html"}  # that one's links are absolute
    mistakes = []
    for file, page in pages.items():
        where = file.relative_to(site)
        mistakes += [f"{where}: not seen as a list or a table: {text}" for text in page.odd]
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            if target.is_dir():
                target = target / "index.html"
            if not target.is_file():
                mistakes.append(f"{where}: {link} leads nowhere")
            elif parts.fragment and target in pages and parts.fragment not in pages[target].anchors:
                mistakes.append(f"{where}: {link}: the page has no such heading")
    return mistakes
