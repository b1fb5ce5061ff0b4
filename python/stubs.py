"""Writes the type stubs of what the libraries declare: `python python/stubs.py [--check]`.

`jaspe/noise.pyi` as a whole, and the maps and the parameters of materials in `jaspe/_jaspe.pyi`.
"""

import inspect
import re
import sys
from pathlib import Path
from typing import Any, Callable

FOLDER = Path(__file__).parent / "jaspe"
# The package that is installed is meant, and not the sources beside this file, which hold no library.
sys.path = [path for path in sys.path if Path(path).resolve() != FOLDER.parent.resolve()]

import jaspe  # noqa: E402
from jaspe import _jaspe, noise  # noqa: E402

#: The type of each parameter of the noises.
TYPES = {
    "points": "ArrayLike",
    "seed": "int",
    "period": "Union[int, Sequence[int], None]",
    "octaves": "float",
    "lacunarity": "float",
    "gain": "float",
    "feature": 'Literal["f1", "f2", "f2-f1", "cell"]',
    "metric": 'Literal["euclidean", "manhattan", "chebyshev"]',
    "jitter": "float",
    "warp": "Union[float, Sequence[float], None]",
}

HEAD = '''# Written by python/stubs.py from the declarations of the library; not to be edited.
from typing import Any, Literal, Sequence, Union, overload

from numpy.typing import ArrayLike, NDArray

from ._jaspe import Grid

__all__ = {names}

_Basis = Literal[{bases}]

def names() -> list[str]: ...
'''


def parameter(name: str, default: object) -> str:
    """One parameter of a noise but for `gradient`, as it stands in a signature."""
    kind = "_Basis" if name == "basis" else TYPES[name]
    return f"{name}: {kind}" if default is inspect.Parameter.empty else f"{name}: {kind} = {default!r}"


def overload(name: str, function: Callable[..., Any], gradient: str, result: str) -> str:
    """The signature of a noise for one meaning of `gradient`."""
    parameters, star = [], False
    for entry in inspect.signature(function).parameters.values():
        keyword = entry.kind is inspect.Parameter.KEYWORD_ONLY
        if entry.name == "gradient" and "=" not in gradient:
            keyword = True
        if keyword and not star:
            parameters.append("*")
            star = True
        parameters.append(gradient if entry.name == "gradient" else parameter(entry.name, entry.default))
    return f"@overload\ndef {name}({', '.join(parameters)}) -> {result}: ...\n"


def noises() -> str:
    """The stub of `jaspe.noise`."""
    bases = ", ".join(f'"{name}"' for name in dict.fromkeys(noise.names() + ["perlin"]))
    parts = [HEAD.format(names=repr(noise.__all__).replace("'", '"'), bases=bases)]
    for name in noise.__all__:
        function = getattr(noise, name)
        if name in ("Grid", "names"):
            continue
        if name != function.__name__:
            parts.append(f"{name} = {function.__name__}\n")
            continue
        array = "NDArray[Any]"
        parts.append(overload(name, function, "gradient: Literal[False] = False", array))
        parts.append(overload(name, function, "gradient: Literal[True]", f"tuple[{array}, {array}]"))
        either = f"Union[{array}, tuple[{array}, {array}]]"
        parts.append(overload(name, function, "gradient: bool = False", either))
    return "\n".join(parts)


def properties() -> str:
    """The parameters of all materials, as properties of `Texture`."""
    lines = []
    seen = set()
    for material in jaspe.textures():
        for entry in material.parameters:
            if entry.name in seen:
                continue
            seen.add(entry.name)
            words = ", ".join(f'"{word}"' for word in entry.choices)
            read = {"int": "int", "float": "float", "color": "tuple[float, float, float]", "choice": "str"}[entry.kind]
            write = {"color": "Union[Sequence[float], str]", "choice": f"Literal[{words}]"}.get(entry.kind, read)
            if entry.default is None:
                read = f"Optional[{read}]"
            lines += [
                "    @property",
                f"    def {entry.name}(self) -> {read}: ...",
                f"    @{entry.name}.setter",
                f"    def {entry.name}(self, value: Optional[{write}]) -> None: ...",
            ]
    return "\n".join(lines)


def native(text: str) -> str:
    """The stub of the native part, with the parameters of today."""
    block = re.compile(r"(# <declared>\n).*?(    # </declared>)", re.DOTALL)
    text = block.sub(lambda found: f"{found[1]}{properties()}\n{found[2]}", text)
    maps = ", ".join(f'"{entry["name"]}"' for entry in _jaspe.declarations()["maps"])
    block = re.compile(r"(# <maps>\n).*?(# </maps>)", re.DOTALL)
    return block.sub(lambda found: f"{found[1]}_Map = Literal[{maps}]\n{found[2]}", text)


def main() -> None:
    """Writes the stubs, or says what is not current."""
    files = {FOLDER / "noise.pyi": noises(), FOLDER / "_jaspe.pyi": native((FOLDER / "_jaspe.pyi").read_text("utf-8"))}
    stale = [path for path, text in files.items() if not path.exists() or path.read_text("utf-8") != text]
    if "--check" in sys.argv[1:]:
        if stale:
            sys.exit(f"not current: {', '.join(path.name for path in stale)}; run python python/stubs.py")
        return
    for path in stale:
        path.write_text(files[path], "utf-8")
        print(f"written: {path.name}")


if __name__ == "__main__":
    main()
