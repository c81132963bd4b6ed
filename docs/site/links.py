"""Checks that each link and picture of a built site leads to a file and an anchor of it, and that no page loads
a file of another site. Usage: links.py FOLDER"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """The links of a page, and what they may lead to."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.loaded, self.anchors = [], [], {"", "top"}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name", "data-view") and value:  # data-view: a view that a script shows
                self.anchors.add(value)
            elif name in ("href", "src") and value:
                self.targets.append(value)
                if name == "src" or (tag == "link" and "stylesheet" in (dict(attributes).get("rel") or "")):
                    self.loaded.append(value)


def faults(folder):
    """A line for each link that leads nowhere, and for each file of another site that a page loads.

    Links to other sites are not followed.
    """
    pages = {path: Page(path.read_text(errors="replace")) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        for target in page.loaded:
            if urllib.parse.urlsplit(target).netloc:
                yield f"{path.relative_to(folder)}: loads {target} from elsewhere"
        for target in page.targets:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            base = folder if parts.path.startswith("/") else path.parent
            place = (base / urllib.parse.unquote(parts.path).lstrip("/")).resolve() if parts.path else path
            if not place.exists():
                yield f"{path.relative_to(folder)}: {target} does not exist"
            elif place in pages and urllib.parse.unquote(parts.fragment) not in pages[place].anchors:
                yield f"{path.relative_to(folder)}: {target} has no such anchor"


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    wrong = sorted(set(faults(folder)))
    print("\n".join(wrong) or f"{sum(1 for _ in folder.rglob('*.html'))} pages, each link leads somewhere")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
