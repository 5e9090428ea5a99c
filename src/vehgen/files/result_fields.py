"""Types of a result's fields: how arrays, undefined numbers and pairs of names are written in JSON and read from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class _Numbers:
    """How an array of `ndim` dimensions is written: nested lists, null for what is not finite."""

    ndim: int
    flags: bool = False

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema as schema

        item: Any = schema.bool_schema() if self.flags else schema.nullable_schema(schema.float_schema())
        for _ in range(self.ndim):
            item = schema.list_schema(item)
        return schema.no_info_after_validator_function(
            self._array, item, serialization=schema.plain_serializer_function_ser_schema(self._lists)
        )

    def _array(self, lists: Any) -> NDArray[Any]:
        return np.array(lists, dtype=np.bool_ if self.flags else np.float64)

    def _lists(self, array: NDArray[Any]) -> Any:
        if self.flags:
            return array.tolist()
        whole = array.astype(object)
        whole[~np.isfinite(array)] = None
        return whole.tolist()


class _Undefined:
    """How a float that may be undefined is written: null for what is not finite."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema as schema

        return schema.no_info_after_validator_function(
            lambda value: float("nan") if value is None else value,
            schema.nullable_schema(schema.float_schema()),
            serialization=schema.plain_serializer_function_ser_schema(lambda value: float(value) if np.isfinite(value) else None),
        )


class _Pairs:
    """How numbers by pairs of names are written: a list of [first, second, number]."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema as schema

        row = schema.tuple_schema([schema.str_schema(), schema.str_schema(), schema.float_schema()])
        return schema.no_info_after_validator_function(
            lambda rows: {(first, second): value for first, second, value in rows},
            schema.list_schema(row),
            serialization=schema.plain_serializer_function_ser_schema(lambda pairs: [[*key, value] for key, value in pairs.items()]),
        )


class _InMemory:
    """A field that is not written: models and kernels behind a result, None in one that was read."""

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema as schema

        return schema.none_schema(serialization=schema.plain_serializer_function_ser_schema(lambda value: None))


IN_MEMORY = _InMemory()
Array1D = Annotated[NDArray[np.float64], _Numbers(1)]
Array2D = Annotated[NDArray[np.float64], _Numbers(2)]
Array3D = Annotated[NDArray[np.float64], _Numbers(3)]
Flags = Annotated[NDArray[np.bool_], _Numbers(1, flags=True)]
Number = Annotated[float, _Undefined()]
PairKeys = Annotated[dict[tuple[str, str], float], _Pairs()]


def rounded(values: NDArray[np.float64], digits: int = 5) -> NDArray[np.float64]:
    """Return values with so many digits that count, as figures need them: a third of the length in files."""
    return np.array([float(f"{value:.{digits}g}") for value in np.ravel(values)], dtype=np.float64).reshape(np.shape(values))
