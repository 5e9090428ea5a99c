"""Figures as files: the same figure gives the same bytes, and no half-written file stays behind."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from markupsafe import escape

from vehgen.errors import InputError, shown
from vehgen.files import write_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("png", "svg", "pdf")
"""What a figure can be saved as."""


def figure_svg(figure: Figure) -> str:
    """Return a figure as SVG text without date and random names, so that equal figures are equal files."""
    return _drawn(figure, "svg").decode()


def save_figure(figure: Figure, path: Path) -> None:
    """Save a figure as its suffix says.

    Raises
    ------
    InputError
        For a suffix other than those of FORMATS, or a file that cannot be written.
    """
    write_bytes(path, _drawn(figure, figure_format(path)))


def figure_format(path: Path) -> str:
    """Return what a figure of this name is saved as, one of FORMATS.

    Raises
    ------
    InputError
        For another suffix.
    """
    kind = path.suffix.removeprefix(".").lower()
    if kind not in FORMATS:
        raise InputError(f"cannot save a figure as {shown(path.name)}: its name must end in {', '.join('.' + item for item in FORMATS)}")
    return kind


def inline_svg(svg: str, name: str, title: str) -> str:
    """Return the element of an SVG file for use in a page: its ids prefixed by `name`, with a title for screen readers.

    `title` is text that is already escaped.
    """
    element = svg[svg.index("<svg") :]
    element = re.sub(r'\bid="', f'id="{name}-', element)
    element = re.sub(r'((?:xlink:)?href="#|url\(#)', rf"\g<1>{name}-", element)
    element = re.sub(r"<metadata>.*?</metadata>", "", element, count=1, flags=re.DOTALL)
    element = re.sub(r"\n *", "\n", element)
    opening = element.index(">")
    return f'{element[:opening]} role="img"><title>{title}</title>{element[opening + 1 :]}'


def with_titles(svg: str, titles: Mapping[str, str]) -> str:
    """Return an SVG file whose groups say what they are when pointed at.

    Parameters
    ----------
    titles
        Plain texts by the ids of groups.
    """
    for name, text in titles.items():
        opening = f'<g id="{name}">'
        svg = svg.replace(opening, f"{opening}<title>{escape(text)}</title>", 1)
    return svg


def _drawn(figure: Figure, kind: str) -> bytes:
    """Return a figure's file of one of FORMATS; its own `savefig` would draw it once more, in vain, to lay it out."""
    from matplotlib.backend_bases import get_registered_canvas_class

    stream, canvas, dpi = io.BytesIO(), figure.canvas, figure.dpi
    with _reproducible():
        try:
            printing = getattr(get_registered_canvas_class(kind)(figure), f"print_{kind}")
            figure.dpi = 150
            printing(stream, metadata={"svg": {"Date": None}, "pdf": {"CreationDate": None}}.get(kind))
        finally:
            figure.set_canvas(canvas)
            figure.dpi = dpi
    return stream.getvalue()


@contextmanager
def _reproducible() -> Iterator[None]:
    """Fix what matplotlib would choose at random; a sign that the font lacks is drawn as a box without a warning."""
    import matplotlib as mpl

    with mpl.rc_context({"svg.hashsalt": "vehgen", "svg.fonttype": "path"}), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from", category=UserWarning)
        yield
