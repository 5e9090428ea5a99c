"""Links of the repository's pages, turned into those of the site."""

from __future__ import annotations

import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PROJECT_PAGES = ("CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
"""Pages of the project's top level that the site has, too; its README is the site's first page."""
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)#:\s]+)(#[^)]*)?\)")
IMAGE_OF_DOCS = re.compile(r"(!\[[^\]]*\]\()docs/")


def for_site(markdown: str, page: str, folder: str = "docs") -> str:
    """Return a page with links to where things stand on the site; what is not on the site is named instead of linked.

    Parameters
    ----------
    markdown
        The page as it stands in the repository.
    page
        Where it stands on the site, e.g. `theory.md`.
    folder
        The folder of the repository in which its links begin.
    """

    def turned(match: re.Match[str]) -> str:
        text, target, anchor = match[1], match[2], match[3] or ""
        path = posixpath.normpath(posixpath.join(folder, target))
        found = _on_site(path)
        if found is None:
            return f"`{path}`" if text.strip("`") in path else f"{text} (`{path}`)"
        place, own_anchor = found
        return f"[{text}]({posixpath.relpath(place, posixpath.dirname(page) or '.')}{own_anchor or anchor})"

    return LINK.sub(turned, IMAGE_OF_DOCS.sub(r"\1", markdown) if folder == "." else markdown)


def _on_site(path: str) -> tuple[str, str] | None:
    """Return the page or file of the site for a path of the repository, and an anchor in it; None for what the site leaves out."""
    if path == "README.md":
        return "index.md", ""
    if path in PROJECT_PAGES:
        return path, ""
    if not path.startswith("docs/"):
        return None
    inside = path.removeprefix("docs/")
    if inside.startswith(("generate", "site")):
        return None
    if inside.startswith("notebooks/"):
        return inside.replace(".py", ".md"), ""
    if (ROOT / path).is_dir():
        return "examples.md", "" if inside == "examples" else f"#{inside.rpartition('/')[2]}"
    return inside, ""
