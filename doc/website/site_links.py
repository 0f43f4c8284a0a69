# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks at the HTML of the site: each link and each anchor is there, and nothing is fetched from elsewhere."""
from html.parser import HTMLParser
import re
from urllib.parse import unquote


class Page(HTMLParser):
    FETCHED = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src"}

    def __init__(self, path):
        super().__init__()
        self.links, self.fetched, self.names = [], [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.names |= {given[key] for key in ("id", "name") if given.get(key)}
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if given.get(self.FETCHED.get(tag)):
            self.fetched.append(given[self.FETCHED[tag]])


def fault_of(page, link, folder, names):
    path, _, anchor = link.partition("#")
    target = (page.parent / unquote(path.partition("?")[0])).resolve() if path else page
    if not target.is_file():
        return "there is no such file"
    if folder not in target.parents:
        return "leads out of the site"
    if anchor and target in names and unquote(anchor) not in names[target]:
        return "there is no such place"
    return None


def faults_of(folder):
    """Sentences; none where all is right."""
    folder = folder.resolve()
    read = {path: Page(path) for path in sorted(folder.rglob("*.html"))}
    names = {path: page.names for path, page in read.items()}
    faults = []
    for path, page in read.items():
        for link in sorted(set(page.links + page.fetched)):
            external = re.match(r"(https?:)?//", link)
            if external and link in page.fetched:
                faults.append(f"{path.relative_to(folder)}: {link}: is fetched from the net")
            elif not external and not re.match(r"(mailto|data):", link):
                wrong = fault_of(path, link, folder, names)
                faults += [f"{path.relative_to(folder)}: {link}: {wrong}"] if wrong else []
    for style in folder.rglob("*.css"):
        faults += [f"{style.relative_to(folder)}: {link}: is fetched from the net" for link in
                   re.findall(r"url\([\"']?((?:https?:)?//[^)\"']+)", style.read_text(encoding="utf-8"))]
    if len(read) < 50:
        faults.append(f"only {len(read)} pages were made")
    return faults
