"""Tables of named columns: from data frames to plans, from flights and reports to data frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pyarrow

Column = NDArray[Any]


class Table(dict[str, Column]):
    """Columns by name, all of one length. `pandas.DataFrame(table)` and `polars.DataFrame(table)` take it as it is.

    With pyarrow installed it is also an Arrow stream, which shares the memory of its numbers.

    >>> table = Table({"t_s": np.array([0.0, 1.0]), "x_m": np.array([5.0, 6.0])})
    >>> table
    <Table of 2 rows: t_s, x_m>
    >>> float(table["x_m"][1])
    6.0
    """

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self.values()), ()))

    def to_arrow(self) -> pyarrow.Table:
        """The table in Arrow's form; numbers are not copied. Needs pyarrow."""
        arrow = _pyarrow("to_arrow")
        return arrow.table({name: arrow.array(column) for name, column in self.items()})

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self.to_arrow().__arrow_c_stream__(requested_schema)

    def __repr__(self) -> str:
        return f"<Table of {self.rows} rows: {', '.join(self)}>"


def columns_of(frame: Any) -> dict[str, Column]:
    """The columns of a mapping, a data frame of pandas or polars, or anything with an Arrow stream.

    NumPy arrays, and columns of numbers without gaps of pandas and polars, are not copied.
    """
    if isinstance(frame, Mapping):
        return {str(name): np.asarray(values) for name, values in frame.items()}
    if hasattr(frame, "columns") and hasattr(frame, "__getitem__") and not hasattr(frame, "column_names"):
        return {str(name): np.asarray(frame[name]) for name in frame.columns}
    if hasattr(frame, "__arrow_c_stream__"):
        table = _pyarrow("a plan from an Arrow stream").table(frame)
        return {name: table.column(name).to_numpy() for name in table.column_names}
    expected = "a dict of columns, a data frame or an Arrow stream"
    raise TypeError(f"plan: found {type(frame).__name__}, expected {expected}")


def _pyarrow(what: str) -> Any:
    try:
        import pyarrow
    except ImportError as error:
        raise ImportError(f"{what} needs pyarrow: pip install 'uav-harness[arrow]'") from error
    return pyarrow
