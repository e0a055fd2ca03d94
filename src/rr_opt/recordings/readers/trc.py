"""TRC, Track Row Column: markers as text, tabs between the cells.

Line 1 begins with `PathFileType`. Line 2 names what line 3 holds: DataRate, NumMarkers, Units and
others. Line 4 is `Frame#`, `Time` and each marker's name above the first of its columns, line 5 has
X1, Y1, Z1, X2 and so on. Rows follow, as a rule after a blank line.
"""

from rr_opt.files.issue import refuse
from rr_opt.messages import shown
from rr_opt.recordings.readers.marker_rows import (
    MarkerData,
    count_notice,
    frames_of,
    marker_data,
    rate_in,
)
from rr_opt.recordings.readers.text import (
    Reader,
    ReadOptions,
    Text,
    cells_of,
    read_table,
    separator_of,
)
from rr_opt.recordings.warnings import Notice, notice


def sniff(text: Text, _: ReadOptions) -> bool:
    """Whether the file begins as every TRC file does."""
    return text.lines[0].lstrip().startswith("PathFileType")


def read(file: str, text: Text, _: ReadOptions) -> MarkerData:
    """The markers of a TRC file. Raises InvalidFileError."""
    if len(text.lines) < 6:
        refuse(
            text.file,
            "The file ends within its header. Expected five header lines and then rows. Export it "
            "again.",
            len(text.lines),
        )
    stated = _stated(text)
    separator = separator_of(text.lines[3])
    head = cells_of(text.lines[3], separator)
    if [cell.casefold() for cell in head[:2]] != ["frame#", "time"]:
        refuse(
            text.file,
            f"Read {shown(text.lines[3])}. Expected `Frame#`, `Time` and the markers' names. "
            "Export it again.",
            4,
        )
    names, doubts = _names(text, head, stated, separator)
    columns = ["Frame#", "Time", *(f"{axis} of {one}" for one in names for axis in "XYZ")]
    table = read_table(text, 5, len(text.lines), separator, columns)
    frame = frames_of(table, 0, file, 5)
    return marker_data(
        {"file": file, "format": "TRC", "encoding": text.encoding},
        frame=frame,
        lines=table.lines,
        t=table.values[:, 1],
        rate=rate_in(stated.get("datarate", ""), "as DataRate", file, 3),
        labels=names,
        positions=table.values[:, 2:].reshape(len(frame), len(names), 3),
        unit=stated.get("units", ""),
        unit_place=("`Units`", 3),
        doubts=[*table.doubts, *doubts, *count_notice(stated.get("numframes", ""), frame)],
    )


def _stated(text: Text) -> dict[str, str]:
    """What lines 2 and 3 say, by the name in small letters."""
    separator = separator_of(text.lines[1])
    keys = [cell.casefold() for cell in cells_of(text.lines[1], separator)]
    return dict(zip(keys, cells_of(text.lines[2], separator), strict=False))


def _names(
    text: Text, head: list[str], stated: dict[str, str], separator: str
) -> tuple[list[str], list[Notice]]:
    """The markers' names, and what is odd about them: one above each X, every third column."""
    axes = [cell for cell in cells_of(text.lines[4], separator)[2:] if cell]
    count = max(len(axes) // 3, 1)
    every_third = [head[at] if at < len(head) else "" for at in range(2, 2 + 3 * count, 3)]
    together = [cell for cell in head[2:] if cell]
    # Some programs write the names side by side, without the empty cells between them.
    names = every_third if all(every_third) or len(together) != count else together
    said = stated.get("nummarkers", "")
    if said.isdecimal() and int(said) != count:
        return names, [notice("file.markers", stated=int(said), count=count)]
    return names, []


READER = Reader("TRC", sniff, read)
