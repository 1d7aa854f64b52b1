# SPDX-License-Identifier: Apache-2.0
"""Results of the bench from Python: tables of results.sqlite (docs/store.md)."""
from __future__ import annotations

import html
import os
import pathlib
import sqlite3
import statistics
from typing import Any, Dict, List, Sequence, Tuple, Union


class Results:
    """What `modelhouse bench` wrote into a folder. Tables are pandas.DataFrame if pandas is installed,
    else a dict of lists by column.

    Raises FileNotFoundError if the folder has no results.sqlite, ValueError if that file is something else."""

    def __init__(self, folder: Union[str, "os.PathLike[str]"]) -> None:
        self.folder = pathlib.Path(folder)
        file = self.folder if self.folder.suffix == ".sqlite" else self.folder / "results.sqlite"
        if not file.is_file():
            raise FileNotFoundError(f"{file}: does not exist, so there are no results")
        self._database = sqlite3.connect(file.absolute().as_uri() + "?mode=ro", uri=True)
        try:
            self._database.execute("SELECT key, name FROM runs LIMIT 1")
            self._database.execute("SELECT key, point, name, value FROM metrics LIMIT 1")
        except sqlite3.DatabaseError as error:
            raise ValueError(f"{file}: is not a results file of this version ({error})") from None

    def sql(self, query: str, parameters: Sequence[Any] = ()) -> Any:
        """The rows of any query over the tables of docs/store.md."""
        found = self._database.execute(query, parameters)
        columns = [column[0] for column in found.description]
        rows = found.fetchall()
        try:
            import pandas  # type: ignore[import]
        except ImportError:
            return {name: [row[k] for row in rows] for k, name in enumerate(columns)}
        return pandas.DataFrame(rows, columns=columns)

    def runs(self) -> Any:
        """One row per run: name, environment, system, labels, level, trial, status and more."""
        return self.sql("SELECT * FROM runs ORDER BY name")

    def metrics(self) -> Any:
        """One row per run, parameter point and metric: run, point, name, value."""
        return self.sql("SELECT runs.name AS run, environment, system, labels, level, trial, point, "
                        "metrics.name AS name, value FROM metrics JOIN runs USING (key) "
                        "ORDER BY runs.name, point, metrics.name")

    def queries(self) -> Any:
        """One row per query: what was asked, the answer and the truth."""
        return self.sql("SELECT runs.name AS run, queries.* FROM queries JOIN runs USING (key) "
                        "ORDER BY runs.name, point, query_set, frame")

    def frames(self) -> Any:
        """One row per frame of the mapping tours: true and estimated poses."""
        return self.sql("SELECT runs.name AS run, frames.* FROM frames JOIN runs USING (key) "
                        "ORDER BY runs.name, frame")

    def table(self, names: Sequence[str] = ("ate_rmse_m", "completeness", "held_out.correct",
                                            "second_tour.correct")
              ) -> List[Tuple[str, str, str, Dict[str, float]]]:
        """Rows of environment, system, labels, and the median over trials of each of these metrics."""
        cells: Dict[Tuple[str, str, str], Dict[str, List[float]]] = {}
        marks = ",".join("?" * len(names))
        for environment, system, labels, name, value in self._database.execute(
                "SELECT environment, system, labels, metrics.name, value FROM metrics "
                f"JOIN runs USING (key) WHERE point = 0 AND value IS NOT NULL AND metrics.name IN ({marks}) "
                "ORDER BY environment, system, labels, trial", list(names)):
            cells.setdefault((environment, system, labels), {}).setdefault(name, []).append(value)
        return [(*key, {name: statistics.median(values) for name, values in found.items()})
                for key, found in cells.items()]

    def _repr_html_(self) -> str:
        """What a notebook shows: a row per environment and system."""
        names = ("ate_rmse_m", "completeness", "held_out.correct", "second_tour.correct")
        head = "".join(f"<th>{html.escape(name)}</th>"
                       for name in ("environment", "system", "labels", *names))
        lines = []
        for environment, system, labels, found in self.table(names):
            cells = [environment, system, labels,
                     *(f"{found[name]:.3f}" if name in found else "-" for name in names)]
            lines.append("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>")
        return f"<table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table>"
