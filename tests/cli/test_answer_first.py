"""The answer is printed before files and figures are written, which take longer."""

from types import SimpleNamespace

from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay
from rr_opt.outcome import Status


def test_answer_first(capsys, tmp_path):
    printed = []

    def save(*_, **__):
        printed.append(capsys.readouterr().out)
        return [tmp_path / "page.html"]

    answer = SimpleNamespace(
        warnings=(), status=Status.OPTIMAL, summary=lambda: "0.3 m/s\n", save=save
    )
    show(answer, StepDisplay(), tmp_path, json=False)  # type: ignore[arg-type]
    assert printed == ["0.3 m/s\n"]
    assert "page.html" in capsys.readouterr().out
