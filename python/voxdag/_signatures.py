"""Signatures of compiled functions that help() shows, and answers to unknown arguments."""
import difflib
import functools
import inspect
import re


class _Text(str):
    """A default value as its text."""
    __repr__ = str.__str__


def _signature(head):
    """Returns the Signature in pybind11's "f(self: Dag, *, steps: int = 1) -> Dag"."""
    arguments = head[head.index("(") + 1:head.rindex(")")]
    depth, parts = 0, [""]
    for letter in arguments:
        depth += (letter in "[(") - (letter in "])")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    kind, parameters = inspect.Parameter.POSITIONAL_OR_KEYWORD, []
    for part in map(str.strip, parts):
        if part == "*":
            kind = inspect.Parameter.KEYWORD_ONLY
        elif part:
            name, default = re.match(r"(\w+)(?:.*? = (.*))?", part).groups()
            parameters.append(inspect.Parameter(
                name, kind, default=inspect.Parameter.empty if default is None else _Text(default)))
    return inspect.Signature(parameters)


def documented(function):
    """Returns the compiled function with a signature that help() shows. Answers unknown keywords with
    the nearest one that it has."""
    head, _, text = (function.__doc__ or "").partition("\n")
    signature = _signature(head)
    known = [name for name in signature.parameters if name != "self"]

    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError:
            for name in kwargs:
                if known and name not in known:
                    near = difflib.get_close_matches(name, known, 1, 0.5)
                    hint = f": did you mean '{near[0]}'?" if near else f"; it has {', '.join(known)}"
                    raise TypeError(f"{function.__name__}() has no argument '{name}'{hint}") from None
            raise
    call.__doc__ = text.strip()
    call.__signature__ = signature
    call.__module__ = "voxdag"
    return call
