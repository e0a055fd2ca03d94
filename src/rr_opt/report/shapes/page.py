"""report.html of a comparison of shapes: one file that opens anywhere, the outcome first."""

from __future__ import annotations

from html import escape

from rr_opt import __version__
from rr_opt.outcome import Status
from rr_opt.report.html import Badge, Cell, card, document, figure, table
from rr_opt.report.quantities import direction_text, number, with_unit
from rr_opt.report.shapes.compared import Compared, gain_of, held_by, label, speed_of

_CAPTION = (
    "One period of the best gait of each family, under the same limits. Dashed grey: the sine. "
    "Dashed red: the limit on the rate."
)


def page(compared: Compared, drawn: str) -> str:
    """The whole page; drawn: the figure as SVG text."""
    good = compared.status is Status.OPTIMAL
    title = _verdict(compared)
    body = [
        f'<header class="{"" if good else "bad"}"><p class="kind">Roller Racer · '
        f"{escape(compared.name)} · shapes of gait</p><h1>{escape(title)}</h1>"
        f'<p class="lead">{escape(compared.message)}</p></header>',
        figure(drawn, "The best gait of each family", _CAPTION) if drawn else "",
        card("Families", _families(compared)),
        card("Checks", _checks(compared)),
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(compared.sha256)}</code></footer>",
    ]
    return document(f"{compared.name}: {title}", body)


def _verdict(compared: Compared) -> str:
    solved = compared.solved
    if len(solved) < 2:
        return "Shapes of gait"
    gain = gain_of(compared, solved[-1]) or 0.0
    return f"A free gait is {100 * gain:.0f} % faster than the best sine"


def _families(compared: Compared) -> str:
    head = ["Shape", "Speed", "Over the sine", "Amplitude", "Period", "J20/J10", "Held by"]
    rows: list[list[Cell]] = []
    for answer in compared.answers:
        best = answer.optimum.best
        if best is None:
            status = Badge(answer.status.value.replace("_", " "), "no")
            rows.append([label(answer), status, *["–"] * 5])
            continue
        speed, gain = speed_of(answer), gain_of(compared, answer)
        rows.append(
            [
                label(answer),
                f"{1e3 * abs(speed):.1f} mm/s {direction_text(speed)}",
                f"{100 * gain:+.1f} %" if gain else "–",
                with_unit(best.gait.amplitude, "rad"),
                with_unit(best.gait.period, "s"),
                number(answer.optimum.ratio or 0.0),
                held_by(answer).replace(" ", ", ") or "nothing",
            ]
        )
    return table(head, rows)


def _checks(compared: Compared) -> str:
    items = "".join(
        f'<li class="{"" if check.passed else "bad"}">'
        f"{escape(label(answer))}: {escape(check.sentence)}</li>"
        for answer in compared.answers
        for check in answer.checks
    )
    return f'<ul class="checks">{items}</ul>' if items else ""
