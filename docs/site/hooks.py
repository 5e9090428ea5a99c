"""What mkdocs calls: adds the pages made from the code, turns links, and refuses pages that load from another host."""

from __future__ import annotations

import logging
import re
from typing import Any

from api_pages import api_pages
from commands_page import commands_page
from examples_page import examples_page
from links import DOCS, PROJECT_PAGES, ROOT, for_site
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from notebooks import notebook_files
from schema_pages import schema_files, schemas_page

log = logging.getLogger("mkdocs.hooks.vehgen")
FROM_ELSEWHERE = re.compile(r"<(?:script|img|iframe|link|source|object)\b[^>]*\b(?:src|href|data)=[\"']?(?:https?:)?//[^>]*>")


def heading_anchor(title: str, separator: str) -> str:
    """Return the anchor of a heading as code hosts make it, so that links are the same there and on the site."""
    return re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", separator)


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Set anchors, and put the pages of the API into the navigation."""
    config.mdx_configs.setdefault("toc", {})["slugify"] = heading_anchor
    reference = next(item["Reference"] for item in config.nav or () if "Reference" in item)
    entry = next(item for item in reference if "API" in item)
    entry["API"] = [{title: path} for path, (title, _) in api_pages().items()]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the project's own pages and all that is made from the code."""
    made: dict[str, str | bytes] = {"index.md": for_site((ROOT / "README.md").read_text(encoding="utf-8"), "index.md", ".")}
    made |= {name: for_site((ROOT / name).read_text(encoding="utf-8"), name, ".") for name in PROJECT_PAGES}
    made |= {path: text for path, (_, text) in api_pages().items()}
    made |= {"commands.md": commands_page(), "schemas.md": schemas_page(), "examples.md": examples_page(DOCS / "examples")}
    made |= schema_files()
    made |= {name: (DOCS / "site" / name).read_text(encoding="utf-8") for name in ("extra.css", "iframe-worker.js")}
    made |= notebook_files(config.extra["execute_notebooks"])
    for path, content in made.items():
        files.append(File.generated(config, path, content=content))
    return files


def on_page_markdown(markdown: str, page: Page, **arguments: Any) -> str:
    """Turn the links of the pages of docs/."""
    return markdown if page.file.generated_by else for_site(markdown, page.file.src_uri)


def on_post_page(output: str, page: Page, **arguments: Any) -> str:
    """Warn of what a page would load from another host when it is viewed; in a strict build that is an error."""
    for tag in FROM_ELSEWHERE.findall(output):
        if 'rel="canonical"' not in tag:
            log.warning("%s loads from another host: %s", page.file.src_uri, tag)
    return output
