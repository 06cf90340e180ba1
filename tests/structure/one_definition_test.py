#!/usr/bin/env python3
"""Checks that no two files define the same type, alias or constant in the same namespace.

The linker does not see such a pair (C++'s One Definition Rule): it keeps one of two inline functions, and
a Debug build may keep the other one.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMESPACE = re.compile(r"^namespace(?: ([\w:]+))? \{")
END = re.compile(r"^\}  // namespace")
DEFINITION = re.compile(
    r"^(?:(?:struct|class|enum(?: class)?|union) (?:alignas\([^)]*\) )?(\w+)(?: final)?(?: : [^;]*)?(?: \{|$)"
    r"|using (\w+) ="
    r"|(?:inline )?constexpr [\w:<>, *&]+? (\w+)(?: = |\{|\[)"
    r"|inline (?!constexpr)[\w:<>, *&]+? (\w+) = )"
)
FUNCTION = re.compile(r"^(?:inline |constexpr |\[\[nodiscard\]\] )*[\w:<>*&]+(?: [\w:<>*&]+)* (\w+)\(([^()]*)\)(?: \{.*|;)$")


def signature(match):
    """Returns NAME(TYPES) of a function that stands on one line."""
    types = [re.sub(r" \w+$", "", parameter.split(" = ")[0].strip()) for parameter in match[2].split(",")]
    return f"{match[1]}({', '.join(types)})"


def definitions(path):
    """Yields (namespace, name, line number) of what a source defines, or a header declares, in a named namespace."""
    namespaces, template = [], ""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if match := NAMESPACE.match(line):
            namespaces.append(match[1])
        elif END.match(line) and namespaces:
            namespaces.pop()
        elif namespaces and None not in namespaces and (match := DEFINITION.match(line)):
            if path.suffix != ".cpp" or "constexpr" not in line:  # a constant of a source has internal linkage
                yield "::".join(namespaces), next(filter(None, match.groups())), number
        elif namespaces and None not in namespaces and path.suffix == ".hpp" and (match := FUNCTION.match(line)):
            yield "::".join(namespaces), template + signature(match), number
        template = line + " " if line.startswith("template") or (template and line.startswith("  requires")) else ""


def twins(folders, suffixes=(".hpp", ".cpp", ".cu")):
    """Returns a line for each name that two files of the folders define."""
    found = {}
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path.suffix in suffixes:
                for namespace, name, number in definitions(path):
                    found.setdefault((namespace, name), {}).setdefault(path, number)
    return [
        f"{namespace}::{name} is defined in " + " and ".join(f"{path}:{number}" for path, number in places.items())
        for (namespace, name), places in sorted(found.items())
        if len(places) > 1
    ], len(found)


def main():
    lines, count = twins([ROOT / folder for folder in ("src", "apps", "python/src")])
    if lines or count < 500:
        sys.exit("\n".join([*lines, f"{count} names"]))


if __name__ == "__main__":
    main()
