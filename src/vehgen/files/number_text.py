"""Numbers as people read them: thousands apart, forces in kN, alike on pages and terminals."""

from __future__ import annotations

_TERMINAL = str.maketrans({"\u202f": " ", "\u2212": "-"})


def grouped(value: float) -> str:
    """Return a number with six digits that count, thousands apart by a narrow space."""
    short = float(f"{value:.6g}")
    if short and not 1e-4 <= abs(short) < 1e10:
        return f"{short:.6g}"
    return _typeset(f"{short:,.0f}" if short.is_integer() else f"{short:,.10f}".rstrip("0"))


def five_digits(value: float) -> str:
    """Return a number with five digits that count, without an exponent below a thousand million."""
    return f"{float(f'{value:.5g}'):.9g}"


def interval_words(interval: tuple[float, float]) -> str:
    """Return an interval's ends with four digits that count, or so many that they differ."""
    told = [tuple(f"{end:.{digits}g}" for end in interval) for digits in range(4, 13)]
    return " to ".join(next((ends for ends in told if ends[0] != ends[1]), told[0]))


def kilonewtons(force: float) -> str:
    """Return a force [N] in kN, to the newton."""
    text = f"{force / 1e3:,.3f}"
    return _typeset(text.removeprefix("-") if float(text.replace(",", "")) == 0 else text)


def millimetres(length: float) -> str:
    """Return a length [m] in mm, to the hundredth."""
    text = f"{length * 1e3:,.2f}"
    return _typeset(text.removeprefix("-") if float(text.replace(",", "")) == 0 else text)


def thousands(value: float, decimals: int = 1, sign: str = "") -> str:
    """Return a number with so many decimals, thousands apart; `sign` is "+" where a positive one shows its sign."""
    return _typeset(f"{value:{sign},.{decimals}f}")


def on_terminal(text: str) -> str:
    """Return a typeset number with signs that every terminal has: a plain space and a hyphen."""
    return text.translate(_TERMINAL)


def _typeset(text: str) -> str:
    return text.replace(",", "\u202f").replace("-", "\u2212")
