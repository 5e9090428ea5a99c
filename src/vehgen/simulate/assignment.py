"""The assignment problem: every row a column of its own, at the least total cost."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def assign(cost: NDArray[np.float64]) -> NDArray[np.intp]:
    """Return the column of every row, `shape (n,)`, by shortest augmenting paths.

    R. Jonker and A. Volgenant, Computing 38, 1987, doi:10.1007/BF02278710, without its heuristics: some dozens of rows are meant, for
    which loading a library would take longer.

    Parameters
    ----------
    cost
        `shape (n, m)`, m not below n, finite.
    """
    n, m = cost.shape
    row_price, column_price = np.zeros(n), np.zeros(m)
    row_of = np.full(m, -1)
    column_of = np.full(n, -1)
    for begin in range(n):
        length, came_from, done = np.full(m, np.inf), np.full(m, -1), np.zeros(m, dtype=bool)
        row, reached, end = begin, 0.0, -1
        rows = [begin]
        while end < 0:
            through = reached + cost[row] - row_price[row] - column_price
            nearer = ~done & (through < length)
            length[nearer], came_from[nearer] = through[nearer], row
            column = int(np.where(done, np.inf, length).argmin())
            reached = float(length[column])
            done[column] = True
            row = int(row_of[column])
            if row < 0:
                end = column
            else:
                rows.append(row)
        row_price[begin] += reached
        for other in rows[1:]:
            row_price[other] += reached - length[column_of[other]]
        column_price[done] -= reached - length[done]
        while end >= 0:
            row = int(came_from[end])
            row_of[end], column_of[row], end = row, end, int(column_of[row])
            if row == begin:
                break
    return column_of
