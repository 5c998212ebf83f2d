"""Settings as YAML 1.2 files: read strictly against a pydantic model, written whole.

Refused: duplicate and unknown keys, NaN and infinity, aliases, merge keys, tags that make objects, several documents, deep nesting, and
files that are large or not regular. All that a model finds wrong is said at once, each with its line.
"""

from __future__ import annotations

import codecs
import io
import json
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, ValidationError
from ruamel.yaml import YAML
from ruamel.yaml.error import MantissaNoDotYAML1_1Warning, MarkedYAMLError, YAMLError
from ruamel.yaml.events import AliasEvent, CollectionEndEvent, CollectionStartEvent, DocumentStartEvent, ScalarEvent
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from benchlab.errors import InputError
from benchlab.io.files import cannot_write, check_regular_file, written_whole
from benchlab.io.yaml_commas import Comma, Place, comma_told, find_commas, with_points
from benchlab.io.yaml_words import Told, name_of, told_of

MAX_BYTES = 1_000_000
MAX_DEPTH = 32
MAX_ERRORS = 12
"""Limits: bytes in a file, nesting of its lists and mappings, errors that are spelt out."""

Model = TypeVar("Model", bound=BaseModel)


class Document(BaseModel):
    """What the models of files inherit: strict types, no unknown keys, no NaN, frozen."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)


def read_document(path: Path, model: type[Model]) -> Model:
    """The file as an instance of `model`; YAML lists become the model's tuples, whole numbers its floats.

    Raises UsageError for a missing file, InputError naming line, key, value and remedy of everything that is wrong.
    """
    return read_document_with_lines(path, model)[0]


def read_document_with_lines(path: Path, model: type[Model]) -> tuple[Model, dict[Place, int]]:
    """The same, and the line of each key and item by its place, as ("segments", 2, "ramp")."""
    lines: dict[Place, int] = {}
    data, told = _parsed(path, read_text(path), lines)
    found = None
    try:
        found = model.model_validate_json(json.dumps(data), strict=True)
    except ValidationError as error:
        told += told_of(error, lines, model)
    if found is None or told:
        raise refused(path, sorted(told, key=lambda one: int(one[0].removeprefix("line "))))
    return found, lines


def write_document(path: Path, document: dict[str, Any], header_comment: str = "") -> None:
    """Write plain data (dict, list, str, bool, int, float, None) as YAML 1.2, the comment's lines before it.

    The file is there whole or not at all. Raises ValueError for data that would not read back the same, InputError
    where the disk refuses.
    """
    yaml: Any = YAML(typ="safe", pure=True)
    yaml.default_flow_style = False
    yaml.allow_unicode = True
    yaml.sort_base_mapping_type_on_output = False
    yaml.width = 100
    body = io.StringIO()
    yaml.dump(document, body)
    if _loaded(body.getvalue()) != document:
        raise ValueError("this document does not read back from YAML as it was written")
    comment = "".join(f"# {line}".rstrip() + "\n" for line in header_comment.splitlines())
    with written_whole(path) as temporary:
        try:
            temporary.write_text(comment + body.getvalue(), encoding="utf-8", newline="\n")
        except OSError as error:
            raise cannot_write(error, path) from error


def read_text(path: Path) -> str:
    """The text of a small file in UTF-8 or UTF-16. Raises UsageError for a missing file, InputError for one that is none."""
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        raise InputError(f"{size / 1e6:.1f} MB, more than the limit of {MAX_BYTES / 1e6:g} MB for YAML", file=path)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise InputError(f"could not be read: {error.strerror or error}", file=path) from error
    wide = raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return raw.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("not readable as UTF-8 text", file=path, hint="save it as UTF-8") from None


def _loaded(text: str) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MantissaNoDotYAML1_1Warning)
        return YAML(typ="safe", pure=True).load(text)


def _parsed(path: Path, text: str, lines: dict[Place, int]) -> tuple[Any, list[Told]]:
    """The data of a document, and what is wrong with commas in it; `lines` is filled with the line of every key and item."""
    try:
        _check_events(path, text)
        node = YAML(typ="safe", pure=True).compose(text)
        if node is None:
            raise InputError("holds no data", file=path, hint="write `key: value` lines")
        if commas := list(find_commas(node, text)):
            text = with_points(text, commas)
            node = YAML(typ="safe", pure=True).compose(text)
        _note_lines(path, node, (), lines)
        data = _loaded(text)
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        what = str(error.problem or error.context).split("\n", maxsplit=1)[0]
        raise InputError(
            f"not YAML: {what}",
            file=path,
            where=f"line {mark.line + 1}" if mark else None,
            hint="indent with blanks, write each key once as `key: value`, and quote text with special signs",
        ) from None
    except (YAMLError, ValueError, OverflowError, LookupError) as error:  # an empty `!!int` has no first letter
        raise InputError(f"not YAML: {str(error).splitlines()[0]}", file=path) from None
    _check_plain(path, data, (), lines)
    return data, [_of_comma(comma) for comma in commas]


def _of_comma(comma: Comma) -> Told:
    what, remedy = comma_told(comma.written) or (f"{comma.written} has a comma", "write a point")
    return f"line {comma.line}", f"{name_of(comma.place)}: {what}", remedy


def _check_events(path: Path, text: str) -> None:
    depth = 0
    for event in YAML(typ="safe", pure=True).parse(io.StringIO(text)):
        where = f"line {event.start_mark.line + 1}"
        if isinstance(event, AliasEvent) or getattr(event, "anchor", None):
            raise InputError("anchors and aliases (& and *) are not read", file=path, where=where, hint="write it out")
        if isinstance(event, DocumentStartEvent) and event.version not in (None, (1, 2)):
            raise InputError("is not YAML 1.2", file=path, where=where, hint="remove the %YAML line")
        if isinstance(event, ScalarEvent) and event.value == "<<" and not event.style:
            raise InputError("merge keys (<<) are not read", file=path, where=where, hint="write it out")
        depth += isinstance(event, CollectionStartEvent) - isinstance(event, CollectionEndEvent)
        if depth > MAX_DEPTH:
            raise InputError(f"nested deeper than {MAX_DEPTH} levels", file=path, where=where)


def _note_lines(path: Path, node: Node, place: Place, lines: dict[Place, int]) -> None:
    lines.setdefault(place, node.start_mark.line + 1)
    if isinstance(node, MappingNode):
        for key, value in node.value:
            line = key.start_mark.line + 1
            if not isinstance(key, ScalarNode) or not str(key.tag).endswith(":str"):
                shown = key.value if isinstance(key, ScalarNode) else "a list or mapping"
                raise InputError(f"key {shown!r} is not text", file=path, where=f"line {line}", hint="quote it")
            if (first := lines.get((*place, key.value))) is not None:
                what = f"duplicate key {name_of((*place, key.value))}, already on line {first}"
                raise InputError(what, file=path, where=f"line {line}", hint="remove or rename one of them")
            lines[(*place, key.value)] = line
            _note_lines(path, value, (*place, key.value), lines)
    elif isinstance(node, SequenceNode):
        for index, item in enumerate(node.value):
            _note_lines(path, item, (*place, index), lines)


def _check_plain(path: Path, value: Any, place: Place, lines: dict[Place, int]) -> None:
    where = f"line {lines.get(place, 1)}"
    if isinstance(value, dict):
        for key, item in value.items():
            _check_plain(path, item, (*place, key), lines)
    elif isinstance(value, list):
        for index, item in enumerate(value):
            _check_plain(path, item, (*place, index), lines)
    elif value is not None and not isinstance(value, (str, bool, int, float)):
        what = f"{name_of(place)} reads as a {type(value).__name__}, {value}"
        raise InputError(what, file=path, where=where, hint="quote it if text is meant")


def refused(path: Path, found: Sequence[Told]) -> InputError:
    """One error of all that is wrong: each its line (empty: of the whole file), what, and the remedy."""
    if len(found) == 1:
        line, what, remedy = found[0]
        return InputError(what, file=path, where=line, hint=remedy)
    shown = [f"{line}{': ' * bool(line)}{what} ({remedy})" for line, what, remedy in found[:MAX_ERRORS]]
    if len(found) > MAX_ERRORS:
        shown.append(f"and {len(found) - MAX_ERRORS} more")
    return InputError(f"{len(found)} things are wrong: " + "; ".join(shown), file=path, hint=None)
