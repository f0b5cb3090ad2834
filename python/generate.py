"""Writes the builders of the package from the JSON Schema of a config: python generate.py [--check].

Each member of a family (a lattice, a term, a state, …) becomes a function whose arguments are the member's keys. So none can be
missing, and names, meanings and defaults are those of the program. A test sees that what is committed is what this writes.
"""

from __future__ import annotations

import importlib.util
import json
import keyword
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

FOLDER = Path(*(importlib.util.find_spec("spinneb") or sys.exit("spinneb is not installed")).submodule_search_locations or [])
WIDTH = 110

#: module, family of the schema, class of what its functions make, first line of the module
FAMILIES = [
    ("lattices", "LatticeSpec", "Lattice", "Lattices: where the spins are."),
    ("terms", "TermSpec", "Energy", "Energy terms. Every bond counts once; the energies of terms add up."),
    ("states", "StateSpec", "State", "Spin states, for the ends of a path and on its way."),
    ("guesses", "GuessSpec", "Guess", "First guesses of a path."),
    ("optimisers", "OptimiserSpec", "Optimiser", "Methods that move a path to its minimum."),
    ("shapes", "Shape", "Shape", "Shapes of lattices and selections of sites; ``a & b``, ``a | b`` and ``~a`` combine them."),
]
#: What Python leaves out though a config may not.
DEFAULTS = {("anisotropy", "axis"): '"z"'}
#: Not for people: the hash of a file that a result keeps.
HIDDEN = {"sha256"}
ALIASES = {
    "Direction": "Direction",
    "Extent": "Extent",
    "Place": "Sequence[Extent]",
    "Selection": "Selection",
    "StateSpec": "State",
    "Shape": "Shape",
}


def resolved(schema: dict[str, Any], part: Any) -> dict[str, Any]:
    """What a reference stands for."""
    if isinstance(part, dict) and "$ref" in part:
        found: dict[str, Any] = schema["definitions"][part["$ref"].rsplit("/", 1)[1]]
        return found
    return part if isinstance(part, dict) else {}


def hint(schema: dict[str, Any], part: Any) -> str:
    """The type of an argument."""
    if not isinstance(part, dict):
        return "Any"
    if "$ref" in part:
        name = part["$ref"].rsplit("/", 1)[1]
        if name in ALIASES:
            return ALIASES[name]
        if name.startswith(("Profile_of_", "ByShell_of_")):
            return "Values"
        return hint(schema, resolved(schema, part))
    if "const" in part:
        return f"Literal[{json.dumps(part['const'])}]"
    if "enum" in part:
        return "Literal[" + ", ".join(json.dumps(value) for value in part["enum"]) + "]"
    for key in ("allOf", "anyOf", "oneOf"):
        if key in part:
            forms = dict.fromkeys(hint(schema, form) for form in part[key])
            return " | ".join(form for form in forms if form)
    if part.get("items") == {"type": "number"} and part.get("minItems") == part.get("maxItems") == 3:
        return "Direction"
    kinds = part.get("type", "any")
    kinds = [kinds] if isinstance(kinds, str) else kinds
    names = {"number": "float", "integer": "int", "boolean": "bool", "string": "str", "null": "None"}

    def one(kind: str) -> str:
        if kind == "array":
            return f"Sequence[{hint(schema, part.get('items'))}]"
        return names.get(kind, "Mapping[str, Any]" if kind == "object" else "Any")

    return " | ".join(one(kind) for kind in kinds if kind != "null")


def given(schema: dict[str, Any], part: Any, arg: str) -> str:
    """The expression for an argument as it is passed on."""
    if takes_direction(schema, part):
        words = re.findall(r'Literal\[(.*?)\]', hint(schema, part))
        return f'as_direction({", ".join([arg, quoted(arg), *words])})'
    if hint(schema, part) == "int":
        least = resolved(schema, part).get("minimum")
        return f"as_count({arg}, {quoted(arg)}" + (")" if least is None else f", {int(least)})")
    makers = {"Sequence[Values]": f"as_list({arg})", "Sequence[State]": f'as_states({arg}, "{arg}")'}
    return makers.get(hint(schema, part), arg)


def quoted(arg: str) -> str:
    """The name of an argument as messages tell it."""
    return f'"{arg}"'


def takes_direction(schema: dict[str, Any], part: Any) -> bool:
    """Whether "z" may stand for [0, 0, 1]."""
    return "Direction" in hint(schema, part)


def annotation(schema: dict[str, Any], part: Any) -> str:
    """The type of an argument; of a list of quantities one alone may be given, and states may be vectors."""
    found = hint(schema, part)
    return {"Sequence[Values]": "Values", "Sequence[State]": "Sequence[AnyState]"}.get(found, found)


def argument(name: str) -> str:
    return f"{name}_" if keyword.iskeyword(name) or name in ("all", "any") else name


def sentence(text: str) -> str:
    text = text.replace("\\", "\\\\").strip()
    text = text[:1].upper() + text[1:]
    return text if text.endswith((".", "!", "?")) else text + "."


def meaning(schema: dict[str, Any], part: dict[str, Any]) -> str:
    said = part.get("description") or resolved(schema, (part.get("allOf") or [part])[0]).get("description") or ""
    default = part.get("default")
    shown = "" if default in (None, [], {}) else f" Default: {json.dumps(default, ensure_ascii=False)}."
    return sentence(said) + shown if said else shown.strip()


def wrapped(text: str, indent: str) -> str:
    lines = textwrap.wrap(" ".join(text.split()), WIDTH - len(indent), break_long_words=False, break_on_hyphens=False)
    return "\n".join(indent + line for line in lines)


def function(schema: dict[str, Any], choice: dict[str, Any], made: str) -> str:
    """The builder of a member."""
    ((name, part),) = choice["properties"].items()
    own = resolved(schema, part)
    keys = {k: v for k, v in own.get("properties", {}).items() if k not in HIDDEN}
    required = [k for k in own.get("required", []) if k in keys]
    others = [k for k in keys if k not in required]
    signature, entries, told = [], [], []
    if own.get("type") == "array" or "oneOf" in own or name == "not":
        # the member is its value
        word = "shape" if name == "not" else "shapes" if name in ("all", "any") else "values"
        kind = {"shape": "Shape", "shapes": "Shape"}.get(word, "ArrayLike")
        signature.append(f"*{word}: {kind}" if word == "shapes" else f"{word}: {kind}")
        value = f"list({word})" if word == "shapes" else word
    else:
        for key in required:
            arg, default = argument(key), DEFAULTS.get((name, key))
            if key == "cells":
                signature.insert(0, "*cells: int | Sequence[int]")
                entries.insert(0, '"cells": as_cells(cells)')
            else:
                signature.append(f"{arg}: {annotation(schema, keys[key])}" + (f" = {default}" if default else ""))
                entries.append(f'"{key}": {given(schema, keys[key], arg)}')
            told.append((arg, meaning(schema, keys[key])))
        if others and not any(s.startswith("*") for s in signature):
            signature.append("*")
        for key in others:
            arg = argument(key)
            signature.append(f"{arg}: {annotation(schema, keys[key])} | None = None")
            entries.append(f'"{key}": {given(schema, keys[key], arg)}')
            told.append((arg, meaning(schema, keys[key])))
        if isinstance(own.get("additionalProperties"), dict):
            signature = [s for s in signature if s != "*"] + [f"**regions: {hint(schema, own['additionalProperties'])}"]
            entries.append("**regions")
            told.append(("regions", "By name of the region."))
        value = "{" + ", ".join(entries) + "}"
    example = next(iter(choice.get("examples", [])), None)
    lines = [f"def {argument(name)}(" + "".join(f"\n    {s}," for s in signature) + ("\n" if signature else "") + f") -> {made}:"]
    lines.append(wrapped('"""' + sentence(choice.get("description", "")), "    "))
    if told:
        lines += ["", "    Parameters", "    ----------"]
        for arg, words in told:
            lines.append(f"    {arg}")
            if words:
                lines.append(wrapped(words, "        "))
    if example is not None:
        lines += ["", "    In a config: ``" + json.dumps(example, ensure_ascii=False) + "``"]
    lines.append('    """')
    lines.append(f'    return {made}("{name}", {value})')
    return "\n".join(lines)


def module(schema: dict[str, Any], family: str, made: str, title: str) -> str:
    choices = schema["definitions"][family]["oneOf"]
    functions = [function(schema, choice, made) for choice in choices]
    names = [argument(next(iter(choice["properties"]))) for choice in choices]
    body = "\n\n\n".join(functions)
    words = {"Literal", "Sequence", "Mapping", "Any", "ArrayLike", "Direction", "Extent", "Selection", "Shape", "State", "Values"}
    used = sorted(word for word in words | {made, "AnyState", "as_cells", "as_count", "as_direction", "as_list", "as_states"} if re.search(rf"\b{word}\b", body))
    own = [w for w in used if w not in ("Literal", "Sequence", "Mapping", "Any", "ArrayLike")]
    typing = [w for w in ("Any", "Literal") if w in used]
    abc = [w for w in ("Mapping", "Sequence") if w in used]
    parts = [f'"""{title}', "", "Written by generate.py from the schema of a config; change that, not this.", '"""', ""]
    parts += ["from __future__ import annotations", ""]
    imports = [f"from collections.abc import {', '.join(abc)}"] if abc else []
    imports += [f"from typing import {', '.join(typing)}"] if typing else []
    parts += imports + ([""] if imports else [])
    if "ArrayLike" in used:
        parts += ["from numpy.typing import ArrayLike", ""]
    parts += [f"from ._values import {', '.join(own)}", "", "__all__ = ["]
    parts += [f'    "{name}",' for name in names] + ["]", "", "", body, ""]
    return "\n".join(parts)


def config_schema() -> dict[str, Any]:
    """The schema, of the native module by itself: the package around it may lack what is written here."""
    (file,) = (path for path in FOLDER.glob("_core*") if path.suffix in (".so", ".pyd"))
    spec = importlib.util.spec_from_file_location("_core", file)
    assert spec is not None and spec.loader is not None
    core = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(core)
    found: dict[str, Any] = json.loads(core.config_schema())
    return found


def main() -> int:
    schema = config_schema()
    stale = []
    for name, family, made, title in FAMILIES:
        path, text = FOLDER / f"{name}.py", module(schema, family, made, title)
        if "--check" in sys.argv:
            stale += [path.name] if not path.exists() or path.read_text() != text else []
        else:
            path.write_text(text)
    if stale:
        print(f"not as the schema has it: {', '.join(stale)}; run python generate.py", file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
