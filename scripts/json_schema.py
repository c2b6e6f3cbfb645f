"""Holds values against a JSON Schema: as much of draft 2020-12 as `asdic settings --schema` makes.

    for place, fault in faults(tomllib.load(file), schema): ...
A keyword that this does not know is an error: nothing passes because it was not looked at.
"""
import re

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool}
WORDS = {"$schema", "title", "description", "default"}  # that check nothing


def is_a(value, kind):
    if kind in ("number", "integer"):
        return isinstance(value, int if kind == "integer" else (int, float)) and not isinstance(value, bool)
    return isinstance(value, TYPES[kind])


def holds(value, schema):
    return not any(True for _ in faults(value, schema))


def faults(value, schema, place=""):
    """Where a value is not what its schema says, and why: pairs of texts."""
    if isinstance(schema, bool):
        if not schema:
            yield place, "is not allowed here"
        return
    for word, rule in schema.items():
        if word == "type":
            if not is_a(value, rule):
                yield place, f"is no {rule}"
                return
        elif word == "enum":
            if value not in rule:
                yield place, f"is none of {rule}"
        elif word == "pattern":
            if isinstance(value, str) and not re.search(rule, value):
                yield place, f"is not like {rule}"
        elif word in ("minimum", "exclusiveMinimum", "maximum"):
            if is_a(value, "number"):
                good = {"minimum": value >= rule, "exclusiveMinimum": value > rule, "maximum": value <= rule}[word]
                if not good:
                    yield place, f"is {value}: {word} {rule}"
        elif word == "minItems":
            if isinstance(value, list) and len(value) < rule:
                yield place, f"has fewer than {rule} items"
        elif word == "maxItems":
            if isinstance(value, list) and len(value) > rule:
                yield place, f"has more than {rule} items"
        elif word == "maxProperties":
            if isinstance(value, dict) and len(value) > rule:
                yield place, f"has more than {rule} keys"
        elif word == "items":
            for i, item in enumerate(value if isinstance(value, list) else ()):
                yield from faults(item, rule, f"{place}[{i}]")
        elif word == "properties":
            for key, inner in rule.items() if isinstance(value, dict) else ():
                if key in value:
                    yield from faults(value[key], inner, f"{place}.{key}".lstrip("."))
        elif word == "additionalProperties":
            assert rule is False
            for key in value if isinstance(value, dict) else ():
                if key not in schema["properties"]:
                    yield f"{place}.{key}".lstrip("."), "is no setting"
        elif word == "required":
            for key in rule if isinstance(value, dict) else ():
                if key not in value:
                    yield f"{place}.{key}".lstrip("."), "is required"
        elif word == "dependentSchemas":
            for key, inner in rule.items() if isinstance(value, dict) else ():
                if key in value and not holds(value, inner):
                    yield f"{place}.{key}".lstrip("."), "is not there with what else is said"
        elif word == "allOf":
            for inner in rule:
                yield from faults(value, inner, place)
        elif word == "anyOf":
            if not any(holds(value, inner) for inner in rule):
                if len(rule) == 1:
                    yield from faults(value, rule[0], place)
                else:
                    yield place, "is none of what it may be"
        elif word == "not":
            if holds(value, rule):
                yield place, "is what it must not be"
        elif word == "if":
            chosen = schema.get("then" if holds(value, rule) else "else", True)
            yield from faults(value, chosen, place)
        elif word not in WORDS | {"then", "else"}:
            raise ValueError(f"json_schema.py does not know {word}")
