"""The keys of files as pydantic models, built from the model's dataclasses, and their errors.

A dataclass of `rr_opt.model` declares unit, range and description of its fields; `keys_of` makes
the pydantic model of them, and `Keys` reads a mapping of a file as such an object.
"""

import dataclasses
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field
from functools import lru_cache
from typing import Annotated, Any, TypeVar, get_args, get_type_hints

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationError,
    create_model,
)
from pydantic_core import CoreSchema, core_schema

from rr_opt.files.issue import Issue
from rr_opt.files.yaml_text import FileData
from rr_opt.messages import nearest, one_of, shown, unknown_word
from rr_opt.model.fields import Interval, Range, Reader
from rr_opt.outcome import InputError


class FileModel(BaseModel):
    """Keys of a file: none but those named, and nothing converted silently."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


@dataclass(frozen=True)
class Key:
    """Annotates a field with the reader that parses its value and describes it in JSON Schema."""

    reader: Any

    def __get_pydantic_core_schema__(self, _: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        def read(value: object) -> Any:
            try:
                return self.reader.read(value)
            except InputError as error:
                # pydantic collects ValueErrors and propagates every other error.
                raise ValueError(str(error)) from None

        return core_schema.no_info_plain_validator_function(read)

    def __get_pydantic_json_schema__(
        self, _: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        return self.reader.json_schema()


@dataclass(frozen=True, eq=False)
class Keys:
    """Annotates a dataclass of the model that is given in a file as a mapping.

    alone   the field that a value other than a mapping stands for
    schema  additions to its JSON Schema besides the keys
    """

    alone: str = ""
    schema: dict[str, Any] = field(default_factory=dict)

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        made = core_schema.no_info_after_validator_function(
            lambda model: source(**dict(model)), handler.generate_schema(keys_of(source))
        )
        if not self.alone:
            return made
        return core_schema.no_info_before_validator_function(
            lambda value: value if isinstance(value, dict | None) else {self.alone: value}, made
        )

    def __get_pydantic_json_schema__(
        self, inner: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        keys = handler(inner)
        resolved = handler.resolve_ref_schema(keys)
        resolved.update(self.schema)
        if not self.alone:
            return keys
        alone = resolved["properties"][self.alone]
        return {"anyOf": [keys, {k: v for k, v in alone.items() if k != "description"}]}


@lru_cache
def keys_of(cls: type) -> Any:
    """The keys of a file that define an object of a dataclass with declared fields."""
    hints = get_type_hints(cls)
    keys: dict[str, Any] = {}
    for one in dataclasses.fields(cls):
        if "description" in one.metadata:
            reader = one.metadata.get("reader")
            kind = Annotated[Any, Key(reader)] if reader else hints[one.name]
            if dataclasses.is_dataclass(kind):
                kind = Annotated[kind, Keys()]
            keys[one.name] = kind, described(one, reader)
    return create_model(cls.__name__, __base__=FileModel, __doc__=cls.__doc__, **keys)


def described(one: dataclasses.Field[Any], reader: Reader | None) -> Any:
    """The pydantic field of a declared field: its default and description."""
    given: dict[str, Any] = {"description": one.metadata["description"]}
    if isinstance(reader, Range):
        given["description"] += " A number fixes it, a pair [low, high] bounds it."
    if isinstance(one.default, Interval):
        low, high = one.default.low, one.default.high
        given["json_schema_extra"] = {"default": low if low == high else [low, high]}
        given["default_factory"] = lambda: one.default
    elif one.default is not MISSING:
        given["default"] = one.default
    elif one.default_factory is not MISSING:
        given["default_factory"] = one.default_factory
    return Field(**given)


def optional(reader: Any, description: str) -> tuple[Any, Any]:
    """A key of a `section` that may be absent."""
    return Annotated[Any, Key(reader)], Field(default=None, description=description)


def section(name: str, doc: str, fields: Mapping[str, Any]) -> Any:
    """The keys of a section that are known only when the program runs."""
    return create_model(name, __base__=FileModel, __doc__=doc, **fields)


Model = TypeVar("Model", bound=BaseModel)


def another_file(model: type[BaseModel], document: FileData) -> list[Issue]:
    """An issue if a whole file has none of the model's keys; its content is not quoted."""
    known, keys = list(model.model_fields), document.data
    if document.prefix or len(keys) < 2 or any(nearest(key, known) for key in keys):
        return []
    message = (
        f"Read {len(keys)} keys, and none that is known. Expected {one_of(known)}. "
        "Is this the right file?"
    )
    return [document.error((), message)]


_EXPECTED = {
    "model_type": "keys with values under it",
    "model_attributes_type": "keys with values under it",
    "string_type": "a text",
    "bool_type": "true or false",
    "list_type": "a list",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
}


def validate(model: type[Model], document: FileData) -> tuple[Model | None, list[Issue]]:
    """The document as a model, or None and every issue found."""
    if wrong := another_file(model, document):
        return None, wrong
    try:
        return model.model_validate(document.data), []
    except ValidationError as error:
        found = error.errors(include_url=False)
        return None, [document.error(one["loc"], _message(model, one)) for one in found]


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
    expected = found["msg"].removeprefix("Input should be ")
    expected = f"a number {expected}" if expected.startswith(("greater", "less")) else expected
    return f"Read {shown(value)}. Expected {expected}. Correct it."


def _model_at(model: type[BaseModel], path: tuple[str | int, ...]) -> type[BaseModel]:
    """The model of the section at a path."""
    for key in path:
        annotation = model.model_fields[str(key)].annotation
        for one in get_args(annotation) or (annotation,):
            kind = getattr(one, "__origin__", one)  # of Annotated
            if dataclasses.is_dataclass(kind):
                model = keys_of(kind)  # pyright: ignore[reportArgumentType]
            elif isinstance(kind, type) and issubclass(kind, BaseModel):
                model = kind
    return model


_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema_of(model: type[BaseModel], kind: str) -> dict[str, Any]:
    """The JSON Schema of a kind of file with these keys."""
    generated = model.model_json_schema()
    return {"$schema": _DIALECT, "title": f"rr-opt {kind} file", **_tidied(generated)}


def _tidied(node: Any) -> Any:
    """Without pydantic's titles, and without null defaults of optional keys."""
    if isinstance(node, list):
        return [_tidied(item) for item in node]
    if not isinstance(node, dict):
        return node
    return {
        key: _tidied(value)
        for key, value in node.items()
        if not (key == "default" and value is None)
        and not (key == "title" and isinstance(value, str))
    }
