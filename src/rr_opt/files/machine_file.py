"""An experiment file of a machine other than the racer: `machine: pendulum | servo | car`."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, SkipValidation

from rr_opt.files.experiment_model import ColumnOf, Uncertain
from rr_opt.files.fields import Key, optional, section, validate
from rr_opt.files.issue import Issue, has_errors, required
from rr_opt.files.source import experiment_path, fingerprint, read_document, unreadable
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import shown
from rr_opt.model.experiment import Column, Use
from rr_opt.model.machine import Machine, MachineExperiment
from rr_opt.model.parameters import Spread, Uncertainty
from rr_opt.units import Number


@dataclass(frozen=True)
class _Where:
    """Reads the source of a channel: a Column, or a constant."""

    unit: str

    def read(self, value: object) -> Column | float:
        """Raises InputError."""
        if isinstance(value, int | float) and not isinstance(value, bool):
            return float(value)
        return ColumnOf(self.unit).read(value)

    def json_schema(self) -> dict[str, Any]:
        """JSON Schema."""
        return {"anyOf": [{"type": "number"}, *ColumnOf(self.unit).json_schema()["anyOf"]]}


def _optional_section(model: Any, description: str) -> tuple[Any, Any]:
    """A section that may be absent, as all its keys may be."""
    return model, Field(default_factory=model, description=description)


def model_of(machine: Machine) -> Any:
    """The keys of a machine's experiment file."""
    parameters = {
        one.name: (
            Annotated[float, Key(Number(one.unit, one.example))],
            Field(
                default=... if one.default is None else one.default,
                description=f"{one.words[0].upper()}{one.words[1:]}, {one.unit}.",
            ),
        )
        for one in machine.parameters
    }
    known = {
        one.name: optional(
            Uncertain(one.unit, one.example),
            f"One sigma of the {one.words}, {one.unit}. "
            f"Default: {_spread_words(one.spread, one.unit)}.",
        )
        for one in machine.parameters
    }
    noise = {
        one.name: optional(
            Number(one.unit, "0.001", above=0), f"Of {one.words}, {one.unit}; else from the data."
        )
        for one in machine.channels
    }
    channels = [(one.name, one.unit, one.words) for one in machine.channels]
    where = {
        name: optional(_Where(unit), f"Where {words} is, {unit}; or its constant value.")
        for name, unit, words in (("t", "s", "the time"), *channels)
    }
    columns = section("ColumnsModel", "Columns by channel.", where)
    entry = section(
        "RecordingModel",
        "One recording.",
        {
            "file": (str, Field(description="Its file, CSV or JSON, relative to this one.")),
            "use": (Use, Field(default="fit", description="holdout: kept back to check the fit.")),
            "columns": _optional_section(columns, "Its own columns."),
        },
    )
    uncertainty = section("UncertaintyModel", "How well nominal values are known.", known)
    noises = section("NoiseModel", "One sigma of what is recorded.", noise)
    return section(
        "ExperimentModel",
        f"{machine.words[0].upper()}{machine.words[1:]}: {machine.equation}.",
        {
            "machine": (str, Field(description="What was recorded.")),
            "parameters": (
                section("ParametersModel", "Nominal values.", parameters),
                Field(description="Nominal values."),
            ),
            "uncertainty": _optional_section(uncertainty, "How well they are known."),
            "noise": _optional_section(noises, "Noise of the measurements."),
            "columns": _optional_section(columns, "Columns of the recordings."),
            "recordings": (
                Annotated[list[entry], SkipValidation],
                Field(description="The recordings.", json_schema_extra={"minItems": 1}),
            ),
        },
    ), entry


def _spread_words(spread: Spread, unit: str) -> str:
    if spread.factor or spread.relative:
        return str(spread)
    return f"{spread.sigma:g} {unit}".strip()


@dataclass(frozen=True)
class PlannedRecording:
    """An entry of `recordings`."""

    file: Path
    use: Use
    columns: Mapping[str, Column | float]


@dataclass(frozen=True)
class MachinePlan:
    """The content of an experiment file; `experiment` has no runs yet."""

    experiment: MachineExperiment
    noise: Mapping[str, float]
    recordings: tuple[PlannedRecording, ...]
    document: FileData


def machine_plan(path: str | Path, machine: Machine) -> tuple[MachinePlan | None, list[Issue]]:
    """The plan (None if an issue is an error), and all issues; recordings are not read."""
    file = experiment_path(Path(path))
    document = read_document(file)
    whole, entry = model_of(machine)
    model, issues = validate(whole, document)
    sections, found = document.entries("recordings", "a list of recordings", "{file: ...}")
    issues += found
    planned: list[PlannedRecording] = []
    for entered in sections:
        read, found = validate(entry, entered)
        issues += found
        if read is None:
            continue
        if why := unreadable(file.parent / read.file):
            issues.append(entered.error(("file",), f"Read {shown(read.file)}. {why}"))
            continue
        own = {**_given(model.columns if model else None), **_given(read.columns)}
        planned.append(PlannedRecording(file.parent / read.file, read.use, own))
    if not any(one.use == "fit" for one in planned) and not has_errors(issues):
        message = "No recording is marked to be fitted. Give at least one `use: fit`."
        issues.append(document.error(("recordings",), message))
    if model is None or has_errors(issues):
        return None, issues
    nominal = dict(model.parameters)
    uncertainty: dict[str, Uncertainty] = {}
    for one in machine.parameters:
        spread = getattr(model.uncertainty, one.name) or one.spread
        known = spread.of(nominal[one.name])
        if not known.exact:
            uncertainty[one.name] = known
    sha = fingerprint((file, *(one.file for one in planned)))
    name = file.absolute().parent.name
    experiment = MachineExperiment(machine, nominal, uncertainty, (), name, sha)
    return MachinePlan(experiment, _given(model.noise), tuple(planned), document), issues


def _given(model: Any) -> dict[str, Any]:
    return {} if model is None else {k: v for k, v in dict(model).items() if v is not None}


def read_machine_plan(path: str | Path, machine: Machine) -> MachinePlan:
    """The same. Raises InvalidFileError with all that is wrong."""
    return required(*machine_plan(path, machine))
