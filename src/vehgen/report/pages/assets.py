"""What all pages share: their style, their one script, and the rule that a browser run no other and fetch nothing."""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from importlib.resources import files

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup


@cache
def template_text(name: str) -> str:
    """Return a file of the folder of templates."""
    return files("vehgen.report").joinpath(f"templates/{name}").read_text(encoding="utf-8")


def page_environment() -> Environment:
    """Return what pages are rendered by: all text is escaped; `style`, `script` and `policy` are known."""
    environment = Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined)
    script = template_text("page.js")
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    environment.globals["style"] = Markup(template_text("page.css"))
    environment.globals["script"] = Markup(script)
    environment.globals["policy"] = f"default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-{digest}'"
    return environment
