"""What pydantic found, as issues in plain English."""

from __future__ import annotations

from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from rr_opt.files.document import Document
from rr_opt.files.issue import Issue, one_of, shown, unknown_word

Model = TypeVar("Model", bound=BaseModel)

_EXPECTED = {
    "model_type": "keys with values under it",
    "model_attributes_type": "keys with values under it",
    "string_type": "a text",
    "bool_type": "true or false",
}


def validate(model: type[Model], document: Document) -> tuple[Model | None, list[Issue]]:
    """The document as a model, or None and every issue found."""
    try:
        return model.model_validate(document.data), []
    except ValidationError as error:
        found = error.errors(include_url=False)
        return None, [document.issue("error", one["loc"], _message(model, one)) for one in found]


def _message(model: type[BaseModel], found: Any) -> str:
    path, value, kind = found["loc"], found["input"], found["type"]
    owner = _model_at(model, path[:-1])
    if kind == "extra_forbidden":
        return unknown_word(str(path[-1]), list(owner.model_fields), "key")
    if kind == "missing":
        description = owner.model_fields[path[-1]].description
        return f"This key is missing. Add it. Expected: {description}"
    if kind == "value_error":
        return str(found["ctx"]["error"])
    if kind == "literal_error":
        choices = get_args(owner.model_fields[path[-1]].annotation)
        return (
            unknown_word(value, choices, "word")
            if isinstance(value, str)
            else (f"Read {shown(value)}. Expected {one_of(choices)}.")
        )
    if kind in _EXPECTED:
        return f"Read {shown(value)}. Expected {_EXPECTED[kind]}. Write it, or delete the key."
    return f"Read {shown(value)}. {found['msg']}."


def _model_at(model: type[BaseModel], path: tuple[str | int, ...]) -> type[BaseModel]:
    for key in path:
        annotation = model.model_fields[str(key)].annotation
        choices = get_args(annotation) or (annotation,)
        model = next(c for c in choices if isinstance(c, type) and issubclass(c, BaseModel))
    return model
